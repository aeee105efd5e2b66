"""Components of places that VAL3 has not: the angles a, b, c about z, y, x, and parts of places that stand nowhere.

`rx, ry, rz` of a trsf turn about x, the new y, the new z; those of the turn back are -c, -b, -a. So an angle is read
out of the inverse of the place, which is put into a variable in front: a component belongs to a variable.
"""

from __future__ import annotations

from rpl import ir
from rpl.passes.legalise.context import Context
from rpl.passes.legalise.rewriting.bodies import Hoister, Lowered
from rpl.passes.legalise.rewriting.editing import Editor, edit_bodies, edit_routines, map_body
from rpl.passes.legalise.stages import legalising
from rpl.passes.rewrite import rewrite_bodies

_EULER = {"a": "euler_z", "b": "euler_y", "c": "euler_x"}
_PLACES = (ir.PoseType, ir.TargetType)
_STORED = (ir.Name, ir.Index)


@legalising()
def components_in_variables(program: ir.Program, context: Context) -> ir.Program:
    """Angles of places by the turn back; what a component is read of stands in a variable."""

    def work(editor: Editor, routine: ir.Routine) -> ir.Routine:
        hoister = Hoister(editor, lambda one: _read(one, editor))

        def body(statements: ir.Body) -> ir.Body:
            return hoister.body(map_body(statements, lambda one: _set(one, editor)))

        return edit_bodies(routine, body)

    return edit_routines(program, context, work)


def _set(statement: ir.Statement, editor: Editor) -> ir.Body:
    """One angle that is set: the whole turn anew, with the other two as they are."""
    match statement:
        case ir.Assign(target=ir.Field(base=base, name=name), value=value) if name in _EULER:
            if isinstance(editor.type_of(base), _PLACES):
                angles = tuple((one, value if one == name else ir.Field(base, one)) for one in ir.ANGLES)
                turned = ir.Field(ir.Aggregate(angles, "pose"), "rot")
                return (ir.Assign(ir.Field(base, "rot"), turned, origin=statement.origin),)
    return (rewrite_bodies(statement, lambda inner: map_body(inner, lambda one: _set(one, editor))),)


def _read(expression: ir.Expression, editor: Editor) -> Lowered | None:
    """The component out of a variable, and what puts the place there."""
    match expression:
        case ir.Field(base=base, name=name) if name in _EULER and isinstance(editor.type_of(base), _PLACES):
            return _turned_back(base, _EULER[name], editor)
        case ir.Builtin(function="euler_x" | "euler_y" | "euler_z" as function, arguments=(ir.Field(base, "rot"),)):
            match base:
                case ir.Builtin(function="inverse", arguments=(ir.Name() | ir.Index(),)):
                    return None  # rx, ry, rz of that place
                case ir.Builtin(function="inverse", arguments=(ir.Builtin("pose_of", (ir.Name() | ir.Index(),)),)):
                    return None
            return _turned_back(base, function, editor)
        case ir.Field(base=base, name="x" | "y" | "z") if not isinstance(base, _STORED):
            if isinstance(editor.type_of(base), _PLACES):
                place = editor.temporary("trPlace", ir.PoseType())
                return (ir.Assign(place, _pose(base, editor)),), ir.Field(place, expression.name)
        case ir.Field(base=base) if not isinstance(base, _STORED) and isinstance(editor.type_of(base), ir.JointsType):
            joints = editor.temporary("jPlace", ir.JointsType())
            return (ir.Assign(joints, base),), ir.Field(joints, expression.name)
    return None


def _turned_back(base: ir.Expression, function: str, editor: Editor) -> Lowered:
    back = editor.temporary("trBack", ir.PoseType())
    turn = ir.Field(ir.Builtin("inverse", (back,)), "rot")
    return (ir.Assign(back, ir.Builtin("inverse", (_pose(base, editor),))),), ir.Builtin(function, (turn,))


def _pose(base: ir.Expression, editor: Editor) -> ir.Expression:
    return ir.Builtin("pose_of", (base,)) if isinstance(editor.type_of(base), ir.TargetType) else base

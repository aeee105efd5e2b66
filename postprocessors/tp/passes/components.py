"""Components of places, for targets that read them from variables only: a taught point, which may be taught anew, and
where the robot stands go into a variable first; of other data that nothing changes the value is written."""

from __future__ import annotations

from rpl import ir
from rpl.passes.fold import Unchanged, constant_number
from rpl.passes.legalise.context import Context
from rpl.passes.legalise.facts.usage import base_name
from rpl.passes.legalise.rewriting.bodies import Hoister, Lowered
from rpl.passes.legalise.rewriting.editing import Editor, edit_bodies, edit_routines
from rpl.passes.legalise.rewriting.walk import unchanged_in
from rpl.passes.legalise.stages import legalising
from rpl.passes.values import real

_ARM = 6  # joints of the arm; further ones are external axes
_PLACES = (ir.PoseType, ir.TargetType, ir.JointsType)


_ACTS_ON = frozenset(("Field", "system actual_joint"))


@legalising(sees=_ACTS_ON)
def read_components(program: ir.Program, context: Context) -> ir.Program:
    """Components of taught points and of the robot's place, which cannot be read."""
    known = unchanged_in(program)

    def work(editor: Editor, routine: ir.Routine) -> ir.Routine:
        return edit_bodies(routine, Hoister(editor, lambda one: _read(one, editor, known), _ACTS_ON).body)

    return edit_routines(program, context, work, _ACTS_ON)


def _read(expression: ir.Expression, editor: Editor, known: Unchanged) -> Lowered | None:
    """A component in another form; None: it stays."""
    match expression:
        case ir.System(name="actual_joint", indices=(ir.IntLiteral(value=axis),)):
            if "actual_joint" in editor.capabilities.system_variables:
                return None
            joints = editor.temporary("place", ir.JointsType())
            name = f"j{axis}" if axis <= _ARM else f"e{axis - _ARM}"
            return (ir.Assign(joints, ir.System("actual_joints")),), ir.Field(joints, name, origin=expression.origin)
    if not isinstance(expression, ir.Field):
        return None
    type = editor.type_of(expression.base)
    if not isinstance(type, _PLACES):
        return None
    taught = _is_taught(expression.base, editor, known)
    if taught and isinstance(type, ir.PoseType):
        return None  # kept in a variable anyway
    if isinstance(expression.base, ir.System) or taught:
        place = editor.temporary("place", type)
        return (ir.Assign(place, expression.base),), ir.Field(place, expression.name, origin=expression.origin)
    base = base_name(expression.base)
    value = None if base is None or base in known.assigned else constant_number(expression, editor.scope, known)
    return None if value is None else ((), real(value))


def _is_taught(base: ir.Expression, editor: Editor, known: Unchanged) -> bool:
    """Is it a place with a name (or an element of such) that the program itself does not change?"""
    name = base_name(base)
    if name is None or name in known.assigned or not isinstance(base, ir.Name | ir.Index):
        return False
    if name in editor.context.unknown:
        return False  # data that no file gives is a register, whose elements are read as they are
    symbol = editor.scope.value(name)
    return symbol is not None and (symbol.module is not None or symbol.routine is not None)


__all__ = ["read_components"]

"""The joints of a place nearest to given ones, and the place of joints, worked out by routines that the translated
program brings along, for targets whose programs cannot ask their controller.

The arm must have a closed form (rpl.emulator.closedforms), and the tool and the frame in use be known where the program
asks. What stays is refused by `refuse`.
"""

from __future__ import annotations

from dataclasses import replace

from rpl import ir
from rpl.ir.walk import walk
from rpl.passes import rigid
from rpl.passes.legalise.context import Context
from rpl.passes.legalise.flow import Frames, ModalFlow
from rpl.passes.legalise.helpers import Helpers
from rpl.passes.legalise.solvertexts import FLANGE, NEAR, REACHED, solver_texts
from rpl.passes.legalise.usage import bodies, each_expression, each_statement
from rpl.passes.legalise.walk import Rewriter
from rpl.passes.rewrite import rewrite_parts
from rpl.passes.values import literal

_ROUTINES = {
    "target_to_joints": NEAR,
    "target_to_joints_near": NEAR,
    "is_reachable": REACHED,
    "joints_to_target": FLANGE,
}
_PLACE = "joints_to_target"
_OWN = {"target_to_joints": 1, "target_to_joints_near": 2, "is_reachable": 2, "joints_to_target": 1}  # arguments


def solved_places(program: ir.Program, context: Context) -> ir.Program:
    """Only for targets that lack the functions, on the arm that the program was written for."""
    can, arm = context.capabilities, context.robot
    lacking = {name for name in _ROUTINES if name not in can.functions}
    if "target_to_joints_near" in lacking:
        lacking.add("target_to_joints")  # such functions choose by the posture that is written at the place
    if arm is None or can.kinematics is not None or not lacking:
        return program
    if context.to_robot is not None and context.to_robot is not arm:
        return program
    if not any(isinstance(one, ir.Builtin) and one.function in lacking for one in walk(*program.modules)):
        return program
    form = arm.closed_form()
    if form is None:
        return program
    helpers = Helpers(context, solver_texts(form))
    return helpers.added_to(_Solved(program, context, helpers, lacking).program())


class _Solved(Rewriter):
    """Rewrites the functions wherever they stand but as the goal of a move, which its controller solves itself."""

    def __init__(self, program: ir.Program, context: Context, helpers: Helpers, lacking: set[str]) -> None:
        super().__init__(program, context)
        self.flow, self.helpers, self.lacking = ModalFlow(program, self.scopes), helpers, lacking
        can = context.capabilities
        self.looked_at = _looked_at(program) if can.banks else set()
        self.kept = set(_OWN) - can.functions if can.banks else set()

    def statement(self, statement: ir.Statement) -> list[ir.Statement]:
        match statement:
            case ir.Move(target=ir.Builtin(function="target_to_joints_near" | "joints_to_target")):
                return [statement]
            case ir.Assign(target=ir.Name(id=name), value=ir.Builtin(function=function, arguments=(_,))) if (
                function in self.kept and name.lower() not in self.looked_at
            ):
                return [statement]  # moves go to what the variable was made of
        return super().statement(statement)

    def expression(self, expression: ir.Expression) -> ir.Expression:
        done = rewrite_parts(expression, self.expression)
        frames = self.flow.frames.get(id(expression))
        if not isinstance(expression, ir.Builtin) or not isinstance(done, ir.Builtin) or frames is None:
            return done
        name, count = expression.function, _OWN.get(expression.function)
        if name not in self.lacking or count is None:
            return done
        given = expression.arguments
        poses = given[count:] if name == _PLACE else (given[0], *given[count:])
        if not all(isinstance(self.type_of(one), ir.PoseType) for one in poses):
            return done
        found = self.place(done, frames) if name == _PLACE else self.joints(done, count, frames)
        return done if found is None else replace(found, origin=expression.origin)

    def joints(self, asked: ir.Builtin, own: int, frames: Frames) -> ir.Expression | None:
        """The joints of a place near given ones, else near those that the robot stands at."""
        place, given = asked.arguments[0], asked.arguments[own:]
        near = asked.arguments[1] if own > 1 else ir.Builtin("current_joints", ())
        seen = _around(given, frames)
        if seen is None:
            return None
        tool, frame = seen
        if frame is not None:
            place = ir.Binary(":", frame, place)
        if tool is not None:
            known = None if frames.tool is None or given else literal(frames.tool.inverse)
            place = ir.Binary(":", place, known or ir.Builtin("inverse", (tool,)))
        return self.helpers.call(_ROUTINES[asked.function], place, near)

    def place(self, asked: ir.Builtin, frames: Frames) -> ir.Expression | None:
        """Where the tool is in the frame, the robot standing at joints."""
        joints, *given = asked.arguments
        seen = _around(tuple(given), frames)
        if seen is None:
            return None
        tool, frame = seen
        place: ir.Expression = self.helpers.call(FLANGE, joints)
        if tool is not None:
            place = ir.Binary(":", place, tool)
        return place if frame is None else ir.Binary(":", ir.Builtin("inverse", (frame,)), place)


def _around(
    given: tuple[ir.Expression, ...], frames: Frames
) -> tuple[ir.Expression | None, ir.Expression | None] | None:
    """The tool and the frame of a question: those given, else those in use; None for those that do nothing."""
    tool, frame = (None if one is None or one == rigid.IDENTITY else literal(one) for one in (frames.tool, frames.base))
    if (not given and frames.tool is None) or (len(given) < 2 and frames.base is None):
        return None
    return given[0] if given else tool, given[1] if len(given) > 1 else frame


def _looked_at(program: ir.Program) -> set[str]:
    """Names, folded, of variables that more is done with than to set them and to move to them."""
    found: set[str] = set()
    for module in program.modules:
        for routine in module.routines:
            for body in bodies(routine):
                each_statement(body, lambda one: found.update(_wanted(one)))
    return found


def _wanted(statement: ir.Statement) -> set[str]:
    names: set[str] = set()
    skipped: tuple[ir.Expression | None, ...] = ()
    match statement:
        case ir.Assign(target=ir.Name() as target):
            skipped = (target,)
        case ir.Move(target=ir.Name() as target):
            skipped = (target,)

    def look(one: ir.Expression) -> None:
        if isinstance(one, ir.Name) and not any(one is known for known in skipped):
            names.add(one.id.lower())

    each_expression(statement, look)
    return names


__all__ = ["solved_places"]

"""The joints of a place nearest to given ones, and the place of joints, worked out by routines that the translated
program brings along, for targets whose programs cannot ask their controller.

The arm must have a closed form (rpl.emulator.closedforms), and the tool and the frame in use be known where the program
asks. A place that was read is taken without its arm configuration, with a warning; one with a written configuration is
not. What stays is refused by `refuse`.
"""

from __future__ import annotations

from dataclasses import replace

from rpl import ir, registry
from rpl.diagnostics import Severity, code
from rpl.ir.walk import bodies, walk
from rpl.passes import rigid
from rpl.passes.legalise.context import Context
from rpl.passes.legalise.facts.flow import Frames, ModalFlow, Uses
from rpl.passes.legalise.facts.usage import each_expression, each_statement
from rpl.passes.legalise.postures.solvertexts import FLANGE, NEAR, REACHED, solver_texts
from rpl.passes.legalise.rewriting.helpers import Helpers
from rpl.passes.legalise.rewriting.walk import Rewriter
from rpl.passes.legalise.stages import legalising
from rpl.passes.rewrite import rewrite_parts
from rpl.passes.values import literal
from rpl.source import NOWHERE

_ROUTINES = {
    "target_to_joints": NEAR,
    "target_to_joints_near": NEAR,
    "is_reachable": REACHED,
    "joints_to_target": FLANGE,
}
_PLACE = "joints_to_target"
_OWN = {"target_to_joints": 1, "target_to_joints_near": 2, "is_reachable": 2, "joints_to_target": 1}  # arguments
NEAREST = code(
    "posture-by-joints",
    Severity.WARNING,
    "the joints are those nearest to the given ones; the source takes the posture that was read with the place",
    "look that the given joints are of the posture in which the place is to be reached",
)
# Components of a place that say nothing of the arm's posture.
_PARTS = frozenset(("x", "y", "z", "a", "b", "c", "trans", "rot", "external", *ir.COMPONENTS[ir.ExternalType]))


@legalising()
def solved_places(program: ir.Program, context: Context) -> ir.Program:
    """Only for targets that lack the functions, on the arm that the program was written for."""
    can, arm = context.capabilities, context.robot
    lacking = {name for name in _ROUTINES if name not in can.functions}
    if "target_to_joints_near" in lacking:
        lacking.add("target_to_joints")  # such functions choose by the posture that is written at the place
    if arm is None or can.places.kinematics is not None or not lacking:
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
        self.looked_at = _looked_at(program) if can.storage.banks else set()
        self.kept = set(_OWN) - can.functions if can.storage.banks else set()
        self.read, self.here = program, NOWHERE
        self.uses: Uses | None = None
        # Numbered positions are read in the frame of the last move: only where no move has one of its own.
        self.framed = can.storage.banks and any(
            isinstance(one, ir.Move) and (one.frame or one.tool) for one in walk(program)
        )
        self.sets_flags = _sets_flags(program)

    def statement(self, statement: ir.Statement) -> list[ir.Statement]:
        self.here = statement.origin
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
        around = self.poses(expression, done, count)
        if around is None:
            return done
        done = replace(done, arguments=(*done.arguments[:count], *around))
        if name == _PLACE:
            found = self.place(done, frames)
        else:
            place = self.pose(expression, done.arguments[0])
            if place is None:
                return expression
            found = self.joints(replace(done, arguments=(place, *done.arguments[1:])), count, frames)
            if found is not None and place is not done.arguments[0]:
                self.context.diagnostics.report(NEAREST, expression.origin if expression.origin.source else self.here)
        return expression if found is None else replace(found, origin=expression.origin)

    def pose(self, asked: ir.Builtin, place: ir.Expression) -> ir.Expression | None:
        """The place without its arm configuration; None where one was written, which may be far from the joints."""
        match self.type_of(asked.arguments[0]):
            case ir.PoseType():
                return place
            case ir.TargetType() if not (
                asked.function == "target_to_joints" or self.framed or self.postured(asked.arguments[0])
            ):
                return ir.Builtin("pose_of", (place,), origin=place.origin)
        return None

    def postured(self, place: ir.Expression) -> bool:
        """May a written arm configuration come to this place? One that was read there is that of the arm."""
        if self.uses is None:
            self.uses = Uses.of(self.read, self.scopes)
        reached = self.uses.reach(place, self.scope)
        written = (one for one in self.uses.keep if id(one) in reached and isinstance(one, ir.Aggregate))
        return self.sets_flags or any(name not in _PARTS for one in written for name, _ in one.entries)

    def poses(self, asked: ir.Builtin, done: ir.Builtin, count: int) -> list[ir.Expression] | None:
        """The tool and the frame that are given, as poses; data of tools and frames only where it is constant."""
        found: list[ir.Expression] = []
        for at, one in enumerate(asked.arguments[count:]):
            if isinstance(self.type_of(one), ir.PoseType):
                found.append(done.arguments[count + at])
                continue
            known = self.flow.part(one, ("tool", "base")[at], {}, self.scope)
            pose = None if known is None else literal(known)
            if pose is None:
                return None
            found.append(pose)
        return found

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


def _sets_flags(program: ir.Program) -> bool:
    """Does the program set parts of an arm configuration?"""
    flags = {"conf"}.union(*(registry.dialect(module.dialect).notation_fields for module in program.modules))
    return any(
        isinstance(one, ir.Assign) and isinstance(one.target, ir.Field) and one.target.name in flags
        for one in walk(*program.modules)
    )


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

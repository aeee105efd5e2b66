"""Joint moves to the solution of a place nearest to given joints, for targets that cannot calculate it.

Where place, tool and joints are constant the move goes to the joints themselves. Nearest to where the arm is: a move to
the place, which the target's controller solves so. Nearest to other constant joints: their posture where the target's
moves can ask for one, else the place alone, with a warning; so where the joints are not known before the program runs.
What stays is refused by `refuse`.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

from rpl import ir
from rpl.diagnostics import Severity, code
from rpl.ir.walk import bodies, walk
from rpl.passes.capabilities import Postures
from rpl.passes.fold import constant
from rpl.passes.legalise.context import Context
from rpl.passes.legalise.facts.framesinforce import FramesInForce
from rpl.passes.legalise.facts.values.taughtvalues import JointsOfPlaces
from rpl.passes.legalise.kinds import walk_for
from rpl.passes.legalise.rewriting.editing import edit_bodies, edit_each
from rpl.passes.legalise.rewriting.walk import Rewriter, unchanged_in
from rpl.passes.legalise.stages import legalising
from rpl.passes.values import Record, Value, component, pose_of, real

POSTURE = code(
    "posture-not-asked",
    Severity.WARNING,
    "the posture nearest to the given joints cannot be asked for; the arm takes the one nearest to where it is",
    "look on the controller that the arm comes to this place in the right posture",
)
_NEAR = "target_to_joints_near"
_HERE = "target_to_joints"  # of one place: nearest to where the robot is
_GIVEN = {_NEAR: 2, _HERE: 1}  # arguments, with the tool and the frame that are set


@legalising(
    unless=lambda context: (
        _NEAR in context.capabilities.functions or context.capabilities.places.kinematics is not None
    ),
    sees=("Builtin",),
)
def near_joints(program: ir.Program, context: Context) -> ir.Program:
    """Only for targets without the function."""
    can = context.capabilities
    lacking = {_NEAR, _HERE} - can.functions
    if not any(
        isinstance(one, ir.Builtin) and one.function in lacking for one in walk_for({"Builtin"}, *program.modules)
    ):
        return program
    return _Solved(_direct(program, lacking), context).program()


class _Solved(Rewriter):
    """Rewrites the moves."""

    def __init__(self, program: ir.Program, context: Context) -> None:
        super().__init__(program, context)
        self.written = JointsOfPlaces(program, context)
        self.flow, self.unchanged = FramesInForce(program), unchanged_in(program)

    def statement(self, statement: ir.Statement) -> list[ir.Statement]:
        match statement:
            case ir.Move(kind="joint", relative=None, target=ir.Builtin(function=name, arguments=given)) if (
                name == _NEAR and len(given) == 2
            ):
                return [self.solved(statement, given[0], given[1])]
            case ir.Move(kind="joint", relative=None, target=ir.Builtin(function=name, arguments=(place,))) if (
                name == _HERE and name not in self.context.capabilities.functions
            ):
                return [replace(statement, target=place)]  # the controller takes what is nearest to where it is
        return super().statement(statement)

    def solved(self, move: ir.Move, place: ir.Expression, near: ir.Expression) -> ir.Move:
        if near == ir.Builtin("current_joints", ()):
            return replace(move, target=place)
        joints = self.axes(constant(near, self.scope, self.unchanged))
        if joints is None and not isinstance(near, ir.Aggregate):
            self.context.diagnostics.report(POSTURE, move.origin)
            return replace(move, target=place)
        if joints is None:
            return move
        found = self.joints(move, place, joints)
        if found is not None:
            self.written.tell(move, self.scope, place)
            return replace(move, target=_written(found))
        if self.context.capabilities.places.postures is Postures.JOINTS:
            return replace(move, target=ir.Builtin(_NEAR, (place, _written(joints))))
        self.context.diagnostics.report(POSTURE, move.origin)
        return replace(move, target=place)

    def axes(self, value: Value | None) -> list[float] | None:
        """The values of the arm's axes, in its own units."""
        arm = self.context.robot
        if not isinstance(value, Record):
            return None
        found = [component(value, name) for name in ir.AXES[: arm.axes if arm is not None else len(ir.AXES)]]
        return [float(one) for one in found if isinstance(one, int | float)] if None not in found else None

    def joints(self, move: ir.Move, place: ir.Expression, near: list[float]) -> list[float] | None:
        """The solution, where everything about the place is constant and the arm is known."""
        arm, frames = self.context.robot, self.flow.frames.get(id(move))
        pose = pose_of(constant(place, self.scope, self.unchanged))
        if arm is None or frames is None or pose is None or len(near) != arm.axes or self.other_arm(arm):
            return None
        flange = frames.flange(pose)
        solved = None if flange is None else arm.nearest(flange.matrix, near)
        return None if solved is None else [float(one) for one in solved]

    def other_arm(self, arm: object) -> bool:
        return self.context.to_robot is not None and self.context.to_robot is not arm


def _written(joints: list[float]) -> ir.Expression:
    entries = tuple((name, real(value)) for name, value in zip(ir.AXES, joints, strict=False))
    return ir.Aggregate(entries, type_name="joints")


# ---- a variable between the calculation and the move


def _direct(program: ir.Program, functions: set[str]) -> ir.Program:
    """`q := near(...)`, `MOVE q` in a row, where nothing else wants q, becomes one move."""
    shared: dict[str, set[int]] = {}  # name that a routine does not declare itself -> the routines with it
    every = [routine for module in program.modules for routine in module.routines]
    for routine in every:
        for name in _mentioned(routine) - _declared(routine):
            shared.setdefault(name, set()).add(id(routine))

    def work(routine: ir.Routine) -> ir.Routine:
        own = _declared(routine)

        def alone(name: str, rest: ir.Body) -> bool:
            return (name in own or shared.get(name) == {id(routine)}) and _dead(name, rest)

        return edit_bodies(routine, lambda body: direct(body, alone, _mentioned(routine, besides=body)))

    def direct(whole: ir.Body, alone: Callable[[str, ir.Body], bool], elsewhere: set[str]) -> ir.Body:
        done: list[ir.Statement] = []
        body = list(whole)
        while body:
            first, *rest = body
            match first, rest:
                case (
                    ir.Assign(target=ir.Name(id=name), value=ir.Builtin(function=function, arguments=given) as value),
                    [ir.Move(kind="joint", relative=None, target=ir.Name(id=goal)) as move, *behind],
                ) if (
                    function in functions
                    and len(given) == _GIVEN[function]
                    and goal.lower() == name.lower()
                    and name.lower() not in elsewhere
                    and alone(name.lower(), tuple(behind))
                ):
                    comments = (*first.origin.comments, *move.origin.comments)
                    done.append(replace(move, target=value, origin=replace(move.origin, comments=comments)))
                    body = behind
                case _:
                    done.append(first)
                    body = rest
        return tuple(done)

    return edit_each(program, lambda _, routine: work(routine))


def _mentioned(routine: ir.Routine, besides: ir.Body | None = None) -> set[str]:
    """Names in the routine, in all bodies but that one."""
    parts = [body for body in bodies(routine) if body is not besides]
    return {one.id.lower() for body in parts for one in walk(*body) if isinstance(one, ir.Name)}


def _declared(routine: ir.Routine) -> set[str]:
    """Names that each call of the routine has anew."""
    own = {
        one.name.lower() for one in routine.declarations if isinstance(one, ir.Variable) and one.storage == "variable"
    }
    return own | {one.name.lower() for one in routine.parameters if one.mode == "value"}


def _dead(name: str, rest: ir.Body) -> bool:
    """Is the variable set again before it is read, at the level of a routine's own body?"""
    for statement in rest:
        match statement:
            case ir.Assign(target=ir.Name(id=target), value=value) if target.lower() == name:
                return not any(isinstance(one, ir.Name) and one.id.lower() == name for one in walk(value))
            case ir.Label():
                return False
        if any(isinstance(one, ir.Name) and one.id.lower() == name for one in walk(statement)):
            return False
    return True


__all__ = ["near_joints"]

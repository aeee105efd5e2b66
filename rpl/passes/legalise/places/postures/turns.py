"""Joint moves to places of a target whose places do not tell how far an axis has turned: its controller takes each axis
the shortest way there.

Where that is another turn than the source's, the move goes to the joints themselves, if place, tool and frame are
constant; else a warning names the difference. Where it is not known from which joints the arm comes, it may come from
any between those that the program's known moves lead to.
"""

from __future__ import annotations

from dataclasses import replace
from typing import Any

from rpl import ir, registry
from rpl.diagnostics import Severity, code
from rpl.ir.walk import bodies, walk
from rpl.passes.capabilities import PlaceRule
from rpl.passes.fold import constant
from rpl.passes.legalise.context import Context, array
from rpl.passes.legalise.facts.motion.whereabouts import Joints, Stand, Whereabouts
from rpl.passes.legalise.facts.values.taughtvalues import JointsOfPlaces
from rpl.passes.legalise.kinds import walk_for
from rpl.passes.legalise.rewriting.walk import Rewriter
from rpl.passes.legalise.stages import legalising
from rpl.passes.scope import Scope
from rpl.passes.values import Target, real

TURN = code(
    "turn-not-told",
    Severity.WARNING,
    "{axes} may come here in another turn than the source tells, which a place of the target cannot: its controller "
    "takes the shortest way from where the arm is, and that is not known here",
    "write this place as joints where the turn matters (cables, limits of axes, joints that are read)",
)
_NEAR = "target_to_joints_near"
_SAME_DEG = 0.01
_OTHER_TURN_DEG = 180.0  # what differs by more is another turn, though joints are known to the degree only


@legalising(
    unless=lambda context: (
        PlaceRule.TURNS in context.capabilities.places.rules
        or not context.foreign
        or ((context.to_robot or context.robot) is None)
    ),
    sees=("Move",),
)
def told_turns(program: ir.Program, context: Context) -> ir.Program:
    """Only for arms that are named, and targets whose places tell no turns."""
    if not any(isinstance(one, ir.Move) and _to_a_place(one) for one in walk_for({"Move"}, *program.modules)):
        return program
    return _Turns(program, context).program()


def _to_a_place(move: ir.Move) -> bool:
    return move.kind == "joint" and move.relative is None


class _Turns(Rewriter):
    """`low`, `high`: between these angles (deg) the axes are where it is not known."""

    def __init__(self, program: ir.Program, context: Context) -> None:
        super().__init__(program, context)
        self.written = JointsOfPlaces(program, context)
        self.arm: Any = context.to_robot or context.robot
        make = registry.dialect(context.capabilities.places.notation).notation
        self.notation: Any = None if make is None else make()
        self.stands = Whereabouts(program, context, converted=True, assuming=True)
        self.low, self.high = self.range(program)

    def range(self, program: ir.Program) -> tuple[Any, Any]:
        known = [stand.joints for stand in self.stands.ends.values() if stand.joints is not None]
        near: list[Joints | None] = []
        for module, routine in self.scopes.routines():
            scope = self.scopes.routine(module, routine)
            near += [_near(one, scope) for one in walk(*bodies(routine)) if isinstance(one, ir.Move)]
        rows = array([self.arm.home, *(one for one in (*known, *near) if one and len(one) == self.arm.axes)])
        return rows.min(axis=0), rows.max(axis=0)

    def statement(self, statement: ir.Statement) -> list[ir.Statement]:
        if isinstance(statement, ir.Move) and _to_a_place(statement):
            return [self.move(statement)]
        return super().statement(statement)

    def move(self, move: ir.Move) -> ir.Move:
        start, end = self.stands.starts.get(id(move), Stand()), self.stands.ends.get(id(move), Stand())
        near = _near(move, self.scope)
        if near is None:
            others = self.spread() if self.is_computed(move) else []
        elif end.joints is not None and end.flange is not None and not self.displaced(move):
            return self.to_joints(move, end.joints) if self.turns(start.joints, end) else move
        else:
            others = self.others(start.joints, array(near)) if len(near) == self.arm.axes else []
        if others:
            self.context.diagnostics.report(TURN, move.origin, axes=_named(others))
        return move

    def displaced(self, move: ir.Move) -> bool:
        """Has the place axes outside the arm, or does the move look for something? Then it stays one to a place."""
        place = move.target.arguments[0] if isinstance(move.target, ir.Builtin) else move.target
        goal = constant(place, self.scope, self.stands.unchanged)
        return move.search is not None or (isinstance(goal, Target) and any(value for _, value in goal.external))

    def is_computed(self, move: ir.Move) -> bool:
        """Is the place one that the program works out, which may tell turns? What is constant and tells some has joints
        near to it by now."""
        if not isinstance(self.type_of(move.target), ir.TargetType):
            return False
        return constant(move.target, self.scope, self.stands.unchanged) is None

    def turns(self, before: Joints | None, end: Stand) -> bool:
        """Would the target's controller come there with other joints?"""
        assert end.joints is not None and end.flange is not None  # `move` looked
        goal = array(end.joints)
        if before is None or self.notation is None:
            return bool(self.others(None, goal))
        flags = self.notation.encode(self.arm, goal)
        found = self.notation.select(self.arm, array(end.flange.matrix), flags, array(before)).joints
        return found is None or float(abs(found - goal).max()) > _SAME_DEG

    def others(self, before: Joints | None, goal: Any) -> list[int]:
        """Axes that the shortest way takes to another turn, from the joints before or from any that may be."""
        places = (self.low, self.high) if before is None else (array(before), array(before))
        found: set[int] = set()
        for place in places:
            away = abs(self.arm.nearest_turn(goal, place) - goal) > _OTHER_TURN_DEG
            found.update(axis for axis, turned in enumerate(away) if turned)
        return sorted(found)

    def spread(self) -> list[int]:
        """Axes that the program turns so far that the shortest way from one end to the other is not the way back."""
        return sorted({*self.others(None, self.low), *self.others(None, self.high)})

    def to_joints(self, move: ir.Move, joints: Joints) -> ir.Move:
        self.written.tell(move, self.scope, move.target)
        entries = tuple((name, real(round(one, 9))) for name, one in zip(ir.AXES, joints, strict=False))
        return replace(move, target=ir.Aggregate(entries, type_name="joints"))


def _near(move: ir.Move, scope: Scope) -> Joints | None:
    """The constant joints that a move solves near to."""
    match move.target:
        case ir.Builtin(function=name, arguments=(_, ir.Aggregate(entries=entries))) if name == _NEAR:
            values = dict(entries)
            given = [constant(values[name], scope) for name in ir.AXES if name in values]
            found = tuple(float(one) for one in given if isinstance(one, int | float))
            return found if len(found) == len(given) > 0 else None
    return None


def _named(axes: list[int]) -> str:
    words = [f"axis {axis + 1}" for axis in axes]
    return words[0] if len(words) == 1 else ", ".join(words[:-1]) + f" and {words[-1]}"


__all__ = ["told_turns"]

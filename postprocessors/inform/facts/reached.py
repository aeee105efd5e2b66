"""Where the robot is in front of each move: the end of the move before, as far as every way there has the same one and
it is constant, and whether it stands there."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from itertools import zip_longest

from rpl import ir
from rpl.ir.walk import walk
from rpl.passes.legalise.facts.forward import Forward, beside, started
from rpl.passes.legalise.facts.usage import assigned_below, assigned_in, doing
from rpl.passes.scope import Scope

from ..operands import constant
from ..places import WORLD, Constants, Position, Values, product, way_of

_DRIVING = (ir.Move, ir.MoveExternal, ir.Spline, ir.Opaque, ir.Halt)


@dataclass(frozen=True, slots=True)
class Reached:
    """position: None where it is not known. frame: as the move says it, or None for the base; `base`: its value, None
    where that is computed. rests_on: variables (folded) with which the computed frame or tool changes. stands: did the
    move end exactly, with the program waiting for it?"""

    position: Position | None = None
    frame: ir.Expression | None = None
    base: Values | None = None
    tool: ir.Expression | None = None
    rests_on: frozenset[str] = frozenset()
    stands: bool = False

    def somewhere(self) -> Reached:
        return Reached(stands=self.stands)


NOWHERE = Reached()


class Ends(Forward[Reached]):
    """`before`: what is known in front of each move, by the move's identity. `of`: the constants of a routine."""

    def __init__(self, program: ir.Program, of: Callable[[ir.Routine], Constants]) -> None:
        super().__init__(program, NOWHERE, NOWHERE)
        self.of = of
        self.before: dict[int, Reached] = {}
        self.driving = doing(program, _drives)
        self.assigned = assigned_below(program)
        self.solve(started(program), beside(program))

    def note(self, statement: ir.Statement, before: Reached) -> None:
        if isinstance(statement, ir.Move):
            known = self.before.get(id(statement))
            self.before[id(statement)] = before if known is None else self.join(known, before)

    def join(self, one: Reached, other: Reached) -> Reached:
        if one == other:
            return one
        if replace(one, stands=False) == replace(other, stands=False):
            return replace(one, stands=False)
        return Reached(stands=one.stands and other.stands)

    def entered(self, state: Reached, here: Scope, there: Scope) -> Reached:
        return NOWHERE

    def left(self, before: Reached, end: Reached, routine: ir.Routine, there: Scope, here: Scope) -> Reached:
        name = routine.name.lower()
        return NOWHERE if name in self.driving else _without(before, self.assigned.get(name, set()))

    def transfer(self, statement: ir.Statement, before: Reached) -> Reached:
        match statement:
            case ir.Move():
                return _without(self.moved(statement, before), assigned_in((statement,)))
            case ir.WaitForMotion():
                return replace(before, stands=True)
            case ir.Opaque() | ir.Halt() | ir.MoveExternal() | ir.Spline():
                return NOWHERE
        return _without(before, assigned_in((statement,)) if before.rests_on else set())

    def moved(self, move: ir.Move, before: Reached) -> Reached:
        constants, stands = self.of(self.run.of.routine), ends_exactly(move)
        if move.search is not None or move.swept is not None:
            return Reached(stands=stands)
        base = WORLD if move.frame is None else _values(constants, move.frame)
        if move.relative is not None:
            position = self.further(move, before, base, constants)
            return replace(before, position=position, stands=stands) if position is not None else Reached(stands=stands)
        target = move.target
        known = constants.known(target)
        while known is None and isinstance(target, ir.Builtin) and target.function in ("joints_to_target", "pose_of"):
            target = target.arguments[0]
            known = constants.known(target)
        if known is None or (known.kind == "joints" and base is None):
            return Reached(stands=stands)
        tool = None if move.tool is None else _values(constants, move.tool)
        computed = [one for one, value in ((move.frame, base), (move.tool, tool)) if value is None and one is not None]
        names = frozenset(node.id.lower() for one in computed for node in walk(one) if isinstance(node, ir.Name))
        return Reached(known, move.frame, base, move.tool, names, stands)

    def further(self, move: ir.Move, before: Reached, base: Values | None, constants: Constants) -> Position | None:
        """Where a relative move comes to from the last place."""
        start, way = before.position, way_of(move.target) or constants.known(move.target)
        if start is None or way is None or way.kind != start.kind or not same_tool(before.tool, move.tool, constants):
            return None
        if way.kind == "joints":
            sums = tuple(one + more for one, more in zip_longest(start.values, way.values, fillvalue=0.0))
            return Position("joints", sums)
        if move.relative == "tool":
            return Position("pose", product(start.values, way.values), start.flags)
        if any(way.values[3:]) or base is None or base != before.base:
            return None
        moved = (one + more for one, more in zip(start.values[:3], way.values[:3], strict=True))
        return Position("pose", (*moved, *start.values[3:]), start.flags)


def ends_exactly(move: ir.Move) -> bool:
    """Does the program wait at its end, and the robot goes round no corner?"""
    if move.concurrent:
        return False
    match move.blend:
        case None:
            return move.kind != "spline"
        case ir.BlendStop():
            return True
        case ir.BlendLevel(level=size) | ir.BlendDistance(distance=size) if size is not None:
            return constant(size) == 0
    return False


def same_tool(one: ir.Expression | None, other: ir.Expression | None, constants: Constants) -> bool:
    """Have both moves the same tool, named or by its value?"""
    if one == other:
        return True
    known = [None if tool is None else _values(constants, tool) for tool in (one, other)]
    return known[0] is not None and known[0] == known[1]


def _values(constants: Constants, place: ir.Expression) -> Values | None:
    known = constants.known(place)
    return None if known is None else known.values


def _without(state: Reached, changed: set[str]) -> Reached:
    """What is known where these variables have changed."""
    return state if state.rests_on.isdisjoint(changed) else state.somewhere()


def _drives(node: object) -> bool:
    return isinstance(node, _DRIVING) or (isinstance(node, ir.CallRoutine) and node.dynamic is not None)


__all__ = ["Ends", "Reached", "ends_exactly", "same_tool"]

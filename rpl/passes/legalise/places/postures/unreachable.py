"""Moves to places to which the arm that runs the result does not come: each is a guarded stop, all else is written.

Where all places that are known could be reached from another foot of the robot, or with a longer tool, that is said:
the shortest such shift of a lattice. The places are looked at one by one; the ways between them may still leave the
reach.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from itertools import product
from typing import Any

from rpl import ir
from rpl.diagnostics import Severity, code
from rpl.ir.walk import bodies, walk
from rpl.passes.legalise.context import Context, Unreached
from rpl.passes.legalise.rewriting.editing import edit_bodies, edit_each, map_body
from rpl.passes.legalise.rewriting.jumps import inside
from rpl.passes.legalise.rewriting.stopping import stopped
from rpl.passes.legalise.stages import legalising
from rpl.source import Origin

UNREACHABLE = code(
    "unreachable-on-target-arm",
    Severity.LOSS,
    "the arm {arm} does not reach this {what}: {reason}",
    "move the place, or the foot of the robot",
    stops=True,
)
UNUSED = code(
    "unreachable-place",
    Severity.WARNING,
    "the arm {arm} does not reach this {what}: {reason}; no move goes just there",
)
SHIFT = code(
    "reach-shift",
    Severity.INFO,
    "with {way}, the arm {arm} comes to all {count} known places of the program; now it misses {missed}",
    "look at the ways between them, and set the frames anew",
)
_STEP_MM, _STEPS = 50.0, 8  # the lattice of shifts: up to 400 mm in each direction
_LONGEST_TOOL_MM, _TOOL_STEP_MM = 300.0, 20.0
_MOST_PLACES = 200


@legalising(sees=("Move",))
def unreachable_moves(program: ir.Program, context: Context) -> ir.Program:
    """Where an arm that is given does not come to a place."""
    if not context.unreached:
        return program
    moves = _Moves(program, context)
    done = edit_each(program, moves.routine)
    arm = context.to_robot or context.robot
    for at, found in context.unreached.items():
        if at not in moves.used and arm is not None:
            words = {"arm": arm.name, "what": found.what, "reason": found.reason}
            context.diagnostics.report(UNUSED, found.origin, **words)
    if moves.used and arm is not None and context.flanges:
        _tell_shift(arm, context, next(context.unreached[at].origin for at in context.unreached if at in moves.used))
    return done


class _Moves:
    """used: places that are not reached, and to which a move goes."""

    def __init__(self, program: ir.Program, context: Context) -> None:
        self.context, self.used = context, set[tuple[int, int]]()
        self.shared: dict[str, set[tuple[int, int]]] = {}
        for module in program.modules:
            self._declared(module.declarations, self.shared)
        self.own: dict[str, set[tuple[int, int]]] = {}

    def routine(self, module: ir.Module, routine: ir.Routine) -> ir.Routine:
        self.own = {}
        self._declared(routine.declarations, self.own)
        for node in walk(*bodies(routine)):
            if isinstance(node, ir.Assign):
                self._told(_root(node.target), (node.origin, node.value.origin), self.own)
        return edit_bodies(routine, self.body)

    def body(self, body: ir.Body) -> ir.Body:
        return map_body(body, self.statement)

    def statement(self, statement: ir.Statement) -> ir.Body:
        if not isinstance(statement, ir.Move):
            return (inside(statement, self.body),)
        found = next(iter(self.goals(statement)), None)
        arm = self.context.to_robot or self.context.robot
        if found is None or arm is None:
            return (statement,)
        words = {"arm": arm.name, "what": found.what, "reason": found.reason}
        return (stopped(statement, UNREACHABLE, self.context, **words),)

    def goals(self, move: ir.Move) -> Iterator[Unreached]:
        """What of the places of a move is not reached: those that stand in it, and data that it names."""
        known = self.context.unreached
        for place in (move.target, move.via):
            if place is None:
                continue
            origins = {_at(move.origin), _at(place.origin)}
            name = _root(_plain(place))
            if name:
                origins |= self.own.get(name, self.shared.get(name, set()))
            for at in sorted(origins & known.keys()):
                self.used.add(at)
                yield known[at]

    def _declared(self, declarations: Iterable[ir.Declaration], into: dict[str, set[tuple[int, int]]]) -> None:
        for one in declarations:
            match one:
                case ir.Variable(name=name, initial=value):
                    self._told(name.lower(), (one.origin, value.origin if value is not None else one.origin), into)
                case ir.Initialise(assign=ir.Assign(target=target, value=value)):
                    self._told(_root(target), (one.origin, value.origin), into)

    def _told(self, name: str, origins: Iterable[Origin], into: dict[str, set[tuple[int, int]]]) -> None:
        found = {_at(one) for one in origins} & self.context.unreached.keys()
        if name and found:
            into.setdefault(name, set()).update(found)


def _at(origin: Origin) -> tuple[int, int]:
    return id(origin.source), origin.start


def _plain(place: ir.Expression) -> ir.Expression:
    """The place itself, where it is given with the joints near to it."""
    return place.arguments[0] if isinstance(place, ir.Builtin) and place.function == "target_to_joints_near" else place


def _root(place: ir.Expression) -> str:
    while isinstance(place, ir.Index | ir.Field):
        place = place.base
    return place.id.lower() if isinstance(place, ir.Name) else ""


def _tell_shift(arm: Any, context: Context, origin: Origin) -> None:
    """The smallest shift of the robot's foot, and the smallest longer tool, with which every known place is reached."""
    import numpy as np  # most translations ask nothing of the arm

    flanges = np.array(list({tuple(map(tuple, one)): one for one in context.flanges}.values())[:_MOST_PLACES])
    missed = ~reached(arm, flanges)
    if not missed.any():
        return
    counts = {"arm": arm.name, "count": len(flanges), "missed": int(missed.sum())}
    steps = np.arange(-_STEPS, _STEPS + 1) * _STEP_MM
    for shift in sorted(product(steps, repeat=3), key=lambda one: (sum(each * each for each in one), one)):
        moved = flanges.copy()
        moved[:, :3, 3] -= shift
        if reached(arm, moved[missed]).all() and reached(arm, moved).all():
            way = ", ".join(f"{name} {each:+g}" for name, each in zip("xyz", shift, strict=True))
            context.diagnostics.report(SHIFT, origin, way=f"its foot moved by {way} mm", **counts)
            break
    for longer in np.arange(_TOOL_STEP_MM, _LONGEST_TOOL_MM + 1.0, _TOOL_STEP_MM):
        moved = flanges.copy()
        moved[:, :3, 3] -= longer * moved[:, :3, 2]
        if reached(arm, moved[missed]).all() and reached(arm, moved).all():
            context.diagnostics.report(
                SHIFT, origin, way=f"a tool {longer:g} mm longer along the flange's axis", **counts
            )
            break


def reached(arm: Any, flanges: Any) -> Any:
    """Which flanges (k, 4, 4) the arm comes to within the limits of its axes."""
    import numpy as np

    if not len(flanges):
        return np.zeros(0, dtype=bool)
    found = arm.inverse_batch(flanges)
    joints = arm.nearest_turn(found.joints, arm.home)
    low, high = arm.limits[:, 0], arm.limits[:, 1]
    with np.errstate(invalid="ignore"):
        inside = (joints >= low - 1e-6) & (joints <= high + 1e-6)
    return (inside.all(axis=2) & found.valid).any(axis=1)


__all__ = ["reached", "unreachable_moves"]

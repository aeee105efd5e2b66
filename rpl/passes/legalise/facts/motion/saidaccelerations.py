"""The acceleration of each move, for targets whose moves say it in numbers (URScript `a=`).

A move that says none is driven with the target's usual acceleration, which may be many times smaller than the one of
the source's controller: cycles become several times longer, and what is timed on the way changes. So each move says
what it has in the source: on paths by its settings, of the axes by the arm, both in its percentage (TP `ACC50`, RAPID
`AccSet`). What depends on the run is left out and named.
"""

from __future__ import annotations

from dataclasses import replace

from rpl import ir
from rpl.diagnostics import Code, Severity, code
from rpl.passes.capabilities import MoveSetting
from rpl.passes.legalise.context import Context, rules_of
from rpl.passes.legalise.facts.settingsinforce import BRAKING, State
from rpl.passes.legalise.kinds import walk_for
from rpl.passes.legalise.rewriting.settingwords import DROPPED

GIVEN = code(
    "accelerations-of-source",
    Severity.WARNING,
    "moves are given the accelerations that they have on the source's controller, in place of the target's usual ones",
    "look that the arm may be driven so with its load",
)
# Settings that moves say then; the percentage of each axis is that of all.
SAID = frozenset(("path_acceleration", "acceleration_percent", "joint_acceleration"))
_FULL = 100.0


class Accelerations:
    """`active`: the target's moves say accelerations, and the source is another language. `start`: the settings at the
    beginning of the program."""

    def __init__(self, program: ir.Program, context: Context, start: State) -> None:
        self.context, self.start = context, start
        says = {"path_acceleration", "axis_acceleration"} <= context.capabilities.settings.speeds
        self.active = context.foreign and says and MoveSetting.SPEED in context.capabilities.settings.of_moves
        self.set = {
            node.target.name
            for node in (walk_for({"Assign"}, *program.modules) if self.active else ())
            if isinstance(node, ir.Assign) and isinstance(node.target, ir.System)
        }
        theirs = rules_of(context.target).system_defaults
        self.usual = float(theirs.get("path_acceleration", BRAKING["path_acceleration"]))
        self.arm = context.to_robot or context.robot
        self.reported: set[Code] = set()

    def with_acceleration(self, move: ir.Move, state: State) -> ir.Move:
        """The move with its acceleration. One that has a time takes what that needs."""
        speed, joint = move.speed or ir.Speed(), move.kind == "joint"
        if not self.active or move.relative is not None or speed.duration is not None:
            return move
        bare = replace(move, acceleration=None)
        if speed.axis_acceleration is not None or speed.path_acceleration is not None:
            return bare
        percent = move.acceleration or self.value("acceleration_percent", state)
        full = number_of(self.value("joint_acceleration" if joint else "path_acceleration", state))
        if percent is None or full is None:
            self.report(DROPPED, move, name="an acceleration that depends on the run")
            return bare
        if joint and self.arm is None:
            if full != _FULL or number_of(percent) != _FULL:
                self.report(DROPPED, move, name="the acceleration of the axes without a named arm")
            return bare
        if joint and self.arm is not None:  # of the slowest axis, as the speed of a joint move is
            full *= float(min(self.arm.accelerations)) / _FULL
        rate = _product(percent, full / _FULL)
        if not joint and number_of(rate) == self.usual:
            return bare
        self.report(GIVEN, move)
        name = "axis_acceleration" if joint else "path_acceleration"
        return replace(bare, speed=replace(speed, **{name: rate}))

    def value(self, name: str, state: State) -> ir.Expression | None:
        """What is set at a move; what nothing sets is as at the start."""
        return state.get(name) if name in self.set else self.start.get(name)

    def report(self, what: Code, move: ir.Move, **arguments: object) -> None:
        if what not in self.reported:
            self.reported.add(what)
            self.context.diagnostics.report(what, move.origin, **arguments)


def _product(value: ir.Expression, factor: float) -> ir.Expression:
    known = number_of(value)
    if known is not None:
        return ir.RealLiteral(float(f"{known * factor:.6g}"), origin=value.origin)
    return ir.Binary("*", value, ir.RealLiteral(float(f"{factor:.12g}")), origin=value.origin)


def number_of(value: ir.Expression | None) -> float | None:
    """A number that is written there, in base units."""
    match value:
        case ir.Quantity(value=inner, unit=unit):
            known = number_of(inner)
            return None if known is None else known * ir.UNITS[unit]
        case ir.RealLiteral(value=number) | ir.IntLiteral(value=number):
            return float(number)
    return None

"""Pulses of axes whose count per degree nobody has said: what is assumed of them is reported once.

Only some controllers count the joints in pulses; where an arm is of another one, a neutral scale stands in.
"""

from __future__ import annotations

from rpl import ir
from rpl.diagnostics import Diagnostics, Severity, code
from rpl.passes.legalise.context import Arm
from rpl.passes.legalise.kinds import walk_for
from rpl.source import NOWHERE, Origin

PULSES_ASSUMED = code(
    "pulses-assumed",
    Severity.WARNING,
    "the controller of {robot} counts no pulses; positions in pulses take {scale:g} per degree",
    "a neutral scale for the emulator and for comparing; such numbers never drive a real arm",
)
STATION_PULSES = code(
    "station-pulses",
    Severity.WARNING,
    "external axis {number} is given in pulses, and nobody has said how many make a degree or mm; it moves by as many "
    "degrees or mm",
    "`pulses` of the axis of its [[mechanism]] says it",
)
EXTERNAL = tuple(ir.COMPONENTS[ir.ExternalType])
_COUNTING = ("joints_from_pulses", "joint_pulses")


def report_assumed(program: ir.Program, arm: Arm, diagnostics: Diagnostics) -> None:
    """Say it once where a program in pulses is for an arm whose own controller counts none."""
    if arm.pulses_per_degree is not None or arm.pulse_scale is None:
        return
    counted = (
        node for node in walk_for({"Builtin"}, program) if isinstance(node, ir.Builtin) and node.function in _COUNTING
    )
    first = next(counted, None)
    if first is not None:
        assumed(arm, diagnostics, first.origin)


def report_stations(program: ir.Program, arm: Arm, diagnostics: Diagnostics) -> None:
    """Say once which external axes a run takes in pulses as if they were degrees or mm. `arm`: with all mechanisms."""
    told: set[int] = set()
    for node in walk_for({"function external_from_pulses"}, program):
        if not isinstance(node, ir.Builtin) or node.function != "external_from_pulses":
            continue
        given = node.arguments[0]
        for name, count in given.entries if isinstance(given, ir.Aggregate) else ():
            number = EXTERNAL.index(name) + 1 if name in EXTERNAL else 0
            known = number and arm.external_pulses(number) is not None
            if number and number not in told and not known and count_of(count) != 0.0:
                told.add(number)
                diagnostics.report(STATION_PULSES, count.origin, number=number)


def assumed(arm: Arm, diagnostics: Diagnostics, origin: Origin = NOWHERE) -> None:
    """The report of a neutral scale."""
    diagnostics.report(PULSES_ASSUMED, origin, robot=arm.name, scale=float(arm.pulse_scale[0]))


def count_of(count: ir.Expression) -> float | None:
    """A count of pulses that is written as a number."""
    match count:
        case ir.IntLiteral(value=value) | ir.RealLiteral(value=value):
            return float(value)
        case ir.Unary(op="-", operand=operand):
            inner = count_of(operand)
            return None if inner is None else -inner
    return None

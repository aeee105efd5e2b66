"""Positions in motor pulses become joints in degrees, by the pulses per degree of the arm the source was written for.

Only a controller that counts in pulses has a name for this; for every other target the numbers must be made degrees,
which needs the arm. Without its data the functions stay, and the writer reports them; an arm whose own controller does
not count pulses has a neutral scale, which is reported. The external axes of a taught point are put into it here, too.
"""

from __future__ import annotations

from collections.abc import Sequence

from rpl import ir
from rpl.passes import rigid
from rpl.passes.legalise.context import Arm, Context
from rpl.passes.legalise.facts.motion.pulsecounts import EXTERNAL, count_of, report_assumed
from rpl.passes.legalise.kinds import rewrite_for
from rpl.passes.legalise.stages import legalising

_FUNCTIONS = ("joints_from_pulses", "joint_pulses", "external_from_pulses", "with_external")
_ACTS_ON = frozenset(f"function {one}" for one in _FUNCTIONS)


@legalising(sees=_ACTS_ON)
def fold_pulses(program: ir.Program, context: Context) -> ir.Program:
    """The program without pulses, as far as the arm is known."""
    if context.robot is not None:
        report_assumed(program, context.robot, context.diagnostics)
    return pulses_as_joints(program, context.robot)


def pulses_as_joints(program: ir.Program, arm: Arm | None) -> ir.Program:
    """The same, with nothing reported."""
    each = arm.pulse_scale if arm is not None else None
    ratios = None if each is None else [float(number) for number in each]
    return rewrite_for(_ACTS_ON, program, lambda node: _folded(node, ratios, arm))


def _folded(node: object, ratios: Sequence[float] | None, arm: Arm | None) -> object:
    match node:
        case ir.Builtin(function="joints_from_pulses", arguments=pulses):
            return _joints(node, pulses, ratios)
        case ir.Builtin(function="joint_pulses", arguments=(joints, ir.IntLiteral(value=number))):
            if ratios is None or not 1 <= number <= len(ratios):
                return node
            angle = ir.Field(joints, ir.AXES[number - 1], origin=node.origin)
            count = ir.Binary("*", angle, ir.RealLiteral(ratios[number - 1]), origin=node.origin)
            return ir.Convert("round_half_away", count, origin=node.origin)
        case ir.Builtin(function="external_from_pulses", arguments=(ir.Aggregate() as counts,)):
            return _external(node, counts, arm)
        case ir.Builtin(function="with_external", arguments=(ir.Aggregate() as position, ir.Aggregate() as axes)):
            given = {name for name, _ in axes.entries}
            kept = tuple(entry for entry in position.entries if entry[0] not in given)
            return ir.Aggregate((*kept, *axes.entries), position.type_name, origin=position.origin)
    return node


def _joints(
    node: ir.Builtin, pulses: tuple[ir.Expression, ...], ratios: Sequence[float] | None
) -> ir.Builtin | ir.Aggregate:
    """An aggregate of joints. The zero position is known without any data of the arm."""
    entries: list[tuple[str | None, ir.Expression]] = []
    for place, (name, count) in enumerate(zip(ir.AXES, pulses, strict=False)):
        ratio = ratios[place] if ratios is not None and place < len(ratios) else None
        number = count_of(count)
        if number == 0.0:
            angle: ir.Expression = ir.RealLiteral(0.0, origin=count.origin)
        elif ratio is None:
            return node
        elif number is not None:
            angle = ir.RealLiteral(rigid.clean(number / ratio), origin=count.origin)
        else:
            angle = ir.Binary("/", count, ir.RealLiteral(ratio), origin=count.origin)
        entries.append((name, angle))
    return ir.Aggregate(tuple(entries), "joints", origin=node.origin)


def _external(node: ir.Builtin, counts: ir.Aggregate, arm: Arm | None) -> ir.Builtin | ir.Aggregate:
    """External axes in degrees or mm. Their zero is known without any data."""
    entries: list[tuple[str | None, ir.Expression]] = []
    for name, count in counts.entries:
        number = count_of(count)
        each = arm.external_pulses(EXTERNAL.index(name) + 1) if arm is not None and name in EXTERNAL else None
        if number is None or (each is None and number != 0.0):
            return node
        value = 0.0 if each is None else rigid.clean(number / each)
        entries.append((name, ir.RealLiteral(value, origin=count.origin)))
    return ir.Aggregate(tuple(entries), "external", origin=node.origin)

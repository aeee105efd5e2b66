"""Corners in the measure of another controller: by percent (FANUC CNT) or by speed (V+) as the target measures them.

For targets whose moves have zones or modal blends. A size in percent that goes with a distance for path moves is that
distance. A corner that begins where the braking would begin is v^2 / 2a long where the target cannot say it by speed.
The measure of joint moves is another one everywhere; a corner by speed gets a fifth of the largest one there.
"""

from __future__ import annotations

from dataclasses import replace

from rpl import ir
from rpl.diagnostics import Severity, code
from rpl.passes.legalise.context import Context, rules_of
from rpl.passes.legalise.facts.settingsinforce import SettingsInForce
from rpl.passes.legalise.kinds import walk_for
from rpl.passes.legalise.rewriting.editing import edit_all, map_body
from rpl.passes.legalise.rewriting.formulas import plain
from rpl.passes.legalise.rewriting.jumps import inside
from rpl.passes.legalise.rewriting.settingwords import JOINT_BLEND
from rpl.passes.legalise.settings.explicit import JOINT_SPEED_BLEND
from rpl.passes.legalise.stages import legalising
from rpl.passes.percents import ZONE_MM_PER_PERCENT

PROCESS = code(
    "process-move",
    Severity.WARNING,
    "a move that keeps the tool's speed constant is written as a path move, which may slow down at its corners",
)
# What a controller brakes with that says nothing, mm/s2: the emulator's value.
_BRAKING_MM_S2 = 5000.0


@legalising(unless=lambda context: context.capabilities.settings.of_moves)
def corners(program: ir.Program, context: Context) -> ir.Program:
    """The program with corners that the target can measure."""
    if not any(_foreign(node) for node in walk_for({"Move"}, *program.modules)):
        return program
    return edit_all(program, _Corners(program, context).body)


def _foreign(node: object) -> bool:
    """Is it a process move, or one with a corner of a size of its own, in percent or by speed?"""
    if not isinstance(node, ir.Move):
        return False
    match node.blend:
        case ir.BlendPercent(percent=size) | ir.BlendSpeed(percent=size):
            return not isinstance(size, ir.System)
    return node.motion_class == "process"


class _Corners:
    def __init__(self, program: ir.Program, context: Context) -> None:
        self.context = context
        self.defaults = dict(rules_of(context.source).system_defaults)
        self.flow = SettingsInForce.of(program, self.defaults)
        self.settings = context.capabilities.system_variables
        self.reported: set[str] = set()

    def body(self, body: ir.Body) -> ir.Body:
        return map_body(body, self.statement)

    def statement(self, statement: ir.Statement) -> ir.Body:
        if isinstance(statement, ir.Move) and _foreign(statement):
            done = replace(statement, blend=self.corner(statement))
            return (self.classic(done) if done.motion_class == "process" else done,)
        return (inside(statement, self.body),)

    def classic(self, move: ir.Move) -> ir.Move:
        if "process" not in self.reported:
            self.reported.add("process")
            self.context.diagnostics.report(PROCESS, move.origin)
        return replace(move, motion_class="classic")

    def corner(self, move: ir.Move) -> ir.Blend | None:
        match move.blend:
            case ir.BlendPercent(percent=percent) if move.kind == "joint":
                return self.joint(move, percent)
            case ir.BlendPercent(path=ir.BlendDistance(distance=distance)) if distance is not None:
                return self.distance(move, distance)
            case ir.BlendPercent(percent=percent):
                return self.distance(move, _times(plain(percent), ZONE_MM_PER_PERCENT))
            case ir.BlendSpeed(percent=percent) if move.kind == "joint":
                return self.joint(move, _times(plain(percent), JOINT_SPEED_BLEND))
            case ir.BlendSpeed(percent=percent) if "blend_speed" not in self.settings:
                return self.by_speed(move, plain(percent))
        return move.blend

    def joint(self, move: ir.Move, percent: ir.Expression) -> ir.Blend:
        """A corner of a joint move, of this part of the largest one."""
        percent = plain(percent)
        if "blend_joint" in self.settings:
            shown = f"{percent.value:g} percent" if isinstance(percent, ir.RealLiteral) else "a computed part"
            if percent != ir.RealLiteral(0.0):
                self.report(move, f"{shown} of the largest corner of joint moves")
            return ir.BlendPercent(percent)
        return self.distance(move, _times(percent, ZONE_MM_PER_PERCENT))

    def distance(self, move: ir.Move, distance: ir.Expression) -> ir.Blend:
        size = plain(distance)
        if isinstance(size, ir.RealLiteral) and size.value == 0:
            return ir.BlendStop()
        self.report(move, f"{size.value:g} mm" if isinstance(size, ir.RealLiteral) else "a computed size")
        return ir.BlendDistance(size)

    def report(self, move: ir.Move, size: str) -> None:
        """Each size once."""
        if size not in self.reported:
            self.reported.add(size)
            self.context.diagnostics.report(JOINT_BLEND, move.origin, size=size)

    def by_speed(self, move: ir.Move, percent: ir.Expression) -> ir.Blend:
        """The way in which the move brakes from that part of its speed."""
        own = {place.name: value for place, value in move.settings if isinstance(place, ir.System)}
        speed = own.get("path_speed") or (move.speed.path if move.speed is not None else None)
        speed = plain(speed or self.flow.at(move).get("path_speed") or ir.System("path_speed"))
        braking = self.defaults.get("path_acceleration", _BRAKING_MM_S2)
        effort = self.effort(move, own) / 100.0
        if not isinstance(percent, ir.RealLiteral) or effort <= 0.0:
            return self.distance(move, _times(percent, JOINT_SPEED_BLEND * ZONE_MM_PER_PERCENT))
        factor = (percent.value / 100.0) ** 2 / (2.0 * float(braking) * effort)
        if isinstance(speed, ir.RealLiteral):
            return self.distance(move, ir.RealLiteral(float(f"{speed.value**2 * factor:.6g}")))
        return self.distance(move, _times(ir.Binary("*", speed, speed), float(f"{factor:.6g}")))

    def effort(self, move: ir.Move, own: dict[str, ir.Expression]) -> float:
        """Acceleration of the move in percent, as far as it is known."""
        value = own.get("acceleration_percent") or move.acceleration
        number = plain(value) if value is not None else None
        return number.value if isinstance(number, ir.RealLiteral) else 100.0


def _times(value: ir.Expression, factor: float) -> ir.Expression:
    if isinstance(value, ir.RealLiteral):
        return ir.RealLiteral(float(f"{value.value * factor:.12g}"))
    return ir.Binary("*", value, ir.RealLiteral(factor))


__all__ = ["corners"]

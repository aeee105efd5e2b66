"""Speeds and accelerations of moves in the measures that the target has.

An axis speed in deg/s becomes percent of the axes' maximum and back, by the fastest axis of the arm: never faster than
programmed, exact for a move that this axis leads. Without an arm a usual maximum stands for it. What a target has no
word for in a move's acceleration is left out and reported once.
"""

from __future__ import annotations

from dataclasses import replace

from rpl import ir
from rpl.diagnostics import Code, Severity, code
from rpl.passes.legalise.context import Context
from rpl.passes.legalise.rewriting.settingwords import DROPPED
from rpl.passes.legalise.rewriting.walk import Rewriter
from rpl.passes.legalise.stages import legalising

AXIS_SPEED = code(
    "axis-speed-in-percent",
    Severity.WARNING,
    "the speed of the leading axis is written in percent of {maximum:g} deg/s, the fastest axis of {arm}",
)
PERCENT_SPEED = code(
    "percent-as-axis-speed",
    Severity.WARNING,
    "percent of the axes' speed are written as a speed of the leading axis, of {maximum:g} deg/s, the fastest of {arm}",
)
# Fields of Speed that targets say which do not list them: what there was before other languages came.
USUAL = frozenset(("profile", "path", "rotation", "joint", "duration"))
# Maximum of an axis where no arm is named, deg/s: a usual one for arms of middle size.
USUAL_AXIS_DEG_S = 180.0
_ACCELERATIONS = {"path_acceleration": "path acceleration", "axis_acceleration": "axis acceleration"}


@legalising()
def fit_speeds(program: ir.Program, context: Context) -> ir.Program:
    """Every target; most programs stay as they are."""
    return _Speeds(program, context, context.capabilities.settings.speeds or USUAL).program()


class _Speeds(Rewriter):
    def __init__(self, program: ir.Program, context: Context, says: frozenset[str]) -> None:
        super().__init__(program, context)
        self.says = says
        self.reported: set[tuple[Code, str]] = set()
        arm = context.to_robot or context.robot
        self.arm = arm.name if arm is not None else "a usual arm"
        self.maximum = USUAL_AXIS_DEG_S if arm is None else float(max(arm.speeds))

    def report_once(self, what: Code, statement: ir.Statement, key: str, **arguments: object) -> None:
        if (what, key) not in self.reported:
            self.reported.add((what, key))
            self.context.diagnostics.report(what, statement.origin, **arguments)

    def statement(self, statement: ir.Statement) -> list[ir.Statement]:
        if isinstance(statement, ir.Move) and statement.speed is not None:
            speed = self.fitted(statement, statement.speed)
            if speed is not statement.speed:
                return [replace(statement, speed=None if speed == ir.Speed() else speed)]
        return [statement]

    def actions(self, body: ir.Body) -> ir.Body:
        return body

    def fitted(self, move: ir.Move, speed: ir.Speed) -> ir.Speed:
        for name, words in _ACCELERATIONS.items():
            if getattr(speed, name) is not None and name not in self.says:
                self.report_once(DROPPED, move, name, name=words)
                speed = replace(speed, **{name: None})
        if speed.axis is not None and "axis" not in self.says:
            if move.kind == "joint" and speed.joint is None:
                self.report_once(AXIS_SPEED, move, "", maximum=self.maximum, arm=self.arm)
                speed = replace(speed, joint=scaled(speed.axis, 100.0 / self.maximum, 100.0))
            elif move.kind != "joint":
                self.report_once(DROPPED, move, "axis", name="the axes' speed on a path")
            speed = replace(speed, axis=None)
        if speed.joint is not None and "joint" not in self.says and "axis" in self.says:
            self.report_once(PERCENT_SPEED, move, "", maximum=self.maximum, arm=self.arm)
            speed = replace(speed, joint=None, axis=scaled(speed.joint, self.maximum / 100.0, self.maximum))
        return speed


def scaled(value: ir.Expression, factor: float, most: float) -> ir.Expression:
    """value times factor, at most `most`; literals are computed, in decimal-clean form."""
    match value:
        case ir.Quantity(value=inner, unit=unit):
            return scaled(inner, factor * ir.UNITS[unit], most)
        case ir.RealLiteral(value=number) | ir.IntLiteral(value=number):
            return ir.RealLiteral(min(most, float(f"{number * factor:.6g}")), origin=value.origin)
    product = ir.Binary("*", value, ir.RealLiteral(float(f"{factor:.12g}")), origin=value.origin)
    return ir.Builtin("min", (ir.RealLiteral(most), product), origin=value.origin)

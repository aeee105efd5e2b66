"""Taught points of a job as constants, and saved values of position variables as first values.

A taught point of the arm is named as in the job (C00001). Positions of base axes and stations taught at the same step
(BC00001, EC00001) become its external axes: e1 ... for the base, then the station.
"""

from __future__ import annotations

from dataclasses import dataclass, field

from rpl import ir
from rpl.diagnostics import Diagnostics, Severity, code
from rpl.source import Origin

from .jobs import ANGLE, POSE, PULSE, Job, Point
from .kinds import Kind, kind_of_point
from .rules import FIELDS

STATION_PULSES = code(
    "inform-station-pulses",
    Severity.WARNING,
    "positions of base axes and stations are given in pulses, whose length is not known here; they are kept as numbers",
)
NOT_TAUGHT = code("inform-no-point", Severity.ERROR, "{name} is not among the points of this job")

_POSE_FIELDS = ("x", "y", "z", "c", "b", "a")
_JOINT_FIELDS = ("j1", "j2", "j3", "j4", "j5", "j6")
Literal = ir.IntLiteral | ir.RealLiteral


def real(literal: Literal) -> ir.Expression:
    """A coordinate as a real number, keeping its spelling."""
    if isinstance(literal, ir.RealLiteral):
        return literal
    return ir.RealLiteral(float(literal.value), origin=literal.origin)


def value_of_point(point: Point, external: tuple[Literal, ...] = ()) -> ir.Expression:
    """A point as an expression: a target, joints, or joints from pulses."""
    values, origin = point.line.values, point.line.origin
    beyond = tuple((f"e{n}", real(value)) for n, value in enumerate((*values[6:], *external)[:6], 1))
    if point.form == POSE:
        entries: list[tuple[str | None, ir.Expression]] = [
            (name, real(value)) for name, value in zip(_POSE_FIELDS, values, strict=False)
        ]
        entries.extend((name, ir.IntLiteral(flag)) for name, flag in zip(FIELDS, point.flags, strict=False))
        return ir.Aggregate((*entries, *beyond), origin=origin)
    if point.form == ANGLE:
        joints = tuple((name, real(value)) for name, value in zip(_JOINT_FIELDS, values, strict=False))
        return ir.Aggregate((*joints, *beyond), origin=origin)
    pulses: ir.Expression = ir.Builtin("joints_from_pulses", (*values, *_missing(values))[:6], origin=origin)
    if beyond:
        pulses = ir.Builtin("with_external", (pulses, ir.Aggregate(beyond, "external", origin=origin)), origin=origin)
    return pulses


def _missing(values: tuple[Literal, ...]) -> tuple[Literal, ...]:
    """Arms with fewer than six axes have fewer values."""
    return (ir.IntLiteral(0),) * max(0, 6 - len(values))


def external_value(values: tuple[Literal, ...], origin: Origin) -> ir.Expression:
    entries = tuple((f"e{n}", real(value)) for n, value in enumerate(values[:6], 1))
    return ir.Aggregate(entries, origin=origin)


def type_of_point(point: Point) -> ir.Type:
    if point.line.bank in ("EC", "BC", "EX", "BP", "RC"):
        return ir.ExternalType()
    return ir.TargetType("inform") if point.form == POSE else ir.JointsType()


@dataclass(slots=True)
class Points:
    """The taught points of one job, as they are used."""

    job: Job
    diagnostics: Diagnostics
    made: dict[str, ir.Variable] = field(default_factory=dict)
    used: set[tuple[str, int]] = field(default_factory=set)
    first: dict[int, tuple[int | None, int | None]] = field(default_factory=dict)
    warned: bool = False

    def taught(
        self, number: int, base: int | None, station: int | None, origin: Origin
    ) -> tuple[ir.Expression, Kind] | None:
        """The name of a taught point with its base axes and station; None (reported) when the header has none."""
        point = self.find("C", number, origin)
        if point is None:
            return None
        with_axes = (base, station)
        name = f"C{number:05d}"
        if self.first.setdefault(number, with_axes) != with_axes:
            name += "".join(f"_{bank}{n:05d}" for bank, n in (("BC", base), ("EC", station)) if n is not None)
        external: tuple[Literal, ...] = ()
        for bank, each in (("BC", base), ("EC", station)):
            further = self.find(bank, each, origin) if each is not None else None
            if further is not None:
                external += self.axes(further)
        if name not in self.made:
            self.declare(name, point, value_of_point(point, external))
        return ir.Name(name, origin=origin), kind_of_point(point.form, point.frame, point.tool, origin)

    def station(self, bank: str, number: int, origin: Origin) -> ir.Expression | None:
        """A station's own point."""
        point = self.find(bank, number, origin)
        if point is None:
            return None
        name = f"{bank}{number:05d}"
        if name not in self.made:
            self.declare(name, point, external_value(self.axes(point), point.line.origin))
        return ir.Name(name, origin=origin)

    def axes(self, point: Point) -> tuple[Literal, ...]:
        if point.form == PULSE and any(value.value for value in point.line.values) and not self.warned:
            self.warned = True
            self.diagnostics.report(STATION_PULSES, point.line.origin)
        return point.line.values

    def find(self, bank: str, number: int, origin: Origin) -> Point | None:
        point = self.job.points.get((bank, number))
        if point is None:
            self.diagnostics.report(NOT_TAUGHT, origin, name=f"{bank}{number:05d}")
            return None
        self.used.add((bank, number))
        return point

    def declare(self, name: str, point: Point, value: ir.Expression) -> None:
        origin = point.line.origin
        self.made[name] = ir.Variable(name, type_of_point(point), value, "constant", "routine", origin=origin)

    def declarations(self) -> tuple[ir.Variable, ...]:
        """All taught points, those that no instruction uses too, in the order of the header."""
        for (bank, number), point in self.job.points.items():
            if bank in ("C", "BC", "EC", "RC") and (bank, number) not in self.used:
                if bank == "C":
                    self.declare(f"C{number:05d}", point, value_of_point(point))
                else:
                    self.declare(f"{bank}{number:05d}", point, external_value(self.axes(point), point.line.origin))
        return tuple(sorted(self.made.values(), key=lambda made: made.origin.start))

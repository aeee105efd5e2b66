"""Taught points of a job as constants, and saved values of position variables as first values.

A taught point of the arm is named as in the job (C00001). Positions of base axes and stations taught at the same step
(BC00001, EC00001) become its external axes: e1 ... for the base, then the station. Their pulses stay pulses
(`external_from_pulses`) until a mechanism says how many make a degree or mm.
"""

from __future__ import annotations

from dataclasses import dataclass, field, replace

from rpl import ir
from rpl.diagnostics import Diagnostics, Severity, code
from rpl.source import Origin

from . import tables
from .jobs import ANGLE, POSE, PULSE, Job, Point
from .kinds import Kind, kind_of_point

NOT_TAUGHT = code("inform-no-point", Severity.ERROR, "{name} is not among the points of this job")

Literal = ir.IntLiteral | ir.RealLiteral


def real(literal: Literal) -> ir.Expression:
    """A coordinate as a real number, keeping its spelling."""
    if isinstance(literal, ir.RealLiteral):
        return literal
    return ir.RealLiteral(float(literal.value), origin=literal.origin)


@dataclass(frozen=True, slots=True)
class Axis:
    """The value of one base axis or of one axis of a station."""

    value: Literal
    pulses: bool = False


Entries = tuple[tuple[str, ir.Expression], ...]


def value_of_point(point: Point, external: tuple[Axis, ...] = ()) -> ir.Expression:
    """A point as an expression: a target, joints, or joints from pulses; with external axes where it has some."""
    axes = (*(Axis(value) for value in point.line.values[6:]), *external)
    beyond, counted = _entries(axes)
    value = _of_arm(point, beyond)
    return value if not counted else _with(value, _from_pulses(counted, point.line.origin))


def _entries(axes: tuple[Axis, ...]) -> tuple[Entries, Entries]:
    """Axes in degrees or mm, and those in pulses, by their names."""
    named = [(f"e{number}", axis) for number, axis in enumerate(axes[:6], 1)]
    plain = tuple((name, real(axis.value)) for name, axis in named if not axis.pulses)
    return plain, tuple((name, real(axis.value)) for name, axis in named if axis.pulses)


def _with(value: ir.Expression, external: ir.Expression) -> ir.Expression:
    """The type of an argument does not follow from its place: it says its own."""
    if isinstance(value, ir.Aggregate) and value.type_name is None:
        names = {name for name, _ in value.entries}
        word = "target inform" if "x" in names else "joints" if "j1" in names else "external"
        value = replace(value, type_name=word)
    return ir.Builtin("with_external", (value, external), origin=value.origin)


def _from_pulses(counted: Entries, origin: Origin) -> ir.Expression:
    return ir.Builtin("external_from_pulses", (ir.Aggregate(counted, "external", origin=origin),), origin=origin)


def _of_arm(point: Point, beyond: Entries) -> ir.Expression:
    values, origin = point.line.values, point.line.origin
    if point.form == POSE:
        entries: list[tuple[str | None, ir.Expression]] = [
            (name, real(value)) for name, value in zip(tables.POSE_ELEMENTS, values, strict=False)
        ]
        entries.extend((name, ir.IntLiteral(flag)) for name, flag in zip(tables.POSTURE, point.flags, strict=False))
        return ir.Aggregate((*entries, *beyond), origin=origin)
    if point.form == ANGLE:
        joints = tuple((name, real(value)) for name, value in zip(tables.JOINT_ELEMENTS, values, strict=False))
        return ir.Aggregate((*joints, *beyond), origin=origin)
    pulses: ir.Expression = ir.Builtin("joints_from_pulses", (*values, *_missing(values))[:6], origin=origin)
    return _with(pulses, ir.Aggregate(beyond, "external", origin=origin)) if beyond else pulses


def _missing(values: tuple[Literal, ...]) -> tuple[Literal, ...]:
    """Arms with fewer than six axes have fewer values."""
    return (ir.IntLiteral(0),) * max(0, 6 - len(values))


def external_value(axes: tuple[Axis, ...], origin: Origin) -> ir.Expression:
    """A position of base axes or a station alone."""
    plain, counted = _entries(axes)
    value: ir.Expression = ir.Aggregate(plain, "external", origin=origin)
    if not counted:
        return value
    return _with(value, _from_pulses(counted, origin)) if plain else _from_pulses(counted, origin)


def external_variable(point: Point) -> ir.Expression:
    """The saved value of a variable for base axes or a station: as it counts, pulses too, for instructions change it in
    its own units."""
    return external_value(tuple(Axis(value) for value in point.line.values), point.line.origin)


def axes_of(point: Point) -> tuple[Axis, ...]:
    """The axes of a base or station point."""
    return tuple(Axis(value, point.form == PULSE) for value in point.line.values)


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
        external: tuple[Axis, ...] = ()
        for bank, each in (("BC", base), ("EC", station)):
            further = self.find(bank, each, origin) if each is not None else None
            if further is not None:
                external += axes_of(further)
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
            self.declare(name, point, external_value(axes_of(point), point.line.origin))
        return ir.Name(name, origin=origin)

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
                    self.declare(f"{bank}{number:05d}", point, external_value(axes_of(point), point.line.origin))
        return tuple(sorted(self.made.values(), key=lambda made: made.origin.start))

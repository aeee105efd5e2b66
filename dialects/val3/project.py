"""All files of an application to one module: its data, and a routine for each program."""

from __future__ import annotations

import re
import xml.etree.ElementTree as Xml
from collections.abc import Iterator, Sequence
from functools import cache
from math import prod
from pathlib import PurePath, PureWindowsPath

from rpl import ir
from rpl.diagnostics import Diagnostics, Severity, code
from rpl.reading.assemble import assemble
from rpl.reading.ledger import FileReport
from rpl.reading.pieces import Item
from rpl.reading.shapes import ShapeParser
from rpl.registry import ReadResult
from rpl.source import Origin, Source

from .blocks import UNKNOWN_TYPE, Builder, sized, zero
from .data import FLAGS, JOINTS, POSE, Datum, data_of
from .expressions import CONFIGURATIONS, TYPES, target
from .facts import Facts, facts_of, headers_of
from .motion import descriptor_of
from .places import pose, real
from .split import split
from .statements import Statements

DAMAGED = code("val3-damaged-file", Severity.ERROR, "this file is no whole XML: {reason}")
INCHES = code(
    "val3-inches", Severity.LOSS, "the application counts in inches, which is not read: lengths would be wrong"
)
TWICE = code("val3-data-twice", Severity.WARNING, "{name} is declared twice; the first one is read")

_START = "start"
_INCHES = re.compile(r'millimeterUnit="false"')


@cache
def _parser() -> ShapeParser:
    return ShapeParser("val3.lark")


def read(sources: Sequence[Source], diagnostics: Diagnostics) -> ReadResult:
    """Read all files of one application together."""
    found = list(_data(sources, diagnostics))
    facts = facts_of(sources, [datum for datum, _ in found])
    lowering, build = Statements(facts, diagnostics), Builder(diagnostics)
    reports: list[FileReport] = []
    items: list[Item] = []
    for source in sources:
        lowering.headers = headers_of(source)
        done = assemble(source, "val3", split(source, lowering.headers), _parser(), lowering.lower, build, diagnostics)
        reports.append(done.report)
        items.extend(done.items)
        if _INCHES.search(source.text[:4_000]):
            diagnostics.report(INCHES, Origin(source, 0, 0))
    routines = tuple(item for item in items if isinstance(item, ir.Routine))
    declared = tuple(one for datum, origin in found for one in _declared(datum, origin, facts, diagnostics))
    module = ir.Module(_name(sources), "val3", declared, routines, origin=Origin(sources[0]))
    entry = _START if any(routine.name == _START for routine in routines) else ""
    return ReadResult(ir.Program((module,), entry=entry), tuple(reports))


def _name(sources: Sequence[Source]) -> str:
    """The application's: that of its project file, else of its data."""
    for suffix in (".pjx", ".dtx", ".pgx"):
        for source in sources:
            stem = PureWindowsPath(source.path).stem
            if PurePath(source.path).suffix.lower() == suffix and stem:
                return re.sub(r"\W", "_", stem)
    return "application"


def _data(sources: Sequence[Source], diagnostics: Diagnostics) -> Iterator[tuple[Datum, Origin]]:
    seen: set[str] = set()
    for source in sources:
        try:
            for datum in data_of(source):
                origin = Origin(source, datum.start, datum.end)
                if datum.name in seen:
                    diagnostics.report(TWICE, origin, name=datum.name)
                elif datum.name not in ("world", "flange"):
                    seen.add(datum.name)
                    yield datum, origin
        except Xml.ParseError as error:
            diagnostics.report(DAMAGED, Origin(source, 0, 0), reason=str(error))


def _declared(datum: Datum, origin: Origin, facts: Facts, diagnostics: Diagnostics) -> Iterator[ir.Declaration]:
    """A datum as a variable that outlives runs. Descriptors that nothing changes stand in the movements; signals are
    those of the cell."""
    if datum.kind in ("dio", "aio") or (datum.kind == "mdesc" and datum.name not in facts.assigned):
        return
    type = TYPES.get(datum.kind)
    if type is None:
        diagnostics.report(UNKNOWN_TYPE, origin, name=datum.name, kind=datum.kind or "without a name")
        return
    initial = _value(datum, 0) if datum.sizes == (1,) else _values(datum, 0, datum.sizes)
    yield ir.Variable(datum.name, sized(type, datum.sizes), initial, "persistent", "global", origin=origin)


def _values(datum: Datum, first: int, sizes: tuple[int, ...]) -> ir.Expression | None:
    """The elements from one on as lists in lists, by these dimensions."""
    if not sizes:
        return _value(datum, first)
    size, *inner = sizes
    values = [_values(datum, first + at * prod(inner), tuple(inner)) for at in range(size)]
    return ir.Aggregate(tuple((None, value) for value in values if value is not None))


def _value(datum: Datum, index: int) -> ir.Expression | None:
    given = datum.values.get(index, {})

    def number(name: str) -> ir.Expression:
        return real(float(given.get(name, "0")))

    match datum.kind:
        case "num":
            return number("value")
        case "bool":
            return ir.BoolLiteral(given.get("value", "false") == "true")
        case "string":
            return ir.TextLiteral(given.get("value", ""))
        case "trsf" | "frame" | "tool":
            return pose(tuple(number(name) for name in POSE))
        case "joint":
            return ir.Aggregate(tuple((name, number(name)) for name in JOINTS), "joints")
        case "point":
            place = pose(tuple(number(name) for name in POSE))
            assert isinstance(place, ir.Aggregate)  # its angles are numbers
            return target(place, [CONFIGURATIONS.get(given.get(name, "")) for name in FLAGS])
        case "mdesc":
            parts = descriptor_of(datum, index)
            return ir.Aggregate(tuple((name, real(parts[name])) for name in parts))
    return zero(datum.kind)

"""What every RAPID program finds declared: speeds, zones, tool0, wobj0, error numbers, vendor functions.

Sources: reference manual, system data types (speeddata, zonedata, tooldata, wobjdata). Error numbers are names without
published values; the values here only have to differ from each other and from the 1..90 a program may raise.
"""

from __future__ import annotations

from functools import cache

from rpl import ir

from .types import NUM, TYPES
from .vendor import FUNCTION_RESULTS
from .words import WORDS

# `vN`: reorientation is 500 deg/s, external axes 5000 mm/s and 1000 deg/s.
VMAX_MM_S = 5000.0  # depends on the robot on newer controllers
ERRORS: dict[str, int] = {name: 1001 + index for index, name in enumerate(WORDS.listed("errors"))}


_TEXT = ir.StringType()
_EVENTS: tuple[tuple[str, ir.Type], ...] = (
    ("used", ir.BoolType()),
    ("distance", NUM),
    ("start", ir.BoolType()),
    ("equiplag", NUM),
    ("signalname", _TEXT),
)
_RECORDS: dict[str, tuple[tuple[str, ir.Type], ...]] = {
    "tasks": (("taskname", _TEXT),),
    "listitem": (("image", _TEXT), ("text", _TEXT)),
    "inposdata": (("position", NUM), ("speed", NUM), ("mintime", NUM), ("maxtime", NUM)),
    "stoppointdata": (
        ("type", NUM),
        ("progsynch", ir.BoolType()),
        ("inpos", ir.NamedType("inposdata")),
        ("stoptime", NUM),
        ("followtime", NUM),
        ("signal", _TEXT),
        ("relation", NUM),
        ("checkvalue", NUM),
    ),
    "triggios": (*_EVENTS, ("setvalue", NUM), ("xxx", NUM)),
    "triggiosdnum": (*_EVENTS, ("setdvalue", NUM), ("xxx", NUM)),
    "triggstrgo": (*_EVENTS, ("setvalue", _TEXT), ("xxx", NUM)),
}


def _literal(number: float) -> ir.Expression:
    whole = isinstance(number, int) or number.is_integer()
    size: ir.Expression = ir.IntLiteral(int(abs(number))) if whole else ir.RealLiteral(abs(number))
    return ir.Unary("-", size) if number < 0 else size


def _list(*values: float | ir.Expression) -> ir.Aggregate:
    entries = (value if not isinstance(value, int | float) else _literal(value) for value in values)
    return ir.Aggregate(tuple((None, entry) for entry in entries))


def _constant(name: str, type: ir.Type, value: ir.Expression, storage: str = "constant") -> ir.Variable:
    return ir.Variable(name, type, value, storage, "global")


def _speeds() -> list[ir.Variable]:
    rows = [(f"v{path}", float(path), 500.0, 5000.0, 1000.0) for path in WORDS.listed("speeds")]
    rows.append(("vmax", VMAX_MM_S, 500.0, 5000.0, 1000.0))
    rows.extend((f"vrot{turn}", 0.0, 0.0, 0.0, float(turn)) for turn in WORDS.listed("rotary_speeds"))
    rows.extend((f"vlin{way}", 0.0, 0.0, float(way), 0.0) for way in WORDS.listed("linear_speeds"))
    return [_constant(name, ir.SpeedType(), _list(*values)) for name, *values in rows]


def _zones() -> list[ir.Variable]:
    zone = ir.ZoneType()
    made = [_constant("fine", zone, _list(ir.BoolLiteral(True), 0, 0, 0, 0, 0, 0))]
    for name, sizes in WORDS.pairs("zones").items():
        made.append(_constant(name, zone, _list(ir.BoolLiteral(False), *map(float, sizes.split()))))
    return made


def _frames() -> list[ir.Variable]:
    true, false = ir.BoolLiteral(True), ir.BoolLiteral(False)
    origin, straight = _list(0, 0, 0), _list(1, 0, 0, 0)
    pose = _list(origin, straight)
    load = _list(0.001, _list(0, 0, 0.001), straight, 0, 0, 0)
    return [
        _constant("tool0", ir.ToolType(), _list(true, pose, load), "persistent"),
        _constant("wobj0", ir.WorkObjectType(), _list(false, true, ir.TextLiteral(""), pose, pose), "persistent"),
        _constant("load0", ir.LoadType(), load, "persistent"),
    ]


def _functions() -> tuple[ir.Routine, ...]:
    """Vendor functions as predefined routines that take anything; a run that reaches one has to be told its result."""
    made = []
    for name, result in FUNCTION_RESULTS.items():
        body = (ir.Vendor("rapid", f"{name}(...)", "unknown"),)
        made.append(ir.Routine(name, "function", (), TYPES[result], (), body, scope="global", open_ended=True))
    return tuple(made)


@cache
def prelude() -> ir.Module:
    """The predefined data and routines as a module."""
    stops = ir.NamedType("stoppointdata")
    declarations: tuple[ir.Declaration, ...] = (
        *_speeds(),
        *_zones(),
        *_frames(),
        *(_constant(name, NUM, _literal(value)) for name, value in WORDS.numbers("numbers").items()),
        *(_constant(name, ir.StringType(), ir.TextLiteral(text)) for name, text in WORDS.pairs("texts").items()),
        *(_constant(name, NUM, ir.IntLiteral(number)) for name, number in ERRORS.items()),
        *(ir.RecordDeclaration(name, fields, "global") for name, fields in _RECORDS.items()),
        *(ir.Variable(name, stops, None, "constant", "global") for name in WORDS.listed("stop_points")),
    )
    return ir.Module("rapid_prelude", "rapid", declarations, _functions())


PREDEFINED_NAMES = frozenset(
    declaration.name.lower() for declaration in prelude().declarations if isinstance(declaration, ir.Variable)
)

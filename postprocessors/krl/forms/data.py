"""The names of form points and the lines that forms have in the data list: FDAT beside each point, PDAT and LDAT for
each move, as the form makes them.
"""

from __future__ import annotations

from collections.abc import Collection
from dataclasses import dataclass, field, replace

from rpl import ir

from .moves import USUAL_SIZE, Form

_PREFIXES = "pj"  # what RAPID's people put in front of a taught point


def point_name(name: str, taken: Collection[str]) -> str | None:
    """The name with which a point stands in forms, whose FDAT is free too; None: there is none. `pPick` is XPick, as
    KUKA's people name points; one that begins with X keeps its name. taken: names in use, folded."""
    if name[:1] in "Xx" and len(name) > 1:
        return name if len(name) <= _MOST and f"f{name[1:]}".lower() not in taken else None
    plain = "".join(sign if sign.isascii() and (sign.isalnum() or sign == "_") else "_" for sign in name)
    bare = plain[1:] if plain[:1] in _PREFIXES and plain[1:2].isupper() else plain
    stem = f"{bare[:1].upper()}{bare[1:]}"[: _MOST - 1]
    stem = f"{stem}Pos" if f"x{stem}".lower() == _HOME else stem  # that one is every program's, and taught elsewhere
    for each in (stem, *(f"{stem[: _MOST - 3]}{number}" for number in range(2, 100))):
        if {f"x{each}".lower(), f"f{each}".lower()}.isdisjoint(taken):
            return f"X{each}"
    return None


_MOST = 24  # signs of a name
_HOME = "xhome"
HOME_DATA = "PDEFAULT"


def is_home(point: ir.Variable) -> bool:
    """Is it named as the home position, which has its FDAT (flange, robot's own base) in every $config.dat?"""
    return point.name.lower() == _HOME and isinstance(point.type, ir.JointsType)


def fits_home(form: Form, size: float | None) -> bool:
    """Does the form say what PDEFAULT says, with FHOME? size: of a corner that must stay."""
    usual = form.acceleration == 100.0 and form.corner == "blend_joint" and form.size is None and size is None
    return form.joint and (form.tool, form.base) == (0, 0) and usual


def frame_data(point: ir.Variable, tool: int, base: int) -> ir.Variable:
    """FDAT of a point."""
    entries: tuple[tuple[str, ir.Expression], ...] = (
        ("TOOL_NO", ir.IntLiteral(tool)),
        ("BASE_NO", ir.IntLiteral(base)),
        ("IPO_FRAME", ir.EnumLiteral("BASE")),
        ("POINT2", ir.TextLiteral(" ")),
        ("TQ_STATE", ir.BoolLiteral(False)),
    )
    value = ir.Aggregate(entries, type_name="FDAT")
    return ir.Variable(f"F{point.name[1:]}", ir.NamedType("FDAT"), value, "persistent", point.scope)


def motion_data(name: str, form: Form, size: float | None) -> ir.Variable:
    """PDAT or LDAT of a move. size: of the corner, also where the move drives none; None: as a new form says it."""
    distance = ir.RealLiteral(USUAL_SIZE if size is None else size)
    entries: tuple[tuple[str, ir.Expression], ...]
    if form.joint:
        mode = "CPTP" if form.corner == "blend_joint" else "CDIS"
        entries = (
            ("VEL", ir.RealLiteral(form.speed)),
            ("ACC", ir.RealLiteral(form.acceleration)),
            ("APO_DIST", distance),
            ("APO_MODE", ir.EnumLiteral(mode)),
        )
    else:
        entries = (
            ("VEL", ir.RealLiteral(form.speed)),
            ("ACC", ir.RealLiteral(form.acceleration)),
            ("APO_DIST", distance),
            ("APO_FAC", ir.RealLiteral(50.0)),
            ("ORI_TYP", ir.EnumLiteral(form.orientation)),
            ("CIRC_TYP", ir.EnumLiteral(form.arc)),
        )
    kind = "PDAT" if form.joint else "LDAT"
    return ir.Variable(name, ir.NamedType(kind), ir.Aggregate(entries, type_name=kind), "persistent")


@dataclass(slots=True)
class Numbering:
    """The names of the data of moves in one module: PPDAT1, LCPDAT1, ..., in the order of the moves. taken: names of
    the program, folded."""

    taken: Collection[str]
    last: dict[str, int] = field(default_factory=dict)

    def next(self, form: Form) -> str:
        stem = "PPDAT" if form.joint else "LCPDAT"
        number = self.last.get(stem, 0) + 1
        while f"{stem}{number}".lower() in self.taken:
            number += 1
        self.last[stem] = number
        return f"{stem}{number}"


def touchable(point: ir.Variable, own: bool) -> ir.Variable:
    """The point as the pendant may teach it anew. own: only its module uses it."""
    return replace(point, storage="persistent", scope="module" if own else point.scope)


def parts_of(move: ir.Move, form: Form, data: str, point: str) -> ir.Body:
    """The statements of a form. data: of the move; the one of HOME also says that this is the home position."""
    here, later = move.origin, replace(move.origin, comments=())
    acting, command = ("PDAT_ACT", "PTP_PARAMS") if form.joint else ("LDAT_ACT", "CP_PARAMS")
    speed = ir.IntLiteral(int(form.speed)) if form.speed == int(form.speed) else ir.RealLiteral(form.speed)
    home = (ir.Assign(ir.Name("$H_POS"), ir.Name(point), origin=later),) if data == HOME_DATA else ()
    return (
        ir.Assign(ir.Name("$BWDSTART"), ir.BoolLiteral(False), origin=here),
        ir.Assign(ir.Name(acting), ir.Name(data), origin=later),
        ir.Assign(ir.Name("FDAT_ACT"), ir.Name(f"F{point[1:]}"), origin=later),
        ir.CallRoutine("BAS", (ir.Argument(ir.EnumLiteral(command)), ir.Argument(speed)), origin=later),
        *home,
        replace(move, target=ir.Name(point), origin=later),
    )


def initialising() -> ir.CallRoutine:
    """BAS(#INITMOV,0)."""
    return ir.CallRoutine("BAS", (ir.Argument(ir.EnumLiteral("INITMOV")), ir.Argument(ir.IntLiteral(0))))


__all__ = [
    "HOME_DATA",
    "Numbering",
    "fits_home",
    "frame_data",
    "initialising",
    "is_home",
    "motion_data",
    "parts_of",
    "point_name",
    "touchable",
]

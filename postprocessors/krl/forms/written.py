"""The folds in which the pendant keeps its inline forms, as KSS 8 writes them.

`;FOLD PTP Gate Vel=50 % PDAT2 Tool[1]:fingers Base[2]:lathe;%{PE}%R 8.3.22,%MKUKATPBASIS,...` is what the pendant shows
and opens; the statements behind it are what the controller carries out.
"""

from __future__ import annotations

from collections.abc import Mapping

from rpl import ir
from rpl.passes.scope import Scope

from .. import tables
from .moves import number_of

MOST = 6  # statements of the form of a move, with the home position
_ACTING = {"PDAT_ACT": ("PTP", "PTP_PARAMS", "P"), "LDAT_ACT": ("LIN", "CP_PARAMS", "L")}
_CORNERS = {"blend_joint": "C_PTP", "blend_distance": "C_DIS"}

Words = dict[str, object]


def is_initialising(statement: ir.Statement) -> bool:
    """Is it BAS(#INITMOV,0)?"""
    match statement:
        case ir.CallRoutine(name="BAS", arguments=(ir.Argument(value=ir.EnumLiteral(member="INITMOV")), _)):
            return True
    return False


def form_words(body: ir.Body, scope: Scope, names: Mapping[tuple[str, int], str]) -> tuple[Words, int] | None:
    """What the fold of a form says that begins with this body, and how many statements are the form's; None: none does.
    names: of tools and bases."""
    match body[:MOST]:
        case (*parts, ir.Assign(target=ir.Name(id="$H_POS")), move):
            words = _words((*parts, move), scope, names)
            return None if words is None else (words | {"tool": "", "base": ""}, MOST)
    words = _words(body[: MOST - 1], scope, names)
    return None if words is None else (words, MOST - 1)


def _words(body: ir.Body, scope: Scope, names: Mapping[tuple[str, int], str]) -> Words | None:
    match body:
        case (
            ir.Assign(target=ir.Name(id="$BWDSTART")),
            ir.Assign(target=ir.Name(id=acting), value=ir.Name(id=data)),
            ir.Assign(target=ir.Name(id="FDAT_ACT"), value=ir.Name(id=frames)),
            ir.CallRoutine(name="BAS", arguments=(ir.Argument(value=ir.EnumLiteral(member=command)), given)),
            ir.Move(target=ir.Name(id=point), blend=blend),
        ) if acting in _ACTING:
            word, wanted, prefix = _ACTING[acting]
            tool, base = _number(frames, "TOOL_NO", scope), _number(frames, "BASE_NO", scope)
            fits = command == wanted and data[:1].upper() == prefix and point[:1].upper() == "X"
            if not fits or frames[1:].lower() != point[1:].lower() or None in (number_of(given.value), tool, base):
                return None
            return {
                "word": word,
                "point": point[1:],
                "corner": _corner(blend),
                "unit": "%" if word == "PTP" else "m/s",
                "data": data[1:],
                "tool": _shown(tables.SELECTED["tool"], tool, names),
                "base": _shown(tables.SELECTED["base"], base, names),
            }
    return None


def _corner(blend: ir.Blend | None) -> str:
    match blend:
        case ir.BlendPercent():
            return _CORNERS["blend_joint"]
        case ir.BlendDistance():
            return _CORNERS["blend_distance"]
    return ""


def _shown(bank: str, number: int | None, names: Mapping[tuple[str, int], str]) -> str:
    """`[1]:fingers`."""
    name = names.get((bank, number or 0), "")
    return f"[{number}]:{name}" if name else f"[{number}]"


def _number(frames: str, part: str, scope: Scope) -> int | None:
    """A number in the FDAT of a point."""
    symbol = scope.value(frames)
    declared = symbol.declaration if symbol is not None else None
    value = declared.initial if isinstance(declared, ir.Variable) else None
    for name, entry in value.entries if isinstance(value, ir.Aggregate) else ():
        if (name or "").upper() == part and isinstance(entry, ir.IntLiteral):
            return entry.value
    return None


__all__ = ["MOST", "form_words", "is_initialising"]

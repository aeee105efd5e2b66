"""Values as KRL spells them: `TRUE`, `#T1`, `"TEXT"`, `{E6AXIS: A1 0.0, A2 -90.0}`."""

from __future__ import annotations

import re

from rpl.controllers.showing import Shown

_NUMBER = re.compile(r"[+-]?(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?")
_STRUCTURE = re.compile(r"\{\s*(?:\w+\s*:)?(.*)\}", re.DOTALL)
_PART = re.compile(r"\s*(\w+(?:\[\])?)\s+(\"[^\"]*\"|\{[^}]*\}|[^,]*)\s*(?:,|$)")


def read_value(text: str) -> Shown:
    """A number, a truth value or a text; what is none of them as it is spelled."""
    bare = text.strip()
    if bare.upper() in ("TRUE", "FALSE"):
        return bare.upper() == "TRUE"
    if len(bare) >= 2 and bare[0] == bare[-1] == '"':
        return bare[1:-1]
    if _NUMBER.fullmatch(bare):
        return int(bare) if re.fullmatch(r"[+-]?\d+", bare) and len(bare) < 12 else float(bare)
    return bare


def read_structure(text: str) -> dict[str, Shown]:
    """The components of a structure, by their names in capitals; empty when it is none."""
    found = _STRUCTURE.fullmatch(text.strip())
    if found is None:
        return {}
    return {part[1].upper(): read_value(part[2]) for part in _PART.finditer(found[1])}


def spelled(value: object) -> str:
    """A number, a truth value or a text in KRL."""
    if isinstance(value, bool):
        return "TRUE" if value else "FALSE"
    if isinstance(value, float):
        return f"{round(value, 5) + 0.0:.5f}" if abs(value) < 1e9 else f"{value:.6e}"
    return str(value) if isinstance(value, int) else f'"{value}"'


def structure(name: str, parts: dict[str, float]) -> str:
    """`{NAME: X 1.0, Y 2.0}`."""
    return f"{{{name}: {', '.join(f'{part} {spelled(number)}' for part, number in parts.items())}}}"

"""Variable dumps of a controller (`.VA`): numeric, string and position registers, frames, payload schedules.

NUMREG.VA `[1] = 1  'count'`, STRREG.VA `[1] = 'text'  'comment'`, POSREG.VA `[1,5] = 'pick'` followed by a joint or
Cartesian position, SYSFRAME.VA the same for $MNUFRAME and $MNUTOOL, SYSMOTN.VA or SYSVARS.VA the fields of $PLST_GRP1
(the load of each PAYLOAD number). Laid out as public backups show it.
"""

from __future__ import annotations

import re
from dataclasses import dataclass, field

from rpl.diagnostics import Diagnostics, Severity, code
from rpl.source import Origin, Source

from .configtext import parse_config
from .positions import Group, Position

BAD_VALUE = code(
    "tp-bad-value",
    Severity.ERROR,
    "the value of {name} cannot be read: {text}",
    "take the dump from the controller anew",
)
_VARIABLE = re.compile(r"^\s*\[\*?(\w+)\*?\]\s*(\$\w+)([^\n]*)", re.MULTILINE)
_ELEMENT = re.compile(r"^\s*\[\s*([\d, ]+)\]\s*=?([^\n]*)", re.MULTILINE)
_QUOTED = re.compile(r"'([^']*)'")
_NUMBER = re.compile(r"[+-]?(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?")
_VALUE = re.compile(r"\b([XYZWPR]|J\d|EXT\d|E\d)\s*[:=]\s*(\*+|[+-]?(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?)")
_FIELD = re.compile(
    r"^\s*Field:\s*\$PLST_GRP1\[(\d+)\]\.\$PAYLOAD(_I?[XYZ])?\s[^\n=]*=\s*([+-]?[\d.]+(?:[eE][+-]?\d+)?)", re.MULTILINE
)
_CONFIG = re.compile(r"Config\s*:\s*([^\n]*)", re.IGNORECASE)


@dataclass(slots=True)
class Dump:
    """Everything the dumps of a project say; labels by (bank, number)."""

    numbers: dict[int, tuple[float, bool, Origin]] = field(default_factory=dict)  # value, is whole
    texts: dict[int, tuple[str, Origin]] = field(default_factory=dict)
    positions: dict[int, tuple[Position, Origin]] = field(default_factory=dict)
    frames: dict[tuple[str, int], tuple[Position, Origin]] = field(default_factory=dict)
    active: dict[str, int] = field(default_factory=dict)
    loads: dict[int, dict[str, float]] = field(default_factory=dict)  # by number: M kg, X Y Z mm, IX IY IZ kg m2
    labels: dict[tuple[str, int], str] = field(default_factory=dict)


def is_dump(text: str) -> bool:
    """Is the text a variable dump with registers, frames or loads?"""
    return re.search(r"^\s*\[\*(?:NUMREG|POSREG|STRREG)\*\]|^\s*\[\*SYSTEM\*\]\$(?:MN(?:UFRAME|UTOOL)|PLST_GRP1)\b",
                     text, re.MULTILINE) is not None  # fmt: skip


def read_dump(source: Source, into: Dump, diagnostics: Diagnostics) -> int:
    """Take over what a dump says. Gives the number of values read; one that cannot be read is reported."""
    text = source.text
    heads = list(_VARIABLE.finditer(text))
    count = 0
    for place, head in enumerate(heads):
        end = heads[place + 1].start() if place + 1 < len(heads) else len(text)
        name = head[2].upper()
        if name in ("$NUMREG", "$STRREG", "$POSREG", "$MNUFRAME", "$MNUTOOL", "$MNUFRAMENUM", "$MNUTOOLNUM"):
            count += _elements(source, name, head.end(), end, into, diagnostics)
        elif name == "$PLST_GRP1":
            count += _loads(text[head.end() : end], into)
    return count


def _loads(text: str, into: Dump) -> int:
    """The payload schedules of the first group. M: centres are in cm and inertias in kg cm2; a mass of no more than 0
    stands for a schedule that nobody has filled in."""
    fields = _FIELD.findall(text)
    for number, name, value in fields:
        scale = 1e-4 if name.startswith("_I") else 10.0 if name else 1.0
        into.loads.setdefault(int(number), {})[name.removeprefix("_") or "M"] = float(value) * scale
    return len(fields)


def _elements(source: Source, name: str, begin: int, end: int, into: Dump, diagnostics: Diagnostics) -> int:
    text = source.text
    marks = list(_ELEMENT.finditer(text, begin, end))
    for place, mark in enumerate(marks):
        stop = marks[place + 1].start() if place + 1 < len(marks) else end
        indices = [int(number) for number in re.findall(r"\d+", mark[1])]
        origin = Origin(source, mark.start() + len(mark[0]) - len(mark[0].lstrip()), mark.end())
        if not _take(name, indices, mark[2], text[mark.end() : stop], origin, into):
            diagnostics.report(BAD_VALUE, origin, name=f"{name}[{mark[1].strip()}]", text=mark[2].strip()[:60])
    return len(marks)


def _take(name: str, indices: list[int], line: str, rest: str, origin: Origin, into: Dump) -> bool:
    """Take over one element; False when its value cannot be read."""
    number = indices[-1]
    quoted = _QUOTED.findall(line)
    if name == "$NUMREG":
        found = _NUMBER.match(line.strip())
        if found is None or ((behind := line.strip()[found.end() :]) and behind[0] not in " \t'"):
            return not line.strip() or "Uninitialized" in line or line.strip().startswith("*")
        into.numbers[number] = (float(found[0]), "." not in found[0], origin)
        _label(into, "R", number, quoted)
    elif name == "$STRREG":
        if quoted and "Uninitialized" not in line:
            into.texts[number] = (quoted[0], origin)
        _label(into, "SR", number, quoted[1:])
    elif name in ("$MNUFRAMENUM", "$MNUTOOLNUM"):
        found = _NUMBER.match(line.strip())
        if found and number == 1:
            into.active["UFRAME_NUM" if name == "$MNUFRAMENUM" else "UTOOL_NUM"] = int(float(found[0]))
    elif len(indices) == 2 and indices[0] == 1:
        position = _position(number, line + "\n" + rest)
        if name == "$POSREG":
            _label(into, "PR", number, quoted)
            if position is not None:
                into.positions[number] = (position, origin)
        elif position is not None:
            into.frames["UFRAME" if name == "$MNUFRAME" else "UTOOL", number] = (position, origin)
        return position is not None or "Uninitialized" in line + rest or "*" in rest
    return True


def _label(into: Dump, bank: str, number: int, quoted: list[str]) -> None:
    if quoted and quoted[0].strip():
        into.labels[bank, number] = quoted[0].strip()


def _position(number: int, text: str) -> Position | None:
    if "Uninitialized" in text.partition("\n")[0]:
        return None
    values: dict[str, float | None] = {}
    for name, given in _VALUE.findall(_QUOTED.sub("", text)):
        values[name.replace("EXT", "E")] = None if given.startswith("*") else float(given)
    values = {name: value for name, value in values.items() if not (name.startswith("E") and value is None)}
    if "X" not in values and "J1" not in values:
        return None
    config = _CONFIG.search(text)
    flags = parse_config(config[1]) if config else None
    return Position(number, "", {1: Group(values, None, None, flags or {})})

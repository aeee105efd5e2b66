"""What a backup of a controller has: jobs, variables and signals in use, tools and user frames (TOOL.CND, UFRAME.CND).

Variables of a controller have no comments in these files; what jobs name is in use.
"""

from __future__ import annotations

import re
from collections.abc import Sequence
from pathlib import PurePosixPath

from rpl import ir
from rpl.diagnostics import Diagnostics
from rpl.ir.standing import Standing
from rpl.registry import words
from rpl.source import Source

from .dumps import Dump, is_dump, read_dump

_NAME = re.compile(r"^//NAME[ \t]+(\S+)", re.MULTILINE)
_VARIABLE = re.compile(r"(?<![\w#])([BIDRSP])(\d{3})(?!\d)")
_CHOSEN = re.compile(r"(?<![\w#])([BIDRSP])\[\s*\D")
_ELEMENT = re.compile(r"(?<![\w#])([BIDRSP])\[\s*(\d+)\s*\]")
_SIGNAL = re.compile(r"\b([A-Z]{2})#\((\d+)\)")
_SELECTED = re.compile(r"\b(TL|UF)#\((\d+)\)|^///(TOOL|USER)[ \t]+(\d+)", re.MULTILINE)
_KINDS = words("inform").pairs("signals")
_BANKS = {"TOOL": "TL", "USER": "UF"}


def standing(sources: Sequence[Source]) -> Standing:
    """All files of the backup together."""
    dump = Dump()
    names: dict[str, str] = {}
    numbers: dict[tuple[str, int], str] = {}
    signals: dict[tuple[str, int], str] = {}
    computed: set[str] = set()
    for source in sources:
        if is_dump(source.text):
            read_dump(source, dump, Diagnostics())
            continue
        named = _NAME.search(source.text)
        names[(named[1] if named else PurePosixPath(source.path).stem).lower()] = source.path
        numbers |= {(bank, int(number)): "" for bank, number in _VARIABLE.findall(source.text)}
        numbers |= {(bank, int(number)): "" for bank, number in _ELEMENT.findall(source.text)}
        computed.update(_CHOSEN.findall(source.text))
        signals |= {(_KINDS[w], int(number)): "" for w, number in _SIGNAL.findall(source.text) if w in _KINDS}
        for word, number, header, other in _SELECTED.findall(source.text):
            numbers[word or _BANKS[header], int(number or other)] = ""
    poses = {}
    for at, value in dump.poses.items():
        x, y, z, a, b, c = (one.value if isinstance(one, ir.RealLiteral) else 0.0 for _, one in value.entries)
        poses[at] = (x, y, z, a, b, c)
    numbers |= {at: "" for at, value in poses.items() if any(value)}
    return Standing(names, numbers, frozenset(computed), signals, {at: one for at, one in poses.items() if any(one)})

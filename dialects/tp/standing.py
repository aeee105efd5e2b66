"""What a backup of a controller has: programs (.LS), registers, signals with their comments, tools and user frames.

Whether a number is read or written does not matter here, so the text says it: `R[5:box count]`, `DO[3:grip]`.
"""

from __future__ import annotations

import re
from collections.abc import Sequence
from pathlib import PurePosixPath

from rpl.diagnostics import Diagnostics
from rpl.ir.standing import Standing
from rpl.source import Source

from .dumps import Dump, is_dump, read_dump
from .tables import NUMBERED_SIGNALS

_PROG = re.compile(r"^\s*/PROG\s+([\w$-]+)", re.MULTILINE)
_USE = re.compile(r"(?<![\w$])([A-Z]{1,3})\[\s*(?:GP\d+:)?\s*(\d+)(?:[^\]:\n]*:([^\]\n]*))?")
_CHOSEN = re.compile(r"(?<![\w$])([A-Z]{1,3})\[\s*(?:GP\d+:)?\s*[A-Z]+\[")
_SELECTED = re.compile(r"\b(UTOOL|UFRAME)(?:_NUM\s*=\s*|\[\s*)(\d+)")
_BANKS = ("R", "PR", "SR", "F", "TIMER")


def standing(sources: Sequence[Source]) -> Standing:
    """All files of the backup together."""
    dump, names = Dump(), {}
    numbers: dict[tuple[str, int], str] = {}
    signals: dict[tuple[str, int], str] = {}
    computed: set[str] = set()
    for source in sources:
        if is_dump(source.text):
            read_dump(source, dump, Diagnostics())
            continue
        named = _PROG.search(source.text)
        names[named[1].lower() if named else PurePosixPath(source.path).stem.lower()] = source.path
        computed.update(word for word in _CHOSEN.findall(source.text) if word in _BANKS)
        for word, number, comment in _USE.findall(source.text):
            if word in _BANKS:
                numbers[word, int(number)] = comment.strip() or numbers.get((word, int(number)), "")
            elif word in NUMBERED_SIGNALS:
                at = (NUMBERED_SIGNALS[word], int(number))
                signals[at] = comment.strip() or signals.get(at, "")
        for word, number in _SELECTED.findall(source.text):
            numbers.setdefault((word, int(number)), "")
    numbers |= dump.labels
    poses = {}
    for at, (position, _) in dump.frames.items():
        group = position.groups.get(1)
        values = group.values if group is not None else {}
        found = [values.get(word) for word in ("X", "Y", "Z", "R", "P", "W")]
        x, y, z, a, b, c = (one if one is not None else 0.0 for one in found)
        if any(found):
            poses[at] = (x, y, z, a, b, c)
            numbers.setdefault(at, "")
    return Standing(names, numbers, frozenset(computed), signals, poses)

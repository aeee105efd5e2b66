"""FANUC TP: how its listings (.LS) and variable dumps (.VA) are recognised; the rest is imported when called."""

from __future__ import annotations

import re
from pathlib import Path

from rpl.registry import Dialect

_HEAD = re.compile(r"^[ \t\ufeff]*/PROG\b", re.MULTILINE)
_BODY = re.compile(r"^[ \t]*/(?:MN|ATTR)\b", re.MULTILINE)
_DUMP = re.compile(
    r"^[ \t]*\[\*(?:NUMREG|POSREG|STRREG)\*\]\$\w+|^[ \t]*\[\*SYSTEM\*\]\s*\$(?:MN(?:UFRAME|UTOOL)|PLST_GRP1)\b",
    re.MULTILINE,
)


def _recognise(path: str, text: str) -> int:
    """How sure the content is TP: /PROG with /MN or /ATTR, or a dump of registers or frames. `.LS` is also the ending
    of logs, so the ending alone says nothing."""
    head = text[:20_000]
    if _HEAD.search(head):
        return 98 if _BODY.search(head) else 70
    if re.search(r"^[ \t]*/MN\b", head, re.MULTILINE) and re.search(r"^[ \t]*/(?:POS|END)\b", text, re.MULTILINE):
        return 60
    return 90 if _DUMP.search(text) else 0


_DUMPS = ("numreg.va", "strreg.va", "posreg.va", "sysframe.va", "sysmotn.va")


def _companions(path: str) -> tuple[str, ...]:
    """The variable dumps beside a listing: values of registers, frames and loads."""
    file = Path(path)
    if file.suffix.lower() != ".ls":
        return ()
    return tuple(str(file.with_name(name)) for dump in _DUMPS for name in (dump, dump.upper()))


_SIGNALS = {
    "digital_in": "DI",
    "digital_out": "DO",
    "group_in": "GI",
    "group_out": "GO",
    "analog_in": "AI",
    "analog_out": "AO",
    "flag": "F",
}


def _signal_name(kind: str, number: int) -> str:
    """How TP spells a physical signal."""
    return f"{_SIGNALS[kind]}[{number}]"


DIALECT = Dialect(
    __name__,
    title="FANUC TP",
    extensions=(".ls", ".va"),
    recognise=_recognise,
    companions=_companions,
    notation_fields=("flip", "down", "back", "t1", "t4", "t6"),
    signal_name=_signal_name,
    aliases=("fanuc",),
)

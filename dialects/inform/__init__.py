"""Yaskawa INFORM: how its jobs are recognised; the heavy parts are imported when called."""

from __future__ import annotations

import re
from pathlib import Path

from rpl.registry import Dialect

from .signals import signal_name, signal_of

_JOB = re.compile(r"^\ufeff?\s*/JOB[ \t\r]*$", re.MULTILINE)
DUMP_HEAD = re.compile(r"\ufeff?\s*//(?:VAR|TOOL[ \t]+\d+|UFRAME[ \t]+\d+)[ \t\r]*$", re.MULTILINE)
_DUMPS = ("VAR.DAT", "TOOL.CND", "UFRAME.CND")
_SECTIONS = re.compile(r"^(?://NAME\b|//POS\b|//INST\b|///NPOS\b|///POSTYPE\b|///ATTR\b)", re.MULTILINE)
_LINES = re.compile(
    r"^[ \t]*(?:S?MOV[JLCS][ \t]+L?[A-Z]+\d+|DOUT[ \t]+OT#\(|JUMP[ \t]+\*|CALL[ \t]+JOB:|TIMER[ \t]+T=)", re.MULTILINE
)


def _recognise(path: str, text: str) -> int:
    """How sure the content is a job, or a file of its controller's values (VAR.DAT, TOOL.CND, UFRAME.CND): by its
    header, then by the share of typical lines."""
    if DUMP_HEAD.match(text[:200]):
        return 96
    head = text[:100_000]
    if _JOB.search(head[:2_000]):
        return 97 if _SECTIONS.search(head) else 85
    if len(_SECTIONS.findall(head)) >= 2:
        return 80
    typical = len(_LINES.findall(head))
    return 45 if typical >= 2 and typical * 5 >= head.count("\n") else 0


def _companions(path: str) -> tuple[str, ...]:
    """The files beside a job that have what its controller keeps: variables, tools, user frames."""
    file = Path(path)
    if file.suffix.lower() != ".jbi":
        return ()
    return tuple(str(file.with_name(name)) for dump in _DUMPS for name in (dump, dump.lower()))


DIALECT = Dialect(
    __name__,
    title="Yaskawa INFORM",
    extensions=(".jbi", ".dat", ".cnd"),
    recognise=_recognise,
    notation_fields=("noflip", "lower", "rear", "r180", "t180", "s180"),
    signal_name=signal_name,
    signal_of=signal_of,
    companions=_companions,
    aliases=("yaskawa", "motoman"),
)

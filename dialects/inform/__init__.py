"""Yaskawa INFORM: how its jobs are recognised; the heavy parts are imported when called."""

from __future__ import annotations

import re
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from rpl.diagnostics import Diagnostics
from rpl.registry import Dialect, ReadResult
from rpl.source import Source

from .signals import signal_name, signal_of

if TYPE_CHECKING:
    from rpl.checks.loading import Loader
    from rpl.emulator.configuration import Notation
    from rpl.ir.rules import Rules
    from rpl.ir.standing import Standing

_JOB = re.compile(r"^\ufeff?\s*/JOB[ \t]*$", re.MULTILINE)
_DUMP = re.compile(r"\ufeff?\s*//(?:VAR|TOOL[ \t]+\d+|UFRAME[ \t]+\d+)[ \t]*$", re.MULTILINE)
_DUMPS = ("VAR.DAT", "TOOL.CND", "UFRAME.CND")
_SECTIONS = re.compile(r"^(?://NAME\b|//POS\b|//INST\b|///NPOS\b|///POSTYPE\b|///ATTR\b)", re.MULTILINE)
_LINES = re.compile(
    r"^[ \t]*(?:S?MOV[JLCS][ \t]+L?[A-Z]+\d+|DOUT[ \t]+OT#\(|JUMP[ \t]+\*|CALL[ \t]+JOB:|TIMER[ \t]+T=)", re.MULTILINE
)


def _recognise(path: str, text: str) -> int:
    """How sure the content is a job, or a file of its controller's values (VAR.DAT, TOOL.CND, UFRAME.CND): by its
    header, then by the share of typical lines."""
    if _DUMP.match(text[:200]):
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


def _read(sources: Sequence[Source], diagnostics: Diagnostics) -> ReadResult:
    from .project import read

    return read(sources, diagnostics)


def _rules() -> Rules:
    from .rules import RULES

    return RULES


def _prelude() -> None:
    return None


def _notation() -> Notation:
    from .configuration import NOTATION

    return NOTATION


def _standing(sources: Sequence[Source]) -> Standing:
    from .standing import standing

    return standing(sources)


def _loading() -> Loader:
    from .loading import LOADER

    return LOADER


DIALECT = Dialect(
    name="inform",
    title="Yaskawa INFORM",
    extensions=(".jbi", ".dat", ".cnd"),
    recognise=_recognise,
    read=_read,
    rules=_rules,
    prelude=_prelude,
    notation=_notation,
    notation_fields=("noflip", "lower", "rear", "r180", "t180", "s180"),
    signal_name=signal_name,
    signal_of=signal_of,
    companions=_companions,
    aliases=("yaskawa", "motoman"),
    loading=_loading,
    standing=_standing,
)

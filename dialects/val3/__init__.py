"""Staubli VAL3: how the files of its applications are recognised; the heavy parts are imported when called."""

from __future__ import annotations

import re
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from rpl.diagnostics import Diagnostics
from rpl.registry import Dialect, ReadResult
from rpl.source import Source

if TYPE_CHECKING:
    from rpl.checks.loading import Loader
    from rpl.emulator.configuration import Notation
    from rpl.ir import Module
    from rpl.ir.rules import Rules

# The root elements of the three kinds of files, as controllers before and since VAL3 s7 write them.
_ROOT = re.compile(
    r'<(?:Programs|Project|Database)\b[^>]*xmlns="http://www\.staubli\.com/robotics/VAL3/'
    r'|<(?:programList|project|dataList)\b[^>]*xmlns="(?:Program|Project|Data)NameSpace"'
)


def _recognise(path: str, text: str) -> int:
    """Sure where the root element is VAL3's own; no other language has it."""
    return 98 if _ROOT.search(text[:4_000]) else 0


def _companions(path: str) -> tuple[str, ...]:
    """The other files of the application: what lies in the same folder."""
    folder = Path(path).parent
    if not folder.is_dir():
        return ()
    files = (str(file) for file in sorted(folder.iterdir()) if file.suffix.lower() in (".pjx", ".dtx", ".pgx"))
    return tuple(file for file in files if file != path)


def _read(sources: Sequence[Source], diagnostics: Diagnostics) -> ReadResult:
    from .project import read

    return read(sources, diagnostics)


def _rules() -> Rules:
    from .rules import RULES

    return RULES


def _prelude() -> Module:
    from .rules import PRELUDE

    return PRELUDE


def _notation() -> Notation:
    from .configuration import NOTATION

    return NOTATION


def _loading() -> Loader:
    from .loading import LOADER

    return LOADER


DIALECT = Dialect(
    name="val3",
    title="Staubli VAL3",
    extensions=(".pjx", ".pgx", ".dtx"),
    recognise=_recognise,
    read=_read,
    rules=_rules,
    prelude=_prelude,
    notation=_notation,
    notation_fields=("shoulder", "elbow", "wrist"),
    companions=_companions,
    aliases=("staubli", "stäubli", "cs8", "cs9"),
    loading=_loading,
)

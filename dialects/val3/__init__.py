"""Staubli VAL3: how the files of its applications are recognised; the heavy parts are imported when called."""

from __future__ import annotations

import re
from pathlib import Path

from rpl.registry import Dialect

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


DIALECT = Dialect(
    __name__,
    title="Staubli VAL3",
    extensions=(".pjx", ".pgx", ".dtx"),
    recognise=_recognise,
    notation_fields=("shoulder", "elbow", "wrist"),
    companions=_companions,
    aliases=("staubli", "stäubli", "cs8", "cs9"),
)

"""Adept/Omron V+: how its files are recognised; the heavy parts are imported when called."""

from __future__ import annotations

import re
from pathlib import Path

from rpl.registry import Dialect

_FRAME = re.compile(r"^[ \t\ufeff]*\.PROGRAM[ \t]+[A-Za-z_][\w.]*", re.IGNORECASE | re.MULTILINE)
_STATEMENTS = re.compile(
    r"^[ \t]*(?:\d+[ \t]+)?(?:MOVE[STF]*\b|APPROS?\b|DEPARTS?\b|SIGNAL\b|SET[ \t]+[#\w]|AUTO\b|LOCAL\b|FOPEN\b|ATTACH\b"
    r"|DETACH\b|OPENI\b|CLOSEI\b|SPEED\b|ACCEL[ \t(]|WAIT\.EVENT\b|TYPE\b|CALL\b|EXECUTE\b|BREAK\b|\.END\b"
    r"|IF\b.*\bTHEN\b|WHILE\b.*\bDO\b|VALUE\b.*:|FOR\b.*\bTO\b|END[ \t]*$)",
    re.IGNORECASE | re.MULTILINE,
)
# Kawasaki AS has the same frame: its own moves, waits, local names and sections tell it apart.
_KAWASAKI = re.compile(
    r"^[ \t]*(?:JMOVE|LMOVE|JAPPRO|LAPPRO|LDEPART|JDEPART|C1MOVE|C2MOVE|SWAIT|TWAIT|ACCURACY|POINT|DRAW|TDRAW|HOME"
    r"|CLAMP|PULSE|UWRIST|DWRIST|PRINT)\b|^[ \t]*\.\$?[a-z_]\w*[ \t]*=|^\.(?:TRANS|JOINTS|AUXDATA|ROBOTDATA|NETCONF"
    r"|SYSDATA|INTER_PANEL\w*)\b|^[ \t]*\w+:[ \t]*$|\bJOINT[ \t]+SPEED\d",
    re.IGNORECASE | re.MULTILINE,
)
_SECTION = re.compile(r"^[ \t]*\.(?:LOCATIONS|REALS|DOUBLES|STRINGS)\b", re.IGNORECASE | re.MULTILINE)


def _recognise(path: str, text: str) -> int:
    """How sure the content is V+: the frame of a program without any word of Kawasaki's language."""
    head = text[:200_000]
    frames = len(_FRAME.findall(head))
    foreign, typical = len(_KAWASAKI.findall(head)), len(_STATEMENTS.findall(head))
    if frames and foreign * 4 <= typical:
        return 92 if typical > 1 else 60
    if not frames and not foreign and _SECTION.search(head) and re.search(r"^\.END\b", head, re.MULTILINE | re.I):
        return 70
    lines = head.count("\n") + 1
    if not frames and not foreign and Path(path).suffix.lower() in (".v2", ".pg") and typical * 3 >= lines:
        return 40
    return 0


def _signal_name(kind: str, number: int) -> str:
    """How V+ spells a physical signal: by its number alone. Numbers that V+ has no place for say what they are."""
    from . import tables

    offset = tables.OFFSETS.get(kind.replace("group", "digital"))
    if offset is None:
        return f"AIO.IN({number})" if kind == "analog_in" else f"AIO.OUT {number}"
    first, last = tables.ROBOT_SIGNALS
    robot = kind == "digital_out" and first <= number <= last
    return str(number + offset) if number <= tables.MOST_SIGNALS or robot else f"{kind} {number}"


DIALECT = Dialect(
    __name__,
    title="Adept V+",
    extensions=(".v2", ".pg", ".lc", ".re", ".st"),
    recognise=_recognise,
    notation_fields=("shoulder", "elbow", "wrist"),
    signal_name=_signal_name,
    aliases=("v+", "adept"),
)

"""KUKA KRL: how its files are recognised; the heavy parts are imported when called."""

from __future__ import annotations

import re
from pathlib import Path

from rpl.registry import Dialect, words

_FRAME = re.compile(
    r"^[ \t\ufeff]*(?:(?:GLOBAL\s+)?DEF(?:FCT\s+[\w$]+(?:\[[^\]]*\])?)?\s+[\w$]+\s*\("
    r"(?![^()\r\n]*(?:\([^()\r\n]*\)[^()\r\n]*)*\)[ \t]*:)"  # other languages end such a header by a colon
    r"|DEFDAT\s+[\w$]+|&ACCESS\b|&REL\b|&PARAM\b)",
    re.IGNORECASE | re.MULTILINE,
)
_FORM = re.compile(r"^[ \t\ufeff]*DEFTP\s+\w+\s*=", re.IGNORECASE | re.MULTILINE)  # an inline form's mask, no program
_STATEMENTS = re.compile(
    r"^[ \t]*(?:S?(?:PTP|LIN|CIRC)(?:_REL)?[ \t]*[\w${]|\$(?:OUT|VEL|BASE|TOOL|APO|ACC)\b|WAIT[ \t]+(?:SEC|FOR)\b"
    r"|DECL[ \t]|ENDFOR\b|ENDIF\b|ENDSWITCH\b|END[ \t]*$|ENDFCT\b|ENDDAT\b|;FOLD\b|BAS[ \t]*\()",
    re.IGNORECASE | re.MULTILINE,
)


def _recognise(path: str, text: str) -> int:
    """How sure the content is KRL: the frame of a module, then the share of typical lines."""
    head = text[:200_000]
    if _FORM.search(head[:20_000]):
        return 0
    frames = len(_FRAME.findall(head[:20_000]))
    if frames and _STATEMENTS.search(head):
        return 95
    if frames:
        return 80
    typical = len(_STATEMENTS.findall(head))
    lines = head.count("\n") + 1
    suffix = Path(path).suffix.lower()
    if typical >= 2 and typical * 5 >= lines:
        return 45
    rare = typical * 20 < lines  # `.dat` and `.src` are names of logs, tables and other languages too
    return 32 if typical and not rare and suffix in (".src", ".sub", ".dat") else 0


def _companions(path: str) -> tuple[str, ...]:
    """The data list of a named program, and the program of a named data list; `$config.dat` beside either."""
    file = Path(path)
    other = {".src": (".dat", ".DAT", ".Dat"), ".sub": (".dat", ".DAT"), ".dat": (".src", ".SRC", ".sub", ".SUB")}
    found = [str(file.with_suffix(suffix)) for suffix in other.get(file.suffix.lower(), ())]
    if found:
        found.extend(str(file.with_name(name)) for name in ("$config.dat", "$CONFIG.DAT", "$Config.dat"))
    return tuple(name for name in found if name != path)


def _signal_name(kind: str, number: int) -> str:
    """How KRL spells a physical signal."""
    known = words("krl")
    return f"{(known.pairs('signals') | known.pairs('groups'))[kind]}[{number}]"


DIALECT = Dialect(
    __name__,
    title="KUKA KRL",
    extensions=(".src", ".dat", ".sub"),
    recognise=_recognise,
    notation_fields=("s", "t"),
    companions=_companions,
    signal_name=_signal_name,
    aliases=("kuka", "krc"),
)

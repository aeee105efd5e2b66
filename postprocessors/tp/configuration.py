"""The text of CONFIG: letters of the posture, then the turns of axes 1, 4 and 6, from the flags of the notation."""

from __future__ import annotations

from functools import lru_cache
from typing import Final

FLAGS: Final = ("flip", "down", "back", "t1", "t4", "t6")
_LETTERS: Final = (("flip", "NF"), ("down", "UD"), ("back", "TB"))
_TURNS: Final = ("t1", "t4", "t6")


@lru_cache(maxsize=1000)
def config_text(given: tuple[tuple[str, int], ...]) -> str:
    """`N U T, 0, 0, 0`; a flag that is not given is the usual one."""
    flags = dict(given)
    letters = " ".join(pair[1 if flags.get(name) else 0] for name, pair in _LETTERS)
    return ", ".join((letters, *(str(int(flags.get(name, 0))) for name in _TURNS)))

"""The text of FANUC's CONFIG string, 'N U T, 0, 0, 0', and its flags: what reading needs of it, without any arm.

What the flags mean stands in `configuration`.
"""

from __future__ import annotations

import re
from collections.abc import Mapping
from functools import lru_cache
from typing import Final

FIELDS: Final = ("flip", "down", "back", "t1", "t4", "t6")
BRANCH: Final = ("flip", "down", "back")
TURN_AXES: Final = {"t1": 0, "t4": 3, "t6": 5}
_CONFIG = re.compile(
    r"'?\s*([NF])?\s*([LR])?\s*([UD])?\s*([TB])?\s*,\s*(-?\d+)\s*,\s*(-?\d+)\s*,\s*(-?\d+)\s*'?", re.IGNORECASE
)
_LETTERS: Final = {"flip": "NF", "down": "UD", "back": "TB"}


def parse_config(text: str) -> dict[str, int | None] | None:
    """The flags of a CONFIG text such as `N U T, 0, 0, 0`; None when it is none."""
    flags = _parsed(text)
    return None if flags is None else dict(flags)


@lru_cache(maxsize=1000)
def _parsed(text: str) -> dict[str, int | None] | None:
    found = _CONFIG.search(text)
    if found is None:
        return None
    wrist, hand, elbow, shoulder, *turns = found.groups()
    if elbow is None and hand is not None:  # an arm of two links in a plane: which of the two ways its elbow bends
        elbow = "UD"["RL".index(hand.upper())]
    flags: dict[str, int | None] = {}
    for name, letter in zip(BRANCH, (wrist, elbow, shoulder), strict=True):
        flags[name] = None if letter is None else _LETTERS[name].index(letter.upper())
    for name, turn in zip(TURN_AXES, turns, strict=True):
        flags[name] = int(turn)
    return flags


def config_text(flags: Mapping[str, int | None], flat: bool = False) -> str:
    """`N U T, 0, 0, 0`, of a `flat` arm (SCARA) `R, 0, 0, 0`; a flag not known is written as the usual posture."""
    letters = " ".join(_LETTERS[name][1 if flags.get(name) else 0] for name in BRANCH)
    if flat:
        letters = "RL"[1 if flags.get("down") else 0]
    turns = ", ".join(str(flags.get(name) or 0) for name in TURN_AXES)
    return f"{letters}, {turns}"

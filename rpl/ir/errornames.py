"""Errors that a program's handlers can catch: neutral names, and the names by which languages call them.

A language that numbers its errors lists them in its rules under its own spelling. Running and translating both ask here
which of them mean the same.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping

# neutral name -> spellings under which the rules of a language may number it
SPELLINGS: Mapping[str, tuple[str, ...]] = {
    "timeout": ("ERR_WAIT_MAXTIME",),
    "dialog_timeout": ("ERR_TP_MAXTIME", "timeout"),
    "division_by_zero": ("ERR_DIVZERO",),
    "out_of_range": ("ERR_OUTOFBND",),
    "not_present": ("ERR_NOTPRES",),
    "unknown_routine": ("ERR_REFUNKPRC",),
    "unknown_function": ("ERR_REFUNKFUN",),
    "unknown_trap": ("ERR_REFUNKTRP",),
    "unknown_data": ("ERR_REFUNKDAT",),
    "bad_call": ("ERR_CALLPROC",),
    "no_result": ("ERR_FNCNORET",),
    "negative_argument": ("ERR_NEGARG",),
    "overflow": ("ERR_OVERFLOW", "ERR_NUM_LIMIT"),
    "bad_rotation": ("ERR_ILLQUAT",),
    "text_too_long": ("ERR_STRTOOLNG",),
    "search_missed": ("ERR_WHLSEARCH",),
    "search_already": ("ERR_SIGSUPSEARCH",),
    "unreachable": ("ERR_OUTSIDE_REACH", "ERR_ROBLIMIT"),
    "not_whole": ("ERR_NOTINTVAL", "ERR_INT_NOTVAL"),
    "already_connected": ("ERR_ALRDYCNT",),
    "unknown_interrupt": ("ERR_UNKINO",),
    "path_not_stored": ("ERR_PATH",),
    "bad_raise": ("ERR_ILLRAISE",),
}

_NEUTRAL: dict[str, str] = {}
for _name, _spellings in SPELLINGS.items():
    _NEUTRAL[_name] = _name
for _name, _spellings in SPELLINGS.items():
    for _spelling in _spellings:
        _NEUTRAL.setdefault(_spelling.lower(), _name)


def neutral_name(spelling: str) -> str:
    """The neutral name of an error; one that has none keeps its own, folded."""
    return _NEUTRAL.get(spelling.lower(), spelling.lower())


def unhandled_text(routine: str) -> str:
    """What a translation says, and then stops, where an error leaves the outermost routine and the target has no
    handlers; a proof knows that stop by it."""
    return f"Error in {routine} is not handled"


def spelled_among(spelling: str, names: Iterable[str]) -> str | None:
    """Which of a language's error names means the same as this one."""
    wanted = neutral_name(spelling)
    return next((name for name in names if neutral_name(name) == wanted), None)

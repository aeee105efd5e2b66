"""What goes wrong while a program runs: errors that a program's own handlers can catch, and the names they go by.

The runtime raises neutral names; a language that numbers its errors lists them in its rules, under its own spelling.
"""

from __future__ import annotations

from collections.abc import Mapping

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
# Errors that are faults of the program in every language: no handler sees them.
FATAL = frozenset(("no_value", "wrong_kind", "no_time", "opaque", "vendor", "too_deep", "internal_limit", "motion"))


class ProgramError(Exception):
    """An error inside the robot program. `name` is neutral; `number` is set for one that the program itself raised."""

    def __init__(self, name: str, message: str, number: float | None = None) -> None:
        super().__init__(message)
        self.name = name
        self.message = message
        self.number = number


def number_of(error: ProgramError, numbers: Mapping[str, int]) -> float | None:
    """The error's number in a language whose errors have these numbers; None when it has none there."""
    if error.number is not None:
        return error.number
    for spelling in (error.name, *SPELLINGS.get(error.name, ())):
        if spelling in numbers:
            return numbers[spelling]
    return None


def name_of(number: float, numbers: Mapping[str, int]) -> str:
    """The language's own name of an error number; the number as text when it has none."""
    for name, value in numbers.items():
        if value == number:
            return name
    return f"{number:g}"

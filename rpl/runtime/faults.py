"""What goes wrong while a program runs: errors that a program's own handlers can catch, and the names they go by.

The runtime raises neutral names; a language that numbers its errors lists them in its rules, under its own spelling.
"""

from __future__ import annotations

from collections.abc import Mapping

from rpl.ir.errornames import SPELLINGS

# Errors that are faults of the program in every language: no handler sees them.
FATAL = frozenset(
    ("no_value", "wrong_kind", "no_time", "opaque", "vendor", "too_deep", "internal_limit", "motion", "bad_value")
)
# What says that something is not there, or that the run itself has come to its end: no statement passes that over.
BEYOND = frozenset(
    (
        *("unknown_routine", "unknown_function", "unknown_data", "unknown_trap", "unknown_interrupt", "unknown_task"),
        *("opaque", "vendor", "no_time", "too_deep", "internal_limit", "motion", "bad_call"),
    )
)
UNNUMBERED = 1  # of an error whose number in the language is not known


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

"""A target's texts and messages."""

from __future__ import annotations

from dataclasses import dataclass
from enum import StrEnum, auto


class TextRule(StrEnum):
    """What is true of texts."""

    LINE_ENDS = auto()
    """They may have line ends (else a message is shown line by line)."""

    CASE = auto()
    """Comparisons tell capital letters from small ones."""

    ORDER = auto()
    """`<` of texts is their order (else only `=` and `<>` compare them)."""

    FIND_FROM = auto()
    """text_find begins at any position."""

    PRINTABLE = auto()
    """A text holds only the printable signs of ASCII, so no bytes."""

    LEADING_NUMBERS = auto()
    """A text that is read as a number may go on behind it; without a number it is 0."""

    COMPUTED_DECIMALS = auto()
    """A number can be rounded to a count of decimals that is computed."""

    PARTS = auto()
    """Without numbered storage as well, helpers read numbers from texts and search them by cutting and comparing
    parts."""

    WHOLE = auto()
    """`value_text` makes a text of a value with components too (else of those one by one)."""


class MessageRule(StrEnum):
    """What is true of messages and questions."""

    NUMBERED = auto()
    """Who sends a message may be a number (the number of an alarm); else it is a text."""

    COMPUTED = auto()
    """A message may show computed text (else it names the registers of its values)."""


@dataclass(frozen=True, slots=True)
class Texts:
    """What texts and messages can be."""

    rules: frozenset[TextRule] = frozenset((TextRule.CASE, TextRule.FIND_FROM, TextRule.COMPUTED_DECIMALS))

    messages: frozenset[MessageRule] = frozenset((MessageRule.COMPUTED,))

    longest_message: int = 0
    """Characters of a message's line (0: any)."""

    room: tuple[int, int] | None = None
    """Each text is declared with its longest length: what it gets where nothing says more, and the most that the
    controller's own functions take."""

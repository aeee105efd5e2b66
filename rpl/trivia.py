"""What of a program's text says nothing to its controller, as a language tells it: for whoever compares texts.

A dialect's folder may have a module `trivia` with TRIVIA; without one nothing but blanks is trivial.
"""

from __future__ import annotations

import re
from collections.abc import Callable
from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class Trivia:
    """numbering: what the editor writes in front of each statement (FANUC `  12:`). header: matches a line of a header,
    its group is the name of the attribute. attributes: those that mean nothing, in capitals: dates, sizes, counts.
    remarks: attributes that are remarks for people. tidy: makes numbers of lines and counts in a header right again
    in a text that was put together from two versions."""

    numbering: re.Pattern[str] | None = None
    header: re.Pattern[str] | None = None
    attributes: frozenset[str] = frozenset()
    remarks: frozenset[str] = frozenset()
    tidy: Callable[[str], str] | None = None

    def key(self, text: str) -> str:
        """The text of a statement without what says nothing: one blank where there are some, no number in front."""
        if self.numbering is not None:
            text = self.numbering.sub("", text, 1)
        return " ".join(text.split())

    def tidied(self, text: str) -> str:
        """The text with its numbers of lines and counts right."""
        return text if self.tidy is None else self.tidy(text)

    def attribute(self, line: str) -> str:
        """The name of the header's attribute in a line that means nothing, empty for any other line."""
        found = self.header.match(line) if self.header is not None else None
        name = found[1].upper() if found is not None else ""
        return name if name in self.attributes else ""


NOTHING = Trivia()

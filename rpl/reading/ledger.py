"""The claim ledger: proof that each piece of a source was lowered, kept as trivia, or reported."""

from __future__ import annotations

from dataclasses import dataclass, field

from rpl.source import Source

LOWERED, TRIVIA, REPORTED = "lowered", "trivia", "reported"


@dataclass(slots=True)
class Ledger:
    """Claims of spans of one source, made in reading order."""

    source: Source
    claims: list[tuple[int, int, str]] = field(default_factory=list)

    def claim(self, start: int, end: int, kind: str) -> None:
        self.claims.append((start, end, kind))

    def gaps(self) -> list[tuple[int, int]]:
        """Spans that hold more than white space and that nobody claimed."""
        text, at, found = self.source.text, 0, []
        for start, end, _ in sorted(self.claims):
            if start > at and text[at:start].strip():
                found.append((at, start))
            at = max(at, end)
        if text[at:].strip():
            found.append((at, len(text)))
        return found

    def rebuilt(self) -> str:
        """The source's text put together again from its claims and the white space between them. Differs from the text
        when claims overlap."""
        text, at, parts = self.source.text, 0, []
        for start, end, _ in sorted(self.claims):
            parts.append(text[at:start])
            parts.append(text[start:end])
            at = end
        parts.append(text[at:])
        return "".join(parts)


@dataclass(frozen=True, slots=True)
class FileReport:
    """What became of one file: its logical statements, and those that could not be read."""

    path: str
    dialect: str
    statements: int
    opaque: int
    unread: tuple[str, ...] = ()

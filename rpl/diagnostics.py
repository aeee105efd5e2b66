"""What is reported to the user: codes, severities, the collector, and renderers (text, JSON, SARIF).

A report is data: a `Code` declared once where the rule lives, an origin and arguments. Rooms declare their codes with
`code(...)`; a code that is declared twice is an error of ours. Every function that can report takes the collector
explicitly.
"""

from __future__ import annotations

import json
from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field
from enum import IntEnum

from rpl.errors import InternalError
from rpl.source import NOWHERE, Origin


class Severity(IntEnum):
    """How bad: an ERROR makes the answer `no` (exit 1), a LOSS makes a guarded stop (exit 3)."""

    INFO = 0
    WARNING = 1
    LOSS = 2
    ERROR = 3

    @property
    def word(self) -> str:
        return self.name.lower()


@dataclass(frozen=True, slots=True)
class Code:
    """One kind of report. `template` is filled with the report's arguments; `help` says what the user can do. `stops`:
    the statement stays for the writer, which puts the target's stop there and need not report it once more. `several`:
    a sentence for reports that say different things, what is in brackets once for each (`{count} left out: [{name}]`);
    without it the message has the values of the argument that differs in its place."""

    name: str
    severity: Severity
    template: str
    help: str = ""
    stops: bool = False
    several: str = ""


_CODES: dict[str, Code] = {}


def code(name: str, severity: Severity, template: str, help: str = "", stops: bool = False, several: str = "") -> Code:
    """Declare a code (kebab-case name). The same name with another meaning is refused."""
    new = Code(name, severity, template, help, stops, several)
    if _CODES.setdefault(name, new) != new:
        raise InternalError(f"diagnostic code {name!r} is declared twice with different meanings")
    return new


@dataclass(frozen=True, slots=True)
class Diagnostic:
    """One report: its code, where, and the arguments of the message."""

    code: Code
    origin: Origin = NOWHERE
    arguments: tuple[tuple[str, object], ...] = ()
    severity: Severity = Severity.ERROR

    @property
    def message(self) -> str:
        return self.code.template.format(**dict(self.arguments))

    def as_json(self) -> dict[str, object]:
        origin = self.origin
        return {
            "code": self.code.name,
            "severity": self.severity.word,
            "file": origin.file,
            "line": origin.line,
            "column": origin.column,
            "message": self.message,
        }

    def as_text(self) -> str:
        """`file:line:column: severity CODE message`"""
        origin = self.origin
        place = f"{origin.file}:{origin.line}:{origin.column}: " if origin.source else ""
        text = f"{place}{self.severity.word} {self.code.name} {self.message}"
        return f"{text} ({self.code.help.format(**dict(self.arguments))})" if self.code.help else text


@dataclass(slots=True)
class Diagnostics:
    """The collector. `strict` turns approximations (WARNING codes named in `approximations`) into errors."""

    items: list[Diagnostic] = field(default_factory=list)
    accepted: frozenset[str] = frozenset()
    raised: frozenset[str] = frozenset()

    def report(self, code: Code, origin: Origin = NOWHERE, /, **arguments: object) -> Diagnostic:
        """Add a report. Accepted codes drop to INFO; codes in `raised` become errors."""
        severity = code.severity
        if code.name in self.raised:
            severity = Severity.ERROR
        if code.name in self.accepted and severity < Severity.ERROR:
            severity = Severity.INFO
        item = Diagnostic(code, origin, tuple(arguments.items()), severity)
        self.items.append(item)
        return item

    def __iter__(self) -> Iterator[Diagnostic]:
        return iter(self.items)

    def __len__(self) -> int:
        return len(self.items)

    def drop_repeated(self, first: int, written: int) -> None:
        """Takes out losses that a writer (reports from `written` on) names at a place where a pass (from `first` on)
        has already said why the program stops there, and losses that say the same at the same place."""
        stopped = {
            _place(item)
            for item in self.items[first:written]
            if item.code.stops and item.severity == Severity.LOSS and item.origin.source
        }
        kept = list(self.items[:first])
        seen: set[tuple[object, ...]] = set()
        for at, item in enumerate(self.items[first:], first):
            if item.severity == Severity.LOSS and item.origin.source:
                key = (*_place(item), item.code.name, item.message)
                if key in seen or (at >= written and _place(item) in stopped):
                    continue
                seen.add(key)
            kept.append(item)
        self.items[:] = kept

    def stopping(self, origin: Origin) -> Diagnostic | None:
        """The report of a pass that says why the program stops at this place."""
        here = origin.file, origin.line, origin.column
        lost = (item for item in self.items if item.code.stops and item.severity == Severity.LOSS)
        return next((item for item in lost if item.origin.source and _place(item) == here), None)

    def of(self, severity: Severity) -> list[Diagnostic]:
        return [item for item in self.items if item.severity == severity]

    @property
    def has_errors(self) -> bool:
        return any(item.severity == Severity.ERROR for item in self.items)

    @property
    def has_losses(self) -> bool:
        return any(item.severity == Severity.LOSS for item in self.items)


def _place(item: Diagnostic) -> tuple[object, ...]:
    return item.origin.file, item.origin.line, item.origin.column


def sarif(items: Iterable[Diagnostic]) -> str:
    """SARIF 2.1.0 log of the reports, for code hosts and editors."""
    levels = {Severity.INFO: "note", Severity.WARNING: "warning", Severity.LOSS: "warning", Severity.ERROR: "error"}
    results = [
        {
            "ruleId": item.code.name,
            "level": levels[item.severity],
            "message": {"text": item.message},
            "locations": [
                {
                    "physicalLocation": {
                        "artifactLocation": {"uri": item.origin.file},
                        "region": {"startLine": max(item.origin.line, 1), "startColumn": max(item.origin.column, 1)},
                    }
                }
            ],
        }
        for item in items
    ]
    run = {"tool": {"driver": {"name": "rpl", "rules": []}}, "results": results}
    return json.dumps({"version": "2.1.0", "$schema": "https://json.schemastore.org/sarif-2.1.0.json", "runs": [run]})

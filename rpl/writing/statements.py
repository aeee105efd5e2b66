"""Statements as lines: what the printers of all line-based targets share.

A printer says how its target writes a statement (`written`). Here stands what is the same for all: a statement that the
target cannot say takes back the lines it has begun and becomes a guarded stop - the original as remarks, then the
controller's own stop, a report, and a mark in the ledger. A move that has actions stands behind it without them.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from dataclasses import replace
from typing import ClassVar, Generic, TypeVar

from rpl import ir
from rpl.diagnostics import Code, Diagnostics
from rpl.errors import RplError
from rpl.source import Comment, Origin
from rpl.writing.ledger import EmissionLedger
from rpl.writing.refusals import refusal
from rpl.writing.templates import TemplateError

LineT = TypeVar("LineT")


class CannotSayError(RplError):
    """The target has no words for this; the statement is written as a guarded stop. `code`: that of the report, where
    it is not the printer's own (its argument is `reason` too)."""

    def __init__(self, reason: str, code: Code | None = None) -> None:
        super().__init__(reason)
        self.code = code


class StatementPrinter(ABC, Generic[LineT]):
    """Prints bodies as lines. `guarded`: the report of a guarded stop; `dialect`: whose vendor statements it writes."""

    guarded: ClassVar[Code]
    dialect: ClassVar[str]

    def __init__(self, ledger: EmissionLedger, diagnostics: Diagnostics) -> None:
        self.ledger, self.diagnostics = ledger, diagnostics
        self.lines: list[LineT] = []
        self.depth = 0

    @abstractmethod
    def written(self, statement: ir.Statement) -> None:
        """Put the statement's lines. Raises CannotSayError."""

    @abstractmethod
    def remark(self, text: str) -> None:
        """Put a remark, of several lines if it has line ends."""

    @abstractmethod
    def stop(self) -> None:
        """Put the controller's own stop."""

    def comment(self, comment: Comment) -> None:
        self.remark(comment.text)

    def comments_only(self, origin: Origin) -> None:
        """Put the remarks of a statement that has no line of its own."""
        for comment in origin.comments:
            self.comment(comment)

    def statement(self, statement: ir.Statement) -> None:
        """One statement, or its guarded stop."""
        kept, depth = len(self.lines), self.depth
        try:
            self.written(statement)
        except CannotSayError as error:
            del self.lines[kept:]
            self.depth = depth
            self.taken_back()
            self.guard(statement, str(error), error.code)
            self.without_actions(statement)
        except TemplateError as error:
            raise error.at(statement.origin) from None
        else:
            self.ledger.written(statement)

    def without_actions(self, statement: ir.Statement) -> None:
        """Behind the stop, a move that only its actions on the way keep from being said: who goes on there finds the
        robot where the next statement expects it."""
        if not isinstance(statement, ir.Move) or not statement.triggers:
            return
        kept, depth = len(self.lines), self.depth
        try:
            self.written(replace(statement, triggers=(), origin=replace(statement.origin, comments=())))
        except CannotSayError:
            del self.lines[kept:]
            self.depth = depth
            self.taken_back()
            self.guarded_behind(statement)

    def taken_back(self) -> None:
        """What a printer has noted down for a statement does not hold."""

    def guard(self, statement: ir.Statement, reason: str, code: Code | None = None) -> None:
        """The original as remarks, then the stop."""
        self.comments_only(statement.origin)
        self.remark(original(statement))
        self.stop()
        known = refusal(statement, self.dialect) if code is None else None
        shown, why = known or (code or self.guarded, reason)
        self.diagnostics.report(shown, statement.origin, reason=why)
        self.ledger.reported(statement)
        self.guarded_behind(statement)

    def guarded_behind(self, statement: ir.Statement) -> None:
        """What a printer knows of the robot's state does not hold behind the stop."""

    def own_text(self, statement: ir.Opaque | ir.Vendor) -> str:
        """The text of a statement that only its own controller has. Raises CannotSayError for another's."""
        if isinstance(statement, ir.Opaque):
            raise CannotSayError(f"it was not read ({statement.text.strip()[:40]})")
        if statement.dialect != self.dialect:
            raise CannotSayError(f"it belongs to {statement.dialect}")
        return statement.text


def original(statement: ir.Statement) -> str:
    """How the source says the statement, else its kind."""
    own = statement.text if isinstance(statement, ir.Opaque | ir.Vendor) else ""
    text = statement.origin.text or own or type(statement).__name__
    return "\n".join(part.strip() for part in text.splitlines())

"""From pieces to blocks: parse and lower each statement, attach comments, nest blocks, recover locally.

A damaged statement costs itself alone: it becomes an Opaque item with one report. A missing or stray block end is
reported and mended at the nearest sensible place.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass, field, replace

from rpl import ir
from rpl.depth import has_more_depth
from rpl.diagnostics import Diagnostics, Severity, code
from rpl.passes.collector import paused_cycle_collector
from rpl.reading.ledger import LOWERED, REPORTED, TRIVIA, FileReport, Ledger
from rpl.reading.pieces import (
    AROUND,
    BLANK,
    COMMENT,
    LAYOUT,
    Attribute,
    Block,
    Close,
    Element,
    Item,
    Middle,
    ModulePart,
    Open,
    Piece,
    Section,
)
from rpl.reading.runs import Runs
from rpl.reading.shapes import ShapeParser, StatementError, SyntaxTree, TooDeepError
from rpl.reading.templates import Templates
from rpl.source import Comment, Origin, Source

UNREADABLE = code(
    "unreadable-statement",
    Severity.ERROR,
    "cannot read this statement: {reason}",
    "it is kept as text; a run stops there",
)
STRAY = code("stray-block-end", Severity.ERROR, "{word} without a block that it could end")
STRAY_MIDDLE = code("stray-section", Severity.ERROR, "{word} outside of the block it belongs to")
UNCLOSED = code("missing-block-end", Severity.ERROR, "this {kind} is never ended")
TOO_DEEP = code(
    "blocks-too-deep",
    Severity.LOSS,
    "blocks nested more than {limit} deep",
    "the inner one is kept as text; a run stops there",
)
TOO_DEEP_STATEMENT = code(
    "expressions-too-deep",
    Severity.LOSS,
    "cannot work on this statement: {reason}",
    "it is kept as text, and so is the block that it belongs to; a run stops there",
)
UNCLAIMED = code("unclaimed-text", Severity.ERROR, "this text was not accounted for: {text}")

DEEPEST_BLOCK = 1_100

Lower = Callable[[SyntaxTree, tuple[str, ...], Origin], Element | tuple[Element, ...]]
"""lower(tree, numbers, origin): numbers[slot.index] is the spelling of a number. May raise StatementError."""
Build = Callable[[Block], Item | tuple[Item, ...]]
"""build(block): the IR item of a closed block."""


@dataclass(slots=True)
class _Frame:
    open: Open
    sections: list[Section] = field(default_factory=list)
    head: Middle | None = None
    refused: bool = False  # one of its statements is nested too deeply: the block is kept as text
    items: list[Item] = field(default_factory=list)

    def next_section(self, head: Middle | None) -> None:
        self.sections.append(Section(self.head, tuple(self.items)))
        self.head, self.items = head, []


@dataclass(frozen=True, slots=True)
class Assembly:
    """The items of a file's top level, and its report."""

    items: tuple[Item, ...]
    report: FileReport
    ledger: Ledger


def assemble(
    source: Source,
    dialect: str,
    pieces: Iterable[Piece],
    parser: ShapeParser,
    lower: Lower,
    build: Build,
    diagnostics: Diagnostics,
    runs: Runs | None = None,
    templates: Templates | None = None,
) -> Assembly:
    """Read one source. Every block kind is opened, divided and closed by the elements that `lower` gives. `runs`: takes
    long runs of moves at once, and then sets the cursor of whoever gives the pieces. `templates`: read statements that
    are alike."""
    with paused_cycle_collector():
        assembler = _Assembler(source, parser, lower, build, diagnostics, runs, templates)
        for piece in pieces:
            assembler.take(piece)
        return assembler.finish(dialect)


class _Assembler:
    def __init__(
        self,
        source: Source,
        parser: ShapeParser,
        lower: Lower,
        build: Build,
        diagnostics: Diagnostics,
        runs: Runs | None,
        templates: Templates | None,
    ) -> None:
        self.source, self.parser, self.lower, self.build = source, parser, lower, build
        self.runs, self.templates = runs, templates
        self.diagnostics = diagnostics
        self.ledger = Ledger(source)
        self.comments: list[Comment] = []
        self.comment_start = 0
        self.statements = 0
        self.unread: list[str] = []
        root = Open("file", None, Origin(source, 0, len(source.text)))
        self.frames: list[_Frame] = [_Frame(root)]

    def take(self, piece: Piece) -> None:
        if piece.kind == BLANK:
            return
        if piece.kind == AROUND:
            self.ledger.claim(piece.start, piece.end, TRIVIA)
            return
        if piece.kind in (COMMENT, LAYOUT):
            self.ledger.claim(piece.start, piece.end, TRIVIA)
            if not self.comments:
                self.comment_start = piece.start
            self.comments.append(Comment(piece.text, layout=piece.kind == LAYOUT))
            return
        self.statements += 1
        origin = Origin(self.source, piece.start, piece.end)
        lowered: Element | tuple[Element, ...]
        try:
            lowered = self.read(piece, origin)
        except TooDeepError as error:
            self.ledger.claim(piece.start, piece.end, REPORTED)
            self.diagnostics.report(TOO_DEEP_STATEMENT, origin, reason=str(error))
            self.refuse(error, piece, origin)
            return
        except StatementError as error:
            self.ledger.claim(piece.start, piece.end, REPORTED)
            self.unread.append(piece.text)
            at = Origin(self.source, min(piece.start + error.offset, piece.end), piece.end)
            self.diagnostics.report(UNREADABLE, at, reason=str(error))
            lowered = ir.Opaque(piece.text, origin=origin)
        else:
            self.ledger.claim(piece.start, piece.end, LOWERED)
        elements = lowered if isinstance(lowered, tuple) else (lowered,)
        for position, element in enumerate(elements):
            self.place(element, piece.comment if position == len(elements) - 1 else None)
        if self.runs is not None and piece.comment is None:
            self.go_on(self.runs, piece, lowered)

    def go_on(self, runs: Runs, piece: Piece, lowered: object) -> None:
        """Take the lines behind a move that have its shape."""
        if self.frames[-1].open.kind in runs.not_in:
            return
        run = runs.behind(piece.start, piece.end, lowered)
        if run is not None:
            self.statements += len(run)
            self.ledger.claim(int(run.columns.starts[0]), int(run.columns.ends[-1]), LOWERED)
            self.frames[-1].items.append(run)

    def read(self, piece: Piece, origin: Origin) -> Element | tuple[Element, ...]:
        try:
            if self.templates is not None:
                return self.templates.read(piece.text, origin)
            tree, numbers = self.parser.parse(piece.text)
            return self.lower(tree, numbers, origin)
        except RecursionError:  # costs its statement like any other damage
            if has_more_depth():
                raise
            raise StatementError("the expression is nested too deep", 0) from None

    def refuse(self, error: TooDeepError, piece: Piece, origin: Origin) -> None:
        """A statement that is nested too deeply, and the block that it opens, divides or ends, are kept as text."""
        try:
            lowered = self.lower(error.tree, error.numbers, origin)
        except StatementError:
            lowered = ()
        elements = lowered if isinstance(lowered, tuple) else (lowered,)
        block = next((one for one in elements if isinstance(one, Open | Middle | Close)), None)
        if block is None:
            self.unread.append(piece.text)
            self.place(ir.Opaque(piece.text, origin=origin), piece.comment)
            return
        if not isinstance(block, Open) and (at := self.innermost(block.kind)) is not None:
            self.frames[at].refused = True
        self.place(block, piece.comment)
        if isinstance(block, Open):
            self.frames[-1].refused = True

    def place(self, element: Element, behind: str | None) -> None:
        if isinstance(element, Middle | Close):
            if behind is not None:
                self.comments.append(Comment(behind))
            self.flush_comments()
            if isinstance(element, Middle):
                self.middle(element)
            else:
                self.close(element)
            return
        comments = [*self.comments, Comment(behind, behind=True)] if behind is not None else self.comments
        if comments:
            element = replace(element, origin=replace(element.origin, comments=tuple(comments)))
            self.comments = []
        if isinstance(element, Open):
            self.frames.append(_Frame(element))
        else:
            self.frames[-1].items.append(element)

    def flush_comments(self) -> None:
        if self.comments:
            origin = Origin(self.source, self.comment_start, self.comment_start, tuple(self.comments))
            self.frames[-1].items.append(ir.Nothing(origin=origin))
            self.comments = []

    def middle(self, element: Middle) -> None:
        at = self.innermost(element.kind)
        if at is None:
            self.diagnostics.report(STRAY_MIDDLE, element.origin, word=element.origin.text.split()[0])
            self.frames[-1].items.append(ir.Opaque(element.origin.text, origin=element.origin))
            return
        self.end_frames_above(at)
        self.frames[-1].next_section(element)

    def close(self, element: Close) -> None:
        at = self.innermost(element.kind)
        if at is None:
            self.diagnostics.report(STRAY, element.origin, word=element.origin.text.split()[0])
            self.frames[-1].items.append(ir.Opaque(element.origin.text, origin=element.origin))
            return
        self.end_frames_above(at)
        self.end_frame(element)

    def innermost(self, kind: str) -> int | None:
        for at in range(len(self.frames) - 1, 0, -1):
            if self.frames[at].open.kind == kind:
                return at
        return None

    def end_frames_above(self, at: int) -> None:
        while len(self.frames) - 1 > at:
            opened = self.frames[-1].open
            self.diagnostics.report(
                UNCLOSED, opened.origin, kind=opened.kind if opened.kind == "block" else f"{opened.kind} block"
            )
            self.end_frame(None)

    def end_frame(self, close: Close | None) -> None:
        depth = len(self.frames) - 1
        frame = self.frames.pop()
        frame.next_section(None)
        opened = frame.open
        end = close.origin.end if close else (self.ledger.claims[-1][1] if self.ledger.claims else opened.origin.end)
        if depth > DEEPEST_BLOCK + 1:
            return  # inside of a block that is kept as text as a whole
        if depth > DEEPEST_BLOCK:
            self.diagnostics.report(TOO_DEEP, opened.origin, limit=DEEPEST_BLOCK)
        if depth > DEEPEST_BLOCK or frame.refused:
            self.unread.append(self.source.text[opened.origin.start : end])
            text = self.source.text[opened.origin.start : end]
            built: Item | tuple[Item, ...] = ir.Opaque(text, origin=replace(opened.origin, end=end))
        else:
            built = self.build(Block(opened, tuple(frame.sections), close))
        self.frames[-1].items.extend(built if isinstance(built, tuple) else (built,))

    def finish(self, dialect: str) -> Assembly:
        self.flush_comments()
        self.end_frames_above(0)
        for start, end in self.ledger.gaps():
            at = Origin(self.source, start, end)
            self.diagnostics.report(UNCLAIMED, at, text=self.source.text[start:end].strip()[:60])
            self.frames[0].items.append(ir.Opaque(self.source.text[start:end], origin=at))
            self.unread.append(self.source.text[start:end])
        report = FileReport(self.source.path, dialect, self.statements, len(self.unread), tuple(self.unread))
        return Assembly(tuple(self.frames[0].items), report, self.ledger)


__all__ = ["Assembly", "Attribute", "Build", "Lower", "ModulePart", "assemble", "paused_cycle_collector"]

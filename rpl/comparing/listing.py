"""A routine as one flat list: each statement with its text as a key, the ends and branches of blocks between them.

Comparing texts is cheap and aligns two versions; the nodes are looked at only where the texts differ. A move of a long
run is made only when somebody asks for it.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field, replace

from rpl import ir
from rpl.source import Comment, Origin, Source
from rpl.trivia import Trivia


class _Moves:
    """The moves of a run, each made when it is asked for."""

    __slots__ = ("columns", "make")

    def __init__(self, run: ir.Run) -> None:
        self.columns, self.make = run.columns, run.maker()

    def move(self, at: int) -> ir.Move:
        return self.make(self.columns.spellings(at), self.columns.origin(at))


@dataclass(slots=True)
class Unit:
    """One statement of the source, with all nodes that were made of it. `mark`: it is a branch or the end of a block,
    which has no node of its own: what the block says there."""

    source: Source | None
    start: int
    end: int
    nodes: list[ir.Statement]
    mark: str = ""
    run: _Moves | None = None
    number: int = 0

    @property
    def remarks(self) -> list[str]:
        """The comments that stand by it."""
        origins = (one.origin for one in self.nodes)
        return [comment.text for origin in origins for comment in origin.comments]

    def statements(self) -> tuple[object, ...]:
        """Its nodes without the bodies of blocks."""
        if self.run is not None:
            return (self.run.move(self.number),)
        return tuple(_head(one) for one in self.nodes)


@dataclass(slots=True)
class Remark:
    """A comment, and between which offsets it stands."""

    text: str
    source: Source | None
    low: int
    high: int


@dataclass(slots=True)
class Listing:
    """The units of a routine, the key of each, and its remarks."""

    trivia: Trivia
    keys: list[str] = field(default_factory=list)
    units: list[Unit] = field(default_factory=list)
    remarks: list[Remark] = field(default_factory=list)

    def body(self, body: ir.Body) -> None:
        for node in body:
            match node:
                case ir.Run():
                    self.run(node)
                case ir.Nothing() if node.origin.comments or not node.origin.text.strip():
                    self.comments(node.origin)
                case _:
                    self.statement(node)

    def run(self, run: ir.Run) -> None:
        columns, key = run.columns, self.trivia.key
        source, moves = columns.source, _Moves(run)
        text = source.text
        for at, (start, end) in enumerate(zip(columns.starts.tolist(), columns.ends.tolist(), strict=True)):
            self.keys.append(key(text[start:end]))
            self.units.append(Unit(source, start, end, [], run=moves, number=at))

    def statement(self, node: ir.Statement) -> None:
        origin = node.origin
        last = self.units[-1] if self.units else None
        if last is not None and not last.mark and last.run is None and (origin.source is None or _same(last, origin)):
            last.nodes.append(node)
        else:
            self.comments(origin)
            self.keys.append(self.trivia.key(origin.text) or type(node).__name__)
            self.units.append(Unit(origin.source, origin.start, origin.end, [node]))
        parts = list(_sections(node))
        if not any(_apart(origin, one) for _, _, body in parts for one in body):
            return
        for mark, at, inner in parts:
            if mark:
                self.mark(mark, at)
            self.body(inner)
        if any(inner for _, _, inner in parts):
            self.mark(f"end {_tail(node)}", None)

    def mark(self, mark: str, origin: Origin | None) -> None:
        """A branch or an end of a block: behind the unit before it, where it has no place of its own."""
        if origin is not None and origin.source is not None:
            self.keys.append(self.trivia.key(origin.text))
            self.units.append(Unit(origin.source, origin.start, origin.end, [], mark))
            return
        last = self.units[-1]
        self.keys.append(mark)
        self.units.append(Unit(last.source, last.end, last.end, [], mark))

    def comments(self, origin: Origin) -> None:
        low = self.units[-1].end if self.units and self.units[-1].source is origin.source else 0
        self.remarks += [_remark(one, origin, low) for one in origin.comments]


def listing(routine: ir.Routine, trivia: Trivia) -> Listing:
    """The flat list of a routine: its body, its handlers, what is undone and driven backwards."""
    made = Listing(trivia)
    made.comments(routine.origin)
    for one in routine.declarations:
        made.comments(one.origin)
    made.body(routine.body)
    for handler in routine.handlers:
        made.keys.append(f"handler {handler.codes!r}")
        made.units.append(Unit(handler.origin.source, handler.origin.start, handler.origin.end, [], "handler"))
        made.body(handler.body)
    for word, body in (("undo", routine.undo), ("backward", routine.backward)):
        if body:
            first = body[0].origin
            made.keys.append(word)
            made.units.append(Unit(first.source, first.start, first.start, [], word))
            made.body(body)
    return made


def remarks(module: ir.Module) -> list[Remark]:
    """What is remarked at the head of a module and among its declarations."""
    origins = [module.origin, *(one.origin for one in module.declarations)]
    return [_remark(comment, origin, 0) for origin in origins if origin.source for comment in origin.comments]


def _same(unit: Unit, origin: Origin) -> bool:
    return unit.source is origin.source and unit.start == origin.start and unit.end == origin.end


def _apart(origin: Origin, node: object) -> bool:
    """Does the node stand elsewhere than the block that it is in?"""
    if isinstance(node, ir.Run):
        return True
    inner = getattr(node, "origin", None)
    return isinstance(inner, Origin) and inner.source is not None and inner.start != origin.start


def _remark(comment: Comment, origin: Origin, low: int) -> Remark:
    high = len(origin.source.text) if origin.source is not None and comment.behind else origin.end
    return Remark(comment.text, origin.source, origin.end if comment.behind else low, high)


def _sections(node: object) -> Iterator[tuple[str, Origin | None, ir.Body]]:
    """The bodies of a block: what the section is called (nothing for the first), where its head stands, its body."""
    match node:
        case ir.If(branches=branches, otherwise=otherwise):
            for at, (condition, body) in enumerate(branches):
                yield f"else if {condition!r}" if at else "", None, body
            if otherwise:
                yield "else", None, otherwise
        case ir.Switch(cases=cases, default=default):
            for case in cases:
                yield f"case {case.values!r}", case.origin, case.body
            if default is not None:
                yield "default", None, default
        case ir.For(body=body) | ir.While(body=body) | ir.Repeat(body=body) | ir.Loop(body=body) | ir.Spline(body=body):
            yield "", None, body


def _tail(node: object) -> str:
    """What the end of a block says: the condition of a loop that is checked there."""
    return repr(node.until) if isinstance(node, ir.Repeat) else type(node).__name__


def _head(node: object) -> object:
    """The node without what stands in it as statements of their own."""
    match node:
        case ir.If(branches=branches, otherwise=otherwise, origin=origin):
            inner = [*(one for _, body in branches for one in body), *otherwise]
            if not any(_apart(origin, one) for one in inner):
                return node
            return ir.If(((branches[0][0], ()),), origin=origin)
        case ir.Switch():
            return replace(node, cases=(), default=None)
        case ir.For() | ir.While() | ir.Loop() | ir.Spline():
            return replace(node, body=())
        case ir.Repeat():
            return ir.Repeat(ir.BoolLiteral(True), (), origin=node.origin)
    return node

"""Runs while reading: behind a few moves of one shape, the lines that go on with it are taken by one pattern.

The shape cache makes a statement cheap; here its lines are not even split. A run is made where it is proved right: each
combination of signs and kinds of numbers that occurs in it is read once in the usual way, and has to be what the run
gives for that line, to the spelling and the place.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator
from dataclasses import dataclass, fields, is_dataclass
from itertools import chain
from typing import TYPE_CHECKING

from rpl import ir
from rpl.diagnostics import Diagnostics
from rpl.ir.runs import CELL, identical
from rpl.reading.alike import quietly
from rpl.reading.shapes import ShapeParser, SyntaxTree
from rpl.source import Origin, Source

if TYPE_CHECKING:  # who reads no long program does not wait for it
    import numpy as np
    from numpy.typing import NDArray

Lower = Callable[[SyntaxTree, tuple[str, ...], Origin], object]
_Path = tuple[str | int, ...]

# Runs of fewer lines are read one by one: they would cost more than they save.
SHORTEST = 24
# Moves in a row behind which looking for a run pays.
ENOUGH = 3
_AT_ONCE = 4096  # lines
_MOST_COLUMNS = 30  # two bits of a whole number for each
_NUMBER = re.compile(r"(?<![\w.$])(?:[0-9]{1,12}\.[0-9]{0,12}|\.[0-9]{1,12}|[0-9]{1,12})(?![\w.])")
_ENDED = re.compile(r"[ \t]*\r?\n")
# Behind these a sign in front of a number does not stand between two numbers.
_OPEN = re.compile(r"[\[({,][ \t]*\Z|[A-Za-z_]\w*[ \t]+\Z")


@dataclass(slots=True)
class Cursor:
    """Where a splitter goes on: what stands before has been taken as a run."""

    at: int = 0


@dataclass(frozen=True, slots=True)
class _Shape:
    """Lines of one shape. line: matches the statement, in groups its numbers; block: many lines. margin, ending: what
    stands around the statement. paths: where its numbers are in the move. proved: combinations of signs and kinds."""

    line: re.Pattern[str]
    block: re.Pattern[str]
    margin: int
    ending: int
    paths: tuple[_Path, ...]
    proved: set[int]


class Runs:
    """Finds the runs of one source, for a language that ends a statement with its line.

    signs_placed: the reader gives the sign of a number the place of its statement. not_in: kinds of blocks that look at
    each of their statements."""

    def __init__(
        self,
        source: Source,
        parser: ShapeParser,
        lower: Lower,
        cursor: Cursor,
        diagnostics: Diagnostics,
        signs_placed: bool,
        not_in: frozenset[str] = frozenset(),
    ) -> None:
        self.source, self.parser, self.lower, self.cursor = source, parser, lower, cursor
        self.diagnostics, self.signs_placed, self.not_in = diagnostics, signs_placed, not_in
        self.shapes: dict[tuple[str, str, str], _Shape | None] = {}
        self.seen = 0  # moves in a row
        self.passed = 0  # up to here looking was in vain

    def behind(self, start: int, end: int, lowered: object) -> ir.Run | None:
        """The run of lines behind a statement at start..end, when there is one; the cursor then stands behind it."""
        if lowered.__class__ is not ir.Move:
            self.seen = 0
            return None
        self.seen += 1
        if self.seen <= ENOUGH or start < self.passed:
            return None
        text = self.source.text
        line = text.rfind("\n", 0, start) + 1
        line = max(text.rfind("\r", line, start) + 1, line)
        ended = _ENDED.match(text, end)
        margin = text[line:start]
        if ended is None or margin.strip(" \t"):
            return None
        shape = self.shape(margin, text[start:end], ended.group())
        found = shape.block.match(text, ended.end()) if shape is not None else None
        if shape is None or found is None:
            return None
        self.passed = found.end()
        if text.count("\n", found.start(), found.end()) < SHORTEST:
            return None
        run = self.run(shape, found.start())
        if run is not None:
            self.cursor.at = int(run.columns.ends[-1])
        return run

    def shape(self, margin: str, written: str, ending: str) -> _Shape | None:
        """What lines like this one have in common; None where no run is made of them."""
        key = margin, _NUMBER.sub("0", written), ending
        if key not in self.shapes:
            self.shapes[key] = self.learned(margin, written, ending)
        return self.shapes[key]

    def learned(self, margin: str, written: str, ending: str) -> _Shape | None:
        fixed, at = [], 0
        numbers = list(_NUMBER.finditer(written))
        for number in numbers:
            before = written[at : number.start()].removesuffix("-")
            if not _OPEN.search(before):
                return None
            fixed.append(before)
            at = number.end()
        if not 0 < len(numbers) <= _MOST_COLUMNS or not written.isascii() or any(sign in written for sign in "\"'\r\n"):
            return None
        fixed.append(written[at:])
        paths = self.paths(fixed, [number.group() for number in numbers])
        if paths is None:
            return None
        one = CELL.join(re.escape(part) for part in fixed)
        many = one.replace(CELL, CELL.replace("(", "(?:", 1))
        block = rf"(?:{re.escape(margin)}{many}{re.escape(ending)}){{1,{_AT_ONCE}}}+"
        return _Shape(re.compile(one), re.compile(block), len(margin), len(ending), paths, set())

    def paths(self, fixed: list[str], numbers: list[str]) -> tuple[_Path, ...] | None:
        """Where the numbers are in the move: it is read once with numbers that occur nowhere else."""
        marks = [f"{10_001 + at}{'.125' if '.' in number else ''}" for at, number in enumerate(numbers)]
        text = "".join(chain.from_iterable(zip(fixed, marks, strict=False))) + fixed[-1]
        move = self.lowered(text, Origin(self.source))
        found = {spelling: path for path, spelling in _numbers(move, ())}
        ordered = tuple(found[mark] for mark in marks if mark in found)
        return ordered if isinstance(move, ir.Move) and len(ordered) == len(marks) else None

    def run(self, shape: _Shape, begin: int) -> ir.Run | None:
        """The run that begins with the line at `begin`, as far as it is proved."""
        import numpy as np

        parts: list[tuple[NDArray[np.float64], NDArray[np.int64], NDArray[np.int64]]] = []
        sample: ir.Run | None = None
        kinds: list[NDArray[np.bool_]] = []
        while (found := shape.block.match(self.source.text, begin)) is not None:
            part = found.group()
            breaks = np.flatnonzero(np.frombuffer(part.encode("ascii"), dtype=np.uint8) == 10) + 1
            starts = np.concatenate(([0], breaks[:-1])) + (begin + shape.margin)
            spellings = _flat(shape.line.findall(part))
            values = np.array(list(map(float, spellings))).reshape(len(breaks), len(shape.paths))
            spans = starts, breaks + (begin - shape.ending)
            if sample is None:
                sample = self.sample(shape, values, spans)
            real = np.fromiter(("." in one for one in spellings), bool, len(spellings)).reshape(values.shape)
            if sample is None or not self.proved(shape, sample, spellings, values, spans, real):
                break
            kinds += [np.logical_or.reduce(real), np.logical_and.reduce(real)]
            parts.append((values, *spans))
            begin = found.end()
        if sample is None or not parts:
            return None
        values, starts, ends = (np.concatenate(arrays) for arrays in zip(*parts, strict=True))
        some, every = np.logical_or.reduce(kinds), np.logical_and.reduce(kinds)
        mixed = frozenset(np.flatnonzero(some & ~every).tolist())
        old = sample.columns
        whole = ir.Columns(self.source, shape.line, old.cells, values, (starts, ends), self.signs_placed, mixed)
        return ir.Run(sample.sample, whole, origin=sample.origin)

    def sample(
        self, shape: _Shape, values: NDArray[np.float64], spans: tuple[NDArray[np.int64], NDArray[np.int64]]
    ) -> ir.Run | None:
        """A run of the first lines, not proved yet."""
        move = self.read(int(spans[0][0]), int(spans[1][0]))
        if not isinstance(move, ir.Move):
            return None
        cells = tuple(_at(move, path) for path in shape.paths)
        numbers = tuple(cell for cell in cells if isinstance(cell, ir.IntLiteral | ir.RealLiteral | ir.Unary))
        if len(numbers) < len(cells):
            return None
        columns = ir.Columns(self.source, shape.line, numbers, values, spans, self.signs_placed, frozenset())
        return ir.Run(move, columns, origin=move.origin)

    def read(self, start: int, end: int) -> object:
        """One line in the usual way."""
        return self.lowered(self.source.text[start:end], Origin(self.source, start, end))

    def lowered(self, text: str, origin: Origin) -> object:
        """What is read of a statement. None where something is reported: then each line has to be."""
        return quietly(self.parser, self.lower, self.diagnostics, text, origin)

    def proved(
        self,
        shape: _Shape,
        run: ir.Run,
        spellings: list[str],
        values: NDArray[np.float64],
        spans: tuple[NDArray[np.int64], NDArray[np.int64]],
        real: NDArray[np.bool_],
    ) -> bool:
        """Is each combination of signs and kinds of numbers that occurs here what reading gives?"""
        import numpy as np

        count = len(shape.paths)
        bits = np.concatenate((np.signbit(values), real), axis=1) @ (1 << np.arange(2 * count, dtype=np.int64))
        make = run.maker()
        for combination, at in zip(*(one.tolist() for one in np.unique(bits, return_index=True)), strict=True):
            if combination in shape.proved:
                continue
            start, end = int(spans[0][at]), int(spans[1][at])
            made = make(tuple(spellings[at * count : (at + 1) * count]), Origin(self.source, start, end))
            if not identical(self.read(start, end), made):
                return False
            shape.proved.add(combination)
        return True


def _flat(found: list[str] | list[tuple[str, ...]]) -> list[str]:
    """Groups of a pattern one behind the other: of a single group Python gives no tuples."""
    return [spelling for row in found for spelling in ((row,) if isinstance(row, str) else row)]


def _numbers(node: object, path: _Path) -> Iterator[tuple[_Path, str]]:
    """Spellings of the numbers below a node, and the way to each."""
    if isinstance(node, ir.IntLiteral | ir.RealLiteral):
        yield path, node.spelling
    elif isinstance(node, tuple):
        for at, part in enumerate(node):
            yield from _numbers(part, (*path, at))
    elif is_dataclass(node) and not isinstance(node, Origin):
        for one in fields(node):
            yield from _numbers(getattr(node, one.name), (*path, one.name))


def _at(node: object, path: _Path) -> object:
    for step in path:
        node = node[step] if isinstance(node, tuple) and isinstance(step, int) else getattr(node, str(step), None)
    return node

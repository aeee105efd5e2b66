"""Statements that differ in numbers and names alone: what reading one of them gives, with the places of these in it.

The shape cache saves the parsing of a statement; here it is not lowered anew either. A template is used where it is
proved right: each combination of signs and kinds of numbers that occurs is read once in the usual way, and has to be
what the template gives for it, to the spelling and the place. Only numbers in lists that are written out (targets,
points) are places of a template: no reader looks at their values.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from string import ascii_letters

from rpl import ir
from rpl.diagnostics import Diagnostics
from rpl.ir.runs import Make, below, identical, literal, maker_of
from rpl.reading.alike import quietly
from rpl.reading.pieces import Element
from rpl.reading.shapes import ShapeParser, SyntaxTree
from rpl.source import NOWHERE, Origin

Lower = Callable[[SyntaxTree, tuple[str, ...], Origin], Element | tuple[Element, ...]]
_Parts = list[str]  # of a statement: what stands between its numbers and names, and these, by turns
_Key = tuple[tuple[str, ...], tuple[int | str, ...]]

# A number, with its sign where that cannot stand between two numbers; a name with a digit in it, as names have that
# change from line to line.
_PLACES = re.compile(
    r"((?:(?<=[\[({,])-)?(?<![\w.$\\])(?:[0-9]{1,12}\.[0-9]{0,12}|\.[0-9]{1,12}|[0-9]{1,12})(?![\w.])"
    r"|(?<![\w.$\\])[A-Za-z_]+[0-9]\w*)"
)
_NAME = frozenset(ascii_letters + "_")
_QUOTES = "\"'"
_MOST = 20_000  # templates and proofs that are kept
_LONGEST = 2_000  # characters of a statement of which there may be many


class _Names(dict[str, str]):
    """What a name is for a template: nothing where reading treats it as all others, else itself."""

    def __init__(self, plain: Callable[[str], bool]) -> None:
        self.plain = plain

    def __missing__(self, name: str) -> str:
        self[name] = found = "" if self.plain(name) else name
        return found


@dataclass(frozen=True, slots=True)
class _Seen:
    """A shape of statements. make: None where reading one of them does not tell what the others give."""

    make: Make[_Parts] | None = None
    learned: bool = False


@dataclass(slots=True)
class Templates:
    """Reads the statements of one source, by templates where it can.

    plain: is a name one that reading keeps and does not look at? signs_placed: the sign of a number has the place of
    its statement."""

    parser: ShapeParser
    lower: Lower
    diagnostics: Diagnostics
    plain: Callable[[str], bool]
    signs_placed: bool = False
    names: _Names = field(init=False)
    proved: dict[_Key, Make[_Parts]] = field(default_factory=dict)
    seen: dict[_Key, _Seen] = field(default_factory=dict)

    def __post_init__(self) -> None:
        self.names = _Names(self.plain)

    def read(self, text: str, origin: Origin) -> Element | tuple[Element, ...]:
        """What the statement is. Raises StatementError."""
        if len(text) > _LONGEST:
            return self.usual(text, origin)
        parts = _PLACES.split(text)
        if len(parts) == 1:
            return self.usual(text, origin)
        names = self.names
        kinds = tuple([names[one] if one[0] in _NAME else (one[0] == "-") + 2 * ("." in one) for one in parts[1::2]])
        key = tuple(parts[::2]), kinds
        make = self.proved.get(key)
        if make is not None:
            made = make(parts, origin)
            assert isinstance(made, ir.Move | ir.Variable)  # no other one is proved
            return made
        before = len(self.diagnostics)
        done = self.usual(text, origin)
        if isinstance(done, ir.Move | ir.Variable) and len(self.diagnostics) == before:
            self.prove(key, parts, done)
        return done

    def usual(self, text: str, origin: Origin) -> Element | tuple[Element, ...]:
        return self.lower(*self.parser.parse(text), origin)

    def prove(self, key: _Key, parts: _Parts, done: ir.Move | ir.Variable) -> None:
        """Is this what the template gives? It is made when its shape is seen for the second time."""
        if len(self.seen) + len(self.proved) > _MOST:
            self.seen.clear()
            self.proved.clear()
        shape = key[0], tuple([one if isinstance(one, str) else 0 for one in key[1]])
        seen = self.seen.get(shape)
        if seen is None:
            self.seen[shape] = _Seen()
            return
        if not seen.learned:
            seen = self.seen[shape] = _Seen(self.learned(key, parts, done.origin), True)
        if seen.make is not None and identical(seen.make(parts, done.origin), done):
            self.proved[key] = seen.make

    def learned(self, key: _Key, parts: _Parts, origin: Origin) -> Make[_Parts] | None:
        """The template of a statement, which is read once with numbers and names that occur nowhere else."""
        marked = list(parts)
        for at, kind in enumerate(key[1]):
            if kind == "":
                marked[2 * at + 1] = f"Zq{10_001 + at}x"
            elif isinstance(kind, int):
                marked[2 * at + 1] = f"{10_001 + at}{'.125' if kind > 1 else ''}"
        text = "".join(marked)
        if any(quote in text for quote in _QUOTES):
            return None
        there = Origin(origin.source)
        sample = quietly(self.parser, self.lower, self.diagnostics, text, there)
        wanted = {
            marked[2 * at + 1]: 2 * at + 1 for at, kind in enumerate(key[1]) if kind == "" or isinstance(kind, int)
        }
        cells: dict[int, Make[_Parts]] = {}
        found = set()
        for spelling, place in _marked(sample):
            if spelling in wanted:
                found.add(spelling)
                cells[id(place)] = self.part(wanted[spelling], isinstance(place, str))
        return maker_of(sample, cells, there) if len(found) == len(wanted) else None

    def part(self, at: int, name: bool) -> Make[_Parts]:
        """What gives the name or the number at one place."""
        if name:
            return lambda parts, origin: parts[at]
        if self.signs_placed:
            return lambda parts, origin: literal(parts[at], origin)
        return lambda parts, origin: literal(parts[at], NOWHERE)


def _marked(sample: object) -> Iterator[tuple[str, object]]:
    """Names, and numbers that stand in a list that is written out, with what they are in the sample."""
    for node in below(sample):
        if isinstance(node, str) and node[0:1] in _NAME:
            yield node, node
        elif isinstance(node, ir.Aggregate):
            for _, value in node.entries:
                if isinstance(value, ir.IntLiteral | ir.RealLiteral) and value.spelling is not None:
                    yield value.spelling, value

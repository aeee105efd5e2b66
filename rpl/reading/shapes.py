"""The shape cache: most statements differ only in their numbers, so only shapes never seen are parsed.

A statement's numbers are taken out, what remains is its shape; Lark parses the shape once. In the tree number tokens
(terminals INT and REAL) become `Slot`s that name the number's place in the statement.
"""

from __future__ import annotations

import re
import sys
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cache
from importlib import resources
from typing import NoReturn

from lark import Lark, Token, Tree
from lark import __version__ as lark_version
from lark.exceptions import UnexpectedInput, UnexpectedToken

from rpl.errors import RplError
from rpl.reading.cache import kept
from rpl.reading.deep import DEEPEST_TREE, depth_of, shallow, tokens_of, without_depth

# Texts and names are kept whole; only free-standing numbers are slots. Dialects may pass their own pattern with the
# groups `real` and `int`; whatever else it matches stays in the shape.
NUMBERS = re.compile(
    r'"(?:[^"\\\n]|\\.|"")*"'
    r"|'[^'\n]*'"
    r"|[A-Za-z_$\u0080-\uffff][\w$]*"
    r"|(?P<real>(?:\d+\.\d*|\.\d+)(?:[eE][+-]?\d+)?|\d+[eE][+-]?\d+)"
    r"|(?P<int>\d+)"
)
LONGEST_STATEMENT = 2_000_000
_CACHED_SHAPES = 50_000
# What stands for a taken-out piece in a shape: pattern group -> terminal and its stand-in text.
NUMBER_SLOTS: Mapping[str, tuple[str, str]] = {"real": ("REAL", "0.5"), "int": ("INT", "0")}


@dataclass(frozen=True, slots=True)
class Slot:
    """Place of a number (or of a name or text, where the dialect takes these out too) in a parsed shape: `index` into
    the pieces taken out, `real` when written as a real."""

    index: int
    real: bool


SyntaxTree = Tree[Token | Slot]


class StatementError(RplError):
    """A statement does not parse. `offset` is relative to the statement's text."""

    def __init__(self, message: str, offset: int) -> None:
        super().__init__(message)
        self.offset = offset


class TooDeepError(StatementError):
    """Expressions of a statement are nested too deeply. `tree` and `numbers`: what the statement is without them, which
    tells whether it opens, divides or ends a block."""

    def __init__(self, tree: SyntaxTree, numbers: tuple[str, ...]) -> None:
        super().__init__(f"its expressions are nested more than {DEEPEST_TREE} deep", 0)
        self.tree, self.numbers = tree, numbers


def real_number(spelling: str, largest: float = sys.float_info.max) -> float:
    """A real number as it is written. Raises StatementError for one that is larger than the language has."""
    value = float(spelling)
    if not -largest <= value <= largest:
        raise StatementError(f"the number {spelling[:20]} is too large", 0)
    return value


class ShapeParser:
    """Parses statements of one grammar with the rule `statement`; keeps the trees of shapes already seen."""

    def __init__(
        self,
        grammar: str,
        numbers: re.Pattern[str] = NUMBERS,
        slots: Mapping[str, tuple[str, str]] = NUMBER_SLOTS,
    ) -> None:
        """`grammar`: file name in rpl.grammars. Its number terminals are named INT and REAL. A dialect whose statements
        differ mostly in names or texts takes these out too: further groups of its pattern with their `slots`."""
        self._lark = load_grammar(grammar)
        self._numbers = numbers
        self._stand_ins = {group: text for group, (_, text) in slots.items()}
        self._terminals = dict(slots.values())
        self._trees: dict[str, SyntaxTree] = {}

    def parse(self, text: str) -> tuple[SyntaxTree, tuple[str, ...]]:
        """Tree of the statement's shape, and the spelling of its numbers in order. Raises StatementError."""
        found: list[str] = []
        stand_ins = self._stand_ins

        def take(match: re.Match[str]) -> str:
            kind = match.lastgroup
            if kind is None:
                return match.group()
            found.append(match.group())
            return stand_ins[kind]

        shape = self._numbers.sub(take, text)
        tree = self._trees.get(shape)
        if tree is None:
            tree = self._parse_shape(shape, text, tuple(found))
            if len(self._trees) >= _CACHED_SHAPES:
                self._trees.clear()
            self._trees[shape] = tree
        return tree, tuple(found)

    def _parse_shape(self, shape: str, text: str, numbers: tuple[str, ...]) -> SyntaxTree:
        if len(text) > LONGEST_STATEMENT:
            raise StatementError(f"statement of {len(text)} characters is too long to read", 0)
        try:
            tree: Tree[Token] = self._lark.parse(shape)
        except UnexpectedInput:
            # Parse what was written, so that the place and the words of the report are the user's.
            try:
                self._lark.parse(text)
            except UnexpectedInput as error:
                _refuse(error, text)
            raise StatementError("a number stands where none can be", 0) from None
        shallow(tree)
        places = self._places(text)
        order = {
            id(token): places[token.start_pos]
            for token in tokens_of(tree)
            if token.start_pos in places and self._terminals.get(token.type) == token
        }
        if depth_of(tree) > DEEPEST_TREE:
            raise TooDeepError(_with_slots(without_depth(tree), order), numbers)
        return _with_slots(tree, order)

    def _places(self, text: str) -> dict[int | None, int]:
        """Where in the shape each piece stood that was taken out: offset -> index. A terminal may hold some of them."""
        found: dict[int | None, int] = {}
        shift = 0
        for match in self._numbers.finditer(text):
            if match.lastgroup is not None:
                found[match.start() + shift] = len(found)
                shift += len(self._stand_ins[match.lastgroup]) - len(match.group())
        return found


def _with_slots(tree: Tree[Token], order: dict[int, int]) -> SyntaxTree:
    children: list[SyntaxTree | Token | Slot] = []
    for child in tree.children:
        if isinstance(child, Tree):
            children.append(_with_slots(child, order))
        elif child is not None and id(child) in order:
            children.append(Slot(order[id(child)], child.type == "REAL"))
        else:
            children.append(child)
    return Tree(tree.data, children)


def _refuse(error: UnexpectedInput, text: str) -> NoReturn:
    if isinstance(error, UnexpectedToken) and error.token.type == "$END":
        raise StatementError("the statement ends too early", len(text)) from None
    offset = error.pos_in_stream if error.pos_in_stream is not None and error.pos_in_stream >= 0 else len(text)
    offset = min(offset, len(text))
    word = re.match(r"\s*(\w+|\S)?", text[offset:])
    found = word.group(1) if word and word.group(1) else None
    raise StatementError(
        f"did not expect {found!r} here" if found else "the statement ends too early", offset
    ) from None


@cache
def load_grammar(name: str) -> Lark:
    """The LALR parser of a grammar file. Its tables are kept between runs, because building them takes a while."""
    text = resources.files("rpl.grammars").joinpath(name).read_text("utf-8")

    def build() -> Lark:
        return Lark(text, parser="lalr", lexer="contextual", start="statement", maybe_placeholders=False)

    return kept(name, (text, lark_version), build, Lark.load, Lark.save)

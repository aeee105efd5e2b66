"""Shapes of RAPID statements: besides numbers also names and texts are taken out before a shape is looked up.

A taught program names a new point in every line, so that shapes which keep names would hardly repeat. Keywords stay.
"""

from __future__ import annotations

import re

from lark import Token, Tree
from lark.exceptions import UnexpectedInput

from rpl.reading.deep import DEEPEST_TREE, depth_of, shallow, tokens_of, without_depth
from rpl.reading.shapes import (
    LONGEST_STATEMENT,
    ShapeParser,
    Slot,
    StatementError,
    SyntaxTree,
    TooDeepError,
    load_grammar,
)

from .words import PLACEHOLDERS, RESERVED

_PARTS = re.compile(
    r'(?P<text>"(?:[^"\r\n]|"")*")'
    r"|(?P<real>(?:\d+\.\d*|\.\d+)(?:[eE][+-]?\d+)?|\d+[eE][+-]?\d+)"
    r"|(?P<int>0[xX][0-9a-fA-F]+|0[bB][01]+|0[oO][0-7]+|\d+)"
    r"|(?P<component>(?<=[.\\])(?!(?:INOUT|VAR|PERS)\b)[^\W\d]\w*)"
    r"|(?P<name>[^\W\d]\w*|<(?:" + "|".join(sorted(PLACEHOLDERS)) + r")>|\{\{\w+\}\})"  # {{X}}: left by a generator
    r"|[ \t\r\n\f\x00\x0b\xa0\ufeff]+",
    re.IGNORECASE,
)
_LEAVES = frozenset(("NAME", "STRING", "INT", "REAL"))
_CACHED_SHAPES = 50_000


class RapidParser(ShapeParser):
    """Parses statements with `grammars/rapid.lark`. Every name, text and number of a tree is a Slot."""

    def __init__(self) -> None:
        self._grammar = load_grammar("rapid.lark")
        self._shapes: dict[str, SyntaxTree] = {}

    def parse(self, text: str) -> tuple[SyntaxTree, tuple[str, ...]]:
        """Tree of the statement's shape, and the spellings of its names, texts and numbers in order. Raises
        StatementError."""
        found: list[str] = []
        take = found.append

        def replace(match: re.Match[str]) -> str:
            kind = match.lastgroup
            if kind is None:
                return " "
            word = match.group()
            if kind == "name":
                upper = word.upper()
                if upper in RESERVED:
                    return upper
            take(word)
            return _STANDS_FOR[kind]

        shape = _PARTS.sub(replace, text)
        tree = self._shapes.get(shape)
        if tree is None:
            tree = self._parse(shape, text, tuple(found))
            if len(self._shapes) >= _CACHED_SHAPES:
                self._shapes.clear()
            self._shapes[shape] = tree
        return tree, tuple(found)

    def reads(self, text: str) -> bool:
        """Does the text parse as one statement?"""
        try:
            self.parse(text)
        except TooDeepError:
            return True
        except StatementError:
            return False
        return True

    def _parse(self, shape: str, text: str, found: tuple[str, ...]) -> SyntaxTree:
        if len(text) > LONGEST_STATEMENT:
            raise StatementError(f"statement of {len(text)} characters is too long to read", 0)
        try:
            tree: Tree[Token] = self._grammar.parse(shape)
        except UnexpectedInput as error:
            raise self._refusal(error, text) from None
        shallow(tree)
        tokens = tokens_of(tree)
        for token in tokens:
            if token.type == "NAME" and str(token) in RESERVED and tree.data != "module_head":
                there = re.search(rf"\b{token}\b", text, re.IGNORECASE)
                raise StatementError(f"{token} is a reserved word", there.start() if there else 0)
        # A module named like a reserved word is read; the name was not taken out of the shape.
        order = {id(token): index for index, token in enumerate(token for token in tokens if _taken_out(token))}
        if depth_of(tree) > DEEPEST_TREE:
            raise TooDeepError(_with_slots(without_depth(tree), order), found)
        return _with_slots(tree, order)

    def _refusal(self, error: UnexpectedInput, text: str) -> StatementError:
        """The place and words of the report are the user's, so what was written is parsed once more."""
        try:
            self._grammar.parse(text)
        except UnexpectedInput as again:
            error = again
        offset = error.pos_in_stream if error.pos_in_stream is not None and error.pos_in_stream >= 0 else len(text)
        word = re.match(r"\s*(\w+|\S)?", text[offset:])
        found = word.group(1) if word and word.group(1) else None
        reason = f"did not expect {found!r} here" if found else "the statement ends too early"
        return StatementError(reason, min(offset, len(text)))


_STANDS_FOR = {"text": '""', "real": "0.5", "int": "0", "component": "x", "name": "x"}


def _taken_out(token: Token) -> bool:
    return token.type in _LEAVES and str(token) not in RESERVED


def _with_slots(tree: Tree[Token], order: dict[int, int]) -> SyntaxTree:
    children: list[SyntaxTree | Token | Slot] = []
    for child in tree.children:
        if isinstance(child, Tree):
            children.append(_with_slots(child, order))
        elif _taken_out(child):
            children.append(Slot(order[id(child)], child.type == "REAL"))
        else:
            children.append(child)
    return Tree(str(tree.data), children)

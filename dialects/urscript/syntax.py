"""Syntax trees of single statements to nodes, and blocks of nodes: the first of the two steps of reading.

The shared assembler carries a node in a ModulePart until all sources are read.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cache
from typing import Final

from lark import Token, Tree

from rpl import ir
from rpl.diagnostics import Diagnostics, Severity, code
from rpl.reading.pieces import Block as ReadBlock
from rpl.reading.pieces import Close, Element, Item, Middle, ModulePart, Open, Section
from rpl.reading.shapes import ShapeParser, Slot, StatementError, SyntaxTree, real_number
from rpl.source import Origin

from . import nodes
from .nodes import Expr, Node
from .splitter import SHAPE

SECOND_ELSE = code("urscript-second-else", Severity.ERROR, "this if has a second else")
MISPLACED_HOLE = code(
    "urscript-template",
    Severity.WARNING,
    "a template that is not filled: {text}",
    "a run stops there; read the program as it is sent to the robot",
)

BLOCK: Final = "block"
# Operators as nodes name them; the grammar's rule -> word.
_LOGIC: Final = {"either": "or", "exclusive": "xor", "both": "and"}
_WORDS: Final = frozenset(("break", "continue", "halt", "pass", "enter_critical", "exit_critical"))

_CARRIED = (
    *(nodes.Store, nodes.Declare, nodes.Perform, nodes.Branches, nodes.Repeat),
    *(nodes.Give, nodes.Word, nodes.Thread, nodes.Template, nodes.Define),
)

Children = list[SyntaxTree | Token | Slot]
Numbers = tuple[str, ...]


@cache
def parser() -> ShapeParser:
    return ShapeParser("urscript.lark", SHAPE)


@dataclass(frozen=True, slots=True)
class Head:
    """What opens a block: kind, and the parts of its first line."""

    kind: str
    name: str = ""
    parameters: tuple[tuple[str, Expr | None], ...] = ()
    condition: Expr | None = None


def wrapped(node: Node) -> Item:
    """A node as the assembler carries it."""
    if isinstance(node, ir.Nothing | ir.Opaque):
        return node
    return ModulePart("", (), (), node, node.origin)


def unwrapped(item: Item) -> Node:
    """The node, with the origin that carries its comments."""
    if isinstance(item, ModulePart):
        node = item.data
        assert isinstance(node, _CARRIED)  # our own
        return replace(node, origin=item.origin)
    assert isinstance(item, ir.Nothing | ir.Opaque)  # nothing else is made
    return item


class Syntax:
    """Lowers the statements of one project."""

    def __init__(self, diagnostics: Diagnostics) -> None:
        self.diagnostics = diagnostics
        self.origin = Origin()
        self.makers: dict[str, Callable[[Children, Numbers], Expr]] = {
            "name": lambda c, n: nodes.Var(str(c[0])),
            "int": self.number,
            "real": self.number,
            "text": lambda c, n: nodes.Text(str(c[0])[1:-1]),
            "hole": lambda c, n: self.hole(str(c[0])),
            "true": lambda c, n: nodes.Truth(True),
            "false": lambda c, n: nodes.Truth(False),
            "parenthesis": lambda c, n: self.expression(c[0], n),
            "list": lambda c, n: nodes.ListOf(self.items(c[0], n) if c else ()),
            "index": self.index,
            "member": lambda c, n: nodes.Member(self.expression(c[0], n), str(c[1])),
            "seconds": lambda c, n: nodes.Member(self.expression(c[0], n), "sec"),  # `sec` begins a program elsewhere
            "call": self.call,
            "run": lambda c, n: nodes.Run(self.expression(c[0], n)),
            "negation": lambda c, n: nodes.Sign("not", self.expression(c[0], n)),
            "signed": lambda c, n: nodes.Sign(str(c[0]), self.expression(c[1], n)),
            "compare": self.operation,
            "sum": self.operation,
            "product": self.operation,
            "power": lambda c, n: nodes.Operation("^", self.expression(c[0], n), self.expression(c[1], n)),
        }

    # ---- statements

    def lower(self, tree: SyntaxTree, numbers: Numbers, origin: Origin) -> Element | tuple[Element, ...]:
        """One statement: a carried node, or an end of a block."""
        self.origin = origin
        kind, children = str(tree.data), tree.children
        match kind:
            case "define" | "secondary" | "thread":
                word = {"define": "def", "secondary": "sec", "thread": "thread"}[kind]
                given = self.parameters(children[1], numbers) if len(children) > 1 else ()
                return Open(BLOCK, Head(word, str(children[0]), given), origin)
            case "if_head" | "while_head":
                return Open(BLOCK, Head(kind[:-5], condition=self.expression(children[0], numbers)), origin)
            case "elif_head":
                return Middle(BLOCK, self.expression(children[0], numbers), origin)
            case "else_head":
                return Middle(BLOCK, None, origin)
            case "end":
                return Close(BLOCK, None, origin)
        return wrapped(self.simple(kind, children, numbers, origin))

    def simple(self, kind: str, children: Children, numbers: Numbers, origin: Origin) -> Node:
        if kind in _WORDS:
            return nodes.Word(kind, origin)
        match kind:
            case "return":
                return nodes.Give(self.expression(children[0], numbers) if children else None, origin)
            case "join" | "kill":
                return nodes.Thread(kind, self.expression(children[0], numbers), origin)
            case "declare":
                return nodes.Declare(str(children[0]), str(children[1]), origin)
            case "declare_hole":
                return nodes.Store(str(children[0]), nodes.Var(str(children[1])), self.hole(""), origin)
            case "declare_value":
                value = self.expression(children[2], numbers)
                return nodes.Store(str(children[0]), nodes.Var(str(children[1])), value, origin)
            case "assign":
                target, value = self.expression(children[0], numbers), self.expression(children[1], numbers)
                if not isinstance(target, nodes.Var | nodes.At | nodes.Member):  # not `3 = x`
                    raise StatementError("a value cannot be stored here", 0)
                return nodes.Store("", target, value, origin)
            case "run_alone":
                return nodes.Perform(nodes.Run(self.expression(children[0], numbers)), origin)
            case "tag":
                self.diagnostics.report(MISPLACED_HOLE, origin, text=str(children[0]))
                return nodes.Template(str(children[0]), origin)
        performed = self.expression(children[0], numbers)
        if isinstance(performed, nodes.Hole):
            return nodes.Template(performed.text, origin)
        if not isinstance(performed, nodes.Apply):
            raise StatementError("an expression alone does nothing", 0)
        return nodes.Perform(performed, origin)

    def parameters(self, tree: SyntaxTree | Token | Slot, numbers: Numbers) -> tuple[tuple[str, Expr | None], ...]:
        assert isinstance(tree, Tree)  # a promise of the grammar
        given = []
        for each in tree.children:
            assert isinstance(each, Tree)  # a promise of the grammar
            default = self.expression(each.children[1], numbers) if len(each.children) > 1 else None
            given.append((str(each.children[0]), default))
        return tuple(given)

    # ---- expressions

    def expression(self, tree: SyntaxTree | Token | Slot, numbers: Numbers) -> Expr:
        assert isinstance(tree, Tree)  # a promise of the grammar
        rule = str(tree.data)
        if rule in _LOGIC:
            left, right = tree.children
            return nodes.Operation(_LOGIC[rule], self.expression(left, numbers), self.expression(right, numbers))
        return self.makers[rule](tree.children, numbers)

    def number(self, children: Children, numbers: Numbers) -> Expr:
        child = children[0]
        spelling = numbers[child.index] if isinstance(child, Slot) else str(child)
        if spelling[:2] in ("0x", "0X"):
            return nodes.Number(int(spelling, 16), spelling)
        return nodes.Number(int(spelling) if spelling.isdecimal() else real_number(spelling), spelling)

    def hole(self, text: str) -> Expr:
        self.diagnostics.report(MISPLACED_HOLE, self.origin, text=text or "no value")
        return nodes.Hole(text)

    def items(self, tree: SyntaxTree | Token | Slot, numbers: Numbers) -> tuple[Expr, ...]:
        assert isinstance(tree, Tree)  # a promise of the grammar
        return tuple([self.expression(child, numbers) for child in tree.children])

    def index(self, children: Children, numbers: Numbers) -> Expr:
        """`p[...]` with six numbers is a pose, also where a variable is called p."""
        base, items = self.expression(children[0], numbers), self.items(children[1], numbers)
        if base == nodes.Var("p") and len(items) > 2:
            if len(items) != 6:
                raise StatementError(f"a pose has 6 numbers, {len(items)} are given", 0)
            return nodes.PoseOf(items)
        return nodes.At(base, items)

    def call(self, children: Children, numbers: Numbers) -> Expr:
        callee = self.expression(children[0], numbers)
        arguments: list[tuple[str | None, Expr]] = []
        if len(children) > 1:
            tree = children[1]
            assert isinstance(tree, Tree)  # a promise of the grammar
            for child in tree.children:
                assert isinstance(child, Tree)  # a promise of the grammar
                if child.data == "named":
                    arguments.append((str(child.children[0]), self.expression(child.children[1], numbers)))
                else:
                    arguments.append((None, self.expression(child.children[0], numbers)))
        if isinstance(callee, nodes.Var):
            return nodes.Apply(callee.name, tuple(arguments))
        if isinstance(callee, nodes.Member):
            return nodes.Apply(callee.name, tuple(arguments), callee.base)
        raise StatementError("only a function can be called", 0)

    def operation(self, children: Children, numbers: Numbers) -> Expr:
        left, right = self.expression(children[0], numbers), self.expression(children[2], numbers)
        return nodes.Operation(str(children[1]), left, right)

    # ---- blocks

    def build(self, block: ReadBlock) -> Item:
        """The node of a closed block."""
        head = block.open.data
        assert isinstance(head, Head)  # our own
        origin = block.open.origin
        bodies = [_body(section) for section in block.sections]
        if head.kind == "if":
            assert head.condition is not None  # the grammar
            return wrapped(self.branches(block, head.condition, bodies))
        for section in block.sections[1:]:
            assert section.head is not None  # only the first has none
            raise_at = section.head.origin
            self.diagnostics.report(SECOND_ELSE, raise_at)
        body = tuple(node for part in bodies for node in part)
        if head.kind == "while":
            assert head.condition is not None  # the grammar
            return wrapped(nodes.Repeat(head.condition, body, origin))
        end = block.close.origin if block.close is not None else Origin()
        return wrapped(nodes.Define(head.kind, head.name, head.parameters, body, origin, end))

    def branches(self, block: ReadBlock, condition: Expr, bodies: list[nodes.Block]) -> nodes.Branches:
        branches = [(condition, bodies[0])]
        otherwise: nodes.Block = ()
        closed = False
        for section, body in zip(block.sections[1:], bodies[1:], strict=True):
            assert section.head is not None  # only the first has none
            found = section.head.data
            if closed:
                self.diagnostics.report(SECOND_ELSE, section.head.origin)
                otherwise = (*otherwise, ir.Opaque(section.head.origin.text, origin=section.head.origin), *body)
            elif found is None:
                otherwise, closed = body, True
            else:
                branches.append((found, body))  # type: ignore[arg-type]  # our own expression
        return nodes.Branches(tuple(branches), otherwise, block.open.origin)


def _body(section: Section) -> nodes.Block:
    return tuple([unwrapped(item) for item in section.items])

"""One line of a job as data: the instruction's word and its operands, and the blocks that instructions open and close.

The lines of all jobs are read first and given their meaning afterwards, because the meaning of a position variable
(pulses or a pose, and in which frame) is only known from what the whole project does with it. Until then a variable is
`Index(Name(bank), (number,))`.
"""

from __future__ import annotations

import re
from dataclasses import dataclass
from typing import cast, get_args

from lark import Tree

from rpl import ir
from rpl.reading.pieces import Block, Close, Element, Item, Middle, ModulePart, Open
from rpl.reading.shapes import Slot, StatementError, SyntaxTree, real_number
from rpl.source import NOWHERE, Origin

from .signals import numbered


@dataclass(frozen=True, slots=True)
class Word:
    """A bare word (ON, BF, SUB1, IF ...), in upper case."""

    text: str


@dataclass(frozen=True, slots=True)
class LabelName:
    """`*NAME`, without the star."""

    name: str


@dataclass(frozen=True, slots=True)
class LabelBy:
    """`LABEL: B000`: the label whose name is this value."""

    value: ir.Expression


@dataclass(frozen=True, slots=True)
class JobName:
    """`JOB:NAME`; `by` is a string variable that holds the name."""

    name: str
    by: ir.Expression | None = None


@dataclass(frozen=True, slots=True)
class Numbered:
    """`UF#(1)`, `TL#(2)`, `IARG#(3)`: a numbered thing that is no signal."""

    word: str
    number: ir.Expression


@dataclass(frozen=True, slots=True)
class SystemName:
    """`$PX000`, in upper case, without the dollar sign."""

    name: str


@dataclass(frozen=True, slots=True)
class Relation:
    """`a=b`: a condition, or a tag with its value when `left` is a word."""

    left: Operand
    op: str
    right: Operand


@dataclass(frozen=True, slots=True)
class Group:
    """`(n)` or `(n, m)`."""

    values: tuple[ir.Expression, ...]


@dataclass(frozen=True, slots=True)
class Bracket:
    """`(a=b AND c=d)`: comparisons and brackets with the words between them."""

    items: tuple[Operand, ...]


@dataclass(frozen=True, slots=True)
class Joined:
    """`+MOVJ`: what follows moves another group at the same time."""

    word: str


@dataclass(frozen=True, slots=True)
class Given:
    """`ARGF value`."""

    value: Operand


@dataclass(frozen=True, slots=True)
class Formula:
    """What stands behind EXPRESS."""

    value: ir.Expression


Operand = (
    ir.Expression
    | Word
    | LabelName
    | LabelBy
    | JobName
    | Numbered
    | SystemName
    | Relation
    | Group
    | Bracket
    | Joined
    | Given
    | Formula
)


@dataclass(frozen=True, slots=True)
class Command:
    """One instruction."""

    word: str
    items: tuple[Operand, ...]
    origin: Origin = NOWHERE


@dataclass(frozen=True, slots=True)
class HeaderLine:
    """A line that begins with slashes: their number, the word behind them, the rest."""

    level: int
    word: str
    rest: str


@dataclass(frozen=True, slots=True)
class PointLine:
    """`C00001=...`: bank, number, values with their spelling."""

    bank: str
    number: int
    values: tuple[ir.IntLiteral | ir.RealLiteral, ...]
    origin: Origin = NOWHERE


@dataclass(frozen=True, slots=True)
class Nest:
    """A closed block: its head (kind and command), and its sections, each with the command that began it."""

    kind: str
    head: Command
    sections: tuple[tuple[Command | None, tuple[Item, ...]], ...]


def mentioned(command: Command) -> tuple[ir.Index | ir.Signal | Numbered, ...]:
    """The numbered variables, signals and things of an instruction, also those inside of others."""
    found: list[ir.Index | ir.Signal | Numbered] = []
    for item in command.items:
        _mention(item, found)
    return tuple(found)


def _inside(item: Given | LabelBy | Formula | ir.Unary | JobName) -> object:
    if isinstance(item, ir.Unary):
        return item.operand
    return item.by if isinstance(item, JobName) else item.value


def _mention(item: object, found: list[ir.Index | ir.Signal | Numbered]) -> None:
    match item:
        case ir.Index(indices=parts):
            found.append(item)
        case ir.Signal(index=first, last=last):
            found.append(item)
            parts = tuple(part for part in (first, last) if part is not None)
        case Numbered(number=number):
            found.append(item)
            parts = (number,)
        case Group(values=parts):
            pass
        case Bracket(items=terms):
            for term in terms:
                _mention(term, found)
            return
        case Relation(left=left, right=right):
            _mention(left, found)
            _mention(right, found)
            return
        case ir.Binary(left=first, right=last):
            parts = (first, last)
        case (
            Given(value=value)
            | LabelBy(value=value)
            | Formula(value=value)
            | JobName(by=value)
            | ir.Unary(operand=value)
        ):
            _mention(value, found)
            return
        case _:
            return
    for part in parts:
        _mention(part, found)


# What an instruction does with blocks: word -> (what, kind).
_BLOCKS: dict[str, tuple[str, str]] = {
    **dict.fromkeys(("IFTHEN", "IFTHENEXP", "IFTHENEXPRESS"), ("open", "if")),
    **dict.fromkeys(("ELSEIF", "ELSEIFEXP", "ELSEIFEXPRESS", "ELSE"), ("middle", "if")),
    "ENDIF": ("close", "if"),
    **dict.fromkeys(("WHILE", "WHILEEXP", "WHILEEXPRESS"), ("open", "while")),
    "ENDWHILE": ("close", "while"),
    "FOR": ("open", "for"),
    "NEXT": ("close", "for"),
    "SWITCH": ("open", "switch"),
    "CASE": ("middle", "switch"),
    "DEFAULT": ("middle", "switch"),
    "ENDSWITCH": ("close", "switch"),
}
_EXPRESSIONS = get_args(ir.Expression)
_BANK = re.compile(r"(L?)([A-Z]+?)(\d*)", re.IGNORECASE)


def lower(tree: SyntaxTree, pieces: tuple[str, ...], origin: Origin) -> Element | tuple[Element, ...]:
    """The element of one line."""
    reading = _Reading(pieces, origin)
    match str(tree.data):
        case "header":
            return _part(origin, header_line(str(tree.children[0])))
        case "point":
            bank, number = bank_of(reading.text(tree.children[0]))
            values = tuple(reading.number(_tree(child)) for child in tree.children[2:])
            return _part(origin, PointLine(bank, number or 0, values, origin))
        case "label":
            return ir.Label(str(tree.children[0])[1:], origin=origin)
    command = reading.command(tree)
    if command.word == "SWITCH" and any(item == Word("CASE") for item in command.items):
        return _switch_with_case(command)
    what, kind = _BLOCKS.get(command.word, ("", ""))
    match what:
        case "open":
            return Open(kind, command, origin)
        case "middle":
            return Middle(kind, command, origin)
        case "close":
            return Close(kind, command, origin)
    return _part(origin, command)


def _switch_with_case(command: Command) -> tuple[Element, ...]:
    """`SWITCH B000 CASE 1` on one line."""
    at = command.items.index(Word("CASE"))
    head, case = command.items[:at], command.items[at + 1 :]
    return (
        Open("switch", Command("SWITCH", head, command.origin), command.origin),
        Middle("switch", Command("CASE", case, command.origin), command.origin),
    )


def build(block: Block) -> Item | tuple[Item, ...]:
    """A closed block, kept for later."""
    head = block.open.data
    assert isinstance(head, Command)  # only commands open blocks
    sections = tuple(
        (cast(Command, section.head.data) if section.head else None, section.items) for section in block.sections
    )
    return _part(block.open.origin, Nest(block.open.kind, head, sections))


def _part(origin: Origin, data: object) -> ModulePart:
    return ModulePart("", (), (), data, origin)


def header_line(text: str) -> HeaderLine:
    """A header line taken apart."""
    bare = text.lstrip("/")
    word, _, rest = bare.strip().partition(" ")
    return HeaderLine(len(text) - len(bare), word.upper(), rest.strip())


def bank_of(name: str) -> tuple[str, int | None]:
    """`LPX010` -> (`LP`, 10): the bank that a name belongs to. PX is the P variable with its base and station axes."""
    found = _BANK.fullmatch(name)
    if found is None:
        raise StatementError(f"{name} is no variable", 0)
    local, kind, number = found.groups()
    kind = kind.upper()
    return local.upper() + ("P" if kind == "PX" else kind), int(number) if number else None


def value_of(operand: Operand) -> ir.Expression:
    """The operand as an expression. Raises StatementError."""
    if not isinstance(operand, _EXPRESSIONS):
        raise StatementError("a value is needed here", 0)
    return cast(ir.Expression, operand)


def variable(bank: str, number: ir.Expression, origin: Origin) -> ir.Index:
    """The first form of a variable; `banks` gives it its final one."""
    return ir.Index(ir.Name(bank, origin=origin), (number,), origin=origin)


@dataclass(frozen=True, slots=True)
class _Reading:
    """A parsed line with the pieces taken out of its shape."""

    pieces: tuple[str, ...]
    origin: Origin

    def text(self, child: object) -> str:
        return self.pieces[child.index] if isinstance(child, Slot) else str(child)

    def command(self, tree: SyntaxTree) -> Command:
        word = self.text(tree.children[0]).upper()
        items = tuple(self.item(child) for child in tree.children[1:] if not _is_comma(child))
        return Command(word, items, self.origin)

    def item(self, child: object) -> Operand:
        tree = _tree(child)
        first = tree.children[0] if tree.children else None
        match str(tree.data):
            case "relation":
                left, op, right = tree.children
                return Relation(self.item(left), str(op), self.item(right))
            case "formula":
                return Formula(self.expression(_tree(first)))
            case "bracket":
                return Bracket(tuple(self.term(part) for part in tree.children))
            case "group":
                return Group(tuple(self.expression(_tree(part)) for part in tree.children))
            case "joined":
                return Joined(str(first).lstrip("+ \t").upper())
            case "word":
                return Word(self.text(first).upper())
            case "label_name":
                return LabelName(str(first)[1:])
            case "label_by":
                return LabelBy(self.value(self.item(first)))
            case "job_name":
                return JobName(str(first)[4:].strip())
            case "job_by":
                return JobName("", self.value(self.item(tree.children[1])))
            case "system":
                return SystemName(str(first)[1:].upper())
            case "argument":
                return Given(self.item(first))
            case "number":
                return self.number(tree)
            case "numbered":
                return self.numbered(tree)
        return self.expression(tree)

    def term(self, child: object) -> Operand:
        """A comparison, a bracket or the word between them."""
        return self.item(child) if isinstance(child, Tree) else Word(self.text(child).upper())

    def value(self, operand: Operand) -> ir.Expression:
        return value_of(operand)

    def numbered(self, tree: SyntaxTree) -> Operand:
        word = str(tree.children[0])[:-1].upper()
        number = self.expression(_tree(tree.children[1]))
        return numbered(word, number, self.origin) or Numbered(word, number)

    def number(self, tree: SyntaxTree) -> ir.IntLiteral | ir.RealLiteral:
        negative = len(tree.children) == 2
        child = tree.children[-1]
        text = ("-" if negative else "") + self.text(child)
        real = child.real if isinstance(child, Slot) else "." in text
        if real:
            return ir.RealLiteral(real_number(text), text, origin=self.origin)
        return ir.IntLiteral(int(text), "", origin=self.origin)

    def expression(self, tree: SyntaxTree) -> ir.Expression:
        origin, children = self.origin, tree.children
        match str(tree.data):
            case "variable":
                bank, number = bank_of(self.text(children[0]))
                return variable(bank, ir.IntLiteral(number or 0), origin)
            case "indirect":
                bank, _ = bank_of(str(children[0]))
                return variable(bank, self.expression(_tree(children[1])), origin)
            case "element":
                return self.element(tree)
            case "integer":
                return ir.IntLiteral(int(self.text(children[0])), origin=origin)
            case "real":
                text = self.text(children[0])
                return ir.RealLiteral(real_number(text), text, origin=origin)
            case "number":
                return self.number(tree)
            case "text":
                return ir.TextLiteral(self.text(children[0])[1:-1], origin=origin)
            case "numbered":
                return self.value(self.numbered(tree))
            case "group" if len(children) == 1:
                return self.expression(_tree(children[0]))
            case "unary":
                return ir.Unary("-", self.expression(_tree(children[1])), origin=origin)
            case "binary":
                left, op, right = children
                sign = {"/": "quo"}.get(str(op), str(op))
                return ir.Binary(sign, self.expression(_tree(left)), self.expression(_tree(right)), origin=origin)
        raise StatementError("a value is needed here", 0)

    def element(self, tree: SyntaxTree) -> ir.Expression:
        """`B000[2]`: an element of a user array, which begins at that variable."""
        bank, number = bank_of(self.text(tree.children[0]))
        indices = tuple(self.expression(_tree(child)) for child in tree.children[1:])
        return ir.Index(ir.Name(f"{bank}{number:03d}[]", origin=self.origin), indices, origin=self.origin)


def _is_comma(child: object) -> bool:
    return isinstance(child, Tree) and child.data == "comma"


def _tree(child: object) -> SyntaxTree:
    assert isinstance(child, Tree)  # the grammar says so
    return child

"""V+ expression trees to IR. Types are not known yet: what is a truth, a number or a location is settled when the whole
project has been read (see `typing`).
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from dataclasses import dataclass, field

from lark import Token, Tree

from rpl import ir
from rpl.diagnostics import Diagnostics, Severity, code
from rpl.reading.shapes import Slot, StatementError, SyntaxTree, real_number
from rpl.source import Origin

from . import tables

LOOSE_LOGIC = code(
    "vplus-comparison-precedence",
    Severity.WARNING,
    "{operator} binds tighter than the comparison beside it: read as {reading}",
    "put brackets around each comparison",
)
LONG_NAMES = code(
    "vplus-long-names",
    Severity.WARNING,
    "{name} and {other} are one name: only 15 characters count",
    "shorten one of them so that they differ in the first 15 characters",
)

RELATIONS = {"==": "=", "<>": "<>", "<": "<", ">": ">", "<=": "<=", ">=": ">=", "=<": "<=", "=>": ">="}
OPERATORS = {
    "+": "+", "-": "-", "*": "*", "/": "/", "mod": "mod", "and": "and", "or": "or", "xor": "xor",
    "band": "band", "bor": "bor", "bxor": "bxor",
}  # fmt: skip
_LOGIC = ("and", "or", "xor")
_LARGEST = 3.5e38  # single precision, with room for rounding


@dataclass(slots=True)
class Facts:
    """What a quick look over the project found before reading: its programs, whole numbers that names stand for,
    whether any step changes how moves are joined, and how long the hand takes (None: it changes)."""

    programs: frozenset[str] = frozenset()
    numbers: dict[str, frozenset[int]] = field(default_factory=dict)
    executed: dict[str, frozenset[str]] = field(default_factory=dict)
    joins_change: bool = False
    hand_time_s: float | None = tables.HAND_TIME_S
    locks: bool = False  # does any step change the priority of its program
    switched: frozenset[str] = frozenset()  # switches that the project turns off, or sets to a value
    upper: bool | None = None  # comparisons of texts: capitals like small letters (None: as the controller is set)
    task_of: dict[str, str] = field(default_factory=dict)  # program -> the one task it runs in
    cycles: dict[str, int] = field(default_factory=dict)  # programs of several rounds (`round_of`): how many


@dataclass(slots=True)
class Names:
    """One spelling for each name: the first that was met. Names that only differ behind the 15th character are one."""

    diagnostics: Diagnostics
    spellings: dict[str, str] = field(default_factory=dict)

    def of(self, text: str, origin: Origin) -> str:
        key = significant(text)
        spelled = self.spellings.setdefault(key, text)
        if spelled != text and spelled.lower() != text.lower():
            self.diagnostics.report(LONG_NAMES, origin, name=text, other=spelled)
        return spelled


def significant(text: str) -> str:
    """What counts of a name: its sign of type and 15 characters, in any case."""
    sigil = text[:1] if text[:1] in ("$", "#", "%") else ""
    return sigil + text[len(sigil) : len(sigil) + tables.NAME_LENGTH].lower()


class Expressions(ABC):
    """Lowers expression trees; base of the statement lowering. `numbers` and `origin` are those of the statement at
    hand."""

    def __init__(self, facts: Facts, diagnostics: Diagnostics) -> None:
        self.facts = facts
        self.diagnostics = diagnostics
        self.names = Names(diagnostics)
        self.numbers: tuple[str, ...] = ()
        self.origin = Origin()
        self.steps: list[ir.Statement] = []  # what the statement at hand has to do before itself
        self.met: list[str] = []  # variables that it read so far
        self.cuts = 0

    def name(self, text: str) -> str:
        return self.names.of(text, self.origin)

    def expression(self, tree: SyntaxTree) -> ir.Expression:
        """The expression of a tree."""
        match tree.data:
            case "real":
                spelling = self.spelling(tree.children[0])
                return ir.RealLiteral(real_number(spelling, _LARGEST), spelling)
            case "integer":
                return self.integer(tree.children[0])
            case "unary":
                return self.unary(tree)
            case "based":
                return based(str(tree.children[0]))
            case "character":
                return ir.IntLiteral(ord(str(tree.children[0])[1]))
            case "text":
                return ir.TextLiteral(str(tree.children[0])[1:-1], origin=self.origin)
            case "group":
                return self.expression(subtree(tree.children[0]))
            case "relation":
                return self.relation(tree)
            case "binary":
                return self.binary(tree)
            case "compose":
                left, right = (self.expression(subtree(child)) for child in tree.children)
                return ir.Binary(":", left, right, origin=self.origin)
            case "reference":
                return self.reference(tree)
        return self.call(tree)

    def spelling(self, child: object) -> str:
        return self.numbers[child.index] if isinstance(child, Slot) else str(child)

    def integer(self, child: object) -> ir.IntLiteral | ir.RealLiteral:
        spelling = self.spelling(child)
        if len(spelling) > 38:
            raise StatementError(f"the number {spelling[:20]} is too large", 0)
        value = int(spelling)
        return ir.IntLiteral(value, spelling) if value < 1 << 31 else ir.RealLiteral(float(value), spelling)

    def number(self, child: object) -> int:
        """A whole number that the grammar wants (labels, levels of loops)."""
        return int(self.spelling(child))

    def binary(self, tree: SyntaxTree) -> ir.Expression:
        op = OPERATORS[str(tree.children[1]).lower()]
        left, right = self.expression(subtree(tree.children[0])), self.expression(subtree(tree.children[2]))
        return ir.Binary(op, left, right, origin=self.origin)

    def unary(self, tree: SyntaxTree) -> ir.Expression:
        word = str(tree.children[0]).lower()
        operand = self.expression(subtree(tree.children[1]))
        if word == "+":
            return operand
        return ir.Unary({"-": "-", "not": "not", "com": "bnot"}[word], operand, origin=self.origin)

    def relation(self, tree: SyntaxTree) -> ir.Expression:
        left, right = subtree(tree.children[0]), subtree(tree.children[2])
        for operand in (left, right):
            if operand.data == "binary" and OPERATORS[str(operand.children[1]).lower()] in _LOGIC:
                operator = str(operand.children[1]).upper()
                reading = "x == (a AND b)".replace("AND", operator)
                self.diagnostics.report(LOOSE_LOGIC, self.origin, operator=operator, reading=reading)
        relation = RELATIONS[str(tree.children[1])]
        one, other = self.expression(left), self.expression(right)
        runs = _executing(one, other)
        order = _order(one, other)
        if order is not None:
            return ir.Binary(relation, *order, origin=self.origin)
        if runs is not None and relation in ("=", "<>"):
            return runs if relation == "=" else ir.Unary("not", runs, origin=self.origin)
        return ir.Binary(relation, one, other, origin=self.origin)

    def reference(self, tree: SyntaxTree) -> ir.Expression:
        """A variable or an element; `name[]` is the whole array. Constants and functions without arguments have names
        like variables."""
        text = str(tree.children[0])
        if len(tree.children) == 1:
            known = self.constant(text)
            if known is not None:
                return known
            self.met.append(significant(text))
            return ir.Name(self.name(text), origin=self.origin)
        base = ir.Name(self.name(text), origin=self.origin)
        self.met.append(significant(text))
        indices = [self.optional(subtree(child)) for child in subtree(tree.children[1]).children]
        given = tuple(index for index in indices if index is not None)
        if not given:
            return base
        if len(given) < len(indices):
            raise StatementError("an index is missing", 0)
        return ir.Index(base, given, origin=self.origin)

    def constant(self, text: str) -> ir.Expression | None:
        """Values that have a name of their own."""
        lower = text.lower()
        if lower in tables.CONSTANTS:
            return tables.CONSTANTS[lower]
        origin = self.origin
        match lower:
            case "here":
                return ir.Builtin("pose_of", (ir.Builtin("current_target", (), origin=origin),), origin=origin)
            case "dest":
                return ir.Builtin("pose_of", (ir.System("end_pose", origin=origin),), origin=origin)
            case "null":
                return ir.System("null_frame", origin=origin)
            case "tool":
                return ir.System(lower, origin=origin)
            case "base":  # M: the function gives back what the instruction was given
                return ir.Builtin("inverse", (ir.System(lower, origin=origin),), origin=origin)
            case "random":
                return ir.Builtin("random", (), origin=origin)
            case "#phere":
                return ir.Builtin("current_joints", (), origin=origin)
            case "hand" | "priority":
                found = self.asked(lower)
                return found if found is not None else ir.VendorValue("vplus", text, tables.REAL, origin=origin)
            case "#pdest":
                here = ir.Builtin("pose_of", (ir.System("end_pose", origin=origin),), origin=origin)
                return ir.Builtin("target_to_joints", (here,), origin=origin)
        return None

    def optional(self, tree: SyntaxTree) -> ir.Expression | None:
        return self.expression(subtree(tree.children[0])) if tree.children else None

    @abstractmethod
    def asked(self, name: str) -> ir.Expression | None:
        """What the project tells of a value of the controller."""

    @abstractmethod
    def call(self, tree: SyntaxTree) -> ir.Expression:
        """A built-in function; V+ knows no others."""


def _executing(state: ir.Expression, number: ir.Expression) -> ir.Expression | None:
    """What `TASK(1, n) == 4` asks: whether the task runs."""
    match state, number:
        case ir.Binary(op="*", left=ir.IntLiteral(value=tables.TASK_EXECUTING), right=ir.Convert(operand=runs)), (
            ir.IntLiteral(value=tables.TASK_EXECUTING)
        ):
            return runs if _asks(runs) else None
    return None


def _order(difference: ir.Expression, number: ir.Expression) -> tuple[ir.Expression, ir.Expression] | None:
    """What `STRDIF(a, b) > 0` compares: the texts themselves."""
    match difference, number:
        case ir.Binary(op="-", left=ir.Convert("bit", ir.Binary(op=">", left=one, right=other))), ir.IntLiteral(
            value=0
        ):
            return one, other
    return None


def _asks(runs: ir.Expression) -> bool:
    match runs:
        case ir.Builtin(function="task_runs"):
            return True
        case ir.Binary(op="or", left=left, right=right):
            return _asks(left) and _asks(right)
    return False


def subtree(child: object) -> SyntaxTree:
    assert isinstance(child, Tree)  # the grammar says so
    return child


def based(text: str) -> ir.IntLiteral:
    """`^B101`, `^H1F`, and octal `^17`."""
    mark = next(mark for mark in tables.NUMBER_MARKS if text.lower().startswith(mark))
    try:
        return ir.IntLiteral(int(text[len(mark) :], tables.NUMBER_MARKS[mark]), text)
    except ValueError:
        raise StatementError(f"{text} is no number", 0) from None


def root_name(expression: ir.Expression | None) -> str | None:
    """The variable that a name or an element belongs to."""
    match expression:
        case ir.Name(id=name) | ir.Index(base=ir.Name(id=name)):
            return name
    return None


__all__ = ["Expressions", "Facts", "Names", "Token", "based", "root_name", "significant", "subtree"]

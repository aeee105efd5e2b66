"""Expressions as text for any target: brackets exactly where the target's own precedence needs them.

A target gives a table of operators and one hook that prints everything which is not an operator (literals, names,
calls). Where a reader of the target could doubt the binding, `mixed` groups ask for brackets that the grammar does not.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field

from rpl import ir

LOWEST, ATOM = 0, 1000
RELATIONS = frozenset(("=", "<>", "<", ">", "<=", ">="))


@dataclass(frozen=True, slots=True)
class Operator:
    """How one operator is written: the sign, how tightly it binds (higher is tighter), on which side it groups (`left`,
    `right`, `none`: never without brackets), and whether blanks stand around it."""

    symbol: str
    level: int
    side: str = "left"
    spaced: bool = True


@dataclass(frozen=True, slots=True)
class OperatorTable:
    """A target's operators by their names in the IR. An operator that is missing is given to the hook.

    mixed: within each group, an operand with another operator of the group gets brackets. always: every operand that is
    itself an operation gets them. sign_anywhere: a signed operand may follow any operator bare (`a * -b`); sign_behind:
    these operators (`a <= -b`).
    """

    binary: Mapping[str, Operator]
    unary: Mapping[str, Operator] = field(default_factory=dict)
    mixed: tuple[frozenset[str], ...] = ()
    always: bool = False
    sign_anywhere: bool = False
    sign_behind: frozenset[str] = frozenset()
    brackets: tuple[str, str] = ("(", ")")


@dataclass(frozen=True, slots=True)
class Printed:
    """A piece of text and how tightly it holds together; ATOM needs no brackets anywhere."""

    text: str
    level: int = ATOM


Hook = Callable[[ir.Expression, "ExpressionPrinter"], "str | Printed"]


@dataclass(frozen=True, slots=True)
class ExpressionPrinter:
    """Prints expressions of one target. `hook(expression, printer)` prints all but the table's operators; it calls
    `printer.text` for its own parts and says with Printed when what it gives is an operation itself."""

    table: OperatorTable
    hook: Hook

    def text(self, expression: ir.Expression, at_least: int = LOWEST) -> str:
        """The expression, in brackets when it binds less tightly than `at_least`."""
        printed = self.printed(expression)
        return printed.text if printed.level >= at_least else self.bracketed(printed.text)

    def atom(self, expression: ir.Expression) -> str:
        """The expression, in brackets unless it holds together by itself."""
        return self.text(expression, ATOM)

    def bracketed(self, text: str) -> str:
        left, right = self.table.brackets
        return f"{left}{text}{right}"

    def printed(self, expression: ir.Expression) -> Printed:
        """The expression without outer brackets, and its level."""
        match expression:
            case ir.Binary(op=op) if op in self.table.binary:
                return self._binary(expression, self.table.binary[op])
            case ir.Unary(op=op) if op in self.table.unary:
                return self._unary(expression, self.table.unary[op])
        given = self.hook(expression, self)
        printed = given if isinstance(given, Printed) else Printed(given)
        if printed.level == ATOM and printed.text[:1] in ("-", "+"):
            # A signed literal is read back as a sign and a number, so it binds like the sign.
            sign = self.table.unary.get(printed.text[0])
            return Printed(printed.text, sign.level if sign else LOWEST)
        return printed

    def _binary(self, expression: ir.Binary, operator: Operator) -> Printed:
        # An operation at the edge of its level is bracketed on the side where the target would group otherwise.
        left_least = operator.level if operator.side == "left" else operator.level + 1
        right_least = operator.level if operator.side == "right" else operator.level + 1
        left = self._operand(expression.left, expression.op, left_least, first=True)
        right = self._operand(expression.right, expression.op, right_least, first=False)
        gap = " " if operator.spaced or operator.symbol[:1].isalpha() else ""
        return Printed(f"{left}{gap}{operator.symbol}{gap}{right}", operator.level)

    def _operand(self, operand: ir.Expression, op: str, at_least: int, *, first: bool) -> str:
        printed = self.printed(operand)
        signed = printed.text[:1] in ("-", "+")
        if (
            printed.level < at_least
            or (signed and not first and not self.table.sign_anywhere and op not in self.table.sign_behind)
            or self._doubtful(operand, op)
        ):
            return self.bracketed(printed.text)
        return printed.text

    def _doubtful(self, operand: ir.Expression, op: str) -> bool:
        if not isinstance(operand, ir.Binary) or operand.op not in self.table.binary:
            return False
        if self.table.always:
            return True
        return operand.op != op and any(op in group and operand.op in group for group in self.table.mixed)

    def _unary(self, expression: ir.Unary, operator: Operator) -> Printed:
        operand = self.printed(expression.operand)
        signed = operand.text[:1] in ("-", "+")
        text = operand.text
        # At the sign's own level `-a + b` is `(-a) + b` everywhere, so an operation there is bracketed, a prefix not.
        prefix = isinstance(expression.operand, ir.Unary)
        least = operator.level if prefix else operator.level + 1
        if operand.level < least or (signed and expression.op in ("-", "+")):
            text = self.bracketed(text)
        gap = " " if operator.symbol[-1:].isalpha() else ""
        return Printed(f"{operator.symbol}{gap}{text}", operator.level)

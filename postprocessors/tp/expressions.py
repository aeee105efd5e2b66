"""IR expressions as TP text: registers, signals, plain lines, mixed logic in brackets, conditions.

A plain line goes from left to right without brackets; whatever needs an order of its own is mixed logic, which stands
in brackets as a whole. Functions have an instruction of their own, so they are part of a longer expression only where
a TP program that is written anew has them there.
"""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass, field

from rpl import ir
from rpl.ir.walk import walk
from rpl.passes.scope import Scope
from rpl.passes.typing import type_of
from rpl.writing.precedence import ExpressionPrinter, Printed
from rpl.writing.refusals import UNDECLARED_PLACE
from rpl.writing.statements import CannotSayError

from . import tables
from .texts import ascii_text, comment, number, register_comment

_ELEMENT = re.compile(r"(?P<bank>R|PR|SR|F|AR|P|TIMER)\[?(?P<number>\d+)\]?", re.IGNORECASE)
_NAMED = re.compile(r"(?P<kind>[A-Z]{1,9})\[?(?P<number>\d+)\]?", re.IGNORECASE)
# A flag or a marker in a condition: controllers list them in brackets only.
_FLAG = re.compile(r"(?:^|[ =>])[FM]\[")
_LAST = 99999
ACTIVE = {"UFRAME_NUM": "$MNUFRAMENUM[1]", "UTOOL_NUM": "$MNUTOOLNUM[1]"}


@dataclass(slots=True)
class Expressions:
    """Prints expressions inside of one scope. `names` are the comments of registers, `points` the points by the
    names of their variables. `limited`: only the numbers that a controller has as it is delivered."""

    scope: Scope
    names: Mapping[tuple[str, int], str] = field(default_factory=dict)
    points: Mapping[str, str] = field(default_factory=dict)
    limited: bool = True
    texts_compared: bool = False
    printer: ExpressionPrinter = field(init=False)

    def __post_init__(self) -> None:
        self.printer = ExpressionPrinter(tables.OPERATORS, self._mixed)

    def type(self, expression: ir.Expression) -> ir.Type | None:
        return type_of(expression, self.scope)

    # ---- places

    def place(self, expression: ir.Expression) -> str:
        """A register, argument, point or signal."""
        found = self.element(expression)
        if found is not None:
            return found
        match expression:
            case ir.Signal():
                return self.signal(expression)
            case ir.Field(base=base, name=name):
                return self.component(base, name)
            case ir.System(name="timer", indices=(index,)):
                return self.numbered("TIMER", index)
            case ir.System(name="flag", indices=(index,)):
                return self.numbered("F", index)
            case ir.Convert(how="real" | "bit", operand=operand):
                return self.place(operand)
            case ir.Name(id=name) if name.startswith("$"):
                return name
            case ir.Name(id="UFRAME_NUM" | "UTOOL_NUM" as name):
                return ACTIVE[name]
            case ir.VendorValue(dialect="tp", text=text):
                return text
            case ir.Name(id=name):
                raise CannotSayError(name, UNDECLARED_PLACE)
        raise CannotSayError(f"this is no register: {_what(expression)}")

    def element(self, expression: ir.Expression) -> str | None:
        """An element of a bank, by its number or by a name such as R5; None when it is something else."""
        match expression:
            case ir.Index(base=ir.Name(id=bank), indices=(index,)) if bank.upper() in tables.BANKS:
                return self.numbered(bank.upper(), index)
            case ir.Name(id=name) if name in self.points:
                return self.points[name]
            case ir.Name(id=name):
                parts = _ELEMENT.fullmatch(name)
                if parts is not None:
                    return self.numbered(parts["bank"].upper(), ir.IntLiteral(int(parts["number"])))
        return None

    def numbered(self, bank: str, index: ir.Expression) -> str:
        """`R[5:count]`, `PR[R[2]]`; a number outside of the bank cannot be said."""
        value = constant(index)
        if value is None:
            return f"{bank}[{self.index(index)}]"
        limits = tables.BANKS[bank]
        last = limits.last if self.limited else _LAST
        if value > last and any(kind == bank and number > last for kind, number in self.names):
            last = limits.most  # the program needs a larger bank, which has been said
        if value != int(value) or not limits.first <= value <= last:
            raise CannotSayError(f"{bank}[{value:g}] is outside of {limits.first}..{last}")
        name = register_comment(bank, self.names.get((bank, int(value)), ""))
        return f"{bank}[{int(value)}{':' + name if name else ''}]"

    def index(self, index: ir.Expression) -> str:
        """A computed number: one register or argument. The controller cuts it to a whole number by itself."""
        if isinstance(index, ir.Convert) and index.how in ("real", "trunc"):
            return self.index(index.operand)
        shown = self.element(index)
        if shown is None or not shown.startswith(("R[", "AR[")):
            raise CannotSayError("a number in brackets is a constant, a register or an argument")
        return shown

    def component(self, base: ir.Expression, name: str) -> str:
        """`PR[3,1]`."""
        names = tables.JOINT_ELEMENTS if isinstance(self.type(base), ir.JointsType) else tables.POSE_ELEMENTS
        shown = self.element(base)
        if shown is None or not shown.startswith("PR["):
            raise CannotSayError("only a position register has components")
        if name.lower() not in names:
            raise CannotSayError(f"a position register has no component {name}")
        inner, _, label = shown[3:-1].partition(":") if shown[3].isdigit() else (shown[3:-1], "", "")
        return f"PR[{inner},{names.index(name.lower()) + 1}{':' + label if label else ''}]"

    def signal(self, signal: ir.Signal) -> str:
        """`DI[3]`, `GO[1]`; RI, RO, UI, UO, SI, SO are signals by name."""
        if signal.name is not None:
            parts = _NAMED.fullmatch(signal.name)
            if parts is None or parts["kind"].upper() not in (*tables.NAMED_SIGNALS, *tables.LAST_SIGNAL):
                raise CannotSayError(f"the signal {signal.name} has no number")
            word, at = parts["kind"].upper(), int(parts["number"])
            said = comment(self.names.get((word, at), ""))
            return f"{word}[{at}{':' + said if said else ''}]"
        known = tables.SIGNALS.get(signal.kind)
        if known is None or signal.index is None:
            raise CannotSayError("a signal needs a number")
        word = known
        if signal.last is not None:
            raise CannotSayError("a group of signals has a number of its own, given at the controller")
        value = constant(signal.index)
        if value is None:
            return f"{word}[{self.index(signal.index)}]"
        last = tables.LAST_SIGNAL[word] if self.limited else _LAST
        if not 1 <= value <= last:
            raise CannotSayError(f"{word}[{value:g}] is outside of 1..{last}")
        name = comment(self.names.get((signal.kind, int(value)), ""))
        return f"{word}[{int(value)}{':' + name if name else ''}]"

    # ---- operands

    def simple(self, expression: ir.Expression) -> str | None:
        """A constant or a place; None when it is an operation."""
        value = constant(expression)
        if value is not None:
            return number(value)
        match expression:
            case ir.BoolLiteral(value=truth):
                return "ON" if truth else "OFF"
            case ir.TextLiteral(value=text):
                return self.text(text)
            case ir.Convert(how="real", operand=operand):
                return self.simple(operand)
            case ir.Convert(how="bit", operand=ir.Signal() as signal):
                return self.signal(signal)
            case ir.Index() | ir.Name() | ir.Signal() | ir.Field() | ir.VendorValue():
                return self.place(expression)
            case ir.System(name="timer" | "flag"):
                return self.place(expression)
            case ir.System(name=name, indices=()) if name in tables.SYSTEM_VARIABLES:
                return tables.SYSTEM_VARIABLES[name]
            case ir.Builtin(function="clock_seconds", arguments=(clock,)):
                return self.place(clock)
            case ir.Quantity(value=value_of, unit=unit) if ir.UNITS[unit] == 1:
                return self.simple(value_of)
        return None

    def operand(self, expression: ir.Expression) -> str:
        shown = self.simple(expression)
        if shown is None:
            raise CannotSayError(f"{_what(expression)} inside of another instruction")
        return shown

    def argument(self, expression: ir.Expression) -> str:
        """What a function is given: a constant or a place; a TP program's own calculation stays as it was."""
        if self.limited or self.simple(expression) is not None:
            return self.operand(expression)
        return self.mixed(expression)

    def text(self, text: str) -> str:
        if "'" in text or len(text) > tables.LONGEST_TEXT or ascii_text(text) != text:
            raise CannotSayError("a text is ASCII without apostrophes, of at most 254 characters")
        return f"'{text}'"

    # ---- values

    def value(self, expression: ir.Expression) -> str:
        """The right side of an assignment of a number, a truth value or a text."""
        shown = self.simple(expression)
        if shown is not None:
            return shown
        match expression:
            case ir.Builtin():
                return self.function(expression)
            case ir.Convert(how="trunc", operand=operand):
                return f"TRUNC[{self.argument(operand)}]"
            case ir.Convert(how="round_half_away", operand=operand):
                return f"ROUND[{self.argument(operand)}]"
            case ir.Convert(how="real", operand=operand):
                return self.value(operand)
            case ir.Unary(op="-", operand=operand):
                return self.value(ir.Binary("*", ir.IntLiteral(-1), operand))
        return self.plain(expression) or f"({self.mixed(expression)})"

    def function(self, call: ir.Builtin) -> str:
        name, values = call.function, call.arguments
        if name in tables.FUNCTIONS:
            wanted = 2 if name == "atan2" else 1
            if len(values) != wanted:
                raise CannotSayError(f"{tables.FUNCTIONS[name]} has {wanted} argument{'s' * (wanted > 1)}")
            return f"{tables.FUNCTIONS[name]}[{','.join(self.argument(value) for value in values)}]"
        match name, values:
            case "text_length", (text,):
                return f"STRLEN {self.operand(text)}"
            case "text_find", (text, start, wanted_text) if constant(start) == 1:
                whole, part = _any_case(text), _any_case(wanted_text)
                if whole is text or part is wanted_text:
                    self.note_texts(text, wanted_text)
                return f"FINDSTR {self.operand(whole)},{self.operand(part)}"
            case ("value_text", (shown,)) | ("number_text", (shown, ir.IntLiteral(value=0))):
                known = constant(shown)
                return self.operand(shown) if known is None else self.text(f"{known:g}")
            case "text_part", (text, start, count):
                return f"SUBSTR {self.operand(text)},{self.operand(start)},{self.operand(count)}"
        raise CannotSayError(f"TP has no function {name}")

    def plain(self, expression: ir.Expression) -> str | None:
        """`R[1]+R[2]-3`: operators of one family from left to right; None when it has to be mixed logic."""
        parts: list[str] = []
        family: frozenset[str] | None = None
        left: ir.Expression = expression
        while isinstance(left, ir.Binary):
            group = next((one for one in (tables.SUMS, tables.PRODUCTS, frozenset("&")) if left.op in one), None)
            right = self.appended(left.right) if left.op == "&" else self.simple(left.right)
            if group is None or family not in (None, group) or right is None:
                return None
            family = group
            sign = "+" if left.op == "&" else tables.OPERATORS.binary[left.op].symbol
            parts[:0] = [f" {sign} " if sign.isalpha() else sign, right]
            left = _bare(left.left)
        first = self.simple(left)
        if first is None or not parts or len(parts) > 2 * tables.LONGEST_PLAIN:
            return None
        return first + "".join(parts)

    def appended(self, piece: ir.Expression) -> str | None:
        """What `SR[1]=SR[2]+..` adds: a text, or a register whose number the controller writes itself."""
        if isinstance(piece, ir.Builtin) and piece.function == "value_text" and constant(piece.arguments[0]) is None:
            return self.simple(piece.arguments[0])
        return self.simple(piece)

    def mixed(self, expression: ir.Expression) -> str:
        """Mixed logic without its outer brackets."""
        for node in walk(expression):
            match node:
                case ir.Binary(op=op, left=left, right=right) if op in tables.COMPARISONS:
                    self.note_texts(left, right)
        return self.printer.text(expression)

    def note_texts(self, *sides: ir.Expression) -> None:
        """Texts are compared; that capital and small letters are the same matters where both sides may have some."""
        texts = all(isinstance(self.type(side), ir.StringType | ir.CharType) for side in sides)
        letters = [side.value for side in sides if isinstance(side, ir.TextLiteral)]
        if texts and all(text.upper() != text.lower() for text in letters):
            self.texts_compared = True

    def _mixed(self, expression: ir.Expression, printer: ExpressionPrinter) -> str | Printed:
        value = constant(expression)
        if value is not None:
            return number(value)
        match expression:
            case ir.BoolLiteral(value=truth):
                return "ON" if truth else "OFF"
            case ir.Unary(op="+", operand=operand) | ir.Convert(how="real", operand=operand):
                return printer.printed(operand)
            case ir.Unary(op="-", operand=operand):
                return printer.printed(ir.Binary("*", ir.IntLiteral(-1), operand))
            case ir.Builtin(function="text_equal", arguments=(one, other, ir.BoolLiteral(value=True))):
                return Printed(f"{self.operand(one)}={self.operand(other)}", tables.OPERATORS.binary["="].level)
            case ir.Binary(op="cand" | "cor" as op):
                return printer.printed(ir.Binary(op[1:], expression.left, expression.right))
            case ir.Convert(how="truth", operand=operand) if not self.limited:
                return printer.printed(operand)
            case ir.Convert(how="truth", operand=operand):
                return printer.printed(ir.Binary("<>", operand, ir.IntLiteral(0)))
            case ir.Builtin(function=name) if name in tables.FUNCTIONS and not self.limited:
                return self.function(expression)
            case ir.Convert(how="trunc" | "round_half_away") if not self.limited:
                return self.value(expression)
        return self.operand(expression)

    # ---- conditions

    def condition(self, expression: ir.Expression) -> str:
        """The shorter way: comparisons joined by AND or by OR, else mixed logic in brackets; so are flags, always."""
        plain = self.comparisons(expression)
        return plain if plain is not None and not _FLAG.search(plain) else f"({self.mixed(expression)})"

    def watched(self, expression: ir.Expression) -> str:
        """What SKIP CONDITION and WHEN take: comparisons wherever they say it."""
        plain = self.comparisons(expression)
        return plain if plain is not None else f"({self.mixed(expression)})"

    def comparisons(self, expression: ir.Expression) -> str | None:
        """`R[1]=5 AND DI[2]=ON`; None when it needs brackets."""
        terms: list[ir.Expression] = []
        joint = ""
        left = expression
        while isinstance(left, ir.Binary) and left.op in ("and", "or", "cand", "cor"):
            op = left.op[-3:] if left.op.endswith("and") else "or"
            if joint not in ("", op):
                return None
            joint = op
            terms.insert(0, left.right)
            left = left.left
        terms.insert(0, left)
        shown = [self.comparison(term) for term in terms]
        if len(terms) > tables.LONGEST_PLAIN or any(one is None for one in shown):
            return None
        return f" {joint.upper()} ".join(one for one in shown if one is not None)

    def comparison(self, term: ir.Expression) -> str | None:
        match term:
            case ir.Binary(op=op, left=left, right=right) if op in tables.COMPARISONS:
                if constant(left) is not None or not self.is_place(left):
                    return None
                self.note_texts(left, right)
                first, second = self.simple(left), self.simple(right)
                if first is None or second is None:
                    return None
                return f"{first}{tables.OPERATORS.binary[op].symbol}{second}"
            case ir.Unary(op="not", operand=operand) if self.is_truth(operand):
                return f"{self.place(operand)}=OFF"
            case ir.Builtin(function="text_equal", arguments=(one, other, ir.BoolLiteral(value=True))):
                return f"{self.operand(one)}={self.operand(other)}"
            case ir.Unary(
                op="not",
                operand=ir.Builtin(function="text_equal", arguments=(one, other, ir.BoolLiteral(value=True))),
            ):
                return f"{self.operand(one)}<>{self.operand(other)}"
            case ir.Signal(name=str() as name) if name.upper().startswith("SEMAPHORE"):
                return self.place(term)  # `WAIT SEMAPHORE[1]`
            case _ if self.is_truth(term):
                return f"{self.place(term)}=ON"
        return None

    def is_place(self, expression: ir.Expression) -> bool:
        if isinstance(expression, ir.Convert) and expression.how in ("real", "bit"):
            return self.is_place(expression.operand)
        return isinstance(expression, ir.Signal | ir.Field) or self.simple(expression) is not None

    def is_truth(self, expression: ir.Expression) -> bool:
        """Is it a signal or a flag that is on or off?"""
        if isinstance(expression, ir.Signal):
            return expression.kind.startswith(("digital", "flag"))
        if isinstance(expression, ir.System):
            return expression.name == "flag"
        shown = self.element(expression)
        return shown is not None and shown.startswith("F[")


def constant(expression: ir.Expression) -> float | int | None:
    """The number that is written, with its sign."""
    match expression:
        case ir.IntLiteral(value=number_of):
            return number_of
        case ir.RealLiteral(value=real):
            return int(real) if real == int(real) and abs(real) < 1e9 else real
        case ir.Unary(op="-" | "+" as op, operand=operand):
            inner = constant(operand)
            return None if inner is None else -inner if op == "-" else inner
        case ir.Convert(how="real", operand=operand):
            return constant(operand)
        case ir.Quantity(value=inner_value, unit=unit):
            inner = constant(inner_value)
            return None if inner is None else _clean(inner * ir.UNITS[unit])
    return None


def _any_case(text: ir.Expression) -> ir.Expression:
    """The text whose case does not count; the same where it does."""
    match text:
        case ir.Builtin(function="text_upper" | "text_lower", arguments=(inner,)):
            return inner
    return text


def measured(expression: ir.Expression, unit: str) -> float | int | None:
    """The constant number of a quantity in `unit`; a bare number is in base units."""
    value = constant(expression)
    return None if value is None else _clean(value / ir.UNITS[unit])


def _clean(value: float) -> float | int:
    value = float(f"{value:.12g}")
    return int(value) if value == int(value) and abs(value) < 1e9 else value


def _bare(expression: ir.Expression) -> ir.Expression:
    while isinstance(expression, ir.Convert) and expression.how == "real":
        expression = expression.operand
    return expression


def _what(expression: ir.Expression) -> str:
    words = re.sub(r"(?<=[a-z])(?=[A-Z])", " ", expression.__class__.__name__).lower()
    detail = getattr(expression, "function", getattr(expression, "op", getattr(expression, "name", "")))
    return f"{words} {detail}".strip()

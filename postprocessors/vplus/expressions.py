"""IR expressions as V+. What V+ cannot say raises CannotSayError, and the statement around it is guarded.

A value that only a step of its own can give (the numbers of a location) asks for lines in front: `Notes.before`.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace

from rpl import ir
from rpl.passes.fold import lasting_number
from rpl.passes.scope import Scope
from rpl.passes.typing import type_of
from rpl.writing.precedence import ATOM, ExpressionPrinter, Printed
from rpl.writing.statements import CannotSayError

from . import spelling, tables
from .units import in_unit, scaled


@dataclass(slots=True)
class Notes:
    """What printing a statement finds out on the way: steps in front of it, variables that these need, texts that lost
    signs."""

    before: list[str] = field(default_factory=list)
    autos: list[str] = field(default_factory=list)
    helpers: set[str] = field(default_factory=set)
    changed_texts: list[str] = field(default_factory=list)
    steps: bool = True  # can steps stand in front?
    taken: set[str] = field(default_factory=set)
    own: set[str] = field(default_factory=set)  # names made here
    tasks: Mapping[str, int] = field(default_factory=dict)  # numbers of the programs that are executed beside
    parts: dict[str, str] = field(default_factory=dict)  # a location that steps before took apart -> its array

    def temporary(self, stem: str) -> str:
        """A new variable of the program's own (with its sign)."""
        sign = stem[:1] if stem[:1] in "$#" else ""
        plain = stem[len(sign) :]
        number = 1
        while f"{plain}{number}" in self.taken:
            number += 1
        self.taken.add(f"{plain}{number}")
        self.own.add(f"{plain}{number}")
        return f"{sign}{plain}{number}"

    def forget(self) -> None:
        """Steps in front that were noted down are not written."""
        self.before.clear()
        self.parts.clear()

    def back_to(self, steps: int, autos: int) -> None:
        """As it was when there were so many steps in front and so many variables."""
        del self.before[steps:]
        del self.autos[autos:]
        self.parts = {value: name for value, name in self.parts.items() if f"{name}[5]" in self.autos}

    def step(self, line: str) -> None:
        if not self.steps:
            raise CannotSayError("a step of its own would have to stand inside of a condition")
        self.before.append(line)


class Expressions:
    """Prints the expressions of one routine."""

    def __init__(self, scope: Scope, notes: Notes) -> None:
        from .places import Places
        from .texts import Texts

        self.scope, self.notes = scope, notes
        self.printer = ExpressionPrinter(tables.OPERATORS, self._hook)
        self.places, self.texts = Places(self), Texts(self)

    def text(self, expression: ir.Expression) -> str:
        return self.printer.text(expression)

    def atom(self, expression: ir.Expression) -> str:
        return self.printer.atom(expression)

    def type(self, expression: ir.Expression) -> ir.Type | None:
        return type_of(expression, self.scope)

    def known(self, expression: ir.Expression) -> float | None:
        return lasting_number(expression, self.scope)

    def listed(self, values: tuple[ir.Expression, ...]) -> str:
        return ", ".join(self.text(value) for value in values)

    def measured(self, value: ir.Expression, unit: str) -> str:
        """A quantity in base units or `unit` as a plain number."""
        return self.shortened(in_unit(value, unit), tables.LONGEST_LINE - 16)

    # ---- leaves

    def _hook(self, expression: ir.Expression, printer: ExpressionPrinter) -> str | Printed:
        match expression:
            case ir.IntLiteral(value=number, spelling=spelled):
                return spelled if spelled.startswith("^") else str(number)
            case ir.RealLiteral(value=real, spelling=spelled):
                return spelling.literal(real, spelled)
            case ir.BoolLiteral(value=truth):
                return "TRUE" if truth else "FALSE"
            case ir.TextLiteral(value=text):
                return self.literal(text)
            case ir.Name(id=name) if name.lstrip("$#") in self.notes.own:
                return name
            case ir.Name() | ir.Index() | ir.Field() | ir.Aggregate() | ir.Signal() | ir.System():
                return self.places.value(expression)
            case ir.Binary(op="**", left=left, right=right):
                return self.power((left, right))
            case ir.Binary(op="div", left=left, right=right):
                return f"INT({self.text(ir.Binary('/', left, right))})"
            case ir.Builtin():
                return self.builtin(expression)
            case ir.Quantity(value=value, unit=unit):
                return printer.printed(scaled(value, ir.UNITS[unit]))
            case ir.Magnitude(value=value, unit=unit):
                return printer.printed(scaled(value, 1.0 / ir.UNITS[unit]))
            case ir.Convert():
                return self.converted(expression)
            case ir.VendorValue(dialect="vplus", text=text):
                return text
            case ir.VendorValue(dialect=dialect):
                raise CannotSayError(f"a value that only {dialect} has")
            case ir.Call(name=name):
                raise CannotSayError(f"there are no user functions ({name})")
        raise CannotSayError(f"there is no {_what(expression)}")

    def literal(self, text: str) -> str | Printed:
        shown, lost = spelling.pieces(text)
        if lost:
            self.notes.changed_texts.append(text)
        return shown[0] if len(shown) == 1 else Printed("+".join(shown), tables.SUM)

    def condition(self, expression: ir.Expression) -> str:
        """An expression where only its truth counts."""
        if isinstance(expression, ir.Convert) and expression.how in ("truth", "minus_bit"):
            expression = expression.operand
        return self.text(expression)

    # ---- conversions

    def converted(self, expression: ir.Convert) -> str | Printed:
        operand = expression.operand
        match expression.how:
            case "real" | "minus_bit":
                return self.printer.printed(operand)
            case "bit" if isinstance(operand, ir.BoolLiteral):
                return "1" if operand.value else "0"
            case "bit":
                return Printed(f"-{self.atom(operand)}", tables.SIGN)
            case "truth":
                return Printed(f"{self.printer.text(operand, tables.RELATION + 1)} <> 0", tables.RELATION)
            case "trunc":
                return f"INT({self.text(operand)})"
            case "floor":
                return self.rounded("floor", (operand,))
            case "round_half_away":
                return self.rounded("round", (operand,))
            case "code":
                return f"ASC({self.text(operand)})"
            case "char":
                return f"$CHR({self.text(operand)})"
        raise CannotSayError(f"there is no conversion {expression.how}")

    def rounded(self, name: str, values: tuple[ir.Expression, ...]) -> str | Printed:
        """Rounding and cutting, to whole numbers or to a constant count of decimals."""
        value, places = values[0], values[1] if len(values) > 1 else ir.IntLiteral(0)
        if not isinstance(places, ir.IntLiteral):
            raise CannotSayError("rounding to a computed count of decimals")
        if places.value:
            scale = ir.RealLiteral(10.0**places.value)
            inner = self.rounded(name, (ir.Binary("*", value, scale),))
            whole = inner if isinstance(inner, str) else f"({inner.text})"
            return Printed(f"{whole}/{self.text(scale)}", tables.PRODUCT)
        shown = self.repeated(value)
        cut = f"INT({shown})"
        match name:
            case "trunc":
                return cut
            case "floor":  # a comparison is -1 where it holds
                return Printed(f"{cut}+({shown} < {cut})", tables.SUM)
            case "ceil":
                return Printed(f"{cut}-({shown} > {cut})", tables.SUM)
        grouped = shown if re.fullmatch(r"[\w.$]+", shown) else f"({shown})"
        return f"INT({grouped}+0.5*SIGN({shown}))"

    def repeated(self, value: ir.Expression) -> str:
        """The text of a value that is written more than once: kept in a variable when it is long or random."""
        text = self.text(value)
        if len(text) <= _SHORT and "RANDOM" not in text:
            return self.printer.text(value, tables.RELATION + 1)
        return self.kept(text, "r")

    def kept(self, text: str, stem: str, word: str = "") -> str:
        """A variable of the program's own that holds a value."""
        name = self.notes.temporary(stem)
        self.notes.step(f"{word}{name} = {text}")
        self.notes.autos.append(name)
        return name

    def moved_in_front(self, value: ir.Expression) -> str:
        """The value in a variable of the program's own, the step that sets it short enough."""
        stem, word = "t", ""
        match self.type(value):
            case ir.StringType() | ir.CharType():
                stem = "$t"
            case ir.JointsType():
                stem, word = "#t", "SET "
            case ir.PoseType() | ir.TargetType() | ir.VectorType() | ir.RotationType():
                stem, word = "p", "SET "
        return self.kept(self.shortened(value, tables.LONGEST_LINE - 16), stem, word)

    def shortened(self, value: ir.Expression, room: int) -> str:
        """The text of a value in at most `room` signs, as far as parts of it can be calculated in front."""
        known = len(self.notes.before), len(self.notes.autos)
        text = self.text(value)
        if len(text) <= room or not self.notes.steps:
            return text
        self.notes.back_to(*known)
        return self.text(self.in_lines(value, room))

    def in_lines(self, whole: ir.Expression, room: int) -> ir.Expression:
        """The value with parts calculated in front until it has at most `room` signs. Inner parts come first, each
        printed once it is short, so that a long chain costs no more than its length."""
        todo: list[tuple[ir.Expression, bool]] = [(whole, False)]
        done: list[ir.Expression] = []
        while todo:
            value, entered = todo.pop()
            parts = _operands(value)
            if not entered:
                todo.append((value, True))
                todo.extend((part, False) for part in reversed(parts))
                continue
            first = len(done) - len(parts)
            for at, part in enumerate(done[first:]):
                if part is not parts[at]:
                    value = _with_operand(value, at, part)
            del done[first:]
            done.append(self.within(value, tables.LONGEST_LINE - 16 if todo else room))
        return done[0]

    def within(self, value: ir.Expression, room: int) -> ir.Expression:
        """The value with its longest operands in variables, as many as it takes to be short enough."""
        while self.length(value) > room:
            parts = [(self.length(part), at) for at, part in enumerate(_operands(value))]
            if not parts or max(parts)[0] <= _NAME:
                return value
            at = max(parts)[1]
            name = self.moved_in_front(_operands(value)[at])
            value = _with_operand(value, at, ir.Name(name))
        return value

    def length(self, value: ir.Expression) -> int:
        """The signs of a value's text, without the steps that printing it takes."""
        known = len(self.notes.before), len(self.notes.autos)
        text = self.text(value)
        self.notes.back_to(*known)
        return len(text)

    def fitted(self, values: list[ir.Expression], room: int) -> list[str]:
        """Values side by side in one step, the longest ones calculated in front where they are too long together."""
        shown = [self.text(value) for value in values]
        while sum(len(one) + 2 for one in shown) > room and self.notes.steps:
            at = max(range(len(shown)), key=lambda place: len(shown[place]))
            if len(shown[at]) <= _NAME:
                return shown
            shown[at] = self.moved_in_front(values[at])
        return shown

    # ---- functions

    def builtin(self, call: ir.Builtin) -> str | Printed:
        name, values = call.function, call.arguments
        if name in tables.VALUES and not values:
            return tables.VALUES[name]
        if name == "inverse" and values == (ir.System("base"),):
            return "BASE"
        special = _SPECIAL.get(name)
        if special is not None:
            return special(self, values)
        if name in ("round", "trunc", "floor", "ceil"):
            return self.rounded(name, values)
        if name in tables.FUNCTIONS:
            return f"{tables.FUNCTIONS[name]}({self.listed(values)})"
        found = self.places.locations.function(call)
        found = found if found is not None else self.texts.function(name, values)
        if found is None:
            raise CannotSayError(f"there is no function {name}")
        return found

    def tangent(self, values: tuple[ir.Expression, ...]) -> Printed:
        angle = self.repeated(values[0])
        return Printed(f"SIN({angle}) / COS({angle})", tables.PRODUCT)

    def arc(self, values: tuple[ir.Expression, ...], cosine: bool) -> str:
        """asin and acos by the angle of a vector."""
        one = self.repeated(values[0])
        other = f"SQRT(1-SQR({one}))"
        return f"ATAN2({other}, {one})" if cosine else f"ATAN2({one}, {other})"

    def sign(self, values: tuple[ir.Expression, ...]) -> Printed:
        value = self.repeated(values[0])
        return Printed(f"({value} < 0)-({value} > 0)", tables.SUM)

    def shifted(self, values: tuple[ir.Expression, ...]) -> Printed:
        count = self.known(values[1])
        if count is None:
            factor = self.raised(ir.IntLiteral(2), values[1])
            return Printed(f"{self.printer.text(values[0], tables.PRODUCT)}*{factor}", tables.PRODUCT)
        return Printed(f"{self.printer.text(values[0], tables.PRODUCT)}*{2 ** int(count)}", tables.PRODUCT)

    def power(self, values: tuple[ir.Expression, ...]) -> str | Printed:
        count = self.known(values[1])
        if count is None or tables.is_raised(count):
            return self.raised(*values)
        if count in (0.5, 2):
            return f"{'SQR' if count == 2 else 'SQRT'}({self.text(values[0])})"
        base = self.repeated(values[0])
        factor = base if re.fullmatch(r"[\w.$]+", base) else f"({base})"
        return Printed("*".join([factor] * int(count)), tables.PRODUCT)

    def undefined(self, values: tuple[ir.Expression, ...]) -> Printed:
        return Printed(f"NOT DEFINED({self.text(values[0])})", tables.SIGN)

    def executing(self, values: tuple[ir.Expression, ...]) -> Printed:
        """Whether a task runs: 4 is the state of one that executes."""
        name = values[0].value.lower() if isinstance(values[0], ir.TextLiteral) else ""
        number = self.notes.tasks.get(name)
        if number is None:
            raise CannotSayError(f"the state of a task that is not executed here ({name or 'computed'})")
        return Printed(f"TASK(1, {number}) == 4", tables.RELATION)

    def raised(self, base: ir.Expression, exponent: ir.Expression) -> str:
        """Any power, by a program that comes along."""
        name = self.notes.temporary("t")
        self.notes.autos.append(name)
        self.notes.step(self.raising(base, exponent, name))
        return name

    def raising(self, base: ir.Expression, exponent: ir.Expression, place: str) -> str:
        """The call that works out a power in a variable."""
        self.notes.helpers.add("rpl.power")
        return f"CALL rpl.power({self.value(base)}, {self.value(exponent)}, {place})"

    def brought(self, wanted: ir.Builtin, place: str) -> str | None:
        """The call of a program that comes along and gives the value in a variable; None where V+ says it itself."""
        match wanted:
            case ir.Builtin(function="power", arguments=(base, exponent)):
                count = self.known(exponent)
                return self.raising(base, exponent, place) if count is None or tables.is_raised(count) else None
            case ir.Builtin(function=name, arguments=values) if name in tables.BROUGHT_TEXTS:
                return self.texts.brought(name, values, place)
        return None

    def value(self, expression: ir.Expression) -> str:
        """An argument by its value."""
        text = self.text(expression)
        return f"({text})" if isinstance(expression, ir.Name | ir.Index) else text

    def dimension(self, values: tuple[ir.Expression, ...]) -> str:
        type = self.type(values[0])
        number = values[1].value if len(values) > 1 and isinstance(values[1], ir.IntLiteral) else 1
        if isinstance(type, ir.ArrayType) and 0 < number <= len(type.dimensions):
            bound = type.dimensions[number - 1]
            if bound is not None:
                last = self.known(bound)
                if last is not None:
                    return spelling.number(last - type.base + 1)
        if isinstance(type, ir.StringType):
            return f"LEN({self.text(values[0])})"
        raise CannotSayError("an array cannot be asked for its size")


_SHORT = 30
_NAME = 8  # a value that is no longer than this gets no variable
_Special = Callable[[Expressions, tuple[ir.Expression, ...]], "str | Printed"]
_SPECIAL: dict[str, _Special] = {
    "tan": Expressions.tangent,
    "asin": lambda e, v: e.arc(v, False),
    "acos": lambda e, v: e.arc(v, True),
    "atan": lambda e, v: f"ATAN2({e.text(v[0])}, 1)",
    "sign": Expressions.sign,
    "power": Expressions.power,
    "bit_shift_left": Expressions.shifted,
    "is_uninitialised": Expressions.undefined,
    "task_runs": Expressions.executing,
    "dimension": Expressions.dimension,
    "length": Expressions.dimension,
}


def _operands(value: ir.Expression) -> tuple[ir.Expression, ...]:
    """The parts of a value that could be calculated before."""
    match value:
        case ir.Binary(left=left, right=right):
            return left, right
        case ir.Unary(operand=operand) | ir.Convert(operand=operand):
            return _operands(operand) if isinstance(operand, ir.Binary | ir.Builtin) else (operand,)
        case ir.Builtin(arguments=arguments) if value.function not in ("format", "message_text", "is_uninitialised"):
            return arguments
        case ir.Aggregate(entries=entries):
            return tuple(part for _, part in entries)
        case ir.Field(base=base):
            return (base,)
    return ()


def _with_operand(value: ir.Expression, at: int, new: ir.Expression) -> ir.Expression:
    """The value with one of its parts exchanged."""
    match value:
        case ir.Binary():
            return replace(value, left=new) if at == 0 else replace(value, right=new)
        case ir.Unary(operand=operand) | ir.Convert(operand=operand):
            inner = _with_operand(operand, at, new) if isinstance(operand, ir.Binary | ir.Builtin) else new
            return replace(value, operand=inner)
        case ir.Builtin(arguments=arguments):
            return replace(value, arguments=(*arguments[:at], new, *arguments[at + 1 :]))
        case ir.Aggregate(entries=entries):
            return replace(value, entries=(*entries[:at], (entries[at][0], new), *entries[at + 1 :]))
        case ir.Field():
            return replace(value, base=new)
    return value


def _what(expression: ir.Expression) -> str:
    words = re.sub(r"(?<=[a-z])(?=[A-Z])", " ", expression.__class__.__name__).lower()
    return f"{words} {getattr(expression, 'how', getattr(expression, 'op', ''))}".strip()


__all__ = ["ATOM", "Expressions", "Notes", "CannotSayError"]

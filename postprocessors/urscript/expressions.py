"""IR expressions as URScript. Numbers stay in the source's mm and degrees; poses and joints are in metres and radians.

What URScript cannot say raises CannotSayError, and the statement around it is guarded. Functions that the program has
to bring along are noted in `Notes.helpers`.
"""

from __future__ import annotations

import re
from collections.abc import Callable
from dataclasses import dataclass, field

from rpl import ir
from rpl.passes.fold import constant_number
from rpl.passes.scope import Scope
from rpl.passes.typing import type_of
from rpl.writing.precedence import ExpressionPrinter, Printed
from rpl.writing.statements import CannotSayError

from . import spelling, tables
from .geometry import Geometry
from .places import Places
from .units import scaled

_WHOLE = re.compile(r"\d+")
_POSES = (ir.PoseType, ir.TargetType, ir.VectorType, ir.RotationType)


@dataclass(slots=True)
class Notes:
    """What printing finds out on the way: helper functions, watches and texts that needed a change."""

    helpers: set[str] = field(default_factory=set)
    changed_texts: list[str] = field(default_factory=list)


class Expressions:
    """Prints the expressions of one scope."""

    def __init__(self, scope: Scope, notes: Notes) -> None:
        self.scope, self.notes = scope, notes
        self.printer = ExpressionPrinter(tables.OPERATORS, self._hook)
        self.geometry = Geometry(self)
        self.places = Places(self, self.geometry.three)

    def text(self, expression: ir.Expression) -> str:
        return self.printer.text(expression)

    def atom(self, expression: ir.Expression) -> str:
        return self.printer.atom(expression)

    def type(self, expression: ir.Expression) -> ir.Type | None:
        return type_of(expression, self.scope)

    def is_pose(self, expression: ir.Expression) -> bool:
        return isinstance(self.type(expression), _POSES)

    def whole(self, expression: ir.Expression) -> bool:
        """Is it a whole number for URScript? A widening conversion leaves no trace of its own."""
        match expression:
            case ir.Convert(how="real", operand=operand) | ir.Unary(op="-" | "+", operand=operand):
                return self.whole(operand)
            case ir.Binary(op="+" | "-" | "*", left=left, right=right):
                return self.whole(left) and self.whole(right)
        return isinstance(self.type(expression), ir.IntType)

    def helper(self, name: str, *arguments: str) -> str:
        """A call of a function that the program brings along."""
        self.notes.helpers.add(name)
        return f"{name}({', '.join(arguments)})"

    def listed(self, values: tuple[ir.Expression, ...]) -> str:
        return ", ".join(self.text(value) for value in values)

    # ---- numbers with units

    def measured(self, value: ir.Expression, unit: str) -> str:
        """A quantity (mm, s, deg, ...) as the number that URScript wants, in `unit`."""
        return self.printer.text(self.in_unit(value, unit))

    def in_unit(self, value: ir.Expression, unit: str) -> ir.Expression:
        """The plain number of `unit` that a quantity is."""
        match value:
            case ir.Quantity(value=inner, unit=own):
                if own == unit:
                    return inner
                return scaled(inner, ir.UNITS[own] / ir.UNITS[unit])
            case ir.Unary(op="-" | "+", operand=operand) if _has_unit(operand):
                return ir.Unary(value.op, self.in_unit(operand, unit))
            case ir.Binary(op="+" | "-" as op, left=left, right=right) if _has_unit(left) or _has_unit(right):
                return ir.Binary(op, self.in_unit(left, unit), self.in_unit(right, unit))
        if ir.UNITS[unit] == 1.0:
            return value
        return ir.Magnitude(value, unit)

    def magnitude(self, value: ir.Expression, unit: str) -> str | Printed:
        """A quantity as a number of `unit`."""
        known = constant_number(value, self.scope) if _is_number(value) else None
        match value, unit:
            case ir.Quantity(), _:
                return self.printer.printed(self.in_unit(value, unit))
            case ir.Field(base=base, name=name), _:
                own = self.places.component(base, name)
                if own is not None and own[1] == unit:
                    return own[0]
            case ir.Builtin(function="distance", arguments=(one, other)), "m":
                return self.geometry.apart(one, other)
            case ir.Builtin(), "rad":
                inner = self.angle(value)
                if inner is not None:
                    return inner
        if known is not None:
            return self.printer.printed(scaled(ir.RealLiteral(known), 1.0 / ir.UNITS[unit]))
        if unit in ("rad", "rad/s", "rad/s2"):
            return f"d2r({self.text(value)})"
        return self.printer.printed(scaled(value, 1.0 / ir.UNITS[unit]))

    def angle(self, call: ir.Builtin) -> str | None:
        """In radians what a function of the controller gives in radians."""
        if call.function in tables.FROM_ANGLE:
            return f"{tables.FROM_ANGLE[call.function]}({self.listed(call.arguments)})"
        return self.geometry.radians(call.function, call.arguments[0]) if len(call.arguments) == 1 else None

    # ---- leaves

    def _hook(self, expression: ir.Expression, printer: ExpressionPrinter) -> str | Printed:
        match expression:
            case ir.IntLiteral(value=number, spelling=spelled):
                return spelled if _WHOLE.fullmatch(spelled) and int(spelled) == number else str(number)
            case ir.RealLiteral(value=real, spelling=spelled):
                return spelling.real_text(real, spelled)
            case ir.BoolLiteral(value=truth):
                return "True" if truth else "False"
            case ir.TextLiteral(value=text):
                return self.literal(text)
            case ir.Name(id=name):
                signal = self.places.declared(name)
                return name if signal is None else self.places.signal(signal)
            case ir.Index() | ir.Field() | ir.Aggregate() | ir.Signal() | ir.System():
                return self.places.value(expression)
            case ir.Binary():
                return self.operation(expression)
            case ir.Call(name=name, arguments=arguments):
                return f"{name}({self.arguments(name, arguments)})"
            case ir.Builtin():
                return self.builtin(expression)
            case ir.Quantity(value=value, unit=unit):
                return printer.printed(scaled(value, ir.UNITS[unit]))
            case ir.Magnitude(value=value, unit=unit):
                return self.magnitude(value, unit)
            case ir.Convert():
                return self.converted(expression)
            case ir.VendorValue(dialect="urscript", text=text):
                return text
            case ir.VendorValue(dialect=dialect):
                raise CannotSayError(f"a value that only {dialect} has")
        raise CannotSayError(f"there is no {_what(expression)}")

    def literal(self, text: str) -> str:
        """A text between quotes. URScript has no way to write a quote or a line end inside."""
        plain = spelling.ascii_text(text.replace("\n", " ").replace('"', "'"))
        if plain != text:
            self.notes.changed_texts.append(text)
        return f'"{plain}"'

    def arguments(self, name: str, arguments: tuple[ir.Argument, ...]) -> str:
        routine = self.scope.routine(name)
        types = [parameter.type for parameter in routine.parameters] if routine is not None else []
        shown = []
        for at, argument in enumerate(arguments):
            if argument.value is None or argument.if_present is not None:
                raise CannotSayError("an argument cannot be left out here")
            text = self.given(argument.value, types[at] if at < len(types) and not argument.name else None)
            shown.append(f"{argument.name}={text}" if argument.name else text)
        return ", ".join(shown)

    def given(self, value: ir.Expression, wanted: ir.Type | None = None) -> str:
        """A value that fixes the type of what it is put into: a real one is spelled so that it is one."""
        if isinstance(wanted, ir.RealType) and isinstance(self.type(value), ir.IntType):
            value = ir.Convert("real", value)
        match value:
            case ir.Convert(how="real", operand=operand) if self.whole(operand):
                if isinstance(operand, ir.IntLiteral):
                    return spelling.real_text(float(operand.value))
                return f"1.0 * {self.atom(operand)}"
        return self.text(value)

    # ---- operators and conversions

    def operation(self, expression: ir.Binary) -> str | Printed:
        op, left, right = expression.op, expression.left, expression.right
        name = tables.OPERATOR_FUNCTIONS.get(op)
        if name is None:
            raise CannotSayError(f"there is no operator {op}")
        if op == ":":
            pose = self.places.constant(expression)
            if pose is not None:
                return pose
        if op in ("div", "mod") and not (self.whole(left) and self.whole(right)):
            raise CannotSayError("a whole division of numbers with fractions")
        arguments = (self.text(left), self.text(right))
        return self.helper(name, *arguments) if name.startswith("rpl_") else f"{name}({', '.join(arguments)})"

    def converted(self, expression: ir.Convert) -> str | Printed:
        operand = expression.operand
        match expression.how:
            case "real":
                if isinstance(operand, ir.IntLiteral):
                    return spelling.real_text(float(operand.value))
                return self.printer.printed(operand)
            case "round_half_away" | "trunc" | "floor" if self.whole(operand):
                return self.printer.printed(operand)
            case "round_half_away":
                return self.helper("rpl_rounded", self.text(operand))
            case "trunc":
                return self.helper("rpl_trunc", self.text(operand))
            case "floor":
                return f"floor({self.text(operand)})"
            case "code":
                return self.helper("rpl_code", self.text(operand))
            case "char":
                return self.helper("rpl_char", self.text(operand))
            case "bit":
                return self.helper("rpl_bit", self.text(operand))
            case "truth":
                return Printed(f"{self.printer.text(operand, tables.RELATION + 1)} != 0", tables.RELATION)
        raise CannotSayError(f"there is no conversion {expression.how}")

    # ---- functions

    def builtin(self, call: ir.Builtin) -> str | Printed:
        name, values = call.function, call.arguments
        if name in tables.TO_ANGLE:
            return f"{tables.TO_ANGLE[name]}({self.measured(values[0], 'rad')})"
        angle = self.angle(call)
        if angle is not None:
            return f"r2d({angle})"
        special = _SPECIAL.get(name)
        if special is not None:
            return special(self, values)
        if name in ("compose", "inverse", "interpolate_pose", "pose_of", "offset", "tool_offset"):
            pose = self.places.constant(call)
            if pose is not None:
                return pose
        if name in tables.FUNCTIONS:
            spelled = tables.FUNCTIONS[name]
            if spelled.startswith("rpl_"):
                return self.helper(spelled, *map(self.text, values))
            return f"{spelled}({self.listed(values)})"
        geometric = self.geometry.function(name, values)
        if geometric is None:
            raise CannotSayError(f"there is no function {name}")
        return geometric

    def rounded(self, name: str, values: tuple[ir.Expression, ...]) -> str | Printed:
        """Rounding and cutting, to whole numbers or to a count of decimals."""
        places = values[1] if len(values) > 1 else ir.IntLiteral(0)
        if places == ir.IntLiteral(0):
            return self.helper(name, self.text(values[0]))
        if not isinstance(places, ir.IntLiteral):
            raise CannotSayError("rounding to a computed count of decimals")
        scale = spelling.real_text(10.0**places.value)
        if name == "rpl_rounded":
            return self.helper("rpl_decimals", self.text(values[0]), scale)
        inner = self.helper(name, f"{self.atom(values[0])} * {scale}")
        return Printed(f"{inner} / {scale}", tables.PRODUCT)

    def part(self, values: tuple[ir.Expression, ...]) -> str:
        text, start, count = values
        return f"str_sub({self.text(text)}, {self.text(before(start))}, {self.text(count)})"

    def find(self, values: tuple[ir.Expression, ...]) -> Printed:
        text, start, wanted = values
        first = "" if start == ir.IntLiteral(1) else f", {self.text(before(start))}"
        return Printed(f"str_find({self.text(text)}, {self.text(wanted)}{first}) + 1", tables.SUM)

    def equal(self, values: tuple[ir.Expression, ...]) -> Printed:
        one, other, *rest = values
        if rest and rest[0] != ir.BoolLiteral(False):
            upper = [self.helper("rpl_upper", self.text(value)) for value in (one, other)]
            return Printed(f"{upper[0]} == {upper[1]}", tables.RELATION)
        return Printed(f"{self.atom(one)} == {self.atom(other)}", tables.RELATION)

    def fraction(self, values: tuple[ir.Expression, ...]) -> Printed:
        return Printed(f"{self.atom(values[0])} - {self.helper('rpl_trunc', self.text(values[0]))}", tables.SUM)

    def value_text(self, values: tuple[ir.Expression, ...]) -> str:
        """The controller would write a value with components in its own way."""
        type = self.type(values[0])
        if isinstance(type, ir.ArrayType | ir.NamedType) or type.__class__ in ir.POSITIONAL:
            raise CannotSayError("a text of a value with components")
        return f"to_str({self.text(values[0])})"

    def dimension(self, values: tuple[ir.Expression, ...]) -> str:
        type = self.type(values[0])
        bounds = type.dimensions if isinstance(type, ir.ArrayType) else ()
        number = values[1].value if len(values) > 1 and isinstance(values[1], ir.IntLiteral) else 0
        found = bounds[number - 1] if 0 < number <= len(bounds) else None
        if found is not None and isinstance(type, ir.ArrayType):
            return self.atom(_size(found, type.base))
        if len(bounds) == 1:
            return f"length({self.text(values[0])})"
        raise CannotSayError("an array cannot be asked for the size of one of its dimensions")


def _size(bound: ir.Expression, base: int) -> ir.Expression:
    """How many elements there are from `base` to the bound."""
    if base == 1:
        return bound
    if isinstance(bound, ir.IntLiteral):
        return ir.IntLiteral(bound.value - base + 1)
    return ir.Binary("+", bound, ir.IntLiteral(1 - base))


def before(index: ir.Expression) -> ir.Expression:
    """A place counted from 1 as one counted from 0."""
    match index:
        case ir.IntLiteral(value=number):
            return ir.IntLiteral(number - 1)
        case ir.Binary(op="+", left=left, right=ir.IntLiteral(value=1)):
            return left
    return ir.Binary("-", index, ir.IntLiteral(1))


def _has_unit(value: ir.Expression) -> bool:
    match value:
        case ir.Quantity():
            return True
        case ir.Unary(operand=operand):
            return _has_unit(operand)
        case ir.Binary(op="+" | "-", left=left, right=right):
            return _has_unit(left) or _has_unit(right)
    return False


def _is_number(value: ir.Expression) -> bool:
    """Is it written as a number?"""
    if isinstance(value, ir.Unary | ir.Convert):
        return _is_number(value.operand)
    return isinstance(value, ir.IntLiteral | ir.RealLiteral)


def _what(expression: ir.Expression) -> str:
    words = re.sub(r"(?<=[a-z])(?=[A-Z])", " ", expression.__class__.__name__).lower()
    return f"{words} {getattr(expression, 'how', getattr(expression, 'op', ''))}".strip()


_E = "2.718281828459045"
_Special = Callable[[Expressions, tuple[ir.Expression, ...]], "str | Printed"]
_SPECIAL: dict[str, _Special] = {
    "value_text": lambda e, v: e.value_text(v),
    "exp": lambda e, v: f"pow({_E}, {e.text(v[0])})",
    "log": lambda e, v: f"log({_E}, {e.text(v[0])})",
    "log10": lambda e, v: f"log(10, {e.text(v[0])})",
    "clock_seconds": lambda e, v: e.text(v[0]),
    "round": lambda e, v: e.rounded("rpl_rounded", v),
    "trunc": lambda e, v: e.rounded("rpl_trunc", v),
    "fraction": Expressions.fraction,
    "text_part": Expressions.part,
    "text_find": Expressions.find,
    "text_equal": Expressions.equal,
    "dimension": Expressions.dimension,
}

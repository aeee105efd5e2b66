"""IR expressions as KRL text. Brackets stand around every mixed operand, because KRL lets relations bind loosest."""

from __future__ import annotations

import re
from dataclasses import replace

from rpl import ir
from rpl.passes.rewrite import rewrite_parts
from rpl.passes.scope import Scope
from rpl.passes.typewords import component_type
from rpl.passes.typing import type_of
from rpl.writing.precedence import ExpressionPrinter, Printed
from rpl.writing.statements import CannotSayError
from rpl.writing.text import ALWAYS_POINT, number_text

from . import tables

_LEAVES = (ir.IntLiteral, ir.RealLiteral, ir.BoolLiteral, ir.TextLiteral, ir.EnumLiteral, ir.Name, ir.Aggregate)
_PLACES = (ir.PoseType, ir.TargetType, ir.JointsType)
_DECIMALS = 6  # of places that are worked out, mm and degrees: as many as a REAL of the controller holds
_REAL = re.compile(r"(?:\d+\.\d*|\.\d+)(?:[eE][+-]?\d+)?|\d+[eE][+-]?\d+")
_BITS = re.compile(r"'[BHbh][0-9A-Fa-f]+'")


class Expressions:
    """Prints expressions inside of one scope."""

    def __init__(self, scope: Scope) -> None:
        self.scope = scope
        self.printer = ExpressionPrinter(tables.OPERATORS, self._hook)

    def text(self, expression: ir.Expression) -> str:
        """The expression; an untyped aggregate keeps the type that its place does not give."""
        return self.printer.text(self.divided(expression))

    def divided(self, expression: ir.Expression) -> ir.Expression:
        """KRL's `/` goes by the operands' types, so a real division of whole numbers gets a real operand, and a whole
        one has whole operands only."""
        if isinstance(expression, _LEAVES):
            return expression
        done = rewrite_parts(expression, self.divided)
        if not isinstance(done, ir.Binary) or done.op not in ("/", "div"):
            return done
        whole = [self.whole(side) for side in (done.left, done.right)]
        if done.op == "div":
            if not all(whole):
                raise CannotSayError("a whole division of numbers that KRL takes for real ones")
            return done
        if not all(whole):
            return done
        left, right = _bare(done.left), _bare(done.right)
        if isinstance(left, ir.IntLiteral):
            return replace(done, left=ir.RealLiteral(float(left.value)))
        if isinstance(right, ir.IntLiteral):
            return replace(done, right=ir.RealLiteral(float(right.value)))
        return replace(done, left=ir.Binary("*", ir.RealLiteral(1.0), done.left))

    def whole(self, expression: ir.Expression) -> bool:
        """Does KRL take what is written for a whole number? A conversion to a real number leaves no trace in it."""
        match expression:
            case ir.Convert(how="real" | "round_half_away", operand=operand) | ir.Unary(op="-" | "+", operand=operand):
                return self.whole(operand)
            case ir.Magnitude(value=ir.System(name=name), unit=unit):
                return name in tables.COUNTED and tables.SYSTEM.get(name, ("", ""))[1] == unit
            case ir.Binary(op="+" | "-" | "*", left=left, right=right):
                return self.whole(left) and self.whole(right)
            case ir.Builtin(function="abs" | "min" | "max", arguments=arguments):
                return all(part is not None and self.whole(part) for part in arguments)
        return isinstance(self.type(expression), ir.IntType)

    def stored(self, expression: ir.Expression) -> str:
        """A value in a place whose type is known: the aggregate needs no type of its own."""
        if isinstance(expression, ir.Aggregate):
            return self.aggregate(expression, typed=False)
        return self.text(expression)

    def type(self, expression: ir.Expression) -> ir.Type | None:
        return type_of(expression, self.scope)

    def measured(self, value: ir.Expression, unit: str) -> str:
        """A quantity as the number that KRL wants: in `unit`."""
        if not unit:
            return self.text(value.value if isinstance(value, ir.Quantity) and _same(value.unit) else value)
        from_unit = value.unit if isinstance(value, ir.Quantity) else ""
        inner = value.value if isinstance(value, ir.Quantity) else value
        factor = (ir.UNITS[from_unit] if from_unit else 1.0) / ir.UNITS[unit]
        return self.scaled(inner, factor)

    def scaled(self, value: ir.Expression, factor: float) -> str:
        """`value * factor`, worked out when the value is written as a number."""
        if factor == 1:
            return self.text(value)
        match value:
            case ir.RealLiteral(value=number) | ir.IntLiteral(value=number):
                return number_text(_scale(float(number), factor), style=ALWAYS_POINT)
            case ir.Unary(op="-", operand=ir.RealLiteral() | ir.IntLiteral() as literal):
                return "-" + self.scaled(literal, factor)
            case ir.Convert(operand=operand):
                return self.scaled(operand, factor)
        if factor > 1:
            return f"{self.printer.atom(value)}*{number_text(factor, style=ALWAYS_POINT)}"
        return f"{self.printer.atom(value)}/{number_text(round(1 / factor, 9), style=ALWAYS_POINT)}"

    # ---- leaves

    def _hook(self, expression: ir.Expression, printer: ExpressionPrinter) -> str | Printed:
        match expression:
            case ir.IntLiteral() | ir.RealLiteral() | ir.BoolLiteral() | ir.TextLiteral() | ir.EnumLiteral():
                return literal(expression)
            case ir.Name() | ir.Index() | ir.Field():
                return self.place(expression)
            case ir.Call(name=name, arguments=arguments):
                return f"{name}({self.arguments(arguments)})"
            case ir.Builtin():
                return self.builtin(expression)
            case ir.Aggregate():
                return self.aggregate(expression, typed=True)
            case ir.System():
                return self.system(expression, "")
            case ir.Magnitude(value=ir.System() as variable, unit=unit):
                return self.system(variable, unit)
            case ir.Signal():
                return self.signal(expression)
            case ir.VendorValue(dialect="krl", text=text):
                return text
            case ir.Convert(how="code", operand=ir.TextLiteral(value=sign)) if len(sign) == 1:
                return printer.printed(ir.IntLiteral(ord(sign)))
            case ir.Convert(how="code", operand=ir.Convert(how="char", operand=code)):
                return printer.printed(code)
            case ir.Convert(how="char", operand=ir.IntLiteral(value=number)) if number in range(32, 127):
                return printer.printed(ir.TextLiteral(chr(number)))
            case ir.Convert(how=how, operand=operand) if how in tables.SILENT_CONVERSIONS:
                return printer.printed(operand)
            case ir.Quantity(value=value, unit=unit):
                return Printed(self.scaled(value, ir.UNITS[unit]), 0 if ir.UNITS[unit] != 1 else 1000)
        raise CannotSayError(f"no KRL for {_what(expression)}")

    def place(self, expression: ir.Name | ir.Index | ir.Field) -> str:
        """A variable, element or component. Whole arrays and texts carry empty brackets."""
        return self.bare(expression) + self.brackets(expression)

    def brackets(self, expression: ir.Expression) -> str:
        type = self.type(expression)
        if isinstance(expression, ir.Index):
            return ""
        if isinstance(type, ir.StringType):
            return "[]"
        if isinstance(type, ir.ArrayType):
            count = len(type.dimensions) + isinstance(self.scope.resolve(type.element), ir.StringType)
            return f"[{',' * (count - 1)}]"
        return ""

    def bare(self, expression: ir.Expression) -> str:
        match expression:
            case ir.Name(id=name):
                return name
            case ir.Field(base=base, name=name):
                return f"{self.bare(base)}.{self.component(base, name)}"
            case ir.Index():
                return self.indexed(expression)
            case ir.System():
                return self.system(expression, "")
            case ir.Magnitude(value=ir.System() as variable, unit=unit):
                return self.system(variable, unit)
        raise CannotSayError("KRL has no component of a computed value")

    def indexed(self, expression: ir.Index) -> str:
        """`A[i,j]`; a character of a row of texts is one bracket: `T[i,j]`; a row of its own is `T[i,]`."""
        base, indices = expression.base, list(expression.indices)
        while isinstance(base, ir.Index):
            indices[:0] = base.indices
            base = base.base
        shown = ",".join(self.text(index) for index in indices)
        type = self.type(expression)
        if isinstance(type, ir.StringType):
            return f"{self.bare(base)}[{shown},]"
        if isinstance(type, ir.ArrayType):
            rest = len(type.dimensions) + isinstance(self.scope.resolve(type.element), ir.StringType)
            return f"{self.bare(base)}[{shown}{',' * rest}]"
        return f"{self.bare(base)}[{shown}]"

    def component(self, base: ir.Expression, name: str) -> str:
        type = self.type(base)
        return component_name(type, name)

    def arguments(self, arguments: tuple[ir.Argument, ...]) -> str:
        if any(argument.name or argument.if_present for argument in arguments):
            raise CannotSayError("KRL has no arguments by name")
        shown = [self.text(argument.value) if argument.value is not None else "" for argument in arguments]
        return ",".join(shown)

    def builtin(self, call: ir.Builtin) -> str:
        name, values = call.function, call.arguments
        if name in tables.FUNCTIONS:
            return f"{tables.FUNCTIONS[name]}({self.listed(values)})"
        match name, values:
            case "text_equal", (one, other, *rest):
                ignore = bool(rest) and isinstance(rest[0], ir.BoolLiteral) and rest[0].value
                mode = "#NOT_CASE_SENS" if ignore else "#CASE_SENS"
                return f"StrComp({self.text(one)},{self.text(other)},{mode})"
            case "text_find", (
                ir.Builtin(function="text_upper", arguments=(text,)),
                start,
                ir.Builtin(function="text_upper", arguments=(wanted,)),
            ):
                return f"StrFind({self.listed((start, text, wanted))},#NOT_CASE_SENS)"
            case "text_find", (text, start, wanted):
                return f"StrFind({self.listed((start, text, wanted))},#CASE_SENS)"
            case "is_uninitialised", (ir.Name(id=variable),):
                return f'(VARSTATE("{variable}")<>#INITIALIZED)'
            case "dimension", (array, ir.IntLiteral(value=number)):
                return self.bound(array, number)
            case "length", (array,) if isinstance(self.type(array), ir.ArrayType):
                return self.bound(array, 1)
            case "compose", (first, second):
                return f"({self.printer.atom(first)}:{self.printer.atom(second)})"
        if name in tables.PROCEDURES:
            return "{procedure}({arguments})".format(**self.procedure(name, values))
        raise CannotSayError(f"KRL has no function {name}")

    def bound(self, array: ir.Expression, number: int) -> str:
        """A declared array's size is known while writing; a parameter's is not."""
        type = self.type(array)
        bounds = type.dimensions if isinstance(type, ir.ArrayType) else ()
        found = bounds[number - 1] if 0 < number <= len(bounds) else None
        if found is None:
            raise CannotSayError("KRL cannot ask an array for its size")
        return self.printer.atom(found)

    def procedure(self, name: str, values: tuple[ir.Expression | None, ...]) -> dict[str, str]:
        spelled = tables.PROCEDURES[name]
        target = values[1] if len(values) > 1 else None
        if name in ("parse_number", "parse_value") and target is not None:
            found = tables.PARSERS.get(self.type(target).__class__)
            if found is None:
                raise CannotSayError("KRL reads INT, REAL and BOOL from a text, nothing else")
            spelled = found
        if any(value is None for value in values):
            raise CannotSayError(f"KRL's {spelled} needs all its arguments")
        return {"procedure": spelled, "arguments": self.listed(tuple(value for value in values if value is not None))}

    def listed(self, values: tuple[ir.Expression, ...]) -> str:
        return ",".join(self.text(value) for value in values)

    # ---- structured values, system variables, signals

    def aggregate(self, aggregate: ir.Aggregate, typed: bool) -> str:
        known = _aggregate_type(aggregate, self.scope)
        parts = []
        for name, value in aggregate.entries:
            if name is None:
                raise CannotSayError("KRL's aggregates name their components")
            inner = component_type(known, name, self.scope) if known is not None else None
            text = isinstance(inner, ir.StringType) or isinstance(value, ir.TextLiteral)
            shown = component_name(known, name) + ("[]" if text and not isinstance(inner, ir.CharType) else "")
            match value:
                case ir.Aggregate():
                    nested = self.aggregate(value, typed=inner is None)
                case ir.RealLiteral(value=number, spelling="") if isinstance(known, _PLACES):
                    nested = number_text(number, _DECIMALS, ALWAYS_POINT)
                case _:
                    nested = self.text(value)
            parts.append(f"{shown} {nested}")
        prefix = f"{_type_prefix(aggregate, known)}: " if typed and aggregate.type_name else ""
        return "{" + prefix + ",".join(parts) + "}"

    def system(self, variable: ir.System, unit: str) -> str:
        """A system variable as a value in `unit` (empty: in the neutral one)."""
        if variable.name == "actual_joint" and isinstance(variable.indices[0], ir.IntLiteral):
            return f"$AXIS_ACT.A{variable.indices[0].value}"
        found = tables.SYSTEM.get(variable.name)
        if found is None:
            raise CannotSayError(f"KRL has no system variable for {variable.name}")
        name, own = found
        if variable.indices:
            name = f"{name}[{self.listed(variable.indices)}]"
        factor = (ir.UNITS[own] if own else 1.0) / (ir.UNITS[unit] if unit else 1.0)
        if factor == 1:
            return name
        if factor > 1:
            return f"({name}*{number_text(factor, style=ALWAYS_POINT)})"
        return f"({name}/{number_text(round(1 / factor, 9), style=ALWAYS_POINT)})"

    def signal(self, signal: ir.Signal) -> str:
        if signal.name is not None:
            return signal.name
        if signal.index is None or signal.last is not None or signal.kind not in tables.SIGNALS:
            raise CannotSayError("KRL names a group of signals by a declaration")
        return f"{tables.SIGNALS[signal.kind]}[{self.text(signal.index)}]"


def literal(
    value: ir.IntLiteral | ir.RealLiteral | ir.BoolLiteral | ir.TextLiteral | ir.EnumLiteral,
) -> str:
    """A literal. Reals keep the source's own spelling where KRL reads it as the same real."""
    match value:
        case ir.IntLiteral(value=number, spelling=spelling):
            return spelling if _BITS.fullmatch(spelling) else str(number)
        case ir.RealLiteral(value=real, spelling=spelling):
            if _REAL.fullmatch(spelling) and float(spelling) == real and real != 0:
                return spelling
            return spelling if real == 0 and _REAL.fullmatch(spelling) else number_text(real, style=ALWAYS_POINT)
        case ir.BoolLiteral(value=truth):
            return "TRUE" if truth else "FALSE"
        case ir.TextLiteral(value=text):
            if '"' in text or "\n" in text:
                raise CannotSayError("KRL has no text with a quotation mark or a line end")
            return f'"{text}"'
        case ir.EnumLiteral(member=member):
            return f"#{member}"


def component_name(type: ir.Type | None, name: str) -> str:
    """A component's KRL name from its neutral one."""
    match type:
        case ir.JointsType():
            return f"A{name[1:]}" if name[:1] == "j" else name.upper()
        case ir.TargetType() | ir.PoseType():
            if name in ("trans", "rot", "conf", "ext"):
                raise CannotSayError(f"KRL's positions have no component {name} of their own")
            return name.upper()
    return name


def _aggregate_type(aggregate: ir.Aggregate, scope: Scope) -> ir.Type | None:
    from rpl.passes.typewords import word_type

    return word_type(aggregate.type_name, scope) if aggregate.type_name else None


def _type_prefix(aggregate: ir.Aggregate, type: ir.Type | None) -> str:
    external = any((name or "")[:1] == "e" for name, _ in aggregate.entries)
    match type:
        case ir.PoseType():
            return "FRAME"
        case ir.TargetType():
            return "E6POS" if external else "POS"
        case ir.JointsType():
            return "E6AXIS" if external else "AXIS"
        case ir.NamedType(name=name):
            return name
    return aggregate.type_name or ""


def _same(unit: str) -> bool:
    return ir.UNITS[unit] == 1


def _scale(value: float, factor: float) -> float:
    return float(f"{value * factor:.12g}")


def _what(expression: ir.Expression) -> str:
    words = re.sub(r"(?<=[a-z])(?=[A-Z])", " ", expression.__class__.__name__).lower()
    return f"{words} {getattr(expression, 'how', getattr(expression, 'op', ''))}".strip()


def _bare(expression: ir.Expression) -> ir.Expression:
    """Without conversions to real numbers, which KRL does not write."""
    while isinstance(expression, ir.Convert) and expression.how == "real":
        expression = expression.operand
    return expression

"""IR declarations as the words of KRL's macros: variables, structures, enumerations, signals, routine headers."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

from rpl import ir
from rpl.passes.fold import lasting, literal
from rpl.passes.scope import Scope
from rpl.writing.statements import CannotSayError

from . import tables
from .expressions import Expressions

Words = dict[str, object]  # of a macro
_LITERALS = (ir.IntLiteral, ir.RealLiteral, ir.BoolLiteral, ir.TextLiteral, ir.EnumLiteral)


def type_parts(type: ir.Type, expressions: Expressions) -> tuple[str, str]:
    """The type's word and the brackets that stand behind the name."""
    match type:
        case ir.IntType():
            return "INT", ""
        case ir.RealType():
            return "REAL", ""
        case ir.BoolType():
            return "BOOL", ""
        case ir.CharType():
            return "CHAR", ""
        case ir.PoseType():
            return "FRAME", ""
        case ir.TargetType(external=external):
            return "E6POS" if external else "POS", ""
        case ir.JointsType(external=external):
            return "E6AXIS" if external else "AXIS", ""
        case ir.NamedType(name=name):
            return name, ""
        case ir.StringType(capacity=capacity):
            return "CHAR", f"[{expressions.text(capacity) if capacity is not None else ''}]"
        case ir.ArrayType(element=element, dimensions=dimensions):
            word, inner = type_parts(element, expressions)
            bounds = [expressions.text(bound) if bound is not None else "" for bound in dimensions]
            if inner:
                bounds.append(inner[1:-1])
            if len(bounds) > 3:
                raise CannotSayError("KRL's arrays have at most three dimensions")
            return word, f"[{','.join(bounds)}]"
    raise CannotSayError(f"KRL has no type for {type.__class__.__name__.removesuffix('Type').lower()}")


def sized(type: ir.Type) -> ir.Type:
    """The type with a length for its texts: only parameters are declared without one."""
    match type:
        case ir.StringType(capacity=None):
            return ir.StringType(ir.IntLiteral(tables.DEFAULT_TEXT_CAPACITY))
        case ir.ArrayType(element=element):
            return replace(type, element=sized(element))
    return type


def variable_words(variable: ir.Variable, scope: Scope, in_data: bool) -> Words:
    """One variable. In a data list with its value; in a routine the value is assigned later."""
    expressions = Expressions(scope)
    type = sized(variable.type)
    word, brackets = type_parts(type, expressions)
    value = ""
    if variable.initial is not None and in_data and not isinstance(type, ir.ArrayType):
        initial = worked_out(variable.initial, scope)
        if not constant(initial):
            raise CannotSayError("a data list takes constants only")
        value = expressions.stored(initial)
    return {
        "everywhere": in_data and variable.scope in ("task", "global"),
        "constant": in_data and variable.storage == "constant",
        "type": word,
        "name": variable.name,
        "brackets": brackets,
        "value": value,
    }


def worked_out(initial: ir.Expression, scope: Scope) -> ir.Expression:
    """A first value with the numbers, truths and texts that constants make (`FIRST*2+1`) in their place. What rests on
    taught places stays as it is."""
    if constant(initial):
        return initial
    if isinstance(initial, ir.Aggregate):
        entries = tuple((name, worked_out(part, scope)) for name, part in initial.entries)
        return replace(initial, entries=entries)
    value = lasting(initial, scope)
    known = literal(value) if isinstance(value, bool | int | float | str) else None
    return initial if known is None else replace(known, origin=initial.origin)


def first_values(variable: ir.Variable, scope: Scope, in_data: bool) -> list[ir.Assign]:
    """What a declaration leaves to be assigned: an array's elements one by one; in a routine any first value."""
    if variable.initial is None:
        return []
    name = ir.Name(variable.name)
    if isinstance(variable.type, ir.ArrayType):
        initial = worked_out(variable.initial, scope) if in_data else variable.initial
        values = list(elements(name, (), initial, len(variable.type.dimensions)))
        if in_data and not all(constant(one.value) for one in values):
            raise CannotSayError("a data list takes constants only")
        return values
    return [] if in_data else [ir.Assign(name, variable.initial)]


def elements(
    name: ir.Expression, indices: tuple[ir.Expression, ...], value: ir.Expression, depth: int
) -> Iterator[ir.Assign]:
    if not depth:
        yield ir.Assign(ir.Index(name, indices), value)
        return
    if not isinstance(value, ir.Aggregate):
        raise CannotSayError("KRL initialises an array element by element")
    for number, (_, part) in enumerate(value.entries, 1):
        yield from elements(name, (*indices, ir.IntLiteral(number)), part, depth - 1)


def constant(value: ir.Expression) -> bool:
    match value:
        case ir.Unary(op="-" | "+", operand=operand) | ir.Convert(operand=operand):
            return constant(operand)
        case ir.Aggregate(entries=entries):
            return all(constant(part) for _, part in entries)
        case ir.System(name="null_frame" | "world"):
            return True
    return isinstance(value, _LITERALS)


def record_words(record: ir.RecordDeclaration, scope: Scope) -> Words:
    expressions = Expressions(scope)
    parts, last = [], ""
    for name, type in record.fields:
        word, brackets = type_parts(sized(type), expressions)
        parts.append(f"{word} {name}{brackets}" if word != last else f"{name}{brackets}")
        last = word
    return {"everywhere": everywhere(record.scope), "name": record.name, "parts": parts}


def signal_words(declaration: ir.SignalDeclaration, scope: Scope) -> Words:
    """`SIGNAL name $OUT[1]`, a range, or another name that the signal stands for."""
    expressions = Expressions(scope)
    signal = declaration.signal
    words: Words = {"everywhere": everywhere(declaration.scope), "name": declaration.name, "last": ""}
    if signal.index is None:
        if signal.name is None:
            raise CannotSayError("this signal has neither number nor name")
        return words | {"signal": signal.name}
    first = expressions.text(signal.index)
    if signal.last is not None:
        word = tables.GROUPS.get(signal.kind) or tables.SIGNALS.get(signal.kind, "$OUT")
        return words | {"signal": f"{word}[{first}]", "last": f"{word}[{expressions.text(signal.last)}]"}
    return words | {"signal": f"{tables.SIGNALS[signal.kind]}[{first}]"}


def everywhere(scope: str) -> bool:
    return scope in ("task", "global")


def heading_words(routine: ir.Routine, scope: Scope, first: bool) -> Words:
    """`DEF name(a:IN,b[]:OUT)`; the first routine of a file is global without saying so."""
    expressions = Expressions(scope)
    parameters = []
    for parameter in routine.parameters:
        if parameter.optional or parameter.switch:
            raise CannotSayError("KRL has no optional parameters")
        _, brackets = type_parts(parameter.type, expressions)
        empty = f"[{',' * brackets.count(',')}]" if brackets else ""
        parameters.append(f"{parameter.name}{empty}:{'OUT' if parameter.mode == 'reference' else 'IN'}")
    return {
        "everywhere": not (first or routine.scope == "module"),
        "returns": "".join(type_parts(routine.returns, expressions)) if routine.returns is not None else "",
        "name": routine.name,
        "parameters": ",".join(parameters),
    }


def parameter_words(parameter: ir.Parameter, scope: Scope) -> Words:
    word, brackets = type_parts(parameter.type, Expressions(scope))
    if isinstance(parameter.type, ir.ArrayType | ir.StringType):
        brackets = f"[{',' * brackets.count(',')}]"
    return {"type": word, "name": parameter.name, "brackets": brackets}

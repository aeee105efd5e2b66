"""IR declarations as URScript: a variable begins with its first value, which fixes its type for good."""

from __future__ import annotations

import math

from rpl import ir
from rpl.passes.fold import constant_number
from rpl.passes.scope import Scope
from rpl.writing.statements import CannotSayError

from .expressions import Expressions
from .facts.programs import assigns
from .places import is_matrix

_POSES = (ir.PoseType, ir.TargetType, ir.VectorType, ir.RotationType)
_DEEPEST = 16


def first_value(variable: ir.Variable, expressions: Expressions) -> str:
    """The value given, spelled so that it has the type declared, or that type's neutral value."""
    scope = expressions.scope
    type = scope.resolve(variable.type)
    initial = variable.initial
    if initial is None:
        return neutral(type, scope, expressions)
    if isinstance(initial, ir.Aggregate) and isinstance(type, ir.ArrayType):
        return expressions.text(_typed(in_one_list(initial, type, scope), type, scope))
    return expressions.given(_real(initial, type))


def in_one_list(value: ir.Aggregate, type: ir.ArrayType, scope: Scope) -> ir.Aggregate:
    """The value of an array of several dimensions, as the one list that it is written as (a matrix stays one)."""
    return value if is_matrix(type, scope) else _flat(value, len(type.dimensions))


def _flat(value: ir.Aggregate, dimensions: int) -> ir.Aggregate:
    if dimensions < 2:
        return value
    entries: list[tuple[str | None, ir.Expression]] = []
    for name, one in value.entries:
        inner = _flat(one, dimensions - 1) if isinstance(one, ir.Aggregate) else one
        entries.extend(inner.entries if isinstance(inner, ir.Aggregate) else ((name, inner),))
    return ir.Aggregate(tuple(entries), origin=value.origin)


def _real(value: ir.Expression, type: ir.Type) -> ir.Expression:
    """A number as its place needs it: a real one with a point."""
    if isinstance(type, ir.RealType) and isinstance(value, ir.IntLiteral):
        return ir.RealLiteral(float(value.value))
    return value


def _typed(value: ir.Aggregate, type: ir.ArrayType, scope: Scope) -> ir.Aggregate:
    """The numbers of an array's value in the form that its elements need."""
    element = scope.resolve(type.element)
    entries = []
    for name, one in value.entries:
        inner = isinstance(one, ir.Aggregate) and one.type_name is None
        entries.append(
            (name, _typed(one, type, scope) if inner and isinstance(one, ir.Aggregate) else _real(one, element))
        )
    return ir.Aggregate(tuple(entries), value.type_name, origin=value.origin)


def neutral(type: ir.Type, scope: Scope, expressions: Expressions, depth: int = 0) -> str:
    """What a variable without a first value begins with."""
    resolved = scope.resolve(type)
    match resolved:
        case ir.IntType():
            return "0"
        case ir.RealType():
            return "0.0"
        case ir.BoolType():
            return "False"
        case ir.StringType() | ir.CharType():
            return '""'
        case ir.JointsType() | ir.AxesType():
            return "[0.0, 0.0, 0.0, 0.0, 0.0, 0.0]"
        case ir.ArrayType():
            return _empty_array(resolved, scope, expressions, depth)
        case ir.NamedType(name=name) if depth < _DEEPEST:
            record = scope.type(name)
            if isinstance(record, ir.RecordDeclaration):
                fields = [f"{field}={neutral(one, scope, expressions, depth + 1)}" for field, one in record.fields]
                return f"struct({', '.join(fields)})"
    if isinstance(resolved, _POSES):
        return "p[0, 0, 0, 0, 0, 0]"
    raise CannotSayError(f"there is no type for {resolved.__class__.__name__.removesuffix('Type').lower()}")


def _empty_array(type: ir.ArrayType, scope: Scope, expressions: Expressions, depth: int) -> str:
    counts = []
    for bound in type.dimensions:
        last = None if bound is None else constant_number(bound, scope)
        if last is None:
            raise CannotSayError("an array whose size is not a constant")
        counts.append(int(last) - type.base + 1)
    inner = neutral(type.element, scope, expressions, depth + 1)
    if is_matrix(type, scope):
        row = f"[{', '.join([inner] * counts[1])}]"
        return f"[{', '.join([row] * counts[0])}]"
    return f"[{', '.join([inner] * math.prod(counts))}]"


def header(routine: ir.Routine) -> dict[str, str]:
    """The words of `def name(a, b):`."""
    for parameter in routine.parameters:
        if parameter.optional or parameter.switch:
            raise CannotSayError("there are no optional parameters")
        if parameter.mode == "reference" and assigns(parameter.name, routine):
            raise CannotSayError(f"the parameter {parameter.name} gives a value back, and arguments are copies")
    return {"name": routine.name, "parameters": ", ".join(parameter.name for parameter in routine.parameters)}

"""Values of constant expressions, and the arithmetic identities that writers rely on.

`constant` gives the value of an expression that never changes in a run: literals, constants, what the language
predefines, arithmetic and pure functions of these. With `Unchanged` also variables that nothing assigns, as taught data
and tools are in programs whose language has no other place for them. `literal` writes a value back as an expression.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cache

from rpl import ir, registry
from rpl.diagnostics import Diagnostics
from rpl.ir.columns import as_float, by_row
from rpl.passes import rigid
from rpl.passes.rewrite import rewrite_parts
from rpl.passes.scope import ProgramScope, Scope
from rpl.passes.typewords import component_names, word_type
from rpl.passes.typing import normalise, type_of
from rpl.passes.values import Member, Value, binary, component, composed, converted, literal, pure, real, scaled, unary

__all__ = [
    "Unchanged",
    "Value",
    "constant",
    "constant_number",
    "element_key",
    "is_taught_type",
    "lasting",
    "lasting_number",
    "literal",
    "real",
    "simplify",
]

_TAUGHT = (ir.TargetType, ir.PoseType, ir.JointsType, ir.ToolType, ir.WorkObjectType)
_DEEPEST = 64  # constants that rest on constants; a longer chain is a cycle


@dataclass(slots=True)
class Unchanged:
    """What nothing assigns in a run (`assigned`: the other names, folded), and what data lists set it to."""

    assigned: set[str]
    initialised: dict[str, list[tuple[ir.Expression, ir.Expression, ir.Module]]] = field(default_factory=dict)
    settled: dict[tuple[str, tuple[int, ...]], Value] = field(default_factory=dict)
    """What the beginning of a program sets to a constant before its use: by folded name and indices of an element."""


def constant(
    expression: ir.Expression,
    scope: Scope,
    unchanged: Unchanged | None = None,
    known: Mapping[str, Value] | None = None,
) -> Value | None:
    """The value of a normalised expression, None when it may change or cannot be known here. `known` are values at this
    place of the run: of variables by folded name, of elements by `element_key`, of system variables with a `$` in
    front."""
    return _Folder(scope, unchanged, known=known).value(expression, None)


def lasting(expression: ir.Expression, scope: Scope) -> Value | None:
    """The value as `constant` gives it, None where a named place, tool or frame of the program decides it. Such data is
    taught anew on the pendant, declared constant or not, and what is computed from it has to follow; so writers and
    passes that put a value in the place of a computation ask for this one."""
    return _Folder(scope, None, taught=False).value(expression, None)


def lasting_number(expression: ir.Expression, scope: Scope) -> float | None:
    """The lasting value when it is a number."""
    value = lasting(expression, scope)
    return as_float(value) if isinstance(value, int | float) and not isinstance(value, bool) else None


def is_taught_type(type: ir.Type, scope: Scope) -> bool:
    """Is data of this type taught: places, joints, tools, frames, and arrays of them?"""
    resolved = scope.resolve(type)
    while isinstance(resolved, ir.ArrayType):
        resolved = scope.resolve(resolved.element)
    return isinstance(resolved, _TAUGHT)


def element_key(name: str, places: Sequence[int]) -> str:
    """The name of an array's element among values that are known at a place of the run."""
    return f"{name.lower()}[{','.join(map(str, places))}]"


def constant_number(expression: ir.Expression, scope: Scope, unchanged: Unchanged | None = None) -> float | None:
    """The value when it is a number."""
    value = constant(expression, scope, unchanged)
    return as_float(value) if isinstance(value, int | float) and not isinstance(value, bool) else None


@cache
def _prelude_scope(dialect: str) -> tuple[ir.Module, Scope] | None:
    module = registry.dialect(dialect).prelude()
    if module is None:
        return None
    program = normalise(ir.Program((replace(module, dialect=dialect),)), Diagnostics())
    return program.modules[0], ProgramScope(program).module(program.modules[0])


@cache
def _predefined(dialect: str, key: str) -> Value | None:
    """The value of a language's own constant, by its folded name: always the same, and asked for at every move."""
    found = _prelude_scope(dialect)
    module, scope = found if found is not None else (None, None)
    for one in module.declarations if module is not None else ():
        if (
            scope is not None
            and isinstance(one, ir.Variable)
            and scope.fold(one.name) == key
            and one.initial is not None
        ):
            return _Folder(scope, None, 1).value(one.initial, scope.resolve(one.type))
    return None


class _Folder:
    def __init__(
        self,
        scope: Scope,
        unchanged: Unchanged | None,
        depth: int = 0,
        known: Mapping[str, Value] | None = None,
        taught: bool = True,
    ) -> None:
        self.scope, self.unchanged, self.depth, self.known = scope, unchanged, depth, known or {}
        self.taught = taught  # may it look into data that the pendant teaches anew?

    def value(self, expression: ir.Expression, wanted: ir.Type | None) -> Value | None:
        match expression:
            case ir.IntLiteral() | ir.RealLiteral() | ir.BoolLiteral() | ir.TextLiteral():
                return expression.value
            case ir.EnumLiteral(member=member):
                return Member(member.lower())
            case ir.Name(id=name):
                found = self.known.get(name.lower())
                return self.name(name) if found is None else found
            case ir.System(name=name) if f"${name}" in self.known:
                return self.known[f"${name}"]
            case ir.System(name=name):
                return rigid.IDENTITY if name in ("null_frame", "world") else None
            case ir.Field(base=base, name=name):
                whole = self.value(base, None)
                return None if whole is None else component(whole, name)
            case ir.Index(base=base, indices=indices):
                return self.index(base, indices)
            case ir.Quantity(value=inner, unit=unit):
                return scaled(self.value(inner, None), ir.UNITS[unit])
            case ir.Magnitude(value=inner, unit=unit):
                return scaled(self.value(inner, None), 1.0 / ir.UNITS[unit])
            case ir.Unary(op=op, operand=operand):
                return unary(op, self.value(operand, wanted))
            case ir.Binary(op=op, left=left, right=right):
                one, other = self.value(left, None), self.value(right, None)
                return None if one is None or other is None else binary(op, one, other)
            case ir.Convert(how=how, operand=operand):
                return converted(how, self.value(operand, None))
            case ir.Builtin(function=function, arguments=arguments):
                values = [self.value(argument, None) for argument in arguments]
                return pure(function, [value for value in values if value is not None], len(values))
            case ir.Aggregate():
                return self.aggregate(expression, wanted)
        return None

    def name(self, name: str) -> Value | None:
        symbol = self.scope.value(name)
        if symbol is None or not isinstance(symbol.declaration, ir.Variable) or self.depth > _DEEPEST:
            return None
        declaration = symbol.declaration
        own = symbol.routine is not None
        if self.unchanged is not None and not own and (name.lower(), ()) in self.unchanged.settled:
            return self.unchanged.settled[name.lower(), ()]
        predefined = symbol.module is None and not own
        fixed = declaration.storage == "constant"
        if not fixed and self.unchanged is not None and not own:
            fixed = name.lower() not in self.unchanged.assigned
        if not fixed:
            return None
        if predefined:
            return self.predefined(name)
        if not self.taught and is_taught_type(declaration.type, self.scope):
            return None
        home = self.scope if own else self.scope.program.module(symbol.module or self.scope.module)
        inner = _Folder(home, self.unchanged, self.depth + 1, taught=self.taught)
        initial = declaration.initial
        if initial is None:
            parts = self.unchanged.initialised.get(name.lower(), []) if self.unchanged and not own else []
            whole = [value for target, value, _ in parts if isinstance(target, ir.Name)]
            initial = whole[-1] if whole else None
        return None if initial is None else inner.value(initial, home.resolve(declaration.type))

    def predefined(self, name: str) -> Value | None:
        dialect = self.scope.module.dialect
        found = _prelude_scope(dialect)
        return None if found is None else _predefined(dialect, found[1].fold(name))

    def index(self, base: ir.Expression, indices: tuple[ir.Expression, ...]) -> Value | None:
        places = [self.value(index, None) for index in indices]
        whole = [int(place) for place in places if isinstance(place, int | float)]
        if len(whole) != len(places):
            return None
        if isinstance(base, ir.Name) and (given := self.known.get(element_key(base.id, whole))) is not None:
            return given
        if self.unchanged is not None and isinstance(base, ir.Name) and self.is_global(base.id):
            settled = self.unchanged.settled.get((base.id.lower(), tuple(whole)))
            if settled is not None:
                return settled
        found = self.value(base, None)
        if found is None:
            return self.listed(base, whole)
        type = type_of(base, self.scope)
        first = type.base if isinstance(type, ir.ArrayType) else 1
        for place in whole:
            if not isinstance(found, tuple) or not first <= place < len(found) + first:
                return None
            found = found[place - first]
        return found

    def is_global(self, name: str) -> bool:
        symbol = self.scope.value(name)
        return symbol is not None and symbol.routine is None

    def listed(self, base: ir.Expression, places: list[int]) -> Value | None:
        """An element that a data list sets on its own line."""
        if self.unchanged is None or not isinstance(base, ir.Name) or base.id.lower() in self.unchanged.assigned:
            return None
        last: Value | None = None
        for target, value, module in self.unchanged.initialised.get(base.id.lower(), []):
            scope = self.scope.program.module(module)
            inner = _Folder(scope, self.unchanged, self.depth + 1)
            if isinstance(target, ir.Index) and self.depth <= _DEEPEST:
                at = [inner.value(index, None) for index in target.indices]
                if at == places:
                    last = inner.value(value, type_of(target, scope))
        return last

    def aggregate(self, expression: ir.Aggregate, wanted: ir.Type | None) -> Value | None:
        type = wanted
        if type is None and expression.type_name:
            type = word_type(expression.type_name, self.scope)
        if isinstance(type, ir.ArrayType):
            rest = type.dimensions[1:]
            element = ir.ArrayType(type.element, rest, type.base) if rest else self.scope.resolve(type.element)
            values = [self.value(value, element) for _, value in expression.entries]
            known = [value for value in values if value is not None]
            return tuple(known) if len(known) == len(values) else None
        if type is None:
            return None
        names = component_names(type, self.scope)
        parts: dict[str, Value] = {}
        for at, (written, entry) in enumerate(expression.entries):
            name = written or (names[at] if at < len(names) else "")
            value = self.value(entry, None)
            if value is None:
                return None
            parts[name] = value
        return composed(type, parts)


# ---- identities


def simplify(expression: ir.Expression, scope: Scope) -> ir.Expression:
    """The expression with units resolved and neutral elements taken out. A literal whose unit needs no conversion keeps
    its spelling; quantities become plain numbers in base units (mm, s, deg)."""
    match expression:
        case ir.Quantity(value=inner, unit=unit):
            return _times(simplify(inner, scope), ir.UNITS[unit])
        case ir.Magnitude(value=inner, unit=unit):
            return _times(simplify(inner, scope), 1.0 / ir.UNITS[unit])
        case ir.Unary(op="+", operand=operand):
            return simplify(operand, scope)
        case ir.Unary(op="-", operand=ir.Unary(op="-", operand=operand)):
            return simplify(operand, scope)
        case ir.Binary():
            inner = rewrite_parts(expression, lambda part: simplify(part, scope))
            return _without_neutral(inner, scope)
    return rewrite_parts(expression, lambda part: simplify(part, scope))


def _times(value: ir.Expression, factor: float) -> ir.Expression:
    if math.isclose(factor, 1.0, rel_tol=1e-14):
        return value
    match value:
        case ir.IntLiteral(value=number) | ir.RealLiteral(value=number):
            return ir.RealLiteral(_rounded(number * factor), origin=value.origin)
        case ir.Unary(op="-", operand=operand):
            return replace(value, operand=_times(operand, factor))
        case ir.Binary(op="*" | "/" as op, left=left, right=ir.RealLiteral(value=number)):
            whole = number * factor if op == "*" else factor / number if number else 0.0
            if whole:
                return _times(left, whole)
    if factor < 1.0 and math.isclose(1.0 / factor, round(1.0 / factor), rel_tol=1e-12):
        return ir.Binary("/", value, ir.RealLiteral(float(round(1.0 / factor))), origin=value.origin)
    return ir.Binary("*", value, ir.RealLiteral(float(f"{factor:.15g}")), origin=value.origin)


@by_row
def _rounded(value: float) -> float:
    return float(f"{value:.12g}")


def _without_neutral(expression: ir.Expression, scope: Scope) -> ir.Expression:
    if not isinstance(expression, ir.Binary):
        return expression
    op, left, right = expression.op, expression.left, expression.right
    if op in ("+", "-") and _is(right, 0, left, scope):
        return left
    if op in ("*", "/") and _is(right, 1, left, scope) and not (op == "/" and _whole(left, scope)):
        return left
    if op == "+" and _is(left, 0, right, scope):
        return right
    if op == "*" and _is(left, 1, right, scope):
        return right
    return expression


def _whole(expression: ir.Expression, scope: Scope) -> bool:
    return isinstance(type_of(expression, scope), ir.IntType)


def _is(one: ir.Expression, number: int, other: ir.Expression, scope: Scope) -> bool:
    """Is `one` the literal, and does leaving it out keep the type of the result?"""
    match one:
        case ir.IntLiteral(value=value):
            return value == number and isinstance(type_of(other, scope), ir.NUMBER_TYPES)
        case ir.RealLiteral(value=value):
            return value == number and isinstance(type_of(other, scope), ir.RealType)
    return False

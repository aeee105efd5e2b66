"""Types where running needs them: first values of variables and values of aggregates."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping

from rpl import ir, registry
from rpl.passes.scope import Scope
from rpl.passes.typewords import component_names, word_type
from rpl.passes.typing import type_of
from rpl.runtime.faults import ProgramError
from rpl.runtime.moves.chain import convention_of
from rpl.runtime.values import (
    Array,
    ConfigValue,
    Member,
    Record,
    StopWatch,
    Value,
    axes_from,
    external_from,
    joints_from,
    pose_from,
    rotation_from,
    target_from,
    vector_from,
    whole,
)

Parts = Mapping[str, Value]
Dimensions = Callable[[ir.Expression], Value]
# Structured types that are kept as records with neutral component names.
RECORD_TYPES: dict[type, str] = {
    ir.ToolType: "tool",
    ir.WorkObjectType: "workobject",
    ir.LoadType: "load",
    ir.SpeedType: "speed",
    ir.ZoneType: "zone",
}
_MOST_ELEMENTS = 4_000_000


class Types:
    """Types of one scope."""

    def __init__(self, scope: Scope) -> None:
        self.scope = scope
        self.unset = scope.rules.undefined
        self.convention = convention_of(scope.rules)

    def of(self, expression: ir.Expression) -> ir.Type | None:
        """The static type of an expression."""
        return type_of(expression, self.scope)

    def aggregate_type(self, expression: ir.Aggregate) -> ir.Type | None:
        return word_type(expression.type_name, self.scope) if expression.type_name else None

    def positions(self, type: ir.Type) -> tuple[str, ...]:
        """Component names in the order of a positional aggregate."""
        return component_names(type, self.scope)

    # ---- first values

    def bounds(self, type: ir.Type) -> Iterator[ir.Expression]:
        """The bounds of the arrays in a type, those in the fields of records among them."""
        type = self.scope.resolve(type)
        if isinstance(type, ir.ArrayType):
            yield from (bound for bound in type.dimensions if bound is not None)
            yield from self.bounds(type.element)
        elif isinstance(type, ir.NamedType) and isinstance(record := self.scope.type(type.name), ir.RecordDeclaration):
            for _, field in record.fields:
                yield from self.bounds(field)

    def initial(self, type: ir.Type, number: Dimensions) -> Value:
        """The value of a variable that nothing was assigned to: zero, or none where the language has it so. `number`
        evaluates the bounds of arrays."""
        type = self.scope.resolve(type)
        none: Value = None
        match type:
            case ir.IntType() | ir.RealType() | ir.InterruptType():
                return none if self.unset and not isinstance(type, ir.InterruptType) else 0
            case ir.BoolType():
                return none if self.unset else False
            case ir.CharType() | ir.StringType():
                return none if self.unset else ""
            case ir.NamedType(name=name):
                return self._named(name, number)
            case ir.ArrayType(element=element, dimensions=dimensions, base=base):
                sizes = [whole(number(bound)) if bound is not None else 0 for bound in dimensions]
                return self._array(element, sizes, base, number)
            case ir.ClockType():
                return StopWatch()
            case ir.TriggerType() | ir.VendorType() | ir.SignalType():
                return None
        return self.composed(type, {} if self.unset else self._zeros(type))

    def zero(self, type: ir.Type | None) -> Value:
        """Zero, FALSE, the empty text, the first member, or a structure of such; None for a type that has no such."""
        type = self.scope.resolve(type) if type is not None else None
        match type:
            case ir.IntType() | ir.RealType():
                return 0
            case ir.BoolType():
                return False
            case ir.CharType() | ir.StringType():
                return ""
            case ir.NamedType(name=name):
                found = self.scope.type(name)
                members = found.members if isinstance(found, ir.EnumDeclaration) else ()
                return Member(members[0].lower()) if members else None
        return self.composed(type, self._zeros(type)) if type is not None and type.__class__ in ir.COMPONENTS else None

    def _named(self, name: str, number: Dimensions) -> Value:
        match self.scope.type(name):
            case ir.RecordDeclaration(fields=fields):
                fold = self.scope.fold
                return Record(fold(name), {fold(field): self.initial(type, number) for field, type in fields})
            case ir.EnumDeclaration(members=members):
                return None if self.unset or not members else Member(members[0].lower())
        return None

    def _array(self, element: ir.Type, sizes: list[int], base: int, number: Dimensions) -> Array:
        total = 1
        for size in sizes:
            total *= max(size - base + 1, 0)
        if total > _MOST_ELEMENTS:
            raise ProgramError("overflow", f"an array of {total} elements is too large to run")
        count = max(sizes[0] - base + 1, 0)
        if len(sizes) > 1:
            return Array([self._array(element, sizes[1:], base, number) for _ in range(count)], base)
        return Array([self.initial(element, number) for _ in range(count)], base)

    def _zeros(self, type: ir.Type) -> Parts:
        zeros: dict[str, Value] = {}
        for name, component in ir.COMPONENTS.get(type.__class__, {}).items():
            match component:
                case ir.RealType() | ir.IntType():
                    zeros[name] = 0.0
                case ir.BoolType():
                    zeros[name] = False
                case ir.StringType():
                    zeros[name] = ""
                case _ if type.__class__ in RECORD_TYPES:
                    zeros[name] = self.composed(component, self._zeros(component))
        if self.convention == "zyx":
            for name in ("q1", "q2", "q3", "q4"):
                zeros.pop(name, None)
        for structured in ("trans", "rot", "ext", "robax"):
            if type.__class__ not in RECORD_TYPES:
                zeros.pop(structured, None)
        match type:
            case ir.ConfigType(notation=notation) | ir.TargetType(notation=notation):
                zeros.update((flag, 0) for flag in registry.dialect(notation).notation_fields)
        return zeros

    def fitted(self, type: ir.Type, value: Value) -> Value:
        """A value from outside in a variable of that type: whole numbers where it holds such, in their range. Raises
        ValueError with what is wrong."""
        type = self.scope.resolve(type)
        match type, value:
            case ir.IntType(), float() | int() if not isinstance(value, bool):
                if value != value or not float(value).is_integer():
                    raise ValueError(f"must be a whole number, not {value:g}")
                most = 2 ** (self.scope.rules.whole_bits - 1)
                if not -most <= value < most:
                    raise ValueError(f"{value:g} is too large for a whole number of {self.scope.rules.whole_bits} bits")
                return int(value)
            case ir.ArrayType(element=element, dimensions=dimensions), Array(items=items):
                rest = dimensions[1:]
                inner = ir.ArrayType(element, rest, type.base) if rest else element
                return Array([self.fitted(inner, item) for item in items], value.base)
            case ir.NamedType(name=name), str() if isinstance(self.scope.type(name), ir.EnumDeclaration):
                return Member(value.lower().removeprefix("#"))
            case ir.NamedType(name=name), Record(parts=parts):
                record = self.scope.type(name)
                if isinstance(record, ir.RecordDeclaration):
                    for field, inner in record.fields:
                        key = self.scope.fold(field)
                        if key in parts:
                            parts[key] = self.fitted(inner, parts[key])
        return value

    # ---- aggregates

    def composed(self, type: ir.Type, parts: Parts) -> Value:
        """The value of a structured type from its components by neutral name; those left out have no value."""
        match type:
            case ir.VectorType():
                return vector_from(parts)
            case ir.RotationType():
                return rotation_from(parts, self.convention)
            case ir.PoseType():
                return pose_from(parts, self.convention)
            case ir.ConfigType(notation=notation):
                flags = registry.dialect(notation).notation_fields
                return ConfigValue(notation, tuple((flag, parts.get(flag)) for flag in flags))
            case ir.ExternalType():
                return external_from(parts)
            case ir.AxesType():
                return axes_from(parts)
            case ir.JointsType():
                return joints_from(parts)
            case ir.TargetType(notation=notation):
                flags = registry.dialect(notation).notation_fields
                return target_from(parts, notation, flags, self.convention)
            case ir.NamedType(name=name):
                return self._record(name, parts)
        word = RECORD_TYPES.get(type.__class__)
        if word is None:
            raise ProgramError("wrong_kind", "this type has no components")
        names = ir.COMPONENTS[type.__class__]
        return Record(word, {name: parts.get(name) for name in names})

    def _record(self, name: str, parts: Parts) -> Value:
        fold = self.scope.fold
        declaration = self.scope.type(name)
        given = {fold(key): value for key, value in parts.items()}
        if not isinstance(declaration, ir.RecordDeclaration):
            return Record(fold(name), dict(given))
        made = {}
        for field, type in declaration.fields:
            key = fold(field)
            made[key] = given[key] if key in given else self.initial(type, no_bound)
        return Record(fold(name), made)


def no_bound(expression: ir.Expression) -> Value:
    """Bounds of arrays inside records are constants."""
    match expression:
        case ir.IntLiteral(value=value) | ir.RealLiteral(value=value):
            return value
    raise ProgramError("wrong_kind", "the bound of an array in a record must be a number")


__all__ = ["RECORD_TYPES", "Types", "no_bound"]

"""Words for types, and the components of built-in and declared types by their neutral names.

One word per type, so that an aggregate can carry the type that its place gives it and later rooms find it again.
"""

from __future__ import annotations

from rpl import ir, registry
from rpl.ir.rules import Rules
from rpl.passes.scope import Scope

_TYPE_WORDS: dict[type, str] = {
    ir.IntType: "int",
    ir.RealType: "real",
    ir.BoolType: "bool",
    ir.CharType: "char",
    ir.StringType: "string",
    ir.VectorType: "vector",
    ir.RotationType: "rotation",
    ir.PoseType: "pose",
    ir.ConfigType: "configuration",
    ir.ExternalType: "external",
    ir.AxesType: "axes",
    ir.TargetType: "target",
    ir.JointsType: "joints",
    ir.ToolType: "tool",
    ir.WorkObjectType: "workobject",
    ir.LoadType: "load",
    ir.SpeedType: "speed",
    ir.ZoneType: "zone",
    ir.ClockType: "clock",
    ir.InterruptType: "interrupt",
    ir.TriggerType: "trigger",
}
_WORD_TYPES: dict[str, ir.Type] = {
    "vector": ir.VectorType(),
    "rotation": ir.RotationType(),
    "pose": ir.PoseType(),
    "external": ir.ExternalType(),
    "axes": ir.AxesType(),
    "joints": ir.JointsType(),
    "tool": ir.ToolType(),
    "workobject": ir.WorkObjectType(),
    "load": ir.LoadType(),
    "speed": ir.SpeedType(),
    "zone": ir.ZoneType(),
}


def type_word(type: ir.Type) -> str:
    """One word for a type: the neutral name, or a declared type's own name. Targets say their notation."""
    match type:
        case ir.NamedType(name=name):
            return name
        case ir.TargetType(notation=notation) | ir.ConfigType(notation=notation):
            return f"{_TYPE_WORDS[type.__class__]} {notation}"
        case ir.VendorType(name=name):
            return name
        case ir.ArrayType(element=element):
            return f"array of {type_word(element)}"
        case ir.SignalType(kind=kind):
            return kind
    return _TYPE_WORDS[type.__class__]


def language_word(type: ir.Type, rules: Rules) -> str:
    """The word by which the language itself calls the type, where it has one."""
    if isinstance(type, ir.VendorType | ir.SignalType):
        return type_word(type)
    words = [word for word, known in rules.type_names.items() if known.__class__ is type.__class__]
    if not words and isinstance(type, ir.NUMBER_TYPES):
        words = [word for word, known in rules.type_names.items() if isinstance(known, ir.NUMBER_TYPES)]
    return min(words, key=lambda word: (len(word), word), default=type_word(type))


def word_type(word: str, scope: Scope) -> ir.Type | None:
    """The type that `type_word` or the dialect's own spelling names; None when there is none."""
    head, _, notation = word.partition(" ")
    if head == "target":
        return ir.TargetType(notation or scope.rules.name)
    if head == "configuration":
        return ir.ConfigType(notation or scope.rules.name)
    declared = scope.type(word)
    if declared is not None:
        return scope.resolve(ir.NamedType(word))
    return scope.rules.type_names.get(scope.fold(word)) or _WORD_TYPES.get(word)


def component_type(base: ir.Type, name: str, scope: Scope) -> ir.Type | None:
    """Type of a component by its neutral (or record field) name; None when the type has no such component."""
    match base:
        case ir.NamedType(name=record):
            declaration = scope.type(record)
            if isinstance(declaration, ir.RecordDeclaration):
                for field_name, field_type in declaration.fields:
                    if scope.fold(field_name) == scope.fold(name):
                        return scope.resolve(field_type)
            return None
        case ir.TargetType(notation=notation):
            if name == "conf":
                return ir.ConfigType(notation)
            if name in registry.dialect(notation).notation_fields:
                return ir.IntType()
            return ir.COMPONENTS[ir.TargetType].get(name)
        case ir.ConfigType(notation=notation):
            return ir.RealType() if name in registry.dialect(notation).notation_fields else None
    return ir.COMPONENTS.get(base.__class__, {}).get(name)


def component_names(base: ir.Type, scope: Scope) -> tuple[str, ...]:
    """Components in the order of a positional aggregate."""
    match base:
        case ir.NamedType(name=record):
            declaration = scope.type(record)
            return tuple(n for n, _ in declaration.fields) if isinstance(declaration, ir.RecordDeclaration) else ()
        case ir.ConfigType(notation=notation):
            return registry.dialect(notation).notation_fields
    return ir.POSITIONAL.get(base.__class__, ())

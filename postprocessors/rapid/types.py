"""The words of types, parameters and declarations."""

from __future__ import annotations

from rpl import ir
from rpl.writing.statements import CannotSayError

from .expressions import Expressions
from .tables import SIGNAL_NAMES, TYPE_NAMES

_STORAGE = {"constant": "CONST", "variable": "VAR", "persistent": "PERS"}
# A motion instruction demands its tool, work object and load as persistent data.
_PERSISTENT = (ir.ToolType, ir.WorkObjectType, ir.LoadType)


def type_name(type: ir.Type) -> str:
    """The type's name; of an array that of its elements. Raises CannotSayError."""
    match type:
        case ir.ArrayType(element=element):
            return type_name(element)
        case ir.NamedType(name=name):
            return name
        case ir.VendorType(dialect="rapid", name=name):
            return name
        case ir.SignalType(kind=kind) if kind in SIGNAL_NAMES:
            return SIGNAL_NAMES[kind]
        case ir.TargetType(notation=notation) | ir.ConfigType(notation=notation) if notation != "rapid":
            raise CannotSayError(f"targets in the notation of {notation} are not known here")
    word = TYPE_NAMES.get(type.__class__)
    if word is None:
        raise CannotSayError(f"there is no type for {type.__class__.__name__}")
    return word


def sizes(type: ir.Type, expressions: Expressions) -> str:
    """The `{2,3}` behind a name; `*` for a dimension that the argument gives."""
    if not isinstance(type, ir.ArrayType):
        return ""
    if len(type.dimensions) > 3:
        raise CannotSayError("arrays have three dimensions at most")
    parts = ("*" if size is None else expressions.text(size) for size in type.dimensions)
    return f"{{{','.join(parts)}}}"


def variable(declaration: ir.Variable, expressions: Expressions) -> dict[str, object]:
    """One data declaration."""
    where = ""
    if declaration.scope == "module":
        where = "LOCAL"
    elif declaration.scope == "task" and declaration.storage == "persistent":
        where = "TASK"
    return {
        "where": where,
        "storage": _STORAGE[declaration.storage],
        "name": declaration.name,
        "sizes": sizes(declaration.type, expressions),
        "initial": "" if declaration.initial is None else expressions.text(declaration.initial),
        "type": type_name(declaration.type),
    }


def record(declaration: ir.RecordDeclaration, expressions: Expressions) -> dict[str, object]:
    """A record with its components."""
    fields = [(type_name(type), name, sizes(type, expressions)) for name, type in declaration.fields]
    return {"local": declaration.scope == "module", "name": declaration.name, "fields": fields}


def parameters(routine: ir.Routine, expressions: Expressions) -> str:
    """The formal parameters between the parentheses."""
    parts: list[str] = []
    before: ir.Parameter | None = None
    for parameter in routine.parameters:
        text = one_parameter(parameter, expressions)
        if parameter.choice is not None and before is not None and before.choice == parameter.choice:
            parts.append(f" | {text}")
        elif parameter.optional:
            parts.append(f"\\{text}")
        else:
            parts.append(f",{text}" if parts else text)
        before = parameter
    return "".join(parts)


def one_parameter(parameter: ir.Parameter, expressions: Expressions) -> str:
    if parameter.switch:
        return f"switch {parameter.name}"
    mode = ""
    if parameter.mode == "reference":
        mode = "INOUT "
        if isinstance(parameter.type, ir.SignalType):
            mode = "VAR "
        elif isinstance(parameter.type, _PERSISTENT):
            mode = "PERS "
    return f"{mode}{type_name(parameter.type)} {parameter.name}{sizes(parameter.type, expressions)}"


def heading(routine: ir.Routine, expressions: Expressions) -> dict[str, object]:
    """The words of a routine's first line; the last one is END and its kind."""
    words: dict[str, object] = {"local": routine.scope == "module", "kind": "PROC", "returns": "", "name": routine.name}
    match routine.kind:
        case "function":
            if routine.returns is None:
                raise CannotSayError("a function without a type of result")
            words |= {"kind": "FUNC", "returns": type_name(routine.returns)}
        case "trap":
            return words | {"kind": "TRAP", "parameters": ""}
    return words | {"parameters": parameters(routine, expressions)}

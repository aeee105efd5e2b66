"""Which names a program mentions, and which of its modules belong to the source's controller: the used part of its
prelude, and the controller's own data lists."""

from __future__ import annotations

from collections import Counter

from rpl import ir
from rpl.passes.legalise.context import Context, rules_of
from rpl.passes.legalise.facts.usage import each_expression
from rpl.passes.legalise.kinds import gathering, walk_for
from rpl.passes.rewrite import rewrite_parts

_NAMING = frozenset(("Call", "CallRoutine", "ConnectInterrupt", "OnError", "TaskControl"))
_BUILT_IN = frozenset(("tool", "workobject", "load", "speed", "zone", "pose", "vector", "rotation", "joints", "axes"))


def naming_of_routines(program: ir.Program) -> Counter[str]:
    """How often each routine is called, started, connected to an interrupt or given to an error, by folded name."""
    found: Counter[str] = Counter()
    for node in walk_for(_NAMING, program):
        match node:
            case ir.Call(name=name) | ir.CallRoutine(name=name) | ir.ConnectInterrupt(routine=name):
                found[name.lower()] += 1
            case ir.OnError(routine=str() as name) | ir.TaskControl(task=str() as name):
                found[name.lower()] += 1
    return found


def is_linked(module: ir.Module, context: Context) -> bool:
    """Is it the used part of the source's prelude, or a list of its controller's own data?"""
    return module.name.lower().startswith(f"{context.source}_base") or is_system_data(module, context)


def is_system_data(module: ir.Module, context: Context) -> bool:
    """Is it a list of data that belongs to the source's controller?"""
    return module.name.lower() in rules_of(context.source).system_data


def called_as(name: str) -> str:
    """How a routine's name stands among the names in use."""
    return f"{name.lower()}()"


def _named_types(type: ir.Type | None) -> set[str]:
    """The name of a type of the program's own, of an array that of its elements."""
    while isinstance(type, ir.ArrayType):
        type = type.element
    return {type.name.lower()} if isinstance(type, ir.NamedType) else set()


def _named(one: ir.Expression) -> tuple[str, ...]:
    match one:
        case ir.Call(name=name):
            return name.lower(), called_as(name)
        case ir.Name(id=name) | ir.EnumLiteral(member=name):
            return (name.lower(),)
        case ir.Aggregate(type_name=word) if word and word not in _BUILT_IN:
            return (word.lower(),)
    return ()


@gathering(
    *("Call", "Name", "EnumLiteral", "Aggregate"),
    *("For", "CallRoutine", "ConnectInterrupt", "TaskControl", "OnError"),
)
def _said(statement: ir.Statement) -> set[str]:
    """The names that a statement mentions."""
    found: set[str] = set()
    match statement:
        case ir.For(counter=name):
            found.add(name.lower())
        case ir.CallRoutine(name=name) | ir.ConnectInterrupt(routine=name):
            found.update((name.lower(), called_as(name)))
        case ir.TaskControl(task=str() as name) | ir.OnError(routine=str() as name):
            found.update((name.lower(), called_as(name)))
    each_expression(statement, lambda one: found.update(_named(one)))
    return found


def mentioned(node: ir.Program | ir.Declaration | ir.Routine) -> set[str]:
    """Every name that the node mentions, folded: of values, routines, types and members."""
    found: set[str] = set()

    def types(type: ir.Type | None) -> None:
        found.update(_named_types(type))

    def expression(one: ir.Expression) -> ir.Expression:
        found.update(_named(one))
        return rewrite_parts(one, expression)

    def body(statements: ir.Body) -> ir.Body:
        found.update(*map(_said, statements))
        return statements

    def declaration(one: ir.Declaration) -> None:
        match one:
            case ir.Variable(type=type) | ir.AliasDeclaration(type=type):
                types(type)
            case ir.RecordDeclaration(fields=fields):
                for _, type in fields:
                    types(type)

    def routine(one: ir.Routine) -> None:
        types(one.returns)
        for parameter in one.parameters:
            types(parameter.type)
        for inner in one.declarations:
            declaration(inner)

    match node:
        case ir.Program(modules=modules):
            for module in modules:
                for one in module.declarations:
                    declaration(one)
                for each in module.routines:
                    routine(each)
        case ir.Routine():
            routine(node)
        case _:
            declaration(node)
    rewrite_parts(node, expression, body)
    return found


__all__ = ["called_as", "is_linked", "is_system_data", "mentioned"]

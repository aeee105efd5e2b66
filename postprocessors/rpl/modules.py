"""Declarations, routines, modules and whole programs as RPL writes them."""

from __future__ import annotations

from collections.abc import Iterator

from rpl import ir
from rpl.ir import words

from .expressions import (
    expression_text,
    function_name,
    name_text,
    place_text,
    procedure_name,
    text_literal,
    type_text,
    value_text,
)
from .statements import INDENT, body_lines, headed, standing

_SCOPES = {scope: f"{word.upper()} " for word, scope in words.SCOPE_WORDS.items()}
_STORAGES = {storage: word.upper() for word, storage in words.STORAGE_WORDS.items()}


def program_lines(program: ir.Program) -> Iterator[str]:
    """The whole program as the lines of one file."""
    head = [*entry_lines(program)]
    yield from head
    for position, module in enumerate(program.modules):
        if head or position:
            yield ""
        yield from module_lines(module)


def entry_lines(program: ir.Program) -> Iterator[str]:
    """Where the program begins, and its tasks."""
    if program.entry:
        yield f"ENTRY {name_text(program.entry)}"
    for task in program.tasks:
        text = f"TASK {name_text(task.name)} ENTRY {name_text(task.entry)}"
        if task.kind != "motion":
            text += f" {task.kind.upper()}"
        if task.cyclic:
            text += " CYCLIC"
        if task.modules:
            text += f" MODULES {', '.join(name_text(module) for module in task.modules)}"
        yield text


def module_lines(module: ir.Module) -> Iterator[str]:
    """One module from MODULE to END MODULE."""
    text = f"MODULE {name_text(module.name)}"
    if module.dialect != words.NATIVE:
        text += f" USING {name_text(module.dialect)}"
    if module.task:
        text += f" TASK {name_text(module.task)}"
    yield from headed(f"{text} PUBLIC" if module.public else text, module.origin, "")
    for name, value in module.attributes:
        yield f"{INDENT}ATTRIBUTE {text_literal(name)} {text_literal(value)}"
    for position, declaration in enumerate(module.declarations):
        last = position == len(module.declarations) - 1 and not module.routines
        yield from declaration_lines(declaration, INDENT, "module", last)
    for position, routine in enumerate(module.routines):
        if position or module.declarations or module.attributes:
            yield ""
        yield from routine_lines(routine, INDENT)
    yield "END MODULE"


def declaration_lines(declaration: ir.Declaration, indent: str, default: str, last: bool = False) -> Iterator[str]:
    """One declaration; the scope is written where it is not the `default` of the place."""
    if isinstance(declaration, ir.Unread) and not declaration.text:
        yield from standing(declaration.origin, indent, 'UNREAD ""', last)
        return
    if isinstance(declaration, ir.VariableRows):
        for one in declaration.variables():
            yield from declaration_lines(one, indent, default)
        return
    scope = getattr(declaration, "scope", default)
    prefix = "" if scope == default else _SCOPES[scope]
    yield from headed(prefix + _declaration(declaration), declaration.origin, indent)


def _declaration(declaration: ir.Declaration) -> str:
    match declaration:
        case ir.VariableRows(sample=sample):
            return _declaration(sample)
        case ir.Variable(name=name, type=type, initial=initial, storage=storage):
            value = "" if initial is None else f" = {value_text(initial)}"
            return f"{_STORAGES[storage]} {name_text(name)}: {type_text(type)}{value}"
        case ir.RecordDeclaration(name=name, fields=fields):
            inner = ", ".join(f"{name_text(field)}: {type_text(type)}" for field, type in fields)
            return f"RECORD {name_text(name)} ({inner})"
        case ir.EnumDeclaration(name=name, members=members):
            return f"ENUM {name_text(name)} ({', '.join(name_text(member) for member in members)})"
        case ir.AliasDeclaration(name=name, type=type):
            return f"ALIAS {name_text(name)}: {type_text(type)}"
        case ir.SignalDeclaration(name=name, signal=signal):
            return f"SIGNAL {name_text(name)} = {expression_text(signal)}"
        case ir.ExternalDeclaration(name=name, text=text):
            return f"EXTERNAL {name_text(name)} {text_literal(text)}"
        case ir.Initialise(assign=assign):
            return f"INIT {place_text(assign.target)} = {value_text(assign.value)}"
        case ir.Unread(text=text):
            return f"UNREAD {text_literal(text)}"


def routine_lines(routine: ir.Routine, indent: str) -> Iterator[str]:
    """One routine with its sections."""
    inner = indent + INDENT
    yield from headed(routine_head(routine), routine.origin, indent)
    for declaration in routine.declarations:
        yield from declaration_lines(declaration, inner, "routine")
    if routine.declarations and routine.declarations[-1] == ir.Unread(""):
        yield f"{indent}BEGIN"  # so that a remark at the end of the declarations stays with them
    yield from body_lines(routine.body, inner)
    for handler in routine.handlers:
        codes = ", ".join(expression_text(code) for code in handler.codes)
        yield f"{indent}ON ERROR {codes}".rstrip()
        yield from body_lines(handler.body, inner, handler.origin.comments if handler.body else ())
    if routine.undo:
        yield f"{indent}UNDO"
        yield from body_lines(routine.undo, inner)
    if routine.backward:
        yield f"{indent}BACKWARD"
        yield from body_lines(routine.backward, inner)
    yield f"{indent}END {routine.kind.upper()}"


def routine_head(routine: ir.Routine) -> str:
    """The first line of a routine."""
    scope = "" if routine.scope == "task" else _SCOPES[routine.scope]
    name = procedure_name(routine.name) if routine.kind == "procedure" else function_name(routine.name)
    parameters = ", ".join([*map(_parameter, routine.parameters), *(["..."] if routine.open_ended else [])])
    returns = "" if routine.returns is None else f": {type_text(routine.returns)}"
    return f"{scope}{routine.kind.upper()} {name}({parameters}){returns}"


def _parameter(parameter: ir.Parameter) -> str:
    parts = []
    if parameter.optional:
        parts.append("OPTIONAL")
    if parameter.choice is not None:
        parts.append(f"CHOICE {parameter.choice}")
    if parameter.switch:
        parts.append("SWITCH")
    if parameter.mode != "value":
        parts.append(parameter.mode.upper())
    return " ".join([*parts, f"{name_text(parameter.name)}: {type_text(parameter.type)}"])

"""Shared by the KRL tests: read text, strip what only carries comments, write and read back."""

from __future__ import annotations

import dataclasses
from typing import TypeVar

from rpl import ir, registry
from rpl.diagnostics import Diagnostics, Severity
from rpl.passes.typing import normalise
from rpl.source import Source, source_from_bytes, source_from_text
from rpl.writing.target import OutputFile, WriteContext

T = TypeVar("T")


def sources(files: dict[str, str]) -> list[Source]:
    return [source_from_text(name, text) for name, text in files.items()]


def read(files: dict[str, str] | str, normal: bool = True) -> tuple[ir.Program, Diagnostics]:
    """The program of some files (a bare text is `p.src`) and what was reported."""
    named = {"p.src": files} if isinstance(files, str) else files
    diagnostics = Diagnostics()
    program = registry.dialect("krl").read(sources(named), diagnostics).program
    return (normalise(program, diagnostics) if normal else program), diagnostics


def body(lines: str, declarations: str = "") -> tuple[ir.Body, Diagnostics]:
    """The statements of a routine with these lines, not yet normalised."""
    program, diagnostics = read(f"DEF P()\n{declarations}\n{lines}\nEND\n", normal=False)
    return program.modules[0].routines[0].body, diagnostics


def statement(line: str, declarations: str = "") -> ir.Statement:
    """The one statement of a line, which must read without a report."""
    found, diagnostics = body(line, declarations)
    assert not [item.as_text() for item in diagnostics]
    (only,) = found
    return only


def expression(text: str, declarations: str = "") -> ir.Expression:
    """An expression as a statement's value."""
    assign = statement(f"X={text}", declarations)
    assert isinstance(assign, ir.Assign)
    return assign.value


def shown(expression: ir.Expression) -> str:
    """An expression with all its brackets, for tables of cases."""
    match expression:
        case ir.Binary(op=op, left=left, right=right):
            return f"({shown(left)} {op} {shown(right)})"
        case ir.Unary(op=op, operand=operand):
            return f"({op} {shown(operand)})"
        case ir.IntLiteral(value=value) | ir.RealLiteral(value=value) | ir.BoolLiteral(value=value):
            return str(value)
        case ir.Name(id=name) | ir.EnumLiteral(member=name):
            return name
        case ir.Field(base=base, name=name):
            return f"{shown(base)}.{name}"
        case ir.Index(base=base, indices=indices):
            return f"{shown(base)}[{','.join(map(shown, indices))}]"
        case ir.Aggregate(entries=entries):
            return "{" + ",".join(f"{name} {shown(value)}" for name, value in entries) + "}"
        case ir.Call(name=name, arguments=arguments):
            listed = ",".join(shown(a.value) if a.value else "" for a in arguments)
            return f"{name}({listed})"
        case ir.Builtin(function=name, arguments=values):
            return f"{name}({','.join(map(shown, values))})"
        case ir.System(name=name):
            return f"@{name}"
        case ir.Magnitude(value=value, unit=unit) | ir.Quantity(value=value, unit=unit):
            return f"<{shown(value)} {unit}>"
        case ir.Convert(how=how, operand=operand):
            return f"{how}({shown(operand)})"
        case ir.Signal(kind=kind, index=index):
            return f"{kind}:{shown(index) if index else ''}"
        case ir.TextLiteral(value=text):
            return repr(text)
    return repr(expression)


def without_comments(node: T) -> T:
    """The IR without nodes that only carry comments or blank lines."""
    if dataclasses.is_dataclass(node) and not isinstance(node, type):
        changes = {
            field.name: without_comments(getattr(node, field.name))
            for field in dataclasses.fields(node)
            if field.name != "origin"
        }
        return dataclasses.replace(node, **changes)
    if isinstance(node, tuple):
        kept = (part for part in node if not isinstance(part, ir.Nothing) and part != ir.Unread(""))
        return tuple(without_comments(part) for part in kept)  # type: ignore[return-value]
    return node


def written(program: ir.Program) -> tuple[list[OutputFile], Diagnostics]:
    diagnostics = Diagnostics()
    return registry.target("krl").write(program, WriteContext(diagnostics)), diagnostics


def round_trip(files: dict[str, str] | str) -> tuple[ir.Program, ir.Program, str]:
    """The program, the program read from what was written of it, and that text."""
    program, _ = read(files)
    out, losses = written(program)
    assert not [item.as_text() for item in losses]
    diagnostics = Diagnostics()
    again = registry.dialect("krl").read([source_from_bytes(f.path, f.data) for f in out], diagnostics).program
    again = normalise(again, diagnostics)
    assert not [item.as_text() for item in diagnostics if item.severity >= Severity.ERROR]
    text = "\n".join(file.data.decode("cp1252") for file in out)
    return without_comments(program), without_comments(again), text

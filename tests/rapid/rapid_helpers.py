"""Short ways to read RAPID in tests, and to compare programs without the nodes that only carry remarks."""

from __future__ import annotations

from dataclasses import replace

from rpl import ir, registry
from rpl.diagnostics import Diagnostics
from rpl.passes.rewrite import rewrite_parts
from rpl.passes.typing import normalise
from rpl.registry import ReadResult
from rpl.source import source_from_bytes, source_from_text
from rpl.writing.target import WriteContext


def read(text: str, path: str = "test.mod") -> tuple[ReadResult, Diagnostics]:
    diagnostics = Diagnostics()
    return registry.dialect("rapid").read([source_from_text(path, text)], diagnostics), diagnostics


def module(text: str) -> ir.Module:
    """The only module of the text, which must read without a report of errors."""
    result, diagnostics = read(text)
    assert not diagnostics.has_errors, [item.as_text() for item in diagnostics]
    (only,) = result.program.modules
    return only


def body(text: str, declarations: str = "") -> ir.Body:
    """The statements of a procedure with this text."""
    return module(f"MODULE m\n{declarations}\nPROC main()\n{text}\nENDPROC\nENDMODULE\n").routines[0].body


def statement(text: str, declarations: str = "") -> ir.Statement:
    (only,) = body(text, declarations)
    return only


def expression(text: str, declarations: str = "VAR num a;VAR num b;VAR num c;VAR bool p;VAR bool q;") -> ir.Expression:
    found = statement(f"x:={text};", f"VAR num x;{declarations}")
    assert isinstance(found, ir.Assign)
    return found.value


def normal(text: str, path: str = "test.mod") -> ir.Program:
    result, diagnostics = read(text, path)
    return normalise(result.program, diagnostics)


def written(program: ir.Program) -> tuple[str, Diagnostics]:
    """All modules as one text (a RAPID file may hold several)."""
    diagnostics = Diagnostics()
    files = registry.target("rapid").write(program, WriteContext(diagnostics))
    return "\n".join(file.data.decode("latin-1") for file in files), diagnostics


def read_back(program: ir.Program) -> ir.Program:
    """Written as RAPID, read again, in normal form."""
    diagnostics = Diagnostics()
    files = registry.target("rapid").write(program, WriteContext(diagnostics, foreign=False))
    sources = [source_from_bytes(file.path, file.data) for file in files]
    again = registry.dialect("rapid").read(sources, diagnostics)
    assert not diagnostics.has_errors, [item.as_text() for item in diagnostics]
    return normalise(again.program, diagnostics)


def without_remarks(program: ir.Program) -> ir.Program:
    """Remarks travel with the next statement, so the nodes that carry lonely ones may differ."""

    def inner(body: ir.Body) -> ir.Body:
        return tuple(
            rewrite_parts(statement, lambda expression: expression, inner)
            for statement in body
            if not isinstance(statement, ir.Nothing)
        )

    modules = []
    for one in program.modules:
        routines = tuple(
            replace(
                routine,
                body=inner(routine.body),
                undo=inner(routine.undo),
                backward=inner(routine.backward),
                handlers=tuple(replace(handler, body=inner(handler.body)) for handler in routine.handlers),
            )
            for routine in one.routines
        )
        declarations = tuple(d for d in one.declarations if not isinstance(d, ir.Unread) or d.text)
        modules.append(replace(one, declarations=declarations, routines=routines))
    return replace(program, modules=tuple(modules))

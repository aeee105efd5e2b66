"""SELECT looks at a register: a signal that decides is read into one first."""

from __future__ import annotations

from dataclasses import replace

from rpl import ir
from rpl.passes.legalise.context import Context
from rpl.passes.legalise.rewriting.editing import Editor, edit_bodies, edit_routines, expansion, map_body
from rpl.passes.legalise.rewriting.jumps import inside
from rpl.passes.legalise.stages import legalising


@legalising(sees=("Switch",))
def signals_in_registers(program: ir.Program, context: Context) -> ir.Program:
    """A choice by a group of signals is one by what they show when it begins."""

    def work(editor: Editor, routine: ir.Routine) -> ir.Routine:
        def change(statement: ir.Statement) -> ir.Body:
            statement = inside(statement, lambda inner: map_body(inner, change))
            if not isinstance(statement, ir.Switch) or not _is_signal(statement.selector, editor):
                return (statement,)
            kept = editor.temporary("step", ir.IntType())
            read = ir.Assign(kept, statement.selector)
            return expansion(statement.origin, (read, replace(statement, selector=kept)))

        return edit_bodies(routine, lambda body: map_body(body, change))

    return edit_routines(program, context, work)


def _is_signal(value: ir.Expression, editor: Editor) -> bool:
    symbol = editor.scope.value(value.id) if isinstance(value, ir.Name) else None
    return isinstance(value, ir.Signal) or (symbol is not None and isinstance(symbol.declaration, ir.SignalDeclaration))


__all__ = ["signals_in_registers"]

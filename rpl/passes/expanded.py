"""A program without runs: the moves of each stand for themselves, for whoever looks at moves one by one."""

from __future__ import annotations

from collections.abc import Iterable

from rpl import ir
from rpl.passes.collector import paused_cycle_collector
from rpl.passes.rewrite import changed, each, rewrite_parts

_BLOCKS = (ir.If, ir.Switch, ir.For, ir.While, ir.Repeat, ir.Loop)


def expanded(program: ir.Program) -> ir.Program:
    """The program with the moves of its runs in place; itself where it has none."""
    with paused_cycle_collector():
        return changed(program, modules=each(program.modules, _module))


def _module(module: ir.Module) -> ir.Module:
    return changed(module, routines=each(module.routines, _routine))


def _routine(routine: ir.Routine) -> ir.Routine:
    handlers = each(routine.handlers, lambda handler: changed(handler, body=spread(handler.body)))
    body, undo, backward = spread(routine.body), spread(routine.undo), spread(routine.backward)
    declarations = routine.declarations
    if any(isinstance(one, ir.VariableRows) for one in declarations):
        declarations = tuple(each for one in declarations for each in _declared(one))
    return changed(routine, declarations=declarations, body=body, handlers=handlers, undo=undo, backward=backward)


def _declared(declaration: ir.Declaration) -> Iterable[ir.Declaration]:
    return declaration.variables() if isinstance(declaration, ir.VariableRows) else (declaration,)


def spread(body: ir.Body) -> ir.Body:
    """A body with its runs, and those of the bodies in it, spread out."""
    if not any(isinstance(one, ir.Run | ir.Rows) for one in body):
        return each(body, _statement)
    done: list[ir.Statement] = []
    for one in body:
        done.extend(one.moves() if isinstance(one, ir.Run | ir.Rows) else (_statement(one),))
    return tuple(done)


def _statement(statement: ir.Statement) -> ir.Statement:
    return rewrite_parts(statement, _kept, spread) if isinstance(statement, _BLOCKS) else statement


def _kept(expression: ir.Expression) -> ir.Expression:
    return expression

"""Interrupts that brake a move which then goes on: V+ BRAKE drops the move.

The move would have to begin again in its middle, by a program that asks behind it whether it was braked: that is
refused where the interrupt is declared. Where no move is driven while it is on, there is nothing to drop.
"""

from __future__ import annotations

from rpl import ir
from rpl.passes.legalise.context import Context
from rpl.passes.legalise.facts.reach import Armed, armed_statements, key_of, number_of
from rpl.passes.legalise.facts.usage import called_below
from rpl.passes.legalise.kinds import walk_for
from rpl.passes.legalise.rewriting.editing import edit_all, edit_bodies, map_body
from rpl.passes.legalise.rewriting.jumps import inside
from rpl.passes.legalise.rewriting.refusedactions import BRAKED, REFUSED, without_actions
from rpl.passes.legalise.rewriting.stopping import left_out, stopped
from rpl.passes.legalise.stages import legalising

_DRIVEN = (ir.Move, ir.MoveExternal, ir.Spline)


@legalising(sees=("StopMotion",))
def braked_moves(program: ir.Program, context: Context) -> ir.Program:
    """Interrupts that brake without dropping the move themselves, while a move may be driven."""
    routines = {routine.name.lower(): routine for module in program.modules for routine in module.routines}
    refused: list[ir.DeclareInterrupt] = []
    for node in walk_for({"DeclareInterrupt"}, *program.modules):
        if isinstance(node, ir.DeclareInterrupt) and isinstance(node.action, ir.CallRoutine):
            below = called_below(program, {node.action.name.lower()})
            if any(_holds(routines[name]) for name in below if name in routines) and _drives(program, key_of(node)):
                refused.append(node)
    keys = {key_of(one) for one in refused}

    def change(statement: ir.Statement) -> ir.Body:
        match statement:
            case ir.DeclareInterrupt(action=ir.CallRoutine(name=name)) if key_of(statement) in keys:
                return (stopped(statement, BRAKED, context, action=name),)
            case ir.ControlInterrupt(handle=handle) if handle is not None and number_of(handle) in keys:
                return (left_out(statement, REFUSED),)
        return (inside(statement, lambda body: map_body(body, change)),)

    return edit_all(without_actions(program, refused), lambda body: map_body(body, change)) if refused else program


def _drives(program: ir.Program, key: int | None) -> bool:
    """Is the robot driven while the interrupt may come?"""
    on = frozenset[int]() if key is None else armed_statements(program, Armed(key))
    return key is None or any(
        isinstance(node, _DRIVEN) and id(node) in on
        for node in walk_for({"Move", "MoveExternal", "Spline"}, *program.modules)
    )


def _holds(routine: ir.Routine) -> bool:
    """Does it brake without dropping the move in the next statement?"""
    found = False

    def look(body: ir.Body) -> ir.Body:
        nonlocal found
        for at, statement in enumerate(body):
            if isinstance(statement, ir.StopMotion):
                found = found or not (at + 1 < len(body) and isinstance(body[at + 1], ir.ClearMotion))
            inside(statement, look)
        return body

    edit_bodies(routine, look)
    return found


__all__ = ["braked_moves"]

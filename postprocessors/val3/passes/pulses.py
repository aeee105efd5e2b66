"""Pulses of outputs: VAL3 has none, so the program sets the output, and a task waits and sets it back meanwhile.

One program for each output, level and length; a pulse that begins before the one before it has ended is left out by the
controller (M: a task of that name exists).
"""

from __future__ import annotations

from dataclasses import replace

from rpl import ir
from rpl.passes.legalise.context import Context
from rpl.passes.legalise.kinds import walk_for
from rpl.passes.legalise.rewriting.editing import edit_all, map_body
from rpl.passes.legalise.stages import legalising
from rpl.passes.rewrite import rewrite_bodies


@legalising(sees=("Pulse",))
def pulses_as_tasks(program: ir.Program, context: Context) -> ir.Program:
    """A task in the place of each pulse of constant length to a constant level."""
    taken = {routine.name for module in program.modules for routine in module.routines}
    made: dict[ir.Pulse, str] = {}
    for node in walk_for({"Pulse"}, *program.modules):
        if isinstance(node, ir.Pulse) and _is_plain(node) and node not in made:
            number = len(made) + 1
            while f"pulse{number}" in taken:
                number += 1
            taken.add(f"pulse{number}")
            made[node] = f"pulse{number}"
    if not made:
        return program

    def change(statement: ir.Statement) -> ir.Body:
        match statement:
            case ir.Pulse() if statement in made:
                begun = ir.Assign(statement.signal, statement.value, origin=statement.origin)
                rest = replace(statement.origin, comments=())
                return (begun, ir.TaskControl("start", made[statement], origin=rest))
        return (rewrite_bodies(statement, lambda body: map_body(body, change)),)

    done = edit_all(program, lambda body: map_body(body, change))
    first = done.modules[0]
    routines = tuple(_routine(name, pulse) for pulse, name in made.items())
    return replace(done, modules=(replace(first, routines=(*first.routines, *routines)), *done.modules[1:]))


def _is_plain(pulse: ir.Pulse) -> bool:
    constant = isinstance(pulse.duration, ir.RealLiteral | ir.IntLiteral | ir.Quantity)
    return constant and isinstance(pulse.value, ir.BoolLiteral) and isinstance(pulse.signal, ir.Signal)


def _routine(name: str, pulse: ir.Pulse) -> ir.Routine:
    assert isinstance(pulse.value, ir.BoolLiteral)  # only such pulses are collected
    ends_at = ir.BoolLiteral(not pulse.value.value)
    return ir.Routine(name, body=(ir.Wait(pulse.duration), ir.Assign(pulse.signal, ends_at)), scope="global")

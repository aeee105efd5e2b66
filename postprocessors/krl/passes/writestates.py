"""The state that SWRITE tells in a variable of the type STATE_T (KUKA System Software, CREAD/CWRITE)."""

from __future__ import annotations

from dataclasses import replace

from rpl import ir
from rpl.passes.legalise.context import Context
from rpl.passes.legalise.rewriting.editing import edit_bodies, edit_each, map_body
from rpl.passes.legalise.rewriting.jumps import inside
from rpl.passes.legalise.stages import legalising

_STATE = ir.NamedType("STATE_T")


@legalising(sees=("procedure format_into",))
def states_of_writes(program: ir.Program, context: Context) -> ir.Program:
    """All formatted writes of a routine that passes have made tell their states in one variable."""

    def work(module: ir.Module, routine: ir.Routine) -> ir.Routine:
        state: list[ir.Variable] = []
        offsets: set[str] = set()

        def change(statement: ir.Statement) -> ir.Body:
            match statement:
                case ir.Do(procedure="format_into", arguments=(text, None, ir.Name(id=offset) as place, *shown)):
                    if not state:
                        state.append(ir.Variable(context.fresh("state"), _STATE, scope="routine"))
                    offsets.add(offset)
                    return (replace(statement, arguments=(text, ir.Name(state[0].name), place, *shown)),)
            return (inside(statement, lambda inner: map_body(inner, change)),)

        done = edit_bodies(routine, lambda body: map_body(body, change))
        return _declared(done, state[0], offsets) if state else routine

    return edit_each(program, work)


def _declared(routine: ir.Routine, state: ir.Variable, offsets: set[str]) -> ir.Routine:
    """The routine with the state in front of the offsets, as people declare both."""
    declared = list(routine.declarations)
    names = [one.name if isinstance(one, ir.Variable) else "" for one in declared]
    first = next((at for at, name in enumerate(names) if name in offsets), len(declared))
    return replace(routine, declarations=(*declared[:first], state, *declared[first:]))


__all__ = ["states_of_writes"]

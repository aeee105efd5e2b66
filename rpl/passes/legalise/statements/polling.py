"""Waits for conditions that the target cannot wait for: a loop that looks again after a short time.

The time limit is counted in these short times. A wait whose condition calls a user function is such a loop as well
where functions become procedures.
"""

from __future__ import annotations

from rpl import ir
from rpl.passes.capabilities import RoutineRule
from rpl.passes.legalise.context import Context
from rpl.passes.legalise.facts.effects import everything
from rpl.passes.legalise.facts.raising import Raising, raising_of
from rpl.passes.legalise.rewriting.editing import Editor, edit_bodies, edit_routines, map_body
from rpl.passes.legalise.rewriting.jumps import inside
from rpl.passes.legalise.rewriting.polling import polled
from rpl.passes.legalise.stages import legalising


@legalising()
def poll_waits(program: ir.Program, context: Context) -> ir.Program:
    """The program with only the waits that the target has."""
    facts: list[Raising] = []

    def work(editor: Editor, routine: ir.Routine) -> ir.Routine:
        def change(statement: ir.Statement) -> ir.Body:
            if isinstance(statement, ir.WaitUntil) and _needed(statement, context):
                if not facts:
                    facts.append(raising_of(program))
                return polled(statement, editor, facts[0])
            return (inside(statement, lambda inner: map_body(inner, change)),)

        return edit_bodies(routine, lambda body: map_body(body, change))

    return edit_routines(program, context, work)


def _needed(statement: ir.WaitUntil, context: Context) -> bool:
    can = context.capabilities
    if "WaitUntil" not in can.statements:
        return True
    timers = "timer" in can.system_variables and can.io.timers
    if statement.timeout is not None and not can.io.wait_timeout and not timers:
        return True
    return RoutineRule.FUNCTIONS not in can.routines.rules and any(
        isinstance(one, ir.Call) for one in everything(statement.condition)
    )

"""Waits for conditions that the target cannot wait for: a loop that looks again after a short time.

The time limit is counted in these short times. A wait whose condition calls a user function is such a loop as well
where functions become procedures.
"""

from __future__ import annotations

from rpl import ir
from rpl.passes.capabilities import RoutineRule
from rpl.passes.conditions import negation
from rpl.passes.legalise.context import Context
from rpl.passes.legalise.facts.effects import everything, is_constant
from rpl.passes.legalise.facts.raising import Raising, raising_of
from rpl.passes.legalise.rewriting.editing import Editor, edit_bodies, edit_routines, expansion, map_body
from rpl.passes.legalise.rewriting.jumps import inside
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


def polled(statement: ir.WaitUntil, editor: Editor, facts: Raising | None = None) -> ir.Body:
    """The wait as a loop. `facts`: only needed for one that ends too late and has nothing to say it by."""
    can = editor.capabilities
    period = ir.RealLiteral(can.io.poll_s)
    pause = ir.Wait(ir.Quantity(period, "s"))
    before: list[ir.Statement] = []
    if statement.in_position:
        before.append(
            ir.WaitForMotion() if "WaitForMotion" in can.statements else ir.Wait(ir.IntLiteral(0), in_position=True)
        )
    waiting = negation(statement.condition)
    if statement.timeout is None:
        return expansion(statement.origin, (*before, ir.While(waiting, (pause,))))
    limit = seconds_of(statement.timeout)
    if not is_constant(limit):
        kept = editor.temporary("limit", ir.RealType())
        before.append(ir.Assign(kept, limit))
        limit = kept
    waited = editor.temporary("waited", ir.RealType())
    late: list[ir.Statement] = [ir.ExitLoop()]
    if statement.timed_out is not None:
        before.append(ir.Assign(statement.timed_out, ir.BoolLiteral(False)))
        late.insert(0, ir.Assign(statement.timed_out, ir.BoolLiteral(True)))
    else:
        assert facts is not None  # who calls gives them for such a wait
        late = [ir.Raise(facts.timeout_code(statement))]
    before.append(ir.Assign(waited, ir.RealLiteral(0.0)))
    check = ir.If(((ir.Binary(">=", waited, limit), tuple(late)),))
    more = ir.Assign(waited, ir.Binary("+", waited, period))
    return expansion(statement.origin, (*before, ir.While(waiting, (check, pause, more))))


def seconds_of(timeout: ir.Expression) -> ir.Expression:
    """The limit as a plain number of seconds."""
    match timeout:
        case ir.Quantity(value=value, unit="s"):
            return value
        case ir.Quantity(value=value, unit=unit):
            factor = ir.UNITS[unit]
            known = _literal(value)
            return (
                ir.RealLiteral(known * factor) if known is not None else ir.Binary("*", value, ir.RealLiteral(factor))
            )
    return timeout


def _literal(value: ir.Expression) -> float | None:
    """The number that a literal is."""
    return float(value.value) if isinstance(value, ir.IntLiteral | ir.RealLiteral) else None

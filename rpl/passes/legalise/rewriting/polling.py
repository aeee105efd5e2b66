"""A wait as a loop that looks again after a short time, with the time limit counted in these short times."""

from __future__ import annotations

from rpl import ir
from rpl.passes.conditions import negation
from rpl.passes.legalise.facts.effects import is_constant
from rpl.passes.legalise.facts.raising import Raising
from rpl.passes.legalise.rewriting.editing import Editor, expansion


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

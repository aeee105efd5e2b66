"""Whether a wait has taken too long is asked by what it waits for, as people do whose waits give no answer.

`WAIT FOR ok OR $TIMER_FLAG[1]`, `IF NOT ok THEN`: no flag is kept. A loop that only waits, does something where that
took too long, and ends when it was in time, looks first: where the condition holds, a pass of it does nothing.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass, replace

from rpl import ir
from rpl.ir.walk import walk
from rpl.passes.conditions import negation
from rpl.passes.legalise.context import Context
from rpl.passes.legalise.kinds import walk_for
from rpl.passes.legalise.rewriting.editing import edit_all
from rpl.passes.legalise.stages import legalising
from rpl.passes.rewrite import rewrite_bodies

__all__ = ["late_flags"]

_ACTS_ON = frozenset(("WaitUntil",))


@legalising(sees=("WaitUntil",))
def late_flags(program: ir.Program, context: Context) -> ir.Program:
    """A wait that is tried again and again is a loop that looks first; whether it has taken too long is asked by the
    condition where waits have no limit or do not say it, else by their flag."""
    by_condition = not (context.capabilities.io.wait_timeout and context.capabilities.io.wait_answers)
    uses = Counter(node.id.lower() for node in walk_for({"Name"}, *program.modules) if isinstance(node, ir.Name))
    worker = _Flags(uses, "While" in context.capabilities.statements, by_condition)
    return edit_all(program, worker.body, _ACTS_ON)


@dataclass(frozen=True, slots=True)
class _Flags:
    """`uses`: how often a variable is named. `first`: are there loops that look first? `condition`: is a flag asked
    by the condition of its wait?"""

    uses: Counter[str]
    first: bool
    condition: bool

    def body(self, body: ir.Body) -> ir.Body:
        done: list[ir.Statement] = []
        for statement in body:
            new = self.looped(rewrite_bodies(statement, self.body))
            before = done[-1] if done else None
            if self.condition and isinstance(before, ir.WaitUntil) and isinstance(new, ir.If):
                new = self.asked(before, new)
            done.append(new)
        same = len(done) == len(body) and all(one is other for one, other in zip(done, body, strict=True))
        return body if same else tuple(done)

    def asked(self, wait: ir.WaitUntil, choice: ir.If) -> ir.If:
        """The choice behind a wait, by the condition where it is by a flag that nothing else asks."""
        match wait, choice.branches:
            case ir.WaitUntil(timed_out=ir.Name(id=name) as late), ((asked, inner), *rest) if (
                self.uses[name.lower()] == 2 and asked in (late, negation(late)) and _again(wait.condition)
            ):
                missed = negation(wait.condition) if asked == late else wait.condition
                return replace(choice, branches=((missed, inner), *rest))
        return choice

    def looped(self, statement: ir.Statement) -> ir.Statement:
        """A loop that waits again and again looks first."""
        match statement:
            case ir.Repeat(until=until, body=body) if self.first:
                parts = _said(body)
            case _:
                return statement
        match parts:
            case (
                ir.WaitUntil(condition=condition, timed_out=ir.Name(id=name) as late),
                ir.If(branches=((asked, inner),), otherwise=()) as choice,
            ) if asked in (late, negation(condition)) and until in (negation(late), condition) and _again(condition):
                own = (asked == late) + (until == negation(late))
                if own and (not self.condition or self.uses[name.lower()] != 1 + own):
                    return statement
                missed = negation(condition)
                again = tuple(replace(choice, branches=((missed, inner),)) if one is choice else one for one in body)
                return ir.While(missed, again, origin=statement.origin)
        return statement


def _again(condition: ir.Expression) -> bool:
    """Does asking the condition once more change nothing?"""
    return not any(isinstance(node, ir.Call) for node in walk(condition))


def _said(body: ir.Body) -> Sequence[ir.Statement]:
    """Without what says nothing."""
    return [one for one in body if not isinstance(one, ir.Nothing)]

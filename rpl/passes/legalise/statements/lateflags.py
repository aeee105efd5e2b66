"""Whether a wait has taken too long is asked by what it waits for, as people do whose waits give no answer.

`WAIT FOR ok OR $TIMER_FLAG[1]`, `IF NOT ok THEN`: no flag is kept. A loop that only waits, does something where that
took too long, and ends when it was in time, looks first: where the condition holds, a pass of it does nothing.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass, replace

from rpl import ir
from rpl.passes.conditions import negation
from rpl.passes.legalise.context import Context
from rpl.passes.legalise.kinds import walk_for
from rpl.passes.legalise.rewriting.editing import edit_all
from rpl.passes.legalise.stages import legalising
from rpl.passes.rewrite import rewrite_bodies

__all__ = ["answered_by_condition", "late_flags"]

_ACTS_ON = frozenset(("WaitUntil",))


@legalising(sees=("WaitUntil",))
def late_flags(program: ir.Program, context: Context) -> ir.Program:
    """Where waits have a limit, their flag is what people ask, and only loops change."""
    return _Flags.of(program, context, asked=not context.capabilities.io.wait_timeout).program(program)


@legalising(sees=("WaitUntil",))
def answered_by_condition(program: ir.Program, context: Context) -> ir.Program:
    """For targets that bring it along: their waits have a limit, but give no answer that can be asked in one line."""
    return _Flags.of(program, context, asked=True).program(program)


def _uses(program: ir.Program) -> Counter[str]:
    """How often each variable is named, by folded name."""
    return Counter(node.id.lower() for node in walk_for({"Name"}, *program.modules) if isinstance(node, ir.Name))


@dataclass(frozen=True, slots=True)
class _Flags:
    """`uses`: how often a variable is named. `first`: are there loops that look first? `condition`: is a flag asked
    by the condition of its wait?"""

    uses: Counter[str]
    first: bool
    condition: bool

    @staticmethod
    def of(program: ir.Program, context: Context, asked: bool) -> _Flags:
        return _Flags(_uses(program), "While" in context.capabilities.statements, asked)

    def program(self, program: ir.Program) -> ir.Program:
        return edit_all(program, self.body, _ACTS_ON)

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
            case ir.WaitUntil(timed_out=ir.Name(id=name) as late), ((asked, inner), *rest) if self.uses[
                name.lower()
            ] == 2 and asked in (late, negation(late)):
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
            ) if asked in (late, negation(condition)) and until in (negation(late), condition):
                own = (asked == late) + (until == negation(late))
                if own and (not self.condition or self.uses[name.lower()] != 1 + own):
                    return statement
                missed = negation(condition)
                again = tuple(replace(choice, branches=((missed, inner),)) if one is choice else one for one in body)
                return ir.While(missed, again, origin=statement.origin)
        return statement


def _said(body: ir.Body) -> Sequence[ir.Statement]:
    """Without what says nothing."""
    return [one for one in body if not isinstance(one, ir.Nothing)]

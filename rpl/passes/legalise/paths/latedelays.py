"""Times behind the end of a move that stops, where a controller shifts an action no further than that end.

The action happens at the end itself there (KRL TRIGGER WHEN DISTANCE=1 with a DELAY above 0). From such a source it is
written without its time, which other controllers would let pass after the robot has come to rest; for such a target the
time is lost, which is reported.
"""

from __future__ import annotations

from dataclasses import replace

from rpl import ir
from rpl.diagnostics import Severity, code
from rpl.passes.fold import constant_number
from rpl.passes.legalise.context import Context, rules_of
from rpl.passes.legalise.rewriting.editing import edit_bodies
from rpl.passes.legalise.rewriting.formulas import plain
from rpl.passes.legalise.rewriting.jumps import inside
from rpl.passes.legalise.stages import legalising
from rpl.passes.scope import ProgramScope, Scope

AT_THE_END = code(
    "late-action-at-end",
    Severity.WARNING,
    "this action comes {seconds} s behind the end of its move; the target's controller does it at the end",
    "let the target's program wait and act in statements of its own",
)


@legalising(sees=("Trigger",))
def without_late_delays(program: ir.Program, context: Context) -> ir.Program:
    """The program with such actions at the ends of their moves."""
    bound = [rules_of(name).triggers.delays_within_move for name in (context.source, context.target)]
    if bound[0] == bound[1]:
        return program
    scopes, modules = ProgramScope(program), []
    for module in program.modules:
        workers = [(routine, _Late(scopes.routine(module, routine), context, bound[1])) for routine in module.routines]
        modules.append(replace(module, routines=tuple(edit_bodies(each, worker.body) for each, worker in workers)))
    return replace(program, modules=tuple(modules))


class _Late:
    def __init__(self, scope: Scope, context: Context, lost: bool) -> None:
        self.scope, self.context, self.lost = scope, context, lost

    def body(self, body: ir.Body) -> ir.Body:
        done: list[ir.Statement] = []
        same = True
        for place, statement in enumerate(body):
            new = self.statement(statement, body[place + 1 :])
            same = same and new is statement
            done.append(new)
        return body if same else tuple(done)

    def statement(self, statement: ir.Statement, behind: ir.Body) -> ir.Statement:
        if isinstance(statement, ir.Trigger):
            following = next((one for one in behind if not isinstance(one, ir.Trigger | ir.Nothing)), None)
            return self.bounded(statement) if isinstance(following, ir.Move) and self.stops(following) else statement
        if isinstance(statement, ir.Move) and statement.triggers and self.stops(statement):
            own = tuple(self.bounded(one) if isinstance(one, ir.Trigger) else one for one in statement.triggers)
            unchanged = all(new is old for new, old in zip(own, statement.triggers, strict=True))
            return statement if unchanged else replace(statement, triggers=own)
        return inside(statement, self.body)

    def bounded(self, trigger: ir.Trigger) -> ir.Trigger:
        """Without its time, where that is a constant one behind the end."""
        if trigger.reference == "start" or trigger.delay is None:
            return trigger
        distance = 0 if trigger.distance is None else constant_number(plain(trigger.distance), self.scope)
        delay = constant_number(plain(trigger.delay), self.scope)
        if distance != 0 or delay is None or delay <= 0:
            return trigger
        if self.lost:
            self.context.diagnostics.report(AT_THE_END, trigger.origin, seconds=f"{delay:g}")
        return replace(trigger, delay=None)

    def stops(self, move: ir.Move) -> bool:
        """Does the robot stand at its end? A corner of no size (CNT0) is no corner."""
        match move.blend:
            case None | ir.BlendStop():
                return True
            case ir.BlendPercent(percent=size, path=None):
                return constant_number(plain(size), self.scope) == 0
        return False


__all__ = ["without_late_delays"]

"""Where a source's advance run stops between two moves, its blend is an exact stop; the target must be told so.

KRL stops the advance run at every access to a signal or an actual position unless CONTINUE stands before it, and a move
that is followed by such a stop is not blended. Targets whose program runs on past a fly-by move would blend.
"""

from __future__ import annotations

from dataclasses import replace

from rpl import ir
from rpl.diagnostics import Severity, code
from rpl.passes.legalise.context import Context, ProgramScope, rules_of
from rpl.passes.legalise.facts.motion.advance import touches
from rpl.passes.legalise.rewriting.editing import edit_bodies
from rpl.passes.legalise.stages import legalising
from rpl.passes.rewrite import rewrite_bodies
from rpl.passes.scope import Scope

STOPPED = code(
    "blend-stopped",
    Severity.INFO,
    "the controller does not blend this move: the statement at line {line} stops its advance run",
)


@legalising(unless=lambda context: not rules_of(context.source).advance.signals_stop)
def stop_blends(program: ir.Program, context: Context) -> ir.Program:
    """Blends that the source controller cancels become stops; CONTINUE marks that have done their work are removed."""
    rules = rules_of(context.source).advance
    scopes = ProgramScope(program)
    keeps_marks = "LookAhead" in context.capabilities.statements
    modules = []
    for module in program.modules:
        routines = []
        for routine in module.routines:
            worker = _Stops(context, scopes.routine(module, routine), rules.stop_statements, keeps_marks)
            routines.append(edit_bodies(routine, worker.body))
        modules.append(replace(module, routines=tuple(routines)))
    return replace(program, modules=tuple(modules))


class _Stops:
    def __init__(self, context: Context, scope: Scope, stops: frozenset[str], keeps_marks: bool) -> None:
        self.context, self.scope, self.stops, self.keeps_marks = context, scope, stops, keeps_marks

    def body(self, body: ir.Body) -> ir.Body:
        done: list[ir.Statement] = []
        for position, statement in enumerate(body):
            if isinstance(statement, ir.Move) and statement.blend not in (None, ir.BlendStop()):
                stopper = self.stopper(body[position + 1 :])
                if stopper is not None:
                    self.context.diagnostics.report(STOPPED, statement.origin, line=stopper.origin.line)
                    statement = replace(statement, blend=ir.BlendStop())
            elif isinstance(statement, ir.LookAhead) and not self.keeps_marks:
                if statement.origin.comments:
                    done.append(ir.Nothing(origin=statement.origin))
                continue
            done.append(rewrite_bodies(statement, self.body))
        return tuple(done)

    def stopper(self, rest: ir.Body) -> ir.Statement | None:
        """The first statement before the next move that stops the advance run, as far as this body shows."""
        allowed = False
        for statement in rest:
            match statement:
                case ir.Move() | ir.Spline() | ir.MoveExternal():
                    return None
                case ir.LookAhead():
                    allowed = True
                    continue
                case ir.Nothing() | ir.Trigger():
                    continue
            if not allowed and (statement.__class__.__name__ in self.stops or touches(statement, self.scope)):
                return statement
            allowed = False
            if isinstance(statement, ir.If | ir.Switch | ir.For | ir.While | ir.Repeat | ir.Loop | ir.Label | ir.Goto):
                return None  # what comes next depends on the run; the target's own look-ahead decides
        return None

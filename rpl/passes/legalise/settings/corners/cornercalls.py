"""Corners in front of a call, for controllers whose program stands still for the robot at every signal (KRL).

Where the routine that is called looks at a signal or sets one before it moves the robot, the robot stops at the corner;
a source whose program runs on drives it. What stands in one routine with the move is written so that the corner stays.
"""

from __future__ import annotations

from rpl import ir
from rpl.diagnostics import Severity, code
from rpl.ir.walk import bodies
from rpl.passes.legalise.context import Context, ProgramScope, rules_of
from rpl.passes.legalise.facts.effects import blocks, statements_in
from rpl.passes.legalise.paths.lookahead import touches
from rpl.passes.legalise.stages import legalising
from rpl.passes.scope import Scope

STANDS = code(
    "corner-stops-in-call",
    Severity.WARNING,
    "the robot stops at this corner: {name}, which is called behind it, waits for it in line {line}",
    "where the corner matters, do this in front of the move",
)
_QUIET = (ir.Nothing, ir.Trigger, ir.LookAhead)
_DRIVES = (ir.Move, ir.Spline, ir.MoveExternal)
_JUMPS = (ir.Label, ir.Goto, ir.Return, ir.ExitLoop)
_DEEPEST = 8  # calls in calls that are looked into


@legalising()
def corner_calls(program: ir.Program, context: Context) -> ir.Program:
    """Tells of such corners; the program stays as it is."""
    source, target = (rules_of(one).advance for one in (context.source, context.target))
    if target.signals_stop and not source.signals_stop:
        looker = _Looker(program, context, target.stop_statements)
        for module in program.modules:
            for routine in module.routines:
                for body in bodies(routine):
                    looker.look(module, routine, body)
    return program


class _Looker:
    def __init__(self, program: ir.Program, context: Context, stops: frozenset[str]) -> None:
        self.context, self.stops = context, stops
        self.scopes = ProgramScope(program)
        self.homes = {id(one): module for module in program.modules for one in module.routines}

    def look(self, module: ir.Module, routine: ir.Routine, body: ir.Body) -> None:
        for at, statement in enumerate(body):
            for inner in blocks(statement):
                self.look(module, routine, inner)
            if not isinstance(statement, ir.Move) or statement.blend in (None, ir.BlendStop()) or statement.concurrent:
                continue
            behind = next((one for one in body[at + 1 :] if not isinstance(one, _QUIET)), None)
            if isinstance(behind, ir.CallRoutine):
                found, _ = self.first((behind,), module, routine, 0)
                if found is not None:
                    name, line = behind.name, found.origin.line
                    self.context.diagnostics.report(STANDS, statement.origin, name=name, line=line)

    def first(
        self, body: ir.Body, module: ir.Module, routine: ir.Routine, depth: int
    ) -> tuple[ir.Statement | None, bool]:
        """The first statement that waits for the robot, and whether the search ends here (a move, a choice)."""
        scope = self.scopes.routine(module, routine)
        for statement in body:
            if isinstance(statement, _DRIVES):
                return None, True
            if self.waits(statement, scope):
                return statement, True
            inner = [one for block in blocks(statement) for one in statements_in(block)]
            if isinstance(statement, _JUMPS) or any(
                isinstance(one, (*_DRIVES, *_JUMPS, ir.CallRoutine)) for one in inner
            ):
                return None, True
            waits = next((one for one in inner if self.waits(one, scope)), None)
            if waits is not None:
                return waits, True
            if isinstance(statement, ir.CallRoutine):
                called = scope.routine(statement.name)
                home = self.homes.get(id(called)) if called is not None else None
                if called is None or home is None or depth == _DEEPEST:
                    return None, True
                found, ended = self.first(called.body, home, called, depth + 1)
                if ended:
                    return found, True
        return None, False

    def waits(self, statement: ir.Statement, scope: Scope) -> bool:
        return statement.__class__.__name__ in self.stops or touches(statement, scope)


__all__ = ["corner_calls"]

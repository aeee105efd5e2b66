"""Where the source has waited for the robot and the target's program would run on: a wait is put in.

A stop point holds the program of some controllers until the robot stands (RAPID, FANUC, RPL); others run ahead over all
moves (KRL) and stop only before certain statements. What interrupts, stop watches and other tasks do is seen while the
robot moves, so statements that arm or disarm them, look at what they have changed, or assign what they look at, must
not come early. Nor must what lasts, and the end, of a routine that an interrupt may leave.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

from rpl import ir
from rpl.ir.walk import bodies, walk
from rpl.passes.legalise.context import Context, ProgramScope, rules_of
from rpl.passes.legalise.facts.advance import is_flag, touches
from rpl.passes.legalise.facts.runbeside import FLAGS, RunBeside, assigned_name
from rpl.passes.legalise.facts.usage import base_name, each_expression, each_statement
from rpl.passes.legalise.interrupts.resumes import left_by_resumes
from rpl.passes.legalise.rewriting.editing import edit_bodies, exits
from rpl.passes.legalise.stages import legalising
from rpl.passes.rewrite import rewrite_parts
from rpl.passes.scope import Scope

_TIMED = frozenset(("timer", "timer_stopped", "timer_positive"))
_MOVES = (ir.Move, ir.MoveExternal, ir.Spline)
_LOOPS = (ir.For, ir.While, ir.Repeat, ir.Loop)


@legalising()
def stand_first(program: ir.Program, context: Context) -> ir.Program:
    """Only from controllers whose stop points hold the program, to one that runs ahead over all moves."""
    source, target = (rules_of(one).advance for one in (context.source, context.target))
    if source.runs_ahead_of != "fly_by" or target.runs_ahead_of != "all":
        return program
    facts = _Facts.of(program)
    scopes = ProgramScope(program)
    facts = _with_ends(program, facts, scopes, target.stop_statements)
    modules = []
    for module in program.modules:
        routines = []
        for routine in module.routines:
            if routine.name.lower() in facts.beside:
                routines.append(routine)  # the program waits, or drives nothing
                continue
            left = routine.name.lower() in facts.left
            worker = _Standing(facts, scopes.routine(module, routine), target.stop_statements, left)
            routines.append(worker.routine(routine))
        modules.append(replace(module, routines=tuple(routines)))
    return replace(program, modules=tuple(modules))


@dataclass(frozen=True, slots=True)
class _Facts:
    """Names in lower case. beside: routines that interrupts and background tasks run; changed: variables that these
    assign; movers: routines that drive; halting: those of them that end with a stop point; watchful: routines that
    contain a statement which must not come early; read: variables that the routines beside look at; left: routines that
    an interrupt may leave."""

    beside: frozenset[str]
    changed: frozenset[str]
    movers: frozenset[str]
    watchful: frozenset[str]
    halting: frozenset[str] = frozenset()
    read: frozenset[str] = frozenset()
    left: frozenset[str] = frozenset()

    @classmethod
    def of(cls, program: ir.Program) -> _Facts:
        routines = {r.name.lower(): r for module in program.modules for r in module.routines}
        around = RunBeside.of(program)
        calls, beside = around.calls, around.beside
        read = frozenset(name for one in beside for name in _looked_at(routines[one]))
        read |= {name for routine in routines.values() for name in _given(routine)}
        known = cls(beside, around.changed, frozenset(), frozenset(), read=read, left=left_by_resumes(program))
        movers = {n for n, r in routines.items() if any(isinstance(node, _MOVES) for node in walk(*bodies(r)))}
        watchful = {n for n, r in routines.items() if any(known.early(node) for node in _statements(r))}
        return replace(known, movers=_with_callers(movers, calls), watchful=_with_callers(watchful, calls))

    def early(self, statement: ir.Statement) -> bool:
        """Would it matter that the statement itself comes while the robot still moves?"""
        match statement:
            case ir.ControlInterrupt() | ir.OrderInterrupt() | ir.Clock() | ir.TaskControl():
                return True
            case ir.CallRoutine(name=name) if name.lower() in self.watchful:
                return True
            case ir.Assign(target=target) if (assigned_name(target) or "").lower() in self.read:
                return True
            case ir.For(counter=counter) if counter.lower() in self.read:
                return True
            case ir.Do(arguments=arguments) if any((_name(one) or "") in self.read for one in arguments):
                return True
        found = False

        def look(expression: ir.Expression) -> None:
            nonlocal found
            match expression:
                case _ if is_flag(expression):
                    found = found or FLAGS in self.changed
                case ir.Name(id=name):
                    found = found or name.lower() in self.changed
                case ir.System(name=name):
                    found = found or name in _TIMED
                case ir.Builtin(function="clock_seconds"):
                    found = True
                case ir.Call(name=name):
                    found = found or name.lower() in self.watchful

        each_expression(statement, look)
        return found


def _with_ends(program: ir.Program, facts: _Facts, scopes: ProgramScope, stops: frozenset[str]) -> _Facts:
    """The facts with the routines that end with a stop point, those by what they call included."""
    while True:
        halting = set()
        for module in program.modules:
            for routine in module.routines:
                left = routine.name.lower() in facts.left
                worker = _Standing(facts, scopes.routine(module, routine), stops, left)
                if routine.name.lower() in facts.movers and worker.ends_moving(routine):
                    halting.add(routine.name.lower())
        if halting <= facts.halting:
            return facts
        facts = replace(facts, halting=facts.halting | halting)


class _Standing:
    def __init__(self, facts: _Facts, scope: Scope, stops: frozenset[str], left: bool) -> None:
        self.facts, self.scope, self.stops, self.left = facts, scope, stops, left
        self.jumps: dict[str, bool] = {}  # label -> does a jump come there while the target still moves?

    def routine(self, routine: ir.Routine) -> ir.Routine:
        """With its other bodies: what comes to those may come from a move."""
        return edit_bodies(routine, lambda body: self.whole(body, body is not routine.body)[0])

    def ends_moving(self, routine: ir.Routine) -> bool:
        """May the target still move when the routine ends?"""
        ways_out = [routine.body, *(handler.body for handler in routine.handlers)]
        return any(self.whole(body, body is not routine.body)[1] for body in ways_out)

    def whole(self, body: ir.Body, moving: bool) -> tuple[ir.Body, bool]:
        """The body of a routine; again where a jump back turns out to come from a move."""
        if not body:
            return body, moving
        begins = moving
        while True:
            known = dict(self.jumps)
            done, moving = self.body(body, begins)
            if known == self.jumps:
                return ((*done, ir.WaitForMotion()), False) if moving and self.left else (done, moving)

    def lasts(self, statement: ir.Statement) -> bool:
        """Is it seen later that the statement was reached, in a routine that an interrupt may leave?"""
        match statement:
            case ir.Assign(target=target):
                symbol = self.scope.value(base_name(target) or "")
                if symbol is None or symbol.routine is None:
                    return not isinstance(target, ir.System)
                given = symbol.declaration
                return isinstance(given, ir.Parameter) and given.mode != "value"
            case ir.Return() | ir.CallRoutine() | ir.Do() | ir.Message() | ir.Raise():
                return True
        return False

    def behind(self, statement: ir.Statement, moving: bool) -> bool:
        """What holds behind a move of its own kind, a label and a jump."""
        match statement:
            case ir.Goto(label=label):
                self.jumps[label.lower()] = self.jumps.get(label.lower(), False) or moving
            case ir.Label(name=name):
                return moving or self.jumps.get(name.lower(), False)
        return False

    def body(self, body: ir.Body, moving: bool) -> tuple[ir.Body, bool]:
        """`moving`: the source stands here, the target perhaps not yet. Also whether that holds at the end."""
        done: list[ir.Statement] = []
        for statement in body:
            match statement:
                case ir.Move(blend=blend, concurrent=concurrent):
                    moving = blend in (None, ir.BlendStop()) and not concurrent
                    done.append(statement)
                    continue
                case ir.MoveExternal() | ir.Spline() | ir.Label() | ir.Goto():
                    moving = self.behind(statement, moving)
                    done.append(statement)
                    continue
            if statement.__class__.__name__ in self.stops or touches(statement, self.scope):
                moving = False
            elif moving and (self.facts.early(statement) or (self.left and self.lasts(statement))):
                done.append(ir.WaitForMotion(origin=statement.origin))
                statement = replace(statement, origin=replace(statement.origin, comments=()))
                moving = False
            inside = moving
            ends: list[bool] = []

            again = isinstance(statement, _LOOPS)
            counted = isinstance(statement, ir.For) and statement.counter.lower() in self.facts.read

            def deeper(
                inner: ir.Body,
                inside: bool = inside,
                ends: list[bool] = ends,
                again: bool = again,
                counted: bool = counted,
            ) -> ir.Body:
                new, end = self.body(inner, inside)
                if end and counted:
                    new, end = (*new, ir.WaitForMotion()), False
                elif end and again and not inside:  # each further pass begins as the one before it ends
                    new, end = self.body(inner, True)
                ends.append(end or (again and exits(inner) and self.drives(inner)))
                return new

            done.append(rewrite_parts(statement, lambda expression: expression, deeper))
            moving = any(ends) or (moving and not _surely_inside(statement))
            if isinstance(statement, ir.CallRoutine) and statement.name.lower() in self.facts.movers:
                moving = statement.name.lower() in self.facts.halting
        return tuple(done), moving

    def drives(self, body: ir.Body) -> bool:
        """Does a move of the body end at a stop point?"""
        for node in walk(*body):
            match node:
                case ir.Move(blend=None | ir.BlendStop(), concurrent=False):
                    return True
                case ir.CallRoutine(name=name) if name.lower() in self.facts.halting:
                    return True
        return False


def _surely_inside(statement: ir.Statement) -> bool:
    """Does one of the statement's bodies run in any case?"""
    match statement:
        case ir.If(otherwise=otherwise):
            return bool(otherwise)
        case ir.Switch(default=default):
            return default is not None
        case ir.Repeat() | ir.Loop():
            return True
        case ir.For(start=ir.IntLiteral(value=start), stop=ir.IntLiteral(value=stop), step=None):
            return start <= stop
    return False


def _looked_at(routine: ir.Routine) -> set[str]:
    """Variables of others that its expressions name."""
    own = {d.name.lower() for d in routine.declarations if isinstance(d, ir.Variable)}
    own |= {parameter.name.lower() for parameter in routine.parameters}
    names: set[str] = set()

    def look(expression: ir.Expression) -> None:
        if is_flag(expression):
            names.add(FLAGS)
        if isinstance(expression, ir.Name):
            names.add(expression.id.lower())

    for statement in _statements(routine):
        each_expression(statement, look)
    return names - own


def _given(routine: ir.Routine) -> set[str]:
    """Variables that an interrupt or a place on the path looks at when it acts."""
    return {
        name.id.lower()
        for node in walk(*bodies(routine))
        if isinstance(node, ir.DeclareInterrupt | ir.Trigger)
        for given in _values(node.action)
        for name in walk(given)
        if isinstance(name, ir.Name)
    }


def _values(action: ir.Statement) -> tuple[ir.Expression, ...]:
    match action:
        case ir.Assign(value=value):
            return (value,)
        case ir.CallRoutine(arguments=arguments):
            return tuple(one.value for one in arguments if one.value is not None)
    return ()


def _name(place: ir.Expression | None) -> str | None:
    found = None if place is None else assigned_name(place)
    return None if found is None else found.lower()


def _statements(routine: ir.Routine) -> list[ir.Statement]:
    found: list[ir.Statement] = []
    for body in bodies(routine):
        each_statement(body, found.append)
    return found


def _with_callers(names: set[str], calls: dict[str, set[str]]) -> frozenset[str]:
    done = set(names)
    while True:
        more = {name for name, callees in calls.items() if callees & done} - done
        if not more:
            return frozenset(done)
        done |= more

"""Where the source has waited for the robot and the target's program would run on: a wait is put in.

A stop point holds the program of some controllers until the robot stands (RAPID, FANUC, RPL); others run ahead over all
moves (KRL) and stop only before certain statements. What interrupts, stop watches and other tasks do is seen while the
robot moves, so statements that arm or disarm them, look at what they have changed, or assign what they look at, must
not come early. Nor must what lasts, and the end, of a routine that an interrupt may leave.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace

from rpl import ir
from rpl.ir.walk import bodies, walk
from rpl.passes.legalise.context import Context, rules_of
from rpl.passes.legalise.facts.forward import Forward, beside
from rpl.passes.legalise.facts.motion.advance import is_flag, touches
from rpl.passes.legalise.facts.runbeside import FLAGS, RunBeside, assigned_name
from rpl.passes.legalise.facts.usage import base_name, each_expression, each_statement
from rpl.passes.legalise.interrupts.resumes import left_by_resumes
from rpl.passes.legalise.rewriting.editing import edit_bodies, edit_each, map_body
from rpl.passes.legalise.rewriting.jumps import inside
from rpl.passes.legalise.stages import legalising
from rpl.passes.scope import Scope

_TIMED = frozenset(("timer", "timer_stopped", "timer_positive"))
_MOVES = (ir.Move, ir.MoveExternal, ir.Spline)


@legalising()
def stand_first(program: ir.Program, context: Context) -> ir.Program:
    """Only from controllers whose stop points hold the program, to one that runs ahead over all moves."""
    source, target = (rules_of(one).advance for one in (context.source, context.target))
    if source.runs_ahead_of != "fly_by" or target.runs_ahead_of != "all":
        return program
    facts = _Facts.of(program)
    ways = _Ways(program, facts, target.stop_statements)

    def body(old: ir.Body) -> ir.Body:
        done = map_body(old, change)
        return (*done, ir.WaitForMotion()) if id(old) in ways.ended else done

    def change(statement: ir.Statement) -> ir.Body:
        done = inside(statement, body)
        if id(statement) not in ways.waits:
            return (done,)
        bare = replace(done, origin=replace(statement.origin, comments=()))
        return (ir.WaitForMotion(origin=statement.origin), bare)

    def work(module: ir.Module, routine: ir.Routine) -> ir.Routine:
        # beside the program, what runs waits, or drives nothing
        return routine if routine.name.lower() in facts.beside else edit_bodies(routine, body)

    return edit_each(program, work)


@dataclass(frozen=True, slots=True)
class _Facts:
    """Names in lower case. beside: routines that interrupts and background tasks run; changed: variables that these
    assign; movers: routines that drive; watchful: routines that contain a statement which must not come early; read:
    variables that the routines beside look at; left: routines that an interrupt may leave."""

    beside: frozenset[str]
    changed: frozenset[str]
    movers: frozenset[str]
    watchful: frozenset[str]
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


class _Ways(Forward[bool]):
    """Does the source stand, and the target perhaps not yet? `waits`: statements that must not come then; `ended`:
    bodies behind which it must stand."""

    def __init__(self, program: ir.Program, facts: _Facts, stops: frozenset[str]) -> None:
        super().__init__(program, False, True)
        self.facts, self.stops = facts, stops
        self.waits: set[int] = set()
        self.ended: set[int] = set()
        self.closed = set(map(id, self.closed_bodies())) - {id(())}
        self.solve(self.by_name, beside(program))

    def closed_bodies(self) -> Iterator[ir.Body]:
        """Those of routines that an interrupt may leave, and of loops whose counter something beside looks at."""
        for one in self.summaries.values():
            if one.routine.name.lower() in self.facts.left:
                yield from bodies(one.routine)
            for node in walk(*bodies(one.routine)):
                if isinstance(node, ir.For) and node.counter.lower() in self.facts.read:
                    yield node.body

    def join(self, one: bool, other: bool) -> bool:
        return one or other

    def transfer(self, statement: ir.Statement, before: bool) -> bool:
        if isinstance(statement, ir.Move):
            return statement.blend in (None, ir.BlendStop()) and not statement.concurrent
        return before

    def entered(self, state: bool, here: Scope, there: Scope) -> bool:
        return False  # a call of a routine in which it matters waits itself

    def left(self, before: bool, end: bool, routine: ir.Routine, there: Scope, here: Scope) -> bool:
        return end if routine.name.lower() in self.facts.movers else before

    def may_leave(self, call: ir.CallRoutine | ir.Call) -> bool:
        return False  # an interrupt brakes the robot before it leaves the routine

    def handled(self, state: bool) -> tuple[bool, bool | None, bool | None]:
        return super().handled(True)  # an error may come from a move

    def body(self, body: ir.Body, state: bool | None) -> bool | None:
        end = super().body(body, state)
        if end and id(body) in self.closed:
            self.ended.add(id(body))
            return False
        return end

    def inner(self, statement: ir.Statement, state: bool | None) -> bool | None:
        if state is not None:
            if isinstance(statement, ir.MoveExternal | ir.Spline):
                return False
            if statement.__class__.__name__ in self.stops or touches(statement, self.scope):
                state = False
            elif state and not isinstance(statement, ir.Move | ir.Label | ir.Goto) and self.must_wait(statement):
                self.waits.add(id(statement))
                state = False
        return super().inner(statement, state)

    def must_wait(self, statement: ir.Statement) -> bool:
        here = self.run.of.routine.name.lower()
        if here in self.facts.beside:
            return False
        return self.facts.early(statement) or (here in self.facts.left and self.lasts(statement))

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

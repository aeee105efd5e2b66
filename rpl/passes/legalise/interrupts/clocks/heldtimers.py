"""Timers that are stopped, for languages whose timers always run (V+): a variable keeps what a stopped timer shows.

Where the course of the program tells whether a timer runs, the timer or the variable is read; elsewhere the value is
put together from both and a number that is 1 while the timer runs. It stands in front of the passes that make timers
of their own; stop watches that become timers are treated as soon as they are (passes.legalise.waits).
"""

from __future__ import annotations

from dataclasses import dataclass, field, replace

from rpl import ir
from rpl.ir.walk import bodies, walk
from rpl.passes.legalise.context import Context
from rpl.passes.legalise.facts.usage import base_name, called_below, doing
from rpl.passes.legalise.kinds import walk_for
from rpl.passes.legalise.rewriting.editing import edit_all, edit_bodies
from rpl.passes.legalise.stages import legalising
from rpl.passes.rewrite import rewrite_bodies, rewrite_parts, visit_bodies
from rpl.passes.values import real

_LOOPS = (ir.While, ir.For, ir.Loop, ir.Repeat)
Known = dict[int, bool]  # number of a timer -> whether it runs


@legalising(
    unless=lambda context: (
        not context.capabilities.io.timers or "timer_stopped" in context.capabilities.system_variables
    )
)
def held_timers(program: ir.Program, context: Context) -> ir.Program:
    """Only for targets with numbered timers that cannot be stopped. Timers of computed numbers stay for the writer."""
    return of_held_timers(program, context)


def of_held_timers(program: ir.Program, context: Context, only: frozenset[int] | None = None) -> ir.Program:
    """As `held_timers`, of these timers only where others have been treated."""
    stopped = {number for node in walk_for({"Assign"}, program) if (number := _stopping(node)) is not None}
    never = _never_started(program)
    stopped |= never | _set_ahead(program)
    if only is not None:
        stopped &= only
    if not stopped:
        return program
    worker = _Held(context, stopped, doing(program, lambda node: _sets(node) is not None))
    worker.apart = _apart(program)
    worker.never = never
    modules = list(edit_all(program, lambda body: worker.body(body, {})).modules)
    unread = {runs.id for _, runs in worker.kept.values()} - worker.asked
    modules = [replace(one, routines=tuple(_without(routine, unread) for routine in one.routines)) for one in modules]
    first = modules[0]
    data = tuple(
        ir.Variable(name.id, ir.RealType(), real(0.0), scope="global")
        for number in sorted(worker.kept)
        for name in worker.kept[number]
        if name.id not in unread
    )
    home = ir.Module(context.fresh("rpl_timers"), first.dialect, data, task=first.task, public=True)
    return replace(program, modules=(*modules, home))


def _sets(node: object) -> int | None:
    """The timer that a statement sets, starts or stops."""
    match node:
        case ir.Assign(target=ir.System(name="timer" | "timer_stopped", indices=(ir.IntLiteral(value=number),))):
            return number
    return None


def _start(number: int) -> ir.Assign:
    return ir.Assign(ir.System("timer_stopped", (ir.IntLiteral(number),)), ir.BoolLiteral(False))


def _stopping(node: object) -> int | None:
    """The timer that a statement stops, or may stop."""
    match node:
        case ir.Assign(target=ir.System(name="timer_stopped"), value=value) if value != ir.BoolLiteral(False):
            return _sets(node)
    return None


def _never_started(program: ir.Program) -> set[int]:
    """Timers that nothing starts: they show what they are set to. Timers of computed numbers may be any."""
    used: set[int] = set()
    started: set[int] = set()
    for node in walk_for({"Assign", "System"}, program):
        match node:
            case ir.Assign(target=ir.System(name="timer_stopped", indices=indices), value=value):
                if not indices or not isinstance(indices[0], ir.IntLiteral):
                    return set()
                started |= {indices[0].value} if value != ir.BoolLiteral(True) else set()
            case ir.System(name="timer" | "timer_positive", indices=(ir.IntLiteral(value=number),)):
                used.add(number)
    return used - started


def _set_ahead(program: ir.Program) -> set[int]:
    """Timers that are set some steps before they are started: they stand in between."""
    found: set[int] = set()

    def look(body: ir.Body) -> ir.Body:
        for at, statement in enumerate(body):
            visit_bodies(statement, look)
            number = _sets(statement)
            if number is not None and isinstance(statement, ir.Assign) and _start(number) != statement:
                behind = body[at + 1 :]
                if _start(number) in behind[1:] and behind[0] != _start(number):
                    found.add(number)
        return body

    for module in program.modules:
        for routine in module.routines:
            for body in bodies(routine):
                look(body)
    return found


def _without_needless_stops(body: ir.Body) -> ir.Body:
    """What stops a timer that is set to a time and started at once does nothing."""
    done: list[ir.Statement] = []
    for at, statement in enumerate(body):
        number, behind = _sets(statement), body[at + 1 : at + 3]
        if (
            number is not None
            and statement == ir.Assign(ir.System("timer_stopped", (ir.IntLiteral(number),)), ir.BoolLiteral(True))
            and behind[1:] == (_start(number),)
            and _sets(behind[0]) == number
            and _stopping(behind[0]) is None
        ):
            done.append(ir.Nothing(origin=statement.origin))
        else:
            done.append(statement)
    return tuple(done)


def _without(routine: ir.Routine, unread: set[str]) -> ir.Routine:
    """The routine without assignments of these variables."""

    def body(statements: ir.Body) -> ir.Body:
        kept = [one for one in statements if not (isinstance(one, ir.Assign) and base_name(one.target) in unread)]
        return tuple(rewrite_bodies(one, body) for one in kept)

    return edit_bodies(routine, body)


def _apart(program: ir.Program) -> set[int]:
    """Timers that tasks, interrupts or actions on the path set: whether they run may change at any place."""
    roots = {task.entry.lower() for task in program.tasks if task.kind != "motion"}
    for node in walk_for({"DeclareInterrupt", "Trigger", "ConnectInterrupt", "TaskControl"}, *program.modules):
        match node:
            case (
                ir.DeclareInterrupt(action=ir.CallRoutine(name=name))
                | ir.Trigger(action=ir.CallRoutine(name=name))
                | ir.ConnectInterrupt(routine=name)
                | ir.TaskControl(task=name)
            ):
                roots.add(name.lower())
    below = called_below(program, roots)
    bodies = [one.body for module in program.modules for one in module.routines if one.name.lower() in below]
    return {number for body in bodies for node in walk(body) if (number := _sets(node)) is not None}


@dataclass(slots=True)
class _Held:
    """`setting`: routines that set timers, with those that call them. `kept`: the value and the running of a timer."""

    context: Context
    stopped: set[int]
    setting: frozenset[str]
    apart: set[int] = field(default_factory=set)
    never: set[int] = field(default_factory=set)  # timers that nothing starts
    kept: dict[int, tuple[ir.Name, ir.Name]] = field(default_factory=dict)
    asked: set[str] = field(default_factory=set)  # what says that a timer runs, where something looks at it

    def names(self, number: int) -> tuple[ir.Name, ir.Name]:
        if number not in self.kept:
            stems = (f"rpl_timer_{number}_held", f"rpl_timer_{number}_runs")
            self.kept[number] = (ir.Name(self.context.fresh(stems[0])), ir.Name(self.context.fresh(stems[1])))
        return self.kept[number]

    def state(self, number: int, known: Known) -> bool | None:
        """Whether the timer runs, where that is known."""
        return False if number in self.never else known.get(number)

    def body(self, body: ir.Body, known: Known) -> ir.Body:
        """The body; `known` becomes what is known behind it."""
        done: list[ir.Statement] = []
        body = _without_needless_stops(body)
        for at, statement in enumerate(body):
            number = _sets(statement)
            if number in self.stopped and isinstance(statement, ir.Assign):
                begins = at + 1 < len(body) and body[at + 1] == _start(number)
                done.extend(self.setting_of(statement, number, known, begins))
                continue
            changed = self.changed(statement)
            here = {k: v for k, v in known.items() if k not in changed} if isinstance(statement, _LOOPS) else known
            inside = _Inside(self, dict(here))
            done.append(rewrite_parts(statement, inside.read, inside.body))
            for one in changed:
                known.pop(one, None)
        return tuple(done)

    def changed(self, statement: ir.Statement) -> set[int]:
        """Timers of which it is not known behind a statement whether they run."""
        found = set(self.apart)
        for node in walk(statement):
            match node:
                case ir.Label():
                    return set(self.stopped)
                case ir.CallRoutine(name=name, dynamic=dynamic) if dynamic is not None or name.lower() in self.setting:
                    return set(self.stopped)
                case ir.Call(name=name) if name.lower() in self.setting:
                    return set(self.stopped)
            number = _sets(node)
            found |= set() if number is None else {number}
        return found

    def setting_of(self, statement: ir.Assign, number: int, known: Known, begins: bool) -> list[ir.Statement]:
        """`begins`: the next statement starts the timer."""
        held, runs = self.names(number)
        timer = ir.System("timer", (ir.IntLiteral(number),))
        value, later = self.read(statement.value, known), replace(statement.origin, comments=())
        assert isinstance(statement.target, ir.System)  # as the caller has found
        if statement.target.name == "timer":
            if begins and number not in self.apart and known.get(number) is None:
                known[number] = True
                return [replace(statement, value=value), ir.Assign(runs, real(1.0), origin=later)]
            if known.get(number) is True:
                return [replace(statement, value=value)]
            kept = ir.Assign(held, value, origin=statement.origin)
            return [kept] if self.state(number, known) is False else [kept, ir.Assign(timer, held, origin=later)]
        state = self.state(number, known)
        runs_now = runs if state is not None and isinstance(value, ir.BoolLiteral) else self.running(number)
        stop: ir.Body = (ir.Assign(held, timer, origin=later), ir.Assign(runs, real(0.0), origin=later))
        start: ir.Body = (ir.Assign(timer, held, origin=later), ir.Assign(runs, real(1.0), origin=later))
        if not isinstance(value, ir.BoolLiteral):
            known.pop(number, None)
            stopping = ir.If(((runs_now, stop),), origin=later)
            starting = ir.If(((ir.Unary("not", runs_now), start),), origin=later)
            return [ir.If(((value, (stopping,)),), (starting,), origin=statement.origin)]
        if number not in self.apart:
            known[number] = not value.value
        if state is not None:
            steps = () if state is not value.value else stop if value.value else start
            return [ir.Nothing(origin=statement.origin), *steps]
        asked, then = (runs_now, stop) if value.value else (ir.Unary("not", runs_now), start)
        return [ir.If(((asked, then),), origin=statement.origin)]

    def running(self, number: int) -> ir.Expression:
        """Whether the timer runs."""
        runs = self.names(number)[1]
        self.asked.add(runs.id)
        return ir.Binary(">", runs, real(0.5))

    def read(self, value: ir.Expression, known: Known) -> ir.Expression:
        match value:
            case ir.System(name="timer_positive", indices=(ir.IntLiteral(value=number),)) if number in self.stopped:
                return ir.Binary(">", self.read(replace(value, name="timer"), known), ir.IntLiteral(0))
            case ir.System(name="timer" | "timer_stopped" as name, indices=(ir.IntLiteral(value=number),)) if (
                number in self.stopped
            ):
                held, runs = self.names(number)
                state = self.state(number, known)
                if name == "timer_stopped":
                    return ir.Unary("not", self.running(number)) if state is None else ir.BoolLiteral(not state)
                if state is not None:
                    return value if state else held
                self.asked.add(runs.id)
                return ir.Binary("+", held, ir.Binary("*", runs, ir.Binary("-", value, held)))
        return rewrite_parts(value, lambda part: self.read(part, known))


@dataclass(frozen=True, slots=True)
class _Inside:
    """Rewrites the parts of a statement; each body in it begins with what is known in front."""

    worker: _Held
    known: Known

    def read(self, value: ir.Expression) -> ir.Expression:
        return self.worker.read(value, self.known)

    def body(self, body: ir.Body) -> ir.Body:
        return self.worker.body(body, dict(self.known))


__all__ = ["held_timers"]

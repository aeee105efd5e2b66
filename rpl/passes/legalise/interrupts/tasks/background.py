"""Routines that a program starts as tasks of their own, for targets whose controllers run background programs from the
start and have no statement to begin one (RAPID tasks, the KRL submit interpreter).

Each such routine gets a background program that waits for a flag, calls the routine, and takes the flag back. To start
the task is to set its flag, to wait for its end is to wait until the flag is off. A task that is ended from outside
looks at a second flag wherever it waits, and leaves. A task that runs from the start needs no flag, only a program of
its own. Such programs do not move the robot; what does not fit is named.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace

from rpl import ir
from rpl.diagnostics import Severity, code
from rpl.ir.walk import walk
from rpl.passes.capabilities import Background
from rpl.passes.legalise.context import Context, ProgramScope
from rpl.passes.legalise.kinds import walk_for
from rpl.passes.legalise.rewriting.editing import edit_bodies, map_body
from rpl.passes.legalise.rewriting.formulas import plain
from rpl.passes.legalise.rewriting.jumps import inside
from rpl.passes.legalise.stages import legalising
from rpl.passes.scope import Scope
from rpl.source import NOWHERE, Origin

LOST = code(
    "background-task-lost",
    Severity.LOSS,
    "{name} cannot run as a background program: {reason}",
    "give this work to the program that starts it, or write the background program by hand",
)
MADE = code(
    "background-task",
    Severity.WARNING,
    "task {name} is written as the background program {made}, which waits for {flag}",
    "install it as a background task of the controller (the option may be needed)",
)

_MOTION = (ir.Move, ir.MoveExternal, ir.Spline, ir.WaitForMotion, ir.StopMotion, ir.StartMotion, ir.ClearMotion)
_OTHER = (ir.DeclareInterrupt, ir.ConnectInterrupt, ir.OnError, ir.Critical, ir.TaskControl)
_SIMPLE = (ir.IntType, ir.RealType, ir.BoolType, ir.StringType, ir.PoseType, ir.TargetType, ir.JointsType)
_NOT_SHARED = (ir.ClockType, ir.InterruptType, ir.TriggerType)
_PLACES = frozenset(("tool", "base", "null_frame", "actual_pose", "actual_joints"))
_WAITS = (ir.Wait, ir.WaitUntil, ir.Pulse)
_FALSE, _TRUE = ir.BoolLiteral(False), ir.BoolLiteral(True)
_SHORT_WAIT = 0.1  # s: no task has to end sooner


@dataclass(frozen=True, slots=True)
class _Plan:
    """A task that can be made: its routine and all that it calls; the flags; variables that carry its arguments.
    Without `runs` it is a task of the program that runs from the start, again and again when it is `cyclic`."""

    name: str
    home: ir.Module
    routine: ir.Routine
    called: tuple[tuple[ir.Module, ir.Routine], ...]
    runs: ir.Variable | None
    stops: ir.Variable | None
    arguments: tuple[ir.Variable, ...]
    cyclic: bool = False

    @property
    def data(self) -> tuple[ir.Variable, ...]:
        return (*(one for one in (self.runs, self.stops) if one is not None), *self.arguments)


class _UnfitError(Exception):
    """Why a routine cannot be a background program."""


@legalising(
    unless=lambda context: (
        context.capabilities.tasks.background is Background.NO or "TaskControl" in context.capabilities.statements
    )
)
def background_tasks(program: ir.Program, context: Context) -> ir.Program:
    """Only for targets with background programs and no statement that starts a task."""
    if any(module.task for module in program.modules) or any(task.kind != "background" for task in program.tasks):
        return program
    controls = [node for node in walk_for({"TaskControl"}, *program.modules) if isinstance(node, ir.TaskControl)]
    return _Maker(program, context, controls).done() if controls or program.tasks else program


class _Maker:
    def __init__(self, program: ir.Program, context: Context, controls: list[ir.TaskControl]) -> None:
        self.program, self.context = program, context
        self.separate = context.capabilities.tasks.background is Background.SEPARATE
        known = {"tool_of_moves", "frame_of_moves", "actual_pose"} <= context.capabilities.system_variables
        self.seen_beside = known and not self.separate
        self.scopes = ProgramScope(program)
        self.operations: dict[str, list[ir.TaskControl]] = {}
        for one in controls:
            self.operations.setdefault(one.task.lower(), []).append(one)
        self.plans: dict[str, _Plan] = {}
        for name, asked in self.operations.items():
            try:
                self.plans[name] = self.plan(asked)
            except _UnfitError as reason:
                context.diagnostics.report(LOST, asked[0].origin, name=asked[0].task, reason=str(reason))

        for task in program.tasks:
            if self.separate or not task.modules:  # a module of its own is a background program already
                try:
                    self.plans[task.entry.lower()] = self.fixed(task)
                except _UnfitError as reason:
                    context.diagnostics.report(LOST, self.origin_of(task.entry), name=task.name, reason=str(reason))

    # ---- what can be made

    def origin_of(self, routine: str) -> Origin:
        found = (r.origin for m in self.program.modules for r in m.routines if r.name.lower() == routine.lower())
        return next(found, NOWHERE)

    def fixed(self, task: ir.Task) -> _Plan:
        """A task that runs from the start."""
        if any(one in self.operations for one in (task.entry.lower(), task.name.lower())):
            raise _UnfitError("the program controls it, although it runs from the start")
        home, routine, called = self.routines_of(task.entry)
        return _Plan(task.name, home, routine, called, None, None, (), task.cyclic)

    def routines_of(self, name: str) -> tuple[ir.Module, ir.Routine, tuple[tuple[ir.Module, ir.Routine], ...]]:
        """The routine of a task with its module, and all that it calls."""
        found = next(((m, r) for m in self.program.modules for r in m.routines if r.name.lower() == name.lower()), None)
        if found is None:
            raise _UnfitError("the program has no such routine")
        home, routine = found
        called = tuple(self.closure(home, routine, {id(routine)}))
        for module, one in ((home, routine), *called):
            self.check(module, one)
        for variable in self.needed((home, routine), *called).values() if self.separate else ():
            if isinstance(variable, ir.Variable) and variable.storage != "constant":
                _shared(variable)
        return home, routine, called

    def plan(self, asked: list[ir.TaskControl]) -> _Plan:
        name = asked[0].task
        operations = {one.op for one in asked}
        if operations & {"pause", "resume"}:
            raise _UnfitError("it is halted and goes on in the middle")
        home, routine, called = self.routines_of(name)
        if routine.kind == "function":
            raise _UnfitError("it is a function")
        if "stop" in operations and any(waits(one) for _, one in called):
            raise _UnfitError("it is ended from outside and waits in a routine that it calls")
        if "stop" in operations and self.is_called(routine):
            raise _UnfitError("it is ended from outside, and called as a routine too")
        fresh = self.context.fresh
        stops = _flag(fresh(f"{name}_stop")) if "stop" in operations else None
        return _Plan(name, home, routine, called, _flag(fresh(f"{name}_runs")), stops, self.carried(routine))

    def carried(self, routine: ir.Routine) -> tuple[ir.Variable, ...]:
        found = []
        for one in routine.parameters:
            if one.mode != "value" or one.optional or not isinstance(one.type, _SIMPLE):
                raise _UnfitError(f"its parameter {one.name} is not a number, text, BOOL or place given by value")
            name = self.context.fresh(f"{routine.name}_{one.name}")
            found.append(ir.Variable(name, one.type, storage="persistent", scope="global"))
        return tuple(found)

    def closure(self, module: ir.Module, routine: ir.Routine, seen: set[int]) -> Iterator[tuple[ir.Module, ir.Routine]]:
        """The program's routines that this one calls, and those that they call."""
        scope = self.scopes.routine(module, routine)
        for node in walk(routine):
            if isinstance(node, ir.CallRoutine) and node.dynamic is not None:
                raise _UnfitError("it calls a routine by a name that is computed")
            callee = scope.routine(node.name) if isinstance(node, ir.CallRoutine | ir.Call) else None
            homes = ((m, r) for m in self.program.modules for r in m.routines if r is callee)
            for home, one in homes:
                if id(one) not in seen:
                    seen.add(id(one))
                    yield home, one
                    yield from self.closure(home, one, seen)

    def check(self, module: ir.Module, routine: ir.Routine) -> None:
        for node in walk(routine):
            match node:
                case ir.System(name="null_frame" | "world") if self.seen_beside:
                    continue  # of a place that is seen
                case ir.System(name="flag"):
                    continue  # flags belong to the whole controller
                case ir.System(name=name) if self.separate and name in _PLACES:
                    continue
                case ir.System(name=name) if self.separate or not name.startswith(("timer", "actual_")):
                    raise _UnfitError(f"it uses {name.replace('_', ' ')}, which belongs to the task that moves")
            if isinstance(node, _MOTION):
                raise _UnfitError("it moves the robot or waits for it")
            if isinstance(node, _OTHER):
                raise _UnfitError("it has interrupts, error routines or tasks of its own")

    def is_called(self, routine: ir.Routine) -> bool:
        return any(
            isinstance(node, ir.CallRoutine | ir.Call) and node.name.lower() == routine.name.lower()
            for node in walk_for({"CallRoutine", "Call"}, *self.program.modules)
        )

    # ---- the program with the tasks

    def done(self) -> ir.Program:
        if not self.plans:
            return self.program
        made: list[ir.Module] = []
        tasks: list[ir.Task] = []
        shared: dict[int, ir.Variable] = {}
        for number, plan in enumerate(self.plans.values(), 2):
            module, entry = self.task_module(plan, f"TASK{number}" if self.separate else "", shared)
            made.append(module)
            task = module.task or module.name.lower()
            tasks.append(ir.Task(task, entry, "background", cyclic=self.separate, modules=(module.name,)))
            if plan.runs is not None:
                where = self.operations[plan.name.lower()][0].origin
                self.context.diagnostics.report(MADE, where, name=plan.name, made=module.name, flag=plan.runs.name)
        planned = {plan.routine.name.lower() for plan in self.plans.values() if plan.runs is None}
        kept = [task for task in self.program.tasks if task.entry.lower() not in planned]
        changed = (self.changed(module, shared) for module in self.program.modules)
        modules = tuple(one for one in changed if one.routines or one.declarations)
        return replace(self.program, modules=(*modules, *made), tasks=(*kept, *tasks))

    def task_module(self, plan: _Plan, task: str, shared: dict[int, ir.Variable]) -> tuple[ir.Module, str]:
        """The module of a background program, and its first routine."""
        name = self.context.fresh(f"{plan.name}_task")
        arguments = tuple(ir.Argument(ir.Name(one.name)) for one in plan.arguments)
        call = ir.CallRoutine(plan.routine.name, arguments)
        cyclic = plan.cyclic or plan.runs is not None
        served: ir.Body = (call,)
        if plan.runs is not None:
            runs = ir.Name(plan.runs.name)
            served = (ir.WaitUntil(runs), call, ir.Assign(runs, _FALSE))
        elif self.separate and not cyclic:  # such a task begins anew at its end
            served = (call, ir.Loop((ir.Wait(ir.Quantity(ir.RealLiteral(1.0), "s")),)))
        dialect = plan.home.dialect
        if not self.separate:
            entry = ir.Routine(name, body=(ir.Loop(served),) if cyclic else served, scope="global")
            return ir.Module(name, dialect, plan.data, (entry,), public=True), name
        entry = ir.Routine("main", body=served, scope="global")
        routines = ((plan.home, self.stoppable(plan)), *plan.called)
        needed = self.needed((plan.home, plan.routine), *plan.called)
        for variable in needed.values():
            if isinstance(variable, ir.Variable) and variable.storage != "constant":
                shared[id(variable)] = _shared(variable)
        copies = tuple(shared.get(id(one), one) for one in needed.values())
        bodies = tuple(replace(one, scope="global") for _, one in routines)
        return ir.Module(name, dialect, (*plan.data, *copies), (entry, *bodies), task=task), "main"

    def needed(self, *routines: tuple[ir.Module, ir.Routine]) -> dict[int, ir.Declaration]:
        """Global declarations that these routines use, each before those that need it."""
        found: dict[int, ir.Declaration] = {}
        names = {name: one for module in self.program.modules for name, one in _types(module)}

        def enter(declaration: ir.Declaration, module: ir.Module) -> None:
            if id(declaration) in found:
                return
            look(declaration, self.scopes.module(module))
            found[id(declaration)] = declaration

        def look(root: object, scope: Scope) -> None:
            for node in walk(root):
                if isinstance(node, ir.NamedType) and (known := names.get(node.name.lower())) is not None:
                    enter(known[1], known[0])
                named = node.counter if isinstance(node, ir.For) and not node.scoped else None
                named = node.id if isinstance(node, ir.Name) else named
                symbol = None if named is None else scope.value(named)
                if symbol is None or symbol.module is None or symbol.routine is not None:
                    continue
                if not isinstance(symbol.declaration, ir.Parameter):
                    enter(symbol.declaration, symbol.module)

        for module, routine in routines:
            look(routine, self.scopes.routine(module, routine))
        return found

    def changed(self, module: ir.Module, shared: dict[int, ir.Variable]) -> ir.Module:
        """A module of the program: its statements that control tasks, what the tasks share, what they call."""
        plans = {id(plan.routine): plan for plan in self.plans.values()}

        def statement(one: ir.Statement) -> ir.Body:
            match one:
                case ir.TaskControl(task=name) if name.lower() in self.plans:
                    return self.control(one, self.plans[name.lower()])
            return (inside(one, lambda body: map_body(body, statement)),)

        routines = []
        for routine in module.routines:
            plan = plans.get(id(routine))
            if plan is not None and self.separate and not self.is_called(routine):
                continue
            if plan is not None and not self.separate:
                routine = replace(self.stoppable(plan), scope="global")
            routines.append(edit_bodies(routine, lambda body: map_body(body, statement)))
        declarations = [shared.get(id(one), one) for one in module.declarations]
        if self.separate:
            for plan in self.plans.values():
                declarations.extend(plan.data if plan.home is module else ())
        return replace(module, declarations=tuple(declarations), routines=tuple(routines))

    def control(self, statement: ir.TaskControl, plan: _Plan) -> ir.Body:
        assert plan.runs is not None  # a task that runs from the start is not controlled
        runs = ir.Name(plan.runs.name)
        ended = ir.WaitUntil(ir.Unary("not", runs))
        if statement.op == "join":
            return (replace(ended, origin=statement.origin),)
        if statement.op == "stop" and plan.stops is not None:
            ask = ir.Assign(ir.Name(plan.stops.name), _TRUE)
            return (ir.If(((runs, (ask, ended)),), origin=statement.origin),)
        given = [
            ir.Assign(ir.Name(variable.name), argument.value)
            for variable, argument in zip(plan.arguments, statement.arguments, strict=False)
            if argument.value is not None
        ]
        if plan.stops is not None:
            given.append(ir.Assign(ir.Name(plan.stops.name), _FALSE))
        if not given:  # beginning a task that runs changes nothing
            return (ir.Assign(runs, _TRUE, origin=statement.origin),)
        return (ir.If(((ir.Unary("not", runs), (*given, ir.Assign(runs, _TRUE))),), origin=statement.origin),)

    # ---- tasks that are ended from outside

    def stoppable(self, plan: _Plan) -> ir.Routine:
        """The routine; it leaves at its next wait when the second flag is set."""
        if plan.stops is None:
            return plan.routine
        return leaving_at(plan.routine, ir.Name(plan.stops.name), self.context, (ir.Return(),))


def leaving_at(routine: ir.Routine, stop: ir.Name, context: Context, leaving: ir.Body) -> ir.Routine:
    """The routine of a task that does `leaving` at its next wait when the flag `stop` is set. Behind a short wait it
    looks at the flag, as a wait that ends by a clock would last for whole cycles of the controller."""
    leave = ir.If(((stop, leaving),))
    late = ir.Variable(context.fresh("late"), ir.BoolType(), scope="routine")

    def statement(one: ir.Statement) -> ir.Body:
        match one:
            case ir.Wait(time=time) if _is_short(time):
                return (one, leave)
            case ir.Wait(time=time, origin=origin):
                waiting = ir.WaitUntil(stop, timeout=time, timed_out=ir.Name(late.name), origin=origin)
                return (waiting, leave)
            case ir.WaitUntil(condition=condition):
                return (replace(one, condition=ir.Binary("or", condition, stop)), leave)
            case ir.Loop() | ir.While() | ir.Repeat() | ir.For() if not waits(one):
                return (inside(one, lambda body: (leave, *body)),)
        return (inside(one, lambda body: map_body(body, statement)),)

    done = edit_bodies(routine, lambda body: map_body(body, statement))
    if not any(isinstance(node, ir.Name) and node.id == late.name for node in walk(*done.body)):
        return done
    return replace(done, declarations=(*done.declarations, late))


def _is_short(time: ir.Expression) -> bool:
    value = plain(time)
    return isinstance(value, ir.RealLiteral | ir.IntLiteral) and value.value <= _SHORT_WAIT


def waits(part: ir.Statement | ir.Routine) -> bool:
    return any(isinstance(node, _WAITS) for node in walk(part))


def _flag(name: str) -> ir.Variable:
    return ir.Variable(name, ir.BoolType(), _FALSE, storage="persistent", scope="global")


def _shared(variable: ir.Variable) -> ir.Variable:
    element = variable.type.element if isinstance(variable.type, ir.ArrayType) else variable.type
    if isinstance(element, _NOT_SHARED):
        raise _UnfitError(f"it uses {variable.name}, which tasks cannot share")
    return replace(variable, storage="persistent", scope="global")


def _types(module: ir.Module) -> Iterator[tuple[str, tuple[ir.Module, ir.Declaration]]]:
    for one in module.declarations:
        if isinstance(one, ir.RecordDeclaration | ir.EnumDeclaration | ir.AliasDeclaration):
            yield one.name.lower(), (module, one)

"""Tasks that move the robot (URScript threads that hold the whole motion), for targets where only the program itself
moves it: the roles are turned around. The task's routine is called where it was started, and what the program looks at
meanwhile to end it becomes an interrupt that brakes and leaves the routine.

What the program did in between stays behind the call, where the task has ended: a loop that waits finds the condition
that came. Work that does not end the task becomes a task of its own, which the program joins. Only where that is known
for all starts of a task; the others are refused, and so is a wait for a limited time, which would not end the motion.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field, replace

from rpl import ir
from rpl.diagnostics import Severity, code
from rpl.ir.walk import bodies, walk
from rpl.passes.legalise.context import Context, rules_of
from rpl.passes.legalise.facts.usage import called_names, exposed
from rpl.passes.legalise.rewriting.beside import closure, local_names, tidy
from rpl.passes.legalise.rewriting.editing import edit_all, edit_bodies, expansion, map_body
from rpl.passes.legalise.rewriting.jumps import inside
from rpl.passes.legalise.rewriting.stopping import stopped
from rpl.passes.legalise.rewriting.support import with_support
from rpl.passes.legalise.stages import legalising
from rpl.passes.legalise.tasks.watchedloops import Event, UnfitError, WatchedTask

CALLED = code(
    "moving-task-called",
    Severity.WARNING,
    "task {name}, which moves the robot, is called as a routine; what the program does meanwhile {how}",
)
KEPT = code(
    "moving-task-kept",
    Severity.LOSS,
    "task {name} moves the robot and cannot be called as a routine: {reason}",
    "let the program itself drive, and watch in an interrupt or in a task what has to stop it",
    stops=True,
)
_DRIVES = (ir.Move, ir.MoveExternal, ir.Spline)
_TIME = (*_DRIVES, ir.Wait, ir.WaitUntil, ir.WaitForMotion, ir.StopMotion, ir.Dialog)
_PRIORITY = 1  # more urgent than any other interrupt of the program
_FIRST_IDENTITY = 9001


@legalising(unless=lambda context: context.capabilities.tasks.moving, sees=("TaskControl",))
def called_tasks(program: ir.Program, context: Context) -> ir.Program:
    """Only for targets whose other tasks cannot move the robot."""
    controls = [node for node in walk(*program.modules) if isinstance(node, ir.TaskControl)]
    if not any(one.op == "start" for one in controls):
        return program
    drives = closure(program, _DRIVES)
    done = program
    for name in dict.fromkeys(one.task.lower() for one in controls if one.op == "start"):
        if name not in drives:
            continue
        try:
            done = _Called(done, context, name).program_with_calls()
        except UnfitError as reason:
            done = _refused(done, context, name, str(reason))
    return done


def _refused(program: ir.Program, context: Context, name: str, reason: str) -> ir.Program:
    """The program without the starts of a task that would drive the robot with nobody to stop it."""

    def change(statement: ir.Statement) -> ir.Body:
        if isinstance(statement, ir.TaskControl) and statement.op == "start" and statement.task.lower() == name:
            return (stopped(statement, KEPT, context, name=name, reason=reason),)
        return (inside(statement, lambda body: map_body(body, change)),)

    return edit_all(program, lambda body: map_body(body, change))


@dataclass(slots=True)
class _Called:
    """One task. `known`: routines (folded) that take time."""

    program: ir.Program
    context: Context
    name: str
    task: WatchedTask = field(init=False)
    routines: list[ir.Routine] = field(default_factory=list)
    made: list[ir.Routine] = field(default_factory=list)
    data: list[ir.Variable] = field(default_factory=list)
    controls: int = 0
    outermost: ir.Body | None = None  # the body of a routine that nobody calls

    def __post_init__(self) -> None:
        found = [r for m in self.program.modules for r in m.routines if r.name.lower() == self.name]
        if len(found) != 1:
            raise UnfitError("the program has no such routine")
        timed = closure(self.program, _TIME)
        self.task = WatchedTask(self.context, found[0], timed, closure(self.program, _DRIVES))

    def program_with_calls(self) -> ir.Program:
        asked = [node for node in self.nodes() if node.task.lower() == self.name]
        if any(one.op in ("pause", "resume") for one in asked):
            raise UnfitError("it is halted and goes on in the middle")
        if self.task.routine.kind == "function":
            raise UnfitError("it is a function")
        modules = tuple(
            replace(module, routines=tuple(map(self.routine, module.routines))) for module in self.program.modules
        )
        done = replace(self.program, modules=modules)
        left = [n for n in walk(*modules) if isinstance(n, ir.TaskControl) and n.task.lower() == self.name]
        if left:
            raise UnfitError("the program ends it, or waits for it, where it was not started")
        if self.routines or self.made:
            done = self.ending(done)
        how = "is done by a task beside it" if self.made else "is done behind it"
        how = how if not self.routines else "to end it is an interrupt"
        self.context.diagnostics.report(CALLED, asked[0].origin, name=self.task.routine.name, how=how)
        made = (*self.routines, *self.made)
        done = exposed(done, called_names(made))
        return with_support(done, self.context, self.data, made, modules[0].task)

    def nodes(self) -> Iterator[ir.TaskControl]:
        return (node for node in walk(*self.program.modules) if isinstance(node, ir.TaskControl))

    def ending(self, program: ir.Program) -> ir.Program:
        """The routine ends when the robot stands, so that the interrupt is armed until then; what it says to others on
        its way it says where the robot is."""
        stands = ir.WaitForMotion()
        source, target = (rules_of(one).advance.runs_ahead_of for one in (self.context.source, self.context.target))
        waits = source == "fly_by" and target == "all"

        def change(one: ir.Statement) -> ir.Body:
            if isinstance(one, ir.Return):
                return (replace(stands, origin=one.origin), replace(one, origin=tidy(one.origin)))
            return (inside(one, on_body),)

        def on_body(body: ir.Body) -> ir.Body:
            return map_body(_standing(body) if waits else body, change)

        def routine(one: ir.Routine) -> ir.Routine:
            if one.name.lower() != self.name:
                return one
            done = on_body(one.body)
            return replace(one, body=done if done and done[-1] == stands else (*done, stands))

        modules = tuple(replace(m, routines=tuple(map(routine, m.routines))) for m in program.modules)
        return replace(program, modules=modules)

    # ---- the routines that start it

    def routine(self, routine: ir.Routine) -> ir.Routine:
        if not any(isinstance(n, ir.TaskControl) and n.task.lower() == self.name for n in walk(*bodies(routine))):
            return routine
        if routine.name.lower() == self.name:
            raise UnfitError("it controls itself")
        self.task.hidden = local_names(routine)
        called = called_names(r for m in self.program.modules for r in m.routines)
        self.outermost = None if routine.name.lower() in called else routine.body
        return edit_bodies(routine, self.body)

    def body(self, body: ir.Body) -> ir.Body:
        done: list[ir.Statement] = []
        at = 0
        while at < len(body):
            statement = body[at]
            if (
                isinstance(statement, ir.TaskControl)
                and statement.task.lower() == self.name
                and statement.op == "start"
            ):
                last = self.task.last_word(body, at)
                if last is None and self.outermost is not body:
                    raise UnfitError("the program does not wait for its end")
                rest = body[at + 1 : len(body) if last is None else last + 1]
                done.extend(self.work_beside(statement, rest) if last is None else self.region(statement, rest))
                at += 1 + len(rest)
                continue
            done.append(inside(statement, self.body))
            at += 1
        return body if all(a is b for a, b in zip(done, body, strict=False)) and len(done) == len(body) else tuple(done)

    def region(self, start: ir.TaskControl, region: ir.Body) -> ir.Body:
        """What stands from the start of the task to its end: up to the waiting, the call, and the rest."""
        try:
            before, events, after = self.task.parted(region)
        except UnfitError:
            if self.task.ends(region):
                raise
            return self.work_beside(start, region)
        call = ir.CallRoutine(start.task, start.arguments)
        way = expansion(start.origin, self.guarded(start, call, events) if events else (call,))
        return (*before, *way, *after) if not before else (*_first(before, start), *_rest(way), *after)

    def work_beside(self, start: ir.TaskControl, region: ir.Body) -> ir.Body:
        """The call, and what the program does until the task has ended as a task of its own."""
        if not region:
            return expansion(start.origin, (ir.CallRoutine(start.task, start.arguments),))
        work = self.context.fresh(f"rpl_beside_{self.name}")
        self.made.append(ir.Routine(work, body=self.task.alone(region), scope="global"))
        call = ir.CallRoutine(start.task, start.arguments)
        return expansion(start.origin, (ir.TaskControl("start", work), call, ir.TaskControl("join", work)))

    def guarded(self, start: ir.TaskControl, call: ir.CallRoutine, events: list[Event]) -> ir.Body:
        """The call with interrupts for what ends it; where that is so already there is no motion."""
        already: list[tuple[ir.Expression, ir.Body]] = []
        armed: list[ir.Statement] = []
        off: list[ir.Statement] = []
        for event in events:
            hit = ir.Assign(event.hit, ir.BoolLiteral(True))
            number = ir.IntLiteral(_FIRST_IDENTITY + self.controls)
            self.controls += 1
            action = self.context.fresh(f"rpl_ends_{self.name}")
            bare = tuple(replace(one, origin=tidy(one.origin)) for one in event.before)
            ending = (*bare, ir.StopMotion(), hit, ir.ResumeLevel())
            self.routines.append(ir.Routine(action, body=ending, scope="global"))
            self.data.append(ir.Variable(event.hit.id, ir.BoolType(), ir.BoolLiteral(False), scope="global"))
            already.append((event.condition, (*bare, hit)))
            declared = ir.DeclareInterrupt(
                ir.IntLiteral(_PRIORITY),
                event.condition,
                ir.CallRoutine(action),
                identity=number,
                origin=tidy(start.origin),
            )
            armed += [declared, ir.ControlInterrupt("on", number)]
            off.append(ir.ControlInterrupt("off", number))
        first = tuple(ir.Assign(event.hit, ir.BoolLiteral(False)) for event in events)
        return (*first, ir.If(tuple(already), (*armed, call, *off)))


def _standing(body: ir.Body) -> ir.Body:
    """The body with a wait for the robot behind each move that stops, as the source's program waits there."""
    done: list[ir.Statement] = []
    for at, statement in enumerate(body):
        done.append(statement)
        stops = isinstance(statement, ir.Move) and isinstance(statement.blend, ir.BlendStop | None)
        if stops and not isinstance(body[at + 1] if at + 1 < len(body) else None, ir.Move):
            done.append(ir.WaitForMotion(origin=tidy(statement.origin)))
    return tuple(done)


def _first(before: ir.Body, start: ir.TaskControl) -> ir.Body:
    """The remarks of the start stand at the first statement."""
    if not start.origin.comments:
        return before
    return (ir.Nothing(origin=start.origin), *before)


def _rest(way: ir.Body) -> ir.Body:
    return tuple(replace(one, origin=tidy(one.origin)) for one in way)


__all__ = ["called_tasks"]

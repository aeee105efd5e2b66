"""Tasks that move the robot (URScript threads that hold the whole motion), for targets where only the program itself
moves it: the roles are turned around. The task's routine is called where it was started.

What the program did until it waits for the task's end and takes no time stays in front of the call; the waiting finds
the task at its end. Other work meanwhile becomes a task of its own, which the program joins. Only where that is known
for all starts of a task; the others are refused, and so is a task that the program ends on its way: nobody would stop
the motion of a routine.
"""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from typing import TypeGuard

from rpl import ir
from rpl.diagnostics import Severity, code
from rpl.ir.walk import bodies, walk
from rpl.passes.legalise.context import Context, rules_of
from rpl.passes.legalise.facts.usage import assigned_in, called_names, exposed
from rpl.passes.legalise.kinds import walk_for
from rpl.passes.legalise.rewriting.beside import closure, local_names, moves_or_waits, tidy
from rpl.passes.legalise.rewriting.editing import edit_all, edit_bodies, expansion, map_body
from rpl.passes.legalise.rewriting.jumps import LOOPS, inside
from rpl.passes.legalise.rewriting.stopping import stopped
from rpl.passes.legalise.rewriting.support import with_support
from rpl.passes.legalise.stages import legalising

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
_WAITING = (ir.Wait, ir.WaitUntil, ir.WaitForMotion, ir.Dialog, ir.Pulse)
_STOPPING = (ir.StopMotion, ir.ClearMotion, ir.StartMotion)
_JUMPING = (ir.Goto, ir.Label, ir.Raise, ir.Halt, ir.Return)


class _UnfitError(Exception):
    """Why a task cannot be called as a routine."""


@legalising(unless=lambda context: context.capabilities.tasks.moving, sees=("TaskControl",))
def called_tasks(program: ir.Program, context: Context) -> ir.Program:
    """Only for targets whose other tasks cannot move the robot."""
    controls = [node for node in walk_for({"TaskControl"}, *program.modules) if isinstance(node, ir.TaskControl)]
    if not any(one.op == "start" for one in controls):
        return program
    drives = closure(program, _DRIVES)
    done = program
    for name in dict.fromkeys(one.task.lower() for one in controls if one.op == "start"):
        if name not in drives:
            continue
        try:
            done = _Called(done, context, name).program_with_calls()
        except _UnfitError as reason:
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
    """One task. timed, driving: routines (folded) that take time, that drive; ended: what the task sets at its end;
    hidden: names that a task beside does not see; outermost: the body of a routine that nobody calls."""

    program: ir.Program
    context: Context
    name: str
    task: ir.Routine = field(init=False)
    timed: frozenset[str] = field(init=False)
    driving: frozenset[str] = field(init=False)
    ended: frozenset[str] = field(init=False)
    hidden: frozenset[str] = frozenset()
    made: list[ir.Routine] = field(default_factory=list)
    outermost: ir.Body | None = None

    def __post_init__(self) -> None:
        found = [r for m in self.program.modules for r in m.routines if r.name.lower() == self.name]
        if len(found) != 1:
            raise _UnfitError("the program has no such routine")
        self.task = found[0]
        self.timed, self.driving = closure(self.program, _TIME), closure(self.program, _DRIVES)
        tail: list[ir.Statement] = []
        for statement in reversed(self.task.body):
            if self.takes_time(statement):
                break
            tail.append(statement)
        self.ended = frozenset(assigned_in(tuple(tail)))

    def program_with_calls(self) -> ir.Program:
        asked = [node for node in walk_for({"TaskControl"}, *self.program.modules) if self.is_control(node)]
        if any(one.op in ("pause", "resume") for one in asked):
            raise _UnfitError("it is halted and goes on in the middle")
        if self.task.kind == "function":
            raise _UnfitError("it is a function")
        done = replace(
            self.program,
            modules=tuple(
                replace(module, routines=tuple(map(self.routine, module.routines))) for module in self.program.modules
            ),
        )
        if any(self.is_control(node) for node in walk_for({"TaskControl"}, *done.modules)):
            raise _UnfitError("the program ends it, or waits for it, where it was not started")
        if self.made:
            done = self.ending(done)
        how = "is done by a task beside it" if self.made else "is done before and behind it"
        self.context.diagnostics.report(CALLED, asked[0].origin, name=self.task.name, how=how)
        done = exposed(done, called_names(self.made))
        return with_support(done, self.context, (), self.made, done.modules[0].task)

    def ending(self, program: ir.Program) -> ir.Program:
        """The routine ends when the robot stands; what it says to others on its way it says where the robot is."""
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

    # ---- what is asked of statements

    def takes_time(self, statement: ir.Statement) -> bool:
        if moves_or_waits(statement, self.timed):
            return True
        return any(isinstance(node, (*_WAITING, *LOOPS)) for node in walk(statement))

    def is_control(self, node: object) -> TypeGuard[ir.TaskControl]:
        return isinstance(node, ir.TaskControl) and node.task.lower() == self.name

    def controls(self, statement: ir.Statement) -> bool:
        return any(map(self.is_control, walk(statement)))

    def finds_ended(self, statement: ir.Statement) -> bool:
        """Does it wait for nothing but what the task says at its end?"""
        match statement:
            case ir.WaitUntil(condition=condition, timeout=None):
                pass
            case ir.While(condition=condition, body=body):
                if not all(isinstance(one, ir.Wait | ir.Nothing) for one in body):
                    return False
            case _:
                return False
        parts = list(walk(condition))
        names = {node.id.lower() for node in parts if isinstance(node, ir.Name)}
        asked = any(isinstance(node, ir.Signal | ir.System | ir.Call | ir.Builtin) for node in parts)
        return bool(names) and names <= self.ended and not asked

    # ---- the routines that start it

    def routine(self, routine: ir.Routine) -> ir.Routine:
        if not any(map(self.is_control, walk(*bodies(routine)))):
            return routine
        if routine.name.lower() == self.name:
            raise _UnfitError("it controls itself")
        self.hidden = local_names(routine)
        called = called_names(r for m in self.program.modules for r in m.routines)
        self.outermost = None if routine.name.lower() in called else routine.body
        return edit_bodies(routine, self.body)

    def body(self, body: ir.Body) -> ir.Body:
        done: list[ir.Statement] = []
        at = 0
        while at < len(body):
            statement = body[at]
            if self.is_control(statement) and statement.op == "start":
                last = self.last_word(body, at)
                if last is None and self.outermost is not body:
                    raise _UnfitError("the program does not wait for its end")
                rest = body[at + 1 : len(body) if last is None else last + 1]
                done.extend(self.region(statement, rest))
                at += 1 + len(rest)
                continue
            done.append(inside(statement, self.body))
            at += 1
        return body if all(a is b for a, b in zip(done, body, strict=False)) and len(done) == len(body) else tuple(done)

    def last_word(self, body: ir.Body, start: int) -> int | None:
        """The last statement of the body that concerns the task, or waits for what it says at its end; None when the
        program never does."""
        last = None
        for at in range(start + 1, len(body)):
            statement = body[at]
            if self.is_control(statement) and statement.op == "start":
                break
            waits = isinstance(statement, (*LOOPS, ir.WaitUntil)) and any(
                isinstance(node, ir.Name) and node.id.lower() in self.ended for node in walk(statement)
            )
            if self.controls(statement) or waits:
                last = at
        return last

    def region(self, start: ir.TaskControl, region: ir.Body) -> ir.Body:
        """What stands from the start of the task to its end: up to the waiting, the call, and the rest; or the call,
        and what the program does meanwhile as a task of its own."""
        for node in walk(*region):
            if self.is_control(node) and node.op == "stop":
                raise _UnfitError("the program ends it on its way")
            if isinstance(node, _JUMPING):
                raise _UnfitError("the program leaves the place from where it looks at it")
            calls = isinstance(node, ir.CallRoutine | ir.Call) and node.name.lower() in self.driving
            if calls or isinstance(node, (*_STOPPING, *_DRIVES)):
                raise _UnfitError("the program moves the robot too")
        at = 0
        while at < len(region) and not self.controls(region[at]) and not self.takes_time(region[at]):
            at += 1
        call = ir.CallRoutine(start.task, start.arguments)
        if at < len(region) and (self.is_control(region[at]) or self.finds_ended(region[at])):
            before = (ir.Nothing(origin=start.origin),) if at and start.origin.comments else ()
            origin = tidy(start.origin) if at else start.origin
            return (*before, *region[:at], replace(call, origin=origin), *self.quiet(region[at:]))
        if not region:
            return (replace(call, origin=start.origin),)
        for node in walk(*region):
            if isinstance(node, ir.Name) and node.id.lower() in self.hidden:
                raise _UnfitError(f"{node.id} is a variable of the routine that works meanwhile")
        work = self.context.fresh(f"rpl_beside_{self.name}")
        self.made.append(ir.Routine(work, body=self.quiet(region), scope="global"))
        return expansion(start.origin, (ir.TaskControl("start", work), call, ir.TaskControl("join", work)))

    def quiet(self, body: ir.Body) -> ir.Body:
        """The statements with nothing that concerns the task, which has ended."""
        done: list[ir.Statement] = []
        for statement in body:
            if self.is_control(statement):
                done += [ir.Nothing(origin=statement.origin)] if statement.origin.comments else []
            else:
                done.append(inside(statement, self.quiet))
        return tuple(done)


def _standing(body: ir.Body) -> ir.Body:
    """The body with a wait for the robot behind each move that stops, as the source's program waits there."""
    done: list[ir.Statement] = []
    for at, statement in enumerate(body):
        done.append(statement)
        stops = isinstance(statement, ir.Move) and isinstance(statement.blend, ir.BlendStop | None)
        if stops and not isinstance(body[at + 1] if at + 1 < len(body) else None, ir.Move):
            done.append(ir.WaitForMotion(origin=tidy(statement.origin)))
    return tuple(done)


__all__ = ["called_tasks"]

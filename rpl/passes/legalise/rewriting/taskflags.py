"""Flags that say whether a task runs, for targets that cannot ask that, wait for its end, or end it: the program sets
the flag where it starts the task, and the task's routine takes it back wherever it ends.

What ends the task from outside takes the flag back as well. A routine that ends by an error or a halt leaves it.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, replace

from rpl import ir
from rpl.ir.walk import rewrite
from rpl.passes.legalise.context import Context
from rpl.passes.legalise.kinds import walk_for
from rpl.passes.legalise.rewriting.editing import edit_bodies, edit_each, expansion, map_body
from rpl.passes.legalise.rewriting.jumps import inside, left_with
from rpl.passes.legalise.rewriting.support import with_support
from rpl.source import NOWHERE

ASKS = "task_runs"
_TRUE, _FALSE = ir.BoolLiteral(True), ir.BoolLiteral(False)


@dataclass(frozen=True, slots=True)
class TaskFlag:
    """What the flag of one task is for: questions whether it runs (`asked`) and waits for its end (`joined`) become
    looks at it; with `ends`, the task looks at a second flag, by which the program asks it to end (`leaving_at` makes
    its routine do so)."""

    runs: ir.Name
    asked: bool = False
    joined: bool = False
    ends: ir.Name | None = None

    @property
    def ended(self) -> ir.WaitUntil:
        return ir.WaitUntil(ir.Unary("not", self.runs), origin=NOWHERE)

    def control(self, statement: ir.TaskControl) -> ir.Body:
        """A statement that controls the task."""
        origin = statement.origin
        match statement.op:
            case "start":
                steps = [] if self.ends is None else [ir.Assign(self.ends, _FALSE)]
                return expansion(origin, (*steps, ir.Assign(self.runs, _TRUE), statement))
            case "stop" if self.ends is not None:
                return (ir.If(((self.runs, (ir.Assign(self.ends, _TRUE), self.ended)),), origin=origin),)
            case "stop":
                return expansion(origin, (statement, ir.Assign(self.runs, _FALSE)))
            case "join" if self.joined:
                return (replace(self.ended, origin=origin),)
        return (statement,)


def with_task_flags(program: ir.Program, context: Context, flags: Mapping[str, TaskFlag]) -> ir.Program:
    """The program with these flags, by the names (folded) of their tasks."""
    if not flags:
        return program

    def answer(node: object) -> object:
        flag = flags.get(asked_task(node) or "")
        return flag.runs if flag is not None and flag.asked else node

    def change(statement: ir.Statement) -> ir.Body:
        if isinstance(statement, ir.TaskControl) and (flag := flags.get(statement.task.lower())) is not None:
            return flag.control(statement)
        return (inside(statement, lambda inner: map_body(inner, change)),)

    def routine(_: ir.Module, one: ir.Routine) -> ir.Routine:
        done = edit_bodies(one, lambda body: map_body(body, change))
        flag = flags.get(one.name.lower())
        return done if flag is None else left_with(done, (ir.Assign(flag.runs, _FALSE),))

    changed = edit_each(program, routine)
    if any(flag.asked for flag in flags.values()):
        changed = rewrite(changed, answer)
    names = [name for flag in flags.values() for name in (flag.runs, flag.ends) if name is not None]
    data = [ir.Variable(name.id, ir.BoolType(), _FALSE, scope="global") for name in names]
    return with_support(changed, context, data, (), changed.modules[0].task)


def flag_of(task: str, context: Context) -> ir.Name:
    """A new name for the flag that says that a task runs."""
    return ir.Name(context.fresh(f"{task.replace('.', '_')}_runs"))


def asked_task(node: object) -> str | None:
    """The task (folded) that a question whether it runs is about."""
    match node:
        case ir.Builtin(function=function, arguments=(ir.TextLiteral(value=name),)) if function == ASKS:
            return name.lower()
    return None


def controlled(program: ir.Program, operations: Iterable[str]) -> set[str]:
    """Tasks (folded) that the program starts, ends or waits for, whichever of these is asked for."""
    wanted = frozenset(operations)
    controls = walk_for({"TaskControl"}, *program.modules)
    return {one.task.lower() for one in controls if isinstance(one, ir.TaskControl) and one.op in wanted}


def called_too(program: ir.Program) -> set[str]:
    """Names (folded) of routines that are called: a flag that such a one takes back would say the wrong thing."""
    calls = walk_for({"CallRoutine", "Call"}, *program.modules)
    return {one.name.lower() for one in calls if isinstance(one, ir.CallRoutine | ir.Call)}


__all__ = ["ASKS", "TaskFlag", "asked_task", "called_too", "controlled", "flag_of", "with_task_flags"]

"""Tasks that a program begins once more while they run, in languages where that makes a second one beside the first
(URScript `run` in a loop), for targets where it does nothing.

Starts into handles of their own are tasks of their own already when a program is read. What is left are starts that
come again: where nothing ends the task or waits for it in between, the difference is named.
"""

from __future__ import annotations

from collections.abc import Iterator

from rpl import ir
from rpl.diagnostics import Severity, code
from rpl.ir.walk import bodies, walk
from rpl.passes.legalise.context import Context, rules_of
from rpl.passes.legalise.rewriting.editing import edit_all, map_body
from rpl.passes.legalise.rewriting.jumps import LOOPS, inside
from rpl.passes.legalise.rewriting.stopping import stopped
from rpl.passes.legalise.stages import legalising

MAYBE = code(
    "task-started-again",
    Severity.WARNING,
    "task {name} may still run when it is started here again; the target then does not begin another one beside it",
    "wait for its end first (join), or keep each handle in a variable of its own",
)
SURELY = code(
    "second-task-lost",
    Severity.LOSS,
    "task {name} never ends and is started here again; the target cannot run it twice",
    "keep each handle in a variable of its own",
    stops=True,
)


@legalising(unless=lambda context: context.capabilities.carries_rules or not rules_of(context.source).task_instances)
def second_starts(program: ir.Program, context: Context) -> ir.Program:
    """For every target that knows a task by its routine."""
    routines = [routine for module in program.modules for routine in module.routines]
    endless = {one.name.lower() for one in routines if _is_endless(one.body)}
    twice: set[int] = set()
    for start in dict.fromkeys(again for one in routines for body in bodies(one) for again in _again(body, False)):
        if start.task.lower() in endless:
            twice.add(id(start))
        else:
            context.diagnostics.report(MAYBE, start.origin, name=start.task)

    def change(one: ir.Statement) -> ir.Body:
        if isinstance(one, ir.TaskControl) and id(one) in twice:
            return (stopped(one, SURELY, context, name=one.task),)
        return (inside(one, lambda inner: map_body(inner, change)),)

    return edit_all(program, lambda body: map_body(body, change)) if twice else program


def _is_endless(body: ir.Body) -> bool:
    """Does the body end in a loop that nothing leaves?"""
    last = next((one for one in reversed(body) if not isinstance(one, ir.Nothing)), None)
    return isinstance(last, ir.Loop) and not any(
        isinstance(node, ir.ExitLoop | ir.Return | ir.Goto | ir.Halt | ir.Raise) for node in walk(*last.body)
    )


def _again(body: ir.Body, in_loop: bool) -> Iterator[ir.TaskControl]:
    """Starts that come while nothing since the start before has ended the task or waited for it."""
    begun: set[str] = set()
    for statement in body:
        controls = [node for node in walk(statement) if isinstance(node, ir.TaskControl)]
        ended = {one.task.lower() for one in controls if one.op in ("stop", "join")}
        match statement:
            case ir.TaskControl(op="start", task=task):
                if task.lower() in begun or (in_loop and not _ends(body, task)):
                    yield statement
                begun.add(task.lower())
            case ir.If(branches=branches, otherwise=otherwise):
                for inner in (*(inner for _, inner in branches), otherwise):
                    yield from _again(inner, in_loop and not any(_ends(body, one.task) for one in controls))
            case ir.Switch(cases=cases, default=default):
                for inner in (*(case.body for case in cases), default or ()):
                    yield from _again(inner, in_loop and not any(_ends(body, one.task) for one in controls))
            case _ if isinstance(statement, LOOPS):
                yield from _again(statement.body, True)
        begun -= ended


def _ends(body: ir.Body, task: str) -> bool:
    """Is the task ended or awaited there?"""
    return any(
        isinstance(node, ir.TaskControl) and node.op in ("stop", "join") and node.task.lower() == task.lower()
        for node in walk(*body)
    )


__all__ = ["SURELY", "second_starts"]

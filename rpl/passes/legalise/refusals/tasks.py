"""Tasks and critical sections that no target is given."""

from __future__ import annotations

from rpl import ir
from rpl.diagnostics import Severity, code
from rpl.passes.legalise.interrupts.tasks.taskreferences import SHARED
from rpl.passes.legalise.refusals.rows import PLAINLY, Asked, Found, Refusal
from rpl.passes.legalise.tasks.calledtasks import KEPT
from rpl.passes.legalise.tasks.secondstarts import SURELY

__all__ = ["TASKS"]

CRITICAL = code(
    "critical-section-lost",
    Severity.LOSS,
    "the target cannot keep other tasks from running in a section of a program",
    "let the tasks take turns by signals, or do in one task what must not be divided",
    stops=True,
)
TASK = code(
    "task-control-lost",
    Severity.LOSS,
    "the target's programs cannot {what} another task ({name})",
    "set the tasks up on the controller and let them wait for signals of each other",
    stops=True,
)
MEETING = code(
    "meeting-lost",
    Severity.LOSS,
    "the target's tasks cannot wait for each other at a point ({point})",
    "let the programs wait for signals of each other",
    stops=True,
)


def _critical(statement: ir.Critical, asked: Asked) -> Found:
    return PLAINLY if "Critical" not in asked.can.statements and statement.enter else ()


def _task(statement: ir.TaskControl, asked: Asked) -> Found:
    op, can = statement.op, asked.can
    if "TaskControl" in can.statements and op in can.tasks.operations:
        return ()
    return ({"what": _WHAT.get(op, op), "name": statement.task},)


def _meeting(statement: ir.Meet, asked: Asked) -> Found:
    return () if "Meet" in asked.can.statements else ({"point": _called(statement.identity)},)


def _called(point: ir.Expression) -> str:
    """What a meeting point is called, as far as the program's text says it."""
    while isinstance(point, ir.Index):
        point = point.base
    return point.id if isinstance(point, ir.Name) else point.value if isinstance(point, ir.TextLiteral) else "computed"


_WHAT = {"start": "start", "stop": "end", "pause": "halt", "resume": "go on with", "join": "wait for the end of"}

TASKS = (
    Refusal("a critical section, where there are other tasks", CRITICAL, (ir.Critical,), _critical),
    Refusal("an operation on another task that the target has not", TASK, (ir.TaskControl,), _task),
    Refusal("a task that never ends, started once more beside itself", SURELY),
    Refusal("an argument of a task that the task or what starts it may change", SHARED),
    Refusal("a task that moves the robot and that the program ends on its way, or moves beside", KEPT),
    Refusal("tasks that wait for each other at a point", MEETING, (ir.Meet,), _meeting),
)

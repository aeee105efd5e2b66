"""What translation gives to no target that lacks it: one table. Each row says which statements, why, and what the user
can do by hand; the statement is reported at its place, and the writer puts the target's stop there.

A critical section of a program with one task says nothing and is left out; so is, with a report and a remark, what only
tunes the source's controller.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from typing import Any, get_args

from rpl import ir
from rpl.diagnostics import Code, Severity, code
from rpl.ir.walk import bodies
from rpl.passes.capabilities import Capabilities
from rpl.passes.legalise.context import Context
from rpl.passes.legalise.control.jumps import inside
from rpl.passes.legalise.facts.effects import statements_in
from rpl.passes.legalise.facts.usage import each_expression
from rpl.passes.legalise.rewriting.editing import Editor, edit_bodies, edit_routines, map_body
from rpl.passes.legalise.stages import legalising
from rpl.passes.scope import Scope
from rpl.passes.typing import type_of
from rpl.source import Comment

CRITICAL = code(
    "critical-section-lost",
    Severity.LOSS,
    "the target cannot keep other tasks from running in a section of a program",
    "let the tasks take turns by signals, or do in one task what must not be divided",
)
TASK = code(
    "task-control-lost",
    Severity.LOSS,
    "the target's programs cannot {what} another task ({name})",
    "set the tasks up on the controller and let them wait for signals of each other",
    stops=True,
)
INTERRUPT = code(
    "interrupt-lost",
    Severity.LOSS,
    "the target has no interrupts; {action} does not run when the condition comes true",
    "watch the condition in a task of its own or with the controller's monitoring function",
    stops=True,
)
MEETING = code(
    "meeting-lost",
    Severity.LOSS,
    "the target's tasks cannot wait for each other at a point ({point})",
    "let the programs wait for signals of each other",
    stops=True,
)
TUNING = code(
    "tuning-left-out",
    Severity.WARNING,
    "{text} sets up the source's controller only; it is left out",
    "set the same on the target's controller where it has it (payload, collision guard)",
)
SEARCH = code(
    "search-lost",
    Severity.LOSS,
    "the target's moves do not watch a condition on their way",
    "use the controller's own search function, or drive in short steps and ask the condition between them",
    stops=True,
)
KINEMATICS = code(
    "kinematics-lost",
    Severity.LOSS,
    "the target's programs cannot {what}",
    "teach the position in the target's own form, or let the move itself find the joints",
    stops=True,
)


@dataclass(slots=True)
class Asked:
    """What a row of the table may ask about: the translation, the program as a whole, and names where the statement
    stands."""

    context: Context
    program: ir.Program
    scope: Scope

    @property
    def can(self) -> Capabilities:
        return self.context.capabilities


Found = tuple[Mapping[str, object], ...]  # one for each report about a statement; none: it is not refused
_PLAINLY: Found = ({},)


@dataclass(frozen=True, slots=True)
class Refusal:
    """A row. what: the construct in words, for the page of what is supported. code: its text says why, its help what to
    do. nodes: classes of statements; refused: what the reports about such a statement name. left: the statement stays,
    because no writer of such a target can say it; else it becomes one that none says."""

    what: str
    code: Code
    nodes: tuple[type, ...]
    refused: Callable[[Any, Asked], Found]
    left: bool = True


def _critical(statement: ir.Critical, asked: Asked) -> Found:
    return _PLAINLY if "Critical" not in asked.can.statements and statement.enter else ()


def _task(statement: ir.TaskControl, asked: Asked) -> Found:
    op, can = statement.op, asked.can
    if "TaskControl" in can.statements and op in can.task_operations:
        return ()
    return ({"what": _WHAT.get(op, op), "name": statement.task},)


def _meeting(statement: ir.Meet, asked: Asked) -> Found:
    return () if "Meet" in asked.can.statements else ({"point": _called(statement.identity)},)


def _declared(statement: ir.DeclareInterrupt, asked: Asked) -> Found:
    if _INTERRUPTS & asked.can.statements:
        return ()
    action = statement.action
    return ({"action": action.name if isinstance(action, ir.CallRoutine) else "an assignment"},)


def _connected(statement: ir.ConnectInterrupt, asked: Asked) -> Found:
    return () if _INTERRUPTS & asked.can.statements else ({"action": statement.routine},)


def _search(statement: ir.Move, asked: Asked) -> Found:
    can = asked.can.statements
    return _PLAINLY if statement.search is not None and "Search" not in can and not _INTERRUPTS & can else ()


def _unsolved(statement: ir.Statement, asked: Asked) -> Found:
    """Kinematic functions that the target has in no form."""
    can, found = asked.can, list[Mapping[str, object]]()
    if can.kinematics is not None:
        return ()

    def look(expression: ir.Expression) -> None:
        if not isinstance(expression, ir.Builtin) or expression.function not in _SOLVED:
            return
        needed = {expression.function}
        if expression.function == "target_to_joints_near":
            if isinstance(statement, ir.Move) and statement.target == expression:
                return  # how a move says the posture that it wants
            chosen = isinstance(type_of(expression.arguments[0], asked.scope), ir.TargetType) and not can.banks
            needed = {"target_to_joints"} if chosen else {"target_to_joints", "target_to_joints_near"}
        elif can.banks and expression.function != "is_reachable":
            return  # registers change their form where they are assigned
        if not needed <= can.functions:
            found.append({"what": _SOLVED[expression.function]})

    each_expression(statement, look)
    return tuple(found)


_SOLVED = {
    "joints_to_target": "calculate the place of the tool at given joints",
    "target_to_joints": "calculate the joints of a place",
    "target_to_joints_near": "calculate the joints of a place that are nearest to given ones",
    "is_reachable": "ask whether a place can be reached",
}
_WHAT = {"start": "start", "stop": "end", "pause": "halt", "resume": "go on with", "join": "wait for the end of"}
_INTERRUPTS = frozenset(("DeclareInterrupt", "ConnectInterrupt"))

REFUSALS = (
    Refusal("a critical section, where there are other tasks", CRITICAL, (ir.Critical,), _critical),
    Refusal("an operation on another task that the target has not", TASK, (ir.TaskControl,), _task),
    Refusal("tasks that wait for each other at a point", MEETING, (ir.Meet,), _meeting),
    Refusal("an interrupt", INTERRUPT, (ir.DeclareInterrupt,), _declared),
    Refusal("an interrupt of a trap routine", INTERRUPT, (ir.ConnectInterrupt,), _connected),
    Refusal("a move that a condition ends", SEARCH, (ir.Move,), _search),
    Refusal("kinematics of the arm in a program", KINEMATICS, get_args(ir.Statement), _unsolved),
)


@legalising()
def refuse(program: ir.Program, context: Context) -> ir.Program:
    """Names what the target lacks; takes out critical sections of programs with one task."""
    asked_of: dict[type, list[Refusal]] = {}
    for row in REFUSALS:
        for node in row.nodes:
            asked_of.setdefault(node, []).append(row)
    single = "Critical" not in context.capabilities.statements and _single(program)
    report = context.diagnostics.report

    def changed(statement: ir.Statement, asked: Asked) -> ir.Body | None:
        match statement:
            case ir.Critical() if single:
                return (ir.Nothing(origin=statement.origin),) if statement.origin.comments else ()
            case ir.Vendor(dialect=owner, text=text, effect="tuning") if owner != context.target:
                report(TUNING, statement.origin, text=text.strip())
                remark = Comment(f" left out: {text.strip()}")
                return (ir.Nothing(origin=replace(statement.origin, comments=(*statement.origin.comments, remark))),)
        for row in asked_of.get(statement.__class__, ()):
            found = row.refused(statement, asked)
            for arguments in found:
                report(row.code, statement.origin, **arguments)
            if found and not row.left:
                return (ir.Opaque(statement.origin.text or row.what, origin=statement.origin),)
        return None

    def work(editor: Editor, routine: ir.Routine) -> ir.Routine:
        asked = Asked(context, program, editor.scope)

        def change(statement: ir.Statement) -> ir.Body:
            done = changed(statement, asked)
            return (inside(statement, lambda inner: map_body(inner, change)),) if done is None else done

        return edit_bodies(routine, lambda body: map_body(body, change))

    return edit_routines(program, context, work)


def _called(point: ir.Expression) -> str:
    """What a meeting point is called, as far as the program's text says it."""
    while isinstance(point, ir.Index):
        point = point.base
    return point.id if isinstance(point, ir.Name) else point.value if isinstance(point, ir.TextLiteral) else "computed"


def _single(program: ir.Program) -> bool:
    """Has the program one task only?"""
    if len(program.tasks) > 1 or len({module.task for module in program.modules}) > 1:
        return False
    return not any(
        isinstance(one, ir.TaskControl)
        for module in program.modules
        for routine in module.routines
        for body in bodies(routine)
        for one in statements_in(body)
    )

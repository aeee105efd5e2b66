"""What no rewriting can give a target: critical sections, control of other tasks, interrupts. Each is named with its
reason; the statement stays, and the writer puts the target's stop there.

A critical section of a program with one task says nothing and is left out; so is, with a report and a remark, what only
tunes the source's controller.
"""

from __future__ import annotations

from dataclasses import replace

from rpl import ir
from rpl.diagnostics import Severity, code
from rpl.ir.walk import bodies
from rpl.passes.legalise.context import Context
from rpl.passes.legalise.editing import Editor, edit_bodies, edit_routines, map_body
from rpl.passes.legalise.effects import statements_in
from rpl.passes.legalise.jumps import inside
from rpl.passes.legalise.usage import each_expression, each_statement
from rpl.passes.scope import Scope
from rpl.passes.typing import type_of
from rpl.source import Comment

CRITICAL = code(
    "critical-section-lost", Severity.LOSS, "the target cannot keep other tasks from running in a section of a program"
)
TASK = code("task-control-lost", Severity.LOSS, "the target's programs cannot {what} another task ({name})", stops=True)
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
SEARCH = code("search-lost", Severity.LOSS, "the target's moves do not watch a condition on their way", stops=True)
KINEMATICS = code(
    "kinematics-lost",
    Severity.LOSS,
    "the target's programs cannot {what}",
    "teach the position in the target's own form, or let the move itself find the joints",
    stops=True,
)
_SOLVED = {
    "joints_to_target": "calculate the place of the tool at given joints",
    "target_to_joints": "calculate the joints of a place",
    "target_to_joints_near": "calculate the joints of a place that are nearest to given ones",
    "is_reachable": "ask whether a place can be reached",
}
_WHAT = {"start": "start", "stop": "end", "pause": "halt", "resume": "go on with", "join": "wait for the end of"}
_INTERRUPTS = frozenset(("DeclareInterrupt", "ConnectInterrupt"))


def refuse(program: ir.Program, context: Context) -> ir.Program:
    """Names what the target lacks; takes out critical sections of programs with one task."""
    statements, operations = context.capabilities.statements, context.capabilities.task_operations
    single = _single(program)

    def change(statement: ir.Statement) -> ir.Body:
        report = context.diagnostics.report
        match statement:
            case ir.Critical() if "Critical" not in statements:
                if single:
                    return (ir.Nothing(origin=statement.origin),) if statement.origin.comments else ()
                if statement.enter:
                    report(CRITICAL, statement.origin)
            case ir.Vendor(dialect=owner, text=text, effect="tuning") if owner != context.target:
                report(TUNING, statement.origin, text=text.strip())
                remark = Comment(f" left out: {text.strip()}")
                return (ir.Nothing(origin=replace(statement.origin, comments=(*statement.origin.comments, remark))),)
            case ir.TaskControl(op=op, task=name) if "TaskControl" not in statements or op not in operations:
                report(TASK, statement.origin, what=_WHAT.get(op, op), name=name)
            case ir.Meet(identity=point) if "Meet" not in statements:
                report(MEETING, statement.origin, point=_called(point))
            case ir.DeclareInterrupt(action=action) if not _INTERRUPTS & statements:
                name = action.name if isinstance(action, ir.CallRoutine) else "an assignment"
                report(INTERRUPT, statement.origin, action=name)
            case ir.ConnectInterrupt(routine=name) if not _INTERRUPTS & statements:
                report(INTERRUPT, statement.origin, action=name)
            case ir.Move(search=ir.Search()) if "Search" not in statements and not _INTERRUPTS & statements:
                report(SEARCH, statement.origin)
        return (inside(statement, lambda inner: map_body(inner, change)),)

    def work(editor: Editor, routine: ir.Routine) -> ir.Routine:
        for body in bodies(routine):
            each_statement(body, lambda statement: _unsolved(statement, editor.scope, context))
        return edit_bodies(routine, lambda body: map_body(body, change))

    return edit_routines(program, context, work)


def _called(point: ir.Expression) -> str:
    """What a meeting point is called, as far as the program's text says it."""
    while isinstance(point, ir.Index):
        point = point.base
    return point.id if isinstance(point, ir.Name) else point.value if isinstance(point, ir.TextLiteral) else "computed"


def _unsolved(statement: ir.Statement, scope: Scope, context: Context) -> None:
    """Reports a kinematic function that the target has in no form."""
    can = context.capabilities
    if can.kinematics is not None:
        return

    def look(expression: ir.Expression) -> None:
        if not isinstance(expression, ir.Builtin) or expression.function not in _SOLVED:
            return
        needed = {expression.function}
        if expression.function == "target_to_joints_near":
            if isinstance(statement, ir.Move) and statement.target == expression:
                return  # how a move says the posture that it wants
            chosen = isinstance(type_of(expression.arguments[0], scope), ir.TargetType) and not can.banks
            needed = {"target_to_joints"} if chosen else {"target_to_joints", "target_to_joints_near"}
        elif can.banks and expression.function != "is_reachable":
            return  # registers change their form where they are assigned
        if not needed <= can.functions:
            context.diagnostics.report(KINEMATICS, statement.origin, what=_SOLVED[expression.function])

    each_expression(statement, look)


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

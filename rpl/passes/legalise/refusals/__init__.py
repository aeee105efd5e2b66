"""What translation gives to no target that lacks it: one table, a file of rows for each concern. Each row says which
statements, why, and what the user can do by hand; the statement is reported at its place, and the writer puts the
target's stop there.

A critical section of a program with one task says nothing and is left out; so is, with a report and a remark, what only
tunes the source's controller.
"""

from __future__ import annotations

from dataclasses import replace

from rpl import ir
from rpl.diagnostics import Severity, code
from rpl.ir.walk import bodies
from rpl.passes.legalise.context import Context
from rpl.passes.legalise.facts.effects import statements_in
from rpl.passes.legalise.kinds import walk_for
from rpl.passes.legalise.refusals.arm import ARM
from rpl.passes.legalise.refusals.errors import ERRORS, serves_all_errors
from rpl.passes.legalise.refusals.motion import MOTION, WAITED_FOR
from rpl.passes.legalise.refusals.routines import ROUTINES
from rpl.passes.legalise.refusals.rows import Asked, Refusal
from rpl.passes.legalise.refusals.settings import SETTINGS
from rpl.passes.legalise.refusals.tasks import TASKS
from rpl.passes.legalise.refusals.texts import TEXTS
from rpl.passes.legalise.refusals.values import VALUES
from rpl.passes.legalise.rewriting.editing import Editor, edit_bodies, edit_routines, map_body
from rpl.passes.legalise.rewriting.jumps import inside
from rpl.passes.legalise.rewriting.refusedactions import REFUSED, without_actions
from rpl.passes.legalise.rewriting.stopping import left_out
from rpl.passes.legalise.stages import legalising
from rpl.source import Comment

TUNING = code(
    "tuning-left-out",
    Severity.WARNING,
    "{text} sets up the source's controller only; it is left out",
    "set the same on the target's controller where it has it (payload, collision guard)",
)

NOT_SET = "the routine for all errors is refused where it is set"
REFUSALS: tuple[Refusal, ...] = (*TASKS, *MOTION, *ARM, *SETTINGS, *ROUTINES, *VALUES, *TEXTS, *ERRORS)


@legalising()
def refuse(program: ir.Program, context: Context) -> ir.Program:
    """Names what the target lacks; takes out critical sections of programs with one task."""
    asked_of: dict[type, list[Refusal]] = {}
    for row in REFUSALS:
        for node in row.nodes:
            asked_of.setdefault(node, []).append(row)
    single = "Critical" not in context.capabilities.statements and _single(program)
    report = context.diagnostics.report
    without = not {"DeclareInterrupt", "ConnectInterrupt"} & context.capabilities.statements
    routines = serves_all_errors(program, context.capabilities.statements)
    if without:
        begun = [
            n
            for n in walk_for({"DeclareInterrupt", "ConnectInterrupt"}, *program.modules)
            if isinstance(n, ir.DeclareInterrupt | ir.ConnectInterrupt)
        ]
        program = without_actions(program, begun) if begun else program
    if not routines:
        set_by = [node for node in walk_for({"OnError"}, *program.modules) if isinstance(node, ir.OnError)]
        program = without_actions(program, set_by, NOT_SET) if set_by else program

    def changed(statement: ir.Statement, asked: Asked) -> ir.Body | None:
        match statement:
            case ir.ControlInterrupt() | ir.OrderInterrupt() if without:
                return (left_out(statement, REFUSED),)
            case ir.OnError(routine=None) if not routines:
                return (left_out(statement, NOT_SET),)
            case ir.Critical() if single:
                return (ir.Nothing(origin=statement.origin),) if statement.origin.comments else ()
            case ir.Critical(enter=False) if "Critical" not in context.capabilities.statements:
                return (left_out(statement, "the section is refused where it begins"),)
            case ir.Move(concurrent=True) if not context.capabilities.motion.concurrent:
                report(WAITED_FOR, statement.origin)
                statement = replace(statement, concurrent=False)
                return changed(statement, asked) or (statement,)
            case ir.Vendor(dialect=owner, text=text, effect="tuning") if owner != context.target:
                report(TUNING, statement.origin, text=text.strip())
                remark = Comment(f" left out: {text.strip()}")
                return (ir.Nothing(origin=replace(statement.origin, comments=(*statement.origin.comments, remark))),)
        for row in asked_of.get(statement.__class__, ()):
            found = () if row.refused is None else row.refused(statement, asked)
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

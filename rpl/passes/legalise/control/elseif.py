"""An If with several branches as Ifs inside of one another, for targets without ELSEIF; and for those that have it, an
ELSE that holds nothing but an If as one more branch, as people write it.
"""

from __future__ import annotations

from dataclasses import replace

from rpl import ir
from rpl.passes.capabilities import Limit
from rpl.passes.legalise.context import Context
from rpl.passes.legalise.rewriting.editing import Editor, edit_bodies, edit_routines, map_body
from rpl.passes.legalise.rewriting.jumps import inside
from rpl.passes.legalise.stages import legalising


@legalising(
    unless=lambda context: (
        Limit.ONE_BRANCH not in context.capabilities.control.limits or "If" not in context.capabilities.statements
    )
)
def nest_branches(program: ir.Program, context: Context) -> ir.Program:
    """Only for targets whose If has one condition. Without blocks the pass of labels knows a shorter form."""

    def change(statement: ir.Statement) -> ir.Body:
        done = inside(statement, lambda inner: map_body(inner, change))
        return (nested(done) if isinstance(done, ir.If) else done,)

    def work(editor: Editor, routine: ir.Routine) -> ir.Routine:
        return edit_bodies(routine, lambda body: map_body(body, change))

    return edit_routines(program, context, work)


def nested(statement: ir.If) -> ir.If:
    """The same choice with one condition at each level."""
    first, *rest = statement.branches
    if not rest:
        return statement
    inner = replace(statement, branches=tuple(rest), origin=replace(statement.origin, comments=()))
    return replace(statement, branches=(first,), otherwise=(nested(inner),))


@legalising(unless=lambda context: Limit.ONE_BRANCH in context.capabilities.control.limits, sees=("If",))
def join_branches(program: ir.Program, context: Context) -> ir.Program:
    """Only for targets that have ELSEIF; what the conditions need in front of them stands there by now."""

    def change(statement: ir.Statement) -> ir.Body:
        done = inside(statement, lambda inner: map_body(inner, change))
        return (joined(done) if isinstance(done, ir.If) else done,)

    return edit_routines(program, context, lambda _, routine: edit_bodies(routine, lambda body: map_body(body, change)))


def joined(statement: ir.If) -> ir.If:
    """The same choice with all its conditions at one level. A remark in front of one goes into its branch."""
    match statement.otherwise:
        case (ir.If(branches=((condition, body), *rest), otherwise=otherwise, origin=origin),):
            if origin.comments:
                body = (ir.Nothing(origin=origin), *body)
            return replace(statement, branches=(*statement.branches, (condition, body), *rest), otherwise=otherwise)
    return statement

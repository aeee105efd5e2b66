"""A tool or frame in use that is set by one component, or by computed components: that is done in a variable first.

One component alone: the whole is read, changed and set again. What follows the settings of a program (speeds, tools,
frames in force) thus knows of every change.
"""

from __future__ import annotations

from rpl import ir
from rpl.passes.fold import constant
from rpl.passes.legalise.context import Context
from rpl.passes.legalise.rewriting.editing import Editor, edit_bodies, edit_routines, expansion, map_body
from rpl.passes.legalise.rewriting.jumps import inside
from rpl.passes.legalise.stages import legalising


@legalising()
def whole_settings(program: ir.Program, context: Context) -> ir.Program:
    """No assignment to a component of a system variable is left."""

    def work(editor: Editor, routine: ir.Routine) -> ir.Routine:
        def body(statements: ir.Body) -> ir.Body:
            return map_body(statements, lambda one: _whole(inside(one, body), editor))

        return edit_bodies(routine, body)

    return edit_routines(program, context, work)


def _whole(statement: ir.Statement, editor: Editor) -> ir.Body:
    match statement:
        case ir.Assign(target=ir.Field(base=ir.System() as setting, name=name), value=value):
            type = editor.type_of(setting)
            if type is None:
                return (statement,)
            kept = editor.temporary("setting", type)
            steps = (
                ir.Assign(kept, setting),
                ir.Assign(ir.Field(kept, name), value),
                ir.Assign(setting, kept),
            )
            return expansion(statement.origin, steps)
        case ir.Assign(target=ir.System() as setting, value=ir.Aggregate(entries=entries) as value):
            type = editor.type_of(setting)
            if not isinstance(type, ir.PoseType) or all(_fixed(one, editor) for _, one in entries):
                return (statement,)
            kept = editor.temporary("setting", type)
            return expansion(statement.origin, (ir.Assign(kept, value), ir.Assign(setting, kept)))
    return (statement,)


def _fixed(value: ir.Expression, editor: Editor) -> bool:
    """Is it the same in every run?"""
    if isinstance(value, ir.Aggregate):
        return all(_fixed(one, editor) for _, one in value.entries)
    return constant(value, editor.scope) is not None

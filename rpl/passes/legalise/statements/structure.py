"""Labels and jumps as structure, for targets that have neither (and NextPass for those without it)."""

from __future__ import annotations

from dataclasses import replace

from rpl import ir
from rpl.passes.legalise.context import Context
from rpl.passes.legalise.rewriting.editing import Editor, edit_bodies, edit_routines
from rpl.passes.legalise.rewriting.structuring.structured import restructured
from rpl.passes.legalise.stages import legalising


@legalising(unless=lambda context: {"Goto", "Label"} <= context.capabilities.statements)
def labels_to_structure(program: ir.Program, context: Context) -> ir.Program:
    """The program without jumps, unless the target has them."""

    def work(editor: Editor, routine: ir.Routine) -> ir.Routine:
        plain = routine.returns is None and routine.kind != "function"
        body = restructured(editor, routine.body, bool(routine.handlers), plain)
        others = edit_bodies(replace(routine, body=()), lambda other: restructured(editor, other, False, False))
        return replace(others, body=body)

    return edit_routines(program, context, work)


__all__ = ["labels_to_structure"]

"""Numbers with a fraction shown in texts: some languages show a count of decimals, others six digits in all. For most
numbers it is the same; where it can differ, that is said.
"""

from __future__ import annotations

from rpl import ir
from rpl.diagnostics import Severity, code
from rpl.ir.walk import walk
from rpl.passes.legalise.context import Context
from rpl.passes.legalise.rewriting.editing import Editor, edit_routines
from rpl.passes.legalise.stages import legalising
from rpl.passes.scope import rules_of

OTHER_DIGITS = code(
    "digits-in-texts",
    Severity.WARNING,
    "a number in a text has {theirs} in the source and {ours} in the target",
    "numbers with more digits show other texts",
)


@legalising(
    unless=lambda context: (
        context.capabilities.carries_rules
        or rules_of(context.source).text_decimals == rules_of(context.target).text_decimals
    )
)
def text_decimals(program: ir.Program, context: Context) -> ir.Program:
    """The program as it is, after a report at each number with a fraction that a text shows."""
    theirs, ours = rules_of(context.source).text_decimals, rules_of(context.target).text_decimals

    def look(editor: Editor, routine: ir.Routine) -> ir.Routine:
        for node in walk(routine):
            match node:
                case ir.Builtin(function="value_text", arguments=(value,)):
                    if isinstance(editor.type_of(value), ir.RealType):
                        shown = {"theirs": _count(theirs), "ours": _count(ours)}
                        context.diagnostics.report(OTHER_DIGITS, routine.origin, **shown)
                        break
        return routine

    return edit_routines(program, context, look)


def _count(decimals: int) -> str:
    return f"up to {decimals} decimals" if decimals else "six digits"


__all__ = ["text_decimals"]

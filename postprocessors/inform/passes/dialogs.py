"""Questions to the operator for targets that only ask for a number: the question is a message in front of it.

Keys become their numbers, which the message tells. What is typed as a text, and questions that end by time, stay and
are refused by the writer.
"""

from __future__ import annotations

from dataclasses import replace

from rpl import ir
from rpl.diagnostics import Severity, code
from rpl.passes.legalise.context import Context
from rpl.passes.legalise.rewriting.editing import edit_all, map_body
from rpl.passes.legalise.rewriting.jumps import inside
from rpl.passes.legalise.stages import legalising

KEYS = code(
    "keys-as-number",
    Severity.WARNING,
    "the operator types the number of the key that the message tells; nothing keeps others away",
)
BY_TEXT = code(
    "text-question-lost", Severity.LOSS, "the target's programs ask the operator for numbers only", stops=True
)
BY_TIME = code(
    "timed-question-lost", Severity.LOSS, "a question of the target's programs does not end by time", stops=True
)


@legalising(sees=("Dialog",))
def number_dialogs(program: ir.Program, context: Context) -> ir.Program:
    """Questions to the operator, who can type a number and nothing else."""

    def change(statement: ir.Statement) -> ir.Body:
        if isinstance(statement, ir.Dialog) and statement.text != ir.TextLiteral(""):
            if statement.timeout is not None or statement.timed_out is not None:
                context.diagnostics.report(BY_TIME, statement.origin)
            elif statement.kind == "text":
                context.diagnostics.report(BY_TEXT, statement.origin)
            else:
                return _asked(statement, context)
        return (inside(statement, lambda inner: map_body(inner, change)),)

    return edit_all(program, lambda body: map_body(body, change))


def _asked(dialog: ir.Dialog, context: Context) -> ir.Body:
    """The question as messages, then the number."""
    question = dialog.text
    if dialog.sender is not None and dialog.sender != ir.TextLiteral(""):
        question = _joined(_joined(dialog.sender, ir.TextLiteral(": ")), question)
    if dialog.kind == "keys":
        context.diagnostics.report(KEYS, dialog.origin)
        for number, key in enumerate(dialog.keys, 1):
            if key is not None:
                question = _joined(question, _joined(ir.TextLiteral(f" {number}="), key))
    later = replace(dialog.origin, comments=())
    empty = ir.TextLiteral("")
    return (
        ir.Message("notify", question, origin=dialog.origin),
        replace(dialog, text=empty, keys=(), kind="number", sender=None, origin=later),
    )


def _joined(one: ir.Expression, other: ir.Expression) -> ir.Expression:
    if isinstance(one, ir.TextLiteral) and isinstance(other, ir.TextLiteral):
        return ir.TextLiteral(one.value + other.value)
    if isinstance(one, ir.Binary) and one.op == "&" and isinstance(one.right, ir.TextLiteral):
        return ir.Binary("&", one.left, _joined(one.right, other))
    return ir.Binary("&", one, other)

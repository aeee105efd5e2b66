"""Numbers read from a text that may go on behind them (V+ VAL): elsewhere such a text is an error, which is said."""

from __future__ import annotations

from rpl import ir
from rpl.diagnostics import Severity, code
from rpl.ir.walk import walk
from rpl.passes.legalise.context import Context
from rpl.passes.scope import rules_of

NUMBER_ONLY = code(
    "text-behind-number",
    Severity.WARNING,
    "where a text goes on behind its number, only the source takes the number; the target stops there",
)


def leading_numbers(program: ir.Program, context: Context) -> ir.Program:
    """The program as it is, after a report where the target reads texts that only hold a number."""
    can = context.capabilities
    if can.leading_numbers or can.carries_rules or not rules_of(context.source).leading_numbers:
        return program
    for node in walk(*program.modules):
        match node:
            case ir.Builtin(function="text_value", arguments=(text,)) if not isinstance(text, ir.TextLiteral):
                context.diagnostics.report(NUMBER_ONLY, node.origin)
                break
    return program


__all__ = ["leading_numbers"]

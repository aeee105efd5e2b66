"""Values that the target's programs cannot ask for or work out."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import get_args

from rpl import ir
from rpl.diagnostics import Severity, code
from rpl.passes.legalise.facts.usage import each_expression
from rpl.passes.legalise.refusals.rows import PLAINLY, Asked, Found, Refusal

__all__ = ["VALUES"]

RANDOM = code(
    "random-numbers-lost",
    Severity.LOSS,
    "the target has no random numbers",
    "take the numbers from a table of the program, or from a signal",
    stops=True,
)
USED = code(
    "record-in-use-lost",
    Severity.LOSS,
    "the target cannot give the {what} in use as a record",
    "use the data that the program has set as {what}",
    stops=True,
)
PAYLOAD = code(
    "payload-question-lost",
    Severity.LOSS,
    "the target's programs cannot ask for the payload in use",
    "keep it in variables where it is set",
    stops=True,
)
_IN_USE = {"current_tool": "tool", "current_frame": "work object"}
_LOAD = ir.System("load")


def _lacking(*functions: str) -> Callable[[ir.Statement, Asked], Found]:
    """Functions that a statement asks for and the target has not."""

    def refused(statement: ir.Statement, asked: Asked) -> Found:
        missing, found = set(functions) - asked.can.functions, list[Mapping[str, object]]()

        def look(expression: ir.Expression) -> None:
            if isinstance(expression, ir.Builtin) and expression.function in missing:
                found.append({"function": expression.function})

        if missing:
            each_expression(statement, look)
        return tuple(found[:1])

    return refused


def _in_use(statement: ir.Assign, asked: Asked) -> Found:
    """The tool or work object in use as a whole."""
    match statement.value:
        case ir.Builtin(function=function, arguments=()) if function in _IN_USE.keys() - asked.can.functions:
            return ({"what": _IN_USE[function]},)
    return ()


def _payload(statement: ir.Statement, asked: Asked) -> Found:
    """Parts of the payload that are asked for."""
    if _LOAD.name in asked.can.system_variables:
        return ()
    found: list[ir.Expression] = []

    def look(expression: ir.Expression) -> None:
        if isinstance(expression, ir.Field) and expression.base == _LOAD:
            found.append(expression)

    each_expression(statement, look)
    return PLAINLY if found else ()


VALUES = (
    Refusal("random numbers", RANDOM, get_args(ir.Statement), _lacking("random")),
    Refusal("the tool or work object in use as a record", USED, (ir.Assign,), _in_use, left=False),
    Refusal("the payload in use", PAYLOAD, get_args(ir.Statement), _payload),
)

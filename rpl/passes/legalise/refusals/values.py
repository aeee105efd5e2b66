"""Values that the target's programs cannot ask for or work out."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import get_args

from rpl import ir
from rpl.diagnostics import Severity, code
from rpl.passes.legalise.facts.usage import each_expression
from rpl.passes.legalise.refusals.rows import Asked, Found, Refusal

__all__ = ["VALUES"]

RANDOM = code(
    "random-numbers-lost",
    Severity.LOSS,
    "the target has no random numbers",
    "take the numbers from a table of the program, or from a signal",
    stops=True,
)


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


VALUES = (Refusal("random numbers", RANDOM, get_args(ir.Statement), _lacking("random")),)

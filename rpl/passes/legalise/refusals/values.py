"""Values that the target's programs cannot ask for or work out."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import get_args

from rpl import ir
from rpl.diagnostics import Severity, code
from rpl.passes.capabilities import DataRule, TextRule
from rpl.passes.legalise.facts.usage import each_expression
from rpl.passes.legalise.refusals.rows import PLAINLY, Asked, Found, Refusal
from rpl.passes.typewords import component_names
from rpl.passes.typing import type_of

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
COMPARED = code(
    "record-comparison-lost",
    Severity.LOSS,
    "the target compares numbers, texts and truths, not {what} as a whole",
    "compare the components that matter, places by how far they are apart",
    stops=True,
)
ORDER = code(
    "text-order-lost",
    Severity.LOSS,
    "the target's programs cannot tell which of two texts stands in front of the other in this order",
    "compare numbers in place of the texts, or let the program that sends them say their order",
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
            each_expression(statement, look, kinds={f"function {one}" for one in missing})
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

    each_expression(statement, look, kinds={"system load"})
    return PLAINLY if found else ()


def _compared(statement: ir.Statement, asked: Asked) -> Found:
    """Whole records, places and joints that are compared."""
    found: list[Mapping[str, object]] = []

    def look(expression: ir.Expression) -> None:
        match expression:
            case ir.Binary(op="=" | "<>", left=left, right=right):
                found.extend({"what": what} for side in (left, right) if (what := _record(side, asked)))

    if DataRule.COMPARED_RECORDS not in asked.can.data.rules and not asked.can.carries_rules:
        each_expression(statement, look, kinds={"operator =", "operator <>"})
    return tuple(found[:1])


def _before(statement: ir.Statement, asked: Asked) -> Found:
    """Texts of which one has to stand in front of the other."""
    found: list[ir.Expression] = []

    def look(expression: ir.Expression) -> None:
        match expression:
            case ir.Binary(op="<" | "<=" | ">" | ">=", left=left):
                if isinstance(type_of(left, asked.scope), ir.StringType):
                    found.append(expression)

    if TextRule.ORDER not in asked.can.texts.rules and not asked.can.carries_rules:
        each_expression(statement, look, kinds={f"operator {one}" for one in ("<", "<=", ">", ">=")})
    return PLAINLY if found else ()


def _record(side: ir.Expression, asked: Asked) -> str:
    """What is compared where it has components; nothing of a number, a text, a truth or a pose."""
    type = type_of(side, asked.scope)
    names = component_names(type, asked.scope) if type is not None else ()
    match type:
        case ir.NamedType(name=name) if names:
            return name
        case ir.TargetType() if "trans" in names:
            return "places"
        case ir.JointsType() | ir.AxesType() if "robax" in names or isinstance(type, ir.AxesType):
            return "joints"
    return ""


VALUES = (
    Refusal("random numbers", RANDOM, get_args(ir.Statement), _lacking("random")),
    Refusal("texts in a given order of characters", ORDER, get_args(ir.Statement), _lacking("text_order")),
    Refusal("texts compared by their order", ORDER, get_args(ir.Statement), _before, left=False),
    Refusal("the tool or work object in use as a record", USED, (ir.Assign,), _in_use, left=False),
    Refusal("the payload in use", PAYLOAD, get_args(ir.Statement), _payload),
    Refusal(
        "records, places and joints that are compared as a whole", COMPARED, get_args(ir.Statement), _compared, False
    ),
)

"""`$a = $DECODE($text, $separators, mode)`: cut the head off a text. One step of V+ becomes several neutral ones.

Mode 0 (or below, or left out) takes what stands in front of the first separator, 1 (or above) the separators
there (M: the usual idiom takes a word and then its separators, until nothing is left). Inside of an expression it is
done in front of the statement (`in_front`).
"""

from __future__ import annotations

from typing import cast

from rpl import ir
from rpl.reading.pieces import Element, Open
from rpl.reading.shapes import StatementError, SyntaxTree
from rpl.source import Origin

from . import tables
from .expressions import root_name

Lowered = Element | tuple[Element, ...]
# Marks of jumps that leave several loops: word and count, as no label of V+ can be written.
LEAVE_MARK = "{word}:{count}"
# Statements that look at their values once, when they are reached.
_ONCE = frozenset(
    (
        "assign",
        "set",
        "call_routine",
        "call_computed",
        "call_element",
        "call_text",
        "if_open",
        "if_goto",
        "case_open",
        "for_open",
    )
) | {
    "type_",
    "write",
    "instruction",
    "bracketed",
    "setting",
}


def in_front(tree: SyntaxTree, lowered: Lowered, steps: ir.Body, origin: Origin) -> Lowered:
    """A statement behind the `steps` that its values need; the condition of WHILE is looked at in each pass."""
    kind = str(tree.data)
    elements = lowered if isinstance(lowered, tuple) else (lowered,)
    if kind == "while_open" and isinstance(lowered, Open):
        over = ir.Unary("not", cast(ir.Expression, lowered.data), origin=origin)
        leave = ir.Goto(LEAVE_MARK.format(word="exit", count=1), origin=origin)
        forever = Open(lowered.kind, ir.BoolLiteral(True), lowered.origin)
        return forever, *steps, ir.If(((over, (leave,)),), origin=origin)
    if kind == "instruction" and len(elements) == 1 and isinstance(elements[0], ir.WaitUntil):
        met = ir.If(((elements[0].condition, (ir.ExitLoop(origin=origin),)),), origin=origin)
        again = ir.Wait(ir.RealLiteral(tables.CYCLE_S), origin=origin)
        return (ir.While(ir.BoolLiteral(True), (*steps, met, again), origin=origin),)
    if kind not in _ONCE or str(tree.children[0]).lower() == "wait":
        raise StatementError("$DECODE cannot stand in a condition that is looked at again and again", 0)
    return *steps, *elements


def decoded(target: ir.Expression, values: list[ir.Expression | None], origin: Origin) -> tuple[ir.Statement, ...]:
    """The statements of one such assignment."""
    text, separators = [*values, None, None][:2]
    mode = values[2] if len(values) > 2 else None
    if text is None or separators is None or root_name(text) is None:
        raise StatementError("$DECODE needs a text variable and its separators", 0)
    if text == target:
        raise StatementError("$DECODE cannot store into the text that it cuts", 0)
    match mode:
        case None | ir.Unary(op="-", operand=ir.IntLiteral()):
            return _word(target, text, separators, origin)
        case ir.IntLiteral(value=number):
            return (_separators if number > 0 else _word)(target, text, separators, origin)
    positive = ir.Binary(">", mode, ir.IntLiteral(0), origin=origin)
    either = _separators(target, text, separators, origin)
    return (ir.If(((positive, either),), _word(target, text, separators, origin), origin=origin),)


def _function(name: str, origin: Origin, *arguments: ir.Expression) -> ir.Builtin:
    return ir.Builtin(name, arguments, origin=origin)


def _rest(text: ir.Expression, first: ir.Expression, taken: ir.Expression, origin: Origin) -> ir.Expression:
    """The text from a position to its end; `first` is one more than what is `taken` off."""
    left = ir.Binary("-", _function("text_length", origin, text), taken, origin=origin)
    return _function("text_part", origin, text, first, left)


def _word(
    target: ir.Expression, text: ir.Expression, separators: ir.Expression, origin: Origin
) -> tuple[ir.Statement, ...]:
    found = _function("text_find_any", origin, text, ir.IntLiteral(1), separators)
    count = ir.Binary("-", found, ir.IntLiteral(1), origin=origin)
    taken = _function("text_length", origin, target)
    after = ir.Binary("+", taken, ir.IntLiteral(1), origin=origin)
    return (
        ir.Assign(target, _function("text_part", origin, text, ir.IntLiteral(1), count), origin=origin),
        ir.Assign(text, _rest(text, after, taken, origin), origin=origin),
    )


def _separators(
    target: ir.Expression, text: ir.Expression, separators: ir.Expression, origin: Origin
) -> tuple[ir.Statement, ...]:
    one = ir.IntLiteral(1)
    any_left = ir.Binary(">", _function("text_length", origin, text), ir.IntLiteral(0), origin=origin)
    first = _function("text_part", origin, text, one, one)
    is_separator = ir.Binary(
        ">", _function("text_find", origin, separators, one, first), ir.IntLiteral(0), origin=origin
    )
    body: ir.Body = (
        ir.Assign(target, ir.Binary("&", target, first, origin=origin), origin=origin),
        ir.Assign(text, _rest(text, ir.IntLiteral(2), one, origin), origin=origin),
    )
    condition = ir.Binary("cand", any_left, is_separator, origin=origin)
    return (
        ir.Assign(target, ir.TextLiteral(""), origin=origin),
        ir.While(condition, body, origin=origin),
    )

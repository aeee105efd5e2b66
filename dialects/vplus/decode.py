"""`$a = $DECODE($text, $separators, mode)`: cut the head off a text. One step of V+ becomes several neutral ones.

Mode 0 (or left out) takes everything in front of the first separator, mode 1 the separators that stand in front (M: the
usual idiom takes a word and then its separators, until nothing is left). Inside of an expression it is done in front of
the statement (`in_front`).
"""

from __future__ import annotations

from typing import cast

from rpl import ir
from rpl.reading.pieces import Element, Open
from rpl.reading.shapes import StatementError, SyntaxTree
from rpl.source import Origin

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
    if mode is None or mode == ir.IntLiteral(0):
        return _word(target, text, separators, origin)
    if mode == ir.IntLiteral(1):
        return _separators(target, text, separators, origin)
    raise StatementError("the mode of $DECODE must be 0 or 1", 0)


def _function(name: str, origin: Origin, *arguments: ir.Expression) -> ir.Builtin:
    return ir.Builtin(name, arguments, origin=origin)


def _rest(text: ir.Expression, first: ir.Expression, origin: Origin) -> ir.Expression:
    """The text from a position to its end; `first` is one more than what is taken off."""
    length = _function("text_length", origin, text)
    left = ir.Binary("+", ir.Binary("-", length, first, origin=origin), ir.IntLiteral(1), origin=origin)
    return _function("text_part", origin, text, first, left)


def _word(
    target: ir.Expression, text: ir.Expression, separators: ir.Expression, origin: Origin
) -> tuple[ir.Statement, ...]:
    found = _function("text_find_any", origin, text, ir.IntLiteral(1), separators)
    count = ir.Binary("-", found, ir.IntLiteral(1), origin=origin)
    after = ir.Binary("+", _function("text_length", origin, target), ir.IntLiteral(1), origin=origin)
    return (
        ir.Assign(target, _function("text_part", origin, text, ir.IntLiteral(1), count), origin=origin),
        ir.Assign(text, _rest(text, after, origin), origin=origin),
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
        ir.Assign(text, _rest(text, ir.IntLiteral(2), origin), origin=origin),
    )
    condition = ir.Binary("cand", any_left, is_separator, origin=origin)
    return (
        ir.Assign(target, ir.TextLiteral(""), origin=origin),
        ir.While(condition, body, origin=origin),
    )

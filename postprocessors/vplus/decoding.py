"""$DECODE: the steps into which the reader takes it apart become one step again."""

from __future__ import annotations

from rpl import ir

from .expressions import Expressions


def decoded(body: ir.Body, expressions: Expressions) -> tuple[str, int] | None:
    """`$head = $DECODE($text, $separators, mode)` and how many statements that is; None: something else."""
    match body[:2]:
        case (
            ir.Assign(target=head, value=ir.Builtin(function="text_part", arguments=(text, first, count))),
            ir.Assign(target=rest, value=ir.Builtin(function="text_part", arguments=(whole, after, _))),
        ) if text == rest == whole and expressions.known(first) == 1:
            behind = ir.Binary("+", ir.Builtin("text_length", (head,)), ir.IntLiteral(1))
            separators = _before_any(count, text, expressions)
            if separators is not None and after == behind:
                return _step(head, text, separators, 0, expressions)
        case (
            ir.Assign(target=head, value=ir.TextLiteral(value="")),
            ir.While(
                condition=ir.Binary(
                    op="cand", right=ir.Binary(op=">", left=ir.Builtin(arguments=(separators, _, one)))
                ),
                body=(ir.Assign(target=grown, value=ir.Binary(op="&", right=added)), ir.Assign(target=text)),
            ),
        ) if head == grown and one == added == _first(text):
            return _step(head, text, separators, 1, expressions)
    return None


def _first(text: ir.Expression) -> ir.Expression:
    return ir.Builtin("text_part", (text, ir.IntLiteral(1), ir.IntLiteral(1)))


def _before_any(count: ir.Expression, text: ir.Expression, expressions: Expressions) -> ir.Expression | None:
    """The separators, where the count is that of the signs in front of the first of them."""
    match count:
        case ir.Binary(
            op="-", left=ir.Builtin(function="text_find_any", arguments=(place, start, separators)), right=one
        ) if place == text and expressions.known(start) == 1 and expressions.known(one) == 1:
            return separators
    return None


def _step(
    head: ir.Expression, text: ir.Expression, separators: ir.Expression, mode: int, expressions: Expressions
) -> tuple[str, int]:
    written = expressions.text
    return f"{written(head)} = $DECODE({written(text)}, {written(separators)}, {mode})", 2

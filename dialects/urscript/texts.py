"""Texts: what is made of values, and parts of texts. URScript counts characters from 0, the IR from 1."""

from __future__ import annotations

from collections.abc import Callable

from rpl import ir
from rpl.ir.walk import walk

from . import nodes
from .arguments import Bound, given, written
from .expressions import Expressions
from .kinds import BOOL, INT
from .nodes import Expr
from .rules import RULES

_MOST_SHOWN = 32


def as_text(reader: Expressions, value: Expr) -> ir.Expression:
    """Any value as the text the controller makes of it."""
    kind = reader.kind(value)
    if kind is not None and kind.word == "text":
        return reader.value(value)
    if kind == BOOL:
        return _truth(reader.value(value, BOOL))
    count = 6 if kind is not None and kind.word == "pose" else kind.length if kind is not None else None
    if kind is not None and kind.word in ("pose", "list") and count is not None and count <= _MOST_SHOWN:
        listed = _listed(reader, value, count)
        if listed is not None:
            return ir.Binary("&", ir.TextLiteral("p["), listed) if kind.word == "pose" else _joined("[", listed)
    return _number(reader.array(value))


def _number(value: ir.Expression) -> ir.Expression:
    """A number that is written out is the text at once: with six decimals, without zeros at the end."""
    match value:
        case ir.IntLiteral(value=whole):
            return ir.TextLiteral(str(whole))
        case ir.Unary(op="-", operand=ir.IntLiteral(value=whole)):
            return ir.TextLiteral(str(-whole))
        case ir.RealLiteral(value=number):
            text = f"{number:.{RULES.text_decimals}f}".rstrip("0").rstrip(".")
            return ir.TextLiteral("0" if text == "-0" else text)
    return ir.Builtin("value_text", (value,))


def _truth(value: ir.Expression) -> ir.Expression:
    if isinstance(value, ir.BoolLiteral):
        return ir.TextLiteral("True" if value.value else "False")
    words = ir.Aggregate(((None, ir.TextLiteral("False")), (None, ir.TextLiteral("True"))))
    return ir.Index(words, (ir.Convert("bit", value),))


def _joined(start: str, rest: ir.Expression) -> ir.Expression:
    return ir.Binary("&", ir.TextLiteral(start), rest)


def _listed(reader: Expressions, value: Expr, count: int) -> ir.Expression | None:
    """The parts of a pose or a list with commas between them, and the bracket behind."""
    kind = reader.kind(value)
    inner = kind.element if kind is not None else None
    if inner is not None and inner.word not in ("bool", "int", "real", "text"):
        return None
    done: ir.Expression | None = None
    for place in range(count):
        part = reader.element(value, place)
        if part is None:
            return None
        shown = _part_shown(part, inner is not None and inner.word == "text", inner == BOOL)
        done = shown if done is None else ir.Binary("&", ir.Binary("&", done, ir.TextLiteral(", ")), shown)
    close = ir.TextLiteral("]")
    return ir.Binary("&", done, close) if done is not None else close


def _part_shown(part: ir.Expression, is_text: bool, is_truth: bool) -> ir.Expression:
    if is_text:
        return part
    return _truth(part) if is_truth else _number(part)


def _cat(reader: Expressions, bound: Bound) -> ir.Expression:
    return ir.Binary("&", as_text(reader, written(bound, "op1")), as_text(reader, written(bound, "op2")))


def _shown(reader: Expressions, bound: Bound) -> ir.Expression:
    return as_text(reader, written(bound, "val"))


def _character(reader: Expressions, bound: Bound) -> ir.Expression:
    place = one_more(given(reader, bound, "index", INT))
    return ir.Builtin("text_part", (given(reader, bound, "src"), place, ir.IntLiteral(1)))


def one_more(number: ir.Expression) -> ir.Expression:
    """URScript counts characters from 0, the IR from 1."""
    if isinstance(number, ir.IntLiteral):
        return ir.IntLiteral(number.value + 1)
    return ir.Binary("+", number, ir.IntLiteral(1))


def _part(reader: Expressions, bound: Bound) -> ir.Expression:
    """str_sub: a length of -1 means up to the end; a longer one takes what there is."""
    text, start = given(reader, bound, "src"), given(reader, bound, "index", INT)
    rest: ir.Expression = ir.Binary("-", ir.Builtin("text_length", (text,)), start)
    match text, start:
        case ir.TextLiteral(value=written_out), ir.IntLiteral(value=first):
            rest = ir.IntLiteral(max(len(written_out) - first, 0))
        case _, ir.IntLiteral(value=0):
            rest = ir.Builtin("text_length", (text,))
    if isinstance(bound["len"], nodes.Sign):
        return ir.Builtin("text_part", (text, one_more(start), rest))
    length = given(reader, bound, "len", INT)
    match length, rest:
        case ir.IntLiteral(value=count), ir.IntLiteral(value=most):
            length = ir.IntLiteral(min(count, most))
        case ir.IntLiteral(value=0 | 1), _:
            pass
        case _ if not _measured(length):
            length = ir.Builtin("min", (length, rest))
    return ir.Builtin("text_part", (text, one_more(start), length))


def _measured(length: ir.Expression) -> bool:
    """A length that comes from what was found in a text, or from its length, stays inside of it."""
    known = ("text_find", "text_length")
    return any(isinstance(node, ir.Builtin) and node.function in known for node in walk((length,)))


def _find(reader: Expressions, bound: Bound) -> ir.Expression:
    place = one_more(given(reader, bound, "start_from", INT))
    found = ir.Builtin("text_find", (given(reader, bound, "src"), place, given(reader, bound, "target")))
    return ir.Binary("-", found, ir.IntLiteral(1))


def _empty(reader: Expressions, bound: Bound) -> ir.Expression:
    return ir.Binary("=", ir.Builtin("text_length", (given(reader, bound, "str"),)), ir.IntLiteral(0))


def _read(reader: Expressions, bound: Bound) -> ir.Expression:
    """to_num; of a written-out number to base 16 the number at once."""
    text = written(bound, "str")
    plain = text.value.strip().lower() if isinstance(text, nodes.Text) else ""
    if plain.startswith("0x") and set(plain[2:]) <= set("0123456789abcdef") and len(plain) > 2:
        return ir.RealLiteral(float(int(plain, 16)))
    return ir.Builtin("text_value", (reader.value(text),))


def _plain(function: str) -> Callable[[Expressions, Bound], ir.Expression]:
    return lambda reader, bound: ir.Builtin(function, (given(reader, bound, "str"),))


TEXTS: dict[str, Callable[[Expressions, Bound], ir.Expression | None]] = {
    "str_at": _character,
    "str_cat": _cat,
    "str_empty": _empty,
    "str_find": _find,
    "str_len": _plain("text_length"),
    "str_sub": _part,
    "to_num": _read,
    "to_str": _shown,
}

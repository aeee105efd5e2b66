"""Expressions and types of RPL: parse tree to IR."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from typing import TypeVar

from lark import Token, Tree

from rpl import ir
from rpl.ir import words
from rpl.reading.shapes import Slot, StatementError, SyntaxTree, real_number
from rpl.source import Origin

from .affixes import Affixing

Child = Token | Slot | SyntaxTree
_ByName = TypeVar("_ByName")

_BINARY = {
    "or": "or",
    "or else": "cor",
    "xor": "xor",
    "and": "and",
    "and then": "cand",
}


@dataclass(frozen=True, slots=True)
class Reading:
    """What lowering one statement needs: the spellings of its numbers, where it stands, and the lists that take the
    frames declared to hang on others and the statements that affix frames while the program runs."""

    numbers: tuple[str, ...]
    origin: Origin
    affixed: list[tuple[str, ir.Expression, Origin]] = field(default_factory=list)
    affixing: list[Affixing] = field(default_factory=list)

    def integer(self, child: Child) -> int:
        text = self.spelling(child)
        return int(text, 0) if text[:2].lower() in ("0x", "0b") else int(text)

    def spelling(self, child: Child) -> str:
        if isinstance(child, Slot):
            return self.numbers[child.index]
        return str(child)


def trees(tree: SyntaxTree) -> Iterator[SyntaxTree]:
    """The sub-trees among the children."""
    return iter([child for child in tree.children if isinstance(child, Tree)])


def tokens(tree: SyntaxTree, *kinds: str) -> Iterator[Token]:
    """The tokens of these terminals among the children."""
    return (child for child in tree.children if isinstance(child, Token) and child.type in kinds)


def names(tree: SyntaxTree) -> list[str]:
    """The names among the children, in order."""
    return [name_of(token) for token in tokens(tree, "NAME", "QUOTED")]


def name_of(token: Token) -> str:
    return words.disclose(token) if token.type == "QUOTED" else str(token)


def wording(token: Token) -> str:
    """A keyword in lower case with single blanks."""
    return " ".join(token.lower().split())


def named(table: dict[str, _ByName], word: str) -> _ByName | None:
    """Look up a bare word without regard to case."""
    return table.get(word.lower())


def expression(tree: SyntaxTree, at: Reading) -> ir.Expression:
    """Lower one expression tree. Raises StatementError for what the grammar cannot exclude."""
    return _EXPRESSIONS[tree.data](tree, at)


def first(tree: SyntaxTree, at: Reading) -> ir.Expression:
    """The first sub-tree as an expression."""
    for child in tree.children:
        if isinstance(child, Tree):
            return _EXPRESSIONS[child.data](child, at)
    raise StatementError("an expression is needed here", 0)


def _int(tree: SyntaxTree, at: Reading) -> ir.Expression:
    text = at.spelling(tree.children[0])
    if text.isdecimal():
        return ir.IntLiteral(int(text), origin=at.origin)
    return ir.IntLiteral(int(text, 0), text, origin=at.origin)


def _real(tree: SyntaxTree, at: Reading) -> ir.Expression:
    text = at.spelling(tree.children[0])
    return ir.RealLiteral(real_number(text), text, origin=at.origin)


def _negative(tree: SyntaxTree, at: Reading) -> ir.Expression:
    number = tree.children[1]
    text = at.spelling(number)
    if text.isdigit() or text[:2].lower() in ("0x", "0b"):
        return ir.IntLiteral(-at.integer(number), origin=at.origin)
    return ir.RealLiteral(-real_number(text), origin=at.origin)


def _token(tree: SyntaxTree) -> Token:
    token = tree.children[0]
    if not isinstance(token, Token):
        raise StatementError("a word is needed here", 0)
    return token


def _text(tree: SyntaxTree, at: Reading) -> ir.Expression:
    return ir.TextLiteral(words.disclose(_token(tree)), origin=at.origin)


def _enum(tree: SyntaxTree, at: Reading) -> ir.Expression:
    member = _token(tree)[1:]
    return ir.EnumLiteral(words.disclose(member) if member.startswith("`") else member, origin=at.origin)


def _system(tree: SyntaxTree, at: Reading) -> ir.Expression:
    token = _token(tree)
    name = token[1:].lower()
    if name not in ir.SYSTEM_VARIABLES:
        raise StatementError(f"there is no system variable {token}", token.start_pos or 0)
    return ir.System(name, origin=at.origin)


def _name(tree: SyntaxTree, at: Reading) -> ir.Expression:
    return ir.Name(name_of(_token(tree)), origin=at.origin)


def _group(tree: SyntaxTree, at: Reading) -> ir.Expression:
    return first(tree, at)


def _field(tree: SyntaxTree, at: Reading) -> ir.Expression:
    return ir.Field(first(tree, at), names(tree)[0], origin=at.origin)


def _index(tree: SyntaxTree, at: Reading) -> ir.Expression:
    base, *indices = trees(tree)
    lowered = tuple(expression(index, at) for index in indices)
    kind = _signal_kind(base)
    if kind is not None:
        if len(lowered) > 1:
            raise StatementError("a signal has one number", 0)
        return ir.Signal(kind, lowered[0], origin=at.origin)
    if base.data == "invoke" and (signal := expression(base, at)) and isinstance(signal, ir.Signal):
        return ir.Signal(signal.kind, lowered[0], name=signal.name, origin=at.origin)
    if base.data == "system":
        system = expression(base, at)
        if isinstance(system, ir.System):
            return ir.System(system.name, lowered, origin=at.origin)
    return ir.Index(expression(base, at), lowered, origin=at.origin)


def _range(tree: SyntaxTree, at: Reading) -> ir.Expression:
    base, low, high = trees(tree)
    first_bit, last_bit = expression(low, at), expression(high, at)
    kind = _signal_kind(base)
    if kind is not None:
        return ir.Signal(kind, first_bit, last_bit, origin=at.origin)
    if base.data == "invoke":
        signal = expression(base, at)
        if isinstance(signal, ir.Signal):
            return ir.Signal(signal.kind, first_bit, last_bit, signal.name, origin=at.origin)
    raise StatementError("only a group of signals is written with TO", 0)


def _signal_kind(base: SyntaxTree) -> str | None:
    """The kind of signal that a bare word before `[` or `(` names."""
    if base.data != "name":
        return None
    token = _token(base)
    return named(words.SIGNAL_WORDS, token) if token.type == "NAME" else None


def _binary(tree: SyntaxTree, at: Reading) -> ir.Expression:
    left, operator, right = tree.children
    if not isinstance(left, Tree) or not isinstance(right, Tree) or not isinstance(operator, Token):
        raise StatementError("an operation needs two operands", 0)
    word = wording(operator)
    return ir.Binary(_BINARY.get(word, word), expression(left, at), expression(right, at), origin=at.origin)


def _unary(tree: SyntaxTree, at: Reading) -> ir.Expression:
    return ir.Unary(wording(_token(tree)), first(tree, at), origin=at.origin)


def _quantity(tree: SyntaxTree, at: Reading) -> ir.Expression:
    return ir.Quantity(first(tree, at), _unit(tree), origin=at.origin)


def _magnitude(tree: SyntaxTree, at: Reading) -> ir.Expression:
    return ir.Magnitude(first(tree, at), _unit(tree), origin=at.origin)


def _unit(tree: SyntaxTree) -> str:
    return words.UNIT_WORDS[next(tokens(tree, "UNIT")).lower()]


def _aggregate(tree: SyntaxTree, at: Reading) -> ir.Expression:
    return ir.Aggregate(entries(tree, at), origin=at.origin)


def entries(tree: SyntaxTree, at: Reading) -> tuple[tuple[str | None, ir.Expression], ...]:
    """The entries of an aggregate."""
    done: list[tuple[str | None, ir.Expression]] = []
    for entry in tree.children:
        if not isinstance(entry, Tree):
            continue
        if entry.data == "keyed":
            key = _token(entry)[:-1].rstrip()
            done.append((words.disclose(key) if key.startswith("`") else key, first(entry, at)))
        elif entry.data == "unkeyed":
            done.append((None, first(entry, at)))
    return tuple(done)


def _typed_aggregate(tree: SyntaxTree, at: Reading) -> ir.Expression:
    head = expression(next(trees(tree)), at)
    match head:
        case ir.Name(id=name):
            type_name = name
        case ir.Field(base=ir.Name(id=name), name=notation):
            type_name = f"{name} {notation}"
        case _:
            raise StatementError("before `{` stands the name of a type", 0)
    return ir.Aggregate(entries(tree, at), type_name, origin=at.origin)


def _invoke(tree: SyntaxTree, at: Reading) -> ir.Expression:
    """A call; a bare word may name a built-in function, a conversion or a signal instead."""
    token = _token(tree)
    given = arguments(next(trees(tree)), at)
    word = token.lower() if token.type == "NAME" else ""
    if word not in words.FUNCTION_WORDS:
        return ir.Call(name_of(token), given, origin=at.origin)
    values = plain_values(given, word)
    if word in ir.FUNCTIONS or word in ir.PROCEDURES:
        return ir.Builtin(word, values, origin=at.origin)
    if len(values) != 1:
        raise StatementError(f"{word} takes one argument", 0)
    if word in words.CONVERSION_WORDS:
        return ir.Convert(words.CONVERSION_WORDS[word], values[0], origin=at.origin)
    inner = values[0]
    if not isinstance(inner, ir.Name):
        raise StatementError(f"{word} takes a name", 0)
    if word == words.PRESENT_WORD:
        return ir.Present(inner.id, origin=at.origin)
    return ir.Signal(words.SIGNAL_WORDS[word], name=inner.id, origin=at.origin)


def plain_values(given: tuple[ir.Argument, ...], word: str) -> tuple[ir.Expression, ...]:
    """Arguments of what takes plain values only."""
    values = tuple(argument.value for argument in given if argument.name is None and argument.if_present is None)
    if len(values) != len(given) or None in values:
        raise StatementError(f"{word} takes plain arguments; a routine of that name is written `{word}`", 0)
    return tuple(value for value in values if value is not None)


def arguments(tree: SyntaxTree, at: Reading) -> tuple[ir.Argument, ...]:
    """The arguments in brackets."""
    return tuple(argument(child, at) for child in trees(tree))


def argument(tree: SyntaxTree, at: Reading) -> ir.Argument:
    """One argument: by place, left out (`?`), by name, or a switch."""
    condition = next((names(child)[0] for child in trees(tree) if child.data == "if_present"), None)
    value = next((child for child in trees(tree) if child.data != "if_present"), None)
    lowered = None if value is None else expression(value, at)
    name = names(tree)[0] if tree.data in ("named", "switched") else None
    return ir.Argument(lowered, name, condition)


def lvalue(tree: SyntaxTree, at: Reading) -> ir.Expression:
    """Something that can be assigned to."""
    place = expression(tree, at)
    if not isinstance(place, ir.Name | ir.Index | ir.Field | ir.System | ir.Signal):
        raise StatementError("nothing can be assigned to this", 0)
    return place


def state(tree: SyntaxTree, at: Reading) -> ir.Expression:
    """A value that is switched to: ON and OFF are TRUE and FALSE."""
    if tree.data in ("on", "off"):
        return ir.BoolLiteral(tree.data == "on", origin=at.origin)
    return expression(tree, at)


def _constant(value: bool) -> Callable[[SyntaxTree, Reading], ir.Expression]:
    return lambda tree, at: ir.BoolLiteral(value, origin=at.origin)


def _vendor_value(tree: SyntaxTree, at: Reading) -> ir.Expression:
    dialect = names(tree)[0]
    text = words.disclose(next(tokens(tree, "TEXT")))
    return ir.VendorValue(dialect, text, type_of(next(trees(tree)), at), origin=at.origin)


_EXPRESSIONS: dict[str, Callable[[SyntaxTree, Reading], ir.Expression]] = {
    "int": _int,
    "real": _real,
    "negative": _negative,
    "text": _text,
    "true": _constant(True),
    "false": _constant(False),
    "enum_value": _enum,
    "system": _system,
    "name": _name,
    "group": _group,
    "field": _field,
    "index": _index,
    "range": _range,
    "binary": _binary,
    "unary": _unary,
    "quantity": _quantity,
    "magnitude": _magnitude,
    "aggregate": _aggregate,
    "typed_aggregate": _typed_aggregate,
    "invoke": _invoke,
    "vendor_value": _vendor_value,
}


# ---- types


def type_of(tree: SyntaxTree, at: Reading) -> ir.Type:
    """Lower a type."""
    return _TYPES[tree.data](tree, at)


def _plain_type(tree: SyntaxTree, at: Reading) -> ir.Type:
    token = _token(tree)
    word = token.lower()
    if token.type == "NAME":
        if word in words.TYPE_WORDS:
            return words.TYPE_WORDS[word]
        if word in words.NOTED_TYPE_WORDS:
            return _noted(word, words.NATIVE)
    return ir.NamedType(name_of(token))


def _noted(word: str, notation: str) -> ir.Type:
    return ir.TargetType(notation) if word == "target" else ir.ConfigType(notation)


def _notated_type(tree: SyntaxTree, at: Reading) -> ir.Type:
    token = _token(tree)
    if token.type != "NAME" or token.lower() not in words.NOTED_TYPE_WORDS:
        raise StatementError(f"only TARGET and CONFIGURATION have a notation, not {token}", token.start_pos or 0)
    return _noted(token.lower(), names(tree)[1])


def _sized_type(tree: SyntaxTree, at: Reading) -> ir.Type:
    token = _token(tree)
    if token.type != "NAME" or token.lower() != "string":
        raise StatementError("only STRING has a capacity; an array is ARRAY[...] OF ...", token.start_pos or 0)
    return ir.StringType(first(tree, at))


def _array_type(tree: SyntaxTree, at: Reading) -> ir.Type:
    *bounds, element = trees(tree)
    base = next((at.integer(child) for child in tree.children if isinstance(child, Slot)), 1)
    dimensions = tuple(None if bound.data == "open_bound" else expression(bound, at) for bound in bounds)
    return ir.ArrayType(type_of(element, at), dimensions, base)


def _signal_type(tree: SyntaxTree, at: Reading) -> ir.Type:
    return ir.SignalType(names(tree)[0])


def _vendor_type(tree: SyntaxTree, at: Reading) -> ir.Type:
    dialect, name = names(tree)
    return ir.VendorType(dialect, name)


def _bare_type(tree: SyntaxTree, at: Reading) -> ir.Type:
    inner = type_of(next(trees(tree)), at)
    match inner:
        case ir.TargetType(notation=notation):
            return ir.TargetType(notation, external=False)
        case ir.JointsType():
            return ir.JointsType(external=False)
    raise StatementError("only TARGET and JOINTS can be PLAIN (without external axes)", 0)


_TYPES: dict[str, Callable[[SyntaxTree, Reading], ir.Type]] = {
    "plain_type": _plain_type,
    "notated_type": _notated_type,
    "sized_type": _sized_type,
    "array_type": _array_type,
    "signal_type": _signal_type,
    "vendor_type": _vendor_type,
    "bare_type": _bare_type,
}

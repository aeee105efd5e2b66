"""Expressions, names and types as RPL writes them, with brackets only where precedence needs them."""

from __future__ import annotations

import re

from rpl import ir
from rpl.errors import InternalError
from rpl.ir import words
from rpl.writing.precedence import ExpressionPrinter, Operator, OperatorTable, Printed

SIGNED, POSTFIX, MEASURED = 100, 130, 120
_WORD_OPERATORS = ("or", "xor", "and", "bor", "bxor", "band", "div", "mod", "quo")
_LEVELS: dict[str, int] = {
    **dict.fromkeys(("or", "cor", "xor"), 10),
    **dict.fromkeys(("and", "cand"), 20),
    **dict.fromkeys(("=", "<>", "<", ">", "<=", ">="), 40),
    **dict.fromkeys(("bor", "bxor", "band"), 50),
    **dict.fromkeys(("+", "-", "&"), 60),
    **dict.fromkeys(("*", "/", "div", "mod", "quo", "@"), 70),
    ":": 80,
    "**": 110,
}
_SYMBOLS = {"cor": "OR ELSE", "cand": "AND THEN", **{word: word.upper() for word in _WORD_OPERATORS}}
_COMPARISONS = frozenset(("=", "<>", "<", ">", "<=", ">="))
_SIDES = {"**": "right", **dict.fromkeys(_COMPARISONS, "none")}
_BITS = frozenset(("bor", "bxor", "band"))
_LOGIC = frozenset(("or", "cor", "xor", "and", "cand"))
TABLE = OperatorTable(
    {op: Operator(_SYMBOLS.get(op, op), level, _SIDES.get(op, "left")) for op, level in _LEVELS.items()},
    mixed=(_BITS, _LOGIC),
    sign_anywhere=True,
)
_UNARY = {"not": ("NOT ", 30), "bnot": ("BNOT ", SIGNED), "-": ("-", SIGNED), "+": ("+", SIGNED)}
_SIGNAL_WORDS = {kind: word for word, kind in words.SIGNAL_WORDS.items()}
_CONVERSIONS = {how: word for word, how in words.CONVERSION_WORDS.items()}
_UNITS = {unit: word for word, unit in words.UNIT_WORDS.items()}
_INT = re.compile(r"0[xX][0-9A-Fa-f]+|0[bB][01]+")
_REAL = re.compile(r"\d+\.\d+(?:[eE][+-]?\d+)?|\d+[eE][+-]?\d+")
# Bare words that a name cannot look like, because they mean something else before a bracket.
_QUOTED_NAMES = words.RESERVED | frozenset(words.SIGNAL_WORDS)
_FOLDED_TYPES = frozenset((*words.TYPE_WORDS, *words.NOTED_TYPE_WORDS, "array", "string", "signal", "vendor", "plain"))


def name_text(name: str, taken: frozenset[str] = _QUOTED_NAMES) -> str:
    """A name, in backticks where it could not stand bare. `taken` in lower case."""
    if not words.is_bare(name) or name.casefold() in _QUOTED_NAMES or name.lower() in taken:
        return words.enclose(name, "`")
    return name


def function_name(name: str) -> str:
    """The name of a user's function before its brackets."""
    return name_text(name, words.FUNCTION_WORDS)


def procedure_name(name: str) -> str:
    """The name of a user's procedure before its brackets."""
    return name_text(name, words.PROCEDURE_WORDS)


def text_literal(text: str) -> str:
    return words.enclose(text, '"')


def _int_text(literal: ir.IntLiteral) -> str:
    if literal.value < 0:
        return f"({literal.value})"
    if literal.spelling and _INT.fullmatch(literal.spelling) and int(literal.spelling, 0) == literal.value:
        return literal.spelling
    return str(int(literal.value))


def _real_text(literal: ir.RealLiteral) -> str:
    if literal.value < 0:
        return f"({_plain_real(literal.value)})"
    if literal.spelling and _REAL.fullmatch(literal.spelling) and float(literal.spelling) == literal.value:
        return literal.spelling
    return _plain_real(literal.value)


def _plain_real(value: float) -> str:
    text = repr(abs(float(value)))
    if text == "inf":
        text = "1e999"  # reads back as infinity; RPL has no word for it
    return f"-{text}" if value < 0 else text


def _hook(node: ir.Expression, printer: ExpressionPrinter) -> str | Printed:
    match node:
        case ir.IntLiteral():
            return _int_text(node)
        case ir.RealLiteral():
            return _real_text(node)
        case ir.BoolLiteral(value=value):
            return "TRUE" if value else "FALSE"
        case ir.TextLiteral(value=value):
            return text_literal(value)
        case ir.EnumLiteral(member=member):
            return "#" + (member if words.is_bare(member) else words.enclose(member, "`"))
        case ir.Name(id=name):
            return name_text(name)
        case ir.Unary(op=op, operand=operand):
            return _unary(op, operand, printer)
        case ir.Field(base=base, name=name):
            return f"{_base(base, printer)}.{name if words.is_bare(name) else words.enclose(name, '`')}"
        case ir.Index(base=base, indices=indices):
            inner = _base(base, printer)
            if isinstance(base, ir.Signal | ir.System):
                inner = f"({inner})"
            return f"{inner}[{', '.join(printer.text(index) for index in indices)}]"
        case ir.Quantity(value=value, unit=unit):
            return Printed(f"{_base(value, printer)} {_UNITS[unit]}", MEASURED)
        case ir.Magnitude(value=value, unit=unit):
            return Printed(f"{_base(value, printer)} AS {_UNITS[unit]}", MEASURED)
    return _called(node, printer)


def _called(node: ir.Expression, printer: ExpressionPrinter) -> str:
    match node:
        case ir.Call(name=name, arguments=arguments):
            return f"{function_name(name)}({arguments_text(arguments)})"
        case ir.Builtin(function=function, arguments=values):
            return f"{function}({', '.join(printer.text(value) for value in values)})"
        case ir.Convert(how=how, operand=operand):
            return f"{_CONVERSIONS[how]}({printer.text(operand)})"
        case ir.Present(name=name):
            return f"{words.PRESENT_WORD}({name_text(name)})"
        case ir.System(name=name, indices=indices):
            inner = f"[{', '.join(printer.text(index) for index in indices)}]" if indices else ""
            return f"${name}{inner}"
        case ir.Signal():
            return _signal(node, printer)
        case ir.Aggregate():
            return _aggregate(node, printer)
        case ir.VendorValue(dialect=dialect, text=text, type=type):
            return f"VENDOR({name_text(dialect)}, {text_literal(text)}, {type_text(type)})"
    raise InternalError(f"RPL has no form for {node.__class__.__name__}")


def _base(node: ir.Expression, printer: ExpressionPrinter) -> str:
    """An operand of a postfix: a name, a literal, a call, or anything in brackets."""
    printed = printer.printed(node)
    return printed.text if printed.level >= POSTFIX else printer.bracketed(printed.text)


def _unary(op: str, operand: ir.Expression, printer: ExpressionPrinter) -> Printed:
    sign, level = _UNARY[op]
    inner = printer.printed(operand)
    text = inner.text
    if inner.level < level or (op in ("-", "+") and text[:1] in ("-", "+")):
        text = printer.bracketed(text)
    return Printed(sign + text, level)


def _signal(node: ir.Signal, printer: ExpressionPrinter) -> str:
    text = _SIGNAL_WORDS[node.kind]
    if node.name is not None:
        text += f"({name_text(node.name)})"
    if node.index is not None:
        last = f" TO {printer.text(node.last)}" if node.last is not None else ""
        text += f"[{printer.text(node.index)}{last}]"
    return text


def _aggregate(node: ir.Aggregate, printer: ExpressionPrinter) -> str:
    parts = []
    for name, value in node.entries:
        text = printer.text(value)
        if name is None:
            # `{a : b}` would look like an entry named a.
            parts.append(f"({text})" if isinstance(value, ir.Binary) else text)
        else:
            parts.append(f"{name if words.is_bare(name) else words.enclose(name, '`')}: {text}")
    prefix = "" if node.type_name is None else f"{_type_prefix(node.type_name)} "
    return f"{prefix}{{{', '.join(parts)}}}"


def _type_prefix(name: str) -> str:
    head, blank, notation = name.partition(" ")
    if blank and words.is_bare(head) and words.is_bare(notation):
        return f"{name_text(head)}.{notation}"
    return name_text(name)


class _Printer(ExpressionPrinter):
    """The shared printer with one more rule: a bracketed sign before a number is not the negative literal."""

    __slots__ = ()

    def bracketed(self, text: str) -> str:
        if text[:1] == "-" and _NUMBER.fullmatch(text[1:]):
            return f"(-({text[1:]}))"
        return f"({text})"


_NUMBER = re.compile(r"\d[\w.]*(?:[+-]\d+)?")
PRINTER = _Printer(TABLE, _hook)
expression_text = PRINTER.text


def value_text(node: ir.Expression) -> str:
    """A value behind `=`: a comparison stands in brackets, for the reader's sake."""
    text = PRINTER.text(node)
    return f"({text})" if isinstance(node, ir.Binary) and node.op in _COMPARISONS else text


def state_text(node: ir.Expression) -> str:
    """A value that is switched to."""
    if isinstance(node, ir.BoolLiteral):
        return "ON" if node.value else "OFF"
    return PRINTER.text(node)


def place_text(node: ir.Expression) -> str:
    """A place that is assigned to, or whatever stands where one is expected."""
    return _base(node, PRINTER)


def arguments_text(arguments: tuple[ir.Argument, ...]) -> str:
    return ", ".join(_argument(argument) for argument in arguments)


def _argument(argument: ir.Argument) -> str:
    if argument.name is None:
        text = "?" if argument.value is None else PRINTER.text(argument.value)
    elif argument.value is None:
        text = f"SWITCH {name_text(argument.name)}"
    else:
        text = f"{name_text(argument.name)} := {PRINTER.text(argument.value)}"
    return text if argument.if_present is None else f"{text} IF PRESENT {name_text(argument.if_present)}"


# ---- types

_TYPE_WORDS = {type.__class__: word.upper() for word, type in words.TYPE_WORDS.items()}


def type_text(type: ir.Type) -> str:
    match type:
        case ir.NamedType(name=name):
            return name_text(name, _FOLDED_TYPES)
        case ir.StringType(capacity=capacity) if capacity is not None:
            return f"STRING[{PRINTER.text(capacity)}]"
        case ir.TargetType(notation=notation, external=external):
            return f"{'' if external else 'PLAIN '}TARGET{_notation(notation)}"
        case ir.ConfigType(notation=notation):
            return f"CONFIGURATION{_notation(notation)}"
        case ir.JointsType(external=False):
            return "PLAIN JOINTS"
        case ir.SignalType(kind=kind):
            return f"SIGNAL {name_text(kind)}"
        case ir.VendorType(dialect=dialect, name=name):
            return f"VENDOR {name_text(dialect)}.{name_text(name)}"
        case ir.ArrayType(element=element, dimensions=dimensions, base=base):
            bounds = ", ".join("*" if bound is None else PRINTER.text(bound) for bound in dimensions)
            start = "" if base == 1 else f"FROM {base} "
            return f"ARRAY[{bounds}] {start}OF {type_text(element)}"
    return _TYPE_WORDS[type.__class__]


def _notation(notation: str) -> str:
    return "" if notation == words.NATIVE else f".{name_text(notation)}"

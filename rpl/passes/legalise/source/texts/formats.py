"""C-like formats with fillings, signs in front of positive numbers, or numbers to other bases, for targets whose own
words for texts of numbers are plainer: such a piece becomes a text by itself, made by functions of the program.
"""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import replace

from rpl import ir
from rpl.ir.walk import walk
from rpl.passes.capabilities import RoutineRule
from rpl.passes.legalise.context import Context
from rpl.passes.legalise.rewriting.library import common_library
from rpl.passes.legalise.rewriting.walk import Rewriter
from rpl.passes.legalise.stages import legalising

_SPECIFICATION = re.compile(r"%(?:%|(?P<flags>[-+ 0]*)(?P<width>\d*)(?:\.(?P<digits>\d+))?l?(?P<kind>[a-zA-Z]))")
_DEFAULT_DECIMALS = 6
_BASES = {"x": (16, "0123456789abcdef"), "X": (16, "0123456789ABCDEF"), "o": (8, "01234567")}


@legalising(
    unless=lambda context: (
        context.capabilities.carries_rules
        or RoutineRule.TEXT_RESULTS not in context.capabilities.routines.rules
        or "format_into" in context.capabilities.procedures
    ),
    sees=("function format", "procedure format_into"),
)
def formats(program: ir.Program, context: Context) -> ir.Program:
    """Only for targets with texts as values and without C's own formats."""
    if not any(_form(node) for node in walk(*program.modules)):
        return program
    worker = _Formats(program, context)
    return worker.helpers.added_to(worker.program())


def _form(node: object) -> str:
    match node:
        case (
            ir.Builtin(function="format", arguments=(ir.TextLiteral(value=form), *_))
            | ir.Do(procedure="format_into", arguments=(_, _, _, ir.TextLiteral(value=form), *_))
        ):
            return form
    return ""


class _Formats(Rewriter):
    def __init__(self, program: ir.Program, context: Context) -> None:
        super().__init__(program, context)
        self.helpers = common_library(context)
        self.own = "format" in context.capabilities.functions

    def expression(self, expression: ir.Expression) -> ir.Expression:
        done = super().expression(expression)
        match done, expression:
            case ir.Builtin(arguments=(ir.TextLiteral(value=form), *values)), ir.Builtin(arguments=(_, *old)) if _form(
                done
            ):
                parts = self.parts(form, values, [self.type_of(one) for one in old])
                return done if parts is None else _joined(parts, done)
        return done

    def statement(self, statement: ir.Statement) -> list[ir.Statement]:
        [done] = super().statement(statement)
        if isinstance(done, ir.Do) and isinstance(statement, ir.Do) and (form := _form(done)):
            types = [self.type_of(one) if one is not None else None for one in statement.arguments[4:]]
            return [self.with_texts(done, form, types)]
        return [done]

    def with_texts(self, statement: ir.Do, form: str, types: Sequence[ir.Type | None]) -> ir.Do:
        """A formatted write whose odd pieces are texts by themselves."""
        specifications = [found for found in _SPECIFICATION.finditer(form) if found[0] != "%%"]
        values = [one for one in statement.arguments[4:] if one is not None]
        if not len(specifications) == len(values) == len(types) or not any(map(self.is_odd, specifications)):
            return statement
        for at in range(len(values) - 1, -1, -1):
            found = specifications[at]
            piece = self.piece(found, values[at], types[at]) if self.is_odd(found) else None
            if piece is not None:
                values[at] = piece
                form = f"{form[: found.start()]}%s{form[found.end() :]}"
        return replace(statement, arguments=(*statement.arguments[:3], ir.TextLiteral(form), *values))

    def parts(
        self, form: str, values: Sequence[ir.Expression], types: Sequence[ir.Type | None]
    ) -> list[ir.Expression] | None:
        """The texts that make up the formatted one; None when the target's words say it as it is, or nothing does."""
        specifications = list(_SPECIFICATION.finditer(form))
        shown = [found for found in specifications if found[0] != "%%"]
        if len(shown) != len(values) or not any(self.is_odd(found) for found in shown):
            return None
        parts: list[ir.Expression] = []
        kept, given, end = "", list[ir.Expression](), 0  # the plain format so far
        rest = list(zip(values, types, strict=True))
        for found in specifications:
            kept += form[end : found.start()]
            end = found.end()
            if found[0] == "%%" or not self.is_odd(found):
                kept += found[0]
                given += [rest.pop(0)[0]] if found[0] != "%%" else []
                continue
            piece = self.piece(found, *rest.pop(0))
            if piece is None:
                return None
            parts += [*_plain(kept, given), piece]
            kept, given = "", []
        return [*parts, *_plain(kept + form[end:], given)]

    def is_odd(self, found: re.Match[str]) -> bool:
        """Is it more than a number or text, filled with blanks on the left?"""
        if found["kind"] in _BASES:
            return bool(not self.own or found["flags"] or found["kind"] == "x")
        text = found["kind"] in "sc" and bool(found["width"] or found["digits"])
        return bool(found["flags"].strip() or text) and found["kind"] in "diufgsc"

    def piece(self, found: re.Match[str], value: ir.Expression, type: ir.Type | None) -> ir.Expression | None:
        """The text of one value."""
        flags, kind, digits = found["flags"], found["kind"], found["digits"]
        number = kind not in "sc"
        if digits and kind not in "fs":
            return None
        text = self.text(kind, int(digits) if digits else _DEFAULT_DECIMALS, value, type)
        if kind == "s" and digits:
            text = self.helpers.call("rpl_beginning", text, ir.IntLiteral(int(digits)))
        if number and ("+" in flags or " " in flags):
            text = self.helpers.call("rpl_signed", text, ir.TextLiteral("+" if "+" in flags else " "))
        if not found["width"]:
            return text
        filling = "rpl_filled" if "-" in flags else "rpl_zeros" if number and "0" in flags else "rpl_padded"
        return self.helpers.call(filling, text, ir.IntLiteral(int(found["width"])))

    def text(self, kind: str, decimals: int, value: ir.Expression, type: ir.Type | None) -> ir.Expression:
        whole = value if isinstance(type, ir.IntType) else ir.Convert("trunc", value)
        match kind:
            case "d" | "i" | "u":
                return ir.Builtin("number_text", (whole, ir.IntLiteral(0)))
            case "x" | "X" | "o":
                base, signs = _BASES[kind]
                return self.helpers.call("rpl_based", whole, ir.IntLiteral(base), ir.TextLiteral(signs))
            case "f":
                return ir.Builtin("number_text", (value, ir.IntLiteral(decimals)))
            case "c" if isinstance(type, ir.IntType):
                return ir.Builtin("from_code", (value,))
        return value if isinstance(type, ir.StringType | ir.CharType) else ir.Builtin("value_text", (value,))


def _plain(form: str, values: Sequence[ir.Expression]) -> list[ir.Expression]:
    """A part of a format; nothing for an empty one."""
    if not form:
        return []
    if not values:
        return [ir.TextLiteral(form.replace("%%", "%"))]
    return [ir.Builtin("format", (ir.TextLiteral(form), *values))]


def _joined(parts: Sequence[ir.Expression], whole: ir.Expression) -> ir.Expression:
    if not parts:
        return ir.TextLiteral("", origin=whole.origin)
    done = parts[0]
    for part in parts[1:]:
        done = ir.Binary("&", done, part, origin=whole.origin)
    return done


__all__ = ["formats"]

"""Texts of V+: items of TYPE and $ENCODE with format controls, and the functions of texts."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING

from rpl import ir
from rpl.writing.precedence import Printed
from rpl.writing.statements import CannotSayError

from . import spelling, tables

if TYPE_CHECKING:
    from .expressions import Expressions

DEFAULT = "/D"
_FORMS = frozenset(("format", "message_text", "number_text", "value_text"))
_SPECIFIER = re.compile(r"%(?:%|(?P<flags>[-+ 0]*)(?P<width>\d*)(?:\.(?P<digits>\d+))?(?P<letter>[a-zA-Z]))")
_PLACE = re.compile(r"%(\d)")
_READERS_OWN = "% .8g"  # how the reader spells a number without a control


class Texts:
    """Prints texts of one routine."""

    def __init__(self, expressions: Expressions) -> None:
        self.expressions = expressions

    def is_text(self, value: ir.Expression) -> bool:
        return isinstance(self.expressions.type(value), ir.StringType | ir.CharType)

    # ---- items

    def items(self, text: ir.Expression) -> str:
        """A text as the items of TYPE, `"count is ", /I0, n`."""
        control, shown = DEFAULT, []
        for wanted, value in self.parts(text):
            if wanted and wanted != control:
                shown.append(wanted)
                control = wanted if not wanted.startswith(("/C", "/X")) else control
            if value:
                shown.append(value)
        return ", ".join(shown) or '""'

    def encoded(self, text: ir.Expression) -> str:
        return f"$ENCODE({self.items(text)})"

    def parts(self, text: ir.Expression) -> list[tuple[str, str]]:
        """(control, text) of each item; one of them may be empty."""
        match text:
            case ir.Binary(op="&" | "+", left=left, right=right):
                return [*self.parts(left), *self.parts(right)]
            case ir.TextLiteral(value=value):
                return self.written(value)
            case ir.Builtin(function="format", arguments=(ir.TextLiteral(value=form), *values)):
                return self.formatted(form, values)
            case ir.Builtin(function="message_text", arguments=(ir.TextLiteral(value=form), *values)):
                return self.filled(form, values)
            case ir.Builtin(function="number_text", arguments=(value, ir.IntLiteral(value=places))):
                return [(f"/F0.{places}", self.item(value))]
            case ir.Builtin(function="value_text", arguments=(value,)):
                return self.shown(value)
            case ir.Builtin(function=name) if name in _FORMS:
                self.refuse("a text whose form the run decides")
        return [("", self.expressions.text(text))]

    def item(self, value: ir.Expression) -> str:
        return self.expressions.text(value)

    def shown(self, value: ir.Expression) -> list[tuple[str, str]]:
        """A value as its language writes it."""
        if self.is_text(value):
            return self.parts(value)
        type = self.expressions.type(value)
        if not isinstance(type, ir.RealType | ir.IntType):
            self.refuse("a text of anything but a number")
        # Six digits, as the languages that show any value have them; whole numbers that are known as such in full.
        whole = isinstance(type, ir.IntType) or isinstance(value, ir.IntLiteral)
        return [("/G0.8" if whole else "/G0.6", self.item(value))]

    def refuse(self, reason: str) -> None:

        raise CannotSayError(reason)

    def written(self, text: str) -> list[tuple[str, str]]:
        """Line ends are controls, other signs that cannot be quoted stand as $CHR."""
        parts: list[tuple[str, str]] = []
        for at, line in enumerate(text.split("\n")):
            if at:
                parts.append(("/C1", ""))
            if line:
                shown, lost = spelling.pieces(line)
                if lost:
                    self.expressions.notes.changed_texts.append(line)
                parts.extend(("", one) for one in shown)
        return parts

    def formatted(self, form: str, values: list[ir.Expression]) -> list[tuple[str, str]]:
        """C-like specifiers as controls."""
        if form == _READERS_OWN and len(values) == 1:
            return [(DEFAULT, self.item(values[0]))]
        parts: list[tuple[str, str]] = []
        rest, end = list(values), 0
        for found in _SPECIFIER.finditer(form):
            parts.extend(self.written(form[end : found.start()]))
            end = found.end()
            if found[0] == "%%":
                parts.extend(self.written("%"))
            elif rest:
                parts.extend(self.specified(found, rest.pop(0)))
        return [*parts, *self.written(form[end:])]

    def specified(self, found: re.Match[str], value: ir.Expression) -> list[tuple[str, str]]:
        letter, width, digits = found["letter"], found["width"] or "0", found["digits"]
        text = letter in "sc" and (width != "0" or digits)
        if text or found["flags"].strip() or (found["flags"] and width == "0"):
            self.refuse(f"{found[0]}: numbers are filled with blanks on the left, and nothing else")
        if letter in "sc" or self.is_text(value):
            return self.shown(value)
        if letter in "diu":
            return [(f"/I{width}", self.item(value))]
        if letter in "xXo":
            return [(f"/{'O' if letter == 'o' else 'H'}{width}", self.item(value))]
        if letter in "feg":
            return [(f"/{letter.upper()}{width}.{digits or 6}", self.item(value))]
        self.refuse(f"there is no format for {found[0]}")
        return []

    def filled(self, form: str, values: list[ir.Expression]) -> list[tuple[str, str]]:
        """`%1` ... are replaced by the values."""
        parts: list[tuple[str, str]] = []
        end = 0
        for found in _PLACE.finditer(form):
            at = int(found[1]) - 1
            if not 0 <= at < len(values):
                continue
            parts.extend(self.written(form[end : found.start()]))
            parts.extend(self.shown(values[at]))
            end = found.end()
        return [*parts, *self.written(form[end:])]

    # ---- functions

    def brought(self, name: str, values: tuple[ir.Expression, ...], place: str) -> str:
        """The call of a program that comes along and makes a text in a variable."""
        program = tables.BROUGHT_TEXTS[name]
        self.expressions.notes.helpers.add(program)
        return f"CALL {program}({', '.join(map(self.expressions.value, values))}, {place})"

    def function(self, name: str, values: tuple[ir.Expression, ...]) -> str | Printed | None:
        expressions = self.expressions
        match name, values:
            case _ if name in _FORMS:
                return self.encoded(ir.Builtin(name, values))
            case "text_part", (text, first, count):
                return f"$MID({expressions.listed((text, first, count))})"
            case "text_find", (text, start, wanted):
                tail = "" if start == ir.IntLiteral(1) else f", {expressions.text(start)}"
                return f"POS({expressions.text(text)}, {expressions.text(wanted)}{tail})"
            case "number_bytes", (value, ir.IntLiteral(value=count)) if count in tables.BYTES:
                return f"${tables.BYTES[count]}({expressions.text(value)})"
            case "bytes_number", (text, ir.IntLiteral(value=1), ir.IntLiteral(value=count)) if count in tables.BYTES:
                return f"{tables.BYTES[count]}({expressions.text(text)})"
            case "bytes_number", (text, first, ir.IntLiteral(value=count)) if count in tables.BYTES:
                return f"{tables.BYTES[count]}({expressions.text(text)}, {expressions.text(first)})"
            case _ if name in tables.BROUGHT_TEXTS or (name == "text_equal" and values[2:] == (ir.BoolLiteral(True),)):
                raise CannotSayError("a program makes this text, and it cannot be called inside of a condition")
            case "text_equal", (one, other, *rest) if not rest or rest[0] == ir.BoolLiteral(False):
                level = tables.RELATION + 1
                left, right = (expressions.printer.text(value, level) for value in (one, other))
                return Printed(f"{left} == {right}", tables.RELATION)
        return None

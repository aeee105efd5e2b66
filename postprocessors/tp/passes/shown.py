"""Messages for targets whose messages show constant text only: a computed part is kept in a variable that the message
names, as `count: R12`.

Each computed part becomes a plain variable in the text, so that the writer can put its register's name there. A value
that is computed for the message goes into a variable of its own, which the next message uses again.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import replace

from rpl import ir
from rpl.diagnostics import Severity, code
from rpl.passes.legalise.context import Context
from rpl.passes.legalise.rewriting.editing import Editor, edit_bodies, edit_routines, expansion, map_body
from rpl.passes.legalise.rewriting.jumps import inside
from rpl.passes.legalise.stages import legalising

NAMED = code(
    "message-values-named",
    Severity.WARNING,
    "the target's messages show constant text; this one names the registers in which its values are",
)
_NUMBERED = re.compile(r"%([1-9])")
_FORMATTED = re.compile(r"%[-+0 #]*\d*(?:\.\d+)?l?([a-zA-Z%])")
_TEMPLATES = {"message_text": _NUMBERED, "format": _FORMATTED}
# Functions that only change how a text looks: the message names the text itself.
_LOOKS = frozenset(("text_upper", "text_lower", "text_trim"))


@legalising(sees=("Message",))
def values_beside_messages(program: ir.Program, context: Context) -> ir.Program:
    """Messages name the registers of their values."""

    def work(editor: Editor, routine: ir.Routine) -> ir.Routine:
        kept: dict[tuple[ir.Type, int], ir.Name] = {}

        def change(statement: ir.Statement) -> ir.Body:
            if isinstance(statement, ir.Message) and statement.kind != "clear":
                return _Shown(editor, kept).message(statement)
            return (inside(statement, lambda inner: map_body(inner, change)),)

        return edit_bodies(routine, lambda body: map_body(body, change))

    return edit_routines(program, context, work)


class _Shown:
    """One message."""

    def __init__(self, editor: Editor, kept: dict[tuple[ir.Type, int], ir.Name]) -> None:
        self.editor = editor
        self.kept = kept
        self.used: dict[ir.Type, int] = {}
        self.before: list[ir.Statement] = []

    def message(self, message: ir.Message) -> ir.Body:
        pieces = [self.piece(one) for one in _pieces(message.text)]
        if all(isinstance(one, ir.TextLiteral) for one in pieces):
            text = "".join(one.value for one in pieces if isinstance(one, ir.TextLiteral))
            same = isinstance(message.text, ir.TextLiteral)
            return (message if same else replace(message, text=ir.TextLiteral(text)),)
        self.editor.context.diagnostics.report(NAMED, message.origin)
        shown = pieces[0]
        for one in pieces[1:]:
            shown = ir.Binary("&", shown, one)
        return expansion(message.origin, (*self.before, replace(message, text=shown)))

    def piece(self, piece: ir.Expression) -> ir.Expression:
        """A constant text, a text variable, or the text of a variable."""
        match piece:
            case ir.TextLiteral():
                return piece
            case ir.Builtin(function="number_text" | "value_text", arguments=(value, *_)):
                return ir.Builtin("value_text", (self.place(value),))
        if isinstance(self.editor.type_of(piece), ir.StringType | ir.CharType):
            return self.place(piece)
        return ir.Builtin("value_text", (self.place(piece),))

    def place(self, value: ir.Expression) -> ir.Expression:
        """The variable that holds the value."""
        if isinstance(value, ir.Name):
            symbol = self.editor.scope.value(value.id)
            declared = None if symbol is None else symbol.declaration
            if isinstance(declared, ir.Variable) and declared.storage != "constant":
                return value
        type = self.editor.type_of(value) or ir.RealType()
        type = ir.StringType() if isinstance(type, ir.CharType) else type
        number = self.used[type] = self.used.get(type, 0) + 1
        if (type, number) not in self.kept:
            self.kept[type, number] = self.editor.temporary("shown", type)
        self.before.append(ir.Assign(self.kept[type, number], value))
        return self.kept[type, number]


def _pieces(text: ir.Expression) -> Iterator[ir.Expression]:
    """The parts of a text in order, templates taken apart."""
    match text:
        case ir.Binary(op="&", left=left, right=right):
            yield from _pieces(left)
            yield from _pieces(right)
        case ir.Builtin(function=name, arguments=(ir.TextLiteral(value=template), *values)) if name in _TEMPLATES:
            yield from _template(template, values, _TEMPLATES[name])
        case ir.Builtin(function=name, arguments=(inner, *_)) if name in _LOOKS:
            yield from _pieces(inner)
        case _:
            yield text


def _template(template: str, values: list[ir.Expression], pattern: re.Pattern[str]) -> Iterator[ir.Expression]:
    at, following = 0, 0
    for found in pattern.finditer(template):
        number = int(found[1]) - 1 if found[1].isdigit() else following
        constant = found[1] == "%" or number >= len(values)
        yield ir.TextLiteral(template[at : found.start()] + ("%" if constant else ""))
        at = found.end()
        if not constant:
            following += 1
            yield from _pieces(values[number])
    yield ir.TextLiteral(template[at:])

"""Messages of several lines, or longer than a line of the target's screen, as several messages one behind the other.

A computed message is taken apart: its constant words and its computed parts are put together to lines as far as they
are sure to fit, so that nothing of it is cut off and no text grows beyond what a variable can hold.
"""

from __future__ import annotations

import re
from dataclasses import replace

from rpl import ir
from rpl.diagnostics import Severity, code
from rpl.ir.walk import rewrite
from rpl.passes.capabilities import MessageRule, TextRule
from rpl.passes.legalise.context import Context
from rpl.passes.legalise.rewriting.editing import Editor, edit_all, edit_bodies, edit_routines, map_body
from rpl.passes.legalise.rewriting.jumps import inside
from rpl.passes.legalise.stages import legalising

SPLIT = code(
    "message-split",
    Severity.WARNING,
    "a message that may be longer than {most} characters is shown in {count} lines",
)
# The longest texts of a whole number of 32 bits and of a real number.
_WHOLE, _REAL = 11, 16
_ENDS = re.compile(r"\r\n|\r|\n")
_WORDS = re.compile(r"\s*\S+\s*|\s+")


@legalising(unless=lambda context: not context.capabilities.texts.longest_message)
def split_messages(program: ir.Program, context: Context) -> ir.Program:
    """Only for targets whose messages have a longest line."""
    most = context.capabilities.texts.longest_message

    def work(editor: Editor, routine: ir.Routine) -> ir.Routine:
        def change(statement: ir.Statement) -> ir.Body:
            if isinstance(statement, ir.Message) and statement.kind != "clear":
                return _split(statement, most, editor)
            return (inside(statement, lambda inner: map_body(inner, change)),)

        return edit_bodies(routine, lambda body: map_body(body, change))

    return edit_routines(program, context, work)


@legalising(unless=lambda context: TextRule.LINE_ENDS in context.capabilities.texts.rules)
def message_lines(program: ir.Program, context: Context) -> ir.Program:
    """A message for each line of one, where texts of the target have no line ends; empty lines are not shown."""

    def change(statement: ir.Statement) -> ir.Body:
        if isinstance(statement, ir.Message) and statement.kind != "clear":
            return _lines(statement)
        return (inside(statement, lambda inner: map_body(inner, change)),)

    return edit_all(program, lambda body: map_body(body, change))


@legalising(
    unless=lambda context: MessageRule.NUMBERED in context.capabilities.texts.messages, sees=("Message", "Dialog")
)
def senders_as_texts(program: ir.Program, context: Context) -> ir.Program:
    """The number of an alarm as a text, where what stands in front of a message is one."""

    def work(editor: Editor, routine: ir.Routine) -> ir.Routine:
        def change(node: object) -> object:
            if not isinstance(node, ir.Message | ir.Dialog) or node.sender is None:
                return node
            match node.sender, editor.type_of(node.sender):
                case ir.IntLiteral(value=number), _:
                    return replace(node, sender=ir.TextLiteral(str(number), origin=node.sender.origin))
                case sender, ir.IntType() | ir.RealType():
                    return replace(node, sender=ir.Builtin("value_text", (sender,), origin=sender.origin))
            return node

        return rewrite(routine, change)

    return edit_routines(program, context, work)


def _lines(message: ir.Message) -> ir.Body:
    pieces = _pieces(message.text)
    if not any(isinstance(piece, ir.TextLiteral) and _ENDS.search(piece.value) for piece in pieces):
        return (message,)
    lines: list[list[ir.Expression]] = [[]]
    for piece in pieces:
        if not isinstance(piece, ir.TextLiteral):
            lines[-1].append(piece)
            continue
        first, *others = _ENDS.split(piece.value)
        lines[-1].append(ir.TextLiteral(first))
        lines.extend([ir.TextLiteral(other)] for other in others)
    full = [line for line in lines if any(piece != ir.TextLiteral("") for piece in line)] or lines[:1]
    later = replace(message.origin, comments=())
    return tuple(
        replace(message, text=_joined(line), origin=message.origin if at == 0 else later)
        for at, line in enumerate(full)
    )


def _split(message: ir.Message, most: int, editor: Editor) -> ir.Body:
    """The message, or its lines."""
    pieces = _pieces(message.text)
    whole = len(pieces) == 1 and not isinstance(pieces[0], ir.TextLiteral)
    if whole or sum(_length(piece, editor, most) for piece in pieces) <= most:
        return (message,)
    lines: list[list[ir.Expression]] = [[]]
    room = most
    for piece in _words(pieces, most):
        size = min(_length(piece, editor, most), most)
        fits = size <= room or (isinstance(piece, ir.TextLiteral) and len(piece.value.rstrip()) <= room)
        if not fits:
            lines.append([])
            room = most
        lines[-1].append(piece)
        room -= size
    if len(lines) > 1:
        editor.context.diagnostics.report(SPLIT, message.origin, most=most, count=len(lines))
    later = replace(message.origin, comments=())
    return tuple(
        replace(message, text=_joined(line), origin=message.origin if at == 0 else later)
        for at, line in enumerate(lines)
    )


def _pieces(text: ir.Expression) -> list[ir.Expression]:
    if isinstance(text, ir.Binary) and text.op == "&":
        return [*_pieces(text.left), *_pieces(text.right)]
    return [text]


def _words(pieces: list[ir.Expression], most: int) -> list[ir.Expression]:
    """The pieces with constant texts cut into words, and words that are too long for a line into parts."""
    done: list[ir.Expression] = []
    for piece in pieces:
        if not isinstance(piece, ir.TextLiteral):
            done.append(piece)
            continue
        for word in _WORDS.findall(piece.value):
            done.extend(ir.TextLiteral(word[at : at + most]) for at in range(0, len(word), most))
    return done


def _length(piece: ir.Expression, editor: Editor, most: int) -> int:
    """How long the piece can be at most."""
    if MessageRule.COMPUTED not in editor.capabilities.texts.messages and not isinstance(piece, ir.TextLiteral):
        banks = [editor.capabilities.storage.banks.get(name) for name in ("RealType", "BoolType", "StringType")]
        return max((len(f"{bank.name}{bank.last}") for bank in banks if bank is not None), default=most)
    match piece:
        case ir.TextLiteral(value=text):
            return len(text)
        case ir.Builtin(function="number_text" | "value_text", arguments=(number, *_)):
            return _WHOLE if isinstance(editor.type_of(number), ir.IntType) else _REAL
    return 1 if isinstance(editor.type_of(piece), ir.CharType) else most


def _joined(line: list[ir.Expression]) -> ir.Expression:
    """A line as one text: neighbouring constants are one, blanks at its ends are dropped."""
    done: list[ir.Expression] = []
    for piece in line:
        before = done[-1] if done else None
        if isinstance(piece, ir.TextLiteral) and isinstance(before, ir.TextLiteral):
            done[-1] = ir.TextLiteral(before.value + piece.value)
        else:
            done.append(piece)
    if done and isinstance(done[0], ir.TextLiteral):
        done[0] = ir.TextLiteral(done[0].value.lstrip())
    if done and isinstance(done[-1], ir.TextLiteral):
        done[-1] = ir.TextLiteral(done[-1].value.rstrip())
    kept = [piece for piece in done if piece != ir.TextLiteral("")] or [ir.TextLiteral("")]
    text = kept[0]
    for piece in kept[1:]:
        text = ir.Binary("&", text, piece)
    return text

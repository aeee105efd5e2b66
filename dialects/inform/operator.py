"""What the operator sees and answers: MSG, PRINT, CLS, INPUT, DIALOG, and alarms of the program (SETUALM)."""

from __future__ import annotations

import re
from dataclasses import replace

from rpl import ir
from rpl.reading.shapes import StatementError

from .data import Statements
from .motion import Motion
from .operands import tags_of
from .split import code_of
from .syntax import Command, Operand, Word

_PLACE = re.compile(r"%[dsf]")
_NUMBER_PLACE = re.compile(r"%[xo%]")
# M: SMODE= of SETUALM: 0 every task stops (as without it), 1 none, 2 this one.
GOES_ON = ir.IntLiteral(1)


def asked(done: list[ir.Statement], made: Statements) -> Statements:
    """What a line has become. The messages that are the question of an INPUT are taken off `done`: the dialog shows
    them, and nobody sees them twice."""
    match made:
        case (ir.Dialog(kind="number", text=text, origin=origin) as dialog,):
            left, comments = text, origin.comments
            while done and isinstance(last := done[-1], ir.Message):
                whole = left == last.text
                if not whole and not (isinstance(left, ir.Binary) and left.right == last.text):
                    break
                comments = (*last.origin.comments, *comments)
                done.pop()
                if whole:
                    break
                assert isinstance(left, ir.Binary)
                left = left.left
            return (replace(dialog, origin=replace(origin, comments=comments)),)
    return made


class Operator(Motion):
    """Instructions for the operator."""

    shown: ir.Expression | None = None  # by MSG in the lines in front of this one

    def on_msg(self, command: Command) -> Statements:
        text = self.as_text(self.needs(command, 1)[0])
        self.shown = text if self.shown is None else ir.Binary("&", self.shown, text, origin=self.origin)
        return (ir.Message("notify", text, origin=self.origin),)

    def as_text(self, operand: Operand) -> ir.Expression:
        value = self.value(operand)
        return value if self.is_text(value) else self.call("value_text", value)

    def is_text(self, value: ir.Expression) -> bool:
        if isinstance(value, ir.TextLiteral):
            return True
        name = value.id if isinstance(value, ir.Name) else ""
        if isinstance(value, ir.Index) and isinstance(value.base, ir.Name):
            name = value.base.id
        return name.lstrip("L").startswith("S")

    def on_print(self, command: Command) -> Statements:
        """PRINT text [values]: %d, %s and %f stand for the values in their order."""
        first, *rest = self.needs(command, 1)
        if not isinstance(first, ir.TextLiteral):
            return (ir.Message("write", self.as_text(first), origin=self.origin),)
        if _NUMBER_PLACE.search(first.value) or len(_PLACE.findall(first.value)) != len(rest):
            return (ir.Vendor("inform", code_of(self.origin.text), "none", origin=self.origin),)
        parts = _PLACE.split(first.value.replace("\\n", ""))
        shown: list[ir.Expression] = []
        for part, value in zip(parts, [*map(self.as_text, rest), None], strict=True):
            shown += [ir.TextLiteral(part, origin=self.origin)] if part else []
            shown += [] if value is None else [value]
        text: ir.Expression = shown[0] if shown else ir.TextLiteral("", origin=self.origin)
        for one in shown[1:]:
            text = ir.Binary("&", text, one, origin=self.origin)
        return (ir.Message("write", text, origin=self.origin),)

    def on_input(self, command: Command) -> Statements:
        """INPUT B|I|D|R: the operator types a number. M: what MSG in front of it says is the question."""
        place = self.needs(command, 1)[0]
        if not isinstance(place, ir.Index) or self.is_position(place):
            raise StatementError("INPUT needs a numeric variable", len(command.word))
        text = self.shown or ir.TextLiteral("", origin=self.origin)
        return (ir.Dialog(self.value(place), text, kind="number", origin=self.origin),)

    def on_dialog(self, command: Command) -> Statements:
        """DIALOG answer DIALSB x y message x y button [DIALSB ...]: the number of the button that is pressed."""
        answer = self.needs(command, 2)[0]
        texts = [
            self.value(item)
            for item in command.items[1:]
            if isinstance(item, ir.TextLiteral) or (isinstance(item, ir.Index) and self.is_text(item))
        ]
        count = sum(item == Word("DIALSB") for item in command.items)
        if not count or len(texts) != 2 * count or not isinstance(answer, ir.Index):
            raise StatementError("DIALOG is read with a message and a button behind each DIALSB", len(command.word))
        message = texts[0]
        for further in texts[2::2]:
            message = ir.Binary("&", message, further, origin=self.origin)
        return (ir.Dialog(self.value(answer), message, tuple(texts[1::2]), origin=self.origin),)

    def on_cls(self, command: Command) -> Statements:
        return (ir.Message("clear", ir.TextLiteral(""), origin=self.origin),)

    def on_setualm(self, command: Command) -> Statements:
        """SETUALM number text axis [SMODE=n]: an alarm, which stops the job until somebody goes on."""
        number = self.value(self.needs(command, 1)[0])
        texts = [item for item in command.items[1:] if isinstance(item, ir.TextLiteral | ir.Index)]
        text = self.value(texts[0]) if texts else ir.TextLiteral("user alarm", origin=self.origin)
        told = ir.Message("error", text, number, origin=self.origin)
        if any(tag == "SMODE" and relation.right == GOES_ON for tag, relation in tags_of(command.items)):
            return (told,)
        return told, ir.Halt(origin=self.origin)

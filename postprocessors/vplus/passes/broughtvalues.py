"""Functions that V+ has not: a program that comes along gives the value, `CALL rpl.upper(($t), $result)`.

So such a function stands alone on the right side of an assignment to a variable. Where a condition of a loop asks for
it, it is made anew in each pass.
"""

from __future__ import annotations

from rpl import ir
from rpl.passes.fold import constant_number
from rpl.passes.legalise.context import Context
from rpl.passes.legalise.rewriting.bodies import Hoister, Lowered
from rpl.passes.legalise.rewriting.editing import Editor, edit_bodies, edit_routines
from rpl.passes.legalise.stages import legalising
from rpl.passes.rewrite import changed

from .. import tables

_IGNORING_CASE = ir.BoolLiteral(True)


@legalising(sees=[f"function {name}" for name in (*tables.BROUGHT_TEXTS, "text_equal", "power")])
def brought_values(program: ir.Program, context: Context) -> ir.Program:
    """Texts in other letters, and powers that are no products, are worked out in front of the statement."""

    def work(editor: Editor, routine: ir.Routine) -> ir.Routine:
        return edit_bodies(routine, _Brought(editor).body)

    return edit_routines(program, context, work)


class _Brought(Hoister):
    def __init__(self, editor: Editor) -> None:
        super().__init__(editor, self.made_before)

    def made_before(self, expression: ir.Expression) -> Lowered | None:
        match expression:
            case ir.Builtin(function="text_equal", arguments=(one, other, ignoring)) if ignoring == _IGNORING_CASE:
                before, left = self.in_capitals(one)
                further, right = self.in_capitals(other)
                return (*before, *further), ir.Binary("=", left, right, origin=expression.origin)
            case ir.Builtin(function=name) if name in tables.BROUGHT_TEXTS:
                kept = self.editor.temporary("t", ir.StringType())
                return (ir.Assign(kept, expression),), kept
            case ir.Builtin(function="power") if self.is_brought(expression):
                result = self.editor.temporary("t", ir.RealType())
                return (ir.Assign(result, expression),), result
        return None

    def is_brought(self, wanted: ir.Builtin) -> bool:
        """Does a program that comes along give the value?"""
        if wanted.function != "power":
            return wanted.function in tables.BROUGHT_TEXTS
        exponent = constant_number(wanted.arguments[1], self.editor.scope)
        return exponent is None or tables.is_raised(exponent)

    def in_capitals(self, text: ir.Expression) -> Lowered:
        """A text to be compared without regard to case; of a known one that is known."""
        if isinstance(text, ir.TextLiteral) and text.value.isascii():
            return (), changed(text, value=text.value.upper())
        kept = self.editor.temporary("t", ir.StringType())
        return (ir.Assign(kept, ir.Builtin("text_upper", (text,))),), kept

    def deciding(self, expression: ir.Binary) -> Lowered:
        """Texts that can be made whatever the left side says are made in front of both."""
        if not self.editor.effects.safe(expression.right):
            return super().deciding(expression)
        before, (left, right) = self.several((expression.left, expression.right), (False, False))
        return before, changed(expression, left=left, right=right)

    def single(self, statement: ir.Statement) -> ir.Body:
        match statement:
            case ir.Assign(target=ir.Name(), value=ir.Builtin(arguments=given) as value) if self.is_brought(value):
                before, made_of = self.several(given, [False] * len(given))
                alone = changed(statement, value=changed(value, arguments=tuple(made_of)))
                return self.expanded(statement, before, alone)
        return super().single(statement)


__all__ = ["brought_values"]

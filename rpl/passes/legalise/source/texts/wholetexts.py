"""Texts of values with components (`[1,2.5,-3]`), for targets that only make texts of numbers, texts and truth values:
the text is put together of those of the components. What is computed is kept in a variable first.
"""

from __future__ import annotations

from functools import reduce

from rpl import ir
from rpl.passes.capabilities import TextRule
from rpl.passes.legalise.context import Context
from rpl.passes.legalise.rewriting.bodies import Hoister, Lowered
from rpl.passes.legalise.rewriting.editing import Editor, edit_bodies, edit_routines
from rpl.passes.legalise.stages import legalising
from rpl.passes.typewords import component_names, component_type

_PLAIN = (*ir.NUMBER_TYPES, ir.StringType, ir.CharType, ir.BoolType)
_MOST = 24  # components that are written one by one


@legalising(unless=lambda context: TextRule.WHOLE in context.capabilities.texts.rules, sees=("Builtin",))
def whole_texts(program: ir.Program, context: Context) -> ir.Program:
    """Where the target has no such texts itself."""

    def look(editor: Editor, routine: ir.Routine) -> ir.Routine:
        worker = _Worker(editor)
        return edit_bodies(routine, Hoister(editor, worker.rule).body)

    return edit_routines(program, context, look)


class _Worker:
    def __init__(self, editor: Editor) -> None:
        self.editor = editor

    def rule(self, expression: ir.Expression) -> Lowered | None:
        match expression:
            case ir.Builtin(function="value_text", arguments=(value,)):
                type = self.editor.type_of(value)
                if type is None or isinstance(type, _PLAIN) or not 0 < self.count(type) <= _MOST:
                    return None
                before: ir.Body = ()
                if not _steady(value):
                    kept = self.editor.temporary("shown", type)
                    before, value = (ir.Assign(kept, value, origin=expression.origin),), kept
                return before, reduce(_joined, self.pieces(value, type))
        return None

    def inner(self, type: ir.Type) -> list[tuple[str | int, ir.Type | None]]:
        """The components by name, or the elements by number, with their types."""
        scope = self.editor.scope
        match type:
            case ir.ArrayType(element=element, dimensions=(ir.IntLiteral(value=last),), base=base):
                return [(number, scope.resolve(element)) for number in range(base, last + 1)]
            case ir.VectorType() | ir.RotationType() | ir.PoseType() | ir.NamedType():
                return [(name, component_type(type, name, scope)) for name in component_names(type, scope)]
        return []

    def count(self, type: ir.Type | None) -> int:
        """How many plain values there are; more than can be written where one of them has no text."""
        if isinstance(type, _PLAIN):
            return 1
        parts = [] if type is None else self.inner(type)
        return sum(self.count(part) for _, part in parts) if parts else _MOST + 1

    def pieces(self, value: ir.Expression, type: ir.Type) -> list[ir.Expression]:
        if isinstance(type, ir.StringType | ir.CharType):
            quote = ir.TextLiteral('"')
            return [quote, value, quote]
        if isinstance(type, _PLAIN):
            return [ir.Builtin("value_text", (value,))]
        done: list[ir.Expression] = []
        for position, (part, inner) in enumerate(self.inner(type)):
            done.append(ir.TextLiteral("," if position else "["))
            read = ir.Index(value, (ir.IntLiteral(part),)) if isinstance(part, int) else ir.Field(value, part)
            assert inner is not None  # it has been counted
            done.extend(self.pieces(read, inner))
        return [*done, ir.TextLiteral("]")]


def _steady(value: ir.Expression) -> bool:
    """Is it a place that is the same each time it is looked at?"""
    match value:
        case ir.Name():
            return True
        case ir.Field(base=base):
            return _steady(base)
        case ir.Index(base=base, indices=indices):
            return _steady(base) and all(isinstance(one, ir.IntLiteral | ir.Name) for one in indices)
    return False


def _joined(left: ir.Expression, right: ir.Expression) -> ir.Expression:
    match left, right:
        case ir.TextLiteral(value=one), ir.TextLiteral(value=other):
            return ir.TextLiteral(one + other)
        case ir.Binary(op="&", left=start, right=ir.TextLiteral(value=one)), ir.TextLiteral(value=other):
            return ir.Binary("&", start, ir.TextLiteral(one + other))
    return ir.Binary("&", left, right)


__all__ = ["whole_texts"]

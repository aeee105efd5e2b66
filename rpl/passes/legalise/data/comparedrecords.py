"""Whole records, places and joints compared, for targets that compare numbers, texts and truths only: component by
component.

Components that are records themselves are compared in the same way; of a place, where it is and how it is turned, of
joints the axes of the arm. A side that is computed is stored first, so that it is worked out once.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

from rpl import ir
from rpl.passes.capabilities import DataRule
from rpl.passes.legalise.context import Context
from rpl.passes.legalise.rewriting.bodies import Hoister, Lowered
from rpl.passes.legalise.rewriting.editing import Editor, edit_bodies, edit_routines
from rpl.passes.legalise.stages import legalising
from rpl.passes.typewords import component_names, component_type

_PLACES = (ir.Name, ir.Index, ir.Field)
_AXES = tuple(ir.COMPONENTS[ir.AxesType])


@legalising(
    unless=lambda context: DataRule.COMPARED_RECORDS in context.capabilities.data.rules,
    sees=("operator =", "operator <>"),
)
def compared_records(program: ir.Program, context: Context) -> ir.Program:
    """Only for targets that do not compare records themselves."""

    def work(editor: Editor, routine: ir.Routine) -> ir.Routine:
        return edit_bodies(routine, _Records(editor).body)

    return edit_routines(program, context, work)


class _Records(Hoister):
    def __init__(self, editor: Editor) -> None:
        super().__init__(editor, lambda _: None)

    def lower(self, expression: ir.Expression, lvalue: bool = False) -> Lowered:
        match expression:
            case ir.Binary(op="=" | "<>", left=left, right=right):
                type = self.record(left) or self.record(right)
                if type is not None:
                    return self.comparison(expression, type)
        return super().lower(expression, lvalue)

    def record(self, side: ir.Expression) -> ir.Type | None:
        type = self.editor.type_of(side)
        return type if type is not None and self.names(type) else None

    def names(self, type: ir.Type) -> tuple[str, ...]:
        """What is compared of a value of this type; nothing where it is compared itself."""
        match type:
            case ir.NamedType():
                return component_names(type, self.editor.scope)
            case ir.TargetType() if "trans" in component_names(type, self.editor.scope):
                return ("trans", "rot")
            case ir.JointsType() if "robax" in component_names(type, self.editor.scope):
                return ("robax",)
            case ir.AxesType():
                return _AXES
        return ()

    def comparison(self, expression: ir.Binary, type: ir.Type) -> Lowered:
        before, sides = self.several((expression.left, expression.right), (False, False))
        done = list(before)
        for at, side in enumerate(sides):
            if not isinstance(side, (*_PLACES, ir.Aggregate)):
                sides[at] = self.editor.temporary("compared", type)
                done.append(ir.Assign(sides[at], side))
        tests = [ir.Binary(expression.op, one, other) for one, other in self.pairs(sides[0], sides[1], type)]
        if not tests:
            return before, expression
        joined: ir.Expression = tests[0]
        for one in tests[1:]:
            joined = ir.Binary("and" if expression.op == "=" else "or", joined, one)
        return tuple(done), replace(joined, origin=expression.origin)

    def pairs(
        self, one: ir.Expression, other: ir.Expression, type: ir.Type
    ) -> Iterator[tuple[ir.Expression, ir.Expression]]:
        """What has to be equal, component by component; nothing for an aggregate that leaves something out."""
        names = self.names(type)
        if not names:
            yield one, other
            return
        for at, name in enumerate(names):
            parts = (_part(one, name, at), _part(other, name, at))
            inner = component_type(type, name, self.editor.scope)
            if parts[0] is not None and parts[1] is not None and inner is not None:
                yield from self.pairs(parts[0], parts[1], inner)


def _part(value: ir.Expression, name: str, at: int) -> ir.Expression | None:
    if not isinstance(value, ir.Aggregate):
        return ir.Field(value, name, origin=value.origin)
    named = next((one for key, one in value.entries if key is not None and key.lower() == name.lower()), None)
    if named is not None or any(key is not None for key, _ in value.entries):
        return named
    return value.entries[at][1] if at < len(value.entries) else None


__all__ = ["compared_records"]

"""`cand`/`cor` for targets that always evaluate both sides, and strict `and`/`or` for targets that stop early.

A right side that neither acts nor fails may as well be evaluated: the plain operator does. Otherwise it is evaluated
behind an If on the left side. The other way round, a right side that acts is evaluated first, so that it always acts.
"""

from __future__ import annotations

from dataclasses import replace

from rpl import ir
from rpl.passes.legalise.context import Context
from rpl.passes.legalise.rewriting.bodies import Hoister, Lowered
from rpl.passes.legalise.rewriting.editing import Editor, edit_bodies, edit_routines
from rpl.passes.legalise.stages import legalising

_STRICT = {"cand": "and", "cor": "or"}
_EARLY = {"and": "cand", "or": "cor"}


_ACTS_ON = frozenset(f"operator {one}" for one in ("and", "or", "cand", "cor"))


@legalising(sees=_ACTS_ON)
def decide_logic(program: ir.Program, context: Context) -> ir.Program:
    """The program with the logical operators that the target has, meaning the same."""
    if context.capabilities.control.short_circuit:
        return edit_routines(program, context, _early, _ACTS_ON)
    return edit_routines(program, context, _strict, _ACTS_ON)


def _early(editor: Editor, routine: ir.Routine) -> ir.Routine:
    """For a target that stops at the side that decides."""
    operators = editor.capabilities.operators

    def rule(expression: ir.Expression) -> Lowered | None:
        match expression:
            case ir.Binary(op="and" | "or", right=right):
                before: ir.Body = ()
                if not editor.effects.quiet(right):
                    value = editor.temporary("right", ir.BoolType())
                    before, expression = (ir.Assign(value, right),), replace(expression, right=value)
                if expression.op not in operators and _EARLY[expression.op] in operators:
                    expression = replace(expression, op=_EARLY[expression.op])
                elif not before:
                    return None
                return before, expression
            case ir.Binary(op="cand" | "cor") if expression.op not in operators:
                return (), replace(expression, op=_STRICT[expression.op])
        return None

    return edit_bodies(routine, _Ordered(editor, rule).body)


class _Ordered(Hoister):
    """The left side of a strict operator is evaluated before the right side even where that is hoisted."""

    acts_on = _ACTS_ON

    def lower(self, expression: ir.Expression, lvalue: bool = False) -> Lowered:
        match expression:
            case ir.Binary(op="and" | "or", left=left, right=right) if not self.editor.effects.quiet(right):
                before, first = self.lower(left)
                further, second = self.lower(right)
                if not self.settled(first, (ir.Assign(ir.Name(""), second),)):
                    saved = self.editor.temporary("left", ir.BoolType())
                    before, first = (*before, ir.Assign(saved, first)), saved
                return self._ruled((*before, *further), replace(expression, left=first, right=second))
        return super().lower(expression, lvalue)


def _strict(editor: Editor, routine: ir.Routine) -> ir.Routine:
    """For a target that evaluates both sides."""

    def rule(expression: ir.Expression) -> Lowered | None:
        match expression:
            case ir.Binary(op="cand" | "cor", right=right) if editor.effects.safe(right):
                return (), replace(expression, op=_STRICT[expression.op])
            case ir.Binary(op="cand" | "cor", left=left, right=right):
                # An If on the left side decides whether the right side is looked at.
                result = editor.temporary("decided", ir.BoolType())
                goes_on = result if expression.op == "cand" else ir.Unary("not", result)
                chosen = ir.If(((goes_on, (ir.Assign(result, right),)),))
                return (ir.Assign(result, left), chosen), result
        return None

    return edit_bodies(routine, _Chains(editor, rule).body)


class _Chains(Hoister):
    """`a cand b` as the whole condition of an If without further branches is two nested Ifs, as people write it."""

    acts_on = _ACTS_ON

    def choice(self, statement: ir.If) -> ir.Body:
        match statement:
            case ir.If(branches=((ir.Binary(op="cand", left=left, right=right), body),), otherwise=()):
                if not self.editor.effects.safe(right):
                    inner = ir.If(((right, body),), origin=replace(statement.origin, comments=()))
                    return self.choice(replace(statement, branches=((left, (inner,)),)))
        return super().choice(statement)

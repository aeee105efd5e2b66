"""Conditions of many comparisons in parts that are found out before they are asked.

A line holds so many, spelled out without brackets. The pass runs behind the steps, where conditions are comparisons of
operands that and/or join, and again behind those that make opposites of them for jumps: `a and b or c and d` has four
comparisons, its opposite eight.
"""

from __future__ import annotations

from dataclasses import replace

from rpl import ir
from rpl.passes.legalise.context import Context
from rpl.passes.legalise.rewriting.bodies import Hoister, Lowered
from rpl.passes.legalise.rewriting.editing import Editor, edit_bodies, edit_routines
from rpl.passes.legalise.rewriting.operands import opposite
from rpl.passes.legalise.rewriting.polling import polled
from rpl.passes.legalise.rewriting.walk import POLLED
from rpl.passes.legalise.stages import legalising

from .. import tables


@legalising(sees=("operator and", "operator or"))
def short_conditions(program: ir.Program, context: Context) -> ir.Program:
    """Parts of a long condition, the longer one first, become truth values of their own."""

    def work(editor: Editor, routine: ir.Routine) -> ir.Routine:
        return edit_bodies(routine, _Short(editor).body)

    return edit_routines(program, context, work)


class _Short(Hoister):
    """`free`: variables for parts that no statement around has; `lent`: those that have one just now."""

    def __init__(self, editor: Editor) -> None:
        super().__init__(editor, lambda _: None)
        self.free: list[ir.Name] = []
        self.lent: list[ir.Name] = []

    def placed(self, statement: ir.Statement) -> ir.Body:
        since = len(self.lent)
        done = super().placed(statement)
        self.free[:0] = self.lent[since:]
        del self.lent[since:]
        return done

    def part(self) -> ir.Name:
        """A variable for a part of a condition; it serves the next statement again."""
        name = self.free.pop(0) if self.free else self.editor.temporary("part", ir.BoolType())
        self.lent.append(name)
        return name

    def condition(self, expression: ir.Expression) -> Lowered:
        if isinstance(expression, ir.Unary) and expression.op == "not":
            return self.condition(opposite(expression.operand))
        if _terms(expression) <= tables.SURE_TERMS or not isinstance(expression, ir.Binary):
            return (), expression
        before, left = self.condition(expression.left)
        further, right = self.condition(expression.right)
        if further and not self.settled(left, further):
            held = self.part()
            before, left = (*before, *_found_out(held, left)), _is_true(held)
        done, parts = replace(expression, left=left, right=right), [*before, *further]
        while _terms(done) > tables.SURE_TERMS:
            held = self.part()
            longer_left = _terms(done.left) >= _terms(done.right)
            parts += _found_out(held, done.left if longer_left else done.right)
            done = replace(done, left=_is_true(held)) if longer_left else replace(done, right=_is_true(held))
        return tuple(parts), done

    def opposite(self, condition: ir.Expression) -> ir.Expression:
        return opposite(condition)

    def single(self, statement: ir.Statement) -> ir.Body:
        """Only a wait has a condition; it is looked at again and again, so its parts are found out each time."""
        if not isinstance(statement, ir.WaitUntil) or _terms(statement.condition) <= tables.SURE_TERMS:
            return (statement,)
        if statement.timeout is not None and statement.timed_out is None:
            return (statement,)  # it ends with an error, which the writer refuses
        self.editor.context.diagnostics.report(POLLED, statement.origin, seconds=tables.WATCH_STEP_S)
        return self.body(polled(statement, self.editor))


def _terms(condition: ir.Expression) -> int:
    """How many comparisons a condition has, spelled out without brackets."""
    return sum(_alternatives(condition))


def _alternatives(condition: ir.Expression) -> list[int]:
    """How many comparisons each alternative has."""
    match condition:
        case ir.Binary(op="or", left=left, right=right):
            return [*_alternatives(left), *_alternatives(right)]
        case ir.Binary(op="and", left=left, right=right):
            return [one + other for one in _alternatives(left) for other in _alternatives(right)]
    return [1]


def _found_out(place: ir.Name, condition: ir.Expression) -> ir.Body:
    """place := condition, as INFORM says it: by a branch."""
    yes, no = ir.Assign(place, ir.BoolLiteral(True)), ir.Assign(place, ir.BoolLiteral(False))
    return (ir.If(((condition, (yes,)),), (no,)),)


def _is_true(place: ir.Name) -> ir.Expression:
    return ir.Binary("=", place, ir.BoolLiteral(True))


__all__ = ["short_conditions"]

"""Conditions of many parts in several statements, for targets whose lines are too short for them.

Parts of a chain of `and` (or of `or`) are put together in variables of their own, in order; all of them are computed,
as before. Short circuits and conditions that loops look at again stay as they are.
"""

from __future__ import annotations

from dataclasses import replace

from rpl import ir
from rpl.passes.legalise.context import Context
from rpl.passes.legalise.facts.effects import everything
from rpl.passes.legalise.rewriting.editing import Editor, edit_bodies, edit_routines, expansion, map_body
from rpl.passes.legalise.rewriting.jumps import inside
from rpl.passes.legalise.stages import legalising

from .. import tables

_CHAINS = ("and", "or")
_PLACES = (ir.Name, ir.Signal, ir.System)


@legalising()
def long_logic(program: ir.Program, context: Context) -> ir.Program:
    """A condition names so many variables and signals at most, to fit in a line."""
    most = tables.LOGIC_NAMES

    def work(editor: Editor, routine: ir.Routine) -> ir.Routine:
        def change(statement: ir.Statement) -> ir.Body:
            statement = inside(statement, lambda inner: map_body(inner, change))
            match statement:
                case ir.Assign(value=value) if _count(value) > most:
                    before, short = _shorter(value, editor, most)
                    return expansion(statement.origin, (*before, replace(statement, value=short)))
                case ir.If(branches=((condition, body), *rest)) if _count(condition) > most:
                    before, short = _shorter(condition, editor, most)
                    done = replace(statement, branches=((short, body), *rest))
                    return expansion(statement.origin, (*before, done))
            return (statement,)

        return edit_bodies(routine, lambda body: map_body(body, change))

    return edit_routines(program, context, work)


def _count(value: ir.Expression) -> int:
    """Variables and signals in the parts of a condition; a part has at least one."""
    match value:
        case ir.Binary(op="and" | "or" | "xor" | "cand" | "cor", left=left, right=right):
            return _count(left) + _count(right)
        case ir.Unary(op="not", operand=operand):
            return _count(operand)
    return max(1, sum(isinstance(one, _PLACES) for one in everything(value)))


def _shorter(value: ir.Expression, editor: Editor, most: int) -> tuple[list[ir.Statement], ir.Expression]:
    """The condition with at most so many names, and what computes the others in front."""
    before: list[ir.Statement] = []
    if isinstance(value, ir.Unary) and value.op == "not":
        before, short = _shorter(value.operand, editor, most)
        return before, replace(value, operand=short)
    if not isinstance(value, ir.Binary) or value.op not in _CHAINS:
        return before, value
    parts: list[ir.Expression] = []
    for part in _chain(value, value.op):
        first, short = _shorter(part, editor, most) if _count(part) > most else ([], part)
        before.extend(first)
        if parts and sum(map(_count, parts)) + _count(short) > most:
            kept = editor.temporary("part", ir.BoolType())
            before.append(ir.Assign(kept, _joined(parts, value.op)))
            parts = [kept]
        parts.append(short)
    return before, _joined(parts, value.op)


def _chain(value: ir.Expression, op: str) -> list[ir.Expression]:
    if isinstance(value, ir.Binary) and value.op == op:
        return [*_chain(value.left, op), *_chain(value.right, op)]
    return [value]


def _joined(parts: list[ir.Expression], op: str) -> ir.Expression:
    done = parts[0]
    for part in parts[1:]:
        done = ir.Binary(op, done, part)
    return done


__all__ = ["long_logic"]

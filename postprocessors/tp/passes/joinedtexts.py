"""Texts of many parts in several assignments: an instruction has so many operators at most."""

from __future__ import annotations

from dataclasses import replace

from rpl import ir
from rpl.passes.legalise.context import Context
from rpl.passes.legalise.rewriting.editing import Editor, edit_bodies, edit_routines, expansion, map_body
from rpl.passes.legalise.rewriting.jumps import inside
from rpl.passes.legalise.stages import legalising

from .. import tables


@legalising(sees=("operator &",))
def joined_texts(program: ir.Program, context: Context) -> ir.Program:
    """What is joined so far is kept in a register where the instruction is full."""

    def work(editor: Editor, routine: ir.Routine) -> ir.Routine:
        kept: list[ir.Name] = []  # serves one assignment after the other

        def change(statement: ir.Statement) -> ir.Body:
            match statement:
                case ir.Assign(value=ir.Binary(op="&") as value) if len(pieces := _pieces(value)) > _MOST:
                    if not kept:
                        kept.append(editor.temporary("step", ir.StringType()))
                    before, last = _in_turn(pieces, kept[0])
                    return expansion(statement.origin, (*before, replace(statement, value=last)))
            return (inside(statement, lambda inner: map_body(inner, change)),)

        return edit_bodies(routine, lambda body: map_body(body, change))

    return edit_routines(program, context, work)


_MOST = tables.LONGEST_PLAIN + 1


def _pieces(value: ir.Expression) -> list[ir.Expression]:
    """What is joined, from left to right."""
    if isinstance(value, ir.Binary) and value.op == "&":
        return [*_pieces(value.left), value.right]
    return [value]


def _in_turn(pieces: list[ir.Expression], kept: ir.Name) -> tuple[list[ir.Statement], ir.Expression]:
    """The first pieces joined in the variable, as often as the instruction is full, and the last value."""
    before: list[ir.Statement] = []
    done, count = pieces[0], 1
    for one in pieces[1:]:
        if count == _MOST:
            before.append(ir.Assign(kept, done))
            done, count = kept, 1
        done, count = ir.Binary("&", done, one), count + 1
    return before, done


__all__ = ["joined_texts"]

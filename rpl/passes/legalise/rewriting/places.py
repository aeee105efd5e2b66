"""Places that are handed to a routine: the same one before and behind the call."""

from __future__ import annotations

from dataclasses import replace

from rpl import ir
from rpl.passes.legalise.facts.effects import is_constant
from rpl.passes.legalise.rewriting.editing import Editor


def fixed_place(place: ir.Expression, before: list[ir.Statement], editor: Editor) -> ir.Expression:
    """The same place before and behind a call: what calculates its subscripts goes to `before`, once."""
    match place:
        case ir.Index(base=base, indices=indices):
            done = []
            for index in indices:
                if not is_constant(index):
                    kept = editor.temporary("subscript", editor.type_of(index) or ir.IntType())
                    before.append(ir.Assign(kept, index))
                    index = kept
                done.append(index)
            return replace(place, base=fixed_place(base, before, editor), indices=tuple(done))
        case ir.Field(base=base):
            return replace(place, base=fixed_place(base, before, editor))
    return place


def is_open(type: ir.Type) -> bool:
    """Is it a list of any length?"""
    return isinstance(type, ir.ArrayType) and None in type.dimensions

"""A move and a wait for its end, which other languages and listings say apart: the move itself ends exactly (FINE)."""

from __future__ import annotations

from rpl import ir
from rpl.passes.legalise.rewriting.editing import edit_all
from rpl.passes.legalise.rewriting.exactends import ending_exactly
from rpl.writing.target import WriteContext


def exact_ends(program: ir.Program, context: WriteContext) -> ir.Program:
    """Only remarks stand between the two."""
    return edit_all(program, ending_exactly)


__all__ = ["exact_ends"]

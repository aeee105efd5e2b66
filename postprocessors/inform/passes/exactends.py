"""A move and a wait for its end, which other languages say apart: the move itself ends exactly (PL=0).

Variables may be calculated between the two: a controller does that on the way, and the wait behind it has nothing to
wait for then.
"""

from __future__ import annotations

from rpl import ir
from rpl.ir.walk import walk
from rpl.passes.legalise.facts.effects import blocks
from rpl.passes.legalise.rewriting.editing import edit_all
from rpl.passes.legalise.rewriting.exactends import ending_exactly
from rpl.writing.target import WriteContext

# Routines that programs bring along and that only calculate.
_CALCULATING = frozenset(("rpl_length", "rpl_min", "rpl_max", "rpl_trunc", "rpl_floor", "rpl_frame", "rpl_tool_offset"))


def exact_ends(program: ir.Program, context: WriteContext) -> ir.Program:
    """The wait stays; behind an exact end it has nothing to wait for."""
    return edit_all(program, lambda body: ending_exactly(body, between=_calculates))


def _calculates(statement: ir.Statement) -> bool:
    """Neither signals, the controller's own variables nor the robot have a part in it."""
    match statement:
        case ir.Nothing():
            return True
        case ir.Assign() | ir.If():
            inner = [one for body in blocks(statement) for one in body]
        case ir.CallRoutine(name=name, dynamic=None) if name.lower() in _CALCULATING:
            inner = []
        case _:
            return False
    alone = not any(isinstance(one, ir.Signal | ir.System | ir.Call | ir.VendorValue) for one in walk(statement))
    seen = any(isinstance(one, ir.Builtin) and one.function.startswith("current_") for one in walk(statement))
    return alone and not seen and all(_calculates(one) for one in inner)


__all__ = ["exact_ends"]

"""Waits that begin when the robot stands, in two steps, for targets whose waits begin at once: first for the end of the
motion, then as before.
"""

from __future__ import annotations

from dataclasses import replace

from rpl import ir
from rpl.passes.legalise.context import Context
from rpl.passes.legalise.rewriting.editing import Editor, edit_bodies, edit_routines, map_body
from rpl.passes.legalise.rewriting.jumps import inside
from rpl.passes.legalise.stages import legalising


@legalising(unless=lambda context: context.capabilities.io.waits_at_rest, sees=("Wait", "WaitUntil"))
def resting_waits(program: ir.Program, context: Context) -> ir.Program:
    """Only for targets whose waits do not say it."""

    def split(statement: ir.Statement) -> ir.Body:
        done = inside(statement, lambda body: map_body(body, split))
        match done:
            case ir.Wait(in_position=True) | ir.WaitUntil(in_position=True):
                return (ir.WaitForMotion(origin=done.origin), replace(done, in_position=False))
        return (done,)

    def work(editor: Editor, routine: ir.Routine) -> ir.Routine:
        return edit_bodies(routine, lambda body: map_body(body, split))

    return edit_routines(program, context, work)


__all__ = ["resting_waits"]

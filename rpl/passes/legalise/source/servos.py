"""Targets handed over one by one (URScript servoj), for targets whose moves come to rest: each is the move to its place
in its time, which ends there even where the time is too short."""

from __future__ import annotations

from dataclasses import replace

from rpl import ir
from rpl.diagnostics import Severity, code
from rpl.passes.legalise.context import Context
from rpl.passes.legalise.rewriting.editing import Editor, edit_bodies, edit_routines
from rpl.passes.legalise.rewriting.jumps import inside
from rpl.passes.legalise.stages import legalising

STOPS = code(
    "servo-as-move",
    Severity.WARNING,
    "a place that the robot is driven towards for a time is written as a move to it in that time: it ends there, and"
    " comes to rest",
    "places that follow one another in short times make the robot stop and go: write their way as moves with corners",
)


@legalising(sees=("servo move",))
def servos(program: ir.Program, context: Context) -> ir.Program:
    """For every target of another language; the reader has told that it is read so."""

    def work(editor: Editor, routine: ir.Routine) -> ir.Routine:
        return edit_bodies(routine, classic)

    def classic(body: ir.Body) -> ir.Body:
        done = tuple(one(statement) for statement in body)
        return body if all(a is b for a, b in zip(done, body, strict=True)) else done

    def one(statement: ir.Statement) -> ir.Statement:
        if isinstance(statement, ir.Move) and statement.motion_class == "servo":
            context.diagnostics.report(STOPS, statement.origin)
            return replace(statement, motion_class="classic")
        return inside(statement, classic)

    return edit_routines(program, context, work)


__all__ = ["servos"]

"""Relative ways in joints (IMOV has distances only): the job works out the goal from where the robot is."""

from __future__ import annotations

from dataclasses import replace

from rpl import ir
from rpl.diagnostics import Severity, code
from rpl.passes.legalise.context import Context
from rpl.passes.legalise.facts.effects import blocks
from rpl.passes.legalise.rewriting.editing import edit_all
from rpl.passes.legalise.rewriting.jumps import inside
from rpl.passes.legalise.stages import legalising

STANDS = code(
    "relative-move-stands",
    Severity.WARNING,
    "this way in joints is worked out from where the robot is; the robot comes to rest in front of it",
    "teach the position, so that the move before can go over into this one",
)


@legalising(sees=("move relative to joints",))
def stand_before_ways(program: ir.Program, context: Context) -> ir.Program:
    """Where a way in joints begins the robot has to stand."""

    def stood(body: ir.Body) -> ir.Body:
        done: list[ir.Statement] = []
        joined = True  # by what was driven before the body
        for statement in body:
            statement = inside(statement, stood)
            if isinstance(statement, ir.Move) and statement.relative == "joints" and joined:
                if done and isinstance(done[-1], ir.Move):
                    context.diagnostics.report(STANDS, statement.origin)
                done.append(ir.WaitForMotion(origin=replace(statement.origin, comments=())))
            if isinstance(statement, ir.Move):
                joined = statement.blend not in (None, ir.BlendStop())
            elif isinstance(statement, ir.WaitForMotion):
                joined = False
            elif blocks(statement) or isinstance(statement, ir.CallRoutine | ir.Label):
                joined = True
            done.append(statement)
        return (
            body
            if len(done) == len(body) and all(one is two for one, two in zip(done, body, strict=True))
            else tuple(done)
        )

    return edit_all(program, stood)


__all__ = ["stand_before_ways"]

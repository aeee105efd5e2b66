"""What is done when a wait has taken too long: TIMEOUT jumps to it, and no flag keeps that it was so."""

from __future__ import annotations

from collections import Counter
from dataclasses import replace

from rpl import ir
from rpl.passes.legalise.context import Context
from rpl.passes.legalise.kinds import walk_for
from rpl.passes.legalise.rewriting.editing import edit_all, expansion
from rpl.passes.legalise.stages import legalising
from rpl.passes.rewrite import rewrite_bodies

from ..tables import TIMED_OUT


@legalising(sees=("WaitUntil",))
def limited_waits(program: ir.Program, context: Context) -> ir.Program:
    """A wait with a limit and the choice behind it are one jump, where nothing else reads the flag."""
    named = Counter(node.id.lower() for node in walk_for({"Name"}, *program.modules) if isinstance(node, ir.Name))

    def written(body: ir.Body) -> ir.Body:
        done: list[ir.Statement] = []
        at = 0
        while at < len(body):
            late = _late(body, at, named)
            if late is not None:
                done += _jumped(body[at], body[at + 1], late, context)
                at += 2
                continue
            done.append(body[at])
            at += 1
        body = tuple(done) if len(done) != len(body) else body
        inner = tuple([rewrite_bodies(one, written) for one in body])
        return body if all(one is other for one, other in zip(inner, body, strict=True)) else inner

    done = edit_all(program, written)
    if done is program:
        return program
    home = done.modules[0]
    flag = ir.Variable(TIMED_OUT, ir.BoolType(), scope="global")
    return replace(done, modules=(replace(home, declarations=(*home.declarations, flag)), *done.modules[1:]))


def _late(body: ir.Body, at: int, named: Counter[str]) -> ir.Body | None:
    """What is done when the limit of the wait at this place has passed; None where the flag is wanted."""
    match body[at : at + 2]:
        case (ir.WaitUntil(timed_out=ir.Name(id=flag)), ir.If(branches=((ir.Name(id=asked), late),), otherwise=())):
            return late if asked.lower() == flag.lower() and named[flag.lower()] == 2 else None
    return None


def _jumped(wait: ir.Statement, choice: ir.Statement, late: ir.Body, context: Context) -> ir.Body:
    assert isinstance(wait, ir.WaitUntil) and isinstance(choice, ir.If)  # what `_late` found
    flag = ir.Name(TIMED_OUT)
    wait = replace(wait, timed_out=flag)
    match late:
        case (ir.Goto(),):
            return (wait, replace(choice, branches=((flag, late),)))
    there, behind = context.fresh("too_late"), context.fresh("in_time")
    jump = ir.If(((flag, (ir.Goto(there),)),))
    ways = expansion(choice.origin, (jump, ir.Goto(behind), ir.Label(there)))
    return (wait, *ways, *late, ir.Label(behind))


__all__ = ["limited_waits"]

"""Outputs that a program switches at a distance from the end of a straight move, for which it waits beside the move (V+
`WAIT DISTANCE(HERE, DEST) <= d`, `SIGNAL n`, up to `BREAK`): actions on the path, as the other languages say them.
"""

from __future__ import annotations

from dataclasses import replace
from math import inf

from rpl import ir
from rpl.passes.legalise.context import Context, rules_of
from rpl.passes.legalise.kinds import walk_for
from rpl.passes.legalise.rewriting.editing import edit_all
from rpl.passes.legalise.rewriting.jumps import inside
from rpl.passes.legalise.stages import legalising
from rpl.passes.rewrite import same
from rpl.source import Comment

_HERE = ir.Builtin("pose_of", (ir.Builtin("current_target", ()),))
_GOAL = ir.Builtin("pose_of", (ir.System("end_pose"),))
_TO_THE_END = ir.Builtin("distance", (ir.Field(_HERE, "trans"), ir.Field(_GOAL, "trans")))


@legalising(
    unless=lambda context: (
        context.capabilities.carries_rules or rules_of(context.target).advance.runs_ahead_of == "begun"
    ),
    sees=("WaitUntil",),
)
def place_waits(program: ir.Program, context: Context) -> ir.Program:
    """For targets whose programs do not wait beside a move as a matter of course."""
    waits = (node for node in walk_for({"WaitUntil"}, *program.modules) if isinstance(node, ir.WaitUntil))
    return edit_all(program, _with_actions) if any(_nearest(one) is not None for one in waits) else program


def _nearest(wait: ir.WaitUntil) -> ir.IntLiteral | ir.RealLiteral | None:
    """How far from the end of the move the program goes on, if that is what it waits for (mm)."""
    match wait:
        case ir.WaitUntil(ir.Binary("<" | "<=", left, ir.IntLiteral() | ir.RealLiteral() as limit), None):
            return limit if left == _TO_THE_END and limit.value > 0 else None
    return None


def _with_actions(body: ir.Body) -> ir.Body:
    done: list[ir.Statement] = []
    at = 0
    while at < len(body):
        statement = body[at]
        at += 1
        match statement:
            case ir.Move(kind="linear", search=None, concurrent=False):
                actions, at = _actions(body, at)
                done += [*actions, replace(statement, blend=ir.BlendStop()) if actions else statement]
            case _:
                done.append(inside(statement, _with_actions))
    return body if same(done, body) else tuple(done)


def _actions(body: ir.Body, begin: int) -> tuple[list[ir.Statement], int]:
    """The actions from there on, behind a move, and where the stop stands that follows them. None where the program
    does anything else there."""
    actions: list[ir.Statement] = []
    asked: ir.Expression | None = None
    nearest: float = inf
    told: tuple[Comment, ...] = ()
    for at in range(begin, len(body)):
        statement = body[at]
        match statement:
            case ir.WaitUntil():
                limit = _nearest(statement)
                if limit is None or limit.value >= nearest:
                    break
                nearest, asked = limit.value, ir.Unary("-", limit)
                told = (*told, *statement.origin.comments)
            case ir.Assign(ir.Signal("digital_out", ir.IntLiteral()), ir.BoolLiteral()) if asked is not None:
                origin = replace(statement.origin, comments=(*told, *statement.origin.comments))
                action = replace(statement, origin=replace(statement.origin, comments=()))
                actions.append(ir.Trigger("end", action, asked, origin=origin))
                told = ()
            case ir.WaitForMotion() if not told:
                return actions, at if actions else begin
            case _:
                break
    return [], begin


__all__ = ["place_waits"]

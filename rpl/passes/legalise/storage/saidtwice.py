"""What one statement of the source became twice in a row is written once: a language sets the speed of six axes one by
one where another has one number for all, and a refused statement of several parts is one stop or one remark. What the
source itself says twice stays.
"""

from __future__ import annotations

from collections.abc import Iterator
from itertools import takewhile

from rpl import ir
from rpl.ir.walk import walk
from rpl.passes.legalise.context import Context
from rpl.passes.legalise.rewriting.editing import edit_all
from rpl.passes.legalise.rewriting.stopping import is_left_out
from rpl.passes.legalise.stages import legalising
from rpl.passes.rewrite import rewrite_bodies

__all__ = ["said_once"]

_CHANGING = (ir.Call, ir.Builtin, ir.VendorValue, ir.Signal, ir.System)


@legalising()
def said_once(program: ir.Program, context: Context) -> ir.Program:
    """The program without assignments that the one in front of them, of the same statement of the source, has made, and
    without what is left of a statement behind its stop."""
    return edit_all(program, _body)


def _body(body: ir.Body) -> ir.Body:
    done: list[ir.Statement] = []
    for at, statement in enumerate(body):
        inner = rewrite_bodies(statement, _body)
        if isinstance(inner, ir.Opaque) and not any(isinstance(one, ir.Move) for one in _rest(body, at)):
            while done and isinstance(done[-1], ir.Trigger) and _of_one(done[-1], inner):
                done.pop()  # an action of a refused move is refused with it
        if not (done and _again(done[-1], inner)):
            done.append(inner)
    return body if len(done) == len(body) and all(map(_same, done, body)) else tuple(done)


def _same(one: ir.Statement, other: ir.Statement) -> bool:
    return one is other


def _of_one(first: ir.Statement, second: ir.Statement) -> bool:
    """Are both made of one statement of the source?"""
    one, other = first.origin, second.origin
    return one.source is not None and one.source is other.source and one.start == other.start


def _rest(body: ir.Body, at: int) -> Iterator[ir.Statement]:
    """What follows there of the same statement of the source."""
    return takewhile(lambda one: _of_one(body[at], one), body[at + 1 :])


def _again(first: ir.Statement, second: ir.Statement) -> bool:
    """Does the second do what the first has just done? Nothing then lies between that could have changed the place."""
    if is_left_out(second):
        return _of_one(first, second) and (isinstance(first, ir.Opaque) or is_left_out(first))
    if not isinstance(first, ir.Assign | ir.Opaque) or first != second or second.origin.comments:
        return False
    if not isinstance(first, ir.Assign) or not isinstance(second, ir.Assign):
        return isinstance(first, ir.Opaque) and _of_one(first, second)
    if first.origin.source is not second.origin.source or first.origin.start != second.origin.start:
        return False
    place = [node for node in walk(first.target) if isinstance(node, ir.Name)]
    parts = list(walk(first.value, *(first.target.indices if isinstance(first.target, ir.Index) else ())))
    return not any(isinstance(node, _CHANGING) or node in place for node in parts) and not any(
        isinstance(node, ir.Signal) for node in walk(first.target)
    )

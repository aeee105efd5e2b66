"""Choices whose condition is always the same: what is never done goes, what is always done stands without a choice.

INFORM compares variables and signals, so it has no condition that is simply true.
"""

from __future__ import annotations

from rpl import ir
from rpl.ir.walk import walk
from rpl.passes.legalise.rewriting.editing import edit_all
from rpl.passes.rewrite import changed, rewrite_bodies, same
from rpl.writing.target import WriteContext


def taken_branches(program: ir.Program, context: WriteContext) -> ir.Program:
    """The program without branches that are never taken; one that a jump goes into stays."""
    return edit_all(program, _body)


def _body(body: ir.Body) -> ir.Body:
    done: list[ir.Statement] = []
    for statement in body:
        one = rewrite_bodies(statement, _body)
        done += _decided(one) if isinstance(one, ir.If) else (one,)
    return body if same(done, body) else tuple(done)


def _decided(choice: ir.If) -> ir.Body:
    kept: list[tuple[ir.Expression, ir.Body]] = []
    never: list[ir.Body] = []
    otherwise = choice.otherwise
    for at, (condition, body) in enumerate(choice.branches):
        if condition == ir.BoolLiteral(True):
            never += [*(later for _, later in choice.branches[at + 1 :]), otherwise]
            otherwise = body
            break
        if condition == ir.BoolLiteral(False):
            never.append(body)
        else:
            kept.append((condition, body))
    if len(kept) == len(choice.branches) or any(isinstance(node, ir.Label) for node in walk(*never)):
        return (choice,)
    if kept:
        return (changed(choice, branches=tuple(kept), otherwise=otherwise),)
    remarks = (ir.Nothing(origin=choice.origin),) if choice.origin.comments else ()
    return (*remarks, *otherwise)


__all__ = ["taken_branches"]

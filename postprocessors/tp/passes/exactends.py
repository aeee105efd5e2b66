"""A move and a wait for its end, which other languages and listings say apart: the move itself ends exactly (FINE)."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace

from rpl import ir
from rpl.passes.legalise.facts.effects import blocks
from rpl.passes.legalise.rewriting.editing import edit_all
from rpl.passes.rewrite import rewrite_bodies
from rpl.writing.target import WriteContext


def exact_ends(program: ir.Program, context: WriteContext) -> ir.Program:
    """The wait stays; behind an exact end it has nothing to wait for."""
    return edit_all(program, _body)


def _body(body: ir.Body) -> ir.Body:
    done = [rewrite_bodies(one, _body) if blocks(one) else one for one in body]
    for at, statement in enumerate(done):
        if isinstance(statement, ir.Move) and _awaited(body[at + 1 :]):
            done[at] = replace(statement, blend=ir.BlendStop())
    return body if all(new is old for new, old in zip(done, body, strict=True)) else tuple(done)


def _awaited(rest: Iterable[ir.Statement]) -> bool:
    return isinstance(next((one for one in rest if not isinstance(one, ir.Nothing)), None), ir.WaitForMotion)

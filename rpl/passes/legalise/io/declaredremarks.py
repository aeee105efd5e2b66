"""Remarks at declarations, for targets that declare nothing because their data have numbers: they stand by themselves.

Registers and points of such targets are made, folded into the lines that use them or gathered elsewhere; the remark of
a declaration stays where the declaration stood. One behind a declaration on its line says what it is about.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

from rpl import ir
from rpl.passes.legalise.context import Context
from rpl.passes.legalise.stages import legalising


@legalising(unless=lambda context: not context.capabilities.storage.banks)
def declared_remarks(program: ir.Program, context: Context) -> ir.Program:
    """Only for targets with numbered data."""
    return replace(program, modules=tuple(map(_of_module, program.modules)))


def _of_module(module: ir.Module) -> ir.Module:
    declarations = tuple(_apart(module.declarations))
    routines = tuple(replace(one, declarations=tuple(_apart(one.declarations))) for one in module.routines)
    return replace(module, declarations=declarations, routines=routines)


def _apart(declarations: tuple[ir.Declaration, ...]) -> Iterator[ir.Declaration]:
    for one in declarations:
        origin = one.origin
        if not origin.comments or isinstance(one, ir.Unread):
            yield one
            continue
        name = getattr(one, "name", "")
        said = tuple(
            replace(comment, text=f" {name}: {comment.text.strip()}", behind=False)
            if comment.behind and name and comment.text.strip()
            else comment
            for comment in origin.comments
        )
        yield ir.Unread("", origin=replace(origin, comments=said))
        yield replace(one, origin=replace(origin, comments=()))


__all__ = ["declared_remarks"]

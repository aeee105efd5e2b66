"""Marks of the source's editor (folds and what its dialogs keep in them), which mean nothing to another controller.

Programs that stay in their language keep them, and so does the universal one, from which they may come back.
"""

from __future__ import annotations

from dataclasses import replace
from typing import cast

from rpl import ir
from rpl.ir.walk import rewrite, walk
from rpl.passes.legalise.context import Context
from rpl.passes.legalise.stages import legalising
from rpl.source import Origin


@legalising()
def source_layout(program: ir.Program, context: Context) -> ir.Program:
    """The program without marks of editors."""
    del context
    modules = tuple(_without(one) if any(map(_has_marks, walk(one))) else one for one in program.modules)
    return replace(program, modules=modules)


def _has_marks(node: object) -> bool:
    origin = getattr(node, "origin", None)
    return isinstance(origin, Origin) and any(comment.layout for comment in origin.comments)


def _without(module: ir.Module) -> ir.Module:
    def change(node: object) -> object:
        if not _has_marks(node):
            return node
        origin = cast("ir.Statement", node).origin
        left = tuple(comment for comment in origin.comments if not comment.layout)
        return replace(cast("ir.Statement", node), origin=replace(origin, comments=left))

    return rewrite(module, change)


__all__ = ["source_layout"]

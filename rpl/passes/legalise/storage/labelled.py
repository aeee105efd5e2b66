"""What a numbered variable is called in its controller (`R[6:height]`) stands as a remark behind its declaration where
variables have names: `R6` alone says nothing to the person who reads the program.
"""

from __future__ import annotations

from dataclasses import replace

from rpl import ir
from rpl.passes.legalise.context import Context
from rpl.passes.legalise.stages import legalising
from rpl.source import Comment

__all__ = ["labels_as_remarks"]


@legalising(unless=lambda context: context.capabilities.storage.banks)
def labels_as_remarks(program: ir.Program, context: Context) -> ir.Program:
    """Only for targets whose variables have names; numbered ones have a place for the label itself."""
    modules = (replace(module, declarations=tuple(map(_remarked, module.declarations))) for module in program.modules)
    return replace(program, modules=tuple(modules))


def _remarked(declaration: ir.Declaration) -> ir.Declaration:
    if not isinstance(declaration, ir.Variable) or not declaration.label:
        return declaration
    said = declaration.origin.comments
    if any(comment.behind for comment in said):
        return declaration
    remark = Comment(declaration.label, behind=True)
    return replace(declaration, origin=replace(declaration.origin, comments=(*said, remark)))

"""Neutral functions that a target lacks, as functions of the program in terms of others: poses turned to the axes, the
middle of an arc, numbers rounded to a computed count of decimals.

Runs before the passes that find words for products of poses, rotation vectors and texts.
"""

from __future__ import annotations

from typing import TypeGuard

from rpl import ir
from rpl.passes.capabilities import TextRule
from rpl.passes.legalise.context import Context
from rpl.passes.legalise.kinds import walk_for
from rpl.passes.legalise.rewriting.library import common_library
from rpl.passes.legalise.rewriting.walk import Rewriter
from rpl.passes.legalise.stages import legalising

_ROUNDED = {"round": "rpl_round", "trunc": "rpl_cut"}
_HELPERS = {
    "aligned": "rpl_aligned",
    "arc_middle": "rpl_arc_middle",
}


@legalising(unless=lambda context: context.capabilities.carries_rules)
def neutral_functions(program: ir.Program, context: Context) -> ir.Program:
    """The program without the functions of this kind that the target has no word for."""
    worker = _Functions(program, context)
    if not any(worker.lacks(node) for node in walk_for({"Builtin"}, *program.modules)):
        return program
    return worker.helpers.added_to(worker.program())


class _Functions(Rewriter):
    def __init__(self, program: ir.Program, context: Context) -> None:
        super().__init__(program, context)
        self.helpers = common_library(context)

    def lacks(self, node: object) -> TypeGuard[ir.Builtin]:
        can = self.context.capabilities
        match node:
            case ir.Builtin(function=("round" | "trunc"), arguments=(_, decimals)):
                return TextRule.COMPUTED_DECIMALS not in can.texts.rules and not isinstance(decimals, ir.IntLiteral)
            case ir.Builtin(function=("aligned" | "arc_middle")):
                return node.function not in can.functions
        return False

    def expression(self, expression: ir.Expression) -> ir.Expression:
        done = super().expression(expression)
        if not self.lacks(done) or not isinstance(expression, ir.Builtin):
            return done
        if done.function in _ROUNDED:
            return self.helpers.call(_ROUNDED[done.function], *done.arguments)
        types = [self.type_of(one) for one in expression.arguments]
        poses = [
            ir.Builtin("pose_of", (one,)) if isinstance(type, ir.TargetType) else one
            for one, type in zip(done.arguments, types, strict=True)
        ]
        pose = self.helpers.call(_HELPERS[done.function], *poses)
        if done.function == "aligned" or not isinstance(types[-1], ir.TargetType):
            return pose
        way = ir.Binary(":", pose, ir.Builtin("inverse", (poses[-1],)))
        return ir.Builtin("displaced", (done.arguments[-1], way), origin=done.origin)


__all__ = ["neutral_functions"]

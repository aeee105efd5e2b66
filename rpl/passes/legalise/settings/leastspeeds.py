"""The smaller of two speeds, where the target has no function for it."""

from __future__ import annotations

from rpl import ir
from rpl.passes.legalise.context import Context
from rpl.passes.legalise.kinds import rewrite_for
from rpl.passes.legalise.rewriting.library import common_library


def with_least(program: ir.Program, context: Context) -> ir.Program:
    """The limits of speeds asked for here, where the target has no function for the smaller of two numbers."""
    if "min" in context.capabilities.functions:
        return program
    helpers = common_library(context)

    def change(node: object) -> object:
        least = isinstance(node, ir.Builtin) and node.function == "min"
        return helpers.call("rpl_min", *node.arguments) if least and isinstance(node, ir.Builtin) else node

    return helpers.added_to(rewrite_for({"function min"}, program, change))


__all__ = ["with_least"]

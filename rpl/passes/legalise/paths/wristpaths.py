"""Paths whose wrist axes go evenly to their end values, for targets whose paths always turn the tool evenly.

The tool's point goes the same way and both ends are the same; only how the tool is turned between them differs.
"""

from __future__ import annotations

from dataclasses import replace

from rpl import ir
from rpl.diagnostics import Severity, code
from rpl.ir.walk import rewrite
from rpl.passes.capabilities import PathRule
from rpl.passes.legalise.context import Context
from rpl.passes.legalise.stages import legalising

EVEN_TURN = code(
    "wrist-path-turned",
    Severity.WARNING,
    "the wrist axes of this path go evenly to their end values; in the target the tool turns evenly instead: "
    "it goes the same way and ends the same, but is turned otherwise in between",
    "look at the turn of the tool on the way, and for axis 5 near 0, which such paths are often chosen for",
)


@legalising(unless=lambda context: PathRule.EVEN_WRIST in context.capabilities.motion.paths)
def wrist_paths(program: ir.Program, context: Context) -> ir.Program:
    """Only for targets without such paths."""
    reported = False

    def turned(node: object) -> object:
        nonlocal reported
        if not isinstance(node, ir.Move) or node.orientation != "wrist":
            return node
        if not reported:
            context.diagnostics.report(EVEN_TURN, node.origin)
            reported = True
        return replace(node, orientation=None)

    modules = tuple(
        replace(module, routines=tuple(rewrite(routine, turned) for routine in module.routines))
        for module in program.modules
    )
    return replace(program, modules=modules) if reported else program


__all__ = ["wrist_paths"]

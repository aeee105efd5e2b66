"""Numbered blend levels become distances, for targets without levels: by the distances that the source's rules give."""

from __future__ import annotations

from dataclasses import replace

from rpl import ir
from rpl.diagnostics import Severity, code
from rpl.ir.walk import rewrite
from rpl.passes.legalise.context import Context, rules_of

AS_DISTANCE = code(
    "level-as-distance",
    Severity.WARNING,
    "positioning level {level} is written as a blend of {size:g} mm; on the controller it is a parameter of the arm",
)


def levels_to_distances(program: ir.Program, context: Context) -> ir.Program:
    """Constant levels by their distance; the size of a computed one is chosen at run time by the writer's own means."""
    levels = rules_of(context.source).blend_levels
    if not levels or "BlendLevel" in context.capabilities.blends:
        return program
    reported: set[int] = set()

    def change(node: object) -> object:
        if not isinstance(node, ir.Move | ir.MoveExternal | ir.Spline) or not isinstance(node.blend, ir.BlendLevel):
            return node
        number = node.blend.level
        if not isinstance(number, ir.IntLiteral):
            return node
        size = levels[number.value] if 0 <= number.value < len(levels) else 0.0
        if size == 0.0:
            return replace(node, blend=ir.BlendStop())
        if number.value not in reported:
            reported.add(number.value)
            context.diagnostics.report(AS_DISTANCE, node.origin, level=number.value, size=size)
        return replace(node, blend=ir.BlendDistance(ir.RealLiteral(size)))

    return rewrite(program, change)

"""Numbered blend levels become distances, for targets without levels: by the distances that the source's rules give.

A level that the run chooses (`PL=B000`) is looked up by a routine that the program brings along; the move stands twice
then, with a corner and, for level 0, with a stop.
"""

from __future__ import annotations

from dataclasses import replace

from rpl import ir
from rpl.diagnostics import Severity, code
from rpl.ir.walk import rewrite
from rpl.passes.legalise.context import Context, rules_of
from rpl.passes.legalise.facts.effects import Effects
from rpl.passes.legalise.kinds import walk_for
from rpl.passes.legalise.rewriting.editing import Editor, edit_bodies, edit_routines, map_body
from rpl.passes.legalise.rewriting.jumps import inside
from rpl.passes.legalise.rewriting.library import common_library
from rpl.passes.legalise.stages import legalising

AS_DISTANCE = code(
    "level-as-distance",
    Severity.WARNING,
    "positioning level {level} is written as a blend of {size:g} mm; on the controller it is a parameter of the arm",
)
BY_RUN = code(
    "level-at-run-as-distance",
    Severity.WARNING,
    "the positioning level {level} is looked up as a blend of {least:g} to {most:g} mm; on the controller they are "
    "parameters of the arm",
)
_CORNER = "rpl_corner"


@legalising(
    unless=lambda context: (
        not rules_of(context.source).blend_levels or "BlendLevel" in context.capabilities.settings.blends
    )
)
def levels_to_distances(program: ir.Program, context: Context) -> ir.Program:
    """Constant levels by their distance; computed ones where they change nothing else."""
    levels = rules_of(context.source).blend_levels
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

    return _computed(rewrite(program, change), context, levels)


def _computed(program: ir.Program, context: Context, levels: tuple[float, ...]) -> ir.Program:
    """Moves whose level the run chooses."""
    if not any(
        isinstance(one, ir.Move) and isinstance(one.blend, ir.BlendLevel)
        for one in walk_for({"Move"}, *program.modules)
    ):
        return program
    helpers, effects = common_library(context, {_CORNER: _text(levels)}), Effects(program)

    def chosen(statement: ir.Statement) -> ir.Body:
        if not isinstance(statement, ir.Move) or not isinstance(statement.blend, ir.BlendLevel):
            return (inside(statement, lambda inner: map_body(inner, chosen)),)
        level = statement.blend.level
        if not effects.quiet(level):
            return (statement,)
        sizes = [size for size in levels if size > 0.0]
        context.diagnostics.report(BY_RUN, statement.origin, level=_shown(level), least=min(sizes), most=max(sizes))
        bare = replace(statement, origin=replace(statement.origin, comments=()))
        through = replace(bare, blend=ir.BlendDistance(helpers.call(_CORNER, level)))
        branch = ir.Binary(">", level, ir.IntLiteral(0))
        stop = replace(bare, blend=ir.BlendStop())
        return (ir.If(((branch, (through,)),), (stop,), origin=statement.origin),)

    def work(editor: Editor, routine: ir.Routine) -> ir.Routine:
        return edit_bodies(routine, lambda body: map_body(body, chosen))

    return helpers.added_to(edit_routines(program, context, work))


def _text(levels: tuple[float, ...]) -> str:
    """The routine that gives the distance of a level."""
    cases = (f"    IF level = {number} THEN RETURN {size}" for number, size in enumerate(levels) if size > 0.0)
    return f"\nFUNCTION {_CORNER}(level: INT): REAL\n" + "\n".join(cases) + "\n    RETURN 0.0\nEND FUNCTION\n"


def _shown(level: ir.Expression) -> str:
    return level.id if isinstance(level, ir.Name) else "that the program works out"


__all__ = ["levels_to_distances"]

"""Whether moves are joined (`blending`, V+ CPON and CPOFF) at the moves themselves, for targets whose moves say so
themselves: where a program only ever sets it to what the source's controller starts with, every move that says nothing
is so.

A program that really changes it keeps the switch, and later passes name what the target makes of it.
"""

from __future__ import annotations

from dataclasses import replace

from rpl import ir
from rpl.ir.walk import rewrite, walk
from rpl.passes.legalise.context import Context, rules_of
from rpl.passes.legalise.editing import edit_bodies, map_body
from rpl.passes.legalise.jumps import inside

_JOINED = ir.System("blending")


def joined_moves(program: ir.Program, context: Context) -> ir.Program:
    """Only for targets whose moves say all their settings, and where the switch never has another value."""
    start = rules_of(context.source).system_defaults.get("blending")
    if (
        context.capabilities.modal_motion
        or "blending" in context.capabilities.system_variables
        or not isinstance(start, bool)
    ):
        return program
    given = [
        value
        for node in walk(*program.modules)
        for setting, value in _settings(node)
        if isinstance(setting, ir.System) and setting.name == "blending"
    ]
    if not given or any(value != ir.BoolLiteral(start) for value in given):
        return program
    blend: ir.Blend = ir.BlendSpeed(ir.IntLiteral(100)) if start else ir.BlendStop()

    def change(statement: ir.Statement) -> ir.Body:
        if any(setting == _JOINED for setting, _ in _settings(statement)) and not isinstance(statement, ir.Move):
            return (ir.Nothing(origin=statement.origin),) if statement.origin.comments else ()
        return (inside(statement, lambda body: map_body(body, change)),)

    def moved(node: object) -> object:
        if not isinstance(node, ir.Move):
            return node
        kept = tuple(pair for pair in node.settings if pair[0] != _JOINED)
        return replace(node, settings=kept, blend=blend if node.blend is None else node.blend)

    modules = tuple(
        replace(
            module, routines=tuple(edit_bodies(one, lambda body: map_body(body, change)) for one in module.routines)
        )
        for module in program.modules
    )
    return replace(program, modules=tuple(rewrite(module, moved) for module in modules))


def _settings(node: object) -> tuple[tuple[ir.Expression, ir.Expression], ...]:
    match node:
        case ir.Assign(target=ir.System() as setting, value=value):
            return ((setting, value),)
        case ir.SetForNextMove(setting=setting, value=value):
            return ((setting, value),)
        case ir.Move(settings=settings):
            return settings
    return ()


__all__ = ["joined_moves"]

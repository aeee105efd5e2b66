"""Straight and circular moves to joint values, for targets where such moves go to places only."""

from __future__ import annotations

from dataclasses import replace

from rpl import ir
from rpl.passes.capabilities import PathRule
from rpl.passes.legalise.context import Context
from rpl.passes.legalise.rewriting.editing import Editor, edit_bodies, edit_routines, map_body
from rpl.passes.legalise.rewriting.jumps import inside
from rpl.passes.legalise.stages import legalising


@legalising(unless=lambda context: PathRule.TO_JOINTS in context.capabilities.motion.paths)
def joint_goals(program: ir.Program, context: Context) -> ir.Program:
    """Only for targets that say so."""

    def work(editor: Editor, routine: ir.Routine) -> ir.Routine:
        def place(value: ir.Expression, move: ir.Move) -> ir.Expression:
            if not isinstance(editor.type_of(value), ir.JointsType):
                return value
            known = (move.tool,) if move.frame is None else (move.tool or ir.System("tool"), move.frame)
            return ir.Builtin("joints_to_target", (value, *(one for one in known if one is not None)))

        def change(statement: ir.Statement) -> ir.Body:
            match statement:
                case ir.Move(kind="linear" | "circular", relative=None, target=target, via=via):
                    goal = place(target, statement)
                    through = None if via is None else place(via, statement)
                    if goal is not target or through is not via:
                        return (replace(statement, target=goal, via=through),)
                    return (statement,)
            return (inside(statement, lambda inner: map_body(inner, change)),)

        return edit_bodies(routine, lambda body: map_body(body, change))

    return edit_routines(program, context, work)


__all__ = ["joint_goals"]

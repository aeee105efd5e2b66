"""What an arm of four axes with an upright tool makes of steps that are written for any arm: the joints it has not got
are 0, and a move that lays the tool along an axis of the world (V+ ALIGN) leaves it as it is.
"""

from __future__ import annotations

from dataclasses import replace

from rpl import ir
from rpl.ir.walk import rewrite
from rpl.passes.legalise.context import Context
from rpl.passes.legalise.rewriting.editing import Editor, edit_bodies, edit_routines, map_body
from rpl.passes.legalise.rewriting.jumps import inside
from rpl.passes.legalise.stages import legalising

_UPRIGHT = 4


@legalising()
def axes_of_arm(program: ir.Program, context: Context) -> ir.Program:
    """Only for such an arm, on both sides."""
    arms = [arm for arm in (context.robot, context.to_robot) if arm is not None]
    if not arms or any(arm.axes != _UPRIGHT for arm in arms):
        return program
    missing = {f"j{number}" for number in range(_UPRIGHT + 1, 7)}

    def work(editor: Editor, routine: ir.Routine) -> ir.Routine:
        def part(node: object) -> object:
            if not isinstance(node, ir.Field) or node.name not in missing:
                return node
            return ir.RealLiteral(0.0) if isinstance(editor.type_of(node.base), ir.JointsType) else node

        def change(statement: ir.Statement) -> ir.Body:
            match statement:
                case ir.Move(target=ir.Builtin(function="aligned"), search=None):
                    return (ir.Nothing(origin=statement.origin),) if statement.origin.comments else ()
                case ir.Assign(value=value):
                    return (replace(statement, value=rewrite(value, part)),)
            return (inside(statement, lambda body: map_body(body, change)),)

        return edit_bodies(routine, lambda body: map_body(body, change))

    return edit_routines(program, context, work)

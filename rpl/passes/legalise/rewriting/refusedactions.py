"""What is left of an interrupt that is refused where it is declared, and of a routine for all errors that is refused
where it is set: its action never runs.

The statements of its routine that only make sense in one (stop the motion, let it go on, leave a level, go on behind
what has failed) are remarks there, so that the refusal stands once. Here also stand the refusals of actions that
passes of several targets report.
"""

from __future__ import annotations

from collections.abc import Collection

from rpl import ir
from rpl.diagnostics import Severity, code
from rpl.ir.walk import bodies, walk
from rpl.passes.legalise.facts.effects import children
from rpl.passes.legalise.facts.usage import called_below
from rpl.passes.legalise.rewriting.editing import edit_bodies, edit_each, map_body
from rpl.passes.legalise.rewriting.jumps import inside
from rpl.passes.legalise.rewriting.stopping import left_out

__all__ = ["BRAKED", "ON_JOINT_MOVE", "REFUSED", "STAYS", "without_actions"]

BRAKED = code(
    "braked-move-lost",
    Severity.LOSS,
    "{action} brakes the robot in the middle of a move that goes on behind it; the target's brake drops the move",
    "let the move end at the condition, or drop it by a word of its own and command what is to follow",
    stops=True,
)
STAYS = code(
    "motion-stays-stopped",
    Severity.LOSS,
    "{routine} stops the robot, and lets it go on in a branch, in another routine or before it has ended: on the target"
    " it goes on when the interrupt routine ends",
    "start the motion again in the routine that stops it, behind everything that takes time",
    stops=True,
)
ON_JOINT_MOVE = code(
    "path-event-on-joint-move",
    Severity.LOSS,
    "an action comes before the end of a joint move, which the target cuts nowhere",
    "drive straight there, or do it at the end",
    stops=True,
)
REFUSED = "its interrupt is refused where it is declared"
_ONLY_THERE = (ir.StopMotion, ir.StartMotion, ir.ClearMotion, ir.StoreMotion, ir.ResumeLevel, ir.TryNext, ir.Retry)
_WHICH = ("interrupt_number", "error_number")


def without_actions(
    program: ir.Program,
    refused: Collection[ir.DeclareInterrupt | ir.ConnectInterrupt | ir.OnError],
    why: str = REFUSED,
) -> ir.Program:
    """The program with remarks in the routines that only these statements (as they stand in it) would run."""
    actions = [one.action if isinstance(one, ir.DeclareInterrupt) else one for one in refused]
    dead = called_below(program, {_called(one) for one in actions})
    gone = {id(one) for one in actions}
    while dead:
        used = {task.entry.lower() for task in program.tasks} | {(program.entry or "").lower()}
        for routine in (routine for module in program.modules for routine in module.routines):
            if routine.name.lower() not in dead:
                used |= {_called(node) for node in walk(*bodies(routine)) if id(node) not in gone}
        if not dead & used:
            break
        dead -= called_below(program, set(dead & used))

    def change(statement: ir.Statement) -> ir.Body:
        if isinstance(statement, _ONLY_THERE) or any(map(_asks, children(statement))):
            return (left_out(statement, why),)
        return (inside(statement, lambda body: map_body(body, change)),)

    def work(module: ir.Module, routine: ir.Routine) -> ir.Routine:
        if routine.name.lower() not in dead:
            return routine
        return edit_bodies(routine, lambda body: map_body(body, change))

    return edit_each(program, work)


def _asks(expression: ir.Expression) -> bool:
    """Does it ask which interrupt has come, or which error?"""
    return any(isinstance(one, ir.System) and one.name in _WHICH for one in walk(expression))


def _called(node: object) -> str:
    match node:
        case ir.CallRoutine(name=name) | ir.Call(name=name) | ir.ConnectInterrupt(routine=name):
            return name.lower()
        case ir.TaskControl(task=name):
            return name.lower()
        case ir.OnError(routine=str(name)):
            return name.lower()
    return ""

"""Questions about the motion, and stops of it, where the robot rests anyway: behind a move without a corner, in a
program whose moves hold the task until they have ended, where no other task moves the robot.

Whether the robot moves is then known (it does not), and to stop it and forget what was to come says nothing.
"""

from __future__ import annotations

from collections.abc import Sequence

from rpl import ir
from rpl.ir.walk import rewrite, walk
from rpl.passes.legalise.context import Context, rules_of
from rpl.passes.legalise.facts.forward import reactions, started
from rpl.passes.legalise.facts.motion.resting import Rests
from rpl.passes.legalise.interrupts.tasks.criticals import Facts
from rpl.passes.legalise.kinds import walk_for
from rpl.passes.legalise.rewriting.editing import edit_bodies, edit_each, map_body
from rpl.passes.legalise.rewriting.jumps import inside
from rpl.passes.legalise.stages import legalising
from rpl.passes.rewrite import rewrite_parts

_MOTION = (ir.Move, ir.MoveExternal, ir.Spline)
_INTERRUPTS = (ir.DeclareInterrupt, ir.ConnectInterrupt, ir.Trigger, ir.DefineTrigger, ir.OnError)
_STOPS = (ir.StopMotion, ir.ClearMotion, ir.StartMotion)
_MOVING = ir.System("moving")


@legalising(
    unless=lambda context: rules_of(context.source).advance.runs_ahead_of != "fly_by",
    sees=("StopMotion", "system moving"),
)
def at_rest(program: ir.Program, context: Context) -> ir.Program:
    """Only for sources whose moves without a corner have ended before the next statement, and where interrupts and
    actions on the way do not move the robot; their routines stay as they are."""
    if program.tasks:
        return program
    nodes = list(
        walk_for({"DeclareInterrupt", "ConnectInterrupt", "Trigger", "DefineTrigger", "OnError"}, *program.modules)
    )
    worker = _AtRest(Facts(program))
    if not worker.beside([n for n in nodes if isinstance(n, _INTERRUPTS)]):
        return program
    resting = Rests(program)
    begun = {*started(program), *worker.facts.alone, *worker.facts.started}
    resting.solve(sorted(begun), sorted({*(name.lower() for name in reactions(program)), *worker.facts.several}))
    rests = resting.rests

    def change(statement: ir.Statement) -> ir.Body:
        resting = rests.get(id(statement), False)
        if resting and isinstance(statement, _STOPS):
            return (ir.Nothing(origin=statement.origin),) if statement.origin.comments else ()
        done = inside(statement, lambda body: map_body(body, change))
        if resting and not isinstance(statement, _INTERRUPTS):  # those look later
            done = rewrite_parts(done, lambda expression: rewrite(expression, _answer))
        if isinstance(done, ir.While) and done.condition == ir.BoolLiteral(False):
            return (ir.Nothing(origin=done.origin),) if done.origin.comments else ()
        return (done,)

    def work(module: ir.Module, routine: ir.Routine) -> ir.Routine:
        return edit_bodies(routine, lambda body: map_body(body, change)) if worker.knows(routine) else routine

    return edit_each(program, work)


class _AtRest:
    def __init__(self, facts: Facts) -> None:
        self.facts = facts
        self.moves = {name: any(isinstance(n, _MOTION) for n in walk(one)) for name, one in facts.routines.items()}
        self.interrupting: set[str] = set()  # routines that run while others move the robot

    def beside(self, interrupts: Sequence[object]) -> bool:
        """Do interrupts and triggers leave the robot where it is?"""
        names = {n.name.lower() for one in interrupts for n in walk(one) if isinstance(n, ir.CallRoutine | ir.Call)}
        for one in interrupts:
            if isinstance(one, ir.OnError):
                return False
            if isinstance(one, ir.ConnectInterrupt):
                names.add(one.routine.lower())
        self.interrupting = self.facts.closure(names & set(self.moves)) | names
        moving = any(isinstance(n, _MOTION) for one in interrupts for n in walk(one))
        return not moving and not any(self.moves.get(name) for name in self.interrupting)

    def knows(self, routine: ir.Routine) -> bool:
        """Does it run in one task only, and no other one moves the robot?"""
        name = routine.name.lower()
        homes = [task for task, names in self.facts.tasks.items() if name in names]
        if len(homes) != 1 or name in self.interrupting:
            return False
        others = set[str]().union(*(names for task, names in self.facts.tasks.items() if task != homes[0]))
        return not any(self.moves[one] for one in others)


def _answer(node: object) -> object:
    if node == _MOVING:
        return ir.BoolLiteral(False)
    match node:
        case ir.Unary(op="not", operand=ir.BoolLiteral(value=value)):
            return ir.BoolLiteral(not value)
    return node


__all__ = ["at_rest"]

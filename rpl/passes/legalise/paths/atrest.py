"""Questions about the motion, and stops of it, where the robot rests anyway: behind a move without a corner, in a
program whose moves hold the task until they have ended, where no other task moves the robot; a routine begins as its
calls find it.

Whether the robot moves is then known (it does not), and to stop it and forget what was to come says nothing.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from rpl import ir
from rpl.ir.walk import rewrite, walk
from rpl.passes.legalise.context import Context, rules_of
from rpl.passes.legalise.facts.effects import blocks
from rpl.passes.legalise.interrupts.tasks.criticals import Facts
from rpl.passes.legalise.rewriting.editing import edit_bodies
from rpl.passes.legalise.rewriting.jumps import inside
from rpl.passes.legalise.stages import legalising
from rpl.passes.rewrite import changed, rewrite_parts

_MOTION = (ir.Move, ir.MoveExternal, ir.Spline)
_INTERRUPTS = (ir.DeclareInterrupt, ir.ConnectInterrupt, ir.Trigger, ir.DefineTrigger, ir.OnError)
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
    nodes = list(walk(*program.modules))
    worker = _AtRest(Facts(program))
    if not worker.beside([n for n in nodes if isinstance(n, _INTERRUPTS)]):
        return program
    worker.find_moving(program)
    modules = tuple(
        changed(module, routines=tuple(worker.routine(one) for one in module.routines)) for module in program.modules
    )
    return replace(program, modules=modules)


class _AtRest:
    def __init__(self, facts: Facts) -> None:
        self.facts = facts
        self.moves = {name: [n for n in walk(one) if isinstance(n, _MOTION)] for name, one in facts.routines.items()}
        self.rests = False
        self.seen = False  # whether the routine just worked on was followed
        self.interrupting: set[str] = set()  # routines that run while others move the robot
        self.called_moving: set[str] = set()  # routines that may be called while it moves

    def find_moving(self, program: ir.Program) -> None:
        """Which routines may be called while the robot moves: those that one call finds so, as long as that makes
        others."""
        known = -1
        while known != len(self.called_moving):
            known = len(self.called_moving)
            for module in program.modules:
                for routine in module.routines:
                    self.routine(routine)
                    if not self.seen:
                        self.called_moving |= self.facts.called(routine.name.lower())

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

    def routine(self, routine: ir.Routine) -> ir.Routine:
        """The routine, where it runs in one task only and no other one moves the robot."""
        self.seen = False
        name = routine.name.lower()
        homes = [task for task, names in self.facts.tasks.items() if name in names]
        if len(homes) != 1 or name in self.interrupting:
            return routine
        others = set[str]().union(*(names for task, names in self.facts.tasks.items() if task != homes[0]))
        if any(self.moves[one] for one in others):
            return routine
        stops = all(_is_stop(one) for names in self.facts.tasks[homes[0]] for one in self.moves[names])
        caught = bool(routine.handlers) and name not in self.facts.alone
        labels = any(isinstance(n, ir.Label) for n in walk(routine))

        def body(statements: ir.Body) -> ir.Body:
            self.rests = stops or (name not in self.called_moving and not labels and not caught)
            return self.body(statements)

        self.seen = True
        return edit_bodies(routine, body)

    def body(self, body: ir.Body) -> ir.Body:
        done: list[ir.Statement] = []
        for statement in body:
            done.extend(self.statement(statement))
        same = len(done) == len(body) and all(new is old for new, old in zip(done, body, strict=True))
        return body if same else tuple(done)

    def statement(self, statement: ir.Statement) -> Sequence[ir.Statement]:
        match statement:
            case ir.Move() | ir.MoveExternal() | ir.Spline() | ir.WaitForMotion():
                done = self.answered(statement)
                self.rests = isinstance(statement, ir.WaitForMotion) or _is_stop(statement)
                return (done,)
            case ir.StopMotion() | ir.ClearMotion() | ir.StartMotion() if self.rests:
                return (ir.Nothing(origin=statement.origin),) if statement.origin.comments else ()
            case ir.If() | ir.Switch():
                return (self.branched(statement),)
        if blocks(statement):
            return self.repeated(statement)
        done = self.answered(statement)
        self.rests = self.rests and self.stay(statement)
        return (done,)

    def branched(self, statement: ir.Statement) -> ir.Statement:
        """Each branch begins as the statement does; behind it what holds in all."""
        begun, ends = self.rests, [True]

        def body(inner: ir.Body) -> ir.Body:
            self.rests = begun
            found = self.body(inner)
            ends.append(self.rests)
            return found

        done = inside(self.answered(statement), body)
        self.rests = all(ends) and begun if not _is_complete(statement) else all(ends)
        return done

    def repeated(self, statement: ir.Statement) -> Sequence[ir.Statement]:
        """A loop, or another statement with bodies: these may begin as they end."""
        moves = [n for n in walk(statement) if isinstance(n, _MOTION)]
        called = all(self.stay(n) for n in walk(statement) if isinstance(n, ir.CallRoutine | ir.Do | ir.Assign))
        begun = self.rests and called and all(_is_stop(one) for one in moves)
        self.rests = begun
        done = inside(self.answered(statement), self.body)
        self.rests = begun
        if isinstance(done, ir.While) and done.condition == ir.BoolLiteral(False):
            return (ir.Nothing(origin=done.origin),) if done.origin.comments else ()
        return (done,)

    def answered(self, statement: ir.Statement) -> ir.Statement:
        """The statement whose own expressions know that the robot does not move."""
        self.note_calls(statement)
        if not self.rests:
            return statement
        return rewrite_parts(statement, lambda expression: rewrite(expression, _answer))

    def note_calls(self, statement: ir.Statement) -> None:
        """Which routines the statement itself, not what is inside it, calls, and whether the robot rests then."""
        found: list[str] = []

        def look(expression: ir.Expression) -> ir.Expression:
            found.extend(n.name.lower() for n in walk(expression) if isinstance(n, ir.Call))
            return expression

        rewrite_parts(statement, look, lambda body: body)
        if isinstance(statement, ir.CallRoutine):
            found.append(statement.name.lower())
        moving = len(found) > 1 and not all(map(self.leaves_at_rest, found))
        if not self.rests or moving:
            self.called_moving.update(found)

    def leaves_at_rest(self, name: str) -> bool:
        return all(_is_stop(one) for reached in self.facts.closure({name}) for one in self.moves[reached])

    def stay(self, statement: object) -> bool:
        """Do the routines that the statement calls leave the robot at rest?"""
        names = {n.name.lower() for n in walk(statement) if isinstance(n, ir.CallRoutine | ir.Call)}
        reached = self.facts.closure(names)
        return all(_is_stop(one) for name in reached for one in self.moves[name])


def _answer(node: object) -> object:
    if node == _MOVING:
        return ir.BoolLiteral(False)
    match node:
        case ir.Unary(op="not", operand=ir.BoolLiteral(value=value)):
            return ir.BoolLiteral(not value)
    return node


def _is_stop(move: object) -> bool:
    return isinstance(move, ir.Move) and isinstance(move.blend, ir.BlendStop) and not move.concurrent


def _is_complete(statement: ir.Statement) -> bool:
    """Is one of the branches always taken?"""
    if isinstance(statement, ir.If):
        return bool(statement.otherwise)
    return isinstance(statement, ir.Switch) and statement.default is not None


__all__ = ["at_rest"]

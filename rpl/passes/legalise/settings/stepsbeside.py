"""Moves whose program goes on at once, for targets whose tasks cannot move the robot and whose programs wait for moves.

What the program does while the move is driven becomes a task of its own, begun just before the move; behind the move
the program waits for the end of that task. Such steps end before what drives the robot, waits for it, or leaves the
block.
"""

from __future__ import annotations

from dataclasses import replace

from rpl import ir
from rpl.diagnostics import Severity, code
from rpl.ir.walk import rewrite, walk
from rpl.passes.legalise.facts.effects import root
from rpl.passes.legalise.rewriting.beside import Beside, moves_or_waits, tidy
from rpl.passes.legalise.rewriting.editing import Editor, expansion
from rpl.passes.legalise.rewriting.jumps import inside
from rpl.source import Origin

LEFT = code(
    "concurrent-move-left",
    Severity.WARNING,
    "the program waits here for the end of the move in line {line}, because it jumps, or leaves this block or routine",
)
EARLY = code(
    "concurrent-move-early",
    Severity.WARNING,
    "the steps beside this move begin before the corner that leads into it",
)
_LEAVING = (ir.Return, ir.Goto, ir.Label, ir.ExitLoop, ir.NextPass, ir.Halt, ir.Raise, ir.Retry, ir.TryNext)


class StepsBeside:
    """Rewrites the moves of one routine."""

    def __init__(self, editor: Editor, routine: ir.Routine, beside: Beside) -> None:
        self.editor, self.routine, self.beside = editor, routine, beside
        self.flag: ir.Name | None = None
        self.depth = 0

    def body(self, body: ir.Body) -> ir.Body:
        self.depth += 1
        done: list[ir.Statement] = []
        rest = list(body)
        before: ir.Move | None = None
        while rest:
            statement = rest.pop(0)
            if isinstance(statement, ir.Move) and statement.concurrent:
                steps = self.taken(statement, rest)
                done.extend(self.together(statement, steps, before))
            else:
                done.append(inside(statement, self.body))
            before = statement if isinstance(statement, ir.Move) else None
        self.depth -= 1
        same = len(done) == len(body) and all(new is old for new, old in zip(done, body, strict=True))
        return body if same else tuple(done)

    def taken(self, move: ir.Move, rest: list[ir.Statement]) -> list[ir.Statement]:
        """The steps that the program does while the move is driven, taken from the rest of the block."""
        steps: list[ir.Statement] = []
        while rest and not self.ends(rest[0]):
            steps.append(rest.pop(0))
        waited = rest and (moves_or_waits(rest[0], self.beside.routines) or isinstance(rest[0], ir.WaitForMotion))
        if not waited and (rest or self.depth > 1):
            at = rest[0] if rest else (steps[-1] if steps else move)
            self.beside.context.diagnostics.report(LEFT, at.origin, line=move.origin.line)
        return steps

    def ends(self, statement: ir.Statement) -> bool:
        """Does the statement wait for the robot, drive it, or leave the block?"""
        if moves_or_waits(statement, self.beside.routines):
            return True
        return any(isinstance(node, (ir.WaitForMotion, *_LEAVING)) for node in walk(statement))

    def together(self, move: ir.Move, steps: list[ir.Statement], last: ir.Move | None) -> ir.Body:
        """The move, with the steps in a task beside it."""
        plain = replace(move, concurrent=False)
        if all(isinstance(one, ir.Nothing) for one in steps):
            return (plain, *steps)
        if last is not None and last.blend not in (None, ir.BlendStop()):
            self.beside.context.diagnostics.report(EARLY, move.origin)
        if self.flag is None:
            self.flag = self.beside.kept(self.editor, self.routine, "rpl_beside", ir.BoolType())
        given: list[ir.Statement] = []
        looked = tuple(rewrite(one, lambda node: _in_force(node, move)) for one in steps)
        body = self.beside.own(self.editor, self.routine, looked, given, "rpl_shared")
        later = tidy(steps[0].origin)
        ended = ir.Assign(self.flag, ir.BoolLiteral(False), origin=later)
        task = self.beside.task(self.routine, "rpl_steps", (*body, ended), own=False)
        begun = (
            *given,
            ir.Assign(self.flag, ir.BoolLiteral(True)),
            ir.TaskControl("start", task),
        )
        behind = (ir.WaitUntil(ir.Unary("not", self.flag), origin=later), *self.brought_back(given, body, later))
        return (*expansion(move.origin, begun), replace(plain, origin=tidy(move.origin)), *behind)

    def brought_back(self, given: list[ir.Statement], body: ir.Body, origin: Origin) -> ir.Body:
        """The values that the steps have given to variables of the routine."""
        changed = {place.id for node in walk(*body) for place in _changed(node) if isinstance(place, ir.Name)}
        return tuple(
            ir.Assign(one.value, one.target, origin=origin)
            for one in given
            if isinstance(one, ir.Assign) and isinstance(one.target, ir.Name) and one.target.id in changed
        )


def _in_force(node: object, move: ir.Move) -> object:
    """A place seen with the tool and in the frame of the move is what the controller itself gives."""
    match node:
        case ir.Builtin(function="current_target" as function, arguments=(tool, *frame)):
            null = ir.System("null_frame")
            if tool == move.tool and (frame[0] if frame else null) == (move.frame or null):
                return ir.Builtin(function, (), origin=node.origin)
    return node


def _changed(node: object) -> list[ir.Expression]:
    """What a statement may change."""
    match node:
        case ir.Assign(target=target):
            return [root(target)]
        case ir.For(counter=counter):
            return [ir.Name(counter)]
        case ir.WaitUntil(timed_out=late) if late is not None:
            return [root(late)]
        case ir.Clock(clock=place) | ir.Dialog(answer=place):
            return [root(place)]
        case ir.CallRoutine(arguments=arguments) | ir.Call(arguments=arguments):
            return [root(one.value) for one in arguments if one.value is not None]
    return []


__all__ = ["StepsBeside"]

"""Loops that are left in their middle, and passes that end early: VAL3 has no word for either.

Help pages of two programming systems (Visual Components 4.9, Staubli add-on; DELMIA, Staubli translators) say that VAL3
has no Break and no Continue, and no public application uses one in a loop; `break` ends a case of a switch. So a
truth value says that the loop is over, and what stands behind is done only where it is not.
"""

from __future__ import annotations

from dataclasses import replace

from rpl import ir
from rpl.passes.conditions import negation
from rpl.passes.fold import constant_number
from rpl.passes.legalise.context import Context
from rpl.passes.legalise.rewriting.editing import (
    Editor,
    edit_bodies,
    edit_routines,
    exits,
    expansion,
    map_body,
    passes_on,
)
from rpl.passes.legalise.stages import legalising
from rpl.passes.rewrite import rewrite_bodies

_TRUE, _FALSE = ir.BoolLiteral(True), ir.BoolLiteral(False)


@legalising(sees=("ExitLoop", "NextPass"))
def loops_left_by_flags(program: ir.Program, context: Context) -> ir.Program:
    """Loops that end at their conditions alone; VAL3 has no word that leaves one."""
    return edit_routines(program, context, lambda editor, routine: edit_bodies(routine, _Loops(editor).body))


class _Loops:
    """The loops of one routine, the inner ones first."""

    def __init__(self, editor: Editor) -> None:
        self.editor = editor

    def body(self, body: ir.Body) -> ir.Body:
        return map_body(body, self.statement)

    def statement(self, statement: ir.Statement) -> ir.Body:
        done = rewrite_bodies(statement, self.body)
        match done:
            case ir.While() | ir.Repeat() | ir.Loop() | ir.For() if passes_on(done.body) or exits(done.body):
                return expansion(done.origin, self.ended(done))
        return (done,)

    def ended(self, loop: ir.While | ir.Repeat | ir.Loop | ir.For) -> ir.Body:
        """The loop without jumps of its own."""
        before: tuple[ir.Statement, ...] = ()
        if passes_on(loop.body):
            skipped = self.editor.temporary("bSkip", ir.BoolType())
            begun = ir.Assign(skipped, _FALSE)
            loop = replace(loop, body=(begun, *_guarded(loop.body, ir.NextPass, skipped)))
        if not exits(loop.body):
            return (loop,)
        if isinstance(loop, ir.For):
            before, loop = self.spelled_out(loop)
        match loop:
            case ir.Loop(body=(ir.If(((condition, (ir.ExitLoop(),)),), ()), *rest)) if not exits(tuple(rest)):
                return (*before, ir.While(negation(condition), tuple(rest), origin=loop.origin))
            case ir.Loop(body=(*first, ir.If(((condition, (ir.ExitLoop(),)),), ()))) if not exits(tuple(first)):
                return (*before, ir.Repeat(condition, tuple(first), origin=loop.origin))
        left = self.editor.temporary("bLeave", ir.BoolType())
        body = _guarded(loop.body, ir.ExitLoop, left)
        before = (*before, ir.Assign(left, _FALSE))
        goes_on = ir.Unary("not", left)
        match loop:
            case ir.Loop():
                return (*before, ir.Repeat(left, body, origin=loop.origin))
            case ir.Repeat(until=until):
                return (*before, ir.Repeat(ir.Binary("cor", left, until), body, origin=loop.origin))
        assert isinstance(loop, ir.While)  # the For has become one
        condition = goes_on if loop.condition == _TRUE else ir.Binary("cand", goes_on, loop.condition)
        return (*before, ir.While(condition, body, origin=loop.origin))

    def spelled_out(self, loop: ir.For) -> tuple[ir.Body, ir.While]:
        """A counting loop as a While: the bounds are looked at once, in front of it."""
        counter = ir.Name(loop.counter)
        before: list[ir.Statement] = []
        step = loop.step or ir.IntLiteral(1)
        size = constant_number(step, self.editor.scope)
        last = self.kept(loop.stop, "nLast", before)
        if size is None:
            step = self.kept(step, "nStep", before)
        before.append(ir.Assign(counter, loop.start))
        upward, downward = ir.Binary("<=", counter, last), ir.Binary(">=", counter, last)
        if size is not None:
            condition: ir.Expression = upward if size >= 0 else downward
        else:
            zero = ir.IntLiteral(0)
            rising = ir.Binary("cand", ir.Binary(">=", step, zero), upward)
            condition = ir.Binary("cor", rising, ir.Binary("cand", ir.Binary("<", step, zero), downward))
        ahead = ir.Assign(counter, ir.Binary("+", counter, step))
        return tuple(before), ir.While(condition, (*loop.body, ahead), origin=loop.origin)

    def kept(self, value: ir.Expression, stem: str, before: list[ir.Statement]) -> ir.Expression:
        if constant_number(value, self.editor.scope) is not None:
            return value
        name = self.editor.temporary(stem, ir.RealType())
        before.append(ir.Assign(name, value))
        return name


def _guarded(body: ir.Body, kind: type[ir.ExitLoop] | type[ir.NextPass], flag: ir.Name) -> ir.Body:
    """The body with a jump of its loop as the flag, and what stands behind a jump that may come under it."""
    for at, statement in enumerate(body):
        if isinstance(statement, kind):
            return (*body[:at], ir.Assign(flag, _TRUE, origin=statement.origin))
        if not _jumps(statement, kind):
            continue
        rest = _guarded(body[at + 1 :], kind, flag)
        match statement:
            case ir.If(branches=((condition, (*first, one)),), otherwise=()) if (
                isinstance(one, kind) and rest and not any(_jumps(each, kind) for each in first)
            ):
                branch = (*first, ir.Assign(flag, _TRUE, origin=one.origin))
                return (*body[:at], replace(statement, branches=((condition, branch),), otherwise=rest))
        done = rewrite_bodies(statement, lambda inner: _guarded(inner, kind, flag))
        guarded = (ir.If(((ir.Unary("not", flag), rest),)),) if rest else ()
        return (*body[:at], done, *guarded)
    return body


def _jumps(statement: ir.Statement, kind: type[ir.ExitLoop] | type[ir.NextPass]) -> bool:
    """May the statement end the pass of the loop around it so?"""
    return exits((statement,)) if kind is ir.ExitLoop else passes_on((statement,))

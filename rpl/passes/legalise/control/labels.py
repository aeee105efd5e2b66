"""Structure as labels and jumps, for targets that lack a block statement; also for blocks that a jump goes into.

`If` with one Goto as its only branch is what every target with labels can say. Runs behind everything that makes
blocks. Conditions are turned round so that they read well; afterwards no jump is dead and every label is used.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

from rpl import ir
from rpl.passes.conditions import opposite
from rpl.passes.legalise.context import Context
from rpl.passes.legalise.control.tidyjumps import tidied
from rpl.passes.legalise.facts.effects import blocks
from rpl.passes.legalise.rewriting.editing import Editor, edit_bodies, edit_routines, expansion
from rpl.passes.legalise.rewriting.jumps import LabelNames, entered, goes_on, inside
from rpl.passes.legalise.stages import legalising
from rpl.source import Origin


@legalising(unless=lambda context: not {"Goto", "Label"} <= context.capabilities.statements)
def structure_to_labels(program: ir.Program, context: Context) -> ir.Program:
    """The program with only the block statements that the target has."""

    def work(editor: Editor, routine: ir.Routine) -> ir.Routine:
        names = LabelNames(context, routine)

        def on_body(body: ir.Body) -> ir.Body:
            done = _Lowering(editor, names, entered(body)).body(body, _OUTSIDE)
            return done if done is body else tidied(done, editor.effects)

        return edit_bodies(routine, on_body)

    return edit_routines(program, context, work)


@dataclass(frozen=True, slots=True)
class _Around:
    """Labels behind and at the next pass of the loop around; empty where that is a loop the target has."""

    leave: str = ""
    again: str = ""


_OUTSIDE = _Around()


def is_conditional_jump(statement: ir.Statement) -> bool:
    """`If` with one Goto as its only branch."""
    match statement:
        case ir.If(branches=((_, (ir.Goto(),)),), otherwise=()):
            return True
    return False


class _Lowering:
    """Lowers the bodies of one routine."""

    def __init__(self, editor: Editor, names: LabelNames, entered: set[int]) -> None:
        self.has = editor.capabilities.statements
        self.names = names
        self.entered = entered

    def body(self, body: ir.Body, around: _Around) -> ir.Body:
        done: list[ir.Statement] = []
        same = True
        for statement in body:
            new = self.statement(statement, around)
            same = same and len(new) == 1 and new[0] is statement
            done.extend(new)
        return body if same else tuple(done)

    def statement(self, statement: ir.Statement, around: _Around) -> ir.Body:
        match statement:
            case ir.ExitLoop() if around.leave:
                return (ir.Goto(around.leave, origin=statement.origin),)
            case ir.NextPass() if around.again:
                return (ir.Goto(around.again, origin=statement.origin),)
        if not blocks(statement) or is_conditional_jump(statement):
            return (statement,)
        if self.keeps(statement):
            here = around if isinstance(statement, ir.If | ir.Switch) else _OUTSIDE
            return (inside(statement, lambda inner: self.body(inner, here)),)
        return expansion(statement.origin, self.lowered(statement, around))

    def keeps(self, statement: ir.Statement) -> bool:
        return statement.__class__.__name__ in self.has and id(statement) not in self.entered

    def lowered(self, statement: ir.Statement, around: _Around) -> ir.Body:
        match statement:
            case ir.If():
                return self.choice(statement, around)
            case ir.Switch():
                return self.switch(statement, around)
            case ir.While():
                return self.while_loop(statement)
            case ir.Repeat(until=until, body=body):
                return self.repeated(statement.origin, body, until)
            case ir.Loop(body=body):
                return self.repeated(statement.origin, body, None)
        return (inside(statement, lambda inner: self.body(inner, _OUTSIDE)),)

    # ---- branches

    def choice(self, statement: ir.If, around: _Around) -> ir.Body:
        end = self.names.fresh("if_end")
        done: list[ir.Statement] = []
        last = len(statement.branches) - 1
        for at, (condition, old) in enumerate(statement.branches):
            body = self.body(old, around)
            more = at < last or bool(statement.otherwise)
            match body:
                case (ir.Goto(),):
                    done.append(ir.If(((condition, body),), origin=statement.origin))
                    continue
            behind = self.names.fresh("else") if more else end
            done.append(_unless(condition, behind))
            done.extend(body)
            if more:
                if goes_on(body):
                    done.append(ir.Goto(end))
                done.append(ir.Label(behind))
        return (*done, *self.body(statement.otherwise, around), ir.Label(end))

    def switch(self, statement: ir.Switch, around: _Around) -> ir.Body:
        """First which case it is, then the cases one behind the other."""
        end = self.names.fresh("case_end")
        cases: list[ir.Case] = []
        parts: list[ir.Statement] = []
        for case in statement.cases:
            body = self.body(case.body, around)
            if _one_jump(body):
                cases.append(replace(case, body=body))
                continue
            label = self.names.fresh("case")
            cases.append(replace(case, body=(ir.Goto(label),)))
            parts += [ir.Label(label), *body, *((ir.Goto(end),) if goes_on(body) else ())]
        default = self.body(statement.default or (), around)
        if _one_jump(default):
            other: ir.Body = default
        elif default:
            label = self.names.fresh("case_else")
            other = (ir.Goto(label),)
            parts += [ir.Label(label), *default]
        else:
            other = (ir.Goto(end),)
        return (replace(statement, cases=tuple(cases), default=other), ir.Goto(end), *parts, ir.Label(end))

    # ---- loops

    def while_loop(self, statement: ir.While) -> ir.Body:
        again, leave = self.names.fresh("loop"), self.names.fresh("loop_end")
        body = self.body(statement.body, _Around(leave, again))
        check: ir.Body = ()
        if statement.condition != ir.BoolLiteral(True):
            check = (_unless(statement.condition, leave),)
        return (ir.Label(again), *check, *body, ir.Goto(again), ir.Label(leave))

    def repeated(self, origin: Origin, body: ir.Body, until: ir.Expression | None) -> ir.Body:
        begin, leave = self.names.fresh("loop"), self.names.fresh("loop_end")
        again = begin if until is None else self.names.fresh("loop_check")
        inner = self.body(body, _Around(leave, again))
        back: ir.Statement = ir.Goto(begin) if until is None else _unless(until, begin)
        check = () if until is None else (ir.Label(again),)
        return (ir.Label(begin, origin=origin), *inner, *check, back, ir.Label(leave))


def _unless(condition: ir.Expression, label: str) -> ir.If:
    return ir.If(((opposite(condition), (ir.Goto(label),)),))


def _one_jump(body: ir.Body) -> bool:
    """What a case of jumps can hold: one Goto or one call without a result."""
    match body:
        case (ir.Goto() | ir.CallRoutine(dynamic=None),):
            return True
    return False

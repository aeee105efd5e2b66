"""Error handlers for targets that have none: a flag that is looked at behind every statement that may raise.

A routine without handler returns at once while an error is on its way. A routine with one runs the handler's body
behind the failed statement: RETRY repeats the statement, TRYNEXT goes on, RETURN and RAISE leave. What the target's
controller itself stops at cannot be caught this way; handlers that may be for such errors are named.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, replace

from rpl import ir
from rpl.diagnostics import Severity, code
from rpl.ir.errornames import unhandled_text
from rpl.ir.walk import walk
from rpl.passes.conditions import negation
from rpl.passes.legalise.context import Context
from rpl.passes.legalise.facts.effects import Effects, blocks, is_constant, may_be_zero, statements_in
from rpl.passes.legalise.facts.raising import Raising, raising_of
from rpl.passes.legalise.kinds import walk_for
from rpl.passes.legalise.rewriting.bodies import Hoister, Lowered
from rpl.passes.legalise.rewriting.editing import Editor, expansion, map_body
from rpl.passes.legalise.rewriting.support import default_value, with_support
from rpl.passes.legalise.stages import legalising
from rpl.passes.legalise.statements.knownerrors import settled
from rpl.passes.rewrite import rewrite_bodies, rewrite_parts
from rpl.passes.scope import ProgramScope

CAUGHT_PARTLY = code(
    "handler-caught-partly",
    Severity.WARNING,
    "{routine}: errors that the controller itself raises stop the program instead of coming to this handler",
)
NOT_CAUGHT = code(
    "fault-not-caught",
    Severity.LOSS,
    "{routine}: what a function is not defined for comes to this handler in the source, here it stops the robot",
    "look at the value in front of the function",
)
# Functions that are not defined for every number.
_PARTIAL = frozenset(("sqrt", "log", "asin", "acos"))
_JUMPS = frozenset(("Goto", "Label"))
_DIVISION, _BOUND, _ARGUMENT = "division_by_zero", "out_of_range", "negative_argument"


@dataclass(frozen=True, slots=True)
class _Names:
    """The two variables every routine shares: is an error on its way, and the number of the latest."""

    raised: ir.Name
    number: ir.Name


@legalising(unless=lambda context: context.capabilities.errors.handlers)
def check_errors(program: ir.Program, context: Context) -> ir.Program:
    """The program with errors as values that are passed on and looked at."""
    facts = raising_of(program)
    if _ARGUMENT not in facts.caught:
        _report_not_caught(program, context)
    if not facts.used:
        return program
    scopes, effects = ProgramScope(program), Effects(program)
    tasks = sorted({module.task for module in program.modules})
    names = {
        task: _Names(ir.Name(context.fresh("error_raised")), ir.Name(context.fresh("error_number"))) for task in tasks
    }
    modules = []
    for module in program.modules:
        routines = []
        for routine in module.routines:
            editor = Editor(context, effects, scopes.routine(module, routine))
            routines.append(editor.closed(_rewritten(editor, routine, facts, names[module.task])))
        modules.append(replace(module, routines=tuple(routines)))
    program = replace(program, modules=tuple(modules))
    number: ir.Type = ir.IntType() if facts.whole_codes else ir.RealType()
    scope = "global" if len(tasks) == 1 else "task"
    for task in tasks:
        declared = (
            ir.Variable(names[task].raised.id, ir.BoolType(), ir.BoolLiteral(False), scope=scope),
            ir.Variable(names[task].number.id, number, default_value(number), scope=scope),
        )
        program = with_support(program, context, declared, task="" if len(tasks) == 1 else task)
    return program


def _report_not_caught(program: ir.Program, context: Context) -> None:
    """Handlers that may take the fault of a function whose argument is not constant or surely wrong."""
    if not any(isinstance(node, ir.Builtin) and _may_fail(node) for node in walk_for({"Builtin"}, *program.modules)):
        return
    for module in program.modules:
        for routine in module.routines:
            if routine.handlers and not routine.handlers[0].codes:
                context.diagnostics.report(NOT_CAUGHT, routine.handlers[0].origin, routine=routine.name)


def _may_fail(call: ir.Builtin) -> bool:
    """Is it one of the functions, of a number that is written with a minus?"""
    return call.function in _PARTIAL and any(isinstance(one, ir.Unary) for one in call.arguments)


def _rewritten(editor: Editor, routine: ir.Routine, facts: Raising, names: _Names) -> ir.Routine:
    work = _Passing(editor, routine, facts, names)
    if routine.handlers and facts.needs_handler(routine):
        handled = _Handling(editor, routine, facts, names, work)
        body = handled.body(routine.body)
    else:
        body = work.body(routine.body)
    if routine.handlers and facts.partly(routine):
        where = routine.handlers[0].origin
        editor.context.diagnostics.report(CAUGHT_PARTLY, where, routine=routine.name)
    done = replace(routine, body=body, handlers=(), undo=())
    if facts.interrupts(routine) and facts.body_raises(routine):
        done = _restoring(editor, done, names)
    return _numbered(done, names)


def _restoring(editor: Editor, trap: ir.Routine, names: _Names) -> ir.Routine:
    """A trap may come between a statement and its check: it keeps what it finds."""
    kept = editor.temporary("kept_error", ir.BoolType())
    back = ir.Assign(names.raised, kept)

    def change(statement: ir.Statement) -> ir.Body:
        if isinstance(statement, ir.Return):
            return expansion(statement.origin, (back, statement))
        if blocks(statement):
            return (rewrite_bodies(statement, lambda body: map_body(body, change)),)
        return (statement,)

    start = (ir.Assign(kept, names.raised), ir.Assign(names.raised, ir.BoolLiteral(False)))
    return replace(trap, body=(*start, *map_body(trap.body, change), back))


def _numbered(routine: ir.Routine, names: _Names) -> ir.Routine:
    """ERRNO is the variable now."""

    def expression(node: ir.Expression) -> ir.Expression:
        if isinstance(node, ir.System) and node.name == "error_number":
            return replace(names.number, origin=node.origin)
        return rewrite_parts(node, expression)

    def body(statements: ir.Body) -> ir.Body:
        return tuple(rewrite_parts(statement, expression, body) for statement in statements)

    return replace(routine, body=body(routine.body))


class _Passing(Hoister):
    """A routine (or a handler's body) in which an error leaves the routine."""

    def __init__(self, editor: Editor, routine: ir.Routine, facts: Raising, names: _Names) -> None:
        super().__init__(editor, self.hoisted)
        self.routine = routine
        self.facts = facts
        self.names = names
        self._nothing: ir.Name | None = None

    # ---- what raises

    def raises(self, statement: ir.Statement) -> bool:
        return self.facts.statement(statement, hoisted=True)

    def hoisted(self, expression: ir.Expression) -> Lowered | None:
        """Calls that may raise stand alone, so that what follows them can be left out."""
        match expression:
            case ir.Call(name=name) if self.facts.raises(name):
                type = self.editor.type_of(expression)
                if type is None:
                    return None
                result = self.editor.temporary("result", type)
                return (ir.Assign(result, expression),), result
            case ir.Binary(op="/" | "div" | "mod", right=right) if may_be_zero(right):
                number = self.facts.caught.get(_DIVISION)
                if number is None:
                    return None
                divisor = right
                before: list[ir.Statement] = []
                if not isinstance(right, ir.Name):
                    type = self.editor.type_of(right) or ir.RealType()
                    divisor = self.editor.temporary("divisor", type)
                    before.append(ir.Assign(divisor, right))
                before.append(ir.If(((ir.Binary("=", divisor, ir.IntLiteral(0)), (ir.Raise(number),)),)))
                return tuple(before), replace(expression, right=divisor)
            case ir.Builtin(function="sqrt", arguments=(value,)) if _ARGUMENT in self.facts.caught:
                root = self.editor.temporary("radicand", ir.RealType())
                negative = ir.Binary("<", root, ir.IntLiteral(0))
                check = ir.If(((negative, (ir.Raise(self.facts.caught[_ARGUMENT]),)),))
                return (ir.Assign(root, value), check), replace(expression, arguments=(root,))
            case ir.Index():
                return self.bounded(expression)
        return None

    def lower(self, expression: ir.Expression, lvalue: bool = False) -> Lowered:
        before, done = super().lower(expression, lvalue)
        if lvalue and isinstance(done, ir.Index):
            checked = self.bounded(done)
            if checked is not None:
                return (*before, *checked[0]), checked[1]
        return before, done

    def bounded(self, index: ir.Index) -> Lowered | None:
        """An element behind a check of its subscripts, where the program looks for that error."""
        number = self.facts.caught.get(_BOUND)
        type = self.editor.type_of(index.base)
        if number is None or not isinstance(type, ir.ArrayType) or all(map(is_constant, index.indices)):
            return None
        before: list[ir.Statement] = []
        subscripts = []
        for at, size in zip(index.indices, type.dimensions, strict=False):
            if size is not None and not is_constant(at):
                if not isinstance(at, ir.Name):
                    kept = self.editor.temporary("subscript", self.editor.type_of(at) or ir.IntType())
                    before.append(ir.Assign(kept, at))
                    at = kept
                low, high = ir.Binary("<", at, ir.IntLiteral(type.base)), ir.Binary(">", at, size)
                before.append(ir.If(((ir.Binary("or", low, high), (ir.Raise(number),)),)))
            subscripts.append(at)
        subscripts.extend(index.indices[len(subscripts) :])
        return (tuple(before), replace(index, indices=tuple(subscripts))) if before else None

    def explicit(self, statement: ir.Statement) -> ir.Body:
        """A timeout that raises, as a flag and a Raise."""
        if not isinstance(statement, ir.WaitUntil | ir.Dialog) or statement.timeout is None:
            return (statement,)
        if statement.timed_out is not None:
            return (statement,)
        flag = self.editor.temporary("timed_out", ir.BoolType())
        late = ir.If(((flag, (ir.Raise(self.facts.timeout_code(statement)),)),))
        waits = replace(statement, timed_out=flag)
        if isinstance(waits, ir.WaitUntil):
            waits = replace(waits, error=None)  # what it raises is raised behind it
        return expansion(statement.origin, (waits, late))

    # ---- statements

    def placed(self, statement: ir.Statement) -> ir.Body:
        if blocks(statement):
            return super().placed(statement)
        steps: list[ir.Statement] = []
        for one in self.explicit(statement):
            steps.extend(super().placed(one) if not blocks(one) else (one,))
        if not any(map(self.raises, steps)):
            return tuple(steps)
        return expansion(statement.origin, self.finished(tuple(steps)))

    def finished(self, steps: ir.Body) -> ir.Body:
        return self.checked(steps)

    def ready(self, before: ir.Body) -> ir.Body:
        return self.checked(before) if any(map(self.raises, before)) else before

    def expanded(self, old: ir.Statement, before: ir.Body, new: ir.Statement) -> ir.Body:
        if blocks(new):
            return super().expanded(old, before, new)
        # `statement` puts the checks behind the steps of a plain statement
        return expansion(old.origin, (*before, new)) if before else (new,)

    def checked(self, steps: ir.Body) -> ir.Body:
        """The steps, each that may raise with a check that leaves the routine behind it."""
        done: list[ir.Statement] = []
        for step in steps:
            match step:
                case ir.Raise(code=number):
                    done.extend((*self.signal(number), *self.leave()))
                case ir.If(branches=branches, otherwise=otherwise):
                    inner = tuple((condition, self.checked(body)) for condition, body in branches)
                    done.append(replace(step, branches=inner, otherwise=self.checked(otherwise)))
                case _:
                    done.append(step)
                    if self.raises(step):
                        done.append(ir.If(((self.names.raised, self.leave()),)))
        return tuple(done)

    def signal(self, number: ir.Expression | None) -> ir.Body:
        flag = ir.Assign(self.names.raised, ir.BoolLiteral(True))
        return (flag,) if number is None else (ir.Assign(self.names.number, number), flag)

    def leave(self) -> ir.Body:
        """How an error gets out of this routine."""
        undo = self.routine.undo
        if self.facts.is_top(self.routine):
            text = ir.TextLiteral(unhandled_text(self.routine.name))
            return (*undo, ir.Message("error", text), ir.Halt("exit"))
        if self.routine.returns is None:
            return (*undo, ir.Return())
        return (*undo, ir.Return(self.nothing()))

    def nothing(self) -> ir.Expression:
        """What a function gives while an error is on its way; nobody looks at it."""
        type = self.editor.scope.resolve(self.routine.returns or ir.RealType())
        value = default_value(type)
        if value is not None:
            return value
        if self._nothing is None:
            self._nothing = self.editor.temporary("no_result", type)
        return self._nothing


class _Handling(_Passing):
    """A routine whose errors come to its own handlers."""

    def __init__(self, editor: Editor, routine: ir.Routine, facts: Raising, names: _Names, passing: _Passing) -> None:
        super().__init__(editor, routine, facts, names)
        self.bodies = [(handler.codes, passing.body(handler.body)) for handler in routine.handlers]
        everything_handled = [one for _, body in self.bodies for one in statements_in(body)]
        self.retries = any(isinstance(one, ir.Retry) for one in everything_handled)
        self.goes_on = any(isinstance(one, ir.TryNext) for one in everything_handled)
        self._variables: dict[str, ir.Name] = {}
        self.made = False
        self.again = ""  # label of the statement that RETRY goes back to, where the target's people jump

    def variable(self, stem: str) -> ir.Name:
        if stem not in self._variables:
            self._variables[stem] = self.editor.temporary(stem, ir.BoolType())
        return self._variables[stem]

    def until(self, core: ir.Body, again: ir.Name) -> ir.Repeat | None:
        """The statement and its handler until the handler does not run: where nothing but the handler's end says that
        it is tried again, and its condition is a variable of the routine that the handler does not name."""
        match core:
            case (
                *head,
                ir.If(branches=((ir.Name() as failed, (*inner, ir.Assign(target=told))),), otherwise=()) as last,
            ):
                if told != again or again in _targets((*head, *inner)) or not self.is_own(failed):
                    return None
                if any(isinstance(one, ir.Name) and one.id.lower() == failed.id.lower() for one in walk(tuple(inner))):
                    return None
                return ir.Repeat(ir.Unary("not", failed), (*head, replace(last, branches=((failed, tuple(inner)),))))
        return None

    def is_own(self, name: ir.Name) -> bool:
        """A variable that nothing outside of the routine can change."""
        symbol = self.editor.scope.value(name.id)
        declared = None if symbol is None else symbol.declaration
        return isinstance(declared, ir.Variable) and declared.scope == "routine" and declared.storage == "variable"

    def forget(self, stem: str) -> None:
        """Nothing uses that variable after all."""
        name = self._variables.pop(stem).id
        self.editor.added = [one for one in self.editor.added if one.name != name]

    def finished(self, steps: ir.Body) -> ir.Body:
        return self.unit(steps)

    def ready(self, before: ir.Body) -> ir.Body:
        if not any(map(self.raises, before)):
            return before
        if not self.goes_on:
            return self.unit(before)
        passed = self.variable("passed")
        steps = (*before, ir.Assign(passed, ir.BoolLiteral(True)))
        return (ir.Assign(passed, ir.BoolLiteral(False)), *self.unit(steps))

    def failed(self) -> ir.Body:
        if not self.goes_on or "passed" not in self._variables:
            return ()
        return (ir.If(((ir.Unary("not", self._variables["passed"]), (ir.ExitLoop(),)),)),)

    def expanded(self, old: ir.Statement, before: ir.Body, new: ir.Statement) -> ir.Body:
        if not before or not blocks(new) or not any(map(self.raises, before)):
            return (new,) if not before else expansion(old.origin, (*before, new))
        ready = self.ready(before)
        if self.goes_on:
            new = ir.If(((self.variable("passed"), (replace(new, origin=replace(old.origin, comments=())),)),))
        return expansion(old.origin, (*ready, new))

    def unit(self, steps: ir.Body) -> ir.Body:
        """One statement of the source: its steps, then the handler when one of them raised."""
        if not self.retries:
            return self.core(steps)
        if self.editor.capabilities.statements >= _JUMPS and "Repeat" not in self.editor.capabilities.statements:
            self.again = self.editor.context.fresh("retry")
            return (ir.Label(self.again), *self.core(steps))
        known = "retry" in self._variables
        again = self.variable("retry")
        core = self.core(steps)
        plain = self.until(core, again)
        if plain is not None:
            if not known:
                self.forget("retry")
            return (plain,)
        start = ir.Assign(again, ir.BoolLiteral(False))
        return (ir.Repeat(ir.Unary("not", again), (start, *core)),)

    def core(self, steps: ir.Body) -> ir.Body:
        raising = [at for at, step in enumerate(steps) if self.raises(step)]
        first = raising[0] if raising else 0
        head, step, rest = steps[:first], steps[first], steps[first + 1 :]
        match step:
            case ir.Raise():
                return (*head, *self.caught_here(step))
            case ir.If(branches=((condition, (ir.Raise() as raised,)),), otherwise=()) if len(raising) == 1:
                return (*head, ir.If(((condition, self.caught_here(raised)),), rest))
        quiet = ir.Assign(self.names.raised, ir.BoolLiteral(False))
        if len(raising) == 1 and not isinstance(step, ir.If):
            return (*head, step, ir.If(((self.names.raised, (quiet, *self.handler())),), rest))
        return (*self.guarded(steps), ir.If(((self.names.raised, (quiet, *self.handler())),)))

    def caught_here(self, raised: ir.Raise) -> ir.Body:
        """An error that is raised beside its handler needs no flag."""
        if raised.code is None:
            return self.handler()
        return (ir.Assign(self.names.number, raised.code), *settled(self.handler(), self.names.number, raised.code))

    def guarded(self, steps: ir.Body) -> ir.Body:
        """Steps behind one that raised are left out."""
        done: list[ir.Statement] = []
        for at, step in enumerate(steps):
            match step:
                case ir.Raise(code=number):
                    return (*done, *self.signal(number))
                case ir.If(branches=branches, otherwise=otherwise):
                    inner = tuple((condition, self.guarded(body)) for condition, body in branches)
                    done.append(replace(step, branches=inner, otherwise=self.guarded(otherwise)))
                case _:
                    done.append(step)
            if self.raises(step):
                rest = self.guarded(steps[at + 1 :])
                if rest:
                    done.append(ir.If(((ir.Unary("not", self.names.raised), rest),)))
                return tuple(done)
        return tuple(done)

    # ---- the handler's body behind one statement

    def handler(self) -> ir.Body:
        """A copy of the handlers' bodies, with the ways out of them as assignments and returns."""
        otherwise: ir.Body = self.tail((ir.Raise(),))
        branches = []
        for codes, body in self.bodies:
            done = self.tail(self.copied(body)) if self.made else self.tail(body)
            if not codes:
                otherwise = done
                break
            condition: ir.Expression | None = None
            for one in codes:
                equal = ir.Binary("=", self.names.number, one)
                condition = equal if condition is None else ir.Binary("or", condition, equal)
            if condition is not None:
                branches.append((condition, done))
        self.made = True
        if not branches:
            return otherwise
        return (ir.If(tuple(branches), otherwise),)

    def copied(self, body: ir.Body) -> ir.Body:
        """Labels of a copy have names of their own."""
        labels = {one.name.lower(): "" for one in statements_in(body) if isinstance(one, ir.Label)}
        if not labels:
            return body
        for name in labels:
            labels[name] = self.editor.context.fresh(name)

        def change(statement: ir.Statement) -> ir.Body:
            match statement:
                case ir.Label(name=name):
                    return (replace(statement, name=labels[name.lower()]),)
                case ir.Goto(label=name) if name.lower() in labels:
                    return (replace(statement, label=labels[name.lower()]),)
            if blocks(statement):
                return (rewrite_bodies(statement, lambda inner: map_body(inner, change)),)
            return (statement,)

        return map_body(body, change)

    def tail(self, body: ir.Body) -> ir.Body:
        """A body whose end is the end of the handler. Falling off the end returns from the routine."""
        for at, statement in enumerate(body):
            head, rest = body[:at], body[at + 1 :]
            match statement:
                case ir.Retry():
                    if self.again:
                        return (*head, *self.behind((ir.Goto(self.again, origin=statement.origin),), rest, falls=False))
                    again = ir.Assign(self.variable("retry"), ir.BoolLiteral(True), origin=statement.origin)
                    return (*head, *self.behind((again,), rest, falls=True))
                case ir.TryNext():
                    done = self.behind((ir.Nothing(origin=statement.origin),), rest, falls=True)
                    return (*head, *done) if len(done) > 1 or not head else head
                case ir.Raise(code=number):
                    left = expansion(statement.origin, (*self.signal(number), *self.leave()))
                    return (*head, *self.behind(left, rest, falls=False))
                case ir.Return() | ir.Halt(kind="exit"):
                    return (*head, *self.behind((statement,), rest, falls=False))
                case ir.If() if _ways_out(statement):
                    return (*head, *self.forked(statement, rest))
                case ir.Switch() if _ways_out(statement):
                    return (*head, *self.forked_switch(statement, rest))
        if self.routine.returns is None:
            return (*body, ir.Return())
        return (*body, ir.Return(self.nothing()))

    def behind(self, way_out: ir.Body, rest: ir.Body, falls: bool) -> ir.Body:
        """A way out of the handler; what follows it can be reached by its labels only."""
        first = next((at for at, one in enumerate(rest) if isinstance(one, ir.Label)), None)
        if first is None:
            return way_out
        reached = self.tail(rest[first:])
        if not falls:
            return (*way_out, *reached)
        end = self.editor.context.fresh("handled")
        return (*way_out, ir.Goto(end), *reached, ir.Label(end))

    def forked(self, statement: ir.If, rest: ir.Body) -> ir.Body:
        """What follows the If belongs to the branches that reach it."""
        branches = tuple((condition, self.tail((*body, *rest))) for condition, body in statement.branches)
        otherwise = self.tail((*statement.otherwise, *rest))
        match branches:
            case ((condition, body),) if otherwise and all(
                one == ir.Nothing() and not one.origin.comments for one in body
            ):
                return (replace(statement, branches=((negation(condition), otherwise),), otherwise=()),)
        return (replace(statement, branches=branches, otherwise=otherwise),)

    def forked_switch(self, statement: ir.Switch, rest: ir.Body) -> ir.Body:
        cases = tuple(replace(case, body=self.tail((*case.body, *rest))) for case in statement.cases)
        return (replace(statement, cases=cases, default=self.tail((*(statement.default or ()), *rest))),)


def _ways_out(statement: ir.Statement) -> bool:
    return any(isinstance(one, ir.Retry | ir.TryNext | ir.Raise) for one in statements_in((statement,)))


def _targets(body: Iterable[ir.Statement]) -> list[ir.Expression]:
    return [one.target for one in statements_in(tuple(body)) if isinstance(one, ir.Assign)]

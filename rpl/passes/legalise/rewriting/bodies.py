"""Rewriting the bodies of a program: what a rewritten expression needs first stands where its value is wanted.

A pass says what becomes of an expression, either by a `Rule` on its rewritten operands (`Hoister`) or as a whole
(`walk.Rewriter`), and which statements must run before. They are placed here, for both, and nowhere else: in front of
the statement, inside the branch of a `cand` or `elseif` that needs them, and again in each pass of a loop. All is
rewritten in the order of the program.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable, Sequence, Set
from dataclasses import replace
from typing import TypeVar

from rpl import ir
from rpl.passes.conditions import negation
from rpl.passes.legalise.facts.effects import children, is_constant
from rpl.passes.legalise.rewriting.editing import Editor, expansion, map_body, passes_on
from rpl.passes.rewrite import changed, rewrite_parts, same
from rpl.passes.scope import Scope
from rpl.passes.typing import counter_type

Lowered = tuple[ir.Body, ir.Expression]
Rule = Callable[[ir.Expression], Lowered | None]
Node = TypeVar("Node")
_LVALUES = (ir.Name, ir.Index, ir.Field, ir.System, ir.Signal)


class Bodies(ABC):
    """`editor`: where the rewriting is just now. `acts_on`: the kinds of nodes (`kinds_of`) that the pass acts on; a
    statement that holds none of them is not entered. Empty: any."""

    editor: Editor
    acts_on: Set[str] = frozenset()

    # ---- what a pass says

    @abstractmethod
    def lower(self, expression: ir.Expression, lvalue: bool = False) -> Lowered:
        """What must run before, and the expression that then gives the value. Of an lvalue only subscripts change."""

    @abstractmethod
    def several(self, parts: Sequence[ir.Expression], in_place: Sequence[bool]) -> tuple[ir.Body, list[ir.Expression]]:
        """Operands in order of evaluation, and what must run before; `in_place`: which of them are lvalues."""

    @abstractmethod
    def single(self, statement: ir.Statement) -> ir.Body:
        """A statement without bodies that run in its place."""

    def case_value(self, value: ir.Expression) -> Lowered:
        """A value of a case."""
        return self.lower(value)

    def condition(self, expression: ir.Expression) -> Lowered:
        """A condition of a branch or a loop (a pass may know another form for it)."""
        return self.lower(expression)

    def opposite(self, condition: ir.Expression) -> ir.Expression:
        """The opposite of a condition in its last form."""
        return negation(condition)

    def ready(self, before: ir.Body) -> ir.Body:
        """The statements in front of a condition, as they are written there (a pass may add checks)."""
        return before

    def failed(self) -> ir.Body:
        """What leaves a loop whose condition could not be evaluated."""
        return ()

    # ---- statements

    def body(self, body: ir.Body) -> ir.Body:
        return map_body(body, self.placed, self.acts_on)

    def placed(self, statement: ir.Statement) -> ir.Body:
        """The statement with what had to be hoisted in front of it."""
        match statement:
            case ir.If():
                return self.choice(statement)
            case ir.While():
                return self.loop(statement)
            case ir.Repeat():
                return self.repeated(statement)
            case ir.For():
                return self.counting(statement)
            case ir.Switch():
                return self.switch(statement)
            case ir.Loop(body=body):
                return (changed(statement, body=self.body(body)),)
        return self.single(statement)

    def expanded(self, old: ir.Statement, before: ir.Body, new: ir.Statement) -> ir.Body:
        return (new,) if not before else expansion(old.origin, (*self.ready(before), new))

    def choice(self, statement: ir.If) -> ir.Body:
        """A chain of conditions; one that needs statements first begins a chain inside the ELSE of the last."""
        lowered = [(self.condition(condition), self.body(body)) for condition, body in statement.branches]
        otherwise = self.body(statement.otherwise)
        branches: list[tuple[ir.Expression, ir.Body]] = []
        for at in range(len(lowered) - 1, -1, -1):
            (before, condition), body = lowered[at]
            branches.insert(0, (condition, body))
            if before and at > 0:
                chain = ir.If(tuple(branches), otherwise, origin=replace(statement.origin, comments=()))
                otherwise = self.expanded(chain, before, chain)
                branches = []
        if len(branches) == len(statement.branches):
            old = statement.branches
            branches = [one if same(one, new) else new for one, new in zip(old, branches, strict=True)]
        new = changed(statement, branches=tuple(branches), otherwise=otherwise)
        return self.expanded(statement, lowered[0][0][0], new)

    def loop(self, statement: ir.While) -> ir.Body:
        before, condition = self.condition(statement.condition)
        body = self.body(statement.body)
        if not before:
            return (changed(statement, condition=condition, body=body),)
        leave = ir.If(((self.opposite(condition), (ir.ExitLoop(),)),))
        return (ir.Loop((*self.ready(before), *self.failed(), leave, *body), origin=statement.origin),)

    def repeated(self, statement: ir.Repeat) -> ir.Body:
        body = self.body(statement.body)
        before, until = self.condition(statement.until)
        if not before:
            return (changed(statement, until=until, body=body),)
        if not passes_on(body):
            return (replace(statement, until=until, body=(*body, *self.ready(before), *self.failed())),)
        again = self.editor.temporary("again", ir.BoolType())
        leave = ir.If(((until, (ir.ExitLoop(),)),))
        check = ir.If(((again, (*self.ready(before), *self.failed(), leave)),))
        loop = ir.Loop((check, ir.Assign(again, ir.BoolLiteral(True)), *body))
        return expansion(statement.origin, (ir.Assign(again, ir.BoolLiteral(False)), loop))

    def counting(self, statement: ir.For) -> ir.Body:
        given = [statement.start, statement.stop] + ([] if statement.step is None else [statement.step])
        before, (start, stop, *step) = self.bounds(given)
        with self.editor.counting(statement, self.counter_type(statement)):
            body = self.body(statement.body)
        new = changed(statement, start=start, stop=stop, step=step[0] if step else None, body=body)
        return self.expanded(statement, before, new)

    def bounds(self, given: list[ir.Expression]) -> tuple[ir.Body, list[ir.Expression]]:
        """Where a loop begins and ends, and its step."""
        return self.several(given, [False] * len(given))

    def counter_type(self, statement: ir.For) -> ir.Type:
        """The type of a counter that exists in its loop only."""
        return counter_type(statement, self.editor.scope)

    def switch(self, statement: ir.Switch) -> ir.Body:
        before, selector = self.lower(statement.selector)
        cases = []
        for case in statement.cases:
            values = [self.case_value(value) for value in case.values]
            before = (*before, *(one for first, _ in values for one in first))
            cases.append(changed(case, values=tuple(value for _, value in values)))
        done = tuple(changed(case, body=self.body(case.body)) for case in cases)
        default = None if statement.default is None else self.body(statement.default)
        return self.expanded(statement, before, changed(statement, selector=selector, cases=done, default=default))

    def deciding(self, expression: ir.Binary) -> Lowered:
        """`cand`/`cor`: what the right side needs runs only where the left side does not decide."""
        before, left = self.lower(expression.left)
        further, right = self.lower(expression.right)
        if not further:
            return before, changed(expression, left=left, right=right)
        result = self.editor.temporary("decided", ir.BoolType())
        goes_on = result if expression.op == "cand" else ir.Unary("not", result)
        chosen = ir.If(((goes_on, (*further, ir.Assign(result, right))),))
        return (*before, ir.Assign(result, left), chosen), result


class Hoister(Bodies):
    """Applies a rule to every expression of a body, bottom up."""

    def __init__(self, editor: Editor, rule: Rule, acts_on: Set[str] = frozenset()) -> None:
        self.editor = editor
        self.rule = rule
        self.acts_on = acts_on or self.acts_on

    # ---- expressions

    def lower(self, expression: ir.Expression, lvalue: bool = False) -> Lowered:
        if isinstance(expression, ir.Binary) and expression.op in ("cand", "cor"):
            before, done = self.deciding(expression)
            return self._ruled(before, done) if isinstance(done, ir.Binary) else (before, done)
        before, rebuilt = self._operands(expression, lvalue)
        if lvalue and isinstance(rebuilt, _LVALUES):
            return before, rebuilt
        return self._ruled(before, rebuilt)

    def case_value(self, value: ir.Expression) -> Lowered:
        return (), self.flat(value)

    def flat(self, expression: ir.Expression) -> ir.Expression:
        """Rewritten as far as it goes without statements before it (conditions that a controller watches)."""
        rebuilt = rewrite_parts(expression, self.flat)
        changed = self.rule(rebuilt)
        return rebuilt if changed is None or changed[0] else changed[1]

    def _ruled(self, before: ir.Body, expression: ir.Expression) -> Lowered:
        changed = self.rule(expression)
        return (before, expression) if changed is None else (before + changed[0], changed[1])

    def _operands(self, expression: ir.Expression, lvalue: bool) -> Lowered:
        parts = children(expression)
        if not parts:
            return (), expression
        match expression:
            case ir.Index() | ir.Field():
                in_place = [True] + [False] * (len(parts) - 1)
            case ir.Call(name=name, arguments=arguments):
                in_place = written_arguments(name, arguments, self.editor.scope)
            case _:
                in_place = [False] * len(parts)
        before, values = self.several(parts, in_place)
        if all(new is old for new, old in zip(values, parts, strict=True)):
            return before, expression
        return before, rebuilt(expression, values)

    def several(self, parts: Sequence[ir.Expression], in_place: Sequence[bool]) -> tuple[ir.Body, list[ir.Expression]]:
        """Operands in order of evaluation: one that would be overtaken by a later one's statements is saved first."""
        lowered = [self.lower(part, place) for part, place in zip(parts, in_place, strict=True)]
        last = max((at for at, (before, _) in enumerate(lowered) if before), default=-1)
        done: list[ir.Statement] = []
        values = []
        for at, (before, value) in enumerate(lowered):
            done.extend(before)
            later = tuple(one for further, _ in lowered[at + 1 :] for one in further)
            if at < last and not (in_place[at] and isinstance(value, _LVALUES)) and not self.settled(value, later):
                type = self.editor.type_of(value)
                if type is not None:
                    saved = self.editor.temporary("saved", type)
                    done.append(ir.Assign(saved, value))
                    value = saved
            values.append(value)
        return tuple(done), values

    def settled(self, value: ir.Expression, later: ir.Body) -> bool:
        """Is it the same whether evaluated before or behind these statements?"""
        if is_constant(value) or (isinstance(value, ir.Name) and value.id.lower() in self.editor.own):
            return True
        return self.editor.effects.quiet(value) and self.editor.effects.quiet_body(later, self.editor.own)

    # ---- statements

    def single(self, statement: ir.Statement) -> ir.Body:
        match statement:
            case ir.DeclareInterrupt(priority=priority):
                before, value = self.lower(priority)
                flat = rewrite_parts(replace(statement, priority=ir.IntLiteral(0)), self.flat, self._flat_body)
                return self.expanded(statement, before, replace(flat, priority=value))
            case ir.OrderInterrupt() | ir.Trigger() | ir.DefineTrigger() | ir.Spline():
                return (rewrite_parts(statement, self.flat, self._flat_body),)
            case ir.WaitUntil(condition=condition):
                watched = self.flat(condition)
                return self._plain(changed(statement, condition=watched), (watched,))
            case ir.Move(search=search):
                return self._move(statement, search)
        return self._plain(statement)

    def _flat_body(self, body: ir.Body) -> ir.Body:
        return tuple(rewrite_parts(statement, self.flat, self._flat_body) for statement in body)

    def _plain(self, statement: ir.Statement, watched: tuple[ir.Expression, ...] = ()) -> ir.Body:
        parts = children(statement)
        if not parts:
            return (statement,)
        places = self._places(statement, parts)
        fixed = [any(part is one for one in watched) for part in parts]
        moving = [part for part, stays in zip(parts, fixed, strict=True) if not stays]
        before, values = self.several(moving, [p for p, stays in zip(places, fixed, strict=True) if not stays])
        if all(new is old for new, old in zip(values, moving, strict=True)) and not before:
            return (statement,)
        given = iter(values)
        every = [part if stays else next(given) for part, stays in zip(parts, fixed, strict=True)]
        return self.expanded(statement, before, rebuilt(statement, every))

    def _places(self, statement: ir.Statement, parts: list[ir.Expression]) -> list[bool]:
        """Which expressions of a statement are places that it writes."""
        match statement:
            case ir.CallRoutine(name=name, arguments=arguments, dynamic=None):
                return written_arguments(name, arguments, self.editor.scope)
            case ir.Do(procedure=procedure, arguments=arguments):
                kinds = ir.PROCEDURES[procedure].parameters if procedure in ir.PROCEDURES else ""
                given = [at for at, one in enumerate(arguments) if one is not None]
                return [kinds[at : at + 1] in ("l", "") for at in given]
            case ir.Assign():
                return [True, False]
        written = [
            getattr(statement, name, None) for name in ("timed_out", "answer", "clock", "handle", "target", "found")
        ]
        return [any(part is one for one in written) for part in parts]

    def _move(self, statement: ir.Move, search: ir.Search | None) -> ir.Body:
        if search is None:
            return self._plain(statement)
        done = self._plain(replace(statement, search=None))
        last = done[-1]
        assert isinstance(last, ir.Move)  # _plain keeps the statement's class
        return (*done[:-1], replace(last, search=rewrite_parts(search, self.flat)))


def rebuilt(node: Node, values: Sequence[ir.Expression]) -> Node:
    """The node with its direct expressions replaced, in the order of `children`."""
    given = iter(values)
    return rewrite_parts(node, lambda _: next(given))


def written_arguments(name: str, arguments: tuple[ir.Argument, ...], scope: Scope) -> list[bool]:
    """For each argument with a value: may the routine write it?"""
    routine = scope.routine(name)
    if routine is None:
        return [True for argument in arguments if argument.value is not None]
    by_name = {scope.fold(parameter.name): parameter for parameter in routine.parameters}
    positional = iter([parameter for parameter in routine.parameters if not parameter.optional])
    done = []
    for argument in arguments:
        parameter = by_name.get(scope.fold(argument.name)) if argument.name else next(positional, None)
        if argument.value is not None:
            done.append(parameter is None or parameter.mode == "reference")
    return done

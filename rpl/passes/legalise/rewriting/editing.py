"""Rewriting one routine at a time: temporaries with their types, and expressions hoisted in front of their statement.

A pass gives a `Rule`: what an expression (its operands already rewritten) becomes, and which statements must run before
it. The Hoister puts these statements where the value is wanted and nowhere else: behind the operands that are evaluated
earlier, inside the branch of a `cand` or `elseif` that needs it, and again in each pass of a loop.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import replace
from operator import is_
from typing import TypeVar

from rpl import ir
from rpl.passes.legalise.context import Context
from rpl.passes.legalise.facts.effects import Effects, children, is_constant, statements_in
from rpl.passes.rewrite import rewrite_parts
from rpl.passes.scope import ProgramScope, Scope
from rpl.passes.typing import counter_type, type_of
from rpl.source import NOWHERE, Origin

Lowered = tuple[ir.Body, ir.Expression]
Rule = Callable[[ir.Expression], Lowered | None]
Node = TypeVar("Node")
_LVALUES = (ir.Name, ir.Index, ir.Field, ir.System, ir.Signal)


class Editor:
    """One routine being rewritten: what names mean there, the facts of the program, and the variables added to it."""

    def __init__(self, context: Context, effects: Effects, scope: Scope) -> None:
        self.context = context
        self.capabilities = context.capabilities
        self.effects = effects
        self.scope = scope
        self.added: list[ir.Variable] = []
        self.own: set[str] = set()

    def temporary(self, stem: str, type: ir.Type) -> ir.Name:
        """A new variable of the routine. A character is a text where the target has no type of characters."""
        if isinstance(type, ir.CharType) and "CharType" not in self.capabilities.types:
            type = ir.StringType()
        variable = ir.Variable(self.context.fresh(stem), type, scope="routine")
        self.added.append(variable)
        self.own.add(variable.name.lower())
        self.scope = self.scope.with_value(variable)
        return ir.Name(variable.name)

    def type_of(self, expression: ir.Expression) -> ir.Type | None:
        return type_of(expression, self.scope)

    @contextmanager
    def counting(self, loop: ir.For) -> Iterator[None]:
        """Inside a loop whose counter is its own."""
        outer = self.scope
        known = len(self.added)
        if loop.scoped:
            self.scope = self.scope.with_value(ir.Variable(loop.counter, counter_type(loop, self.scope)))
        yield
        self.scope = outer
        for variable in self.added[known:]:
            self.scope = self.scope.with_value(variable)

    def closed(self, routine: ir.Routine) -> ir.Routine:
        """The routine with the new variables declared."""
        return replace(routine, declarations=(*routine.declarations, *self.added)) if self.added else routine


def edit_routines(
    program: ir.Program, context: Context, work: Callable[[Editor, ir.Routine], ir.Routine]
) -> ir.Program:
    """The program with each routine rewritten by `work`; temporaries are declared in the routine."""
    scopes = ProgramScope(program)
    effects = Effects(program)

    def edited(module: ir.Module, routine: ir.Routine) -> ir.Routine:
        editor = Editor(context, effects, scopes.routine(module, routine))
        return editor.closed(work(editor, routine))

    return edit_each(program, edited)


def edit_bodies(routine: ir.Routine, on_body: Callable[[ir.Body], ir.Body]) -> ir.Routine:
    """The routine with each of its bodies rewritten; the same object when nothing changed."""
    body, undo, backward = on_body(routine.body), on_body(routine.undo), on_body(routine.backward)
    handlers = tuple(
        handler if (done := on_body(handler.body)) is handler.body else replace(handler, body=done)
        for handler in routine.handlers
    )
    if (
        body is routine.body
        and undo is routine.undo
        and backward is routine.backward
        and all(new is old for new, old in zip(handlers, routine.handlers, strict=True))
    ):
        return routine
    return replace(routine, body=body, undo=undo, backward=backward, handlers=handlers)


def edit_all(program: ir.Program, on_body: Callable[[ir.Body], ir.Body]) -> ir.Program:
    """The program with each body of each routine rewritten; the same object when nothing changed."""
    return edit_each(program, lambda module, routine: edit_bodies(routine, on_body))


def edit_each(program: ir.Program, work: Callable[[ir.Module, ir.Routine], ir.Routine]) -> ir.Program:
    """The program with each routine rewritten; the same object when nothing changed."""
    modules = []
    for module in program.modules:
        routines = tuple(work(module, routine) for routine in module.routines)
        same = all(map(is_, routines, module.routines))
        modules.append(module if same else replace(module, routines=routines))
    return program if all(map(is_, modules, program.modules)) else replace(program, modules=tuple(modules))


def expansion(origin: Origin, statements: Sequence[ir.Statement]) -> ir.Body:
    """Statements that replace one: each has its place, the first its comments."""
    plain = replace(origin, comments=()) if origin.comments else origin
    done: list[ir.Statement] = []
    for statement in statements:
        own = statement.origin
        if own is NOWHERE or (own.source is origin.source and own.start == origin.start and own.end == origin.end):
            wanted = plain if done else origin
            statement = statement if own is wanted else replace(statement, origin=wanted)
        done.append(statement)
    return tuple(done)


def map_body(body: ir.Body, change: Callable[[ir.Statement], ir.Body]) -> ir.Body:
    """The body with each statement replaced by what `change` gives; the same object when nothing changed."""
    done: list[ir.Statement] = []
    same = True
    for statement in body:
        new = change(statement)
        same = same and len(new) == 1 and new[0] is statement
        done.extend(new)
    return body if same else tuple(done)


def negation(condition: ir.Expression) -> ir.Expression:
    """The opposite condition, in the shorter way of writing it."""
    opposite = {"=": "<>", "<>": "=", "<": ">=", ">=": "<", ">": "<=", "<=": ">"}
    match condition:
        case ir.Unary(op="not", operand=operand):
            return operand
        case ir.BoolLiteral(value=value):
            return replace(condition, value=not value)
        case ir.Binary(op=op) if op in opposite:
            return replace(condition, op=opposite[op])
    return ir.Unary("not", condition, origin=condition.origin)


def passes_on(body: ir.Body) -> bool:
    """Does the body of a loop have a NextPass of that loop?"""
    return _own_jump(body, ir.NextPass)


def exits(body: ir.Body) -> bool:
    """Does the body of a loop have an ExitLoop of that loop?"""
    return _own_jump(body, ir.ExitLoop)


def _own_jump(body: ir.Body, kind: type) -> bool:
    for statement in body:
        match statement:
            case ir.If(branches=branches, otherwise=otherwise):
                if any(_own_jump(inner, kind) for _, inner in branches) or _own_jump(otherwise, kind):
                    return True
            case ir.Switch(cases=cases, default=default):
                if any(_own_jump(case.body, kind) for case in cases) or _own_jump(default or (), kind):
                    return True
            case _:
                if isinstance(statement, kind):
                    return True
    return False


class Hoister:
    """Applies a rule to every expression of a body, bottom up."""

    def __init__(self, editor: Editor, rule: Rule) -> None:
        self.editor = editor
        self.rule = rule

    # ---- expressions

    def lower(self, expression: ir.Expression, lvalue: bool = False) -> Lowered:
        """What must run before, and the expression that then gives the value. Of an lvalue only subscripts change."""
        if isinstance(expression, ir.Binary) and expression.op in ("cand", "cor"):
            return self._deciding(expression)
        before, rebuilt = self._operands(expression, lvalue)
        if lvalue and isinstance(rebuilt, _LVALUES):
            return before, rebuilt
        return self._ruled(before, rebuilt)

    def condition(self, expression: ir.Expression) -> Lowered:
        """A condition of a branch or a loop (a pass may know another form for it)."""
        return self.lower(expression)

    def opposite(self, condition: ir.Expression) -> ir.Expression:
        """The opposite of a condition in its last form."""
        return negation(condition)

    def flat(self, expression: ir.Expression) -> ir.Expression:
        """Rewritten as far as it goes without statements before it (conditions that a controller watches)."""
        rebuilt = rewrite_parts(expression, self.flat)
        changed = self.rule(rebuilt)
        return rebuilt if changed is None or changed[0] else changed[1]

    def _ruled(self, before: ir.Body, expression: ir.Expression) -> Lowered:
        changed = self.rule(expression)
        return (before, expression) if changed is None else (before + changed[0], changed[1])

    def _deciding(self, expression: ir.Binary) -> Lowered:
        """`cand`/`cor`: what the right side needs runs only where the left side does not decide."""
        before, left = self.lower(expression.left)
        further, right = self.lower(expression.right)
        if not further:
            same = left is expression.left and right is expression.right
            return self._ruled(before, expression if same else replace(expression, left=left, right=right))
        result = self.editor.temporary("decided", ir.BoolType())
        goes_on = result if expression.op == "cand" else ir.Unary("not", result)
        chosen = ir.If(((goes_on, (*further, ir.Assign(result, right))),))
        return (*before, ir.Assign(result, left), chosen), result

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

    def body(self, body: ir.Body) -> ir.Body:
        return map_body(body, self.statement)

    def statement(self, statement: ir.Statement) -> ir.Body:
        """The statement with what had to be hoisted in front of it."""
        match statement:
            case ir.If():
                return self._if(statement)
            case ir.While():
                return self._while(statement)
            case ir.Repeat():
                return self._repeat(statement)
            case ir.For():
                return self._for(statement)
            case ir.Switch():
                return self._switch(statement)
            case ir.Loop(body=body):
                done = self.body(body)
                return (statement if done is body else replace(statement, body=done),)
            case ir.DeclareInterrupt(priority=priority):
                before, value = self.lower(priority)
                flat = rewrite_parts(replace(statement, priority=ir.IntLiteral(0)), self.flat, self._flat_body)
                return self._finished(statement, before, replace(flat, priority=value))
            case ir.OrderInterrupt() | ir.Trigger() | ir.DefineTrigger() | ir.Spline():
                return (rewrite_parts(statement, self.flat, self._flat_body),)
            case ir.WaitUntil(condition=condition):
                watched = self.flat(condition)
                return self._plain(
                    statement if watched is condition else replace(statement, condition=watched), (watched,)
                )
            case ir.Move(search=search):
                return self._move(statement, search)
        return self._plain(statement)

    def _flat_body(self, body: ir.Body) -> ir.Body:
        return tuple(rewrite_parts(statement, self.flat, self._flat_body) for statement in body)

    def ready(self, before: ir.Body) -> ir.Body:
        """The statements in front of a condition, as they are written there (a pass may add checks)."""
        return before

    def failed(self) -> ir.Body:
        """What leaves a loop whose condition could not be evaluated."""
        return ()

    def _finished(self, old: ir.Statement, before: ir.Body, new: ir.Statement) -> ir.Body:
        return (new,) if not before else expansion(old.origin, (*self.ready(before), new))

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
        return self._finished(statement, before, rebuilt(statement, every))

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

    def _if(self, statement: ir.If) -> ir.Body:
        lowered = [(self.condition(condition), self.body(body)) for condition, body in statement.branches]
        branches: list[tuple[ir.Expression, ir.Body]] = []
        otherwise = self.body(statement.otherwise)
        for at in range(len(lowered) - 1, -1, -1):
            (before, condition), body = lowered[at]
            branches.insert(0, (condition, body))
            if before and at > 0:
                chain = ir.If(tuple(branches), otherwise, origin=replace(statement.origin, comments=()))
                otherwise = self._finished(chain, before, chain)
                branches = []
        same = otherwise is statement.otherwise and len(branches) == len(statement.branches)
        if same and all(
            new[0] is old[0] and new[1] is old[1] for new, old in zip(branches, statement.branches, strict=True)
        ):
            new = statement
        else:
            new = replace(statement, branches=tuple(branches), otherwise=otherwise)
        return self._finished(statement, lowered[0][0][0], new)

    def _while(self, statement: ir.While) -> ir.Body:
        before, condition = self.condition(statement.condition)
        body = self.body(statement.body)
        if not before:
            same = condition is statement.condition and body is statement.body
            return (statement if same else replace(statement, condition=condition, body=body),)
        leave = ir.If(((self.opposite(condition), (ir.ExitLoop(),)),))
        return (ir.Loop((*self.ready(before), *self.failed(), leave, *body), origin=statement.origin),)

    def _repeat(self, statement: ir.Repeat) -> ir.Body:
        body = self.body(statement.body)
        before, until = self.condition(statement.until)
        if not before:
            same = until is statement.until and body is statement.body
            return (statement if same else replace(statement, until=until, body=body),)
        if not passes_on(body):
            return (replace(statement, until=until, body=(*body, *self.ready(before), *self.failed())),)
        again = self.editor.temporary("again", ir.BoolType())
        leave = ir.If(((until, (ir.ExitLoop(),)),))
        check = ir.If(((again, (*self.ready(before), *self.failed(), leave)),))
        loop = ir.Loop((check, ir.Assign(again, ir.BoolLiteral(True)), *body))
        return expansion(statement.origin, (ir.Assign(again, ir.BoolLiteral(False)), loop))

    def _for(self, statement: ir.For) -> ir.Body:
        given = [statement.start, statement.stop] + ([] if statement.step is None else [statement.step])
        before, values = self.several(given, [False] * len(given))
        with self.editor.counting(statement):
            body = self.body(statement.body)
        same = body is statement.body and all(new is old for new, old in zip(values, given, strict=True))
        step = values[2] if len(values) > 2 else None
        new = statement if same else replace(statement, start=values[0], stop=values[1], step=step, body=body)
        return self._finished(statement, before, new)

    def _switch(self, statement: ir.Switch) -> ir.Body:
        before, selector = self.lower(statement.selector)
        cases = tuple(
            replace(case, values=tuple(map(self.flat, case.values)), body=self.body(case.body))
            for case in statement.cases
        )
        default = None if statement.default is None else self.body(statement.default)
        new = replace(statement, selector=selector, cases=cases, default=default)
        same = new == statement and not before
        return (statement,) if same else self._finished(statement, before, new)


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


def jumps(body: ir.Body) -> bool:
    """Are there labels or gotos in the body?"""
    return any(isinstance(statement, ir.Label | ir.Goto) for statement in statements_in(body))

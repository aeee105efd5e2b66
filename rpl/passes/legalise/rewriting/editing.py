"""Rewriting one routine at a time, in all of its bodies, with temporaries and their types.

What rewrites says which kinds of nodes it acts on (`acts_on`, as `kinds_of` names them; empty: any). A routine or a
statement that holds none of them is left as it is and not entered.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence, Set
from contextlib import contextmanager
from dataclasses import replace

from rpl import ir
from rpl.passes.legalise.context import Context
from rpl.passes.legalise.facts.effects import Effects
from rpl.passes.legalise.kinds import holds_none
from rpl.passes.rewrite import changed
from rpl.passes.scope import ProgramScope, Scope
from rpl.passes.typing import counter_type, type_of
from rpl.source import NOWHERE, Origin


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
    def counting(self, loop: ir.For, type: ir.Type | None = None) -> Iterator[None]:
        """Inside a loop whose counter, of this type, is its own."""
        outer = self.scope
        known = len(self.added)
        if loop.scoped:
            self.scope = self.scope.with_value(ir.Variable(loop.counter, type or counter_type(loop, outer)))
        yield
        self.scope = outer
        for variable in self.added[known:]:
            self.scope = self.scope.with_value(variable)

    def closed(self, routine: ir.Routine) -> ir.Routine:
        """The routine with the new variables declared."""
        return replace(routine, declarations=(*routine.declarations, *self.added)) if self.added else routine


def edit_routines(
    program: ir.Program,
    context: Context,
    work: Callable[[Editor, ir.Routine], ir.Routine],
    acts_on: Set[str] = frozenset(),
) -> ir.Program:
    """The program with each routine rewritten by `work`; temporaries are declared in the routine."""
    scopes = ProgramScope(program)
    effects = Effects(program)

    def edited(module: ir.Module, routine: ir.Routine) -> ir.Routine:
        editor = Editor(context, effects, scopes.routine(module, routine))
        return editor.closed(work(editor, routine))

    return edit_each(program, edited, acts_on)


def edit_bodies(routine: ir.Routine, on_body: Callable[[ir.Body], ir.Body]) -> ir.Routine:
    """The routine with each of its bodies rewritten; the same object when nothing changed."""
    body = on_body(routine.body)
    handlers = tuple([changed(handler, body=on_body(handler.body)) for handler in routine.handlers])
    undo, backward = on_body(routine.undo), on_body(routine.backward)
    return changed(routine, body=body, handlers=handlers, undo=undo, backward=backward)


def edit_all(program: ir.Program, on_body: Callable[[ir.Body], ir.Body], acts_on: Set[str] = frozenset()) -> ir.Program:
    """The program with each body of each routine rewritten; the same object when nothing changed."""
    return edit_each(program, lambda module, routine: edit_bodies(routine, on_body), acts_on)


def edit_each(
    program: ir.Program, work: Callable[[ir.Module, ir.Routine], ir.Routine], acts_on: Set[str] = frozenset()
) -> ir.Program:
    """The program with each routine rewritten; the same object when nothing changed."""

    def edited(module: ir.Module, routine: ir.Routine) -> ir.Routine:
        return routine if holds_none(routine, acts_on) else work(module, routine)

    modules = tuple(
        [changed(one, routines=tuple([edited(one, each) for each in one.routines])) for one in program.modules]
    )
    return changed(program, modules=modules)


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


def map_body(body: ir.Body, change: Callable[[ir.Statement], ir.Body], acts_on: Set[str] = frozenset()) -> ir.Body:
    """The body with each statement replaced by what `change` gives; the same object when nothing changed."""
    done: list[ir.Statement] = []
    same = True
    for statement in body:
        if holds_none(statement, acts_on):
            done.append(statement)
            continue
        new = change(statement)
        same = same and len(new) == 1 and new[0] is statement
        done.extend(new)
    return body if same else tuple(done)


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

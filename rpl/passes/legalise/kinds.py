"""Which kinds of nodes a program or a part of it holds, and walks that pass by what holds none of those asked for.

Kinds are kept by statement: a pass that changes three statements of 200,000 costs three walks and no more.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Set
from functools import wraps
from typing import TypeVar, cast, get_args

from rpl import ir
from rpl.ir.walk import children, is_expression, is_statement, map_children, walk
from rpl.passes.legalise.kept import of_node, of_program, shared
from rpl.passes.rewrite import visit_parts

_DECLARATIONS = (
    *(ir.Variable, ir.VariableRows, ir.RecordDeclaration, ir.EnumDeclaration, ir.AliasDeclaration),
    *(ir.SignalDeclaration, ir.ExternalDeclaration, ir.Initialise),
)

_WITH_BODIES = frozenset((ir.If, ir.Switch, ir.While, ir.For, ir.Repeat, ir.Loop, ir.Spline, ir.Handler))
_STATEMENTS = frozenset(one.__name__ for one in get_args(ir.Statement))
_PASSED = frozenset((*get_args(ir.Statement), *_DECLARATIONS))  # entered where they hold what is asked for
_TELLING = frozenset((ir.Builtin, ir.System, ir.Binary, ir.Unary, ir.Do, ir.Signal, ir.Move, ir.CallRoutine))
T = TypeVar("T")
N = TypeVar("N")


def kinds_of(node: object) -> tuple[str, ...]:
    """What may be seen of one node: the name of its class, and of a built-in thing which one it is: `Move`;
    `Builtin`, `function text_part`; `System`, `system tool`; `Binary`, `operator mod`; `Do`, `procedure set_group`;
    `Signal`, `signal flag`; of moves also `move_kinds`; of calls whose name is a text `call by text`."""
    name = node.__class__.__name__
    match node:
        case ir.Builtin(function=which):
            return name, f"function {which}"
        case ir.System(name=which):
            return name, f"system {which}"
        case ir.Binary(op=which) | ir.Unary(op=which):
            return name, f"operator {which}"
        case ir.Do(procedure=which):
            return name, f"procedure {which}"
        case ir.Signal(kind=which):
            return name, f"signal {which}"
        case ir.Move():
            return name, *move_kinds(node)
        case ir.CallRoutine(dynamic=text) if text is not None:
            return name, "call by text"
    return (name,)


def move_kinds(move: ir.Move) -> Iterator[str]:
    """What is not said of every move: `move relative to base`, `velocity move`."""
    if move.relative is not None:
        yield f"move relative to {move.relative}"
    if move.motion_class != "classic":
        yield f"{move.motion_class} move"


@of_node
def kinds_within(node: object) -> frozenset[str]:
    """The kinds of a node and of all below it; the statements in blocks are asked for theirs."""
    found: set[str] = set()
    if node.__class__ not in _WITH_BODIES:
        for one in walk(node):
            if one.__class__ in _TELLING:
                found.update(kinds_of(one))
            else:
                found.add(one.__class__.__name__)
        return shared(frozenset(found))
    stack: list[object] = [node]
    while stack:
        one = stack.pop()
        if one is not node and is_statement(one):
            found |= kinds_within(one)
        else:
            found.update(kinds_of(one))
            stack += children(one)
    return shared(frozenset(found))


def gathering(*kinds: str) -> Callable[[Callable[[ir.Statement], Iterable[T]]], Callable[[ir.Statement], frozenset[T]]]:
    """Makes a question about a statement, its bodies left aside, one about all that is in it. kinds: who holds none of
    them has nothing to answer."""
    asked_of = frozenset(kinds)

    def made(own: Callable[[ir.Statement], Iterable[T]]) -> Callable[[ir.Statement], frozenset[T]]:
        @of_node
        @wraps(own)
        def answer(statement: ir.Statement) -> frozenset[T]:
            found = set(own(statement))
            if _holds_statements(statement):
                visit_parts(statement, _nothing, lambda body: found.update(*map(asked, body)))
            return shared(frozenset(found))

        def asked(statement: ir.Statement) -> frozenset[T]:
            return frozenset() if asked_of.isdisjoint(kinds_within(statement)) else answer(statement)

        return asked

    return made


def _holds_statements(statement: object) -> bool:
    return statement.__class__ in _WITH_BODIES or len(_STATEMENTS & kinds_within(statement)) > (
        statement.__class__.__name__ in _STATEMENTS
    )


def _nothing(expression: ir.Expression) -> None:
    """Expressions hold no statements."""


@of_program
def kinds_in(program: ir.Program) -> frozenset[str]:
    """The kinds of all nodes of its modules."""
    found: set[str] = set()
    for module in program.modules:
        found.add("Module")
        for declaration in module.declarations:
            found |= kinds_within(declaration)
        for routine in module.routines:
            found |= kinds_in_routine(routine)
    return frozenset(found)


@of_node
def kinds_in_routine(routine: ir.Routine) -> frozenset[str]:
    found = {"Routine"}
    for parts in (routine.declarations, routine.body, routine.undo, routine.backward, routine.parameters):
        for part in parts:
            found |= kinds_within(part)
    for handler in routine.handlers:
        found |= kinds_within(handler)
    if routine.returns is not None:
        found |= kinds_within(routine.returns)
    return shared(frozenset(found))


def holds_none(node: object, kinds: Set[str]) -> bool:
    """Is it a routine, a declaration or a statement without any of these kinds? Everything that is passed by is asked
    here. No kinds: they are not known, and nothing is passed by."""
    if not kinds:
        return False
    if isinstance(node, ir.Routine):
        return kinds.isdisjoint(kinds_in_routine(node))
    return node.__class__ in _PASSED and kinds.isdisjoint(kinds_within(node))


def walk_for(kinds: Set[str], *roots: object) -> Iterator[object]:
    """The nodes of these kinds in the order of `walk`. What holds none of them is passed by: routines, declarations,
    statements, and where only statements are asked for all expressions."""
    plain, telling = _STATEMENTS.issuperset(kinds), any(" " in one for one in kinds)

    def is_one(node: object) -> bool:
        kind = node.__class__
        return kind.__name__ in kinds or (telling and kind in _TELLING and not kinds.isdisjoint(kinds_of(node)))

    stack = [node for root in reversed(roots) for node in (reversed(root) if isinstance(root, tuple) else (root,))]
    while stack:
        node = stack.pop()
        kind = node.__class__
        if holds_none(node, kinds) or (plain and is_expression(node)):
            continue
        if kind in _WITH_BODIES or not (is_expression(node) or kind in _PASSED):
            stack += reversed(children(node))
        elif not plain:
            yield from filter(is_one, walk(node))
            continue
        elif _holds_statements(node):
            stack += reversed(children(node))
        if is_one(node):
            yield node


def rewrite_for(kinds: Set[str], node: N, change: Callable[[object], object]) -> N:
    """As `ir.walk.rewrite`, for a change that acts on nodes of these kinds only: routines, declarations and statements
    that hold none of them are not entered and stay as they are."""

    def rewritten(one: object) -> object:
        if holds_none(one, kinds):
            return one
        return change(map_children(one, rewritten))

    return cast(N, rewritten(node))


def has_arcs(program: ir.Program) -> bool:
    """Does any move go along an arc?"""
    return any(isinstance(one, ir.Move) and one.kind == "circular" for one in walk_for({"Move"}, *program.modules))


__all__ = [
    "gathering",
    "holds_none",
    "kinds_in",
    "kinds_in_routine",
    "kinds_of",
    "kinds_within",
    "move_kinds",
    "rewrite_for",
    "walk_for",
    "has_arcs",
]

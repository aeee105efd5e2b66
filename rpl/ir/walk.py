"""Going through a tree of the IR and rebuilding it, for any node, by its own fields.

Passes name only the nodes they change; the rest is carried along here. A rebuilt node keeps its origin, and a part that
did not change stays the same object, so that comparing by identity tells whether anything happened.
"""

from __future__ import annotations

import dataclasses
from collections.abc import Callable, Iterator
from operator import attrgetter, is_
from typing import TypeGuard, TypeVar, cast, get_args

from rpl.ir.expressions import Aggregate, Expression
from rpl.ir.modules import Routine
from rpl.ir.statements import Body, Statement
from rpl.source import Origin

Node = TypeVar("Node")

_EXPRESSIONS = frozenset(get_args(Expression))
_STATEMENTS = frozenset(get_args(Statement))
_EMPTY: tuple[object, ...] = ()


# Annotations of fields that never hold a node: names, operators, switches. Most fields are of these.
_PLAIN_TYPES = frozenset(("str", "int", "float", "bool", "str | None", "int | None", "float | None", "bool | None"))


class _Fields(dict[type, tuple[str, ...]]):
    """The fields of a node class that can hold parts; remembered, because this is asked for every node."""

    def __missing__(self, kind: type) -> tuple[str, ...]:
        node = dataclasses.is_dataclass(kind) and not issubclass(kind, Origin)
        fields = dataclasses.fields(kind) if node else ()
        self[kind] = found = tuple(f.name for f in fields if f.name != "origin" and f.type not in _PLAIN_TYPES)
        return found


class _Parts(dict[type, Callable[[object], tuple[object, ...]]]):
    """What takes those fields' values from a node of the class, in order."""

    def __missing__(self, kind: type) -> Callable[[object], tuple[object, ...]]:
        names = PART_FIELDS[kind]
        taken: Callable[[object], tuple[object, ...]]
        if len(names) > 1:
            taken = attrgetter(*names)
        elif names:
            one = attrgetter(*names)
            taken = lambda node: (one(node),)  # noqa: E731 (one of three)
        else:
            taken = _no_parts
        self[kind] = taken
        return taken


def _no_parts(node: object) -> tuple[object, ...]:
    return ()


PART_FIELDS = _Fields()
PARTS = _Parts()


# Classes whose values hold no nodes: what most fields of a node are; classes that were asked for are added.
_PLAIN: set[type] = {str, int, float, bool, type(None), Origin}
_NODES: set[type] = set()


def _is_node(part: object) -> bool:
    kind = part.__class__
    if kind in _PLAIN or kind in _NODES:
        return kind in _NODES
    if dataclasses.is_dataclass(kind):
        _NODES.add(kind)
        return True
    if kind is not tuple:
        _PLAIN.add(kind)
    return False


def children(node: object) -> list[object]:
    """The nodes directly below a node (or inside nested tuples), in the order of its fields."""
    found: list[object] = []
    for part in PARTS[node.__class__](node):
        kind = part.__class__
        if kind in _NODES:
            found.append(part)
        elif kind not in _PLAIN and part is not _EMPTY:
            _collect(part, found)
    return found


def _collect(part: object, found: list[object]) -> None:
    if part.__class__ is tuple:
        for item in cast(tuple[object, ...], part):
            kind = item.__class__
            if kind in _NODES:
                found.append(item)
            elif kind not in _PLAIN:
                _collect(item, found)
    elif _is_node(part):
        found.append(part)


def _nodes(part: object) -> list[object]:
    found: list[object] = []
    _collect(part, found)
    return found


def walk(*roots: object) -> Iterator[object]:
    """Every node of the trees, each before the ones below it. A root may be a body (a tuple of nodes)."""
    stack: list[object] = [node for root in reversed(roots) for node in reversed(_nodes(root))]
    parts_of = PARTS
    while stack:
        node = stack.pop()
        yield node
        taken = parts_of[node.__class__]
        if taken is _no_parts:
            continue
        if node.__class__ is Aggregate:  # most of what there is in a list of points
            stack += [value for _, value in reversed(node.entries)]
            continue
        # The same as `children`, in place: every pass goes through here for every node.
        below: list[object] = []
        for part in taken(node):
            kind = part.__class__
            if kind in _NODES:
                below.append(part)
            elif kind not in _PLAIN and part is not _EMPTY:
                _collect(part, below)
        if below:
            below.reverse()
            stack += below


def expressions(*roots: object) -> Iterator[Expression]:
    """Every expression of the trees, outer ones first."""
    return (cast(Expression, node) for node in walk(*roots) if node.__class__ in _EXPRESSIONS)


def statements(*roots: object) -> Iterator[Statement]:
    """Every statement of the trees, outer ones first; the actions of triggers and interrupts are statements too.

    An expression holds none and is not entered."""
    stack = [node for root in reversed(roots) for node in reversed(_nodes(root))]
    while stack:
        node = stack.pop()
        if node.__class__ in _STATEMENTS:
            yield cast(Statement, node)
        if node.__class__ not in _EXPRESSIONS:
            stack.extend(reversed(children(node)))


def is_expression(node: object) -> TypeGuard[Expression]:
    return node.__class__ in _EXPRESSIONS


def is_statement(node: object) -> TypeGuard[Statement]:
    return node.__class__ in _STATEMENTS


def bodies(routine: Routine) -> list[Body]:
    """All bodies of a routine: its own, its handlers, undo, backward. What a routine does is in all of them."""
    return [routine.body, *(handler.body for handler in routine.handlers), routine.undo, routine.backward]


def rewrite(node: Node, change: Callable[[object], object]) -> Node:
    """The tree rebuilt from below: `change` is given each node with its parts already rewritten and returns the node to
    put there (the same object to leave it). A statement in a body may be replaced by a tuple of statements."""
    return cast(Node, _rewritten(node, change))


def map_children(node: Node, change: Callable[[object], object]) -> Node:
    """The node with each node directly below it replaced; the depth is the caller's affair."""
    changes: dict[str, object] = {}
    kind = node.__class__
    for name, old in zip(PART_FIELDS[kind], PARTS[kind](node), strict=True):
        if old.__class__ in _PLAIN:
            continue
        new = _mapped(old, change)
        if new is not old:
            changes[name] = new
    return dataclasses.replace(node, **changes) if changes else node  # type: ignore[type-var]  # nodes are dataclasses


def _rewritten(node: object, change: Callable[[object], object]) -> object:
    return change(map_children(node, lambda child: _rewritten(child, change)))


def _mapped(part: object, change: Callable[[object], object]) -> object:
    if isinstance(part, tuple):
        done: list[object] = []
        for item in part:
            new = item if item.__class__ in _PLAIN else _mapped(item, change)
            if new is not item and isinstance(new, tuple) and not isinstance(item, tuple):
                done += new  # a statement that became several
            else:
                done.append(new)
        return part if len(done) == len(part) and all(map(is_, done, part)) else tuple(done)
    if _is_node(part):
        return change(part)
    return part

"""Going through a tree of the IR and rebuilding it, for any node, by its own fields.

Passes name only the nodes they change; the rest is carried along here. A rebuilt node keeps its origin, and a part that
did not change stays the same object, so that comparing by identity tells whether anything happened.
"""

from __future__ import annotations

import dataclasses
from collections.abc import Callable, Iterable, Iterator
from typing import TypeGuard, TypeVar, cast, get_args

from rpl.ir.expressions import Expression
from rpl.ir.statements import Statement
from rpl.source import Origin

Node = TypeVar("Node")

_EXPRESSIONS = frozenset(get_args(Expression))
_STATEMENTS = frozenset(get_args(Statement))


_FIELDS: dict[type, tuple[str, ...]] = {}


def _fields(kind: type) -> tuple[str, ...]:
    """The fields of a node class that can hold parts; remembered, because this is asked for every node."""
    known = _FIELDS.get(kind)
    if known is None:
        node = dataclasses.is_dataclass(kind) and not issubclass(kind, Origin)
        known = tuple(f.name for f in dataclasses.fields(kind) if f.name != "origin") if node else ()
        _FIELDS[kind] = known
    return known


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
    for name in _FIELDS.get(node.__class__) or _fields(node.__class__):
        part = getattr(node, name)
        kind = part.__class__
        if kind in _NODES:
            found.append(part)
        elif kind not in _PLAIN:
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
    while stack:
        node = stack.pop()
        yield node
        below = children(node)
        if below:
            below.reverse()
            stack += below


def expressions(*roots: object) -> Iterator[Expression]:
    """Every expression of the trees, outer ones first."""
    return (cast(Expression, node) for node in walk(*roots) if node.__class__ in _EXPRESSIONS)


def statements(*roots: object) -> Iterator[Statement]:
    """Every statement of the trees, outer ones first; the actions of triggers and interrupts are statements too."""
    return (cast(Statement, node) for node in walk(*roots) if node.__class__ in _STATEMENTS)


def is_expression(node: object) -> TypeGuard[Expression]:
    return node.__class__ in _EXPRESSIONS


def is_statement(node: object) -> TypeGuard[Statement]:
    return node.__class__ in _STATEMENTS


def rewrite(node: Node, change: Callable[[object], object]) -> Node:
    """The tree rebuilt from below: `change` is given each node with its parts already rewritten and returns the node to
    put there (the same object to leave it). A statement in a body may be replaced by a tuple of statements."""
    return cast(Node, _rewritten(node, change))


def map_children(node: Node, change: Callable[[object], object]) -> Node:
    """The node with each node directly below it replaced; the depth is the caller's affair."""
    changes: dict[str, object] = {}
    for name in _fields(node.__class__):
        old = getattr(node, name)
        new = _mapped(old, change)
        if new is not old:
            changes[name] = new
    return dataclasses.replace(node, **changes) if changes else node  # type: ignore[type-var]  # nodes are dataclasses


def _rewritten(node: object, change: Callable[[object], object]) -> object:
    return change(map_children(node, lambda child: _rewritten(child, change)))


def _mapped(part: object, change: Callable[[object], object]) -> object:
    if isinstance(part, tuple):
        done = list(_items(part, change))
        same = len(done) == len(part) and all(new is old for new, old in zip(done, part, strict=True))
        return part if same else tuple(done)
    if _is_node(part):
        return change(part)
    return part


def _items(part: Iterable[object], change: Callable[[object], object]) -> Iterator[object]:
    for item in part:
        new = _mapped(item, change)
        if isinstance(new, tuple) and not isinstance(item, tuple):
            yield from new
        else:
            yield new

"""Rebuilding a node from rewritten parts, by the node's own fields, keeping its origin.

A node whose parts all stay the same objects is given back itself: most of a program does not change in a pass.
"""

from __future__ import annotations

import dataclasses
from collections.abc import Callable, Hashable, Mapping
from functools import cache
from operator import attrgetter, is_
from typing import Any, TypeVar, cast, get_args

from rpl import ir

Node = TypeVar("Node")
OnExpression = Callable[[ir.Expression], ir.Expression]
OnBody = Callable[[ir.Body], ir.Body]

_EXPRESSIONS = frozenset(get_args(ir.Expression))
_STATEMENTS = frozenset(get_args(ir.Statement))
_LEAVES = frozenset((str, int, float, bool, type(None)))
_NOTHING_GIVEN: Mapping[str, object] = {}


@cache
def _fields(node_class: Hashable) -> tuple[str, ...]:
    if not (isinstance(node_class, type) and dataclasses.is_dataclass(node_class)):
        return ()
    return tuple(field.name for field in dataclasses.fields(node_class) if field.name != "origin")


@cache
def _getter(node_class: Hashable) -> Callable[[object], tuple[object, ...]]:
    names = _fields(node_class)
    if len(names) > 1:
        return attrgetter(*names)
    return lambda node: tuple([getattr(node, name) for name in names])


def rewrite_parts(
    node: Node,
    on_expression: OnExpression,
    on_body: OnBody | None = None,
    given: Mapping[str, object] = _NOTHING_GIVEN,
) -> Node:
    """The node with each direct expression replaced by `on_expression` and each body by `on_body` (bodies stay as they
    are without it). Parts that are neither (speeds, blends, cases, arguments) are entered. `given`: fields that are
    rewritten already, by name."""
    kind = cast(Hashable, node.__class__)
    names = _fields(kind)
    values = list(_getter(kind)(node))
    same = True
    for at, old in enumerate(values):
        if old.__class__ in _LEAVES:
            continue
        new = given[names[at]] if names[at] in given else _part(old, on_expression, on_body)
        if new is not old:
            values[at] = new
            same = False
    if same:
        return node
    parts: dict[str, Any] = dict(zip(names, values, strict=True))
    if hasattr(node, "origin"):
        parts["origin"] = node.origin
    return node.__class__(**parts)


def changed(node: Node, **parts: object) -> Node:
    """The node with these parts; the node itself where it has them already."""
    for name, part in parts.items():
        if getattr(node, name) is not part:
            return dataclasses.replace(node, **parts)  # type: ignore[type-var]  # nodes are dataclasses
    return node


def each(items: tuple[Node, ...], on_item: Callable[[Node], Node]) -> tuple[Node, ...]:
    """The items rewritten; the same tuple where none changes."""
    done = tuple([on_item(item) for item in items])
    return items if all(map(is_, done, items)) else done


def _part(part: object, on_expression: OnExpression, on_body: OnBody | None) -> object:
    kind = part.__class__
    if kind in _LEAVES:
        return part
    if kind in _EXPRESSIONS:
        return on_expression(cast(ir.Expression, part))
    if kind is tuple:
        items = cast(tuple[object, ...], part)
        if not items:
            return part
        if on_body is not None and all(item.__class__ in _STATEMENTS for item in items):
            return on_body(cast(ir.Body, items))
        return each(items, lambda item: _part(item, on_expression, on_body))
    if kind in _STATEMENTS:
        if on_body is not None:
            one = on_body((cast(ir.Statement, part),))
            return one[0] if len(one) == 1 else part
        return part
    if _fields(cast(Hashable, kind)):
        return rewrite_parts(part, on_expression, on_body)
    return part

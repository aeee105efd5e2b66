"""Rebuilding a node from rewritten parts, by the node's own fields, keeping its origin."""

from __future__ import annotations

import dataclasses
from collections.abc import Callable, Hashable
from functools import cache
from typing import TypeVar, cast, get_args

from rpl import ir

Node = TypeVar("Node")
OnExpression = Callable[[ir.Expression], ir.Expression]
OnBody = Callable[[ir.Body], ir.Body]

_EXPRESSIONS = frozenset(get_args(ir.Expression))
_STATEMENTS = frozenset(get_args(ir.Statement))
_LEAVES = frozenset((str, int, float, bool, type(None)))


@cache
def _fields(node_class: Hashable) -> tuple[str, ...]:
    if not (isinstance(node_class, type) and dataclasses.is_dataclass(node_class)):
        return ()
    return tuple(field.name for field in dataclasses.fields(node_class) if field.name != "origin")


def rewrite_parts(node: Node, on_expression: OnExpression, on_body: OnBody | None = None) -> Node:
    """The node with each direct expression replaced by `on_expression` and each body by `on_body` (bodies stay as they
    are without it). Parts that are neither (speeds, blends, cases, arguments) are entered."""
    changes = {}
    for name in _fields(cast(Hashable, node.__class__)):
        old = getattr(node, name)
        if old.__class__ in _LEAVES:
            continue
        new = _part(old, on_expression, on_body)
        if new is not old:
            changes[name] = new
    if not changes:
        return node
    return dataclasses.replace(node, **changes)  # type: ignore[type-var]


def _part(part: object, on_expression: OnExpression, on_body: OnBody | None) -> object:
    kind = part.__class__
    if kind in _LEAVES:
        return part
    if kind in _EXPRESSIONS:
        return on_expression(cast(ir.Expression, part))
    if kind is tuple:
        items = cast(tuple[object, ...], part)
        if on_body is not None and items and all(item.__class__ in _STATEMENTS for item in items):
            return on_body(cast(ir.Body, items))
        done = tuple(_part(item, on_expression, on_body) for item in items)
        return done if any(new is not old for new, old in zip(done, items, strict=True)) else part
    if kind in _STATEMENTS:
        if on_body is not None:
            one = on_body((cast(ir.Statement, part),))
            return one[0] if len(one) == 1 else part
        return part
    if _fields(cast(Hashable, kind)):
        return rewrite_parts(part, on_expression, on_body)
    return part

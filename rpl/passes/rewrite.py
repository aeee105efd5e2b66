"""Rebuilding a node from rewritten parts, by the node's own fields, keeping its origin.

A node whose parts all stay the same objects is given back itself: most of a program does not change in a pass.
"""

from __future__ import annotations

import dataclasses
from collections.abc import Callable, Mapping, Sequence
from operator import attrgetter, is_
from typing import Any, TypeVar, cast, get_args

from rpl import ir
from rpl.ir.walk import PART_FIELDS, PARTS

Node = TypeVar("Node")
OnExpression = Callable[[ir.Expression], ir.Expression]
OnBody = Callable[[ir.Body], ir.Body]

_EXPRESSIONS = frozenset(get_args(ir.Expression))
_STATEMENTS = frozenset(get_args(ir.Statement))
_LEAVES = frozenset((str, int, float, bool, type(None)))
# The statements that hold no others: as blocks, as parts, as actions.
_SIMPLE = _STATEMENTS - frozenset(
    (
        *(ir.If, ir.Switch, ir.For, ir.While, ir.Repeat, ir.Loop, ir.Spline, ir.Rows, ir.Run, ir.Instruction),
        *(ir.Move, ir.Trigger, ir.DefineTrigger, ir.DeclareInterrupt),
    )
)
_EMPTY: tuple[object, ...] = ()
_NOTHING_GIVEN: Mapping[str, object] = {}


class _Rebuilding(dict[type, tuple[tuple[str, ...], Callable[[object], tuple[Any, ...]]]]):
    """All fields of a node class, and what takes their values; `dataclasses.replace` looks them up each time."""

    def __missing__(self, kind: type) -> tuple[tuple[str, ...], Callable[[object], tuple[Any, ...]]]:
        names = tuple(field.name for field in dataclasses.fields(kind))
        one = attrgetter(*names)
        self[kind] = found = (names, one if len(names) > 1 else lambda node: (one(node),))
        return found


_REBUILDING = _Rebuilding()


def rewrite_parts(
    node: Node,
    on_expression: OnExpression,
    on_body: OnBody | None = None,
    given: Mapping[str, object] = _NOTHING_GIVEN,
) -> Node:
    """The node with each direct expression replaced by `on_expression` and each body by `on_body` (bodies stay as they
    are without it). Parts that are neither (speeds, blends, cases, arguments) are entered. `given`: fields that are
    rewritten already, by name."""
    kind = node.__class__
    if isinstance(node, ir.Aggregate) and not given:
        return cast(Node, _aggregate(node, on_expression))
    changes: dict[str, object] | None = None
    for at, old in enumerate(PARTS[kind](node)):
        if old.__class__ in _LEAVES or old is _EMPTY:
            continue
        name = PART_FIELDS[kind][at] if given else ""
        new = given[name] if name in given else _part(old, on_expression, on_body)
        if new is not old:
            if changes is None:
                changes = {}
            changes[PART_FIELDS[kind][at]] = new
    return node if changes is None else _rebuilt(node, changes)


def _rebuilt(node: Node, changes: Mapping[str, object]) -> Node:
    """The node with other parts; `dataclasses.replace` takes twice as long."""
    kind = node.__class__
    names, values = _REBUILDING[kind]
    parts: dict[str, Any] = dict(zip(names, values(node), strict=True))
    parts.update(changes)
    return kind(**parts)


def _aggregate(node: ir.Aggregate, on_expression: OnExpression) -> ir.Aggregate:
    """As any other node; most of what there is in a list of points."""
    old = [value for _, value in node.entries]
    new = [on_expression(value) for value in old]
    if all(map(is_, new, old)):
        return node
    entries = tuple([(entry[0], value) for entry, value in zip(node.entries, new, strict=True)])
    return ir.Aggregate(entries, node.type_name, origin=node.origin)


def visit_parts(
    node: object, on_expression: Callable[[ir.Expression], object], on_body: Callable[[ir.Body], object] | None = None
) -> None:
    """Show the same parts as `rewrite_parts` in the same order, and rebuild nothing."""
    if node.__class__ is ir.Aggregate:
        for _, value in node.entries:
            on_expression(value)
        return
    for part in PARTS[node.__class__](node):
        if part.__class__ not in _LEAVES and part is not _EMPTY:
            _visit(part, on_expression, on_body)


def rewrite_bodies(statement: Node, on_body: OnBody) -> Node:
    """The statement with each body directly in it replaced; an action is a body of one step. Expressions stay."""
    return statement if statement.__class__ in _SIMPLE else rewrite_parts(statement, _as_it_is, on_body)


def visit_bodies(statement: object, on_body: Callable[[ir.Body], object]) -> None:
    """Show the same bodies as `rewrite_bodies` in the same order, and rebuild nothing."""
    if statement.__class__ not in _SIMPLE:
        visit_parts(statement, _as_it_is, on_body)


def _as_it_is(expression: ir.Expression) -> ir.Expression:
    return expression


def _visit(
    part: object, on_expression: Callable[[ir.Expression], object], on_body: Callable[[ir.Body], object] | None
) -> None:
    kind = part.__class__
    if kind in _LEAVES:
        return
    if kind in _EXPRESSIONS:
        on_expression(cast(ir.Expression, part))
    elif kind is tuple:
        items = cast(tuple[object, ...], part)
        if items and on_body is not None and _STATEMENTS.issuperset(map(type, items)):
            on_body(cast(ir.Body, items))
            return
        for item in items:
            _visit(item, on_expression, on_body)
    elif kind in _STATEMENTS:
        if on_body is not None:
            on_body((cast(ir.Statement, part),))
    else:
        for inner in PARTS[kind](part):
            _visit(inner, on_expression, on_body)


def changed(node: Node, **parts: object) -> Node:
    """The node with these parts; the node itself where it has them already, or tuples of the same objects."""
    for name, part in parts.items():
        if not _is(getattr(node, name), part):
            return _rebuilt(node, parts)
    return node


def _is(old: object, new: object) -> bool:
    if old is new:
        return True
    return isinstance(old, tuple) and isinstance(new, tuple) and same(old, new)


def same(old: Sequence[object], new: Sequence[object]) -> bool:
    """Are these the same objects?"""
    return len(old) == len(new) and all(map(is_, old, new))


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
        if on_body is not None and _STATEMENTS.issuperset(map(type, items)):
            return on_body(cast(ir.Body, items))
        done = tuple([_part(item, on_expression, on_body) for item in items])
        return items if all(map(is_, done, items)) else done
    if kind in _STATEMENTS:
        if on_body is not None:
            one = on_body((cast(ir.Statement, part),))
            return one[0] if len(one) == 1 else part
        return part
    if PART_FIELDS[kind]:
        return rewrite_parts(part, on_expression, on_body)
    return part

"""Frames that hang on other frames: `FRAME part = {...} ON table`.

The variable keeps its offset, and its components are those of the offset; wherever the frame itself is used, it stands
for `table : part`. So it follows when the table moves.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import TypeVar, cast

from rpl import ir
from rpl.ir.walk import map_children

Affixment = tuple[str, ir.Expression]
Node = TypeVar("Node")


def affix(module: ir.Module, affixed: Sequence[Affixment]) -> ir.Module:
    """The module with every use of a hanging frame put together with what it hangs on."""
    frames: dict[str, ir.Expression] = {}
    for name, base in affixed:
        frames[name.lower()] = _used(base, frames)
    if not frames:
        return module
    declared = tuple(_used(declaration, frames) for declaration in module.declarations)
    routines = tuple(_in_routine(routine, frames) for routine in module.routines)
    return replace(module, declarations=declared, routines=routines)


def _in_routine(routine: ir.Routine, frames: dict[str, ir.Expression]) -> ir.Routine:
    own = {parameter.name.lower() for parameter in routine.parameters}
    own |= {item.name.lower() for item in routine.declarations if isinstance(item, ir.Variable)}
    visible = {name: base for name, base in frames.items() if name not in own}
    return _used(routine, visible) if visible else routine


def _used(node: Node, frames: dict[str, ir.Expression]) -> Node:
    return cast(Node, _replaced(node, frames))


def _replaced(node: object, frames: dict[str, ir.Expression]) -> object:
    match node:
        case ir.Name(id=name) if name.lower() in frames:
            return ir.Binary(":", frames[name.lower()], node, origin=node.origin)
        case ir.Field(base=ir.Name()):
            return node
        case ir.Assign(target=target, value=value):
            # Assigning sets the offset itself; only indices on the left are uses.
            return replace(node, target=_place(target, frames), value=_used(value, frames))
    return map_children(node, lambda child: _replaced(child, frames))


def _place(target: ir.Expression, frames: dict[str, ir.Expression]) -> ir.Expression:
    match target:
        case ir.Name():
            return target
        case ir.Field(base=base) | ir.Index(base=base):
            inner = replace(target, base=ir.Name(""))
            return replace(_used(inner, frames), base=_place(base, frames))
    return _used(target, frames)

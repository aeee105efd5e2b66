"""Copies of whole arrays element by element, for what cannot be copied as a whole (a row of a larger array)."""

from __future__ import annotations

from itertools import product

from rpl import ir
from rpl.source import NOWHERE, Origin

_MOST = 64  # elements; more are left as a whole


def array_copy(
    target: ir.Expression, value: ir.Expression, type: ir.Type, bases: tuple[int, int], origin: Origin = NOWHERE
) -> tuple[ir.Assign, ...]:
    """The assignments that copy an array of that type; one of the whole where its size is not known or too large.
    `bases`: where the indices of the target and the value begin. A row of a larger array has some indices already."""
    whole = (ir.Assign(target, value, origin=origin),)
    if isinstance(type, ir.ArrayType) and isinstance(value, ir.Aggregate) and isinstance(target, ir.Index):
        if len(type.dimensions) > 1 or any(name is not None for name, _ in value.entries):
            return whole
        parts = enumerate(one for _, one in value.entries)
        return tuple(ir.Assign(_element(target, (at,), bases[0]), one, origin=origin) for at, one in parts)
    if not isinstance(type, ir.ArrayType) or not isinstance(value, ir.Name | ir.Index):
        return whole
    bounds = [one.value for one in type.dimensions if isinstance(one, ir.IntLiteral)]
    counts = [bound - type.base + 1 for bound in bounds]
    size = 1
    for count in counts:
        size *= count
    if len(counts) < len(type.dimensions) or not 0 < size <= _MOST:
        return whole
    return tuple(
        ir.Assign(_element(target, places, bases[0]), _element(value, places, bases[1]), origin=origin)
        for places in product(*map(range, counts))
    )


def _element(array: ir.Expression, places: tuple[int, ...], base: int) -> ir.Index:
    indices = tuple(ir.IntLiteral(base + place) for place in places)
    if isinstance(array, ir.Index):
        return ir.Index(array.base, (*array.indices, *indices))
    return ir.Index(array, indices)


__all__ = ["array_copy"]

"""Settings that KRL writes as one: a whole structure ($VEL, $ACC, $APO), the axes of a spline move."""

from __future__ import annotations

from collections.abc import Sequence

from rpl import ir

from . import tables

Pair = tuple[ir.Expression, ir.Expression]
_AXES = 6


def whole_structure(pairs: Sequence[Pair]) -> tuple[str, ir.Expression] | None:
    """The structure and its value when the first pairs set all its components from the components of one value."""
    for name, parts in tables.STRUCTURES.items():
        values = [
            _component(pair, component, neutral) for pair, (component, neutral) in zip(pairs, parts, strict=False)
        ]
        first = values[0] if len(values) == len(parts) else None
        if first is not None and all(value == first for value in values):
            return name, first
    return None


def _component(pair: Pair, component: str, neutral: str) -> ir.Expression | None:
    target, value = pair
    if isinstance(value, ir.Quantity):
        value = value.value
    if not (isinstance(target, ir.System) and target.name == neutral and isinstance(value, ir.Field)):
        return None
    return value.base if value.name.upper() == component and isinstance(value.base, ir.Call) else None


def all_axes(pairs: Sequence[Pair]) -> bool:
    """Do the first pairs set one axis variable to one value for every axis, in order?"""
    if len(pairs) < _AXES:
        return False
    target, value = pairs[0]
    if not isinstance(target, ir.System) or target.name not in ("joint_speed", "joint_acceleration"):
        return False
    wanted = [(ir.System(target.name, (ir.IntLiteral(n),)), value) for n in range(1, _AXES + 1)]
    return list(pairs[:_AXES]) == wanted


def grouped(pairs: Sequence[Pair]) -> list[tuple[str, ir.Expression] | Pair]:
    """Settings of a spline move, with structures and axes that belong together as one (their name and value)."""
    done: list[tuple[str, ir.Expression] | Pair] = []
    at = 0
    while at < len(pairs):
        rest = pairs[at:]
        whole = whole_structure(rest)
        if whole is not None:
            done.append(whole)
            at += len(tables.STRUCTURES[whole[0]])
        else:
            done.append(pairs[at])
            at += _AXES if all_axes(rest) else 1
    return done

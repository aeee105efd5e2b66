"""Joint values that are written out: their axes as numbers, and the same value with other axes."""

from __future__ import annotations

from dataclasses import replace

from rpl import ir
from rpl.passes.values import Record, component

AXES = tuple(ir.COMPONENTS[ir.AxesType])


def with_joints(
    expression: ir.Aggregate, new: dict[str, ir.Expression], given: dict[str, ir.Expression]
) -> ir.Aggregate:
    """The aggregate, nested or not, with new joint values."""
    if "robax" in given:
        axes = ir.Aggregate(tuple(new.items()), type_name="axes", origin=given["robax"].origin)
        rest = tuple((name, value) for name, value in given.items() if name != "robax")
        return replace(expression, entries=(("robax", axes), *rest))
    rest = tuple((name, value) for name, value in given.items() if name not in AXES)
    return replace(expression, entries=(*new.items(), *rest))


def joint_values(value: Record) -> list[float] | None:
    """The axes of joint values, nested or not, as far as all of them that are given are numbers."""
    axes = value.part("robax")
    source = axes if isinstance(axes, Record) else value
    values = [component(source, name) for name in AXES]
    found = [float(one) for one in values if isinstance(one, int | float)]
    return found if len(found) == len(values) else None

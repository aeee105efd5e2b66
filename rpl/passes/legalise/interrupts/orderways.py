"""An interrupt variable that is ordered in several ways (once and again and again, by two times, for two signals)
becomes one variable for each way, for targets where a number has one declaration. What switches the variable off does
so with all of them; where it is switched on again without a new order nobody knows which was meant, so it stays.
"""

from __future__ import annotations

from dataclasses import replace

from rpl import ir
from rpl.ir.walk import rewrite, walk
from rpl.passes.legalise.context import Context

Way = tuple[str, ir.Expression | None, ir.Expression | None, bool]


def one_way_each(program: ir.Program, context: Context) -> ir.Program:
    """The program in which each interrupt variable is ordered in one way."""
    ways = _ways(program)
    names: dict[str, list[str]] = {
        handle: [handle, *(context.fresh(f"{handle}_{number}") for number in range(2, len(found) + 1))]
        for handle, found in ways.items()
    }
    if not names:
        return program

    def each(node: object) -> object:
        match node:
            case ir.OrderInterrupt(handle=ir.Name(id=name)) if name.lower() in names:
                way = ways[name.lower()].index(_way(node))
                return replace(node, handle=ir.Name(names[name.lower()][way]))
            case ir.ConnectInterrupt(handle=ir.Name(id=name)) | ir.ControlInterrupt(handle=ir.Name(id=name)) if (
                name.lower() in names
            ):
                later = replace(node.origin, comments=())
                return tuple(
                    replace(node, handle=ir.Name(one), origin=later if place else node.origin)
                    for place, one in enumerate(names[name.lower()])
                )
        return node

    return rewrite(program, each)


def _way(order: ir.OrderInterrupt) -> Way:
    return order.event, order.condition, order.time, order.once


def _ways(program: ir.Program) -> dict[str, list[Way]]:
    """The ways of each variable that has several, and is used for nothing but interrupts."""
    found: dict[str, list[Way]] = {}
    used: dict[str, int] = {}
    handled: dict[str, int] = {}
    kept: set[str] = set()
    for node in walk(*program.modules):
        match node:
            case ir.Name(id=name):
                used[name.lower()] = used.get(name.lower(), 0) + 1
            case ir.OrderInterrupt() | ir.ConnectInterrupt() | ir.ControlInterrupt() if isinstance(
                node.handle, ir.Name
            ):
                name = node.handle.id.lower()
                handled[name] = handled.get(name, 0) + 1
                if isinstance(node, ir.ControlInterrupt) and node.op == "on":
                    kept.add(name)
                if isinstance(node, ir.OrderInterrupt) and _way(node) not in found.setdefault(name, []):
                    found[name].append(_way(node))
    return {
        name: ways
        for name, ways in found.items()
        if len(ways) > 1 and name not in kept and used.get(name) == handled.get(name)
    }

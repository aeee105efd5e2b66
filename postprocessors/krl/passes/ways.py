"""Registers that only move other places (INFORM `SFTON P010`, TP `Offset,PR[11]`) as frames.

A controller with numbered registers keeps such a way in a position register, which KRL would call E6POS. There it is a
`FRAME`, which stands in a product as it is: `LIN Place_offset:XCorner`, `$BASE=BASE_DATA[2]:Place_offset`.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator
from dataclasses import replace

from rpl import ir
from rpl.ir.walk import rewrite, walk
from rpl.passes.legalise.context import Context
from rpl.passes.legalise.facts.usage import base_name, usage_of
from rpl.passes.legalise.kinds import walk_for
from rpl.passes.legalise.stages import legalising

__all__ = ["ways_as_frames"]

_WAY = ("x", "y", "z")


@legalising(sees=("Move",))
def ways_as_frames(program: ir.Program, context: Context) -> ir.Program:
    """Variables of places that nothing uses but by their components, as poses, or to be set to such."""
    ways = _ways(program)
    if not ways:
        return program
    straight = ways - _turning(program)

    def changed(node: object) -> object:
        match node:
            case ir.Variable(name=name, initial=initial) if name.lower() in ways:
                return replace(node, type=ir.PoseType(), initial=_pose(initial))
            case ir.Builtin(function="pose_of", arguments=(ir.Name(id=name) as way,)) if name.lower() in ways:
                return replace(way, origin=node.origin)
            case ir.Assign(target=ir.Name(id=name), value=value) if name.lower() in ways:
                return replace(node, value=_pose(value) or value)
            case ir.Move(target=target, relative=None):
                return replace(node, target=_moved(target, node.kind, straight))
        return node

    modules = tuple(rewrite(module, changed) for module in program.modules)
    return replace(program, modules=modules)


def _moved(target: ir.Expression, kind: str, straight: frozenset[str]) -> ir.Expression:
    """A place moved along x, y and z by the components of one way that turns nothing: the way in front of it. A product
    has no arm configuration, so a joint move goes to it only where it asks for none."""
    match target:
        case ir.Builtin(function="pose_of", arguments=(inner,)):
            found = _moved(inner, "", straight)
            return target if found is inner else found
        case ir.Builtin(function="tool_offset", arguments=(inner, *along)):  # the way along the tool stands behind both
            found = _moved(inner, kind, straight)
            return target if found is inner else replace(target, arguments=(found, *along))
        case ir.Builtin(function="offset", arguments=(ir.Name() as base, *parts)) if kind != "joint":
            match parts:
                case [ir.Field(base=ir.Name(id=x) as way), ir.Field(base=ir.Name(id=y)), ir.Field(base=ir.Name(id=z))]:
                    names = tuple(one.name for one in parts if isinstance(one, ir.Field))
                    if names == _WAY and x == y == z and x.lower() in straight:
                        return ir.Binary(":", way, base, origin=target.origin)
    return target


def _pose(value: ir.Expression | None) -> ir.Expression | None:
    match value:
        case ir.Aggregate():
            return replace(value, type_name="pose")
        case ir.Builtin(function="element_difference"):
            return ir.Aggregate(tuple((part, ir.RealLiteral(0.0)) for part in ir.POSE), "pose", origin=value.origin)
    return value


def _ways(program: ir.Program) -> frozenset[str]:
    """Folded names that stand for one variable each, and all of whose uses are those of a frame."""
    seen, fitting, declared = Counter[str](), Counter[str](), Counter[str]()
    places, moving = set[str](), set[str]()
    for node in walk_for({"Name", "Variable", "Parameter", "Field", "Builtin", "Assign"}, *program.modules):
        match node:
            case ir.Variable(name=name, type=type, initial=initial):
                declared[name.lower()] += 1
                if isinstance(type, ir.TargetType) and (initial is None or _is_pose(initial)):
                    places.add(name.lower())
            case ir.Parameter(name=name):
                declared[name.lower()] += 1
            case ir.Name(id=name):
                seen[name.lower()] += 1
            case ir.Builtin(function="pose_of" | "offset", arguments=arguments):
                moving.update(base_name(one) or "" for one in arguments)
        fitting.update(_fitting(node))
    known = usage_of(program)
    return frozenset(
        one
        for one in places & moving
        if declared[one] == 1 and seen[one] == fitting[one] and one not in known.otherwise
    )


def _fitting(node: object) -> Iterator[str]:
    """The variable whose use as a frame this is."""
    match node:
        case ir.Field(base=ir.Name(id=name), name=part) if part in ir.POSE:
            yield name.lower()
        case ir.Builtin(function="pose_of", arguments=(ir.Name(id=name),)):
            yield name.lower()
        case ir.Assign(target=ir.Name(id=name), value=value) if _is_pose(value):
            yield name.lower()
        case ir.Assign(target=ir.Name(id=name), value=value) if _is_nowhere(value):
            yield from (one.id.lower() for one in walk(node) if isinstance(one, ir.Name))


def _is_pose(value: ir.Expression) -> bool:
    return isinstance(value, ir.Aggregate) and {name for name, _ in value.entries} == set(ir.POSE)


def _is_nowhere(value: ir.Expression) -> bool:
    """Is this a place less itself (INFORM `SUB P010 P010`, TP `PR[11]=LPOS-LPOS`)?"""
    match value:
        case ir.Builtin(function="element_difference", arguments=(one, other)):
            return one == other and not any(isinstance(node, ir.Call) for node in walk(one))
    return False


def _turning(program: ir.Program) -> frozenset[str]:
    """Folded names of variables that may turn what they move."""
    found: set[str] = set()
    for node in walk_for({"Assign", "Variable"}, *program.modules):
        match node:
            case ir.Assign(target=ir.Field(base=ir.Name(id=name), name=part)) if part in ir.ANGLES:
                found.add(name.lower())
            case ir.Assign(target=ir.Name(id=name), value=value) | ir.Variable(name=name, initial=value):
                if value is not None and not _turns_nothing(value):
                    found.add(name.lower())
    return frozenset(found)


def _turns_nothing(value: ir.Expression) -> bool:
    if _is_nowhere(value):
        return True
    angles = [one for name, one in value.entries if name in ir.ANGLES] if isinstance(value, ir.Aggregate) else [value]
    return all(isinstance(one, ir.IntLiteral | ir.RealLiteral) and one.value == 0 for one in angles)

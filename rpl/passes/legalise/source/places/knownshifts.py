"""Moves that are shifted by a way in a variable, where the variable surely holds a way that can be said plainly.

A controller that shifts all positions from one instruction on (INFORM SFTON) keeps the shift in a variable: `shift =
frame : way : inverse(frame)`, and each move goes in `shift : frame`. That is `frame : way`, a product that people write
where places have products. Where they have none and the way turns nothing, it is the point offset by x, y and z of the
way (RAPID Offs), or by the way itself (TP `Offset,PR[n]`, which adds components; elsewhere that is an offset too).
A register that nothing sets is its numbers (TP `Tool_Offset,PR[n]` is RelTool by them).
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace

from rpl import ir
from rpl.ir.walk import rewrite, walk
from rpl.passes.capabilities import PlaceRule, Places
from rpl.passes.legalise.context import Context, rules_of
from rpl.passes.legalise.facts.inforce import InForce
from rpl.passes.legalise.facts.usage import usage_of
from rpl.passes.legalise.facts.values.taughtvalues import WRITTEN
from rpl.passes.legalise.kinds import walk_for
from rpl.passes.legalise.rewriting.unreaddata import without_unread
from rpl.passes.legalise.stages import legalising
from rpl.source import Origin

__all__ = ["known_shifts"]

_SEEN = ("function inverse", "function element_sum", "function displaced_in_tool")
_PARTS = ("x", "y", "z")
NUMBERS = "the way of these moves along the tool or the frame"
_NOWHERE = ir.System("null_frame")
# Folded name of a variable -> the shift that it holds; a name as _straight makes it: a place that turns nothing.
State = Mapping[str, ir.Expression]
_KNOWN_OF_NONE: State = {}


@legalising(unless=lambda context: not context.foreign, sees=_SEEN)
def known_shifts(program: ir.Program, context: Context) -> ir.Program:
    """Not in the program's own language, which has an instruction for it. Only shifts that the reader keeps for the
    controller are looked at: they begin as none. One that nothing reads any more goes."""
    shifts = _shifts(program) & {name.lower() for name in rules_of(context.source).settings_data}
    straight = any(
        isinstance(node, ir.Assign) and _turns_nothing(node.value) for node in walk_for({"Assign"}, *program.modules)
    )
    if not shifts and not straight and not _constant_ways(program):
        return program
    moves = _Moves(program, shifts, context.capabilities.places)
    if not moves.found:
        return program

    def moved(node: object) -> object:
        return moves.found.get(id(node), node) if isinstance(node, ir.Move) else node

    modules = tuple(
        replace(module, routines=tuple(rewrite(routine, moved) for routine in module.routines))
        for module in program.modules
    )
    for name, origin in moves.written.values():
        context.diagnostics.report(WRITTEN, origin, what=NUMBERS, names=name)
    return without_unread(replace(program, modules=modules), shifts | moves.written.keys())


@dataclass(frozen=True, slots=True)
class _Shift:
    """`frame : way : inverse(frame)`; frame None: along the base."""

    frame: ir.Expression | None
    way: ir.Name


def _shift(value: ir.Expression) -> _Shift | None:
    match value:
        case ir.Builtin(function="pose_of", arguments=(ir.Name() as way,)):
            return _Shift(None, way)
        case ir.Binary(
            op=":",
            left=ir.Binary(op=":", left=frame, right=ir.Builtin(function="pose_of", arguments=(ir.Name() as way,))),
            right=ir.Builtin(function="inverse", arguments=(other,)),
        ) if frame == other:
            return _Shift(frame, way)
    return None


def _shifts(program: ir.Program) -> frozenset[str]:
    """Variables (folded names) that hold shifts and that nothing but assignments of them and of no shift changes."""
    usage = usage_of(program)
    found: dict[str, bool] = {}
    for node in walk_for({"Assign"}, *program.modules):
        if isinstance(node, ir.Assign) and isinstance(node.target, ir.Name):
            name, shift = node.target.id.lower(), _shift(node.value)
            known = shift is not None and not _names(shift.frame) & usage.assigned
            found[name] = found.get(name, True) and (known or node.value == _NOWHERE)
    declared = [one.name.lower() for one in _variables(program)]
    return frozenset(
        name for name, held in found.items() if held and name not in usage.otherwise and declared.count(name) == 1
    )


def _variables(program: ir.Program) -> list[ir.Variable]:
    return [node for node in walk_for({"Variable"}, *program.modules) if isinstance(node, ir.Variable)]


def _names(expression: ir.Expression | None) -> set[str]:
    return {node.id.lower() for node in walk(expression) if isinstance(node, ir.Name)} if expression else set()


class _Moves(InForce[ir.Expression]):
    """`found`: by identity, the moves that are said otherwise."""

    def __init__(self, program: ir.Program, shifts: frozenset[str], can: Places) -> None:
        super().__init__(program, dict.fromkeys(shifts, _NOWHERE))
        self.shifts, self.can = shifts, can
        self.constant = _constant_ways(program)
        self.written: dict[str, tuple[str, Origin]] = {}  # ways whose numbers stand in moves, and in the first of them
        self.met: dict[int, tuple[ir.Move, ir.Move | None]] = {}
        self.follow_program()
        self.found = {key: new for key, (_, new) in self.met.items() if new is not None}

    def assigned(self, name: str, target: ir.Expression, value: ir.Expression, before: State) -> State:
        kept = self.without(before, {name})
        match target:
            case ir.Name() if name in self.shifts:
                return {**kept, name: value}
            case ir.Field(base=ir.Name(), name=part) if part.lower() in _PARTS:
                turned = _straight(name)
                return {**kept, turned: before[turned]} if turned in before else kept
            case ir.Name() if _turns_nothing(value):
                return {**kept, _straight(name): _NOWHERE}
        return kept

    def known(self, name: str, place: ir.Expression) -> tuple[ir.Expression, ...] | None:
        """The numbers of a way that nothing sets, which are written where it was named."""
        way = self.constant.get(name.lower())
        if way is not None:
            self.written.setdefault(name.lower(), (name, place.origin))
        return way

    def shifted(self, place: ir.Expression, state: State) -> ir.Expression:
        """The place with the ways that are surely along the frame or the tool as numbers."""
        match place:
            case ir.Builtin(function="displaced_in_tool", arguments=(base, ir.Builtin("pose_of", (ir.Name(id=name),)))):
                way = self.known(name, place)
                moved = self.shifted(base, state)
                if way is not None:
                    return ir.Builtin("tool_offset", (moved, *way), origin=place.origin)
                return place if moved is base else replace(place, arguments=(moved, place.arguments[1]))
            case ir.Builtin(function="element_sum", arguments=(base, ir.Name(id=name) as way)):
                known = self.known(name, place)
                if known is not None:
                    return ir.Builtin("offset", (base, *known), origin=place.origin)
                if _straight(name.lower()) in state:
                    return ir.Builtin("offset", (base, *_parts(way)), origin=place.origin)
        return place

    def rests_on(self, value: ir.Expression) -> set[str]:
        return _names(value)

    def passed(self, call: ir.CallRoutine | ir.Call, state: State) -> State:
        return super().passed(call, state) if self.meant(call) else _KNOWN_OF_NONE

    def note(self, statement: ir.Statement, before: State) -> None:
        if not isinstance(statement, ir.Move):
            return
        new = self.said(statement, before)
        _, earlier = self.met.get(id(statement), (statement, new))
        self.met[id(statement)] = statement, new if new == earlier else None

    def said(self, move: ir.Move, state: State) -> ir.Move | None:
        plainly = move.via is None and move.relative is None
        if plainly and not self.can.move_functions & {"element_sum", "displaced"}:
            target = self.shifted(move.target, state)
            if target is not move.target:
                return replace(move, target=target)
        match move.frame:
            case ir.Name(id=name):
                frame: ir.Expression | None = None
            case ir.Binary(op=":", left=ir.Name(id=name), right=right):
                frame = right
            case _:
                return None
        held = state.get(name.lower()) if name.lower() in self.shifts else None
        if held is None or move.relative is not None:
            return None
        move = replace(move, frame=_NOWHERE if frame is None else frame)
        if held == _NOWHERE:
            return move
        shift = _shift(held)
        if shift is None or shift.frame != frame:
            return None
        summed = "element_sum" in self.can.move_functions
        if (summed or PlaceRule.QUATERNIONS in self.can.rules) and self.is_plain(move, state, shift.way):
            if summed:
                return replace(move, target=ir.Builtin("element_sum", (move.target, shift.way)))
            return self.along(move, move.target, shift.way)
        if summed:  # it knows no products of places
            return None
        pose = ir.Builtin("pose_of", (shift.way,))
        return replace(move, frame=pose if frame is None else ir.Binary(":", frame, pose))

    def is_plain(self, move: ir.Move, state: State, way: ir.Name) -> bool:
        """Does the way turn nothing, and is all of the move said by one target?"""
        return _straight(way.id.lower()) in state and move.via is None and move.relative is None

    def along(self, move: ir.Move, place: ir.Expression, way: ir.Name) -> ir.Move:
        return replace(move, target=ir.Builtin("offset", (place, *_parts(way))))


def _parts(way: ir.Name) -> tuple[ir.Expression, ...]:
    return tuple(ir.Field(way, part) for part in _PARTS)


def _constant_ways(program: ir.Program) -> dict[str, tuple[ir.Expression, ...]]:
    """Data (folded names) that nothing sets and that turns nothing: its x, y and z."""
    usage, found = usage_of(program), {}
    declared = [one.name.lower() for one in _variables(program)]
    for one in _variables(program):
        name = one.name.lower()
        if isinstance(one.initial, ir.Aggregate) and _turns_nothing(one.initial) and name not in usage.assigned:
            entries = dict(one.initial.entries)
            if declared.count(name) == 1 and entries.keys() >= set(_PARTS):
                found[name] = tuple(entries[part] for part in _PARTS)
    return found


def _straight(name: str) -> str:
    """What a state calls it that a place turns nothing."""
    return f"{name}[straight]"


def _turns_nothing(value: ir.Expression) -> bool:
    match value:
        case ir.Builtin(function="element_difference", arguments=(one, other)):
            return one == other and not any(isinstance(node, ir.Call) for node in walk(one))
        case ir.Aggregate(entries=entries):
            turns = {name: entry for name, entry in entries if name in ir.ANGLES}
            return len(turns) == len(ir.ANGLES) and all(_is_zero(one) for one in turns.values())
    return False


def _is_zero(value: ir.Expression) -> bool:
    return isinstance(value, ir.IntLiteral | ir.RealLiteral) and value.value == 0

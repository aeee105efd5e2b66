"""Between which limits the place of a move lies, in the robot's base: places that a program counts (columns, rows,
layers of a pallet) are inside a box as large as the loops count.

What a name stands for comes from its one assignment, a number from constants, loops that count, and what all calls
give. Whatever is not surely known has no box.
"""

from __future__ import annotations

import math
from collections import Counter
from dataclasses import dataclass, field
from itertools import product

from rpl import ir
from rpl.ir.walk import bodies, walk
from rpl.passes import rigid
from rpl.passes.fold import constant_number
from rpl.passes.legalise.facts.effects import statements_in
from rpl.passes.legalise.facts.mentioned import naming_of_routines
from rpl.passes.legalise.facts.motion.ways import Part, Ways
from rpl.passes.legalise.facts.usage import base_name, written_in
from rpl.passes.scope import Scope

__all__ = ["Boxes"]

Span = tuple[float, float]
_DEEPEST = 12  # names and operators that are looked into


@dataclass(frozen=True, slots=True)
class Box:
    """x, y and z from the lowest to the highest, mm."""

    x: Span
    y: Span
    z: Span

    def apart(self, other: Box) -> float:
        """How far two points of these boxes are apart at least, mm."""
        pairs = zip((self.x, self.y, self.z), (other.x, other.y, other.z), strict=True)
        return math.hypot(*(max(0.0, one[0] - two[1], two[0] - one[1]) for one, two in pairs))

    def placed(self, frame: rigid.Pose) -> Box:
        """The box around this one in a frame."""
        corners = [frame.place(rigid.Vector(*one)) for one in product(self.x, self.y, self.z)]
        found = ([getattr(one, axis) for one in corners] for axis in "xyz")
        return Box(*((min(values), max(values)) for values in found))

    def moved(self, by: Box) -> Box:
        """The box of sums."""
        pairs = zip((self.x, self.y, self.z), (by.x, by.y, by.z), strict=True)
        return Box(*((one[0] + two[0], one[1] + two[1]) for one, two in pairs))


_ORIGIN = Box((0.0, 0.0), (0.0, 0.0), (0.0, 0.0))


@dataclass(slots=True)
class Boxes:
    """Facts of one program, behind `Ways`."""

    ways: Ways
    named: Counter[str]
    calls: dict[str, list[tuple[Scope, ir.CallRoutine]]] = field(default_factory=dict)
    found: dict[int, Box | None] = field(default_factory=dict)

    @staticmethod
    def of(program: ir.Program, ways: Ways) -> Boxes:
        boxes = Boxes(ways, naming_of_routines(program))
        for module, routine in ways.stands.scopes.routines():
            scope = ways.stands.scopes.routine(module, routine)
            for body in bodies(routine):
                for statement in statements_in(body):
                    if isinstance(statement, ir.CallRoutine) and statement.dynamic is None:
                        boxes.calls.setdefault(statement.name.lower(), []).append((scope, statement))
        return boxes

    def least_mm(self, first: ir.Move, second: ir.Move) -> float:
        """How far the places of two moves are apart at least; 0 where that is not known."""
        one, other = self.box(first), self.box(second)
        return 0.0 if one is None or other is None or first.tool != second.tool else one.apart(other)

    def box(self, move: ir.Move) -> Box | None:
        key = id(move)
        if key not in self.found:
            parts, place = self.ways.parts(move), self.ways.place(move)
            if place is not None:
                self.found[key] = _ORIGIN.placed(rigid.Pose(place, rigid.NO_TURN))
            else:
                self.found[key] = None if parts is None else self.product(parts, self.ways.scopes[key], 0)
        return self.found[key]

    def product(self, parts: list[Part], scope: Scope, depth: int) -> Box | None:
        """The place that a product of frames and ways gives."""
        box: Box | None = None  # of what stands behind, which turns with what is in front of it
        for part in reversed(parts):
            if isinstance(part, rigid.Pose):
                box = (box or _ORIGIN).placed(part)
                continue
            inner = self.part(part, scope, depth)
            if inner is None or (box is not None and not _is_way(part)):
                return None
            box = inner if box is None else box.moved(inner)
        return box or _ORIGIN

    def part(self, part: ir.Expression, scope: Scope, depth: int) -> Box | None:
        match part:
            case ir.Builtin(function="offset", arguments=(x, y, z)):
                spans = [self.span(one, scope, depth + 1) for one in (x, y, z)]
                known = [one for one in spans if one is not None]
                return Box(*known) if len(known) == len(spans) else None
            case ir.Name(id=name) if depth < _DEEPEST:
                value = self.held(name, scope)
                return None if value is None else self.product(self.ways.factors(value, scope), scope, depth + 1)
        return None

    def held(self, name: str, scope: Scope) -> ir.Expression | None:
        """What a variable of the routine holds behind its one assignment, which the routine makes in its own body."""
        routine, symbol = scope.routine_here, scope.value(name)
        if routine is None or symbol is None or symbol.routine is not routine or not _is_own(symbol.declaration):
            return None
        given = {one.name.lower() for one in routine.parameters}
        assigned = [
            one
            for body in bodies(routine)
            for one in statements_in(body)
            if isinstance(one, ir.Assign) and base_name(one.target) == name.lower()
        ]
        match assigned:
            case [ir.Assign(target=ir.Name(), value=value) as only] if name.lower() not in given:
                lent = self.lent(name, routine)
                early = any(one is only for one in routine.body) and not any(
                    isinstance(one, ir.Label) for one in statements_in(routine.body)
                )
                own = any(isinstance(one, ir.Name) and one.id.lower() == name.lower() for one in walk(value))
                return value if early and not lent and not own else None
        return None

    def lent(self, name: str, routine: ir.Routine) -> bool:
        """Does a call hand the variable itself over, so that it may change?"""
        for call in walk(routine):
            if not isinstance(call, ir.CallRoutine | ir.Call):
                continue
            for at, one in enumerate(call.arguments):
                given = isinstance(one.value, ir.Name) and one.value.id.lower() == name.lower()
                if given and (one.name or not self.keeps(call, at)):
                    return True
        return False

    def keeps(self, call: ir.CallRoutine | ir.Call, at: int) -> bool:
        """Does every routine of that name leave this argument as it is?"""
        routines = [one for _, one in self.ways.stands.scopes.routines() if one.name.lower() == call.name.lower()]
        return bool(routines) and all(at < len(one.parameters) and _leaves(one, one.parameters[at]) for one in routines)

    # ---- numbers

    def span(self, value: ir.Expression, scope: Scope, depth: int) -> Span | None:
        """Between which numbers a value lies."""
        known = constant_number(value, scope, self.ways.stands.unchanged)
        if known is not None or depth > _DEEPEST:
            return None if known is None else (known, known)
        match value:
            case ir.Name(id=name):
                return self.named_span(name, scope, depth + 1)
            case ir.Unary(op="-", operand=operand):
                inner = self.span(operand, scope, depth + 1)
                return None if inner is None else (-inner[1], -inner[0])
            case ir.Convert(how="real", operand=operand):
                return self.span(operand, scope, depth + 1)
            case ir.Binary(op="+" | "-" | "*" as op, left=left, right=right):
                one, other = self.span(left, scope, depth + 1), self.span(right, scope, depth + 1)
                return None if one is None or other is None else _combined(op, one, other)
            case ir.Binary(op="/", left=left, right=right):
                one, other = self.span(left, scope, depth + 1), self.span(right, scope, depth + 1)
                if one is None or other is None or other[0] != other[1] or other[0] == 0:
                    return None
                return _combined("*", one, (1.0 / other[0], 1.0 / other[0]))
        return None

    def named_span(self, name: str, scope: Scope, depth: int) -> Span | None:
        """Of a parameter what all calls give; of a variable of the routine what the loops count that set it."""
        routine, symbol = scope.routine_here, scope.value(name)
        if routine is None or symbol is None or symbol.routine is not routine:
            return None
        at = next((at for at, one in enumerate(routine.parameters) if one.name.lower() == name.lower()), None)
        if at is not None:
            kept = name.lower() not in written_in(routine) and _leaves(routine, routine.parameters[at])
            return self.given(routine, at, depth) if kept else None
        if self.lent(name, routine):
            return None
        if not _is_own(symbol.declaration):
            return None
        spans: list[Span | None] = [self.first(symbol.declaration, scope, depth)]
        for body in bodies(routine):
            for one in statements_in(body):
                match one:
                    case ir.For(counter=counter) if counter.lower() == name.lower():
                        spans.append(self.counted(one, scope, depth))
                    case ir.Assign(target=target) if base_name(target) == name.lower():
                        return None
        return _joined(spans) if len(spans) > 1 else None

    def first(self, declared: object, scope: Scope, depth: int) -> Span | None:
        """What a variable begins with; zero where the language says nothing."""
        initial = declared.initial if isinstance(declared, ir.Variable) else None
        return (0.0, 0.0) if initial is None else self.span(initial, scope, depth + 1)

    def counted(self, loop: ir.For, scope: Scope, depth: int) -> Span | None:
        step = 1.0 if loop.step is None else constant_number(loop.step, scope, self.ways.stands.unchanged)
        start, stop = self.span(loop.start, scope, depth + 1), self.span(loop.stop, scope, depth + 1)
        if step is None or start is None or stop is None or (loop.step is None and loop.automatic):
            return None
        low, high = min(start[0], stop[0]), max(start[1], stop[1])
        return (low, high + step) if step > 0 else (low + step, high)  # behind the loop it is one step further

    def given(self, routine: ir.Routine, at: int, depth: int) -> Span | None:
        calls = self.calls.get(routine.name.lower(), [])
        if not calls or len(calls) != self.named[routine.name.lower()]:
            return None
        spans = []
        for scope, call in calls:
            plain = len(call.arguments) == len(routine.parameters) and not any(one.name for one in call.arguments)
            value = call.arguments[at].value if plain else None
            spans.append(None if value is None else self.span(value, scope, depth + 1))
        return _joined(spans)


def _leaves(routine: ir.Routine, parameter: ir.Parameter) -> bool:
    """Does the caller's variable stay as it is: is it given by value, or neither written nor handed on?"""
    name = parameter.name.lower()
    if parameter.mode == "value":
        return True
    handed = (one for one in walk(routine) if isinstance(one, ir.CallRoutine | ir.Call))
    on = any(
        isinstance(one.value, ir.Name) and one.value.id.lower() == name for call in handed for one in call.arguments
    )
    return not on and name not in written_in(routine)


def _is_way(part: Part) -> bool:
    return isinstance(part, ir.Builtin) and part.function == "offset" and len(part.arguments) == 3


def _is_own(declared: object) -> bool:
    """A variable that begins anew at each call of its routine."""
    return isinstance(declared, ir.Variable) and declared.storage == "variable"


def _combined(op: str, one: Span, other: Span) -> Span:
    match op:
        case "+":
            return one[0] + other[0], one[1] + other[1]
        case "-":
            return one[0] - other[1], one[1] - other[0]
    corners = [a * b for a in one for b in other]
    return min(corners), max(corners)


def _joined(spans: list[Span | None]) -> Span | None:
    known = [one for one in spans if one is not None]
    if not known or len(known) < len(spans):
        return None
    return min(one[0] for one in known), max(one[1] for one in known)

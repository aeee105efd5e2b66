"""How far it is from the place of one move to that of the next: as far as it is known, else for the run to compute.

A place is a product of frames: frame, target, offsets. Constant ones are multiplied out. Of two products with the same
beginning only the rest tells how far they are apart, wherever the beginning is.
"""

from __future__ import annotations

from dataclasses import dataclass, field

from rpl import ir
from rpl.ir.walk import bodies, rewrite, walk
from rpl.passes import rigid
from rpl.passes.fold import constant, constant_number
from rpl.passes.legalise.context import Context
from rpl.passes.legalise.facts.effects import Effects, blocks
from rpl.passes.legalise.facts.motion.whereabouts import Whereabouts
from rpl.passes.legalise.facts.usage import assigned_in
from rpl.passes.scope import Scope
from rpl.passes.typing import type_of
from rpl.passes.values import Value, pose_of

Part = rigid.Pose | ir.Expression
Assigned = dict[str, ir.Expression | None]
_CALLING = (ir.CallRoutine, ir.TaskControl, ir.Do, ir.Vendor, ir.Opaque)
_SEEING = frozenset(("current_target", "current_joints", "current_position"))


@dataclass(frozen=True, slots=True)
class Ways:
    """Facts of one program. `scopes`: of each move by identity; `between`: of two moves that follow each other in one
    body, the names (folded) that are assigned in between, with the number where it is one; None where any may be."""

    stands: Whereabouts
    scopes: dict[int, Scope]
    between: dict[tuple[int, int], Assigned | None]
    quiet: Effects
    targets: dict[int, ir.Expression] = field(default_factory=dict)

    @staticmethod
    def of(program: ir.Program, context: Context) -> Ways:
        stands = Whereabouts(program, context, converted=True, settled=True)
        scopes: dict[int, Scope] = {}
        between: dict[tuple[int, int], Assigned | None] = {}
        follow: list[tuple[ir.Move, ir.Move]] = []
        for module, routine in stands.scopes.routines():
            scope = stands.scopes.routine(module, routine)
            for body in bodies(routine):
                for node in walk(body):
                    if isinstance(node, ir.Move):
                        scopes[id(node)] = scope
                follow += _note_neighbours(body, between)
        ways = Ways(stands, scopes, between, Effects(program))
        for first, second in follow:
            ways.from_where_it_stands(first, second)
        return ways

    def from_where_it_stands(self, first: ir.Move, second: ir.Move) -> None:
        """A place that is seen from where the robot stands behind the first move, seen from that move's place."""
        assigned = self.between[id(first), id(second)]
        target = second.target
        if assigned is None or not any(_is_here(node) for node in walk(target)):
            return
        here = self.expression(first, assigned, later=False)
        if here is not None and not isinstance(here, ir.Builtin):
            self.targets[id(second)] = rewrite(target, lambda node: here if _is_here(node) else node)

    def target(self, move: ir.Move) -> ir.Expression:
        target = self.targets.get(id(move), move.target)
        near = isinstance(target, ir.Builtin) and target.function == "target_to_joints_near"
        return target.arguments[0] if near and isinstance(target, ir.Builtin) else target

    def known_mm(self, first: ir.Move, second: ir.Move) -> float | None:
        """The straight way between both places, mm."""
        here, there = self.place(first), self.place(second)
        if here is not None and there is not None:
            return there.plus(here, -1.0).length
        one, other = self.parts(first), self.parts(second)
        if one is None or other is None or first.tool != second.tool:
            return None
        way = _differing(one, other)
        if way is None or not (all(map(_fixed, (*one, *other))) or self.unchanged(first, second)):
            return None
        return way

    def unchanged(self, first: ir.Move, second: ir.Move) -> bool:
        """Is nothing that both places are made of assigned from the first move to the second?"""
        assigned = self.between.get((id(first), id(second)))
        places = (self.target(first), first.frame, self.target(second), second.frame)
        return assigned is not None and all(self.keeps(one, assigned) for one in places if one is not None)

    def computed(self, first: ir.Move, second: ir.Move) -> ir.Expression | None:
        """The straight way between both places as an expression (mm) that means the same at both moves."""
        assigned = self.between.get((id(first), id(second)))
        if assigned is None or first.tool != second.tool:
            return None
        places = [self.expression(first, assigned, later=False), self.expression(second, assigned, later=True)]
        one, other = places
        return None if one is None or other is None else between(one, other)

    def seen(self, here: ir.Move, there: ir.Move) -> ir.Expression | None:
        """The straight way between both places as an expression (mm) at the first one, where the other is constant."""
        far = self.place(there)
        if here.tool != there.tool or far is None:
            return None
        near = self.expression(here, {}, later=False)
        return None if near is None else between(near, _literal(far))

    def place(self, move: ir.Move) -> rigid.Vector | None:
        """Where the tool is at the end of a move, in the robot's base."""
        parts = self.parts(move)
        if parts is not None and all(map(_fixed, parts)):
            return _position(parts)
        stand, frames = self.stands.ends.get(id(move)), self.stands.flow.frames.get(id(move))
        if stand is None or stand.flange is None or frames is None or frames.tool is None:
            return None
        return stand.flange.then(frames.tool).position

    def expression(self, move: ir.Move, assigned: Assigned, later: bool) -> ir.Expression | None:
        """The place of a move in the robot's base, where these names are assigned before it (`later`) or behind it.
        None where it is not known to be a pose (joints that the run computes)."""
        target, frame = self.target(move), move.frame
        if move.relative is not None:
            return None
        scope, joints = self.scopes[id(move)], False
        if frame is None or self.factors(frame, scope) in ([], [rigid.IDENTITY]):
            value = self.value(target, scope)
            joints = pose_of(value) is None and self.stands.axes(value) is not None
            whole: ir.Expression = ir.Builtin("joints_to_target", (target,)) if joints else target
        else:
            whole = ir.Binary(":", frame, target)
        if (joints or self.is_pose(target, scope)) and self.keeps(whole, {} if later else assigned):
            whole = _with_numbers(whole, assigned if later else {})
            if self.keeps(whole, assigned):
                return whole
        known = self.place(move)
        return None if known is None else _literal(known)

    def is_pose(self, target: ir.Expression, scope: Scope) -> bool:
        """Is it known to be a place, of which a distance can be computed?"""
        known = pose_of(self.value(target, scope)) is not None
        return known or isinstance(type_of(target, scope), ir.PoseType | ir.TargetType)

    def keeps(self, place: ir.Expression, assigned: Assigned) -> bool:
        """Is a place the same wherever it is computed, if these names change?"""
        for node in walk(place):
            match node:
                case ir.Name(id=name) if name.lower() in assigned:
                    return False
                case ir.Call() if not self.quiet.quiet(node):
                    return False
                case ir.Signal():
                    return False
                case ir.System(name=name) if name != "null_frame":
                    return False
                case ir.Builtin(function=function) if function in _SEEING:
                    return False
        return True

    def at_start(self, move: ir.Move) -> ir.Expression | None:
        """The place of a move, seen from where the robot stands in front of it; None: it is not seen so."""
        if move.relative is not None or move.frame is not None or not any(_is_here(node) for node in walk(move.target)):
            return None
        seen = rewrite(move.target, lambda node: ir.System("null_frame") if _is_here(node) else node)
        pose = self.is_pose(move.target, self.scopes[id(move)])
        return move.target if pose and self.keeps(seen, {}) else None

    def value(self, expression: ir.Expression, scope: Scope) -> Value | None:
        return constant(expression, scope, self.stands.unchanged)

    # ---- places as products

    def parts(self, move: ir.Move) -> list[Part] | None:
        if move.relative is not None:
            return None
        scope = self.scopes[id(move)]
        found = [] if move.frame is None else self.factors(move.frame, scope)
        found += self.factors(self.target(move), scope)
        done: list[Part] = []
        for part in found:
            if isinstance(part, rigid.Pose) and done and isinstance(done[-1], rigid.Pose):
                done[-1] = done[-1].then(part)
            else:
                done.append(part)
        return done

    def factors(self, expression: ir.Expression, scope: Scope) -> list[Part]:
        known = pose_of(self.value(expression, scope))
        if known is not None:
            return [known]
        match expression:
            case ir.System(name="null_frame"):
                return []
            case ir.Binary(op=":", left=left, right=right):
                return [*self.factors(left, scope), *self.factors(right, scope)]
            case ir.Builtin(function="pose_of", arguments=(place,)):
                return self.factors(place, scope)
            case ir.Builtin(function="target_to_joints_near", arguments=(place, _)):
                return self.factors(place, scope)
            case ir.Builtin(function="displaced", arguments=(place, by)):
                return [*self.factors(by, scope), *self.factors(place, scope)]
            case ir.Builtin(function="displaced_in_tool", arguments=(place, by)):
                return [*self.factors(place, scope), *self.factors(by, scope)]
            case ir.Builtin(function="offset", arguments=(place, x, y, z)):
                return [self.shift(scope, x, y, z), *self.factors(place, scope)]
            case ir.Builtin(function="tool_offset", arguments=(place, x, y, z)):
                return [*self.factors(place, scope), self.shift(scope, x, y, z)]
        return [expression]

    def shift(self, scope: Scope, *parts: ir.Expression) -> Part:
        found = [constant_number(one, scope, self.stands.unchanged) for one in parts]
        known = [one for one in found if one is not None]
        if len(known) < len(found):
            return ir.Builtin("offset", parts)
        return rigid.Pose(rigid.Vector(*known), rigid.NO_TURN)


def _is_here(node: object) -> bool:
    return node == ir.System("actual_pose") or (
        isinstance(node, ir.Builtin) and node == ir.Builtin("current_target", ())
    )


def _with_numbers(place: ir.Expression, assigned: Assigned) -> ir.Expression:
    """A place with the numbers that names are set to before it."""

    def change(node: object) -> object:
        return (assigned.get(node.id.lower()) or node) if isinstance(node, ir.Name) else node

    return rewrite(place, change)


def _literal(place: rigid.Vector) -> ir.Expression:
    parts = [ir.RealLiteral(float(f"{value:.9g}")) for value in (place.x, place.y, place.z, 0.0, 0.0, 0.0)]
    return ir.Aggregate(tuple(zip(ir.POSE, parts, strict=True)), type_name="pose")


def between(one: ir.Expression, other: ir.Expression) -> ir.Expression:
    """The straight way between two poses, mm."""
    return ir.Builtin("distance", (ir.Field(one, "trans"), ir.Field(other, "trans")))


def _fixed(part: Part) -> bool:
    return isinstance(part, rigid.Pose)


def _differing(one: list[Part], other: list[Part]) -> float | None:
    """How far two products are apart, None where that is not known."""
    at = 0
    while at < min(len(one), len(other)) and one[at] == other[at]:
        at += 1
    one, other = one[at:], other[at:]
    if all(map(_fixed, one)) and all(map(_fixed, other)):
        return _position(other).plus(_position(one), -1.0).length
    # the same place moved along the axes of one frame
    first, second = _moved(one), _moved(other)
    if first is None or second is None or first[1] != second[1]:
        return None
    return second[0].plus(first[0], -1.0).length


def _position(parts: list[Part]) -> rigid.Vector:
    place = rigid.IDENTITY
    for part in parts:
        place = place.then(part) if isinstance(part, rigid.Pose) else place
    return place.position


def _moved(parts: list[Part]) -> tuple[rigid.Vector, list[Part]] | None:
    """A product as a shift and what is shifted."""
    if not parts or not isinstance(parts[0], rigid.Pose):
        return rigid.Vector(0.0, 0.0, 0.0), parts
    return (parts[0].position, parts[1:]) if parts[0].rotation == rigid.NO_TURN else None


def _note_neighbours(body: ir.Body, between: dict[tuple[int, int], Assigned | None]) -> list[tuple[ir.Move, ir.Move]]:
    """The moves that follow each other in this body and in all inside it."""
    work, found = [body], []
    while work:
        last: ir.Move | None = None
        assigned: Assigned = {}
        for statement in work.pop():
            work += blocks(statement)
            if isinstance(statement, ir.Move):
                if last is not None:
                    key = (id(last), id(statement))
                    between[key] = assigned if key not in between else None
                    found.append((last, statement))
                last, assigned = statement, {}
            elif last is not None and _may_hide(statement):
                last = None
            elif last is not None:
                assigned |= _assigned(statement)
    return found


def _assigned(statement: ir.Statement) -> Assigned:
    match statement:
        case ir.Assign(target=ir.Name(id=name), value=ir.IntLiteral() | ir.RealLiteral() as value):
            return {name.lower(): value}
    return {name.lower(): None for name in assigned_in((statement,))}


def _may_hide(statement: ir.Statement) -> bool:
    """May it change more than it assigns itself, or may control come there from elsewhere?"""
    return any(isinstance(node, (ir.Label, ir.Move, ir.Spline, *_CALLING)) for node in walk(statement))


__all__ = ["Ways", "between"]

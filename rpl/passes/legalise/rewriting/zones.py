"""Corners of constant size between constant places, with the ways beside them and how far the tool turns there: what is
asked to tell how a controller with zones (RAPID zonedata) reduces them.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace

from rpl import ir
from rpl.ir.columns import Stretch, column_of, in_next_row, in_row
from rpl.passes import rigid
from rpl.passes.fold import constant, constant_number
from rpl.passes.legalise.rewriting.editing import edit_bodies, edit_each
from rpl.passes.legalise.rewriting.jumps import inside
from rpl.passes.scope import ProgramScope, Scope
from rpl.passes.values import Record, pose_of

NO_WAY, NO_TURN = 1e-3, 1e-3


@dataclass(frozen=True, slots=True)
class Zone:
    """A move with a zone that is constant; sizes in mm and degrees."""

    move: ir.Move
    blend: ir.BlendZone
    path: float
    rotation_path: float
    rotation: float


@dataclass(frozen=True, slots=True)
class Leg:
    """A move from one constant place to another: mm, degrees."""

    way: float
    turn: float

    def limits(self, zone: Zone) -> list[float]:
        """The sizes (mm) to which the turn reduces a zone."""
        if self.turn <= NO_TURN or self.way <= NO_WAY:
            return []
        by_angle = [zone.rotation / self.turn * self.way] if zone.rotation > 0.0 else []
        return [max(zone.rotation_path, zone.path), *by_angle]


_Change = Callable[[Zone, list[Leg]], ir.Blend]


def with_zones(program: ir.Program, change: _Change) -> ir.Program:
    scopes = ProgramScope(program)
    return edit_each(program, lambda module, one: edit_bodies(one, _Bodies(scopes.routine(module, one), change).body))


@dataclass(frozen=True, slots=True)
class _Place:
    """Where a move goes; for a stretch of a run (`stretch`) where each of its moves goes."""

    pose: rigid.Pose
    frames: tuple[object, object]

    @property
    def stretch(self) -> Stretch | None:
        return next((one.stretch for one in map(column_of, self.numbers()) if one is not None), None)

    def numbers(self) -> tuple[float, ...]:
        at = self.pose.position
        return at.x, at.y, at.z, *self.pose.rotation.quaternion

    def changed(self, change: Callable[[float], float]) -> _Place:
        x, y, z, *quaternion = map(change, self.numbers())
        a, b, c, d = quaternion
        return replace(self, pose=rigid.Pose(rigid.Vector(x, y, z), rigid.Rotation((a, b, c, d))))

    def in_row(self, at: int) -> _Place:
        return self.changed(lambda number: in_row(number, at))

    def in_next_row(self, step: int) -> _Place:
        return self.changed(lambda number: in_next_row(number, step))


@dataclass(frozen=True, slots=True)
class _Open:
    """A move with a zone, of which the way behind it is not known yet. leg: the way to it."""

    index: int
    zone: Zone
    leg: Leg | None
    place: _Place | None


class _Bodies:
    def __init__(self, scope: Scope, change: _Change) -> None:
        self.scope, self.change = scope, change

    def body(self, body: ir.Body) -> ir.Body:
        done = list(body)
        before: _Place | None = None
        open: _Open | None = None
        for index, statement in enumerate(body):
            if isinstance(statement, ir.Move):
                place = self.place(statement)
                stretch = None if place is None else place.stretch
                first = place if place is None or stretch is None else place.in_row(stretch.first)
                if open is not None:
                    self.close(done, open, _leg(before, first) if statement.kind != "circular" else None)
                if place is not None and stretch is not None:
                    before = place.in_next_row(-1)
                leg = _leg(before, place) if statement.kind != "circular" else None
                zone = self.zone(statement)
                open = _Open(index, zone, leg, place) if zone is not None else None
                before = place if place is None or stretch is None else place.in_row(stretch.end - 1)
            elif not isinstance(statement, ir.Nothing | ir.Trigger | ir.LookAhead | ir.Assign | ir.Pulse):
                if open is not None:
                    self.close(done, open, None)
                before, open = None, None
                done[index] = inside(statement, self.body)
        if open is not None:
            self.close(done, open, None)
        return body if all(new is old for new, old in zip(done, body, strict=True)) else tuple(done)

    def close(self, done: list[ir.Statement], open: _Open, leg: Leg | None) -> None:
        if leg is not None and open.place is not None and open.place.stretch is not None:
            leg = _leg(open.place, open.place.in_next_row(1))
        blend = self.change(open.zone, [one for one in (open.leg, leg) if one is not None])
        if blend is not open.zone.blend:
            done[open.index] = replace(open.zone.move, blend=blend)

    def place(self, move: ir.Move) -> _Place | None:
        if move.relative is not None:
            return None
        pose = pose_of(constant(move.target, self.scope))
        return None if pose is None else _Place(pose, (move.tool, move.frame))

    def zone(self, move: ir.Move) -> Zone | None:
        blend = move.blend
        if not isinstance(blend, ir.BlendZone):
            return None
        value = constant(blend.zone, self.scope)
        if not isinstance(value, Record) or value.part("stop"):
            return None
        path = constant_number(blend.distance, self.scope) if blend.distance is not None else value.part("path")
        sizes = [path, value.part("rotation_path"), value.part("rotation")]
        numbers = [float(size) for size in sizes if isinstance(size, int | float)]
        return Zone(move, blend, *numbers) if len(numbers) == 3 and numbers[0] > 0.0 else None


def _leg(start: _Place | None, end: _Place | None) -> Leg | None:
    if start is None or end is None or start.frames != end.frames:
        return None
    way = end.pose.position.plus(start.pose.position, -1.0).length
    turn = start.pose.rotation.inverse.then(end.pose.rotation).angle
    return Leg(way, turn)


__all__ = ["NO_TURN", "NO_WAY", "Leg", "Zone", "with_zones"]

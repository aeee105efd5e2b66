"""Actions on the path: where on a move they happen, and when the piece that is driven comes there.

A move that begins or ends in a corner has its start or end in the middle of that corner. How millimetres are counted
near a corner, and how far a time may shift an action, differ between controllers: see `TriggerRules`.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from rpl.runtime.moves.orders import Drive, TriggerOrder

if TYPE_CHECKING:
    from rpl.ir.rules import TriggerRules
    from rpl.runtime.moves.pieces import Corner, Piece

# Moments (s), ways (mm) and fractions of moves that differ by less are one.
SMALL = 1e-9


@dataclass(frozen=True, slots=True)
class Place:
    """part: `move` (`at` is a fraction of it), `into` or `out`: the corner at its start or end (`at` is a fraction of
    the corner), `back`: mm before the end of the corner at its start, `on`: mm behind the beginning of that at its
    end."""

    part: str
    at: float


def due_of(piece: Piece, drive: Drive, trigger: TriggerOrder) -> float | None:
    """When the trigger of `drive` is due, s; None when only a later piece can tell. `drive` is the piece's own, or the
    one that follows the corner which the piece is."""
    rules = drive.order.rules.triggers
    corner = piece.corner
    if corner is not None and drive is corner.following:
        return _in_start_corner(piece, corner, drive, trigger, rules)
    out = corner if corner is not None else piece.ahead
    place = place_of(drive, trigger, rules, out)
    when = _in_end_corner(piece, corner, place, rules) if corner is not None else _on_move(piece, place, trigger, rules)
    if when is None:
        return None
    due = _passed(piece, trigger) if when < piece.start_s - SMALL else when + trigger.delay
    if trigger.early_while_braking and corner is None and piece.ahead is None and not piece.open_end:
        due = max(due, piece.start_s + _braking_begins(piece))
    return _within(piece, trigger, due) if rules.delays_within_move else due


def _passed(piece: Piece, trigger: TriggerOrder) -> float:
    """The place lies behind the robot: the time that counts since then goes on."""
    return trigger.due if trigger.due is not None else piece.start_s + trigger.delay


def _within(piece: Piece, trigger: TriggerOrder, due: float) -> float:
    """A time shifts an action at most to the limits of its move; one by a distance, to the next stop."""
    rests = piece.ahead is None and piece.corner is None and not piece.open_end
    if rests or (trigger.distance is None and (piece.corner is not None or trigger.reference == "start")):
        due = min(due, piece.end_s)
    if piece.ahead is not None and trigger.distance is None and trigger.reference != "start":
        due = max(due, piece.end_s)
    return due


def _braking_begins(piece: Piece) -> float:
    """Seconds into the piece at which the robot leaves its top speed; 0 where it never drives evenly."""
    law = piece.plan.law
    fast = [time for time, speed in zip(law.times, law.speeds, strict=True) if speed >= 0.999 * law.speeds.max()]
    evenly = len(fast) > 1 and fast[-1] - fast[0] > law.smoothing_s + 1e-6
    return float(fast[-1]) - 0.5 * law.smoothing_s if evenly else 0.0


# ---- where


def place_of(drive: Drive, trigger: TriggerOrder, rules: TriggerRules, out: Corner | None) -> Place:
    """Where on the move or in its corners (`out`: that at its end, as far as it is known) the trigger stands."""
    import numpy as np

    assert drive.plan is not None
    geometry = drive.plan.geometry
    whole = float(geometry.distance(np.array([1.0]))[0])
    starts, distance = trigger.reference == "start", trigger.distance or 0.0
    if trigger.behind_corner and drive.entered is not None:
        return Place("back", 0.0)
    if distance == 0.0 or whole <= 0.0:
        if starts:
            return Place("move", 0.0) if drive.entered is None else Place("into", 0.5)
        return Place("move", 1.0) if out is None else Place("out", 0.5)
    meet, half = drive.entered or (0.0, 0.0)
    leave = whole if out is None else float(geometry.distance(np.array([out.leave]))[0])
    if rules.measured == "path":
        end = half + leave - meet + (out.half_mm if out is not None else 0.0)
        driven = distance if starts else end + distance
        if driven < half or driven < 0.0:
            return Place("back", half - driven)
        if driven > half + leave - meet:
            return Place("on", driven - half - leave + meet) if out is not None else Place("move", 1.0)
        return Place("move", geometry.fraction_at(driven - half + meet))
    place = min(max(distance if starts else whole + distance, 0.0), whole)
    if place < meet:
        return Place("into", 0.5 + 0.5 * place / meet)
    if place > leave + SMALL:
        return Place("out", 0.5 * (place - leave) / (whole - leave))
    return Place("move", geometry.fraction_at(place))


def carried(drive: Drive, trigger: TriggerOrder, corner: Corner) -> TriggerOrder | None:
    """The same action on the next move, where it lies behind the corner at the end of this one."""
    place = place_of(drive, trigger, drive.order.rules.triggers, corner)
    if place.part != "on" or place.at <= corner.ways[-1]:
        return None
    there = trigger.copy()
    there.reference, there.distance = "start", place.at - corner.half_mm
    return there


# ---- when


def _on_move(piece: Piece, place: Place, trigger: TriggerOrder, rules: TriggerRules) -> float | None:
    begin, end = piece.plan.span
    if place.part in ("into", "back") or (place.part == "move" and place.at < begin):
        return piece.start_s - 1.0
    if place.part == "move" and place.at <= end + SMALL:
        if place.at >= end - SMALL or end <= begin:  # at rest there: a last bit of way would be 1e-8 s
            return piece.end_s
        return piece.start_s + float(piece.plan.law.time_of((place.at - begin) / (end - begin)))
    if piece.ahead is not None:
        if rules.end_at_joint_corner and _is_left_for_joints(piece, piece.ahead):
            return piece.end_s
        inside = piece.ahead.fraction_of(place.part, place.at)
        return None if inside is None else piece.end_s + float(piece.ahead.plan.law.time_of(inside))
    if trigger.delay < 0.0 and piece.open_end and end > begin:  # the corner to come is taken as fast as the move
        speed = float(piece.plan.law.speed_at(piece.plan.duration_s)) * (end - begin)
        return piece.end_s + (place.at - end) / speed if speed > 0.0 else None
    return None


def _in_end_corner(piece: Piece, corner: Corner, place: Place, rules: TriggerRules) -> float | None:
    if rules.end_at_joint_corner and _is_left_for_joints(piece, corner):
        return piece.start_s
    if place.part in ("move", "into", "back"):
        return piece.start_s - 1.0
    inside = corner.fraction_of(place.part, place.at)
    return None if inside is None else _time_at(piece, inside)


def _in_start_corner(
    piece: Piece, corner: Corner, drive: Drive, trigger: TriggerOrder, rules: TriggerRules
) -> float | None:
    place = place_of(drive, trigger, rules, None)
    if place.part not in ("into", "back"):
        return None
    inside = place.at if place.part == "into" else corner.fraction_of("on", max(corner.ways[-1] - place.at, 0.0))
    if inside is None or (rules.end_at_joint_corner and piece.drive.order.kind == "joint" != drive.order.kind):
        return None
    when = _time_at(piece, inside)
    if when is None:
        return None
    return _passed(piece, trigger) if when < piece.start_s - SMALL else when + trigger.delay


def _is_left_for_joints(piece: Piece, corner: Corner) -> bool:
    return piece.drive.order.kind != "joint" and corner.following.order.kind == "joint"


def _time_at(piece: Piece, fraction: float) -> float | None:
    """When the piece, a corner or a part of one, comes there; before its start: that lies behind the robot."""
    begin, end = piece.plan.span
    if fraction < begin:
        return piece.start_s - 1.0
    if fraction > end:
        return None
    return piece.start_s + float(piece.plan.law.time_of((fraction - begin) / max(end - begin, 1e-300)))


def middle_of(piece: Piece) -> float | None:
    """When the corner's middle is passed on this piece, which is the corner or a part of it."""
    begin, end = piece.plan.span
    return _time_at(piece, 0.5) if begin <= 0.5 <= end else None

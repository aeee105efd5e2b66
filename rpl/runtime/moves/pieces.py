"""Pieces of planned moves as the robot drives them, and the arithmetic of leaving, joining, braking and taking up.

A piece is a part of a move's geometry with its own time law; replacing the piece that is driven by another one that
starts at the same place with the same speed is how a plan changes while the robot moves.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, TypeGuard

from rpl.passes import rigid
from rpl.runtime.moves.orders import BlendOrder, Drive
from rpl.runtime.moves.zones import ZoneSize, largest, zone_size
from rpl.runtime.values import Value

if TYPE_CHECKING:
    from rpl.emulator.model import RobotModel
    from rpl.emulator.planner import MotionFault, MoveRequest, PlannedMove
    from rpl.emulator.rotations import FloatArray

# A joint blend of 100 percent begins this far before the target, measured on the axis that has the longest way.
JOINT_BLEND_DEG = 90.0
MOST = 0.5
# A move is driven up to this share of it before its corner, so that rounding never puts it behind the corner's start.
ROUNDING = 1e-9


@dataclass(slots=True, eq=False)
class Corner:
    """A corner and what follows it: the rest of the next move. `rates`: fractions of the move before and of the next
    one per fraction of the corner, where they meet it. `leave`: the fraction of the move before it where it begins;
    `ways` (k,): millimetres along it at even fractions."""

    plan: PlannedMove
    rest: PlannedMove
    following: Drive
    rates: tuple[float, float]
    leave: float
    ways: FloatArray

    @property
    def entered(self) -> tuple[float, float]:
        """Where the next move begins behind it: mm of that move, and mm driven behind the corner's middle."""
        import numpy as np

        met = float(self.rest.geometry.distance(np.array([self.rest.span[0]]))[0])
        return met, float(self.ways[-1]) - self.half_mm

    @property
    def half_mm(self) -> float:
        """Millimetres from its beginning to its middle."""
        return float(self.ways[len(self.ways) // 2])

    def fraction_of(self, part: str, at: float) -> float | None:
        """The fraction of the corner: `at` itself (`out`), or that many mm behind its start (`on`); None: behind it."""
        import numpy as np

        if part != "on":
            return at
        if at > self.ways[-1]:
            return None
        return float(np.interp(at, self.ways, np.linspace(0.0, 1.0, len(self.ways))))


@dataclass(frozen=True, slots=True)
class Halting:
    """The robot brakes. `hard`: with the emergency ramp; `ends_move`: what is left of the move is dropped when it
    stands; `onward`: speed (1/s of the move or corner) at the piece's end, where it does not come to rest in it."""

    hard: bool
    ends_move: bool
    onward: float = 0.0


@dataclass(slots=True, eq=False)
class Piece:
    """What is driven from `start_s` on. `ahead`: a corner follows this piece; `corner`: this piece is that corner, or a
    part of it. `open_end`: it ends where a corner should begin, the next move not being known yet. `shown_s`: how much
    of it is in the trace already."""

    drive: Drive
    plan: PlannedMove
    start_s: float
    ahead: Corner | None = None
    corner: Corner | None = None
    open_end: bool = False
    halting: Halting | None = None
    shown_s: float = 0.0

    @property
    def end_s(self) -> float:
        return self.start_s + self.plan.duration_s

    def joints_at(self, now: float) -> FloatArray:
        return self.plan.joints_at(min(max(now - self.start_s, 0.0), self.plan.duration_s))


def plan(model: RobotModel, joints: FloatArray, request: MoveRequest) -> PlannedMove | MotionFault:
    """Plan one move (the emulator is imported when the first move is made)."""
    from rpl.runtime.moves import repeats

    return repeats.plan(model, joints, request)


def is_planned(planned: PlannedMove | MotionFault) -> TypeGuard[PlannedMove]:
    from rpl.emulator.planner import PlannedMove

    return isinstance(planned, PlannedMove)


def is_fault(planned: PlannedMove | MotionFault) -> TypeGuard[MotionFault]:
    return not is_planned(planned)


def pose_data(pose: rigid.Pose | None) -> dict[str, Value]:
    """A pose as the trace prints it."""
    if pose is None:
        return {}
    place = pose.position
    turn = [round(number + 0.0, 9) for number in pose.rotation.quaternion]
    if next((number for number in turn if number), 1.0) < 0.0:  # of two quaternions for one rotation always the same
        turn = [0.0 - number for number in turn]
    return {"xyz_mm": [round(number + 0.0, 6) for number in (place.x, place.y, place.z)], "quat_wxyz": turn}


# ---- where a piece is


def place_of(piece: Piece, now: float) -> tuple[float, float]:
    """Fraction of the whole move's geometry, and its speed in 1/s."""
    begin, end = piece.plan.span
    t = min(max(now - piece.start_s, 0.0), piece.plan.duration_s)
    law = piece.plan.law
    return begin + (end - begin) * law.fraction_at(t), (end - begin) * float(law.speed_at(t))


def rest_of(piece: Piece, now: float, end: float = 1.0, end_speed: float = 0.0) -> PlannedMove:
    """From where the robot is now, with its speed, to a place further on."""
    place, speed = place_of(piece, now)
    place = min(place, end)
    if place == piece.plan.span[0] and end == piece.plan.span[1] and end_speed == piece.plan.law.speeds[-1] == 0.0:
        return piece.plan  # nothing of it is driven yet
    return piece.plan.part((place, end), piece.plan.profile.law(place, end, speed, end_speed))


def to_the_end(piece: Piece, now: float) -> Piece:
    """The same move, now to its end and to rest there."""
    return Piece(piece.drive, rest_of(piece, now), now)


def open_ended(piece: Piece, now: float) -> Piece:
    """Towards where the corner would begin, without slowing down for a stop."""
    overlap = overlap_of(piece.drive.order.blend, piece.plan)
    if overlap is not None:
        return _overlap_ended(piece, now, overlap)
    leave = _leave_alone(piece.plan, piece.drive) - ROUNDING
    place, speed = place_of(piece, now)
    if leave <= place + 1e-9:
        return piece
    profile = piece.plan.profile
    end_speed = min(profile.speed, (speed * speed + 2.0 * profile.acceleration * (leave - place)) ** 0.5)
    opened = piece.plan.part((place, leave), profile.law(place, leave, speed, end_speed))
    return Piece(piece.drive, opened, now, open_end=True)


def _overlap_ended(piece: Piece, now: float, share: float) -> Piece:
    """Towards a corner with a move like this one, at the speed that it has there."""
    from rpl.emulator.blending import open_end

    leave, end_speed, profile = open_end(piece.plan, share)
    place, speed = place_of(piece, now)
    if leave - ROUNDING <= place + 1e-9:
        return piece
    opened = piece.plan.part((place, leave - ROUNDING), profile.law(place, leave - ROUNDING, speed, end_speed))
    return Piece(piece.drive, opened, now, open_end=True)


# Moving back onto a path that was left, as a share of the axes' speed.
REGAIN_SHARE = 0.1


def way_back(model: RobotModel, joints: FloatArray, piece: Piece, now: float) -> Piece | None:
    """The move back to where a path was left; None when the robot stands there."""
    from rpl.emulator.planner import MoveRequest

    goal = piece.joints_at(piece.end_s)
    if float(abs(goal - joints).max()) < 1e-3:
        return None
    made = plan(model, joints, MoveRequest(kind="joint", target_joints=goal, joint_speed=REGAIN_SHARE))
    return Piece(piece.drive, made, now) if is_planned(made) else None


# ---- corners


@dataclass(slots=True, eq=False)
class Stored:
    """A path put aside: where it was interrupted and what was still to come."""

    joints: FloatArray
    piece: Piece | None
    queue: list[Drive]
    stopped: bool


def joined(model: RobotModel, piece: Piece, following: Drive, now: float) -> Piece | None:
    """The piece up to the corner with the next move, from where the robot is; None when there can be no corner."""
    from rpl.emulator.blending import Size
    from rpl.runtime.moves import repeats

    first, second = piece.drive.plan, following.plan
    assert first is not None and second is not None
    order, sliding = piece.drive.order.blend, piece.drive.sliding
    asked = blend_size(order, first, second, sliding)
    if asked == (None, None):
        return None
    distance, fraction = _in_segments(piece.drive, following, *asked)
    zone = zone_size(order, first, second, sliding) if order.zone is not None else ZoneSize()
    overlap = overlap_of(piece.drive.order.blend, first)
    alone = first.span[0] <= 0.0 and piece.plan.span[0] <= 0.0, following.order.blend.stops
    size = Size(distance, zone.extended, zone.shares or fraction, overlap)
    made = repeats.joining(model, rest_of(piece, now), second, size, alone)
    if made is None:
        return None
    parts = made.parts
    corner = Corner(parts.corner, parts.second, following, made.rates, parts.first.span[1], made.ways)
    return Piece(piece.drive, parts.first, now, ahead=corner)


def corner_piece(piece: Piece, now: float) -> Piece:
    """The corner that this piece leads to."""
    assert piece.ahead is not None
    return Piece(piece.drive, piece.ahead.plan, now, corner=piece.ahead)


def leaves_s(piece: Piece) -> float:
    """When the robot comes to the largest zone (of the place, the orientation, external axes) at the piece's end."""
    import numpy as np

    drive, order = piece.drive, piece.drive.order.blend
    if order.zone is None:
        return piece.end_s
    whole = float(piece.plan.geometry.distance(np.array([1.0]))[0])
    following = piece.ahead.following.plan if piece.ahead is not None else None
    size = largest(order, piece.plan, following, drive.sliding)
    begin, end = piece.plan.span
    place = piece.plan.geometry.fraction_at(max(whole - size, (1.0 - MOST) * whole))
    if whole <= 0.0 or place >= end:
        return piece.end_s
    return piece.start_s + float(piece.plan.law.time_of(max(place - begin, 0.0) / max(end - begin, 1e-12)))


def overlap_of(order: BlendOrder, first: PlannedMove) -> float | None:
    """The share of a ramp in which two moves overlap, where the controller makes its corners so."""
    if order.kind != "percent" or not first.controller.overlap:
        return None
    return first.controller.overlap_at(order.percent)


def blend_size(
    order: BlendOrder, first: PlannedMove, second: PlannedMove | None, sliding: tuple[bool, ...] = ()
) -> tuple[float | None, float | None]:
    """Distance in mm or share of the moves, by the measure that the program uses; none: no corner."""
    both_joint = first.kind == "joint" and (second is None or second.kind == "joint")
    match order.kind:
        case "percent":
            by_path = blend_size(order.path, first, second) if order.path is not None and not both_joint else None
            if by_path is not None and by_path != (None, None):
                return by_path
            size = order.percent / 100.0 * JOINT_BLEND_DEG
            ways = [float(abs(m.end_joints - m.start_joints).max()) for m in (first, second) if m is not None]
            fraction = min([MOST, *(size / way for way in ways if way > 1e-9)])
            return None, fraction if fraction > 0.0 else None
        case "speed":
            whole = first.length_mm
            top, braking = first.profile.speed * whole, first.profile.down * whole
            way: float = (order.percent / 100.0 * top) ** 2 / (2.0 * braking) if braking > 0.0 else 0.0
            return (way, None) if way > 0.0 else (None, None)
        case "zone" if order.zone is not None:
            zone = zone_size(order, first, second, sliding)
            return zone.path, zone.shares[0] if zone.shares is not None else None
        case "distance":
            sizes = [] if not order.distance else [order.distance]
            share = _turn_share(order.rotation, first)
            if share is not None:
                sizes.append(share * first.length_mm)
            return (min(sizes), None) if sizes and min(sizes) > 0.0 else (None, None)
    return None, None


def may_blend(order: BlendOrder, move: PlannedMove) -> bool:
    """May there be a corner behind the move? A distance of zero is a stop, before the next move is known."""
    if order.stops:
        return False
    return order.kind != "distance" or blend_size(order, move, None) != (None, None)


def _turn_share(rotation: float | None, move: PlannedMove) -> float | None:
    """Which share of the move turns the tool by that many degrees at its end."""
    if not rotation:
        return None
    from rpl.emulator.rotations import rotation_angle

    turn = 57.29577951308232 * float(rotation_angle(move.start_pose[:3, :3].T @ move.end_pose[:3, :3]))
    return min(MOST, rotation / turn) if turn > 1e-9 else None


def _in_segments(
    drive: Drive, following: Drive | None, distance: float | None, fraction: float | None
) -> tuple[float | None, float | None]:
    """M: the corner of a spline block takes at most half of its last segment, that into one half of its first."""
    shares: list[tuple[PlannedMove, float]] = []
    if len(drive.orders) > 1 and drive.plan is not None:
        shares.append((drive.plan, MOST * (1.0 - drive.marks[-1])))
    if following is not None and len(following.orders) > 1 and following.plan is not None:
        shares.append((following.plan, MOST * following.marks[0]))
    for plan, share in shares:
        fraction = min(fraction, share) if fraction is not None else None
        distance = min(distance, plan.length_mm * share) if distance is not None else None
    return distance, fraction


def _leave_alone(move: PlannedMove, drive: Drive) -> float:
    """Where the corner would begin as far as this move alone can tell."""
    import numpy as np

    overlap = overlap_of(drive.order.blend, move)
    if overlap is not None:
        from rpl.emulator.blending import open_end

        return open_end(move, overlap)[0]
    order = drive.order.blend
    distance, fraction = _in_segments(drive, None, *blend_size(order, move, None, drive.sliding))
    if distance is not None and order.zone is not None:
        distance = zone_size(order, move, None, drive.sliding).extended or distance
    if fraction is not None:
        return 1.0 - fraction
    whole = float(move.geometry.distance(np.array([1.0]))[0])
    if distance is None or whole <= 0.0:
        return 1.0
    if not (move.controller.corner_whole and move.span[0] <= 0.0 and whole > distance):
        distance = min(distance, MOST * whole)
    return move.geometry.fraction_at(whole - distance)

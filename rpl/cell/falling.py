"""Where a part comes to rest that is let go.

It falls to the surface below it, bounces with the product of both restitution coefficients, and wanders off sideways to
at most a distance that grows with the energy of its fall; what it falls on next may be another surface, or another
part. How it lies in the end is one of the stable states of its form. These are the rules of the textbook's system
(Craig, Introduction to Robotics, ch. 13; M, at second hand): not dynamics but their outcome, drawn from the seed of the
cell.

The height of one body above another is exact for facets: it is least where a corner is over a face, a face over a
corner, or an edge over an edge.
"""

from __future__ import annotations

import math
import random
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import cached_property, lru_cache

import numpy as np
from numpy.typing import NDArray

from rpl.cell.layout import Fixture, Part
from rpl.cell.shapes import Facets, Shape, moved
from rpl.emulator.rotations import FloatArray, invert_pose, quaternion_to_matrix, rotation_z

GRAVITY_MM_S2 = 9806.65
# How deep a part may be pressed into what it stands on, as programs do that place it.
PRESSED_MM = 3.0
# A part that falls less than this stays as it is.
SET_DOWN_MM = 1.0
_LEAST_BOUNCE_MM = 1.0
_MOST_BOUNCES = 12
_MOST_RINGS = 16
_SKIN_MM = 0.01
_UPRIGHT_MM = 1e-6
_MOST_PAIRS = 1_000_000  # of edges that are crossed at once


@dataclass(frozen=True, eq=False)
class Obstacle:
    """What a part can fall on: triangles (m, 3, 3) in the cell."""

    name: str
    triangles: FloatArray
    restitution: float
    fixture: Fixture | None = None

    @cached_property
    def bounds(self) -> FloatArray:
        """Lowest and highest corner (2, 3)."""
        corners = self.triangles.reshape(-1, 3)
        return np.stack([corners.min(axis=0), corners.max(axis=0)])

    @cached_property
    def points(self) -> FloatArray:
        """Its corners (k, 3), each once."""
        return np.unique(np.round(self.triangles.reshape(-1, 3), 6), axis=0)

    @cached_property
    def edges(self) -> FloatArray:
        """Both ends of its edges (k, 2, 3), each edge once, without those that are upright."""
        ends = np.concatenate([self.triangles[:, [0, 1]], self.triangles[:, [1, 2]], self.triangles[:, [2, 0]]])
        ends = np.round(ends, 6)
        swapped = ends[:, ::-1]
        ordered = np.where(_before(ends[:, 0], ends[:, 1])[:, None, None], ends, swapped)
        single = np.unique(ordered.reshape(-1, 6), axis=0).reshape(-1, 2, 3)
        return np.asarray(single[np.abs(single[:, 1, :2] - single[:, 0, :2]).max(axis=1) > _UPRIGHT_MM])


@dataclass(frozen=True, slots=True, eq=False)
class Stop:
    """A part on its way: at `after_s` it is at a pose (4, 4). `on`: what it touches there; "" where nothing is."""

    after_s: float
    pose: FloatArray
    on: str


@dataclass(frozen=True, slots=True)
class Laws:
    """Of the cell: see Layout.scatter and Layout.tangle."""

    scatter: float = 0.0
    tangle: float = 0.0


def obstacle_of(part: Part, pose: FloatArray) -> Obstacle:
    """A part that lies at a pose (4, 4) in the cell."""
    return Obstacle(part.name, triangles_at(part.shape.facets, pose), part.restitution)


def obstacles_of(fixture: Fixture) -> Iterator[Obstacle]:
    """The bodies of a fixture."""
    for body in fixture.bodies:
        yield Obstacle(fixture.name, triangles_at(body.shape.facets, body.at), fixture.restitution, fixture)


def triangles_at(facets: Facets, pose: FloatArray) -> FloatArray:
    """The triangles (m, 3, 3) of a body that stands at a pose (4, 4)."""
    return np.asarray(moved(facets.vertices, pose)[facets.faces])


@dataclass(frozen=True, slots=True, eq=False)
class Below:
    """What is under a part, and by how many mm; negative where it is pressed in."""

    gap_mm: float
    obstacle: Obstacle


def below(shape: Shape, pose: FloatArray, obstacles: Sequence[Obstacle]) -> Below | None:
    """The first thing that a part meets which sinks from a pose (4, 4); None where nothing is under it."""
    own = Obstacle("", _narrowed(triangles_at(shape.facets, pose)), 0.0)
    low, high = own.bounds
    best: Below | None = None
    for one in obstacles:
        least, most = one.bounds
        if (least[:2] > high[:2]).any() or (most[:2] < low[:2]).any() or least[2] > low[2] + PRESSED_MM:
            continue
        if best is not None and low[2] - most[2] > best.gap_mm:
            continue
        gap = min(_gap(own.points, one.triangles, 1.0), _gap(one.points, own.triangles, -1.0), _crossed(own, one))
        if gap < math.inf and (best is None or gap < best.gap_mm):
            best = Below(gap, one)
    return best


def _narrowed(triangles: FloatArray) -> FloatArray:
    """A part without the skin of its sides: what it touches there is not below it."""
    corners = triangles.reshape(-1, 3)
    low, high = corners.min(axis=0)[:2], corners.max(axis=0)[:2]
    thin = triangles.copy()
    thin[..., :2] = (low + high) / 2.0 + (thin[..., :2] - (low + high) / 2.0) * (1.0 - 2.0 * _SKIN_MM / (high - low))
    return thin


def _before(first: FloatArray, second: FloatArray) -> NDArray[np.bool_]:
    """Which of points (k, 3) come before those of another list, by x, then y, then z."""
    differs = first != second
    axis = np.argmax(differs, axis=1)
    rows = np.arange(len(first))
    return np.asarray(first[rows, axis] < second[rows, axis])


def _crossed(upper: Obstacle, lower: Obstacle) -> float:
    """The least height of edges of one body over edges of another that they cross, seen from above."""
    low = np.maximum(upper.bounds[0], lower.bounds[0])[:2]
    high = np.minimum(upper.bounds[1], lower.bounds[1])[:2]
    over, under = (_within(one.edges, low, high) for one in (upper, lower))
    if not len(over) or not len(under):
        return math.inf
    size = max(_MOST_PAIRS // len(under), 1)
    return min(_crossings(over[start : start + size], under) for start in range(0, len(over), size))


def _within(edges: FloatArray, low: FloatArray, high: FloatArray) -> FloatArray:
    flat = edges[:, :, :2]
    return np.asarray(edges[((flat.max(axis=1) >= low) & (flat.min(axis=1) <= high)).all(axis=1)])


def _crossings(over: FloatArray, under: FloatArray) -> float:
    p, r = over[:, None, 0], over[:, None, 1] - over[:, None, 0]
    q, u = under[None, :, 0], under[None, :, 1] - under[None, :, 0]
    across = r[..., 0] * u[..., 1] - r[..., 1] * u[..., 0]
    inverse = 1.0 / np.where(np.abs(across) > 1e-9, across, np.inf)
    x, y = q[..., 0] - p[..., 0], q[..., 1] - p[..., 1]
    s = (x * u[..., 1] - y * u[..., 0]) * inverse
    t = (x * r[..., 1] - y * r[..., 0]) * inverse
    gaps = p[..., 2] + s * r[..., 2] - q[..., 2] - t * u[..., 2]
    met = (inverse != 0.0) & (s >= 0.0) & (s <= 1.0) & (t >= 0.0) & (t <= 1.0) & (gaps >= -PRESSED_MM)
    return float(np.where(met, gaps, math.inf).min())


def _gap(points: FloatArray, triangles: FloatArray, way: float) -> float:
    """The least height of points over triangles (`way` 1), or of triangles over points (-1); infinite for none."""
    low, high = triangles.reshape(-1, 3).min(axis=0), triangles.reshape(-1, 3).max(axis=0)
    points = points[((points[:, :2] >= low[:2]) & (points[:, :2] <= high[:2])).all(axis=1)]
    a, b, c = (triangles[:, place] for place in range(3))
    across = (b[:, 0] - a[:, 0]) * (c[:, 1] - a[:, 1]) - (b[:, 1] - a[:, 1]) * (c[:, 0] - a[:, 0])
    flat = np.abs(across) > 1e-9  # seen from above it is no line
    a, b, c, across = a[flat], b[flat], c[flat], across[flat]
    if not len(points) or not len(a):
        return math.inf
    x, y = points[:, 0, None] - a[None, :, 0], points[:, 1, None] - a[None, :, 1]
    u = (x * (c[:, 1] - a[:, 1]) - y * (c[:, 0] - a[:, 0])) / across
    v = (y * (b[:, 0] - a[:, 0]) - x * (b[:, 1] - a[:, 1])) / across
    height = a[:, 2] + u * (b[:, 2] - a[:, 2]) + v * (c[:, 2] - a[:, 2])
    gaps = way * (points[:, 2, None] - height)
    met = (u >= -1e-9) & (v >= -1e-9) & (u + v <= 1.0 + 1e-9) & (gaps >= -PRESSED_MM)
    return float(np.where(met, gaps, math.inf).min())


# ---- the way down


def fall(
    part: Part, pose: FloatArray, obstacles: Sequence[Obstacle], laws: Laws, chance: random.Random
) -> tuple[Stop, ...]:
    """The stops of a part that is let go at a pose (4, 4), each a touch of something, the last one its rest.

    A last stop on nothing (`on` is ""): there is nothing below, and it is lost.
    """
    under = below(part.shape, pose, obstacles)
    if under is None:
        return (_lost(pose, 0.0),)
    if under.gap_mm < SET_DOWN_MM:
        return (Stop(0.0, _sunk(pose, under.gap_mm), under.obstacle.name),)
    stops: list[Stop] = []
    time, height = 0.0, under.gap_mm
    holder = _bin_around(pose, obstacles)
    here = _kept_in(part, _in_its_state(part, pose, height, chance), holder)
    reach = laws.scatter * height
    for _ in range(_MOST_BOUNCES):
        under = below(part.shape, here, obstacles)
        if under is None:
            return (*stops, _lost(here, time))
        time += math.sqrt(2.0 * max(under.gap_mm, 0.0) / GRAVITY_MM_S2)
        here = _sunk(here, under.gap_mm)
        stops.append(Stop(time, here, under.obstacle.name))
        height = (part.restitution * under.obstacle.restitution) ** 2 * max(under.gap_mm, 0.0)
        if height < _LEAST_BOUNCE_MM:
            break
        time += math.sqrt(2.0 * height / GRAVITY_MM_S2)
        there = _kept_in(part, _aside(here, height, reach, chance), holder)
        here = there if _is_free(part.shape, there, obstacles) else _sunk(here, -height)
    return (*stops[:-1], _settled(part, stops[-1], obstacles, laws, chance))


def _lost(pose: FloatArray, time: float) -> Stop:
    """A second later, so far down as it falls in it."""
    return Stop(time + 1.0, _sunk(pose, GRAVITY_MM_S2 / 2.0), "")


def _sunk(pose: FloatArray, by_mm: float) -> FloatArray:
    lower = pose.copy()
    lower[2, 3] -= by_mm
    return lower


def _aside(pose: FloatArray, height: float, reach: float, chance: random.Random) -> FloatArray:
    """Up by `height`, and to a place within `reach` that is as likely as any other."""
    away, way = reach * math.sqrt(chance.random()), 2.0 * math.pi * chance.random()
    moved_ = _sunk(pose, -height)
    moved_[0, 3] += away * math.cos(way)
    moved_[1, 3] += away * math.sin(way)
    return moved_


def _is_free(shape: Shape, pose: FloatArray, obstacles: Sequence[Obstacle]) -> bool:
    """Does the part stand in nothing? Looked at from above everything."""
    lift = max(float(one.bounds[1, 2]) for one in obstacles) - float(moved(shape.facets.vertices, pose)[:, 2].min())
    if lift <= 0.0:
        return True
    under = below(shape, _sunk(pose, -lift), obstacles)
    return under is None or under.gap_mm >= lift


def _in_its_state(part: Part, pose: FloatArray, drop_mm: float, chance: random.Random) -> FloatArray:
    """The part about its centre of mass in the stable state that it will come to, its middle where it was.

    From a drop of its largest dimension on it has forgotten how it was held; from less it is turned about the vertical
    by as much less.
    """
    states = states_of(part.shape)
    size = float(np.ptp(part.shape.facets.bounds, axis=0).max())
    share = min(drop_mm / size, 1.0)
    drawn, total = chance.random(), 0.0
    nearest = max(states, key=lambda state: float(state.rotation[2] @ pose[2, :3]))
    rotation = nearest.rotation
    for state in states if drawn < share else ():
        total += state.probability
        if drawn < share * total:
            rotation = state.rotation
            break
    centre = part.shape.facets.centre
    turn = share * math.pi * (2.0 * chance.random() - 1.0)
    lying = np.eye(4)
    lying[:3, :3] = rotation_z(turn + _yaw(pose[:3, :3], rotation)) @ rotation
    lying[:3, 3] = pose[:3, :3] @ centre + pose[:3, 3] - lying[:3, :3] @ centre
    # As high as it was held: turning must not push it through what is below.
    lift = moved(part.shape.facets.vertices, pose)[:, 2].min() - moved(part.shape.facets.vertices, lying)[:, 2].min()
    lying[2, 3] += lift
    return lying


def _yaw(held: FloatArray, lying: FloatArray) -> float:
    """By how much about the vertical a state is to be turned to lie most like it was held: the angle that brings the
    traces of both rotations together."""
    apart = held @ lying.T
    return math.atan2(float(apart[1, 0] - apart[0, 1]), float(apart[0, 0] + apart[1, 1]))


def _bin_around(pose: FloatArray, obstacles: Sequence[Obstacle]) -> Fixture | None:
    """The bin into which a part falls, or in which it is."""
    for fixture in {id(one.fixture): one.fixture for one in obstacles}.values():
        if fixture is not None and fixture.inside is not None:
            x, y, _ = (invert_pose(fixture.floor) @ pose)[:3, 3]
            if abs(x) <= fixture.inside[0] / 2.0 and abs(y) <= fixture.inside[1] / 2.0:
                return fixture
    return None


def _kept_in(part: Part, pose: FloatArray, fixture: Fixture | None) -> FloatArray:
    """In a bin no part leaves its inside."""
    if fixture is None or fixture.inside is None:
        return pose
    back = invert_pose(fixture.floor) @ pose
    corners = moved(part.shape.facets.vertices, back)
    low, high = corners.min(axis=0), corners.max(axis=0)
    for axis in range(2):
        half = fixture.inside[axis] / 2.0
        room = (-half - low[axis], half - high[axis])
        if room[0] <= room[1]:
            back[axis, 3] += min(max(0.0, room[0]), room[1]) if room[0] > 0.0 or room[1] < 0.0 else 0.0
    return np.asarray(fixture.floor @ back)


def _settled(part: Part, stop: Stop, obstacles: Sequence[Obstacle], laws: Laws, chance: random.Random) -> Stop:
    """A part that lies on another one stays there where that carries its centre of mass and they tangle; else it slides
    to the nearest free place, or where there is none, to the lowest."""
    hit = next(one for one in obstacles if one.name == stop.on)
    if hit.fixture is not None or (chance.random() < laws.tangle and _is_carried(part, stop.pose, hit)):
        return stop
    return _beside(part, stop, obstacles) or stop


def _is_carried(part: Part, pose: FloatArray, hit: Obstacle) -> bool:
    """Is the centre of mass over what the part lies on?"""
    centre = pose[:3, :3] @ part.shape.facets.centre + pose[:3, 3]
    return bool(((centre[:2] >= hit.bounds[0, :2]) & (centre[:2] <= hit.bounds[1, :2])).all())


def _beside(part: Part, stop: Stop, obstacles: Sequence[Obstacle]) -> Stop | None:
    """The nearest place around where the part's box lies over a fixture and over no other part, by rings of growing
    radius; else the place whose parts are lowest. None where every place is beyond the fixture."""
    others = [one for one in obstacles if one.fixture is None]
    lowest = np.array([one.bounds[0] for one in others])
    highest = np.array([one.bounds[1] for one in others])
    corners = moved(part.shape.facets.vertices, stop.pose)
    low, high = corners.min(axis=0), corners.max(axis=0)
    places = _rings(max(float((high - low)[:2].min()) / 2.0, 1.0))
    apart = (low[None, None, :2] + places[:, None] >= highest[None, :, :2] - 1e-6) | (
        high[None, None, :2] + places[:, None] <= lowest[None, :, :2] + 1e-6
    )
    tops = np.where(apart.any(axis=2), -math.inf, highest[None, :, 2]).max(axis=1)
    floor = _bin_around(stop.pose, obstacles)
    fitting = _fits_in(corners, floor, places) if floor is not None else np.ones(len(places), dtype=bool)
    for number in np.argsort(np.where(fitting, tops, math.inf), kind="stable"):
        if not fitting[number] or tops[number] >= low[2] - SET_DOWN_MM:
            break
        there = _sunk(stop.pose, -float(high[2] - low[2]))
        there[:2, 3] += places[number]
        under = below(part.shape, there, obstacles)
        if under is not None:
            return Stop(stop.after_s + 0.1, _sunk(there, under.gap_mm), under.obstacle.name)
    return None


def _fits_in(corners: FloatArray, bin_: Fixture, places: FloatArray) -> NDArray[np.bool_]:
    """Is a part of these corners (n, 3) within the walls of a bin when it is moved by each of places (k, 2)?"""
    assert bin_.inside is not None
    back = invert_pose(bin_.floor)
    here = moved(corners, back)
    ways = places @ back[:2, :2].T
    half = np.array(bin_.inside[:2]) / 2.0 + 1e-6
    low, high = here.min(axis=0)[:2] + ways, here.max(axis=0)[:2] + ways
    return np.asarray(((low >= -half) & (high <= half)).all(axis=1))


def _rings(step: float) -> FloatArray:
    """Places (k, 2) around the origin on rings, the nearest first."""
    turns = [
        (ring * step, 2.0 * math.pi * place / (6 * ring)) for ring in range(1, _MOST_RINGS) for place in range(6 * ring)
    ]
    return np.array([(away * math.cos(way), away * math.sin(way)) for away, way in turns])


# ---- stable states


@dataclass(frozen=True, slots=True, eq=False)
class State:
    """One way to lie: the rotation (3, 3) of the part and how often it comes."""

    rotation: FloatArray
    probability: float


@lru_cache(maxsize=256)
def states_of(shape: Shape) -> tuple[State, ...]:
    """The stable states of a form, most probable first."""
    from rpl.cell.stable import stable_states

    return tuple(State(quaternion_to_matrix(one.rotation), one.probability) for one in stable_states(shape))

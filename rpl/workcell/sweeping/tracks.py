"""Pieces of bodies along a block of moments: where they are at each, and how far any point of them goes in between.

The bound of what lies between two moments is what makes the sweep safe: the way of the middle of a piece, its turn
times its radius, and twice what both bend by (their second differences), so that it holds for parts of an interval too.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import cached_property
from typing import TYPE_CHECKING, Literal

import numpy as np
from numpy.typing import NDArray

from rpl.emulator.rotations import FloatArray
from rpl.workcell.sweeping.solids import Solid
from rpl.workcell.sweeping.ways import Way

if TYPE_CHECKING:
    import coal

# A piece that no robot moves.
STILL = -1

Kind = Literal["link", "gripper", "fixture", "part"]


@dataclass(frozen=True, slots=True)
class Thing:
    """What can touch. `way`: the number of its robot, STILL for fixtures and parts; `link`: that it is or sits on."""

    name: str
    kind: Kind
    way: int = STILL
    link: int = 0


@dataclass(frozen=True, slots=True, eq=False)
class Piece:
    """A solid of a thing for a time. `way`: the number of the robot whose `link` it goes with, STILL where it stands;
    `at` (4, 4): where its frame is in that link, or in the cell. `holder`: the gripper that holds it."""

    thing: int
    solid: Solid
    way: int
    link: int
    at: FloatArray
    start_s: float
    end_s: float
    holder: str = ""


@dataclass(frozen=True, slots=True, eq=False)
class Frames:
    """Poses (k, 4, 4) of a link; `turn` (k - 1,): by how much it turns in each interval, as the way of a point at a
    distance of 1, and `bend` how much that may deviate in between."""

    poses: FloatArray
    turn: FloatArray
    bend: FloatArray


@dataclass(frozen=True, slots=True, eq=False)
class Block:
    """Moments (k,) with the poses of the links of each robot (k, links + 1, 4, 4) in the cell; `driven` (k - 1,) of
    each: the number of the leg between two moments, -1 where it stands; `known`: what was worked out of them."""

    times: FloatArray
    links: tuple[FloatArray, ...]
    driven: tuple[NDArray[np.int64], ...]
    known: dict[tuple[int, int, int], Frames] = field(default_factory=dict)

    def frames(self, way: int, link: int, seen_from: int = STILL) -> Frames:
        """Where a link is: in the cell, or seen from another link of the same robot."""
        if (way, link, seen_from) not in self.known:
            poses = self.links[way][:, link]
            if seen_from != STILL:
                poses = _seen_from(self.links[way][:, seen_from], poses)
            chord, bend = _steps(poses[:, :3, :3].reshape(-1, 9), self.times, self.driven[way])
            self.known[way, link, seen_from] = Frames(poses, chord / np.sqrt(2.0), bend / np.sqrt(2.0))
        return self.known[way, link, seen_from]


def block_of(ways: tuple[Way, ...], times: FloatArray) -> Block:
    """The poses of all robots at moments (k,)."""
    middles = (times[1:] + times[:-1]) / 2.0
    driven = []
    for way in ways:
        numbers = np.searchsorted(way.starts, middles, side="right") - 1
        inside = numbers >= 0
        inside[inside] = middles[inside] <= way.ends[numbers[inside]]
        driven.append(np.where(inside, numbers, -1))
    return Block(times, tuple(way.links(times) for way in ways), tuple(driven))


@dataclass(eq=False)
class Track:
    """A piece at the moments `first` to `last` of a block. `centre` (m, 3) and `half` (m, 3): the box along the axes of
    the cell (or of the link that it is seen from) that holds it; `bound` (m - 1,): how far any point of it goes between
    two moments. A piece that stands (`still`) has one row."""

    piece: Piece
    first: int
    last: int
    rotation: FloatArray
    position: FloatArray
    centre: FloatArray
    half: FloatArray
    bound: FloatArray
    still: bool
    transforms: dict[int, coal.Transform3s] = field(default_factory=dict)

    def row(self, knot: int) -> int:
        """Of a moment of the block."""
        return 0 if self.still else knot - self.first

    def transform(self, knot: int) -> coal.Transform3s:
        """The pose at a moment as coal takes it."""
        row = 0 if self.still else knot - self.first
        found = self.transforms.get(row)
        if found is None:
            import coal

            found = self.transforms[row] = coal.Transform3s(self.rotation[row], self.position[row])
        return found

    @cached_property
    def corners(self) -> FloatArray:
        """Lowest and highest corner (2, 3) of all the way, the intervals as well."""
        grown = float(self.bound.max()) if len(self.bound) else 0.0
        return np.stack([(self.centre - self.half).min(axis=0) - grown, (self.centre + self.half).max(axis=0) + grown])


def track_of(piece: Piece, block: Block, first: int, last: int, stands: bool, seen_from: int = STILL) -> Track:
    """A piece at the moments first to last (inclusive) of a block. `stands`: whatever carries it does not move, in the
    cell or seen from another link of its robot."""
    solid = piece.solid
    frames = None
    if piece.way == STILL or seen_from == piece.link:
        poses = piece.at[None]
    elif stands:
        poses = (block.links[piece.way][first, piece.link] @ piece.at)[None]
    else:
        frames = block.frames(piece.way, piece.link, seen_from)
        poses = frames.poses[first : last + 1] @ piece.at
    rotation, position = np.ascontiguousarray(poses[:, :3, :3]), np.ascontiguousarray(poses[:, :3, 3])
    centre = position + rotation @ solid.middle
    half = np.abs(rotation) @ solid.half + solid.round_mm
    bound = np.zeros(0)
    if frames is not None:
        chord, bend = _steps(centre, block.times[first : last + 1], block.driven[piece.way][first:last])
        turn, turning = frames.turn[first:last], frames.bend[first:last]
        bound = chord + solid.radius * turn + 2.0 * (bend + solid.radius * turning)
    return Track(piece, first, last, rotation, position, centre, half, bound, frames is None)


def _seen_from(frames: FloatArray, poses: FloatArray) -> FloatArray:
    """Poses (k, 4, 4) in frames (k, 4, 4)."""
    back = np.ascontiguousarray(frames[:, :3, :3].transpose(0, 2, 1))
    found = np.zeros_like(poses)
    found[:, 3, 3] = 1.0
    found[:, :3, :3] = back @ poses[:, :3, :3]
    found[:, :3, 3] = (back @ (poses[:, :3, 3] - frames[:, :3, 3])[:, :, None])[:, :, 0]
    return found


def _steps(values: FloatArray, times: FloatArray, driven: NDArray[np.int64]) -> tuple[FloatArray, FloatArray]:
    """How far values (k, c) go in each interval (k - 1,), and how far they may be off the straight way in between.

    The deviation of a curve from its chord is at most h^2/8 of its second derivative, which is taken from the second
    differences at both ends within the same leg, doubled. A leg of one interval may bend by half its chord.
    """
    spans = np.maximum(np.diff(times), 1e-12)
    ways = np.diff(values, axis=0)
    chord = np.sqrt((ways * ways).sum(axis=1))
    chord[driven < 0] = 0.0
    within = (driven[1:] == driven[:-1]) & (driven[1:] >= 0)
    rates = ways / spans[:, None]
    second = np.sqrt((np.diff(rates, axis=0) ** 2).sum(axis=1)) * 2.0 / (spans[1:] + spans[:-1])
    at_ends = np.concatenate([[0.0], np.where(within, second, 0.0), [0.0]])
    known = np.concatenate([[False], within]) | np.concatenate([within, [False]])
    bend = np.where(known, np.maximum(at_ends[1:], at_ends[:-1]) * spans * spans / 4.0, chord / 2.0)
    bend[driven < 0] = 0.0
    return chord, bend

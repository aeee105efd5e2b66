"""Collisions of a run of a cell: who with whom, where, when, how deep, and at which line; and what came near.

`find_collisions` sweeps all pairs of bodies along the ways that the robots drove (see rpl.workcell.sweeping), so that
nothing is passed over however fast it goes, and no answer depends on the step at which the run is looked at.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, field
from itertools import product
from typing import TYPE_CHECKING

import numpy as np

from rpl.emulator.rotations import FloatArray
from rpl.errors import UsageError
from rpl.source import NOWHERE, Origin
from rpl.workcell.record import CellRun
from rpl.workcell.sweeping.scene import Meeting, Scene, scene_of
from rpl.workcell.sweeping.sweep import (
    COARSE_MM,
    FINE_MM,
    TOUCH_MM,
    Contact,
    Least,
    Meter,
    PairSweep,
    sharpened,
)
from rpl.workcell.sweeping.tracks import STILL, Block, Piece, Track, block_of, track_of
from rpl.workcell.sweeping.ways import Way, knots

if TYPE_CHECKING:
    from rpl.runtime.values import Value

# The step at which the run is looked at first; what lies between is bounded, not left out.
STEP_S = 0.004
# A held part may be this deep in what it touches as it is taken up or put down.
REST_MM = 1.0
# Moments that are looked at in one go.
BLOCK = 8192
# Collisions, and near misses, that are printed; one often has others in its train.
_MOST_SHOWN = 10
# Moments of one window of boxes.
WINDOW = 64
# Contacts that are this near to each other are one, and one that a grasp is this near to belongs to it.
ONE_S = 1e-3


@dataclass(frozen=True, slots=True, eq=False)
class Collision:
    """Two things touch. `t` to `until_s`; `at_mm` (3,) in the cell where they do first; `depth_mm`: the deepest, at
    `deepest_s`. `origin`: the line of the move that is driven at `t`; `other_origin` that of the other robot, where two
    are driven."""

    t: float
    until_s: float
    a: str
    b: str
    at_mm: tuple[float, float, float]
    depth_mm: float
    deepest_s: float
    origin: Origin = NOWHERE
    other_origin: Origin | None = None

    def as_json(self) -> dict[str, Value]:
        found: dict[str, Value] = {
            "t": round(self.t, 4),
            "a": self.a,
            "b": self.b,
            "file": self.origin.file,
            "line": self.origin.line,
            "depth_mm": round(self.depth_mm, 3),
            "until": round(self.until_s, 4),
            "at_mm": [round(value, 2) for value in self.at_mm],
        }
        if self.other_origin is not None:
            found["other_file"], found["other_line"] = self.other_origin.file, self.other_origin.line
        return found


@dataclass(frozen=True, slots=True, eq=False)
class Near:
    """The least distance of two things that never touch, where it is below the cell's `near_mm`."""

    t: float
    a: str
    b: str
    at_mm: tuple[float, float, float]
    distance_mm: float
    origin: Origin = NOWHERE

    def as_json(self) -> dict[str, Value]:
        return {
            "t": round(self.t, 4),
            "a": self.a,
            "b": self.b,
            "file": self.origin.file,
            "line": self.origin.line,
            "distance_mm": round(self.distance_mm, 3),
            "at_mm": [round(value, 2) for value in self.at_mm],
        }


@dataclass(frozen=True, slots=True)
class Collisions:
    """What the search has found, by time. `notes`: what is assumed of the bodies, and what was not looked at."""

    collisions: tuple[Collision, ...] = ()
    near: tuple[Near, ...] = ()
    notes: tuple[str, ...] = ()

    def as_json(self) -> dict[str, Value]:
        return {
            "collisions": [one.as_json() for one in self.collisions],
            "near": [one.as_json() for one in self.near],
            "notes": list(self.notes),
        }

    def lines(self) -> Iterator[str]:
        """For people."""
        for one in self.collisions[:_MOST_SHOWN]:
            x, y, z = one.at_mm
            where = f"{one.origin.file}:{one.origin.line}: " if one.origin.source else ""
            depth = f"{one.depth_mm:.1f} mm deep, at ({x:.0f}, {y:.0f}, {z:.0f})"
            yield f"{one.t:9.3f} s  {where}{one.a} collides with {one.b} until {one.until_s:.3f} s, {depth}"
        if (more := len(self.collisions) - _MOST_SHOWN) > 0:
            yield f"           and {more} more (--json has them all)"
        for near in sorted(self.near, key=lambda one: one.distance_mm)[:_MOST_SHOWN]:
            where = f"{near.origin.file}:{near.origin.line}: " if near.origin.source else ""
            yield f"{near.t:9.3f} s  {where}{near.a} comes within {near.distance_mm:.1f} mm of {near.b}"
        if (more := len(self.near) - _MOST_SHOWN) > 0:
            yield f"           and {more} more near misses"
        if not self.collisions:
            yield "no collision was found"
        yield from (f"note: {note}" for note in self.notes)


def find_collisions(
    run: CellRun, step_s: float = STEP_S, on_progress: Callable[[float], None] | None = None
) -> Collisions:
    """All collisions and near misses of a run. `step_s`: at which moments it is looked at first, which changes the time
    that the search takes and not what it finds; `on_progress` is told the share of the run that is done.

    Raises UsageError where Pinocchio or coal is not installed.
    """
    scene = scene_of(run)
    search = _Search(scene, list(scene.meetings()))
    more = [one.t for one in run.placed]
    moments = knots(scene.ways, more, scene.end_s, step_s)
    for first in range(0, len(moments) - 1, BLOCK):
        search.block(moments[first : first + BLOCK + 1])
        if on_progress is not None:
            on_progress(min(1.0, (first + BLOCK) / len(moments)))
    return search.result()


def distance_over_time(run: CellRun, a: str, b: str, times: Sequence[float]) -> FloatArray:
    """The signed distance (k,) in mm of two things at moments (k,) s, whatever may touch; NaN where one is not there.

    Raises UsageError for a name that there is not, and where Pinocchio or coal is not installed.
    """
    scene = scene_of(run)
    names = {thing.name: number for number, thing in enumerate(scene.things)}
    for name in (a, b):
        if name not in names:
            raise UsageError(f"nothing of the cell is called '{name}': there are {', '.join(names)}")
    ours, theirs = ([piece for piece in scene.pieces if piece.thing == names[name]] for name in (a, b))
    meter, found = Meter(scene.ways), np.full(len(times), np.nan)
    for row, t in enumerate(times):
        there = ([piece for piece in one if piece.start_s <= t <= piece.end_s] for one in (ours, theirs))
        pairs = product(*there)
        found[row] = min((meter.at(first, second, float(t)) for first, second in pairs), default=np.nan)
    return found


@dataclass
class _Pair:
    """What is found of one meeting."""

    meeting: Meeting
    level_mm: float
    least: Least | None
    contacts: list[Contact] = field(default_factory=list)


class _Search:
    def __init__(self, scene: Scene, meetings: Sequence[Meeting]) -> None:
        self.scene = scene
        self.meter = Meter(scene.ways)
        near_mm = scene.run.layout.near_mm
        self.least: dict[tuple[int, int], Least] = {}
        self.pairs: list[_Pair] = []
        for meeting in meetings:
            rests = meeting.rests and self._rests(meeting)
            least = None
            if meeting.near and not rests and near_mm > 0.0:
                least = self.least.setdefault(self._things(meeting), Least(near_mm))
            self.pairs.append(_Pair(meeting, -REST_MM if rests else -TOUCH_MM, least))

    def _things(self, meeting: Meeting) -> tuple[int, int]:
        return meeting.first.thing, meeting.second.thing

    def _rests(self, meeting: Meeting) -> bool:
        """Do a held part and what stands touch as it is taken up or put down?"""
        start = max(meeting.first.start_s, meeting.second.start_s)
        end = min(meeting.first.end_s, meeting.second.end_s)
        return any(abs(self.meter.at(meeting.first, meeting.second, t)) <= REST_MM for t in (start, end))

    def block(self, times: FloatArray) -> None:
        """Looks at all pairs between these moments (k,)."""
        block = block_of(self.scene.ways, times)
        tracks: dict[tuple[int, int], Track | None] = {}

        def track(piece: Piece, seen_from: int) -> Track | None:
            key = (id(piece), seen_from)
            if key not in tracks:
                tracks[key] = self._track(piece, block, seen_from)
            return tracks[key]

        for pair in self.pairs:
            pieces = pair.meeting.first, pair.meeting.second
            # Two pieces of one robot: only what moves between them counts, so they are seen from the first one's link.
            seen_from = pieces[0].link if pieces[0].way == pieces[1].way else STILL
            first, second = (track(piece, seen_from) for piece in pieces)
            if first is not None and second is not None and _near(first, second, pair):
                fine_mm = COARSE_MM if pair.meeting.grips else FINE_MM
                sweep = PairSweep(self.meter, block, (first, second), pair.level_mm, pair.least, fine_mm)
                pair.contacts += sweep.contacts()

    def _track(self, piece: Piece, block: Block, seen_from: int) -> Track | None:
        """A piece in a block; None where it is not there then."""
        first = int(np.searchsorted(block.times, piece.start_s - 1e-9))
        last = int(np.searchsorted(block.times, piece.end_s + 1e-9)) - 1
        stands = seen_from == STILL and self.scene.stands(piece)
        return track_of(piece, block, first, last, stands, seen_from) if last > first else None

    def result(self) -> Collisions:
        """What was found, thing by thing."""
        found: dict[tuple[int, int], list[Contact]] = {}
        for pair in self.pairs:
            contacts = [one for one in pair.contacts if not _of_grip(one, pair.meeting.grips)]
            if contacts:
                found.setdefault(self._things(pair.meeting), []).extend(contacts)
        collisions = [self._collision(things, one) for things, contacts in found.items() for one in _merged(contacts)]
        near = [
            self._near(things, sharpened(least, self.meter.point))
            for things, least in self.least.items()
            if least.t is not None and things not in found and least.distance_mm >= -TOUCH_MM
        ]
        return Collisions(
            tuple(sorted(collisions, key=lambda one: (round(one.t, 4), one.a, one.b))),
            tuple(sorted(near, key=lambda one: (round(one.t, 4), one.a, one.b))),
            self.scene.notes,
        )

    def _collision(self, things: tuple[int, int], contact: Contact) -> Collision:
        ways = self._ways(things, contact.start_s)
        place, *others = [way.place(contact.start_s) for way in ways] or [NOWHERE]
        names = [self.scene.things[thing].name for thing in things]
        return Collision(
            contact.start_s,
            contact.end_s,
            names[0],
            names[1],
            _point(contact.point),
            contact.depth_mm,
            contact.deepest_s,
            place,
            others[0] if others else None,
        )

    def _near(self, things: tuple[int, int], least: Least) -> Near:
        t = least.t if least.t is not None else 0.0
        ways = self._ways(things, t)
        names = [self.scene.things[thing].name for thing in things]
        place = ways[0].place(t) if ways else NOWHERE
        return Near(t, names[0], names[1], _point(least.point), max(least.distance_mm, 0.0), place)

    def _ways(self, things: tuple[int, int], t: float) -> list[Way]:
        """The robots that move the two at a moment, those that are driven then before those that stand."""
        pieces = [piece for piece in self.scene.pieces if piece.thing in things and piece.start_s <= t <= piece.end_s]
        pieces.sort(key=lambda piece: things.index(piece.thing))
        numbers = list(dict.fromkeys(piece.way for piece in pieces if piece.way != STILL))
        ways = [self.scene.ways[number] for number in numbers]
        driven = [way for way in ways if way.moving(t)]
        return driven or ways[:1]


def _near(first: Track, second: Track, pair: _Pair) -> bool:
    """Do the boxes about the whole ways of both come near enough for a look?"""
    limit = 0.0 if pair.least is None else max(pair.least.distance_mm, 0.0)
    low, high = first.corners, second.corners
    gaps = np.maximum(np.maximum(low[0] - high[1], high[0] - low[1]), 0.0)
    return bool((gaps @ gaps) <= limit * limit)


def _of_grip(contact: Contact, grips: Sequence[float]) -> bool:
    return any(contact.start_s - ONE_S <= t <= contact.end_s + ONE_S for t in grips)


def _merged(contacts: Sequence[Contact]) -> Iterator[Contact]:
    """Contacts of the pieces of two things as contacts of the things."""
    so_far: Contact | None = None
    for one in sorted(contacts, key=lambda contact: contact.start_s):
        if so_far is not None and one.start_s <= so_far.end_s + ONE_S:
            deeper = one if one.depth_mm > so_far.depth_mm else so_far
            end = max(one.end_s, so_far.end_s)
            so_far = Contact(so_far.start_s, end, deeper.deepest_s, deeper.depth_mm, so_far.point)
            continue
        if so_far is not None:
            yield so_far
        so_far = one
    if so_far is not None:
        yield so_far


def _point(values: FloatArray) -> tuple[float, float, float]:
    x, y, z = (float(value) for value in values)
    return x, y, z

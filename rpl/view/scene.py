"""Where everything of a run is at a time: for pictures and for the live view; the page does the same in its script."""

from __future__ import annotations

from bisect import bisect_right
from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from rpl.cell.armbodies import link_poses
from rpl.cell.record import Placed, pose_between
from rpl.emulator.rotations import FloatArray
from rpl.report.screws import Screws, screws_of
from rpl.view.bodies import Drawn, bodies_of, robot_of
from rpl.view.tracks import Track, track_of

if TYPE_CHECKING:
    from rpl.workcell.collisions import Collision
    from rpl.workcell.record import CellRun


# So long (s) before and behind it a collision is shown.
SEEN_S = 0.25


@dataclass(frozen=True, slots=True, eq=False)
class Scene:
    """A run with all that is needed to draw it. `places`: of each part by time."""

    run: CellRun
    bodies: tuple[Drawn, ...]
    tracks: tuple[Track, ...]
    screws: tuple[Screws | None, ...]
    places: tuple[tuple[Placed, ...], ...]
    collisions: tuple[Collision, ...] = ()

    def base_at(self, robot: int, t: float) -> FloatArray:
        """The base (4, 4) of a robot in the cell, where its track has it at a time."""
        carried = self.tracks[robot].base_at(t)
        return self.run.robots[robot].place.base if carried is None else carried

    def links_at(self, robot: int, joints: FloatArray, t: float) -> FloatArray:
        """The frames of a robot's links (links + 1, 4, 4) in the cell."""
        run = self.run.robots[robot]
        assert run.model is not None
        return np.asarray(self.base_at(robot, t) @ link_poses(run.model, joints[None])[0])

    def flange_at(self, robot: int, joints: FloatArray, t: float) -> FloatArray:
        """The flange (4, 4) of a robot in the cell."""
        run = self.run.robots[robot]
        assert run.model is not None
        return np.asarray(self.base_at(robot, t) @ run.model.forward(joints))

    def joints_at(self, t: float) -> list[FloatArray | None]:
        """Joints of all robots at a time; None for those without a model."""
        return [
            track.joints_at(t) if screws is not None else None
            for track, screws in zip(self.tracks, self.screws, strict=True)
        ]

    def poses_at(self, t: float, joints: Sequence[FloatArray | None] | None = None) -> list[FloatArray | None]:
        """The pose (4, 4) in the cell of each of the bodies at a time, None of what is not there; `joints` in place of
        those of the run."""
        given = self.joints_at(t) if joints is None else joints
        links = [None if q is None else self.links_at(number, q, t) for number, q in enumerate(given)]
        parts = self._parts_at(t, given)
        found: list[FloatArray | None] = []
        for body in self.bodies:
            carried = links[body.robot] if body.robot >= 0 else None
            if body.part >= 0:
                found.append(parts[body.part])
            elif carried is None:
                found.append(body.at)
            else:
                found.append(carried[body.link] @ self._opened(body, t))
        return found

    def collisions_at(self, t: float) -> list[Collision]:
        """Those that are shown at a time."""
        return [one for one in self.collisions if one.t - SEEN_S < t < one.until_s + SEEN_S]

    def _parts_at(self, t: float, joints: Sequence[FloatArray | None]) -> list[FloatArray | None]:
        run = self.run
        found: list[FloatArray | None] = []
        holders = {one.name: robot_of(run, one.robot) for one in run.layout.grippers}
        for places in self.places:
            number = bisect_right(places, t + 1e-9, key=lambda one: one.t)
            if number == 0 or places[number - 1].state == "gone":  # it has not come yet, or was taken away
                found.append(None)
                continue
            here = places[number - 1]
            pose, holder = pose_between(places[number - 1 : number + 1], max(t, here.t))
            if holder and (held := joints[holders[holder]]) is not None:
                pose = self.flange_at(holders[holder], held, t) @ pose
            found.append(pose)
        return found

    def _opened(self, body: Drawn, t: float) -> FloatArray:
        """The place of a body on its link; a jaw is half of the opening from the middle."""
        if body.way is None:
            return body.at
        shifted = body.at.copy()
        shifted[:3, 3] += body.way * (self.width_at(body.gripper, t) / 2.0 - body.rest_mm)
        return shifted

    def width_at(self, gripper: int, t: float) -> float:
        """How far the jaws of a gripper are apart, mm."""
        found = self.run.layout.grippers[gripper]
        width = first_width(found.opening)
        for one in self.run.openings:
            if one.gripper == found.name and one.t <= t + 1e-9:
                width = one.width_mm
        return width


def _places_in(run: CellRun) -> tuple[tuple[Placed, ...], ...]:
    """Of each part its places by time. One that the run says nothing of rests where the cell has it, unless a feeder
    brings it."""
    found: dict[str, list[Placed]] = {}
    for one in run.placed:
        found.setdefault(one.part, []).append(one)
    for part in run.layout.parts:
        if part.again_s is None:
            found.setdefault(part.name, [Placed(0.0, part.name, "rests", part.at)])
    return tuple(tuple(found.get(part.name, ())) for part in run.layout.parts)


def first_width(opening: tuple[float, float]) -> float:
    """What jaws are drawn at before anything is known: open, but not wider than looks like a gripper."""
    return float(min(opening[1], 120.0))


def scene_of(run: CellRun, collisions: Sequence[Collision] = ()) -> Scene:
    """All that is needed to draw a run."""
    screws = tuple(None if one.model is None else screws_of(one.model) for one in run.robots)
    tracks = tuple(track_of(one) for one in run.robots)
    return Scene(run, bodies_of(run), tracks, screws, _places_in(run), tuple(collisions))

"""The interactive screen without a screen: what buttons, the gizmo and clicks do, in plain Python.

A run is played, and a person may take the arm by the hand: then joints of the hand stand in place of those of the run,
until the time is moved again. The live view (`rpl.view.live`) shows this object in a browser; tests use it without one.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from rpl.emulator.margins import limit_margins, singular_factors
from rpl.emulator.rotations import FloatArray, invert_pose, matrix_to_zyx
from rpl.errors import RplError, UsageError
from rpl.view.entering import cell_text
from rpl.view.scene import Scene
from rpl.view.teaching import Taught, Written, frame_of, written
from rpl.view.tracks import LineAt, Track, track_of

if TYPE_CHECKING:
    from rpl.emulator.model import RobotModel
    from rpl.project import ReadProgram
    from rpl.workcell.record import RobotRun

# Below these shares a joint is near its limit, a posture near a singular one.
NEAR_LIMIT, NEAR_SINGULAR = 0.03, 0.05
NATIVE = "rpl"
_MOST_SAID = 12
_PATIENCE_S = 600.0


@dataclass(frozen=True, slots=True)
class Loaded:
    """A run that is shown, and what was read for each of its robots."""

    scene: Scene
    reads: tuple[ReadProgram, ...]


@dataclass(slots=True)
class Hand:
    """The arm as a person holds it: joints (n,), or a way that it drives from `since_s` on."""

    joints: FloatArray
    way: Track | None = None
    driven_s: float = 0.0

    @property
    def now(self) -> FloatArray:
        return self.joints if self.way is None else self.way.joints_at(self.driven_s)


@dataclass(slots=True)
class Screen:
    """The state of the screen. `again` runs everything anew when a program has changed; `write` writes a file."""

    loaded: Loaded
    again: Callable[[], Loaded] | None = None
    write: Callable[[Path, bytes], None] | None = None
    time_s: float = 0.0
    speed: float = 1.0
    playing: bool = False
    until_s: float = math.inf
    robot: int = 0
    hands: dict[int, Hand] = field(default_factory=dict)
    points: dict[str, Taught] = field(default_factory=dict)
    frames: dict[str, FloatArray] = field(default_factory=dict)  # in the cell
    said: list[str] = field(default_factory=list)
    step_at: int = -1

    @property
    def scene(self) -> Scene:
        return self.loaded.scene

    @property
    def run(self) -> RobotRun:
        """The robot that the person works with."""
        return self.scene.run.robots[self.robot]

    @property
    def model(self) -> RobotModel:
        """Its arm. Raises UsageError where it has none."""
        if self.run.model is None:
            raise UsageError("there is no arm: name one with --robot")
        return self.run.model

    def say(self, text: str) -> str:
        """Keep a line for the person to read."""
        self.said = [*self.said, text][-_MOST_SAID:]
        return text

    # ---- time

    def go(self, t: float) -> None:
        """To a time of the run; the arms are there where the run has them."""
        self.time_s = min(max(t, 0.0), self.scene.run.time_s)
        self.hands.clear()
        self.step_at = -1

    def play(self, on: bool | None = None) -> None:
        """On, off, or the other of both; from the start when the run is at its end."""
        self.playing = not self.playing if on is None else on
        self.until_s = math.inf
        if self.playing:
            self.go(0.0 if self.time_s >= self.scene.run.time_s - 1e-9 else self.time_s)

    def tick(self, seconds: float) -> bool:
        """Time has passed; TRUE when something has moved."""
        moved = False
        for hand in self.hands.values():
            if hand.way is not None:
                moved, hand.driven_s = True, hand.driven_s + seconds * self.speed
                if hand.driven_s >= hand.way.times[-1]:
                    hand.joints, hand.way = hand.way.joints[-1], None
        if not self.playing:
            return moved
        end = min(self.until_s, self.scene.run.time_s)
        self.time_s = min(self.time_s + seconds * self.speed, end)
        self.step_at = -1
        self.playing = self.time_s < end
        return True

    def lines(self) -> list[LineAt]:
        """The lines of all programs by time."""
        return sorted((one for track in self.scene.tracks for one in track.lines), key=lambda one: one.t)

    def step(self, way: int) -> LineAt | None:
        """To the next line of any program (1), or the one before (-1)."""
        lines = self.lines()
        if not lines:
            return None
        self.playing = False
        here = self.step_at
        if here < 0:
            here = sum(one.t <= self.time_s + 1e-9 for one in lines) - 1
        number = min(max(here + way, 0), len(lines) - 1)
        self.go(lines[number].t)
        self.step_at = number
        return lines[number]

    def run_line(self, file: str, line: int) -> str:
        """Play a single line: from when the run comes to it (the next time, else the first) until the next line."""
        track = self.scene.tracks[self.robot]
        found = [n for n, one in enumerate(track.lines) if one.line == line and one.file.endswith(file)]
        if not found:
            raise UsageError(f"the run does not come to {file}:{line}")
        number = next((n for n in found if track.lines[n].t > self.time_s + 1e-9), found[0])
        here = track.lines[number]
        later = [one.t for one in track.lines[number + 1 :] if one.task == here.task and one.t > here.t + 1e-9]
        self.go(here.t)
        self.playing, self.until_s = True, later[0] if later else self.scene.run.time_s
        return self.say(f"{file}:{line} from {here.t:.3f} s to {self.until_s:.3f} s")

    # ---- the arm by hand

    def joints(self) -> list[FloatArray | None]:
        """Joints of all robots: by hand, else those of the run."""
        found = self.scene.joints_at(self.time_s)
        for robot, hand in self.hands.items():
            found[robot] = hand.now
        return found

    def poses(self) -> list[FloatArray | None]:
        """Of all bodies, in the cell."""
        return self.scene.poses_at(self.time_s, self.joints())

    def here(self) -> FloatArray:
        """Joints (n,) of the person's robot. Raises UsageError where it has no arm."""
        found = self.joints()[self.robot]
        if found is None:
            raise UsageError("there is no arm: name one with --robot")
        return found

    def base(self) -> FloatArray:
        """The base (4, 4) of the person's robot in the cell."""
        return self.scene.base_at(self.robot, self.time_s)

    def tool(self) -> FloatArray:
        """The tool (4, 4) on the flange of the person's robot."""
        return self.scene.tracks[self.robot].tool_at(self.time_s)

    def tool_pose(self) -> FloatArray:
        """The tool centre point (4, 4) of the person's robot in the cell."""
        return self.scene.flange_at(self.robot, self.here(), self.time_s) @ self.tool()

    def drag(self, pose: FloatArray) -> list[str]:
        """Bring the tool centre point to a pose (4, 4) of the cell, if the arm can; and what is to be said of it."""
        model, near = self.model, self.here()
        flange = invert_pose(self.base()) @ pose @ invert_pose(self.tool())
        self.playing = False
        found = model.nearest(flange, near)
        if found is None:
            return [self._why_not(flange, near)]
        self.hands[self.robot] = Hand(found)
        words = self.margins()
        if np.abs(found - near)[model.revolute].max(initial=0.0) > 90.0:
            words.append("another posture")
        return words

    def _why_not(self, flange: FloatArray, near: FloatArray) -> str:
        model = self.model
        ways = [model.nearest_turn(one.joints, near) for one in model.inverse(flange, near)]
        if not ways:
            return "out of reach"
        best = min(ways, key=lambda joints: len(model.within_limits(joints)))
        beyond = [
            f"J{axis + 1} at {best[axis]:.1f} ({model.limits[axis, 0]:.4g} to {model.limits[axis, 1]:.4g})"
            for axis in model.within_limits(best)
        ]
        return f"beyond the limits: {', '.join(beyond)}"

    def move_joint(self, axis: int, value: float) -> list[str]:
        """One joint by hand, held at its limits."""
        joints = self.here().copy()
        joints[axis] = min(max(value, self.model.limits[axis, 0]), self.model.limits[axis, 1])
        self.playing = False
        self.hands[self.robot] = Hand(joints)
        return self.margins()

    def margins(self) -> list[str]:
        """Joints near a limit, and singularities near the posture."""
        model, joints = self.model, self.here()
        words = [
            f"J{axis + 1} is {min(joints[axis] - model.limits[axis, 0], model.limits[axis, 1] - joints[axis]):.1f} "
            f"{'deg' if model.revolute[axis] else 'mm'} from its limit"
            for axis, room in enumerate(limit_margins(model, joints[None])[0])
            if room < NEAR_LIMIT
        ]
        for name, share in singular_factors(model, joints[None]).items():
            if share[0] < NEAR_SINGULAR:
                words.append(f"near the {name} singularity ({share[0]:.3f})")
        return words

    # ---- frames and points

    def frame_on(self, body: int, start: FloatArray, direction: FloatArray, name: str = "") -> FloatArray:
        """A frame where a ray of the cell meets a body: its origin on the true surface, not on the facets that are
        drawn, z outwards, x as near to the cell's x (y on a face across it) as that allows.

        Raises UsageError where the ray passes by.
        """
        pose = self.poses()[body]
        drawn = self.scene.bodies[body]
        if pose is None:
            raise UsageError(f"{drawn.name} is not there")
        back = invert_pose(pose)
        origin, way = back[:3, :3] @ start + back[:3, 3], back[:3, :3] @ direction
        met = drawn.shape.facets.pierced(origin, way / np.linalg.norm(way))
        if met is None:
            raise UsageError(f"the ray passes by {drawn.name}")
        point, normal = drawn.shape.on_surface(origin + met[0] * way / np.linalg.norm(way))
        frame = np.eye(4)
        z = pose[:3, :3] @ normal
        x = np.eye(3)[0] - z[0] * z
        if np.linalg.norm(x) < 1e-3:
            x = np.eye(3)[1] - z[1] * z
        x /= np.linalg.norm(x)
        frame[:3, :3] = np.stack([x, np.cross(z, x), z], axis=1)
        frame[:3, 3] = pose[:3, :3] @ point + pose[:3, 3]
        name = name or f"frame{len(self.frames) + 1}"
        self.frames[name] = frame
        self.say(f"{name} on {drawn.name}: {in_words(frame)}")
        return frame

    def go_to_frame(self, name: str) -> list[str]:
        """The tool onto a frame, its z against that of the frame."""
        if name not in self.frames:
            raise UsageError(f"there is no frame {name}")
        return self.drag(self.frames[name] @ np.diag([1.0, -1.0, -1.0, 1.0]))

    def teach(self, name: str) -> Taught:
        """Keep where the arm is under a name."""
        if not name.isidentifier() or not name.isascii():
            raise UsageError(f"{name!r} is no name for a point: a letter, then letters, digits and underscores")
        pose = invert_pose(self.base()) @ self.tool_pose()
        self.points[name] = Taught(name, self.here().copy(), pose, self.tool())
        self.say(f"{name}: {in_words(pose)} in the robot's base")
        return self.points[name]

    def as_rpl(self, name: str) -> str:
        """A taught point as a line of RPL."""
        frame, _ = frame_of(self.run.result, name, self.time_s)
        return self._taught(name).as_rpl(frame)

    def save(self, name: str) -> Written:
        """A taught point into the program, in its own language; then everything runs again.

        Raises UsageError or SourceError, and writes nothing, where the text has no place for it.
        """
        taught = self._taught(name)
        frame, why = frame_of(self.run.result, name, self.time_s)
        made = written(self.loaded.reads[self.robot], taught, frame)
        path = Path(made.source.path)
        if self.write is None or not path.is_file():
            raise UsageError(f"{path} is no file that can be written: here is the line: {made.text}")
        self.write(path, made.source.data)
        self.say(f"{made} ({why})")
        if self.again is not None:
            time_s, hands = self.time_s, dict(self.hands)
            self.loaded = self.again()
            self.go(time_s)
            self.hands = hands
        return made

    def _taught(self, name: str) -> Taught:
        if name not in self.points:
            raise UsageError(f"no point {name} has been taught")
        return self.points[name]

    # ---- lines that are typed

    def enter(self, text: str) -> list[str]:
        """Run statements of RPL from where the arm is; points that were taught are known by their names.

        Gives the messages, and what went wrong; the arm drives where the statements send it.
        """
        from rpl.cell import parse_cell
        from rpl.diagnostics import Diagnostics, Severity
        from rpl.project import read_sources
        from rpl.simulation import run_program
        from rpl.source import source_from_text

        diagnostics = Diagnostics()
        declared = "".join(one.as_rpl(np.eye(4)) + "\n" for one in self.points.values())
        read = read_sources([source_from_text("line", f"{declared}{text}\n")], NATIVE, diagnostics)
        if diagnostics.has_errors:
            return [self.say(item.message) for item in diagnostics.of(Severity.ERROR)]
        cell = parse_cell(cell_text(self.here(), self.tool()), "screen")
        try:
            result = run_program(read.program, self.model, cell, None, _PATIENCE_S)
        except RplError as error:
            return [self.say(str(error))]
        words = [self.say(message) for message in result.messages]
        if result.fault is not None:
            words.append(self.say(f"{result.fault.code}: {result.fault.message}"))
        way = track_of(replace(self.run, program=read.program, result=result))
        self.playing = False
        if len(way.times):
            self.hands[self.robot] = Hand(way.joints[-1], way)
        return words


def in_words(pose: FloatArray) -> str:
    """A pose as people read it."""
    place = ", ".join(f"{value:.2f}" for value in pose[:3, 3])
    turned = ", ".join(f"{value:.2f}" for value in matrix_to_zyx(pose[:3, :3]))
    return f"{place} mm; {turned} deg"

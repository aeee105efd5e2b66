"""One job as text: the header as a state machine over its points, then the instructions.

Points without a posture stand first, before any RCONF, because nothing takes an RCONF back.
"""

from __future__ import annotations

import math
import re
from collections import Counter
from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING

import numpy as np

from rpl import registry
from rpl.diagnostics import Severity, code
from rpl.writing.statements import CannotSayError
from rpl.writing.templates import Macros

from . import tables
from .cell import Cell, Kept
from .layout import laid_out
from .places import WORLD, Position, matrix, values_of
from .texts import ascii_text, fixed

if TYPE_CHECKING:
    from rpl.emulator.model import RobotModel

JOINT_ANGLE = code(
    "inform-joint-angle",
    Severity.LOSS,
    "a controller counts the joints of a position in pulses: {reason}",
    "give pulses_per_degree in a robot file of your own; the program stops there with PAUSE",
)
_STEP = re.compile(r"(?:S?MOV[JLCS]|REFP|IMOV)\b[^=]*?\bC(\d{5})\b")
_DATE = "2000/01/01 00:00"  # the same text for the same program


def winding(robot: RobotModel | None) -> bool:
    """Can an axis whose turns no RCONF shows (L, U, B) make more than one turn? A pose then does not say the joints."""
    if robot is None:
        return False
    axes = [axis for axis in tables.UNTURNED if axis < robot.axes and robot.revolute[axis]]
    return any(float(robot.limits[axis][1] - robot.limits[axis][0]) > tables.TURN_DEG for axis in axes)


@dataclass(slots=True)
class Job:
    """Header data and lines of one job. `tool`: that of positions that name none."""

    name: str
    cell: Cell
    robot: RobotModel | None = None
    tool: int = 0
    counting: bool = False  # the program calculates with joints: an arm without pulses gets a neutral scale
    lines: list[str] = field(default_factory=list)
    points: dict[Kept, int] = field(default_factory=dict)
    further: dict[int, Kept] = field(default_factory=dict)  # points of later steps that go to the same place
    positions: set[int] = field(default_factory=set)  # position variables whose values the header gives
    comment: str = ""
    entry: bool = False
    moves: bool = False

    def point_of(self, position: Position, tool: int, frame: int, wanted: int | None, name: str = "") -> str:
        """The taught point for a position; `wanted` is its number when that is free, `name` the source's."""
        if position.kind == "joints":
            frame = 0
        what = Kept(self.sayable(position, tool, taught=True), tool, frame, name)
        if what not in self.points:
            taken = set(self.points.values())
            free = next(n for n in range(tables.POINTS.last + 2) if n not in taken)
            number = free if wanted is None or wanted in taken else wanted
            if number > tables.POINTS.last:
                raise CannotSayError("there are no more numbers for points")
            self.points[what] = number
        return f"C{self.points[what]:05d}"

    def in_steps(self, lines: list[str]) -> list[str]:
        """The lines with a point of its own for each step, as controllers keep them: editing a step on the pendant
        changes its point. Where numbers run out the steps share one."""
        places = {number: kept for kept, number in self.points.items()}
        seen: set[int] = set()
        done = []
        for line in lines:
            step = _STEP.match(line)
            number = int(step[1]) if step is not None else None
            if number in seen and number in places:
                line = self.again(line, number, places[number], {*places, *self.further})
            elif number is not None:
                seen.add(number)
            done.append(line)
        return done

    def again(self, line: str, number: int, kept: Kept, taken: set[int]) -> str:
        """A step with another point at the same place, that of its external axes too."""
        free = next((n for n in range(tables.POINTS.last + 1) if n not in taken), None)
        if free is None:
            return line
        self.further[free] = kept
        self.cell.stands(self.name, kept.name, f"C{free:05d}")
        return re.sub(rf"\b([BE]?C){number:05d}\b", rf"\g<1>{free:05d}", line)

    def constant(self, position: Position, tool: int = 0, frame: int = 0, name: str = "") -> str:
        """A position variable that holds a constant."""
        if position.kind == "joints" and self.cell.value_of_tool(tool) is None:
            tool = 0  # the joints are the same with any tool; that of the flange has a known value
        number = self.cell.keep(Kept(self.sayable(position, tool), tool, frame, name))
        self.positions.add(number)
        return f"P{number:03d}"

    def flange_of(self, position: Position) -> Position:
        """The flange's pose and posture at joints."""
        if self.robot is None or any(position.external):
            return self.sayable(position, 0)
        return pose_of_joints(position, self.robot, WORLD)

    @property
    def scale(self) -> list[float] | None:
        """Pulses per degree of each axis, where the program can count joints."""
        if self.robot is None:
            return None
        counts = self.robot.pulse_scale if self.counting else self.robot.pulses_per_degree
        return None if counts is None else [float(one) for one in counts]

    @property
    def taught_scale(self) -> list[float] | None:
        """The pulses per degree of taught points: the arm's own, and a neutral scale only where a posture says too
        little."""
        own = None if self.robot is None else self.robot.pulses_per_degree
        return None if own is None and not winding(self.robot) else self.scale

    def sayable(self, position: Position, tool: int, taught: bool = False) -> Position:
        """The position as a controller can keep it: joints as pulses where they can be counted, else as a pose. Taught
        points are poses as well where pulses would be counted by a neutral scale, and a posture says enough."""
        position = self.with_counts(position, taught)
        if position.kind != "joints":
            return position
        if self.robot is None:
            raise CannotSayError("joint values need the arm (--robot): jobs have pulses, or poses with a posture")
        if len(position.values) < self.robot.axes:
            raise CannotSayError(f"{self.robot.name} has {self.robot.axes} axes")
        if (self.taught_scale if taught else self.scale) is not None:
            return position
        pose = pose_of_joints(position, self.robot, self.cell.value_of_tool(tool))
        return replace(pose, external=position.external, counted=True)

    def with_counts(self, position: Position, taught: bool) -> Position:
        """The position with its external axes in pulses; taught points alone have places for them."""
        count = self.cell.external if taught else 0
        if not taught and any(position.external):
            raise CannotSayError("a position variable with external axes")
        given = position.external[:count]
        if len(given) < count or any(math.isnan(one) for one in given):
            raise CannotSayError("a point that does not say where the external axes go")
        if not position.counted:
            given = tuple(self.counts(number, value) for number, value in enumerate(given, 1))
        return replace(position, external=given, counted=True)

    def counts(self, number: int, value: float) -> float:
        """Pulses of an external axis."""
        each = None if self.robot is None else self.robot.external_pulses(number)
        if each is None and value != 0.0:
            raise CannotSayError("positions of external axes are in pulses, which are not known here")
        return 0.0 if each is None else float(round(value * each))

    def pulses(self, axis: int) -> float:
        """Pulses per degree of an axis (1-based)."""
        counts = self.scale
        if counts is None:
            name = "the arm" if self.robot is None else self.robot.name
            raise CannotSayError(f"the pulses per degree of {name} are not known", JOINT_ANGLE)
        if axis > len(counts):
            raise CannotSayError(f"there is no axis {axis}", JOINT_ANGLE)
        return counts[axis - 1]

    def text(self, say: Macros) -> str:
        groups = []
        if self.moves:
            bases, stations = self.cell.bases, self.cell.external - self.cell.bases
            groups = ["RB1,BS1" if bases else "RB1", *(["ST1"] if stations > 0 else [])]
        lines = say.lines(
            "job",
            name=self.name,
            header=self.header(),
            date=_DATE,
            comment=ascii_text(self.comment)[:32].strip(),
            frame=self.relative_to(),
            groups=groups,
            lines=laid_out(self.lines, say),
        )
        return "\r\n".join((*lines, ""))

    def relative_to(self) -> str:
        """The frame of a relative job, whose steps are poses: that of most of them. Empty: it has no such step."""
        frames = Counter(kept.frame for kept in (*self.points, *self.further.values()) if kept.position.kind == "pose")
        if not frames:
            return ""
        (most, _), *_ = frames.most_common(1)
        return f"USER {most}" if most else "BASE"

    def header(self) -> list[str]:
        points = [(number, kept) for kept, number in self.points.items()] + list(self.further.items())
        rows = [("C", number, kept) for number, kept in points]
        for number, kept in points:
            axes, bases = kept.position.external, self.cell.bases
            for bank, values in (("BC", axes[:bases]), ("EC", axes[bases:])):
                if values:
                    rows.append((bank, number, Kept(Position("external", values))))
        rows += [("P", number, kept) for kept, number in self.cell.kept.items() if number in self.positions]
        rows.sort(key=lambda row: (bool(row[2].position.flags), row[0], row[2].position.kind, row[2].frame, row[1]))
        counts = [sum(bank == kind for bank, _, _ in rows) for kind in ("C", "BC", "EC", "P", "BP", "EX")]
        lines = [f"///NPOS {','.join(map(str, counts))}"]
        if rows or self.moves or self.tool:
            lines.append(f"///TOOL {self.tool}")
        state = {"TOOL": str(self.tool)}
        for bank, number, kept in rows:
            for word, value in self.wanted(kept).items():
                if state.get(word) != value:
                    state[word] = value
                    lines.append(f"///{word} {value}".rstrip())
                    if word in ("PULSE", "RECTAN"):
                        state.pop("RECTAN" if word == "PULSE" else "PULSE", None)
            lines.append(f"{bank}{number:05d}={self.values(kept.position)}")
        return lines

    def wanted(self, kept: Kept) -> dict[str, str]:
        """The header lines that a point needs."""
        if kept.position.kind == "external":
            return {"POSTYPE": "PULSE", "PULSE": ""}
        found = {"TOOL": str(kept.tool)}
        if kept.position.kind == "joints":
            return {**found, "POSTYPE": "PULSE", "PULSE": ""}
        if kept.frame:
            found["USER"] = str(kept.frame)
        found |= {"POSTYPE": "USER" if kept.frame else "BASE", "RECTAN": ""}
        flags = dict(kept.position.flags)
        if flags:
            found["RCONF"] = ",".join(str(flags.get(name, 0)) for name in tables.FLAGS)
        return found

    def values(self, position: Position) -> str:
        if position.kind == "external":
            return ",".join(str(round(value)) for value in position.values)
        if position.kind == "joints":
            counts = self.scale
            assert counts is not None  # `sayable` has made poses of the others
            return ",".join(str(round(v * k)) for v, k in zip(position.values, counts, strict=False))
        x, y, z, a, b, c = position.values
        return ",".join((*(fixed(v, 3) for v in (x, y, z)), *(fixed(v, 4) for v in (c, b, a))))


def pose_of_joints(position: Position, robot: RobotModel, tool: tuple[float, ...] | None) -> Position:
    """The pose and posture of joints, in the base."""
    make = registry.dialect("inform").notation
    if tool is None or make is None:
        raise CannotSayError("joint values with a tool that is kept in a variable")
    joints = np.array(position.values[: robot.axes], dtype=np.float64)
    flags: Mapping[str, int] = make().encode(robot, joints)
    pose = np.asarray(robot.forward(joints) @ matrix(tool), dtype=np.float64)
    return Position("pose", values_of(pose), tuple(flags.items()))

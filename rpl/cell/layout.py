"""The bodies of a cell as data: robots with their programs, grippers, fixtures, bins, parts, and the signals between.

Poses are x y z in mm and a b c in degrees (about z, then y, then x), turned into (4, 4) matrices when a cell file is
read. What is said here never changes while a program runs; where the parts are then is `rpl.cell.world`.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, field, replace
from typing import Literal

import numpy as np

from rpl.cell.shapes import Shape
from rpl.emulator.rotations import FloatArray

# What a row without a robot's name means: the only one of the cell.
ONLY_ROBOT = ""


def _nowhere() -> FloatArray:
    return np.eye(4)


@dataclass(frozen=True, slots=True, eq=False)
class Body:
    """A form in a place: of a fixture in the cell, of a gripper on the flange."""

    shape: Shape
    at: FloatArray = field(default_factory=_nowhere)


@dataclass(frozen=True, slots=True, eq=False)
class RobotPlace:
    """A robot of the cell. `arm`: the name or file of its model; `programs`: paths of its program, by the cell file;
    `base`: of its base in the cell."""

    name: str = ONLY_ROBOT
    arm: str = ""
    programs: tuple[str, ...] = ()
    entry: str = ""
    base: FloatArray = field(default_factory=_nowhere)
    joints: tuple[float, ...] | None = None
    key: str = ""  # of its row, for messages


@dataclass(frozen=True, slots=True)
class Switch:
    """A signal of a robot that becomes a value."""

    signal: str
    value: bool | int | float = True


@dataclass(frozen=True, slots=True, eq=False)
class Gripper:
    """What a robot holds parts with. `grip` is the pose of the point between its jaws, or of the lip of its cup, on the
    flange, z away from the gripper; jaws close along its y. `opening`: least and greatest distance of the jaws in mm.
    `misses`: at which of its grasps, counted from 1, it does not hold the part; `chance_of_miss`: of each other one.
    `force_n`: with how much it holds a part against its weight and the acceleration of the arm; None: with enough."""

    name: str
    kind: Literal["jaws", "suction"]
    robot: str = ONLY_ROBOT
    grip: FloatArray = field(default_factory=_nowhere)
    bodies: tuple[Body, ...] = ()
    close: Switch = Switch("")
    open: Switch | None = None  # None: the signal of `close` going back
    gripped: str = ""  # input that is TRUE while a part is held
    opened: str = ""  # input that is TRUE while it is open
    closed: str = ""  # input that is TRUE while it is closed on nothing
    time_s: float = 0.0
    opening: tuple[float, float] = (0.0, 1000.0)
    reach_mm: float = 20.0  # how far from the grip point a part may be
    misses: tuple[int, ...] = ()
    chance_of_miss: float = 0.0
    force_n: float | None = None
    key: str = ""


@dataclass(frozen=True, slots=True, eq=False)
class Fixture:
    """What stands still: its upward faces carry parts. `inside`: of a bin, from which nothing falls out, its lengths
    (mm) over the pose `floor` of the middle of its floor."""

    name: str
    bodies: tuple[Body, ...]
    restitution: float = 0.3
    inside: tuple[float, float, float] | None = None
    floor: FloatArray = field(default_factory=_nowhere)
    key: str = ""


@dataclass(frozen=True, slots=True, eq=False)
class OwnGrasp:
    """Where a part is to be taken: the grip point (4, 4) in its frame, and from how far the gripper comes and goes
    (None: as far as by default)."""

    grip: FloatArray
    approach_mm: float | None = None
    depart_mm: float | None = None


@dataclass(frozen=True, slots=True, eq=False)
class Part:
    """What can be moved. `at`: where its frame is at the start; `restitution` of its material, `mass_kg` None: not
    weighed. `again_s`: where a feeder brings it, how long after the one before it was taken; `comes_s`: when it comes
    where that is known; `grasps`: in place of the default ones."""

    name: str
    shape: Shape
    at: FloatArray = field(default_factory=_nowhere)
    restitution: float = 0.3
    mass_kg: float | None = None
    again_s: float | None = None
    comes_s: float = 0.0
    grasps: tuple[OwnGrasp, ...] = ()
    kind: str = ""  # the name that it shares with its copies
    key: str = ""


@dataclass(frozen=True, slots=True, eq=False)
class Sensor:
    """An input that is TRUE while any part (or one of `parts`) is in a body."""

    name: str
    signal: str
    body: Body
    robot: str = ONLY_ROBOT
    parts: tuple[str, ...] = ()
    key: str = ""


@dataclass(frozen=True, slots=True)
class Removal:
    """Somebody, or a conveyor, takes away what stands on a fixture some time after a signal of a robot switched."""

    when: Switch
    fixture: str
    after_s: float = 0.0
    robot: str = ONLY_ROBOT
    key: str = ""


@dataclass(frozen=True, slots=True)
class Wire:
    """An output of one robot that is an input of another one."""

    robot: str
    output: str
    to_robot: str
    input: str
    key: str = ""


@dataclass(frozen=True, slots=True, eq=False)
class Layout:
    """Everything that a cell file says of bodies. `allowed`: pairs of names that may touch each other. `scatter`: how
    far from where it is let go a part may come to rest, in mm per mm of its fall. `tangle`: the chance that a part
    stays on the one that it falls on; else it slides into free space."""

    robots: tuple[RobotPlace, ...] = ()
    grippers: tuple[Gripper, ...] = ()
    fixtures: tuple[Fixture, ...] = ()
    parts: tuple[Part, ...] = ()
    sensors: tuple[Sensor, ...] = ()
    wires: tuple[Wire, ...] = ()
    removals: tuple[Removal, ...] = ()
    allowed: tuple[tuple[str, str], ...] = ()
    scatter: float = 0.0
    tangle: float = 0.0
    near_mm: float = 20.0  # distances below this are near misses
    lost_beyond_mm: float | None = None  # collisions deeper than this knock a part out of its gripper
    path: str = ""

    def __bool__(self) -> bool:
        return bool(self.robots or self.grippers or self.fixtures or self.parts or self.sensors)

    def robot(self, name: str) -> RobotPlace:
        """The robot of that name; the only one, at the origin, where the cell names none."""
        if not self.robots:
            return RobotPlace()
        return next(one for one in self.robots if name in (one.name, ONLY_ROBOT))

    @property
    def by_name(self) -> Mapping[str, Part]:
        return {one.name: one for one in self.parts}

    def of(self, robot: str) -> Layout:
        """What is wired to one robot."""
        mine = (ONLY_ROBOT, robot)
        return replace(
            self,
            robots=tuple(one for one in self.robots if one.name == robot),
            grippers=tuple(one for one in self.grippers if one.robot in mine),
            sensors=tuple(one for one in self.sensors if one.robot in mine),
            removals=tuple(one for one in self.removals if one.robot in mine),
        )

    def signals(self) -> Iterator[str]:
        """Every signal that bodies and wires are joined to, of a cell of one robot (see `of`)."""
        for wire in self.wires:
            yield from (wire.output for one in self.robots if one.name == wire.robot)
            yield from (wire.input for one in self.robots if one.name == wire.to_robot)
        for gripper in self.grippers:
            named = (gripper.close.signal, gripper.gripped, gripper.opened, gripper.closed)
            yield from (one for one in named if one)
            if gripper.open is not None:
                yield gripper.open.signal
        yield from (one.signal for one in self.sensors)
        yield from (one.when.signal for one in self.removals)

    def spelled(self, name: Callable[[str], str]) -> Layout:
        """The same bodies, wired to signals of other names."""

        def switch(given: Switch) -> Switch:
            return replace(given, signal=name(given.signal))

        def of(signal: str) -> str:
            return name(signal) if signal else ""

        grippers = tuple(
            replace(
                one,
                close=switch(one.close),
                open=switch(one.open) if one.open is not None else None,
                gripped=of(one.gripped),
                opened=of(one.opened),
                closed=of(one.closed),
            )
            for one in self.grippers
        )
        sensors = tuple(replace(one, signal=name(one.signal)) for one in self.sensors)
        removals = tuple(replace(one, when=switch(one.when)) for one in self.removals)
        return replace(self, grippers=grippers, sensors=sensors, removals=removals)

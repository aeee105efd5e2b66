"""The bodies of a cell while programs run: where each part is, what grippers hold, and which inputs follow from that.

A world is told when an output switches a gripper, when an arm begins to move, and when something that it has put on the
agenda comes due; it looks where the flange is at that moment, moves parts, and switches inputs. It knows no motion
queue and no program: the machines of the robots, which it asks for time and flange, are `Mover`s.
"""

from __future__ import annotations

import random
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, field
from typing import Any, Protocol

import numpy as np

from rpl.cell.falling import GRAVITY_MM_S2, PRESSED_MM, Laws, Obstacle, below, fall, obstacle_of, obstacles_of
from rpl.cell.grasping import Hold, Miss, grasp
from rpl.cell.layout import Gripper, Layout, Part, Sensor, Switch
from rpl.cell.record import Grasp, Knock, Opening, Placed
from rpl.cell.shapes import Facets, bounds_at, moved
from rpl.emulator.rotations import FloatArray, invert_pose
from rpl.errors import UsageError

# The deed that changes nothing by itself: behind each deed it is seen which parts come and what sensors see.
LOOK = "look"
# While an arm with a part moves, sensors are looked at so often (s).
LOOK_S = 0.02
# Steps (s) in which the acceleration of what is held is looked at.
STRAIN_S = 0.008
# A part that stands deeper than this in a fixture at the start is a mistake of the cell file.
_DEEPEST_MM = 1.0


class Mover(Protocol):
    """A robot's machine, as a world sees it."""

    @property
    def now(self) -> float: ...
    def flange_in_cell(self) -> FloatArray: ...
    def deed_later(self, time_s: float, deed: str) -> None: ...
    def input_later(self, time_s: float, signal: str, value: bool) -> None: ...


@dataclass(slots=True)
class _Grip:
    """What changes of a gripper. `closes`: number of the closing that is under way or was the last one. `also`: parts
    that it has closed on while another gripper holds them: they are its own when that one opens."""

    closed: bool = False
    closes: int = 0
    holds: dict[str, FloatArray] = field(default_factory=dict)  # part -> pose in the flange
    also: list[str] = field(default_factory=list)


@dataclass(slots=True)
class _There:
    """What changes of a part. `since`: when it came to rest, or will."""

    pose: FloatArray
    on: str
    since: float
    held_by: str = ""
    lost: bool = False


class World:
    """What moves in a cell. Raises UsageError where the cell cannot be as its file says."""

    def __init__(self, layout: Layout, seed: int, knocks: Sequence[Knock] = ()) -> None:
        self.layout = layout
        self.knocks = tuple(knocks)
        self.random = random.Random(seed)
        self.movers: dict[str, Mover] = {}
        self.way: dict[str, int] = {}  # how many ways each robot has begun
        self.grips = {one.name: _Grip() for one in layout.grippers}
        self.there: dict[str, _There] = {}
        self.to_come: list[Part] = []
        self.seen: dict[str, bool] = {one.name: False for one in layout.sensors}
        self.placed: list[Placed] = []
        self.grasps: list[Grasp] = []
        self.openings: list[Opening] = []
        self.notes: list[str] = []
        self.fixed = [one for fixture in layout.fixtures for one in obstacles_of(fixture)]
        self.laws = Laws(layout.scatter, layout.tangle)
        self._by_name = dict(layout.by_name)
        self._begin()

    def __deepcopy__(self, memo: dict[int, Any]) -> World:
        import copy

        for each in (self.layout, self.fixed, self.laws, self._by_name):
            memo[id(each)] = each
        twin = self.__class__.__new__(self.__class__)
        memo[id(self)] = twin
        for name, value in self.__dict__.items():
            setattr(twin, name, copy.deepcopy(value, memo))
        return twin

    def _begin(self) -> None:
        """Every part that is there at the start settles on what is below it."""
        firsts = set()
        for part in self.layout.parts:
            if part.kind in firsts and (part.again_s is not None or part.comes_s > 0.0):
                self.to_come.append(part)
                continue
            firsts.add(part.kind)
            self._stands_in_nothing(part)
            if below(part.shape, part.at, self._obstacles()) is None:
                raise UsageError(f"{self.layout.path}: {part.key}.at: nothing is below {part.name}: it would fall")
            self._fall(part, part.at, 0.0)

    def _stands_in_nothing(self, part: Part) -> None:
        corners = moved(part.shape.facets.vertices, part.at)
        inner = corners.mean(axis=0) + (corners - corners.mean(axis=0)) * 0.98
        for one in self.layout.fixtures:
            for body in one.bodies:
                back = moved(inner, invert_pose(body.at))
                low, high = body.shape.facets.bounds
                deep = ((back > low + _DEEPEST_MM) & (back < high - _DEEPEST_MM)).all(axis=1)
                if deep.any() and any(_is_inside(body.shape.facets, point) for point in back[deep]):
                    raise UsageError(f"{self.layout.path}: {part.key}.at: {part.name} stands in {one.name}")

    # ---- what machines tell

    def join(self, robot: str, mover: Mover) -> None:
        """A robot's machine is there: inputs that are TRUE at the start are switched."""
        self.movers[robot] = mover
        for one in self._grippers(robot):
            if one.opened:
                mover.input_later(0.0, one.opened, True)
        mine = {one.name for one in self._grippers(robot)}
        for number, knock in enumerate(self.knocks):
            if knock.gripper in mine:
                mover.deed_later(knock.t, f"knock {number}")
        for sensor in self.layout.sensors:
            if self._robot_of(sensor.robot) == robot and self._sees(sensor, 0.0):
                self.seen[sensor.name] = True
                mover.input_later(0.0, sensor.signal, True)
        for since in {each.since for each in self.there.values() if each.since > 0.0}:
            mover.deed_later(since, LOOK)
        for part in self.to_come:
            if part.again_s is None:
                mover.deed_later(part.comes_s, LOOK)

    def _look_later(self, time_s: float) -> None:
        """See then which parts come and what sensors see: on every agenda, for the one robot may have ended by then."""
        for mover in self.movers.values():
            mover.deed_later(time_s, LOOK)

    def settle_alone(self) -> float:
        """Without robots: let all parts come; the time (s) at which the last one rests."""
        for part in sorted(self.to_come, key=lambda one: one.comes_s):
            if part.again_s is None:
                self.to_come.remove(part)
                self._fall(part, part.at, part.comes_s)
        return max((at.since for at in self.there.values()), default=0.0)

    def switches(self, robot: str) -> Iterator[tuple[Switch, str]]:
        """The outputs of a robot that do something to bodies, and what: told to `happen` when they switch."""
        for one in self._grippers(robot):
            yield one.close, f"close {one.name}"
            back = one.open if one.open is not None else Switch(one.close.signal, _back(one.close.value))
            yield back, f"open {one.name}"
        for number, removal in enumerate(self.layout.removals):
            if self._robot_of(removal.robot) == robot:
                yield removal.when, f"remove {number}"
        for number, wire in enumerate(self.layout.wires):
            if wire.robot == robot:
                yield Switch(wire.output, True), f"on {number}"
                yield Switch(wire.output, False), f"off {number}"

    def begins(self, robot: str, start_s: float, end_s: float, way: Callable[[FloatArray], FloatArray]) -> None:
        """An arm moves from one moment to another: what it holds passes sensors, and may be too heavy. `way` gives the
        flange in the cell (k, 4, 4) at times (k,)."""
        self.way[robot] = self.way.get(robot, 0) + 1
        for one in self._grippers(robot):
            slips = self._slips(one, start_s, end_s, way)
            if slips is not None:
                self.movers[robot].deed_later(slips[0], f"slip {self.way[robot]} {slips[1]:.1f} {one.name}")
        if self.layout.sensors and any(self.grips[one.name].holds for one in self._grippers(robot)):
            mover = self.movers[robot]
            for number in range(1, int((end_s - start_s) / LOOK_S) + 1):
                mover.deed_later(start_s + number * LOOK_S, LOOK)
            mover.deed_later(end_s, LOOK)

    def happen(self, robot: str, deed: str) -> None:
        """Something that `switches` names has been asked for, or has come due."""
        mover = self.movers[robot]
        what, _, name = deed.partition(" ")
        match what:
            case "on" | "off":
                wire = self.layout.wires[int(name)]
                self.movers[wire.to_robot].input_later(mover.now, wire.input, what == "on")
            case "remove":
                mover.deed_later(mover.now + self.layout.removals[int(name)].after_s, f"removed {name}")
            case "removed":
                for part in self._upon(self.layout.removals[int(name)].fixture):
                    at = self.there.pop(part)
                    self.placed.append(Placed(mover.now, part, "gone", at.pose))
            case "close":
                self._close(mover, self._gripper(name))
            case "knock":
                knock = self.knocks[int(name)]
                self._lose(mover, self._gripper(knock.gripper), f"knocked out by {knock.by}")
            case "slip":
                number, needed, gripper = name.split(" ", 2)
                if self.way[robot] == int(number):
                    holds = f"it holds {self._gripper(gripper).force_n:g} N"
                    self._lose(mover, self._gripper(gripper), f"lost on the way: {needed} N are needed, {holds}")
            case "hold":
                number, _, gripper = name.partition(" ")
                self._hold(mover, self._gripper(gripper), int(number))
            case "open":
                self._open(mover, self._gripper(name))
            case "opened":
                number, _, gripper = name.partition(" ")
                grip = self._gripper(gripper)
                if self.grips[gripper].closes == int(number) and grip.opened:
                    mover.input_later(mover.now, grip.opened, True)
        self._parts_come(mover.now)
        self._look(mover.now)

    # ---- grippers

    def _slips(
        self, gripper: Gripper, start_s: float, end_s: float, way: Callable[[FloatArray], FloatArray]
    ) -> tuple[float, float] | None:
        """When (s) a gripper loses what it holds on a way, and the force (N) that it would have needed: mass times
        acceleration against gravity, of the centre of mass."""
        holds = self.grips[gripper.name].holds
        if gripper.force_n is None or not holds or end_s - start_s < 2.0 * STRAIN_S:
            return None
        times = np.arange(start_s, end_s, STRAIN_S)
        flanges = way(times)
        needed = np.zeros(max(len(times) - 2, 0))
        for name, pose in holds.items():
            part = self._by_name[name]
            centre = pose[:3, :3] @ part.shape.facets.centre + pose[:3, 3]
            places = flanges[:, :3, :3] @ centre + flanges[:, :3, 3]
            pulls = np.diff(places, 2, axis=0) / STRAIN_S**2 + (0.0, 0.0, GRAVITY_MM_S2)
            needed += (part.mass_kg or 0.0) * np.linalg.norm(pulls, axis=1) / 1000.0
        beyond = np.flatnonzero(needed > gripper.force_n)
        return (float(times[beyond[0] + 1]), float(needed.max())) if len(beyond) else None

    def _lose(self, mover: Mover, gripper: Gripper, why: str) -> None:
        """What it holds falls out of a closed gripper."""
        if held := ", ".join(self.grips[gripper.name].holds):
            self.grasps.append(Grasp(mover.now, gripper.name, held, False, why, lost=True))
            self._let_go(mover, gripper)
            if gripper.closed:
                mover.input_later(mover.now, gripper.closed, True)

    def _close(self, mover: Mover, gripper: Gripper) -> None:
        grip = self.grips[gripper.name]
        if grip.closed:
            return
        grip.closed = True
        grip.closes += 1
        if gripper.opened:
            mover.input_later(mover.now, gripper.opened, False)
        mover.deed_later(mover.now + gripper.time_s, f"hold {grip.closes} {gripper.name}")

    def _hold(self, mover: Mover, gripper: Gripper, number: int) -> None:
        """The jaws have closed, or the cup has drawn."""
        grip, now = self.grips[gripper.name], mover.now
        if not grip.closed or grip.closes != number:
            return  # opened again on the way
        flange = mover.flange_in_cell()
        free = [
            (self._by_name[name], self._pose_of(name)) for name, at in self.there.items() if self._is_there(at, now)
        ]
        found = grasp(gripper, flange @ gripper.grip, free)
        slipped = number in gripper.misses or (
            gripper.chance_of_miss > 0.0 and self.random.random() < gripper.chance_of_miss
        )
        if slipped and isinstance(found, Hold):
            found = Miss("it slipped, as the cell says", found.part.name)
        if isinstance(found, Miss):
            self.grasps.append(Grasp(now, gripper.name, found.part, False, found.why))
            self.openings.append(Opening(now, gripper.name, False, gripper.opening[0]))
            if gripper.closed:
                mover.input_later(now, gripper.closed, True)
            return
        if self.there[found.part.name].held_by:
            self._share(mover, gripper, found.part.name)
            return
        for part, in_grip in ((found.part, found.pose), *found.too):
            before = self.there[part.name].pose
            for name in (part.name, *self._upon(part.name)):
                there = self.there[name]
                carried = gripper.grip @ in_grip @ invert_pose(before) @ there.pose
                there.held_by, there.on = gripper.name, gripper.name
                grip.holds[name] = carried
                self.placed.append(Placed(now, name, "held", carried, gripper.name))
                self._will_come(name, now)
        others = ", ".join(name for name in grip.holds if name != found.part.name)
        why = f"{'double pick: ' * bool(found.too)}with {others}" if others else ""
        self.grasps.append(Grasp(now, gripper.name, found.part.name, True, why))
        self.openings.append(Opening(now, gripper.name, False, found.width_mm))
        if gripper.gripped:
            mover.input_later(now, gripper.gripped, True)

    def _share(self, mover: Mover, gripper: Gripper, name: str) -> None:
        """Close on a part that another gripper holds: it stays as that one has it until that one opens."""
        self.grips[gripper.name].also.append(name)
        why = f"from {self.there[name].held_by}"
        self.grasps.append(Grasp(mover.now, gripper.name, name, True, why))
        if gripper.gripped:
            mover.input_later(mover.now, gripper.gripped, True)

    def _taken_over(self, name: str, pose: FloatArray, now: float) -> bool:
        """Has another gripper closed on a part that is let go at a pose in the cell? Then it is its own."""
        for one in self.layout.grippers:
            if name in (also := self.grips[one.name].also):
                also.remove(name)
                flange = self.movers[self._robot_of(one.robot)].flange_in_cell()
                carried = invert_pose(flange) @ pose
                self.there[name] = _There(pose, one.name, now, one.name)
                self.grips[one.name].holds[name] = carried
                self.placed.append(Placed(now, name, "held", carried, one.name))
                return True
        return False

    def _open(self, mover: Mover, gripper: Gripper) -> None:
        grip, now = self.grips[gripper.name], mover.now
        if not grip.closed:
            return
        grip.closed = False
        self.openings.append(Opening(now, gripper.name, True, gripper.opening[1]))
        if gripper.closed and not grip.holds and not grip.also:
            mover.input_later(now, gripper.closed, False)
        if gripper.opened:
            mover.deed_later(now + gripper.time_s, f"opened {grip.closes} {gripper.name}")
        self._let_go(mover, gripper)

    def _let_go(self, mover: Mover, gripper: Gripper) -> None:
        grip, now = self.grips[gripper.name], mover.now
        if gripper.gripped and (grip.holds or grip.also):
            mover.input_later(now, gripper.gripped, False)
        grip.also.clear()
        flange = mover.flange_in_cell()
        held, grip.holds = grip.holds, {}
        # The lowest first: what it carries comes to lie on it.
        for name in sorted(held, key=lambda one: float((flange @ held[one])[2, 3])):
            part, pose = self._by_name[name], flange @ held[name]
            if self._taken_over(name, pose, now):
                continue
            if inside := self._stuck_in(part, pose):
                self.notes.append(f"{now:.3f} s: {name} is let go inside {inside}")
            self._fall(part, pose, now)
            self._look_later(self.there[name].since)

    def _upon(self, name: str) -> list[str]:
        """The parts that stand on a part, and on these."""
        found = [each for each, at in self.there.items() if at.on == name and not at.held_by]
        return [one for each in found for one in (each, *self._upon(each))]

    # ---- parts

    def _is_there(self, at: _There, now: float) -> bool:
        return not at.lost and at.since <= now

    def _obstacles(self) -> list[Obstacle]:
        lying = [(name, at) for name, at in self.there.items() if not at.held_by and not at.lost]
        return [*self.fixed, *(obstacle_of(self._by_name[name], at.pose) for name, at in lying)]

    def _fall(self, part: Part, pose: FloatArray, now: float) -> None:
        """Let go at a pose in the cell: the whole way down is known at once."""
        others = [one for one in self._obstacles() if one.name != part.name]
        stops = fall(part, pose, others, self.laws, self.random)
        here, last = pose, stops[-1]
        if last.after_s > 0.0:
            self.placed.append(Placed(now, part.name, "falls", here))
        for stop in stops[:-1]:
            self.placed.append(Placed(now + stop.after_s, part.name, "falls", stop.pose, stop.on))
        lost = not last.on
        state = _There(last.pose, last.on, now + last.after_s, lost=lost)
        self.there[part.name] = state
        self.placed.append(Placed(state.since, part.name, "lost" if lost else "rests", last.pose, last.on))

    def _will_come(self, taken: str, now: float) -> None:
        """A feeder brings the next part some time after this one was taken from its place."""
        part = self._by_name[taken]
        first = next((one for one in self.to_come if one.kind == part.kind), None)
        if first is not None and first.again_s is not None:
            self._look_later(now + first.again_s)

    def _parts_come(self, now: float) -> None:
        """Those of feeders whose place is free, each feeder's next one."""
        for kind in dict.fromkeys(one.kind for one in self.to_come):
            part = next(one for one in self.to_come if one.kind == kind)
            if now < self._due(part) - 1e-9 or (part.again_s is not None and self._is_taken(part)):
                continue
            self.to_come.remove(part)
            self._fall(part, part.at, now)
            self._look_later(self.there[part.name].since)

    def _due(self, part: Part) -> float:
        if part.again_s is None:
            return part.comes_s
        taken = [one.t for one in self.placed if one.state == "held" and self._by_name[one.part].kind == part.kind]
        return max(taken, default=0.0) + part.again_s

    def _is_taken(self, part: Part) -> bool:
        """Does another part lie, or hang, where this one is to come?"""
        low, high = bounds_at(part.shape, part.at)
        for name, at in self.there.items():
            if at.lost:
                continue
            least, most = bounds_at(self._by_name[name].shape, self._pose_of(name))
            if (least < high - 1e-6).all() and (most > low + 1e-6).all():
                return True
        return False

    def _pose_of(self, name: str) -> FloatArray:
        """Where a part is now, in the cell."""
        at = self.there[name]
        if not at.held_by:
            return at.pose
        gripper = self._gripper(at.held_by)
        flange = self.movers[self._robot_of(gripper.robot)].flange_in_cell()
        return flange @ self.grips[at.held_by].holds[name]

    def _stuck_in(self, part: Part, pose: FloatArray) -> str:
        """Another part in whose box this one is deeper than programs press; "" for none."""
        low, high = bounds_at(part.shape, pose)
        for name, at in self.there.items():
            if name == part.name or at.held_by or at.lost:
                continue
            least, most = bounds_at(self._by_name[name].shape, at.pose)
            if (np.minimum(most, high) - np.maximum(least, low) > PRESSED_MM).all():
                return name
        return ""

    # ---- sensors

    def _look(self, now: float) -> None:
        for sensor in self.layout.sensors:
            seen = self._sees(sensor, now)
            if seen != self.seen[sensor.name]:
                self.seen[sensor.name] = seen
                self.movers[self._robot_of(sensor.robot)].input_later(now, sensor.signal, seen)

    def _sees(self, sensor: Sensor, now: float) -> bool:
        low, high = bounds_at(sensor.body.shape, sensor.body.at)
        for name, at in self.there.items():
            part = self._by_name[name]
            if (sensor.parts and name not in sensor.parts and part.kind not in sensor.parts) or at.since > now:
                continue
            least, most = bounds_at(part.shape, self._pose_of(name))
            if not at.lost and (least < high).all() and (most > low).all():
                return True
        return False

    # ---- names

    def _gripper(self, name: str) -> Gripper:
        return next(one for one in self.layout.grippers if one.name == name)

    def _grippers(self, robot: str) -> Iterator[Gripper]:
        return (one for one in self.layout.grippers if self._robot_of(one.robot) == robot)

    def _robot_of(self, name: str) -> str:
        """The name under which a robot's machine has joined."""
        return self.layout.robot(name).name


def _back(value: bool | int | float) -> bool | int | float:
    return not value if isinstance(value, bool) else 0


def _is_inside(facets: Facets, point: FloatArray) -> bool:
    """Is a point within a closed body? A ray from it comes out through a face that looks the same way."""
    way = np.array([0.5773, 0.5774, 0.57735])
    found = facets.pierced(point, way)
    return found is not None and float(facets.normals[found[1]] @ way) > 0.0

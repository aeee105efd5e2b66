"""All that can touch in a run of a cell, under its name, and which pairs of it are looked at.

Things are links, grippers, fixtures and parts; a part is one piece for each stay in a place or in a gripper. The rules
of what counts stand in `Meeting` and are told in docs/collisions.md.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property
from itertools import pairwise

import numpy as np

from rpl.cell.armbodies import bodies_of
from rpl.cell.layout import ONLY_ROBOT, Gripper
from rpl.cell.shapes import Shape
from rpl.emulator.rotations import FloatArray
from rpl.workcell.record import CellRun, Placed
from rpl.workcell.sweeping.selfpairs import touching_always
from rpl.workcell.sweeping.solids import solids_of
from rpl.workcell.sweeping.tracks import STILL, Piece, Thing
from rpl.workcell.sweeping.ways import Way, way_of

# What a robot is called that the cell gives no name.
NAMELESS = "robot"
# A run in which no time goes by is looked at as if it took that long.
SHORTEST_S = 1e-3


@dataclass(frozen=True, slots=True)
class Meeting:
    """A pair of pieces that is looked at. `rests`: a held part and what stands, which may touch as it is taken up or
    put down; `grips`: moments at which one takes or leaves the other, when they may touch; `near`: whether their least
    distance is of interest."""

    first: Piece
    second: Piece
    rests: bool = False
    grips: tuple[float, ...] = ()
    near: bool = True


@dataclass(frozen=True)
class Scene:
    """`things` by number, `pieces` of them; `apart`: of each robot the pairs of its own things (by number) that are not
    looked at, since they touch however it stands; `notes`: what is to be said of the search."""

    run: CellRun
    ways: tuple[Way, ...]
    things: tuple[Thing, ...]
    pieces: tuple[Piece, ...]
    apart: frozenset[tuple[int, int]]
    notes: tuple[str, ...]

    def meetings(self) -> Iterator[Meeting]:
        """All pairs of pieces that may touch and that are worth a look."""
        for number, first in enumerate(self.pieces):
            for second in self.pieces[number + 1 :]:
                if min(first.end_s, second.end_s) > max(first.start_s, second.start_s) and self._may_meet(
                    first, second
                ):
                    yield self._meeting(first, second)

    def stands(self, piece: Piece) -> bool:
        """Is it a thing that cannot move? An arm that happens to stand is none."""
        if piece.way == STILL:
            return True
        mechanisms = self.ways[piece.way].model.mechanisms
        return piece.link == 0 and not any(one.carries_robot for one in mechanisms)

    def name(self, piece: Piece) -> str:
        return self.things[piece.thing].name

    def _may_meet(self, first: Piece, second: Piece) -> bool:
        if first.thing == second.thing or (self.stands(first) and self.stands(second)):
            return False
        if first.way == second.way and first.way != STILL:
            low, high = sorted((first.link, second.link))
            if low == high or (min(first.thing, second.thing), max(first.thing, second.thing)) in self.apart:
                return False
        return not self._allowed(self.name(first), self.name(second))

    def _allowed(self, first: str, second: str) -> bool:
        """By `layout.allowed`, where the name of a robot stands for all its links."""
        return any(
            (_is(first, one) and _is(second, other)) or (_is(first, other) and _is(second, one))
            for one, other in self.run.layout.allowed
        )

    def _meeting(self, first: Piece, second: Piece) -> Meeting:
        one, other = self.things[first.thing], self.things[second.thing]
        if one.kind == "part" or (other.kind != "part" and other.kind == "gripper"):
            first, second, one, other = second, first, other, one
        if other.kind != "part":
            return Meeting(first, second, near=first.way != second.way)
        if one.kind in ("fixture", "part"):
            held = [piece for piece in (first, second) if piece.way != STILL]
            rests = len(held) == 1
            return Meeting(first, second, rests=rests)
        last = self.ways[one.way].model.axes
        grips = self._grips.get((one.way, other.name), ()) if one.link == last else ()
        return Meeting(first, second, grips=grips, near=not grips and first.way != second.way)

    @property
    def end_s(self) -> float:
        return end_of(self.run)

    @cached_property
    def _grips(self) -> dict[tuple[int, str], tuple[float, ...]]:
        """When the hand of a robot takes, misses or leaves a part."""
        found: dict[tuple[int, str], list[float]] = {}
        hands = {gripper.name: self._way_of(gripper) for gripper in self.run.layout.grippers}
        for grasp in self.run.grasps:
            if grasp.part and grasp.gripper in hands:
                found.setdefault((hands[grasp.gripper], grasp.part), []).append(grasp.t)
        for part in self.run.layout.parts:
            for before, after in pairwise((None, *self.run.places_of(part.name), None)):
                for one in (before, after):
                    t = after.t if after is not None else self.end_s
                    if one is not None and one.state == "held" and one.on in hands:
                        found.setdefault((hands[one.on], part.name), []).append(t)
        return {key: tuple(sorted(set(times))) for key, times in found.items()}

    def _way_of(self, gripper: Gripper) -> int:
        return way_number(self.run, self.ways, gripper.robot)


def way_number(run: CellRun, ways: tuple[Way, ...], robot: str) -> int:
    """The robot of that name among those that move; STILL without one."""
    names = [way.name for way in ways]
    if robot in names:
        return names.index(robot)
    return 0 if robot == ONLY_ROBOT and len(ways) == 1 else STILL


def end_of(run: CellRun) -> float:
    """When the search ends, s."""
    return max(run.time_s, SHORTEST_S)


def _is(name: str, said: str) -> bool:
    return name == said or name.startswith(f"{said}.")


def scene_of(run: CellRun) -> Scene:
    """The things of a run. Raises UsageError where the library that measures distances is not installed."""
    builder = _Builder(run)
    builder.robots()
    builder.fixtures()
    for part in run.layout.parts:
        builder.part(part.name, run.places_of(part.name))
    apart, said = touching_always(builder.ways, builder.things_of_robots())
    names = [thing.name for thing in builder.things]
    notes = [*builder.notes, *(f"not looked at, since they {why}: {names[a]} and {names[b]}" for a, b, why in said)]
    return Scene(run, tuple(builder.ways), tuple(builder.things), tuple(builder.pieces), apart, tuple(notes))


class _Builder:
    def __init__(self, run: CellRun) -> None:
        self.run = run
        self.ways: list[Way] = []
        self.things: list[Thing] = []
        self.pieces: list[Piece] = []
        self.notes: list[str] = []

    def robots(self) -> None:
        for robot in self.run.robots:
            name = robot.place.name or NAMELESS
            if robot.model is None:
                self.notes.append(f"{name} has no arm: it is not looked at")
                continue
            number = len(self.ways)
            self.ways.append(way_of(robot, name if robot.place.name else ONLY_ROBOT, robot.model))
            found = bodies_of(robot.model)
            self.notes += [f"{name}: {note}" for note in found.notes]
            limits = "; links with one between them are left to the limits of the axes" if found.fitted else ""
            self.notes.append(f"{name}: bodies are {found.source}{limits}")
            links: dict[int, int] = {}
            for body in found.bodies:
                if body.link not in links:
                    links[body.link] = len(self.things)
                    called = f"{name}.link{body.link}" if body.link else f"{name}.base"
                    self.things.append(Thing(called, "link", number, body.link))
                self._add(links[body.link], body.shape, body.at, number, body.link)
        for gripper in self.run.layout.grippers:
            number = way_number(self.run, tuple(self.ways), gripper.robot)
            if number == STILL or not gripper.bodies:
                continue
            model = self.ways[number].model
            flange = model.arm.forward(np.zeros(model.axes))
            self.things.append(Thing(gripper.name, "gripper", number, model.axes))
            for part in gripper.bodies:
                self._add(len(self.things) - 1, part.shape, flange @ part.at, number, model.axes)

    def fixtures(self) -> None:
        for fixture in self.run.layout.fixtures:
            self.things.append(Thing(fixture.name, "fixture"))
            for body in fixture.bodies:
                self._add(len(self.things) - 1, body.shape, body.at, STILL, 0)

    def part(self, name: str, places: list[Placed]) -> None:
        """One piece for each stay. Where it falls, is lost or is taken away, it is not looked at."""
        shape = self.run.layout.by_name[name].shape
        robots = {one.name: one.robot for one in self.run.layout.grippers}
        self.things.append(Thing(name, "part"))
        for here, after in pairwise((*places, None)):
            if here is None or here.state in ("falls", "lost", "gone"):
                continue
            end = after.t if after is not None else end_of(self.run)
            way, link, at = STILL, 0, here.pose
            if here.state == "held":
                way = way_number(self.run, tuple(self.ways), robots.get(here.on, ""))
                if way == STILL:
                    continue
                model = self.ways[way].model
                link, at = model.axes, model.arm.forward(np.zeros(model.axes)) @ here.pose
            self._add(len(self.things) - 1, shape, at, way, link, (here.t, end), here.on if way != STILL else "")

    def _add(
        self,
        thing: int,
        shape: Shape,
        at: FloatArray,
        way: int,
        link: int,
        span: tuple[float, float] | None = None,
        holder: str = "",
    ) -> None:
        start, end = span if span is not None else (0.0, end_of(self.run))
        for solid in solids_of(shape, at):
            self.pieces.append(Piece(thing, solid, way, link, solid.at, start, end, holder))

    def things_of_robots(self) -> list[tuple[int, Thing, list[Piece]]]:
        """Links and grippers with their numbers and pieces."""
        return [
            (number, thing, [piece for piece in self.pieces if piece.thing == number])
            for number, thing in enumerate(self.things)
            if thing.kind in ("link", "gripper")
        ]

"""A minute of an arm with a gripper among 30 objects: the sweep beside coal and Pinocchio alone, every 4 ms.

    python benchmarks/cell_collisions.py [SECONDS] [OBJECTS]

The arm goes to and fro among boxes and cylinders, half of its moves straight, half by its joints, all of 0.25 to 1 m/s.
What is measured, on one core: `find_collisions` with near misses and without; the same pairs by `coal.distance` at
every 4 ms, one call a pair; and by Pinocchio's geometry model, whose loop over the pairs is not in Python. The last two
tell what is true at the samples only.
"""

from __future__ import annotations

import sys
import time
from collections.abc import Callable

import numpy as np

from rpl import ir
from rpl.cell.layout import Body, Fixture, Gripper, Layout, RobotPlace
from rpl.cell.shapes import Box, Cylinder
from rpl.emulator.model import load_robot
from rpl.emulator.planner import MoveRequest, PlannedMove, plan
from rpl.emulator.rotations import FloatArray, pose_matrix, zyx_to_matrix
from rpl.runtime.trace import Event, Leg, RunResult
from rpl.workcell.collisions import STEP_S, find_collisions
from rpl.workcell.record import CellRun, RobotRun
from rpl.workcell.sweeping.geometrymodel import geometry_model
from rpl.workcell.sweeping.scene import Scene, scene_of
from rpl.workcell.sweeping.sweep import Meter
from rpl.workcell.sweeping.tracks import block_of, track_of

MODEL = load_robot("kuka_kr6r900sixx")


def pose(x: float, y: float, z: float, b: float = 0.0) -> FloatArray:
    return pose_matrix(np.array([x, y, z]), zyx_to_matrix(np.array([0.0, b, 0.0])))


def driven(seconds: float) -> RunResult:
    """Moves through drawn places until the time is up."""
    draws = np.random.default_rng(1)
    joints, clock, events = MODEL.home.copy(), 0.0, []
    while clock < seconds:
        target = pose(draws.uniform(350, 600), draws.uniform(-400, 400), draws.uniform(250, 600), 180.0)
        request = MoveRequest(
            "linear" if len(events) % 2 else "joint",
            target_pose=target,
            path_speed_mm_s=draws.uniform(250, 1000),
            joint_speed=draws.uniform(0.2, 0.6),
        )
        move = plan(MODEL, joints, request)
        if isinstance(move, PlannedMove):
            events.append(Event(clock, "main", "move", {}, legs=(Leg(move, clock, move.duration_s),)))
            clock, joints = clock + move.duration_s, move.end_joints
    return RunResult("finished", clock, len(events), 0, (), (), None, tuple(events), tuple(joints))


def cell(result: RunResult, objects: int, near_mm: float) -> CellRun:
    """Objects on a table and about it; some are hit."""
    draws = np.random.default_rng(2)
    fixtures = [Fixture("table", (Body(Box((1600.0, 1600.0, 40.0)), pose(500, 0, -30)),))]
    while len(fixtures) < objects:
        x, y = draws.uniform(-200, 800), draws.uniform(-700, 700)
        if np.hypot(x, y) > 250.0:
            high = draws.uniform(30, 250) if np.hypot(x, y) < 700.0 else draws.uniform(100, 900)
            form = Box((80.0, 120.0, high)) if len(fixtures) % 2 else Cylinder(90.0, high)
            fixtures.append(Fixture(f"object{len(fixtures)}", (Body(form, pose(x, y, high / 2.0)),)))
    jaws = Gripper("jaws", "jaws", bodies=tuple(
        Body(Box(size), pose(0, y, z)) for size, y, z in
        (((60.0, 110.0, 50.0), 0, 25), ((20.0, 10.0, 60.0), 30, 80), ((20.0, 10.0, 60.0), -30, 80))
    ))  # fmt: skip
    layout = Layout((RobotPlace("arm"),), (jaws,), tuple(fixtures), near_mm=near_mm)
    robot = RobotRun(layout.robots[0], MODEL, ir.Program(()), result)
    return CellRun(layout, (robot,), time_s=result.time_s)


def best(what: Callable[[], object], rounds: int = 3) -> float:
    """Seconds of one core, the best of a few rounds."""
    found = []
    for _ in range(rounds):
        start = time.process_time()
        what()
        found.append(time.process_time() - start)
    return min(found)


def bare(scene: Scene, times: FloatArray) -> int:
    """coal.distance of all pairs at all samples, one after the other."""
    block, meter, touching = block_of(scene.ways, times), Meter(scene.ways), 0
    tracks = {}
    for meeting in scene.meetings():
        for piece in (meeting.first, meeting.second):
            if id(piece) not in tracks:
                tracks[id(piece)] = track_of(piece, block, 0, len(times) - 1, scene.stands(piece))
        first, second = tracks[id(meeting.first)], tracks[id(meeting.second)]
        touching += min(meter.at_knot(first, second, knot) for knot in range(len(times))) < 0.0
    return touching


def by_pinocchio(scene: Scene, times: FloatArray) -> int:
    """Pinocchio's distances of all pairs at all samples."""
    numbers = {id(piece): number for number, piece in enumerate(scene.pieces)}
    pairs = [(numbers[id(one.first)], numbers[id(one.second)]) for one in scene.meetings()]
    geometry = geometry_model(MODEL, scene.pieces, pairs)
    least = np.full(len(pairs), np.inf)
    for theta in MODEL.theta(scene.ways[0].joints(times)):
        least = np.minimum(least, geometry.distances(theta))
    return int((least < 0.0).sum())


def main() -> None:
    seconds = float(sys.argv[1]) if len(sys.argv) > 1 else 60.0
    objects = int(sys.argv[2]) if len(sys.argv) > 2 else 30
    result = driven(seconds)
    times = np.arange(int(result.time_s / STEP_S) + 1) * STEP_S
    scene = scene_of(cell(result, objects, 20.0))
    pairs = sum(1 for _ in scene.meetings())
    print(
        f"{result.time_s:.1f} s, {result.moves} moves, {objects} objects, {len(times)} samples, {pairs} pairs of bodies"
    )
    for near_mm in (20.0, 0.0):
        run = cell(result, objects, near_mm)
        took = best(lambda run=run: find_collisions(run))
        found = find_collisions(run)
        print(f"sweep, near misses below {near_mm:2.0f} mm: {took:6.2f} s  "
              f"({len(found.collisions)} collisions, {len(found.near)} near)")  # fmt: skip
    took = best(lambda: find_collisions(run, 0.012))
    print(f"the same, first looked at every 12 ms: {took:6.2f} s")
    took = best(lambda: bare(scene, times), 1)
    print(f"coal.distance at every sample:      {took:6.2f} s")
    took = best(lambda: by_pinocchio(scene, times), 1)
    print(f"Pinocchio's geometry model:         {took:6.2f} s")


if __name__ == "__main__":
    main()

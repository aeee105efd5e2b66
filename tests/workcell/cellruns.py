"""Runs of cells made by hand: arms that are driven through joints, and what stands about."""

from collections.abc import Sequence

import numpy as np

from rpl import ir
from rpl.cell.layout import Body, Fixture, Layout, RobotPlace
from rpl.cell.shapes import Shape
from rpl.emulator.model import RobotModel
from rpl.emulator.planner import MoveRequest, PlannedMove, plan
from rpl.emulator.rotations import FloatArray, pose_matrix, zyx_to_matrix
from rpl.runtime.trace import Event, Leg, RunResult
from rpl.source import Origin, Source
from rpl.workcell.record import CellRun, RobotRun

PROGRAM = ir.Program(())


def at(x: float, y: float, z: float, a: float = 0.0, b: float = 0.0, c: float = 0.0) -> FloatArray:
    return pose_matrix(np.array([x, y, z]), zyx_to_matrix(np.array([a, b, c])))


def fixture(name: str, shape: Shape, pose: FloatArray) -> Fixture:
    return Fixture(name, (Body(shape, pose),))


def line(number: int) -> Origin:
    text = "move\n" * 50
    source = Source("moves.txt", text.encode(), text, "utf-8")
    return Origin(source, 5 * (number - 1), 5 * number - 1)


def driven(model: RobotModel, *requests: MoveRequest, start: Sequence[float], pause_s: float = 0.0) -> RunResult:
    """The run of a program whose line n makes the n-th of these moves."""
    joints, clock, events = np.array(start, dtype=np.float64), 0.0, []
    for number, request in enumerate(requests, start=1):
        move = plan(model, joints, request)
        assert isinstance(move, PlannedMove), move
        events.append(Event(clock, "main", "move", {}, line(number), legs=(Leg(move, clock, move.duration_s),)))
        clock, joints = clock + move.duration_s + pause_s, move.end_joints
    return RunResult("finished", clock, len(events), len(events), (), (), None, tuple(events), tuple(joints))


def to_joints(*values: float, speed: float = 1.0) -> MoveRequest:
    return MoveRequest("joint", target_joints=np.array(values, dtype=np.float64), joint_speed=speed)


def straight(pose: FloatArray, mm_s: float = 250.0, tool: FloatArray | None = None) -> MoveRequest:
    more = {} if tool is None else {"tool": tool}
    return MoveRequest("linear", target_pose=pose, path_speed_mm_s=mm_s, path_acc_mm_s2=10.0 * mm_s, **more)


def standing(model: RobotModel, joints: Sequence[float], time_s: float) -> RunResult:
    return RunResult("finished", time_s, 0, 0, (), (), None, (), tuple(joints))


def cell(layout: Layout, *robots: tuple[RobotModel, RunResult], **more: object) -> CellRun:
    """A run of the robots of a layout, in their order."""
    places = layout.robots or (RobotPlace(),)
    runs = tuple(RobotRun(place, model, PROGRAM, result) for place, (model, result) in zip(places, robots, strict=True))
    return CellRun(layout, runs, time_s=max(result.time_s for _, result in robots), **more)  # type: ignore[arg-type]

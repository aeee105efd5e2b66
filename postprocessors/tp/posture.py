"""CONFIG of points whose posture nobody said: the one nearest to the point before, on the arm that runs the program.

A taught position of TP always has a posture. Other languages have poses without one, and their controllers keep the
posture they are in.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from rpl import registry

from .frames import Frames
from .positions import Points, Position

if TYPE_CHECKING:
    from rpl.emulator.model import RobotModel
    from rpl.emulator.rotations import FloatArray


def choose_postures(points: Points, frames: Frames, robot: RobotModel) -> list[int]:
    """Fill in the flags of points without any, in the order of the moves; the numbers of those filled in."""
    make = registry.dialect("tp").notation
    if make is None:
        return []
    notation, near, filled = make(), robot.home, []
    for number, frame, tool in points.order:
        position = points.found.get(number)
        if position is None:
            continue  # reported where it is declared
        if position.kind == "joints":
            if len(position.values) == robot.axes:
                near = _array(position.values)
            continue
        flange = _flange(position, frame, tool, frames) if position.kind == "pose" else None
        if flange is None:
            continue
        if position.flags:
            joints = notation.select(robot, flange, dict(position.flags), near).joints
        else:
            joints = robot.nearest(flange, near)
            if joints is not None:
                points.found[number] = position.with_flags(notation.encode(robot, joints))
                filled.append(number)
        near = near if joints is None else joints
    return filled


def assumed_postures(points: Points, frames: Frames, robot: RobotModel, first: tuple[float, ...]) -> list[int]:
    """Flags for poses that no move goes to as they are (registers get them), nearest to the joints `first` (else the
    arm's home), with the only tool and frame that the program has."""
    make = registry.dialect("tp").notation
    if make is None:
        return []
    notation, filled = make(), []
    near = _array(first) if len(first) == robot.axes else robot.home
    moved_to = {number for number, _, _ in points.order}
    for number, position in points.found.items():
        if position.kind != "pose" or position.flags or number in moved_to or number in points.recorded:
            continue
        flange = _flange(position, _usual("UFRAME", frames), _usual("UTOOL", frames), frames)
        joints = None if flange is None else robot.nearest(flange, near)
        if joints is not None:
            points.found[number] = position.with_flags(notation.encode(robot, joints))
            filled.append(number)
    return filled


def _usual(word: str, frames: Frames) -> str:
    """The number that the program selects, when it selects one beside that of nothing at all."""
    return frames.only(word) or next(iter(sorted(frames.selected[word] - {"0"})), "0")


def _flange(position: Position, frame: str, tool: str, frames: Frames) -> FloatArray | None:
    import numpy as np

    base = frames.pose("UFRAME", frame or frames.only("UFRAME"))
    held = frames.pose("UTOOL", tool or frames.only("UTOOL"))
    if base is None or held is None:
        return None
    found = _matrix(base) @ _matrix(position.values) @ np.linalg.inv(_matrix(held))
    return np.asarray(found, dtype=np.float64)


def _matrix(values: tuple[float, ...]) -> FloatArray:
    from rpl.emulator.rotations import pose_matrix, zyx_to_matrix

    return pose_matrix(list(values[:3]), zyx_to_matrix(list(values[3:6])))


def _array(values: tuple[float, ...]) -> FloatArray:
    import numpy as np

    return np.array(values, dtype=np.float64)

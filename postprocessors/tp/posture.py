"""CONFIG of points whose posture nobody said: the one nearest to the point before, on the arm that runs the program.

A taught position of TP always has a posture. Other languages have poses without one, and their controllers keep the
posture they are in.
"""

from __future__ import annotations

import re
from collections.abc import Iterable
from typing import TYPE_CHECKING

from rpl import registry

from .frames import Frames
from .lines import Line
from .positions import Points, Position, Reached

if TYPE_CHECKING:
    from rpl.emulator.model import RobotModel
    from rpl.emulator.rotations import FloatArray


def choose_postures(points: Points, frames: Frames, robot: RobotModel) -> list[tuple[Reached, str]]:
    """Fill in the flags of points without any, in the order of the moves. A path comes to its point in the turns that
    the axes are in, whatever the point tells.

    The first joint move to each point whose flags the arm cannot follow inside its limits, with the reason."""
    make = registry.dialect("tp").notation
    if make is None:
        return []
    notation, near = make(), robot.home
    wrong: dict[int, tuple[Reached, str]] = {}
    for reached in points.order:
        number, frame, tool, joint = reached.number, reached.frame, reached.tool, reached.joint
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
        if position.flags and joint:
            selection = notation.select(robot, flange, dict(position.flags), near)
            joints = selection.joints
            if joints is None:
                wrong.setdefault(number, (reached, selection.reason))
        else:
            joints = robot.nearest(flange, near)
            if joints is not None and not position.flags:
                points.found[number] = position.with_flags(notation.encode(robot, joints))
        near = near if joints is None else joints
    return list(wrong.values())


_REGISTER = r"PR\[(\d+)(?::[^\]]*)?\]"
_STORED = re.compile(rf"\s*{_REGISTER}=P\[(\d+)")
_COPIED = re.compile(rf"\s*{_REGISTER}=(.*)")
_TURNED = re.compile(r"\s*PR\[(\d+),[456][:\]]")
_MOVED = re.compile(rf"(?:[JLC]|\s)\s*{_REGISTER}\s(?!.*Offset)")


def moved_to(lines: Iterable[Line]) -> frozenset[int] | None:
    """Registers whose value goes to a move with the rotation it has, by itself or copied; None when any may, since
    moves or copies compute the number."""
    turned, moved, copies = set[int](), set[int](), list[tuple[int, list[int]]]()
    for text in (one for line in lines for one in (line.first, *line.further)):
        if re.search(r"PR\[A?R\[", text):
            return None
        if found := _TURNED.match(text):
            turned.add(int(found[1]))
        elif found := _COPIED.match(text):
            copies.append((int(found[1]), [int(one) for one in re.findall(_REGISTER, found[2])]))
        elif found := _MOVED.match(text):
            moved.add(int(found[1]))
    while more := {one for to, given in copies if to in moved - turned for one in given} - moved:
        moved |= more
    return frozenset(moved)


def frames_only(lines: list[Line], moved: frozenset[int] | None) -> frozenset[int]:
    """Points of a program that registers get but no move goes to: places are only computed from them, with another
    rotation than theirs."""
    stored = [(int(found[2]), int(found[1])) for line in lines if (found := _STORED.match(line.first))]
    reached = {point for point, register in stored if moved is None or register in moved}
    return frozenset(point for point, _ in stored) - reached


def assumed_postures(
    points: Points, frames: Frames, robot: RobotModel, first: tuple[float, ...], computed_from: frozenset[int]
) -> list[int]:
    """Flags for poses that no move goes to as they are (registers get them), nearest to the joints `first` (else the
    arm's home), with the only tool and frame that the program has; those that places are only `computed_from` hand
    on the posture of `first` itself."""
    make = registry.dialect("tp").notation
    if make is None:
        return []
    notation, filled = make(), []
    near = _array(first) if len(first) == robot.axes else robot.home
    in_moves = {one.number for one in points.order}
    for number, position in points.found.items():
        if position.kind != "pose" or position.flags or number in in_moves or number in points.recorded:
            continue
        if number in computed_from:
            points.found[number] = position.with_flags(notation.encode(robot, near))
            filled.append(number)
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

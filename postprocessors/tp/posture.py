"""CONFIG of points whose posture nobody said: the one nearest to the point before, on the arm that runs the program.

A taught position of TP always has a posture. Other languages have poses without one, and their controllers keep the
posture they are in.
"""

from __future__ import annotations

import re
from collections.abc import Iterable
from dataclasses import replace
from itertools import islice
from typing import TYPE_CHECKING, cast

from rpl import registry

from .frames import Frames
from .lines import Line
from .positions import Points, Position, Reached

if TYPE_CHECKING:
    from rpl.emulator.configuration import BatchNotation, Notation
    from rpl.emulator.model import RobotModel
    from rpl.emulator.rotations import FloatArray, IntArray


def choose_postures(points: Points, frames: Frames, robot: RobotModel) -> list[tuple[Reached, str]]:
    """Fill in the flags of points without any, in the order of the moves. A path comes to its point in the turns that
    the axes are in, whatever the point tells.

    The first joint move to each point whose flags the arm cannot follow inside its limits, with the reason."""
    make = registry.dialect("tp").notation
    if make is None:
        return []
    notation, near, order, at = make(), robot.home, points.order, 0
    wrong: dict[int, tuple[Reached, str]] = {}
    while at < len(order):
        end = _together(points, at)
        position = points.found.get(order[at].number)
        if position is None:
            pass  # reported where it is declared
        elif position.kind == "joints":
            near = _array(position.values) if len(position.values) == robot.axes else near
        elif position.kind == "pose":
            near = _chosen(order[at:end], points, frames, robot, notation, near, wrong)
        at = end
    return list(wrong.values())


def _together(points: Points, first: int) -> int:
    """Up to where moves go to poses, each to another one, with one tool and frame."""
    asked, found, seen = points.order[first], points.found, set[int]()
    for at, one in enumerate(islice(points.order, first, None), first):
        position = found.get(one.number)
        pose = position is not None and position.kind == "pose" and one.number not in seen
        if not pose or one.tool != asked.tool or one.frame != asked.frame:
            return max(at, first + 1)
        seen.add(one.number)
    return len(points.order)


def _chosen(
    moves: list[Reached],
    points: Points,
    frames: Frames,
    robot: RobotModel,
    notation: Notation,
    near: FloatArray,
    wrong: dict[int, tuple[Reached, str]],
) -> FloatArray:
    """Fill in the flags of the points of such moves; the joints behind the last one. Points of joint moves whose flags
    the arm cannot follow go to `wrong`."""
    import numpy as np

    from rpl.emulator.configuration import flag_row
    from rpl.emulator.onways import Nearest, followed

    positions = [points.found[one.number] for one in moves]
    flanges = _flanges(positions, moves[0].frame, moves[0].tool, frames)
    if flanges is None:
        return near
    nearest, many = (
        Nearest(robot, flanges),
        cast("BatchNotation", notation),
    )
    exact = np.array([bool(position.flags) and one.joint for position, one in zip(positions, moves, strict=True)])
    flags = np.concatenate([flag_row(notation.fields, dict(one.flags)) for one in positions]) if exact.any() else exact

    def solve(rows: IntArray, before: FloatArray) -> FloatArray:
        joints = np.empty((len(rows), robot.axes))
        asked = exact[rows]
        if not asked.all():
            joints[~asked] = nearest(rows[~asked], before[~asked])
        if asked.any():
            some = rows[asked]
            joints[asked] = many.select_all(robot, flanges[some], flags[some], before[asked]).joints
        return joints

    joints, before = followed(solve, near, len(moves))
    there = ~np.isnan(joints[:, 0])
    for at in np.flatnonzero(exact & ~there).tolist():
        selection = notation.select(robot, flanges[at], dict(positions[at].flags), before[at])
        wrong.setdefault(moves[at].number, (moves[at], selection.reason))
    unsaid = there & np.array([not one.flags for one in positions])
    names, shared = notation.fields, dict[tuple[int, ...], tuple[tuple[str, int], ...]]()
    found = many.encode_all(robot, joints[unsaid]).tolist() if unsaid.any() else []
    for at, row in zip(np.flatnonzero(unsaid).tolist(), map(tuple, found), strict=True):
        told = shared.setdefault(row, tuple(zip(names, row, strict=True)))
        points.found[moves[at].number] = replace(positions[at], flags=told)
    return joints[there][-1] if there.any() else near


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
    found = _flanges([position], frame, tool, frames)
    return None if found is None else found[0]


def _flanges(positions: list[Position], frame: str, tool: str, frames: Frames) -> FloatArray | None:
    """Flange poses (k, 4, 4) at these poses."""
    import numpy as np

    from rpl.emulator.rotations import pose_matrix, zyx_to_matrix

    base = frames.pose("UFRAME", frame or frames.only("UFRAME"))
    held = frames.pose("UTOOL", tool or frames.only("UTOOL"))
    if base is None or held is None:
        return None
    values = np.array([one.values for one in positions], dtype=np.float64)
    poses = pose_matrix(values[:, :3], zyx_to_matrix(values[:, 3:6]))
    return np.asarray(_matrix(base) @ poses @ np.linalg.inv(_matrix(held)), dtype=np.float64)


def _matrix(values: tuple[float, ...]) -> FloatArray:
    from rpl.emulator.rotations import pose_matrix, zyx_to_matrix

    return pose_matrix(list(values[:3]), zyx_to_matrix(list(values[3:6])))


def _array(values: tuple[float, ...]) -> FloatArray:
    import numpy as np

    return np.array(values, dtype=np.float64)

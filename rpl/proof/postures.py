"""What a controller did with a move otherwise than the program asks: left it out, cut it short, or drove it in another
posture of the arm. A tool may go the same way then, and the steel does not.

A posture family is front or back of axis 1, elbow up or down, wrist turned over or not. Near the boundary of two of
them a side says nothing, so that no verdict hangs on rounding.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from rpl.proof.difference import Difference, Side
from rpl.proof.record import Family, LeftOut, place_of

if TYPE_CHECKING:
    from rpl.emulator.model import RobotModel
    from rpl.emulator.rotations import FloatArray
    from rpl.proof.record import Stretch
    from rpl.runtime.trace import Event

LEFT_OUT, CUT_SHORT = "overlapping-blends", "corner-path-failure"
# A side that changes when one axis moves by this much (degrees, mm) says nothing.
BOUNDARY = 0.01
_WORDS = (("front", "back"), ("elbow up", "elbow down"), ("wrist not turned over", "wrist turned over"))


def family_of(robot: RobotModel, joints: FloatArray) -> Family | None:
    """The family of joints (n,); None for an arm without families."""
    from rpl.emulator.postures import has_flags, sides
    from rpl.emulator.recognise import PlacedArm

    if not has_flags(robot) or len(joints) != robot.axes:
        return None
    steps = np.concatenate([np.zeros((1, robot.axes)), np.eye(robot.axes) * BOUNDARY, np.eye(robot.axes) * -BOUNDARY])
    found = sides(robot, joints + steps)
    sure = (found == found[0]).all(axis=0)
    words = [_WORDS[number][int(found[0, number])] if sure[number] else "" for number in range(3)]
    arm = robot.arm.arm if isinstance(robot.arm, PlacedArm) else robot.arm
    return Family(type(arm).__name__, *words)


def left_out(trace: Sequence[Event]) -> dict[str, tuple[LeftOut, ...]]:
    """The moves of each task that its controller left out or shortened."""
    found: dict[str, list[LeftOut]] = {}
    for event in trace:
        if event.kind == "warning" and event.data.get("code") == LEFT_OUT:
            one = LeftOut(
                place_of(event.origin), event.t, not event.data.get("left_out"), str(event.data.get("text", ""))
            )
            found.setdefault(event.task, []).append(one)
    return {task: tuple(moves) for task, moves in found.items()}


def noted(
    stretches: Sequence[Stretch], moves: Sequence[Event], trace: Sequence[Event], robot: RobotModel | None
) -> tuple[Stretch, ...]:
    """Stretches, one for each of these moves of a trace, with the family of their goals and whether the controller cut
    them short."""
    short = _cut_short(trace)
    return tuple(
        replace(stretch, family=_goal_family(move, robot), cut_short=id(move) in short)
        for stretch, move in zip(stretches, moves, strict=True)
    )


def _goal_family(move: Event, robot: RobotModel | None) -> Family | None:
    joints = move.data.get("joints")
    if robot is None or not isinstance(joints, list) or move.data.get("interrupted"):
        return None
    return family_of(robot, np.asarray(joints, dtype=float))


def _cut_short(trace: Sequence[Event]) -> set[int]:
    """The moves (by identity) whose corner became a stop, as the controller logs at their line before they end."""
    waiting: set[tuple[str, str, int]] = set()
    found: set[int] = set()
    for event in trace:
        key = (event.task, event.origin.file, event.origin.line)
        if event.kind == "warning" and event.data.get("code") == CUT_SHORT:
            waiting.add(key)
        elif event.kind == "move" and key in waiting:
            waiting.discard(key)
            found.add(id(event))
    return found


def posture_difference(task: str, a: Stretch, b: Stretch) -> Difference | None:
    """Do both programs drive to the goal of a move in the same posture? For arms of one build; families that are on a
    boundary on either side are not compared."""
    if a.family is None or b.family is None:
        return None
    apart = a.family.differs(b.family)
    if not apart:
        return None
    ours, theirs = (", ".join(pair[number] for pair in apart) for number in (0, 1))
    text = f"the arm comes there in another posture: {ours} in A, {theirs} in B"
    return Difference("posture", "geometry", text, _side(a, ours), _side(b, theirs), task)


def cut_short_difference(task: str, a: Stretch, b: Stretch) -> Difference | None:
    """Does one controller come to rest in place of a corner because the next move comes too late, and the other not?"""
    if a.cut_short == b.cut_short or a.stops == b.stops:
        return None
    who = "A" if a.cut_short else "B"
    text = f"{who} comes to rest in place of a corner: its next move comes too late for the controller"
    return Difference("stop", "geometry", text, _side(a, "a corner"), _side(b, "a corner"), task)


def left_out_difference(
    a: Mapping[str, Sequence[LeftOut]], b: Mapping[str, Sequence[LeftOut]], same_language: bool
) -> Difference | None:
    """The first move that the controller of B leaves out, or shortens, more often than that of A. What A's controller
    leaves out is what A means: whether B does without it as well is seen on the way of the tool, unless both programs
    are in one language."""
    for task in [*b, *(one for one in a if one not in b)]:
        ours, theirs = a.get(task, () if len(a) != 1 else next(iter(a.values()))), b.get(task, ())
        if len(theirs) > len(ours):
            return _left_out(task, None, theirs[len(ours)])
        if same_language and len(ours) > len(theirs):
            return _left_out(task, ours[len(theirs)], None)
    return None


def _left_out(task: str, ours: LeftOut | None, theirs: LeftOut | None) -> Difference:
    one = ours if ours is not None else theirs
    assert one is not None  # one of them is given
    what = "is made with smaller corners than the program says" if one.driven else "is left out by the controller"
    text = f"a move {what} in {'A' if ours is not None else 'B'} only: {one.text}"
    a, b = (Side("makes the move") if side is None else Side(what, side.place, side.t) for side in (ours, theirs))
    return Difference("left-out", "geometry", text, a, b, task)


def _side(stretch: Stretch, what: str) -> Side:
    return Side(f"{stretch.motion} move: {what}", stretch.place, float(stretch.times[0]))


__all__ = [
    "Family",
    "LeftOut",
    "cut_short_difference",
    "family_of",
    "left_out",
    "left_out_difference",
    "noted",
    "posture_difference",
]

"""The way of the tool in two runs: the same way, the same joints, the same that is asked of each move.

Between two controllers corners are measured (corners.py): what they make different is a deviation. Everything else that
is apart is a difference.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from rpl.proof.asked import compare_asked
from rpl.proof.corners import Corner, aside, between, corner_behind, ways
from rpl.proof.difference import Difference, Side
from rpl.proof.findings import Findings
from rpl.proof.groups import Group, aligned, beside
from rpl.proof.paths import Gap, gap
from rpl.proof.postures import cut_short_difference, left_out_difference, posture_difference
from rpl.proof.record import Record, Stretch
from rpl.proof.tolerance import Tolerance


@dataclass(frozen=True, slots=True)
class Pairing:
    """What two records have in common, and how far their ways may be apart. limit_mm: a way that is further apart is
    another one; up to there it deviates."""

    same_arm: bool
    same_language: bool
    tolerance: Tolerance
    limit_mm: float


@dataclass(frozen=True, slots=True)
class Driven:
    """The moves of one task, side by side; the numbers of the groups behind which a corner deviates, and of those that
    hang on where a sensor answered."""

    groups: tuple[Group, ...]
    loose: frozenset[int] = frozenset()
    sensed: frozenset[int] = frozenset()

    def near_sensor(self, *numbers: int) -> bool:
        """Is one of the moves from the first of these groups to the last, or one beside them, ended by a sensor?"""
        return any(number in self.sensed for number in range(min(numbers) - 1, max(numbers) + 2))


def compare_motion(
    a: Record, b: Record, pairing: Pairing, found: Findings
) -> tuple[Difference | None, dict[str, Driven]]:
    """The first difference of the ways, and the moves by the task of A; deviations go to `found`."""
    driven: dict[str, Driven] = {}
    first = left_out_difference(a.left_out, b.left_out, pairing.same_language)
    for task in dict.fromkeys((*a.motion, *b.motion)):
        ours, theirs = _of(a, b, task), _of(b, a, task)
        if task not in a.motion and ours:
            continue  # the only robot of B, which A calls otherwise: compared there
        difference, driven[task] = _task(task, ours, theirs, pairing, found)
        first = first or difference
    return first, driven


def _of(record: Record, other: Record, task: str) -> Sequence[Stretch]:
    """The moves of a task; of the only robot where the task is another's name for it."""
    if task in record.motion:
        return record.motion[task]
    alone = len(record.motion) == 1 and len(other.motion) == 1
    return next(iter(record.motion.values())) if alone else ()


def _task(
    task: str, ours: Sequence[Stretch], theirs: Sequence[Stretch], pairing: Pairing, found: Findings
) -> tuple[Difference | None, Driven]:
    groups = aligned(ours, theirs)
    loose: set[int] = set()
    sensed = frozenset() if pairing.same_language else _sensed(groups, pairing.tolerance)
    first: Difference | None = None
    for number, (a, b) in enumerate(groups):
        found.compared += 1
        if number in sensed:
            difference = _by_sensor(task, groups[number], pairing, found)
        else:
            difference = _group(task, groups, number, pairing, found, loose)
        difference = difference or _asked(task, groups[number], number in sensed, pairing, found)
        if a and b and number not in sensed:
            ends = a[-1], b[-1]
            difference = difference or posture_difference(task, *ends) or cut_short_difference(task, *ends)
        first = first or difference
    for number in sorted(loose):
        _measure(task, groups, number, pairing.tolerance, found)
    return first, Driven(tuple(groups), frozenset(loose), sensed)


def _asked(task: str, group: Group, sensed: bool, pairing: Pairing, found: Findings) -> Difference | None:
    """What both programs ask of the moves of a group; of moves that a sensor divides only where they are single."""
    whole = len(group[0]) == len(group[1]) == 1
    if sensed and not whole:
        return None
    first: Difference | None = None
    for pair in beside(group):
        stands = pairing.same_arm and whole and not sensed
        difference = compare_asked(task, pair, whole, stands, pairing.same_language, pairing.tolerance, found)
        first = first or difference
    return first


def _group(
    task: str, groups: Sequence[Group], number: int, pairing: Pairing, found: Findings, loose: set[int]
) -> Difference | None:
    """Compare one group. Corners that make its ways differ are added to `loose`."""
    a, b = groups[number]
    if not a or not b:
        return Difference("move", "geometry", f"only {'A' if a else 'B'} moves here", move_side(a), move_side(b), task)
    tolerance = pairing.tolerance
    foreign = not pairing.same_language
    corners = (corner_behind(groups, number - 1), corner_behind(groups, number)) if foreign else (None, None)
    for place, corner in zip((number - 1, number), corners, strict=True):
        if corner is not None and corner.stops[0] != corner.stops[1]:
            loose.add(place)
    joint_way = any(stretch.motion == "joint" for stretch in (*a, *b))
    if joint_way and not pairing.same_arm:  # two arms bend differently between the same points
        return _ends(task, groups[number], corners[1], pairing, found)
    worst = gap(*ways(groups[number]))
    if not _apart(worst, tolerance):
        found.apart(worst.mm)
    elif any(corner is not None for corner in corners):
        loose |= {place for place, one in zip((number - 1, number), corners, strict=True) if one is not None}
        rest = between(groups[number], *corners)
        left = gap(*rest) if rest is not None else None
        difference = _goals(task, a[-1], b[-1], corners[1], pairing, found)
        if difference is not None:
            return difference
        if left is not None and _apart(left, tolerance):
            return _another_way(task, groups[number], left, pairing, found)
    else:
        difference = _another_way(task, groups[number], worst, pairing, found)
        if difference is not None:
            return difference
    difference = _apart_aims(task, a, b, pairing)
    if difference is not None:
        return difference
    return _joints(task, a, b, pairing, found)


def _by_sensor(task: str, group: Group, pairing: Pairing, found: Findings) -> Difference | None:
    """Moves that hang on where a sensor answered: how far apart they are left, and whether they were to be one."""
    worst = gap(*ways(group))
    found.apart(worst.mm)
    if worst.mm > pairing.tolerance.path_mm:
        text = f"where a sensor ends the move, or behind it, the tool is up to {worst.mm:.3f} mm apart"
        found.deviates("sensed", worst.mm, text, move_side(group[0]), move_side(group[1]), task)
    a, b = group
    if len(a) == len(b) == 1 and a[0].motion != b[0].motion and worst.mm > pairing.tolerance.path_mm:
        text = f"beside what a sensor ends A makes a {a[0].motion} move, B a {b[0].motion} one"
        return Difference("move", "geometry", text, move_side(a), move_side(b), task)
    return _apart_aims(task, a, b, pairing)


def _apart(worst: Gap, tolerance: Tolerance) -> bool:
    return worst.mm > tolerance.path_mm or worst.deg > tolerance.turn_deg


def _another_way(task: str, group: Group, worst: Gap, pairing: Pairing, found: Findings) -> Difference | None:
    """Ways that are apart: a deviation as far as somebody accepts that, else a difference."""
    found.apart(worst.mm)
    text = (
        f"the tool goes another way: {worst.mm:.3f} mm and {worst.deg:.3f} deg apart"
        f" at ({_xyz(worst.a)}) in A, ({_xyz(worst.b)}) in B"
    )
    sides = move_side(group[0]), move_side(group[1])
    if worst.mm <= pairing.limit_mm and worst.deg <= pairing.tolerance.turn_deg:
        found.deviates("path", worst.mm, text, *sides, task)
        return None
    return Difference("path", "geometry", text, *sides, task)


def _ends(task: str, group: Group, corner: Corner | None, pairing: Pairing, found: Findings) -> Difference | None:
    """Of joint moves of two arms: where they end, or head for where one of them passes."""
    a, b = group[0][-1], group[1][-1]
    if corner is not None or not (a.stops and b.stops):
        return _goals(task, a, b, corner, pairing, found)
    worst = gap(a.poses[-1:], b.poses[-1:])
    if not _apart(worst, pairing.tolerance):
        found.apart(worst.mm)
        return None
    return _another_way(task, group, worst, pairing, found)


def _goals(
    task: str, a: Stretch, b: Stretch, corner: Corner | None, pairing: Pairing, found: Findings
) -> Difference | None:
    """Moves at a corner: both must head for the same point."""
    if corner is None or (a.cut and b.cut):
        return None
    return _apart_goals(task, a, b, pairing, found)


def _apart_aims(task: str, a: Sequence[Stretch], b: Sequence[Stretch], pairing: Pairing) -> Difference | None:
    """Moves that both are ended on their way: the way alone does not show where they were to go."""
    if len(a) != 1 or len(b) != 1 or not (a[0].cut and b[0].cut) or a[0].motion != b[0].motion:
        return None
    aims = a[0].aim, b[0].aim
    if aims[0] is None or aims[1] is None:
        return None
    worst = gap(aims[0][None], aims[1][None])
    if not _apart(worst, pairing.tolerance):
        return None
    text = f"the moves that are ended on their way head for points {worst.mm:.3f} mm and {worst.deg:.3f} deg apart"
    return Difference("path", "geometry", text, move_side(a), move_side(b), task)


def _apart_goals(task: str, a: Stretch, b: Stretch, pairing: Pairing, found: Findings) -> Difference | None:
    if a.goal is None or b.goal is None:
        return None
    apart = float(np.linalg.norm(a.goal[:3] - b.goal[:3]))
    chord = min(float(np.linalg.norm(a.goal[3:] - b.goal[3:])), float(np.linalg.norm(a.goal[3:] + b.goal[3:])))
    turn = float(np.degrees(4.0 * np.arcsin(min(0.5 * chord, 1.0))))
    found.apart(apart)
    if apart <= pairing.tolerance.path_mm and turn <= pairing.tolerance.turn_deg:
        return None
    text = f"the moves head for points that are {apart:.3f} mm and {turn:.3f} deg apart"
    return Difference("path", "geometry", text, move_side([a]), move_side([b]), task)


def _measure(task: str, groups: Sequence[Group], number: int, tolerance: Tolerance, found: Findings) -> None:
    """How far apart two controllers pass a corner."""
    corner = corner_behind(groups, number)
    if corner is None:
        return
    (a, b), behind = groups[number], groups[number + 1]
    sides = move_side(a), move_side(b)
    if corner.stops[0] != corner.stops[1]:
        text = f"{'A' if corner.stops[0] else 'B'} comes to rest where the other goes on"
        found.deviates("stop", 1.0, text, *sides, task)
    mm, deg = aside(groups, number, corner)
    found.apart(mm)
    if mm > tolerance.path_mm:
        then = " / ".join(f"line {one[0].place.line}" for one in behind if one[0].place.line)
        text = f"the tool passes the corner {mm:.3f} mm and {deg:.3f} deg apart" + (f", before {then}" if then else "")
        found.deviates("corner", mm, text, *sides, task)
    if deg > tolerance.turn_deg:
        found.deviates("turning", deg, f"in the corner the tool is turned {deg:.3f} deg apart", *sides, task)


def _sensed(groups: Sequence[Group], tolerance: Tolerance) -> frozenset[int]:
    """Moves that both programs leave on the way when a sensor answers, and those from there up to one that begins at
    the same place again: where the sensor answered depends on how fast each controller accelerates."""
    found: set[int] = set()
    for number, (a, b) in enumerate(groups):
        if not a or not b:
            continue
        apart = float(np.linalg.norm(a[0].poses[0, :3, 3] - b[0].poses[0, :3, 3]))
        carried = number - 1 in found and apart > tolerance.path_mm
        if carried or (a[-1].cut and b[-1].cut):
            found.add(number)
    return frozenset(found)


def _joints(
    task: str, a: Sequence[Stretch], b: Sequence[Stretch], pairing: Pairing, found: Findings
) -> Difference | None:
    first, second = a[-1], b[-1]
    if not (first.stops and second.stops):
        return None
    if not (first.cut or second.cut):
        difference = _external(task, first, second, pairing)
        if difference is not None:
            return difference
    if not (pairing.same_arm and len(first.joints) == len(second.joints)):
        return None
    apart = np.abs(first.joints - second.joints)
    found.max_joint_deg = max(found.max_joint_deg, float(apart.max(initial=0.0)))
    if apart.max(initial=0.0) <= pairing.tolerance.joint_deg:
        return None
    axis = int(np.argmax(apart))
    text = (
        f"the arm stands differently: axis {axis + 1} at {first.joints[axis]:.3f} in A, {second.joints[axis]:.3f} in B"
    )
    return Difference("joints", "geometry", text, move_side(a), move_side(b), task)


def _external(task: str, a: Stretch, b: Stretch, pairing: Pairing) -> Difference | None:
    """External axes are the cell's, so they are the same ones for another arm too."""
    if a.external is None or b.external is None or len(a.external) != len(b.external):
        return None
    apart = np.abs(a.external - b.external)
    if apart.max(initial=0.0) <= pairing.tolerance.joint_deg:
        return None
    axis = int(np.argmax(apart))
    text = f"external axis {axis + 1} stands at {a.external[axis]:.3f} in A, at {b.external[axis]:.3f} in B"
    return Difference("joints", "geometry", text, move_side([a]), move_side([b]), task)


def _xyz(point: tuple[float, float, float]) -> str:
    return ", ".join(f"{value:.3f}" for value in point)


def move_side(group: Sequence[Stretch]) -> Side:
    """The last move of a group, in words and with its place."""
    if not group:
        return Side(None)
    last = group[-1]
    x, y, z = (float(value) for value in last.poses[-1, :3, 3])
    return Side(f"{last.motion} move to ({x:.3f}, {y:.3f}, {z:.3f})", last.place, float(last.times[0]))


__all__ = ["Driven", "Pairing", "compare_motion", "move_side"]

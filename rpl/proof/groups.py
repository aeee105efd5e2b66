"""The moves of two runs side by side: move against move, or from stop to stop where one language says with several
moves what another says with one (splines, relative moves).
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from rpl.proof.paths import length_mm
from rpl.proof.record import Stretch

if TYPE_CHECKING:
    from rpl.emulator.rotations import FloatArray

# Moves of two programs whose goals are that near to each other head for one point.
SAME_GOAL_MM = 0.1
# Axes that are that near (deg or mm) to each other stand alike.
_SAME_AXIS = 1e-3
# Moves that share less of a way (mm, share of the shorter one) only touch there: corners shift where a move ends.
_SHARED_MM, _SHARED = 2.0, 0.2

Group = tuple[Sequence[Stretch], Sequence[Stretch]]


def aligned(a: Sequence[Stretch], b: Sequence[Stretch]) -> list[Group]:
    """The moves of two runs, without those to where the robot already is, in groups that belong together."""
    return _grouped(_rejoined(_going(a)), _rejoined(_going(b)))


def _going(stretches: Sequence[Stretch]) -> list[Stretch]:
    """Those that move anything: a tool that stands on its part while a table turns is led by the arm."""
    before: Sequence[Stretch | None] = (None, *stretches)
    return [one for one, last in zip(stretches, before, strict=False) if not _stands(one, last)]


def _grouped(a: Sequence[Stretch], b: Sequence[Stretch]) -> list[Group]:
    """Move against move where both have the same; else, from the first two that differ in kind or goal, up to the next
    stop, because one language says with several moves what another says with one (splines, relative moves)."""
    if [stretch.motion for stretch in a] == [stretch.motion for stretch in b]:
        return [([one], [other]) for one, other in zip(a, b, strict=True)]
    groups: list[Group] = []
    at, there = 0, 0
    while at < len(a) or there < len(b):
        end, other = _behind_stop(a, at), _behind_stop(b, there)
        if end > at and other > there and _alike(a[at], b[there]):
            end, other = at + 1, there + 1
        groups += _parted(a[at:end], b[there:other])
        at, there = end, other
    return groups


def _parted(a: Sequence[Stretch], b: Sequence[Stretch]) -> list[Group]:
    """Moves up to a stop, in groups that end at the points that both head for, in their order."""
    groups: list[Group] = []
    at, there = 0, 0
    for end, stretch in enumerate(a[:-1], 1):
        found = (other for other, one in enumerate(b[there:-1], there + 1) if _same_goal(stretch, one))
        other = next(found, None)
        if other is not None:
            groups.append((a[at:end], b[there:other]))
            at, there = end, other
    return [*groups, (a[at:], b[there:])]


def _same_goal(one: Stretch, other: Stretch) -> bool:
    if one.goal is None or other.goal is None:
        return False
    return float(np.linalg.norm(one.goal[:3] - other.goal[:3])) < SAME_GOAL_MM


def _alike(one: Stretch, other: Stretch) -> bool:
    """Two moves of one kind that head for the same point and both stop there, or both do not."""
    return one.motion == other.motion and one.stops == other.stops and _same_goal(one, other)


def _behind_stop(stretches: Sequence[Stretch], begin: int) -> int:
    """Where the next move begins at rest, from a place of the row on."""
    for number in range(begin, len(stretches)):
        if stretches[number].stops:
            return number + 1
    return len(stretches)


def _rejoined(stretches: list[Stretch]) -> list[Stretch]:
    """A move that was stopped on its way and begun again from there to the same point is one move."""
    done: list[Stretch] = []
    for stretch in stretches:
        last = done[-1] if done else None
        if last is not None and last.cut and _goes_on(last, stretch):
            poses, times = np.concatenate((last.poses, stretch.poses)), np.concatenate((last.times, stretch.times))
            corner_at = None if stretch.corner_at is None else stretch.corner_at + len(last.poses)
            done[-1] = replace(stretch, poses=poses, times=times, corner_at=corner_at)
        else:
            done.append(stretch)
    return done


def _goes_on(cut: Stretch, stretch: Stretch) -> bool:
    """Does a straight move go on from where another one was cut, in its direction?"""
    if not cut.motion == stretch.motion == "linear" or np.abs(cut.poses[-1] - stretch.poses[0]).max() > 1e-3:
        return False
    before, behind = (one.poses[-1, :3, 3] - one.poses[0, :3, 3] for one in (cut, stretch))
    lengths = float(np.linalg.norm(before) * np.linalg.norm(behind))
    return lengths > 0.0 and float(before @ behind) > (1.0 - 1e-8) * lengths


def _stands(stretch: Stretch, last: Stretch | None) -> bool:
    """A move to where the robot and its external axes already are behind the last move."""
    apart = np.abs(stretch.poses[:, :3, :] - stretch.poses[:1, :3, :]).max(initial=0.0)
    if apart >= 1e-6:
        return False
    return last is None or not (_other(last.joints, stretch.joints) or _other(last.external, stretch.external))


def _other(before: FloatArray | None, behind: FloatArray | None) -> bool:
    if before is None or behind is None or len(before) != len(behind):
        return False
    return bool(np.abs(before - behind).max(initial=0.0) > _SAME_AXIS)


def beside(group: Group) -> Iterator[tuple[Stretch, Stretch]]:
    """Moves of a group that drive the same part of the way, and those at its end: one may ask something else of it than
    the other."""
    a, b = group
    if len(a) == len(b) == 1:
        yield a[0], b[0]
        return
    spans = [_shares(side) for side in group]
    for one, (begin, end) in zip(a, spans[0], strict=True):
        for other, (since, until) in zip(b, spans[1], strict=True):
            shared = min(end, until) - max(begin, since)
            if shared > max(_SHARED_MM, _SHARED * min(end - begin, until - since)):
                yield one, other


def _shares(side: Sequence[Stretch]) -> list[tuple[float, float]]:
    """From and to (mm of the way) of each move."""
    ends = np.cumsum([length_mm(one.poses) for one in side])
    return list(zip([0.0, *ends[:-1].tolist()], ends.tolist(), strict=True))

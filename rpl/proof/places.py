"""Where on the way outputs switch in two runs: at which move, and where the tool is then.

The length of the way until there says it as long as both ways are one. Where corners differ, the ways have other
lengths and the place itself is compared, with the move that it lies on.
"""

from __future__ import annotations

from bisect import bisect_left
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from rpl.proof.difference import Difference
from rpl.proof.events import in_words, matched, side
from rpl.proof.findings import Findings
from rpl.proof.motion import Driven, Pairing
from rpl.proof.record import Happening

Pair = tuple[str, Sequence[Happening], Sequence[Happening]]
_SOON_S = 1e-6


@dataclass(frozen=True, slots=True)
class _Place:
    """Of one output in both runs: the groups of moves, how far apart (mm) in the room and along the way."""

    groups: tuple[int, int]
    apart: float
    along: float


def compare_places(
    pairs: Sequence[Pair], driven: dict[str, Driven], pairing: Pairing, found: Findings
) -> Difference | None:
    """The first output that switches elsewhere; those beside corners and on joint moves deviate."""
    if not pairing.same_arm:
        return None
    for task, ours, theirs in pairs:
        moves = driven.get(task) or (next(iter(driven.values())) if len(driven) == 1 else Driven(()))
        ends = _ends(moves, 0), _ends(moves, 1)
        for first, second in matched(ours, theirs, pairing.tolerance, not pairing.same_language):
            if first is None or second is None:
                break
            if first.kind != "output":
                continue
            difference = _place(task, first, second, moves, ends, pairing, found)
            if difference is not None:
                return difference
    return None


def _ends(driven: Driven, which: int) -> list[float]:
    """When each group has ended; one in which a program does not move ends with the one before."""
    done: list[float] = []
    for group in driven.groups:
        moves = group[which]
        done.append(float(moves[-1].times[-1]) if moves else (done[-1] if done else 0.0))
    return done


def _place(
    task: str,
    first: Happening,
    second: Happening,
    driven: Driven,
    ends: tuple[list[float], list[float]],
    pairing: Pairing,
    found: Findings,
) -> Difference | None:
    tolerance = pairing.tolerance
    slack = tolerance.place_mm if first.moving or second.moving else 10.0 * tolerance.path_mm
    groups = bisect_left(ends[0], first.t - _SOON_S), bisect_left(ends[1], second.t - _SOON_S)
    along = abs(first.along - second.along)
    apart = _apart(first, second, along)
    if pairing.same_language or not driven.loose:
        if along <= slack:
            return None
    elif apart <= slack and abs(groups[0] - groups[1]) <= 1:
        return None
    sides = side(first), side(second)
    amount = along if apart <= slack else apart
    if not pairing.same_language and _on_one_move(first, second, groups, driven):
        where = f"in A at ({_xyz(first)}), in B at ({_xyz(second)})" if first.at and second.at else ""
        found.deviates("place", amount, f"{in_words(first)} {amount:.3f} mm apart {where}".rstrip(), *sides, task)
        return None
    text = f"{in_words(first)} after {first.along:.3f} mm of the path in A, after {second.along:.3f} mm in B"
    if groups[0] != groups[1]:
        text += ", at another move"
    return Difference("place", "geometry", text, *sides, task)


def _on_one_move(first: Happening, second: Happening, groups: tuple[int, int], driven: Driven) -> bool:
    """Does the output belong to the same move in both runs? While the robot drives, a corner may end the move before;
    moves that a sensor ends are divided as each controller needs."""
    apart = abs(groups[0] - groups[1])
    return apart == 0 or (apart == 1 and (first.moving or second.moving)) or driven.near_sensor(*groups)


def _xyz(happening: Happening) -> str:
    return ", ".join(f"{value:.1f}" for value in happening.at or ())


def _apart(first: Happening, second: Happening, along: float) -> float:
    if first.at is None or second.at is None:
        return along
    return float(np.linalg.norm(np.array(first.at) - np.array(second.at)))


__all__ = ["compare_places"]

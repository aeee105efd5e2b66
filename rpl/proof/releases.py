"""What an input releases: where one program waits until an input changes and then goes on, the other one must not have
gone on before that change came in its own run.

Whether a condition had to be waited for depends on how fast a controller was before, so between two controllers the
wait itself is no event. What it is for is one: nothing behind it is done before.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from rpl.proof.difference import Difference, Side
from rpl.proof.events import in_words, is_looking, matched, same_value, side
from rpl.proof.motion import Driven, move_side
from rpl.proof.places import Pair
from rpl.proof.record import Happening, Record
from rpl.proof.tolerance import Tolerance

# A wait ends so soon (s) after the change that it waited for: controllers look again in their cycle.
SOON_S = 0.05
_SLACK_S = 1e-6
_SHOWN = frozenset(("output", "message", "dialog"))


def compare_releases(
    records: tuple[Record, Record], pairs: Sequence[Pair], driven: dict[str, Driven], tolerance: Tolerance
) -> Difference | None:
    """The first event or move that one program does before the change of the input that the other one waits for."""
    for task, ours, theirs in pairs:
        moves = driven.get(task) or (next(iter(driven.values())) if len(driven) == 1 else Driven(()))
        both = [(a, b) for a, b in matched(ours, theirs, tolerance, True) if a is not None and b is not None]
        for waiting, happenings in ((0, ours), (1, theirs)):
            for end, change in _releases(records[waiting], task, happenings, tolerance):
                if _moves_at(moves, waiting, end):
                    continue  # what comes next may have been commanded before
                other = records[1 - waiting]
                found = _event(task, both, waiting, end, change, other, tolerance)
                found = found or _move(task, moves, waiting, end, change, other, tolerance)
                if found is not None:
                    return found
    return None


def _releases(
    record: Record, task: str, happenings: Sequence[Happening], tolerance: Tolerance
) -> Iterator[tuple[float, Happening]]:
    """When a task went on behind a wait, and the change of an input that ended it."""
    alone = len(record.tasks) == 1
    spans = [(one.begin, one.end, SOON_S) for one in record.waited if alone or one.task.lower() == task.lower()]
    for one in happenings:
        if is_looking(one, tolerance) and isinstance(one.value, int | float):
            spans.append((one.t, one.t + float(one.value), one.longest_s + SOON_S))
    for begin, end, soon in sorted(spans):
        changes = [one for one in record.inputs if begin < one.t <= end + _SLACK_S and end - one.t <= soon]
        if changes:
            yield end, changes[-1]


def _moves_at(driven: Driven, which: int, t: float) -> bool:
    return any(
        move.times[0] < t - _SLACK_S and move.times[-1] > t + _SLACK_S
        for group in driven.groups
        for move in group[which]
    )


def _event(
    task: str,
    both: Sequence[tuple[Happening, Happening]],
    waiting: int,
    end: float,
    change: Happening,
    other: Record,
    tolerance: Tolerance,
) -> Difference | None:
    """Is the next event behind the wait one that the other program shows too soon?"""
    for pair in both:
        behind, there = pair[waiting], pair[1 - waiting]
        if behind.kind not in _SHOWN or behind.timed is not None or behind.t < end - _SLACK_S:
            continue
        if _came(other, change, there.t, tolerance):
            return None
        return _too_soon(task, in_words(behind), waiting, change, (side(pair[0]), side(pair[1])))
    return None


def _move(
    task: str, driven: Driven, waiting: int, end: float, change: Happening, other: Record, tolerance: Tolerance
) -> Difference | None:
    """Is the next move behind the wait one that the other program begins too soon?"""
    for group in driven.groups:
        mine, theirs = group[waiting], group[1 - waiting]
        if not mine or mine[0].times[0] < end - _SLACK_S:
            continue
        if not theirs or _came(other, change, float(theirs[0].times[0]), tolerance):
            return None
        return _too_soon(task, "the next move", waiting, change, (move_side(group[0]), move_side(group[1])))
    return None


def _came(record: Record, change: Happening, t: float, tolerance: Tolerance) -> bool:
    """Has the input had that value by then?"""
    return any(
        one.t <= t + _SLACK_S and one.names & change.names and same_value(one.value, change.value, tolerance.number)
        for one in record.inputs
    )


def _too_soon(task: str, what: str, waiting: int, change: Happening, sides: tuple[Side, Side]) -> Difference:
    first, second = "AB"[waiting], "BA"[waiting]
    name = min(change.names, key=lambda one: (":" in one, one), default="an input")
    text = f"{first} waits until {name} becomes {change.value}, {second} goes on before: {what}"
    return Difference("wait", "events", text, *sides, task)


__all__ = ["SOON_S", "compare_releases"]

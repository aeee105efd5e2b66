"""How long the robot stands: between two events, before the first move, between two moves, behind the last one.

Nothing moves then, so that no acceleration says when the next event comes: a wait that ends by its time-out, one that
is left out and one that is made at another point show in what the robot stands for. Where an input ends the wait, its
moment is the surroundings', and the stand is left out (releases.py).
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

from rpl.proof.difference import Side
from rpl.proof.events import in_words, is_looking, matched, side
from rpl.proof.findings import Findings
from rpl.proof.motion import Driven, move_side
from rpl.proof.places import Pair
from rpl.proof.record import Happening, Record
from rpl.proof.releases import SOON_S
from rpl.proof.tolerance import Tolerance

_SLACK_S = 1e-6
Moments = tuple[float, float]


@dataclass(frozen=True, slots=True)
class _Stand:
    """A time in which the robot stands in both runs: from and to (s) in each, and what comes then."""

    begin: Moments
    end: Moments
    sides: tuple[Side, Side] | None


def compare_standing(
    records: tuple[Record, Record],
    pairs: Sequence[Pair],
    driven: dict[str, Driven],
    tolerance: Tolerance,
    found: Findings,
) -> None:
    """Tell every stand that is longer in one of the runs. In programs of several tasks that of the one that moves."""
    foreign = records[0].language != records[1].language
    for task, ours, theirs in pairs:
        moves = _moves(task, driven, len(pairs) == 1)
        if moves is None:
            continue
        both = [(a, b) for a, b in matched(ours, theirs, tolerance, foreign) if a is not None and b is not None]
        shown = [(a, b) for a, b in both if not (_helped(a, tolerance) or _helped(b, tolerance))]
        spans = tuple(_Spans(record, task, one, tolerance) for record, one in zip(records, (ours, theirs), strict=True))
        for stand in _stands(moves, (records[0].time_s, records[1].time_s)):
            _compare(task, stand, shown, spans, tolerance, found)


def _moves(task: str, driven: dict[str, Driven], alone: bool) -> Driven | None:
    """The moves of the task; of a single one also where its robot has another name, or there is none."""
    named = {name.lower(): one for name, one in driven.items()}
    found = named.get(task.lower())
    if found is None and alone and len(driven) <= 1:
        return next(iter(driven.values()), Driven(()))
    return found


def _helped(one: Happening, tolerance: Tolerance) -> bool:
    """What comes by itself after a time that began elsewhere, and looks of a loop: no moment that the task gives."""
    return one.timed is not None or one.helper or is_looking(one, tolerance)


def _stands(moves: Driven, ends: Moments) -> Iterator[_Stand]:
    """Where both robots stand; moves that only one of them makes, and those near a sensor, end the row."""
    last: Moments | None = (0.0, 0.0)
    for number, (a, b) in enumerate(moves.groups):
        if not a or not b:
            return
        begins = float(a[0].times[0]), float(b[0].times[0])
        if last is not None:
            yield _Stand(last, begins, (move_side(a), move_side(b)))
        stops = a[-1].stops and b[-1].stops and not moves.near_sensor(number)
        last = (float(a[-1].times[-1]), float(b[-1].times[-1])) if stops else None
    if last is not None:
        yield _Stand(last, ends, None)


class _Spans:
    """When one run waited for what another run may wait for at another moment."""

    def __init__(self, record: Record, task: str, happenings: Sequence[Happening], tolerance: Tolerance) -> None:
        alone = len(record.tasks) == 1
        own = [one for one in record.waited if alone or one.task.lower() == task.lower()]
        looks = [one for one in happenings if is_looking(one, tolerance)]
        self.changes = [one.t for one in record.inputs]
        self.waits = [(one.begin, one.end, not one.timed_out, 0.0) for one in own]
        self.waits += [(one.t, one.t + float(one.value or 0.0), True, one.longest_s) for one in looks]
        # A wait that is no moment of its own: from and to, as far as it may end by its time.
        self.timed = [(one.begin, one.end) for one in own if one.timed_out]
        self.timed += [
            (one.t, one.t + float(one.value)) for one in happenings if one.kind == "wait" and one.value is not None
        ]
        self.alone = alone

    def begun_before(self, begin: float) -> bool:
        """Does the task wait here for a time that began while the robot still moved?"""
        return any(since < begin - _SLACK_S and until > begin + _SLACK_S for since, until in self.timed)

    def released(self, begin: float, end: float) -> bool:
        """Did something outside of the task say when this time ended, or a part of it?"""
        ends = [(until, look) for _, until, met, look in self.waits if met and begin < until + _SLACK_S <= end + SOON_S]
        if ends and not self.alone:
            return True
        ends = [*ends, (end, 0.0)]
        return any(
            begin - _SLACK_S < change <= until + _SLACK_S and until - change <= SOON_S + look
            for change in self.changes
            for until, look in ends
        )

    def look_s(self, begin: float, end: float, tolerance: Tolerance) -> float:
        """By how much a program that looks again and again may see too late what it waits for."""
        looks = [look for since, until, met, look in self.waits if met and since <= end and until >= begin]
        return tolerance.helped_s + 2.0 * max(looks) + tolerance.looking_share * (end - begin) if looks else 0.0


def _compare(
    task: str,
    stand: _Stand,
    shown: Sequence[tuple[Happening, Happening]],
    spans: tuple[_Spans, ...],
    tolerance: Tolerance,
    found: Findings,
) -> None:
    if any(one.begun_before(begin) for one, begin in zip(spans, stand.begin, strict=True)):
        return  # how much of it is left depends on how fast the robot came here
    last = stand.begin
    for first, second in shown:
        if not (_within(first, stand, 0, last[0]) and _within(second, stand, 1, last[1])):
            continue
        _gap(task, last, (first.t, second.t), (side(first), side(second)), in_words(first), spans, tolerance, found)
        last = _behind(first), _behind(second)
    if stand.sides is not None:
        _gap(task, last, stand.end, stand.sides, "the next move begins", spans, tolerance, found)


def _within(one: Happening, stand: _Stand, which: int, last: float) -> bool:
    return max(stand.begin[which], last) - _SLACK_S <= one.t <= stand.end[which] + _SLACK_S


def _behind(one: Happening) -> float:
    """When the task goes on behind it: a wait of so many seconds is compared by itself."""
    return one.t + float(one.value) if one.kind == "wait" and isinstance(one.value, int | float) else one.t


def _gap(
    task: str,
    begin: Moments,
    end: Moments,
    sides: tuple[Side, Side],
    what: str,
    spans: tuple[_Spans, ...],
    tolerance: Tolerance,
    found: Findings,
) -> None:
    if any(one.released(first, last) for one, first, last in zip(spans, begin, end, strict=True)):
        return
    lengths = [last - first for first, last in zip(begin, end, strict=True)]
    apart = abs(round(lengths[0] - lengths[1], 9))
    slack = max(one.look_s(first, last, tolerance) for one, first, last in zip(spans, begin, end, strict=True))
    if apart > max(tolerance.exact_s, slack):
        text = f"the robot stands for {lengths[0]:.6g} s in A, for {lengths[1]:.6g} s in B until: {what}"
        found.deviates("wait", apart, text, *sides, task)


__all__ = ["compare_standing"]

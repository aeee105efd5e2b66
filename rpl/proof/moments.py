"""Times in two runs: lengths of waits and pulses, which every controller keeps, and the moments of all events, which
are compared only between programs in one language on one arm, because two controllers never agree on accelerations.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from rpl.proof.events import in_words, matched, side
from rpl.proof.findings import Findings
from rpl.proof.record import Happening
from rpl.proof.tolerance import Tolerance

Pair = tuple[str, Sequence[Happening], Sequence[Happening]]
Matched = tuple[Happening, Happening]


def compare_lengths(pairs: Sequence[Pair], foreign: bool, tolerance: Tolerance, found: Findings) -> None:
    """Waits and pulses that are longer in one of the runs."""
    for task, ours, theirs in pairs:
        last: dict[frozenset[str], Matched] = {}
        for first, second in _both(ours, theirs, tolerance, foreign):
            if first.kind == "wait":
                _wait(task, first, second, tolerance, found)
            elif first.kind == "message":
                _sender(task, first, second, foreign, found)
            elif first.kind == "output":
                _number(task, first, second, foreign, found)
                _pulse(task, (first, second), last.get(first.names), tolerance, found)
                last[first.names] = first, second


def _both(
    ours: Sequence[Happening], theirs: Sequence[Happening], tolerance: Tolerance, foreign: bool
) -> Iterator[Matched]:
    for first, second in matched(ours, theirs, tolerance, foreign):
        if first is None or second is None:
            return
        yield first, second


def _wait(task: str, a: Happening, b: Happening, tolerance: Tolerance, found: Findings) -> None:
    """Looks of a polling loop are no wait that a program asks for."""
    if not isinstance(a.value, int | float) or not isinstance(b.value, int | float):
        return
    if a.times != b.times and min(a.longest_s, b.longest_s) <= tolerance.look_s:
        return
    apart = abs(round(float(a.value) - float(b.value), 9))
    if apart > tolerance.exact_s:
        text = f"waits {a.value:g} s in A, {b.value:g} s in B"
        found.deviates("wait", apart, text, side(a), side(b), task)


def _sender(task: str, a: Happening, b: Happening, foreign: bool, found: Findings) -> None:
    """Who says a message, or its title; between two languages where both say it."""
    one, other = (" ".join(each.sender.split()) for each in (a, b))
    if one != other and not (foreign and not (one and other)):
        found.deviates("sender", 1.0, f"sender of {in_words(a)}: {one!r} in A, {other!r} in B", side(a), side(b), task)


def _number(task: str, a: Happening, b: Happening, foreign: bool, found: Findings) -> None:
    """Outputs of one name that both programs number, and not alike. Within one language they are two outputs."""
    one, other = (frozenset(name for name in each.names if ":" in name) for each in (a, b))
    if foreign and one and other and not one & other:
        text = f"{in_words(a)}: number {min(one)} in A, {min(other)} in B"
        found.deviates("output-number", 1.0, text, side(a), side(b), task)


def _pulse(task: str, now: Matched, before: Matched | None, tolerance: Tolerance, found: Findings) -> None:
    """The end of a pulse or of a delay: its seconds where both programs say them, else those since it was begun."""
    first, second = now
    said = [one.timed for one in now]
    if said[0] is None and said[1] is None:
        return
    if said[0] is not None and said[1] is not None:
        lengths, slack = (said[0][1], said[1][1]), tolerance.exact_s
    elif before is None or "pulse" not in (one[0] for one in said if one is not None):
        return
    else:
        lengths, slack = (first.t - before[0].t, second.t - before[1].t), tolerance.helped_s
    apart = abs(round(lengths[0] - lengths[1], 9))
    if apart > slack:
        text = f"{in_words(first)} after {lengths[0]:g} s in A, after {lengths[1]:g} s in B"
        found.deviates("pulse", apart, text, side(first), side(second), task)


def compare_moments(pairs: Sequence[Pair], tolerance: Tolerance, found: Findings) -> None:
    """Events at other moments, in programs of one language on one arm."""
    for task, ours, theirs in pairs:
        for first, second in _both(ours, theirs, tolerance, False):
            apart = abs(first.t - second.t)
            found.max_time_s = max(found.max_time_s, apart)
            whole = max(first.t, second.t)
            if apart > max(tolerance.time_s, tolerance.time_share * whole):
                text = f"{in_words(first)} at {first.t:.3f} s in A, at {second.t:.3f} s in B"
                found.deviates("time", apart, text, side(first), side(second), task, apart / max(whole, 1e-9))


__all__ = ["compare_lengths", "compare_moments"]

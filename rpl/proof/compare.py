"""What is compared of two runs: events first, then the way of the tool and what is asked of each move, then times.

Events: per task the same outputs, messages, dialogs, blocking waits and end, in the same order with the same values.
Geometry: the tool goes the same way, heads for the same joints (on the same arm), and outputs switch at the same place.
A group of outputs is its bits where one of the two switches them singly (bits.py).
Time: every happening comes at the same moment; asked only of programs in the same language on the same arm, because
two controllers never agree on accelerations.
A level is asked only when the ones before it hold; measures that deviate refute nothing, they are all told.
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import chain

from rpl.proof.bits import in_bits
from rpl.proof.deviations import Deviation
from rpl.proof.difference import Difference
from rpl.proof.events import crossed_difference, event_difference, paired, same_event, without_conditions
from rpl.proof.findings import Findings
from rpl.proof.moments import compare_lengths, compare_moments
from rpl.proof.motion import Pairing, compare_motion
from rpl.proof.places import Pair, compare_places
from rpl.proof.record import Record
from rpl.proof.releases import compare_releases
from rpl.proof.standing import compare_standing
from rpl.proof.tolerance import Tolerance

LEVELS = ("none", "events", "geometry", "time")


@dataclass(frozen=True, slots=True)
class Comparison:
    """level: the highest level at which no difference was found. `compared`: how many events and moves were held
    against each other; the end of a run is none. Maxima leave nothing out."""

    level: str
    difference: Difference | None
    deviations: tuple[Deviation, ...] = ()
    max_path_mm: float = 0.0
    max_joint_deg: float = 0.0
    max_time_s: float = 0.0
    compared: int = 0


def compare(a: Record, b: Record, tolerance: Tolerance, limit_mm: float = 0.0) -> Comparison:
    """Compare two runs level by level; stop at the first level that differs. Ways of the tool that are further apart
    than the tolerance deviate up to `limit_mm`, and differ beyond."""
    found = Findings()
    a, b = in_bits(a, b)
    pairing = Pairing(a.robot == b.robot, a.language == b.language, tolerance, max(limit_mm, tolerance.path_mm))
    events = event_difference(a, b, tolerance)
    pairs = _pairs(a, b)
    difference, driven = compare_motion(a, b, pairing, found)
    events = events or crossed_difference(pairs, tolerance, not pairing.same_language)
    if events is not None:
        return _made("none", events, found)
    found.compared += sum(one.kind != "end" for one in chain.from_iterable(ours for _, ours, _ in pairs))
    difference = difference or compare_places(pairs, driven, pairing, found)
    if not pairing.same_language:
        difference = difference or compare_releases((a, b), pairs, driven, tolerance)
    compare_standing((a, b), pairs, driven, tolerance, found)
    compare_lengths(pairs, not pairing.same_language, tolerance, found)
    if difference is not None:
        return _made("events", difference, found)
    if not (pairing.same_arm and pairing.same_language):
        return _made("geometry", None, found)
    compare_moments(pairs, tolerance, found)
    late = any(one.kind == "time" for one in found.deviations)
    return _made("geometry" if late else "time", None, found)


def _made(level: str, difference: Difference | None, found: Findings) -> Comparison:
    return Comparison(
        level,
        difference,
        tuple(found.deviations),
        found.max_path_mm,
        found.max_joint_deg,
        found.max_time_s,
        found.compared,
    )


def _pairs(a: Record, b: Record) -> list[Pair]:
    """Tasks side by side, without what counts only within one language; nothing where they do not pair."""
    pairs = paired(a, b)
    if isinstance(pairs, Difference):
        return []
    if a.language == b.language:
        return [(task, ours, theirs) for task, ours, theirs in pairs]
    return [(task, without_conditions(ours), without_conditions(theirs)) for task, ours, theirs in pairs]


__all__ = ["LEVELS", "Comparison", "compare", "same_event"]

"""What re-teaching showed of each taught datum, in words and as data."""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from rpl.proof.difference import Difference
from rpl.proof.teaching.data import KINDS, Datum
from rpl.proof.teaching.moving import Amount
from rpl.proof.teaching.pairs import Copy

# The same in both; the same when all its copies are taught; not the same; not in the other program; not in the run;
# not moved, because the arm cannot go there.
HOLDS, COPIED, FAILS, MISSING, UNREACHED, UNMOVED = "holds", "copied", "fails", "missing", "unreached", "unmoved"
STATES = (HOLDS, COPIED, FAILS, MISSING, UNREACHED, UNMOVED)
_WORDS = {
    FAILS: "not the same in B: {names}",
    MISSING: "not kept in B: {names}",
    COPIED: "kept in several places of B: {names}",
    UNMOVED: "not moved: {names}",
    UNREACHED: "the run does not come to {names}",
}
_MOST_NAMED = 4


@dataclass(frozen=True, slots=True)
class Outcome:
    """One taught datum of A: its copies in B, one of STATES, and why it is so where it does not hold."""

    datum: Datum
    copies: tuple[Copy, ...]
    state: str
    reason: str = ""

    def as_json(self) -> dict[str, object]:
        """A stable document: name, kind, file, line, state, reason, copies."""
        copies = [one.as_json() for one in self.copies]
        return {**self.datum.as_json(), "state": self.state, "reason": self.reason, "copies": copies}

    def as_text(self) -> str:
        """`pVice: 2 copies, LOADVICE.P2 and UNLOADVICE.P1`."""
        return f"{self.datum.name}: {self.reason}"


@dataclass(frozen=True, slots=True)
class Retaught:
    """All taught data of A. `runs`: how many pairs of runs it took; `note`: why nothing was moved, where nothing was;
    `together`: data that means the same one by one and not when all of it is moved, and why; `difference`: the first
    one that re-teaching made."""

    outcomes: tuple[Outcome, ...]
    seed: int
    amount: Amount
    runs: int = 0
    note: str = ""
    together: tuple[str, ...] = ()
    difference: Difference | None = None

    def of(self, *states: str) -> tuple[Outcome, ...]:
        return tuple(one for one in self.outcomes if one.state in states)

    @property
    def fails(self) -> bool:
        """Does re-teaching some of it mean something else in B?"""
        return bool(self.of(FAILS) or self.together)

    @property
    def holds(self) -> bool:
        """Does re-teaching mean the same in both, for all that the run comes to?"""
        return not self.note and not self.fails and not self.of(COPIED, MISSING, UNMOVED)

    def headline(self) -> str:
        """`14 of 15 points, 2 tools, 3 frames mean the same; XDoor: 2 copies, ...`."""
        if self.note:
            return self.note
        if not self.outcomes:
            return "A has no taught data"
        said = [f"{', '.join(self._counted())} mean the same"]
        for state, words in _WORDS.items():
            names = [one.datum.name for one in self.of(state)]
            said += [words.format(names=_listed(names))] if names else []
        said += ["not the same when all is moved together"] if self.together else []
        return "; ".join(said)

    def _counted(self) -> list[str]:
        whole = Counter(one.datum.kind for one in self.outcomes)
        good = Counter(one.datum.kind for one in self.of(HOLDS))
        return [
            f"{good[kind]} of {_many(whole[kind], kind)}" if good[kind] < whole[kind] else _many(whole[kind], kind)
            for kind in KINDS
            if whole[kind]
        ]

    def as_text(self) -> str:
        """The first line, then one for each datum that does not mean the same."""
        if self.note:
            return f"re-taught: {self.note}"
        moved = f"(by up to {self.amount.mm:g} mm and {self.amount.deg:g} deg, seed {self.seed})"
        told = [f"  {one.as_text()}" for one in self.of(FAILS, MISSING, COPIED, UNMOVED)]
        told += [f"  only together: {one}" for one in self.together]
        return "\n".join((f"re-taught: {self.headline()} {moved}", *told))

    def as_json(self) -> dict[str, object]:
        """A stable document: holds, seed, mm, deg, runs, note, together, data."""
        return {
            "holds": self.holds,
            "seed": self.seed,
            "mm": self.amount.mm,
            "deg": self.amount.deg,
            "runs": self.runs,
            "note": self.note,
            "together": list(self.together),
            "data": [one.as_json() for one in self.outcomes],
        }


def _many(number: int, kind: str) -> str:
    return f"{number} {kind}{'' if number == 1 else 's'}"


def outcomes_of(
    pairs: Mapping[Datum, Sequence[Copy]],
    failing: Mapping[Datum, str],
    unreached: Sequence[Datum],
    unmoved: Sequence[Datum],
) -> tuple[Outcome, ...]:
    """The outcome of each datum. `failing`: those that do not mean the same, and why."""
    found = []
    for datum, copies in pairs.items():
        state, reason = HOLDS, ""
        if datum in failing:
            state, reason = FAILS, failing[datum]
        elif not copies:
            state, reason = MISSING, "B keeps nothing of that name, comment or value"
        elif datum in unreached:
            state, reason = UNREACHED, "the run does not come to it"
        elif datum in unmoved:
            state, reason = UNMOVED, "the arm cannot go there, or not likewise in both"
        elif len(copies) > 1:
            state, reason = COPIED, f"{len(copies)} copies, {_listed([one.datum.name for one in copies])}"
        found.append(Outcome(datum, tuple(copies), state, reason))
    return tuple(found)


def _listed(names: Sequence[str]) -> str:
    shown = [*names[:_MOST_NAMED], *([f"{len(names) - _MOST_NAMED} more"] if len(names) > _MOST_NAMED else [])]
    return " and ".join((", ".join(shown[:-1]), shown[-1])) if len(shown) > 1 else shown[0]


__all__ = [
    "COPIED",
    "FAILS",
    "HOLDS",
    "MISSING",
    "STATES",
    "UNMOVED",
    "UNREACHED",
    "Outcome",
    "Retaught",
    "outcomes_of",
]

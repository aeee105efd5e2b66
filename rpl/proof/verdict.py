"""The verdict in words: equal, alike, different or undecided, and everything that stands behind the word."""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import cached_property
from typing import TYPE_CHECKING

from rpl.proof.deviations import Deviation, Measure, measures
from rpl.proof.difference import Difference
from rpl.proof.reach import Reach
from rpl.proof.tolerance import Accepted, Tolerance
from rpl.showing import folded, heading, line

if TYPE_CHECKING:
    from rpl.proof.teaching.outcome import Retaught

EQUAL, ALIKE, DIFFERENT, UNDECIDED = "equal", "alike", "different", "undecided"
VERDICTS = (EQUAL, ALIKE, DIFFERENT, UNDECIDED)
_MOST_NAMED = 6


@dataclass(frozen=True, slots=True)
class Explored:
    """How far an exploration went: cells that were compared besides the user's own, cells that were tried, and what
    ended it early (`cells`, `seconds`), if anything did. `unmatched`: kept values of A, and of B, that the
    other one does not keep, so that they were not changed."""

    cells: int
    tried: int
    ended: str = ""
    unmatched: tuple[tuple[str, ...], ...] = ()

    def as_json(self) -> dict[str, object]:
        """A stable document: cells, tried, ended, unmatched (a, b)."""
        kept = {side: list(names) for side, names in zip("ab", self.unmatched, strict=False)}
        return {"cells": self.cells, "tried": self.tried, "ended": self.ended, "unmatched": kept}

    def unchanged(self) -> str:
        """The kept values that were not changed, for the first line; empty when there are none."""
        told = []
        for who, names in zip("AB", self.unmatched, strict=False):
            more = len(names) - _MOST_NAMED
            if names:
                told.append(f"{', '.join(names[:_MOST_NAMED])}{f' and {more} more' if more > 0 else ''} of {who}")
        return f"; kept by one only and not changed: {'; '.join(told)}" if told else ""

    def as_text(self) -> str:
        early = f"; ended early by the limit of {self.ended}" if self.ended else ""
        return f"explored: {self.tried} cells tried, {self.cells} of them compared{early}"


@dataclass(frozen=True, repr=False)
class ProofResult:
    """Whether two programs mean the same, as far as their runs tell.

    equal: everything compared lies within the tolerance, or deviates as somebody accepts. alike: the same events in the
    same order, but measures deviate. different: there is a difference. undecided: no difference was found, and the runs
    do not show enough (`reason`). `level`: the highest of none, events, geometry, time at which the runs agree. Maxima
    leave nothing out. `reach_a`, `reach_b`: which statements the runs came to; `explored`: in how many cells besides
    the user's own, where that was asked. `approximations`: codes of what a translation has written in another way on
    purpose, and how often, as far as nobody accepts them; with one of them nothing is equal. `notes`: what the reader
    of the verdict should know besides. `taught`: what re-teaching showed, where that was asked.
    """

    level: str
    difference: Difference | None
    max_path_mm: float
    max_joint_deg: float
    max_time_s: float
    deviations: tuple[Deviation, ...] = ()
    reason: str = ""
    notes: tuple[str, ...] = ()
    tolerance: Tolerance = field(default_factory=Tolerance)
    acceptance: Accepted = field(default_factory=Accepted)
    reach_a: Reach | None = None
    reach_b: Reach | None = None
    explored: Explored | None = None
    approximations: tuple[tuple[str, int], ...] = ()
    taught: Retaught | None = None

    @cached_property
    def accepted(self) -> tuple[Measure, ...]:
        """What deviates and is accepted."""
        return measures(one for one in self.deviations if self.acceptance.takes(one))

    @cached_property
    def open(self) -> tuple[Measure, ...]:
        """What deviates and is not accepted."""
        return measures(one for one in self.deviations if not self.acceptance.takes(one))

    @property
    def verdict(self) -> str:
        """One of VERDICTS."""
        if self.difference is not None or (self.taught is not None and self.taught.fails):
            return DIFFERENT
        if self.reason:
            return UNDECIDED
        untaught = self.taught is not None and not self.taught.holds
        return ALIKE if self.open or self.approximations or untaught else EQUAL

    @property
    def equal(self) -> bool:
        return self.verdict == EQUAL

    @property
    def agrees(self) -> bool:
        """Was no difference found? Measures may deviate, and the runs may not show enough."""
        return self.difference is None

    def as_json(self) -> dict[str, object]:
        """A stable document."""
        return {
            "verdict": self.verdict,
            "equal": self.equal,
            "level": self.level,
            "reason": self.reason,
            "first_difference": self.difference.as_json() if self.difference else None,
            "deviations": [one.as_json() | {"accepted": self.acceptance.takes(one)} for one in self.deviations],
            "approximations": dict(self.approximations),
            "max_path_mm": round(self.max_path_mm, 6),
            "max_joint_deg": round(self.max_joint_deg, 6),
            "max_time_s": round(self.max_time_s, 6),
            "reach": self._reach_as_json(),
            "notes": list(self.notes),
            "taught": self.taught.as_json() if self.taught is not None else None,
        }

    def __repr__(self) -> str:
        return line("ProofResult", [self.headline()])

    def _repr_html_(self) -> str:
        return heading("proof", [self.headline()]) + folded("all of it", self.as_text())

    def _reach_as_json(self) -> dict[str, object]:
        sides = {"a": self.reach_a, "b": self.reach_b}
        found: dict[str, object] = {side: one.as_json() for side, one in sides.items() if one is not None}
        return found | {"explored": self.explored.as_json() if self.explored is not None else None}

    def unreached(self) -> str:
        """What the runs did not come to, for the first line; empty when every statement of both was reached."""
        sides = (("A", self.reach_a), ("B", self.reach_b))
        named = [f"{one.named(side)}" for side, one in sides if one is not None and one.unreached]
        return f"; not reached: {' and '.join(named)}" if named else ""

    def headline(self) -> str:
        """The first line."""
        if self.difference is not None:
            return self._verdict()
        return self._verdict() + self.unreached() + (self.explored.unchanged() if self.explored is not None else "")

    def _verdict(self) -> str:
        told = [one.as_text() for one in self.open]
        if self.approximations:
            codes = ", ".join(f"{name} ({count})" for name, count in self.approximations)
            told.append(f"written with approximations: {codes}")
        if self.taught is not None and not self.taught.holds:
            told.append(f"re-taught, {self.taught.headline()}")
        deviating = ", ".join(told)
        accepted = ", ".join(one.as_text() for one in self.accepted)
        beside = f"; accepted: {accepted}" if accepted else ""
        match self.verdict:
            case "different":
                if self.difference is None:
                    return f"different: {deviating}"
                return f"different: {self.difference.explanation}"
            case "undecided":
                return f"undecided: {self.reason}" + (f"; {deviating}" if deviating else "") + beside
            case "alike":
                return f"alike: {deviating}{beside}"
            case _:
                return f"equal: everything that was compared lies within {self.tolerance.as_text()}{beside}"

    def as_text(self) -> str:
        """The verdict for people: its line, what stands behind it, notes."""
        lines = [self.headline()]
        if self.difference is not None:
            lines += self.difference.as_text().splitlines()[1:]
            lines += [f"besides: {one.as_text()}" for one in self.open]
        else:
            lines += [each for one in self.open for each in one.as_lines()]
        distance = f"greatest distance {self.max_path_mm:.4f} mm, {self.max_joint_deg:.4f} deg"
        lines.append(f"{distance}; agree on: {self.level}")
        lines += [told for side, one in (("A", self.reach_a), ("B", self.reach_b)) for told in _reach_lines(side, one)]
        if self.explored is not None:
            lines.append(self.explored.as_text())
        if self.taught is not None:
            lines += self.taught.as_text().splitlines()
        return "\n".join((*lines, *(f"note: {note}" for note in self.notes if note != self.reason)))


def _reach_lines(side: str, reach: Reach | None) -> list[str]:
    """What was not reached, and why; nothing where all was."""
    return [f"{side}: {line}" for line in reach.as_text().splitlines()] if reach is not None and reach.unreached else []


__all__ = ["ALIKE", "DIFFERENT", "EQUAL", "UNDECIDED", "VERDICTS", "Explored", "ProofResult"]

"""Measures in which two runs differ that show the same events in the same order: what turns `equal` into `alike`.

A deviation is data: its kind, how much, and both places. Nothing of it is left out of a verdict; who accepts one names
its kind or its limit.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass

from rpl.proof.difference import Side

# kind -> (what differs, in words for people with {amount} and {count}, unit). The order is that of the verdict's line.
KINDS: dict[str, tuple[str, str]] = {
    "path": ("tool paths up to {amount} apart at {count} moves", "mm"),
    "corner": ("tool paths up to {amount} apart at {count} corners", "mm"),
    "turning": ("the tool turned up to {amount} apart at {count} corners", "deg"),
    "stop": ("one robot stops where the other passes at {count} points", ""),
    "sensed": ("moves that a sensor ends are left up to {amount} apart at {count} places", "mm"),
    "place": ("outputs switch up to {amount} apart along the path at {count} places", "mm"),
    "path-speed": ("path speeds differ by up to {amount} at {count} moves", "%"),
    "turning-speed": ("turning speeds differ by up to {amount} at {count} moves", "%"),
    "joint-speed": ("joint speeds differ by up to {amount} at {count} moves", "%"),
    "move-time": ("programmed times of moves differ by up to {amount} at {count} moves", "%"),
    "acceleration": ("accelerations differ by up to {amount} at {count} moves", "%"),
    "acceleration-unit": ("accelerations are said in units that do not compare at {count} moves", "%"),
    "corner-size": ("programmed corners differ by up to {amount} at {count} moves", "mm"),
    "load": ("loads differ by up to {amount} at {count} moves", "kg"),
    "load-centre": ("centres of loads differ by up to {amount} at {count} moves", "mm"),
    "tool": ("tools differ by up to {amount} at {count} moves", "mm"),
    "frame": ("work objects differ by up to {amount} at {count} moves", "mm"),
    "sender": ("messages have other senders or titles at {count} places", ""),
    "output-number": ("outputs have other numbers at {count} places", ""),
    "wait": ("waits differ by up to {amount} at {count} places", "s"),
    "pulse": ("pulses differ by up to {amount} at {count} places", "s"),
    "time": ("moments differ by up to {amount} at {count} places", "s"),
}


@dataclass(frozen=True, slots=True)
class Deviation:
    """One place where a measure differs. `amount` in the unit of its kind (KINDS), never negative; a and b: both sides
    with their places; `explanation`: one line for people with both values. `share`: of a moment, the deviation as a
    share of the time since the start."""

    kind: str
    amount: float
    explanation: str
    a: Side
    b: Side
    task: str = ""
    share: float = 0.0

    def as_json(self) -> dict[str, object]:
        """A stable document: kind, amount, unit, explanation, task, a, b."""
        return {
            "kind": self.kind,
            "amount": round(self.amount, 6),
            "unit": KINDS[self.kind][1],
            "explanation": self.explanation,
            "task": self.task,
            "a": self.a.as_json(),
            "b": self.b.as_json(),
        }


@dataclass(frozen=True, slots=True)
class Measure:
    """All deviations of one kind: how many, and the worst of them."""

    kind: str
    count: int
    worst: Deviation

    def as_text(self) -> str:
        """`tool paths up to 187.8 mm apart at 12 corners (worst: line 21 / line 38)`."""
        words, unit = KINDS[self.kind]
        text = words.format(amount=f"{self.worst.amount:.4g} {unit}".rstrip(), count=self.count)
        if self.count == 1:
            text = text.removesuffix("s") if words.endswith("s") else text
        lines = [f"line {side.place.line}" for side in (self.worst.a, self.worst.b) if side.place.line]
        return f"{text} (worst: {' / '.join(lines)})" if lines else text

    def as_lines(self) -> list[str]:
        """The worst of them with both places."""
        worst = self.worst
        places = [f"  {name}: {side.place}" for name, side in (("A", worst.a), ("B", worst.b)) if side.place.line]
        return [f"{self.kind}: {worst.explanation}", *places]


def measures(deviations: Iterable[Deviation]) -> tuple[Measure, ...]:
    """The deviations by kind, in the order of KINDS; of two equally bad ones the first is the worst."""
    by_kind: dict[str, list[Deviation]] = {}
    for one in deviations:
        by_kind.setdefault(one.kind, []).append(one)
    return tuple(Measure(kind, len(by_kind[kind]), _worst(by_kind[kind])) for kind in KINDS if kind in by_kind)


def _worst(deviations: Sequence[Deviation]) -> Deviation:
    return max(deviations, key=lambda one: round(one.amount, 6))

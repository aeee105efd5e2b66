"""Which statements of a program its runs came to, and why the others were not reached.

The statements of a program are those that become instructions: comments, declarations, labels and the words that only
hold a block together do not count. A statement over several instructions is reached when one of them was executed.
"""

from __future__ import annotations

from collections.abc import Collection, Iterable, Mapping, Sequence
from dataclasses import dataclass
from itertools import groupby

from rpl import ir
from rpl.proof.record import Place, place_of
from rpl.proof.unreached import UNDRIVEN, Key, key_of, reasons
from rpl.runtime.reached import Reached
from rpl.source import Origin

_ONE_WAY = "no input, kept value or answer is looked at, so that every run is the same"
_MOST_LINES = 12  # folded ranges of lines that one line of text shows


@dataclass(frozen=True, slots=True)
class Unreached:
    """A statement that no run came to. `offset` in its file tells it from others on its line. `impossible`: an
    exploration has found that nothing it can change decides about it."""

    place: Place
    reason: str
    offset: int = 0
    impossible: bool = False

    def as_json(self) -> dict[str, object]:
        """A stable document: file, line, text, reason, impossible."""
        return {**self.place.as_json(), "reason": self.reason, "impossible": self.impossible}


@dataclass(frozen=True, slots=True)
class Reach:
    """How many statements a program has, how many of them were reached, and the others in the order of the program."""

    statements: int
    reached: int
    unreached: tuple[Unreached, ...] = ()

    @property
    def share(self) -> float:
        """Of all statements, 0 to 1; a program without statements is reached as a whole."""
        return self.reached / self.statements if self.statements else 1.0

    @property
    def impossible(self) -> int:
        """How many of the unreached statements nothing could reach."""
        return sum(one.impossible for one in self.unreached)

    def as_json(self) -> dict[str, object]:
        """A stable document: statements, reached, share, unreached (see Unreached)."""
        return {
            "statements": self.statements,
            "reached": self.reached,
            "share": round(self.share, 6),
            "unreached": [one.as_json() for one in self.unreached],
        }

    def as_text(self) -> str:
        """The share, then one line for each reason with the lines of the program."""
        first = f"{self.reached} of {self.statements} statements were reached ({_percent(self.share)})"
        first += f"; {self.impossible} cannot be" if self.impossible else ""
        by_reason: dict[str, list[Unreached]] = {}
        for one in self.unreached:
            by_reason.setdefault(one.reason, []).append(one)
        rest = [f"not reached: {lines_of(many)}: {reason}" for reason, many in by_reason.items()]
        return "\n".join((first, *rest))

    def named(self, side: str = "") -> str:
        """What was not reached, in a few words: `3 statements (lines 7-8, 12)`, with `side` `3 statements of A (...)`;
        empty when all was."""
        count = len(self.unreached)
        many = f"{count} statement{'s' if count > 1 else ''}" + (f" of {side}" if side else "")
        return f"{many} ({lines_of(self.unreached)})" if count else ""

    def merged(self, *others: Reach) -> Reach:
        """The reach of several runs together: what none of them came to, with the reason of the first."""
        left = [{(one.place.file, one.offset) for one in other.unreached} for other in others]
        kept = tuple(one for one in self.unreached if all((one.place.file, one.offset) in missing for missing in left))
        return Reach(self.statements, self.statements - len(kept), kept)


def reach_of(
    program: ir.Program,
    runs: Iterable[Reached | None],
    entry: str | None = None,
    remarks: Mapping[Key, str] | None = None,
    one_way: bool = False,
    routines: Collection[int] | None = None,
) -> Reach:
    """What the runs of the program came to, all together. `entry`: the routine that they began with, where it was
    named. From an exploration: `remarks` about statements with a condition that never went the other way; `one_way`:
    every run of the program goes the same way. `routines`: the numbers of those that count (see LinkedProgram.codes);
    else all do."""
    done = [run for run in runs if run is not None]
    if not done:
        return Reach(0, 0)
    every: dict[Key, Origin] = {}
    came: set[Key] = set()
    for number, code in done[0].linked.codes():
        for origin in code.origins if routines is None or number in routines else ():
            if origin.source is not None:
                every.setdefault(key_of(origin, code.kind == "action"), origin)
    for run in done:
        for code, marks in run.marks.items():
            action = code.kind == "action"
            came.update(key_of(origin, action) for place, origin in enumerate(code.origins) if marks[place])
    missing = [key for key in every if key not in came]
    if not missing:
        return Reach(len(every), len(every))
    why = reasons(program, every.keys(), came, entry, remarks or {})
    order = {path: number for number, path in enumerate(dict.fromkeys(key[0] for key in every))}
    missing.sort(key=lambda key: (order[key[0]], key[1:]))
    unreached = tuple(_unreached(every[key], why[key], key[1], one_way) for key in missing)
    return Reach(len(every), len(every) - len(unreached), unreached)


def _unreached(origin: Origin, why: str, offset: int, one_way: bool) -> Unreached:
    never = why.endswith(UNDRIVEN)
    if one_way and not never:
        why = f"{why}; {_ONE_WAY}"
    return Unreached(place_of(origin), why, offset, never or one_way)


def lines_of(many: Sequence[Unreached], most: int = _MOST_LINES) -> str:
    """`line 7`, `lines 7-9, 12`; with several files each with its name: `a.src lines 7-9; b.src line 3`."""
    files = {one.place.file for one in many}
    told = []
    for file, group in groupby(sorted(many, key=lambda one: one.place.file), key=lambda one: one.place.file):
        ranges = _ranges(sorted({one.place.line for one in group}))
        shown = ", ".join(ranges[:most]) + (f" and {len(ranges) - most} more" if len(ranges) > most else "")
        word = "line" if len(ranges) == 1 and "-" not in ranges[0] else "lines"
        told.append(f"{file.rpartition('/')[2]} {word} {shown}" if len(files) > 1 else f"{word} {shown}")
    return "; ".join(told)


def _ranges(lines: Sequence[int]) -> list[str]:
    """`3`, `7-9` for lines in order."""
    found: list[list[int]] = []
    for line in lines:
        if found and line == found[-1][1] + 1:
            found[-1][1] = line
        else:
            found.append([line, line])
    return [f"{first}-{last}" if last > first else f"{first}" for first, last in found]


def _percent(share: float) -> str:
    """As many as are there, never rounded up to all of them."""
    tenths = int(share * 1000)
    return f"{tenths / 10:g} %"


__all__ = ["Reach", "Unreached", "lines_of", "reach_of"]

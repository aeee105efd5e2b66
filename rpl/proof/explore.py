"""Finds cells in which programs go ways that they have not gone yet: other inputs, values that a controller keeps,
answers of the operator.

It begins with the user's cell. Behind each run it looks at what decided the ways that nobody went, which sources were
looked at there or just before, and changes one of them: from the start on, or from a moment on. A cell that leads on is
kept and looked at in turn. Everything is in a fixed order; the random tries at the end have a seed. Both programs are
run in the same cells, so that what either of them decides is tried on both.
"""

from __future__ import annotations

import random
import time
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, field, replace
from itertools import product

from rpl.cell import Cell, Input
from rpl.errors import RplError
from rpl.proof.candidates import Given, Names, constants_of, values_for, with_given
from rpl.proof.progress import Progress, moment, progress_of
from rpl.proof.unreached import UNDRIVEN, Key, key_of
from rpl.proof.watched import EVENT, RECENT, STATEMENT, WAIT, Look, Seen, Side, Source
from rpl.runtime.code import Branch, Code
from rpl.runtime.limits import Limits
from rpl.runtime.reached import Reached

# How long after a wait has begun what it waits for comes, s.
_AFTER_S = 1.0
# As many sources of one condition are changed together.
_TOGETHER = 4
# A moment for an input keeps this away from where either program looks at it, s and share of the time.
_MARGIN_S, _MARGIN_SHARE = 0.02, 0.01
_LOOKS_OF_A_LOOP = 3
_RANDOM_TRIES = 20
_MOST_KEPT = 64  # runs of the second program whose progress is remembered
# Sources that have one value for a whole run.
_TIMELESS = frozenset(("variable", "answer", "seed"))


_Clock = Callable[[float], float]


@dataclass(frozen=True, slots=True)
class Budget:
    """How much an exploration may do: cells that it tries, seconds of computing (its result then depends on the
    machine, and says so), seed of the random tries."""

    cells: int = 200
    seconds: float = 120.0
    seed: int = 1


@dataclass(frozen=True, slots=True, eq=False)
class Exploration:
    """cells: the found ones, without the user's own; others: the same for the second program, whose inputs come when
    that one is as far (progress.py). tried: how many were run. ended: what ended it early (`cells`,
    `seconds`), empty when nothing was left to try. reached: per side, by the runs in the user's cell and the found
    ones; remarks: per side, about statements whose condition never went the other way; one_way: per side, whether
    nothing that can be changed was ever looked at (see reach.reach_of). unmatched: per side, kept values that it looks
    at and that the other one does not keep, so that they stayed as they are. time_s: how long a run in a found cell
    took at most."""

    cells: tuple[Cell, ...]
    others: tuple[Cell, ...]
    tried: int
    ended: str
    reached: tuple[tuple[Reached, ...], ...]
    remarks: tuple[dict[Key, str], ...]
    one_way: tuple[bool, ...]
    unmatched: tuple[tuple[str, ...], ...]
    time_s: float


def explore(sides: Sequence[Side], cell: Cell | None = None, budget: Budget = Budget()) -> Exploration:
    """Explore one program, or two that are to mean the same, from a cell on. Raises UsageError or RunError when the
    user's own cell does not fit."""
    return _Explorer(sides, cell if cell is not None else Cell(), budget).explore()


@dataclass(slots=True, eq=False)
class _Ways:
    """What one side has done so far in all runs: marks of each code as bits, looks, time-outs."""

    marks: dict[Code, int] = field(default_factory=dict)
    looks: set[object] = field(default_factory=set)

    def add(self, seen: Seen) -> bool:
        """Join a run; TRUE when it has done something new."""
        new = False
        for code, marks in _marks(seen).items():
            before = self.marks.get(code, 0)
            self.marks[code] = before | marks
            new = new or marks & ~before != 0
        looks: set[object] = {(look.code, look.at, look.source) for look in seen.looks}
        looks |= {("late", *place) for place in seen.late} | seen.met
        new = new or not looks <= self.looks
        self.looks |= looks
        return new

    def has(self, code: Code, place: int) -> bool:
        """Is the mark set? `place` as in Machine.marks_of."""
        size = 2 * len(code.instructions)
        return bool(self.marks.get(code, 0) >> 8 * (place % size) & 1) if size else True


def _marks(seen: Seen) -> dict[Code, int]:
    """The marks of the program's own code as bits."""
    reached = seen.result.reached
    assert reached is not None  # every run has them
    return {code: int.from_bytes(marks, "little") for code, marks in reached.marks.items() if not code.predefined}


@dataclass(frozen=True, slots=True, eq=False)
class _Step:
    """A cell that led on, as each side has it, and what each side showed in it."""

    cells: tuple[Cell, ...]
    seen: tuple[Seen, ...]

    @property
    def cell(self) -> Cell:
        """As the first side has it."""
        return self.cells[0]


class _Explorer:
    def __init__(self, sides: Sequence[Side], cell: Cell, budget: Budget) -> None:
        self.sides, self.start, self.budget = tuple(sides), cell, budget
        self.names = Names(self.sides)
        self.constants = constants_of(self.sides)
        self.ways = [_Ways() for _ in self.sides]
        self.known: set[object] = {_identity(cell)}
        self.steps: list[_Step] = []
        self.tried = 0
        self.begun = time.process_time()
        self.limits = [side.limits for side in self.sides]
        self.moments: dict[object, float] = {}
        self.progress: dict[object, Progress | None] = {}
        self.branches: dict[Code, dict[int, Branch]] = {}
        self.every = [{code: _every(code) for _, code in side.linked.codes()} for side in self.sides]

    def explore(self) -> Exploration:
        """All of it."""
        seen = tuple(side.run(self.start, side.limits) for side in self.sides)
        self._take(_Step((self.start,) * len(self.sides), seen))
        self.limits = [_tighter(side.limits, seen) for side, seen in zip(self.sides, self.steps[0].seen, strict=True)]
        at, ended = 0, ""
        while at < len(self.steps) and not ended:
            ended = self._try_all(self._children(self.steps[at]))
            at += 1
            if at == len(self.steps) and not ended:
                ended = self._try_all(self._random())
        kept = self._needed()
        reached = tuple(
            tuple(found for step in kept if (found := step.seen[number].result.reached) is not None)
            for number in range(len(self.sides))
        )
        remarks = tuple(self._remarks(number) for number in range(len(self.sides)))
        one_way = tuple(
            not any(step.seen[number].looks or self.start.vendor for step in self.steps)
            for number in range(len(self.sides))
        )
        unmatched = tuple(self._unmatched(number) for number in range(len(self.sides)))
        longest = max(limits.time_s for limits in self.limits)
        cells, others = tuple(step.cell for step in kept[1:]), tuple(step.cells[-1] for step in kept[1:])
        return Exploration(cells, others, self.tried, ended, reached, remarks, one_way, unmatched, longest)

    # ---- trying

    def _try_all(self, cells: Iterator[Cell]) -> str:
        """Run cells as they come; gives what ended it early."""
        for cell in cells:
            identity = _identity(cell)
            if identity in self.known:
                continue
            self.known.add(identity)
            if self.tried >= self.budget.cells:
                return "cells"
            if time.process_time() - self.begun > self.budget.seconds:
                return "seconds"
            self.tried += 1
            try:
                step = self._run(cell)
            except RplError:
                continue  # a value that does not fit the variable: not a cell for this program
            if len(self.sides) == 1 or self._is_robust(step):
                self._take(step)
        return ""

    def _run(self, cell: Cell) -> _Step:
        """Run all sides in a cell; each input comes to a second program where that one is as far as the first one."""
        first = self.sides[0].run(cell, self.limits[0])
        if len(self.sides) == 1:
            return _Step((cell,), (first,))
        timed = any(one.time_s > 0.0 for one in cell.inputs)
        ours = self._progress(0, first) if timed else None
        there = self._in_step(cell, ours) if ours is not None else cell
        return _Step((cell, there), (first, self.sides[1].run(there, self.limits[1])))

    def _in_step(self, cell: Cell, ours: Progress) -> Cell:
        """The cell for the second side, whose inputs come one by one: where it is as far it shows without those that
        come later."""
        done: list[Input] = []
        for number, one in enumerate(cell.inputs):
            before = done[-1].time_s if done else 0.0
            key = (_identity(replace(cell, inputs=cell.inputs[:number])), one.time_s)
            if one.time_s > 0.0 and key not in self.moments:
                theirs = self._without(replace(cell, inputs=tuple(done)))
                self.moments[key] = moment(one.time_s, ours, theirs) if theirs is not None else one.time_s
            done.append(replace(one, time_s=max(before, self.moments[key]) if one.time_s > 0.0 else one.time_s))
        return replace(cell, inputs=tuple(done))

    def _without(self, cell: Cell) -> Progress | None:
        """How far the second side is in a cell in which further inputs have not come."""
        key = _identity(cell)
        if key not in self.progress:
            if len(self.progress) >= _MOST_KEPT:
                self.progress.clear()
            self.progress[key] = self._progress(1, self.sides[1].run(cell, self.limits[1]))
        return self.progress[key]

    def _progress(self, number: int, seen: Seen) -> Progress | None:
        """How far a side is when; None where that does not matter, in one language."""
        languages = [side.program.modules[0].dialect for side in self.sides]
        if languages[0] == languages[-1]:
            return None
        return progress_of(seen.result, self.sides[number].program)

    def _take(self, step: _Step) -> None:
        """Keep a step that leads on."""
        new = [ways.add(seen) for ways, seen in zip(self.ways, step.seen, strict=True)]
        for known, seen in zip(self.names.set_first, step.seen, strict=True):
            known |= seen.set_first
        if any(new) or not self.steps:
            self.steps.append(step)

    def _is_robust(self, step: _Step) -> bool:
        """Does no statement of either side look at an input about when it changes, and does nothing begin to watch it
        then? Two programs come there at slightly different times, and would see different values."""
        for number, run in enumerate(step.seen):
            both = zip(step.cells[0].inputs, step.cells[number].inputs, strict=True)
            given = [own for one, own in both if one.time_s > 0.0 and one not in self.start.inputs]
            watched: set[Source] = set()
            for look in run.looks:
                begins = look.how == EVENT and look.source not in watched
                watched |= {look.source} if begins else set()
                looks = look.how == STATEMENT and look.times <= _LOOKS_OF_A_LOOP
                if not (looks or begins) or look.source.kind in _TIMELESS:
                    continue
                texts = self.names.texts(number, look.source)
                for one in given:
                    margin = _MARGIN_S + _MARGIN_SHARE * one.time_s
                    last = look.last_s if looks else look.first_s
                    near = min(abs(look.first_s - one.time_s), abs(last - one.time_s)) < margin
                    if near and any(self.names.same(one.signal, text) for text in texts):
                        return False
        return True

    # ---- what to try

    def _children(self, step: _Step) -> Iterator[Cell]:
        """Cells that may lead on from a step: for each decision that never went the other way, each wait, each armed
        interrupt; then every source by itself."""
        for number, seen in enumerate(step.seen):
            clock = self._clock(number, step)
            yield from self._of_waits(number, step.cell, seen, clock)
            yield from self._of_decisions(number, step.cell, seen, clock)
            yield from self._of_events(number, step.cell, seen, clock)
        for number, seen in enumerate(step.seen):
            for look in _each_source(seen.looks):
                for given in self._given(number, look):
                    if self._is_done():
                        return
                    yield with_given(step.cell, given, 0.0, self.names)

    def _clock(self, number: int, step: _Step) -> _Clock:
        """When the first side is where this one is at a moment."""
        if number == 0:
            return lambda time_s: time_s
        ours, theirs = self._progress(number, step.seen[number]), self._progress(0, step.seen[0])
        if ours is None or theirs is None:
            return lambda time_s: time_s
        return lambda time_s: round(moment(time_s, ours, theirs), 3) if time_s > 0.0 else time_s

    def _is_done(self) -> bool:
        """Has everything been gone that the runs came near to?"""
        return all(
            ways.marks.get(code, 0) & every == every
            for ways, wanted in zip(self.ways, self.every, strict=True)
            for code, every in wanted.items()
        )

    def _given(self, number: int, look: Look, statement: Key | None = None) -> list[Given]:
        """Other values for a source that was looked at, for the conditions of a statement."""
        texts = self.names.texts(number, look.source)
        if not self.names.means(number, look):
            return []
        values = values_for(look.source, look.value, look.choices, self.constants, statement)
        return [Given(look.source, texts, value) for value in values]

    def _branch(self, code: Code, at: int) -> Branch | None:
        if code not in self.branches:
            self.branches[code] = {branch.at: branch for branch in code.branches}
        return self.branches[code].get(at)

    def _of_waits(self, number: int, cell: Cell, seen: Seen, clock: _Clock) -> Iterator[Cell]:
        """What the tasks waited for at the end comes; what a wait with a time limit waited for does not come."""
        for code, at, since in seen.stuck:
            if self._is_done():
                break
            looks = [look for look in _each_source(reversed(seen.looks)) if (look.code, look.at) == (code, at)]
            yield from self._changed(number, cell, looks, clock(since + _AFTER_S))
        for code, at in sorted(seen.timed, key=lambda place: _order(*place)):
            if ("late", code, at) in self.ways[number].looks:
                continue
            looks = [look for look in _each_source(seen.looks) if (look.code, look.at) == (code, at)]
            for look in looks:
                for value in dict.fromkeys((look.value, *values_for(look.source, look.value, (), self.constants))):
                    texts = self.names.texts(number, look.source)
                    if texts and look.source.kind not in _TIMELESS:
                        yield with_given(cell, Given(look.source, texts, value), 0.0, self.names)

    def _of_decisions(self, number: int, cell: Cell, seen: Seen, clock: _Clock) -> Iterator[Cell]:
        """For each decision: the way that was not gone, then the values that its sources did not have there."""
        ways = self.ways[number]
        for (code, at), index in seen.evaluated.items():
            branch = self._branch(code, at)
            if branch is None or code.predefined:
                continue
            key = key_of(code.origin(at))
            direct = list(_each_source(look for look in seen.looks if (look.code, look.at) == (code, at)))
            before = [look for look in reversed(seen.looks[:index]) if look.how in (STATEMENT, WAIT)]
            yield from self._together(number, cell, (code, at), direct[:_TOGETHER])
            for look in list(_each_source((*direct, *before)))[:RECENT]:
                moments = _moments(look, seen.looks) if look.source.kind not in _TIMELESS else [0.0]
                for time_s, given in product(moments, self._given(number, look, key)):
                    met = (code, at, frozenset(((look.source, given.value),)))
                    one_way = not (ways.has(code, branch.held) and ways.has(code, ~at))
                    if met not in ways.looks or (one_way and time_s > 0.0):
                        yield with_given(cell, given, clock(time_s), self.names)

    def _together(self, number: int, cell: Cell, place: tuple[Code, int], looks: Sequence[Look]) -> Iterator[Cell]:
        """All combinations of the sources of one condition."""
        if len(looks) < 2:
            return
        key = key_of(place[0].origin(place[1]))
        several = [[None, *self._given(number, look, key)[:2]] for look in looks]
        for chosen in product(*several):
            now = {look.source: look.value for look in looks} | {one.source: one.value for one in chosen if one}
            if (*place, frozenset(now.items())) not in self.ways[number].looks:
                yield self._all_given(cell, chosen, 0.0)

    def _all_given(self, cell: Cell, chosen: Sequence[Given | None], time_s: float) -> Cell:
        for one in chosen:
            cell = with_given(cell, one, time_s, self.names) if one is not None else cell
        return cell

    def _changed(self, number: int, cell: Cell, looks: Sequence[Look], time_s: float) -> Iterator[Cell]:
        """Sources of one condition, each by itself, then several of them together."""
        for look in looks:
            for given in self._given(number, look):
                yield with_given(cell, given, time_s, self.names)
        if len(looks) < 2:
            return
        several = [[None, *self._given(number, look)[:2]] for look in looks[:_TOGETHER]]
        for chosen in product(*several):
            yield self._all_given(cell, chosen, time_s)

    def _of_events(self, number: int, cell: Cell, seen: Seen, clock: _Clock) -> Iterator[Cell]:
        """What interrupts and searches wait for comes while they do: best while the program waits, where both programs
        are at one place."""
        ways = self.ways[number]
        armed = [code for code in seen.armed if not ways.has(code, 0)]
        watched = {look.source for look in seen.looks if look.how == EVENT}
        if not armed and not watched:
            return
        moments = _spread(seen)
        for look in _each_source(seen.looks):
            if look.source.kind in _TIMELESS or not (armed or look.source in watched):
                continue
            for time_s, given in product(moments, self._given(number, look)):
                if self._is_done():
                    return
                yield with_given(cell, given, clock(time_s), self.names)

    def _random(self) -> Iterator[Cell]:
        """Several sources at once, by chance, for what nothing else led to."""
        chance = random.Random(self.budget.seed)
        sources = [
            (number, look)
            for number in range(len(self.sides))
            for look in _each_source(look for step in self.steps for look in step.seen[number].looks)
            if self._given(number, look)
        ]
        for _ in range(_RANDOM_TRIES if len(sources) > 1 else 0):
            if self._is_done():
                return
            step = chance.choice(self.steps)
            cell = step.cell
            for number, look in chance.sample(sources, min(len(sources), chance.randint(2, _TOGETHER))):
                moments = [0.0, *map(self._clock(number, step), _spread(step.seen[number]))]
                cell = with_given(cell, chance.choice(self._given(number, look)), chance.choice(moments), self.names)
            yield cell

    # ---- what came of it

    def _needed(self) -> list[_Step]:
        """The user's cell, and of the others those that add a way; later ones, which went further, first."""
        done = [_Ways() for _ in self.sides]
        kept = {0}
        for ways, seen in zip(done, self.steps[0].seen, strict=True):
            ways.add(_without_looks(seen))
        for place in range(len(self.steps) - 1, 0, -1):
            new = [ways.add(_without_looks(run)) for ways, run in zip(done, self.steps[place].seen, strict=True)]
            if any(new):
                kept.add(place)
        return [step for place, step in enumerate(self.steps) if place in kept]

    def _unmatched(self, number: int) -> tuple[str, ...]:
        """Kept values that a side looks at and that cannot be given to both."""
        if len(self.sides) == 1:
            return ()
        names, found = self.names, []
        for look in _each_source(look for step in self.steps for look in step.seen[number].looks):
            given = names.texts(number, look.source) if number else names.means(number, look)
            if look.source.kind == "variable" and not given:
                found.append(str(look.source.key))
        return tuple(found)

    def _remarks(self, number: int) -> dict[Key, str]:
        """About decisions that went one way only: whether anything that could decide them was looked at before."""
        found: dict[Key, str] = {}
        vendor = any(meaning.value is not None for meaning in self.start.vendor)
        for step in self.steps:
            seen = step.seen[number]
            for (code, at), index in seen.settled.items():
                branch = self._branch(code, at)
                if branch is None or (self.ways[number].has(code, branch.held) and self.ways[number].has(code, ~at)):
                    continue
                free = not vendor and not index and not any((look.code, look.at) == (code, at) for look in seen.looks)
                key = key_of(code.origin(at))
                if not free:
                    tried = f"{self.tried} other cells did not change that"
                    found[key] = tried if self.tried else "it looks at kept data that is not changed"
                else:
                    found.setdefault(key, UNDRIVEN)
        return found


def _every(code: Code) -> int:
    """The marks of a code of which all instructions were executed."""
    return int.from_bytes(b"\x01" * len(code.instructions), "little")


def _without_looks(seen: Seen) -> Seen:
    return replace(seen, looks=())


def _tighter(limits: Limits, seen: Seen) -> Limits:
    """Limits for changed cells, in which a program may go round for ever: some times what the first run took."""
    steps = max(100_000, 5 * seen.result.statements)
    return replace(
        limits,
        time_s=min(limits.time_s, 2.0 * seen.result.time_s + 20.0),
        statements=steps if limits.statements is None else min(limits.statements, steps),
    )


def _each_source(looks: Sequence[Look] | Iterator[Look]) -> Iterator[Look]:
    """The first look at each source."""
    known: set[Source] = set()
    for look in looks:
        if look.source not in known:
            known.add(look.source)
            yield look


def _moments(look: Look, looks: Sequence[Look]) -> list[float]:
    """When a source may change so that this look sees another value: between the look before and this one; in the
    middle of a look that goes on; at the start."""
    before = [one.last_s for one in looks if one.source == look.source and one.last_s < look.first_s]
    found = [round((max(before) + look.first_s) / 2, 3)] if before else []
    if look.last_s > look.first_s:
        found.append(round(look.first_s + min(_AFTER_S, (look.last_s - look.first_s) / 2), 3))
    return [*found, 0.0]


def _spread(seen: Seen) -> list[float]:
    """Moments of a run at which something may come: in the middle of waits, longest first, then over its time."""
    quiet = sorted((span for span in seen.quiet if span[1] - span[0] > 10 * _MARGIN_S), key=lambda s: s[0] - s[1])[:3]
    middles = [round((begin + end) / 2, 3) for begin, end in quiet]
    return [*middles, *(round(seen.result.time_s * part, 3) for part in (0.5, 0.25, 0.75, 0.125, 0.9))]


def _order(code: Code, at: int) -> tuple[str, int]:
    return (code.name, at)


def _identity(cell: Cell) -> object:
    """What tells cells apart that an exploration makes of one."""
    answers = tuple((one.answer, one.after_s, one.text.pattern if one.text else None) for one in cell.answers)
    variables = tuple((name, repr(value)) for name, value in cell.variables.items())
    return (cell.inputs, cell.reactions, answers, variables, cell.seed)


__all__ = ["Budget", "Exploration", "explore"]

"""A run that notes what it looks at: inputs, kept variables that nothing has written yet, answers of the operator. From
that an exploration knows what to give so that a program goes another way.
"""

from __future__ import annotations

import random
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING, Any

from rpl import ir
from rpl.ir.walk import walk
from rpl.runtime.code import Code, Values
from rpl.runtime.limits import DEFAULTS, Limits
from rpl.runtime.signals import Key, group_bits, is_bit_group, usual_key, zero_of
from rpl.runtime.values import Array, SignalRef, Value
from rpl.runtime.waits import TIMED_OUT
from rpl.simulation import Simulation
from rpl.source import Origin

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator, Mapping

    from rpl.cell import Cell
    from rpl.emulator.model import RobotModel
    from rpl.linking.program import LinkedProgram
    from rpl.motionmodel import MotionModel
    from rpl.runtime.interrupts import Interrupt
    from rpl.runtime.ports import Task
    from rpl.runtime.trace import RunResult
    from rpl.runtime.waits import Wait

# How a source was looked at: by a statement, by a wait that stands, by what watches for an event (interrupt, search).
STATEMENT, WAIT, EVENT = "statement", "wait", "event"
MOST_LOOKS = 5000
RECENT = 6  # sources that were looked at before a decision and may be behind it
_SCALAR = bool | int | float | str
_NO_LINE = -1  # pauses_at is asked before each instruction while there are breakpoints; this one is never met


@dataclass(frozen=True, slots=True)
class Source:
    """Something that the surroundings give. kind: the kind of an input signal (digital_in, ...), `bits` (key: kind,
    first, last of a group of bits), `variable` (key: its name, with the index of an element), `data` (key: the name of
    a kept pose, record or array as a whole, which is not changed), `answer` (key: the number of the dialog in the run)
    or `seed` of random numbers."""

    kind: str
    key: Key | tuple[str, int, int]


@dataclass(slots=True, eq=False)
class Look:
    """What a place of the program saw of a source: from first_s to last_s (s), so many `times`, always this value.
    `choices`: the numbers of the keys that a dialog has."""

    source: Source
    value: Value
    code: Code | None
    at: int
    how: str
    first_s: float
    last_s: float
    times: int = 1
    choices: tuple[int, ...] = ()


# A deciding instruction, and values of sources: all that it looked at itself, or one that was looked at before it.
Met = tuple[Code, int, frozenset[tuple[Source, Value]]]


@dataclass(frozen=True, slots=True, eq=False)
class Seen:
    """What a watched run showed. `evaluated`, `settled`: how many looks there were before an instruction that decides
    was executed first, and last; `met`: with what values it was. `late`: waits whose time ran out; `timed`: those that
    have one. `stuck`: where tasks stood waiting at the end, and since when. `armed`: actions of interrupts that were
    waited for. `quiet`: spans of time (s) in which tasks waited. `set_first`: kept values that the program set itself
    before it looked at them."""

    result: RunResult
    looks: tuple[Look, ...]
    evaluated: Mapping[tuple[Code, int], int]
    settled: Mapping[tuple[Code, int], int]
    met: frozenset[Met]
    late: frozenset[tuple[Code, int]]
    timed: frozenset[tuple[Code, int]]
    stuck: tuple[tuple[Code, int, float], ...]
    armed: tuple[Code, ...]
    quiet: tuple[tuple[float, float], ...]
    set_first: frozenset[Source] = frozenset()


@dataclass(frozen=True, slots=True, eq=False)
class Side:
    """A program to explore, and how it is run. `words`: the cell in the words of this program; `kept`: by the folded
    name of one of its variables the names that the first program may have for it."""

    program: ir.Program
    linked: LinkedProgram
    robot: RobotModel | None = None
    entry: str | None = None
    limits: Limits = DEFAULTS
    controller: str | MotionModel | None = None
    words: Callable[[Cell], Cell] = lambda cell: cell
    kinds: Mapping[str, str] = field(default_factory=dict)
    kept: Mapping[str, tuple[str, ...]] = field(default_factory=dict)

    def run(self, cell: Cell, limits: Limits) -> Seen:
        """Run the program in the cell. Raises UsageError or RunError when the cell does not fit."""
        simulation = _Watched(self, self.words(cell), limits)
        simulation.run()
        return simulation.seen()


def side_of(
    program: ir.Program,
    robot: RobotModel | None = None,
    entry: str | None = None,
    limits: Limits = DEFAULTS,
    controller: str | MotionModel | None = None,
    words: Callable[[Cell], Cell] | None = None,
    kept: Mapping[str, tuple[str, ...]] | None = None,
) -> Side:
    """A normalised program as a side of an exploration; it is linked once."""
    from rpl.linking import link

    side = Side(program, link(program), robot, entry, limits, controller, kinds=named_inputs(program), kept=kept or {})
    return side if words is None else replace(side, words=words)


def named_inputs(program: ir.Program) -> dict[str, str]:
    """Input signals that have a name only: folded name -> kind."""
    return {
        node.name.lower(): node.kind
        for node in walk(*program.modules)
        if isinstance(node, ir.Signal) and node.name is not None and node.kind.endswith("_in")
    }


class _Signals(dict[Key, Value]):
    """The signals of a run that tells which inputs are looked at."""

    owner: _Watched | None = None

    def get(self, key: Key, default: Value = None) -> Value:
        value = super().get(key, default)
        if self.owner is not None:
            self.owner.looked_at_signal(key, value)
        return value


class _Globals(Values):
    """The global data of a run that tells which of it is read before anything wrote it."""

    owner: _Watched | None = None

    def __init__(self) -> None:
        super().__init__()
        self.written: set[int] = set()

    def __getitem__(self, place: int) -> Value:  # type: ignore[override]  # places are asked for one by one, never as slices
        value = super().__getitem__(place)
        if self.owner is not None and place not in self.written:
            self.owner.looked_at_variable(place, value)
        return value

    def __setitem__(self, place: int, value: Value) -> None:  # type: ignore[override]  # as above: no slices
        if self.owner is not None:
            self.written.add(place)
            self.owner.set_variable(place)
        super().__setitem__(place, value)


class _Elements(Values):
    """The elements of a kept array, the same for each of them."""

    def __init__(self, items: Values, owner: _Watched, name: str, base: int) -> None:
        super().__init__(items)
        self.owner, self.name, self.base = owner, name, base
        self.written: set[int] = set()

    def __getitem__(self, place: Any) -> Any:
        value = super().__getitem__(place)
        if isinstance(place, slice) or not (value is None or isinstance(value, _SCALAR)):
            self.owner.looked_at(Source("data", self.name), None)
        elif place not in self.written and value is not None:
            self.owner.looked_at(Source("variable", f"{self.name}[{place + self.base}]"), value)
        return value

    def __setitem__(self, place: Any, value: Any) -> None:
        if isinstance(place, int):
            self.written.add(place)
            self.owner.set_source(Source("variable", f"{self.name}[{place + self.base}]"))
        super().__setitem__(place, value)

    def __iter__(self) -> Iterator[Value]:
        self.owner.looked_at(Source("data", self.name), None)
        return super().__iter__()


class _Chance(random.Random):
    """Random numbers that tell that they are asked for."""

    owner: _Watched | None = None

    def random(self) -> float:
        if self.owner is not None:
            self.owner.looked_at_chance()
        return super().random()


class _Watched(Simulation):
    """The run itself. `here` is what looks now: code, instruction, how."""

    def __init__(self, side: Side, cell: Cell, limits: Limits) -> None:
        self.side = side
        self.here: tuple[Code | None, int, str] = (None, -1, EVENT)
        self.looks: list[Look] = []
        self.noted: dict[tuple[Code | None, int, Source], Look] = {}
        self.evaluated: dict[tuple[Code, int], int] = {}
        self.settled: dict[tuple[Code, int], int] = {}
        self.deciding: dict[Code, frozenset[int]] = {}
        self.met: set[Met] = set()
        self.direct: dict[Source, Value] = {}
        self.recent: dict[Source, Value] = {}
        self.late: set[tuple[Code, int]] = set()
        self.with_limit: set[tuple[Code, int]] = set()
        self.armed: dict[Code, None] = {}
        self.sources: set[Source] = set()
        self.set_first: set[Source] = set()
        self.dialogs = 0
        super().__init__(
            side.program,
            side.robot,
            cell,
            side.entry,
            limits=limits,
            controller=side.controller,
            linked=side.linked,
        )
        self.breakpoints = {("", _NO_LINE)}
        self.random = chance = _Chance(cell.seed)
        chance.owner = self

    def _new_globals(self) -> Values:
        return _Globals()

    def _new_signals(self) -> dict[Key, Value]:
        return _Signals()

    def run(self) -> None:
        """Run to the end, from now on noting what is looked at."""
        assert isinstance(self.signals, _Signals) and isinstance(self.globals, _Globals)
        self.signals.owner = self.globals.owner = self
        super().run()
        self.signals.owner = self.globals.owner = None

    # ---- who looks

    def pauses_at(self, task: Task) -> bool:
        """Before each instruction."""
        self._note_met()
        code, at = task.frame.code, task.frame.counter
        self.here = (code, at, STATEMENT)
        deciding = self.deciding.get(code)
        if deciding is None:
            deciding = self.deciding[code] = frozenset(branch.at for branch in code.branches)
        if at in deciding:
            self.evaluated.setdefault((code, at), len(self.looks))
            self.settled[code, at] = len(self.looks)
        return False

    def _note_met(self) -> None:
        """A statement or a look of a wait is over: what values did a decision meet?"""
        code, at, _ = self.here
        if code is not None and (code, at) in self.evaluated and len(self.met) < MOST_LOOKS:
            self.met.add((code, at, frozenset(self.direct.items())))
            for source, _ in zip(reversed(self.recent), range(RECENT), strict=False):
                self.met.add((code, at, frozenset(((source, self.recent[source]),))))
        self.direct.clear()

    def changed(self) -> None:
        """Something changed; who looks then is no statement."""
        before, self.here = self.here, (None, -1, EVENT)
        super().changed()
        self.here = before

    def look_at(self, task: Task) -> None:
        """A task's interrupts look, then its wait."""
        before, self.here = self.here, (None, -1, EVENT)
        for interrupt in task.interrupts.known.values():
            self._note_armed(interrupt)
        super().look_at(task)
        self.here = before

    def _note_armed(self, interrupt: Interrupt) -> None:
        if interrupt.on:
            self.armed.setdefault(interrupt.action)

    def _is_over(self, task: Task, wait: Wait) -> bool:
        before, self.here = self.here, (task.frame.code, wait.at, WAIT)
        over = super()._is_over(task, wait)
        self._note_met()
        self.here = before
        return over

    def schedule_wait(self, task: Task, wait: Wait) -> None:
        """A task begins to wait."""
        if wait.kind in TIMED_OUT and wait.deadline is not None:
            self.with_limit.add((task.frame.code, wait.at))
        super().schedule_wait(task, wait)

    def _wake(self, task: Task, token: int) -> None:
        wait = task.wait
        if wait is not None and wait.token == token and wait.kind in TIMED_OUT and not self._is_over(task, wait):
            self.late.add((task.frame.code, wait.at))
        super()._wake(task, token)

    # ---- what is looked at

    def looked_at_signal(self, key: Key, value: Value) -> None:
        """A signal was read."""
        kind = key[0] if isinstance(key, tuple) else self.side.kinds.get(key, "")
        if not kind.endswith("_in"):
            return
        if value is None and isinstance(key, str) and (usual := usual_key(key)) is not None:
            value = dict.get(self.signals, usual)
        self.looked_at(Source(kind, key), zero_of(kind) if value is None else value)

    def read_unset(self, key: Key, kind: str) -> Value:
        """The same signal under its number, which is no other source."""
        assert isinstance(self.signals, _Signals)
        before, self.signals.owner = self.signals.owner, None
        value = super().read_unset(key, kind)
        self.signals.owner = before
        return value

    def read(self, port: SignalRef) -> Value:
        """A group of bits is looked at as one."""
        if not is_bit_group(port) or not port.kind.endswith("_in"):
            return super().read(port)
        assert isinstance(self.signals, _Signals)
        before, self.signals.owner = self.signals.owner, None
        value = super().read(port)
        self.signals.owner = before
        bits = group_bits(port)
        self.looked_at(Source("bits", (str(bits[0][0]), int(bits[0][1]), int(bits[-1][1]))), value)
        return value

    def looked_at_variable(self, place: int, value: Value) -> None:
        """A global variable was read that nothing has written."""
        slot = self.side.linked.slots[place]
        if slot.kept and isinstance(value, _SCALAR):
            self.looked_at(Source("variable", slot.name), value)
        elif slot.kept and not self._tells_elements(slot.name, value):
            self.looked_at(Source("data", slot.name), None)

    def _tells_elements(self, name: str, value: Value) -> bool:
        """Is it an array whose elements tell that they are looked at? From now on, where they can."""
        if not isinstance(value, Array):
            return False
        items = value.items
        if not isinstance(items, _Elements) and items and (items[0] is None or isinstance(items[0], _SCALAR)):
            value.items = _Elements(items, self, name, value.base)
        return isinstance(value.items, _Elements)

    def set_variable(self, place: int) -> None:
        """A global variable was set."""
        slot = self.side.linked.slots[place]
        if slot.kept:
            self.set_source(Source("variable", slot.name))

    def set_source(self, source: Source) -> None:
        """A kept value was set: what it was before does not count, where nothing has looked at it."""
        if source not in self.sources:
            self.set_first.add(source)

    def looked_at_chance(self) -> None:
        """A random number was asked for."""
        self.looked_at(Source("seed", ""), self.cell.seed)

    def message(self, task: Task, kind: str, text: str, origin: Origin, **more: Value) -> None:
        """A message; a dialog is looked at for its answer."""
        if kind == "dialog":
            keys = more.get("keys") or []
            choices = tuple(number for number, key in enumerate(keys, 1) if key is not None)
            self.looked_at(Source("answer", ("", self.dialogs)), more.get("answer"), choices)
            self.dialogs += 1
        super().message(task, kind, text, origin, **more)

    def looked_at(self, source: Source, value: Value, choices: tuple[int, ...] = ()) -> None:
        """A source was looked at and gave a value."""
        code, at, how = self.here
        self.sources.add(source)
        if how != EVENT:
            self.direct[source] = value
            self.recent.pop(source, None)
            self.recent[source] = value
        last = self.noted.get((code, at, source))
        if last is not None and last.value == value and last.how == how:
            last.last_s = self.now
            last.times += 1
        elif len(self.looks) < MOST_LOOKS:
            look = Look(source, value, code, at, how, self.now, self.now, choices=choices)
            self.looks.append(look)
            self.noted[code, at, source] = look

    # ---- what came of it

    def seen(self) -> Seen:
        """All of it, behind the end of the run."""
        stuck = tuple(
            (task.frame.code, task.wait.at, task.wait.since)
            for task in self.tasks
            if task.wait is not None and task.wait.kind in TIMED_OUT and task.frames
        )
        return Seen(
            self.result(),
            tuple(self.looks),
            self.evaluated,
            self.settled,
            frozenset(self.met),
            frozenset(self.late),
            frozenset(self.with_limit),
            stuck,
            tuple(self.armed),
            tuple((one.begin, one.end) for one in self.waited),
            frozenset(self.set_first),
        )


__all__ = ["EVENT", "RECENT", "STATEMENT", "WAIT", "Look", "Seen", "Side", "Source", "named_inputs", "side_of"]

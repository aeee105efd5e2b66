"""Interpreter mode (TCP 30020): statements that come one by one become part of the program that runs.

A program waits in `interpreter_mode()` until `end_interpreter()`; meanwhile each line that was taken is run, in order,
with the program's own variables and functions. Sources: Universal Robots' article "Interpreter mode" (software 5.10 and
later, e-Series) and the names and meanings of its script manual as UnderAutomation's pages and Elite Robots' manual
(whose controllers take the same words) repeat them; the form of the answers after the client in the article, which
takes the number behind `word: `. The manual itself was not read. M: the reasons of a `discard`, numbers from 1 on, what
`abort` and `skipbuffer` answer.

Each statement is read with what the statements before it have defined, as the last line of a function inside of the
program, and runs from that line on as a program of its own: between two of them the robot stands, `speedl` and threads
end with the statement that began them, and the program's other threads stand still while one runs.
"""

from __future__ import annotations

import asyncio
import itertools
import math
import re
from collections import deque
from collections.abc import Sequence
from dataclasses import dataclass, field
from functools import partial
from typing import TYPE_CHECKING

from rpl import ir
from rpl.cell import Cell, VendorMeaning
from rpl.controllers.ur.panel import Panel
from rpl.controllers.ur.pushed import BLOCK
from rpl.controllers.virtual import within
from rpl.controllers.virtual.lines import answer, line_of
from rpl.diagnostics import Diagnostics, Severity
from rpl.errors import RplError
from rpl.project import ReadProgram, read_sources
from rpl.runtime.values import Array, AxesValue, ExternalValue, JointsValue, Value
from rpl.source import Source, source_from_bytes

if TYPE_CHECKING:
    from rpl.simulation import Simulation

# Signals by which the program says what it does; they have no number and no other controller has them.
_MODE, _KEEPS, _LEAVES, _CLEARED = "interpreter_mode", "interpreter_keeps", "interpreter_leaves", "interpreter_cleared"
_WAITS_S = 1e8
_AXES = 6
_ROUTINE = "interpreted_statements"
_STATES = ("statelastexecuted", "statelastinterpreted", "statelastcleared", "stateunexecuted")
_KEPT = r"\s*\(\s*(?:clearQueueOnEnter\s*=\s*)?False|.*\bclearQueueOnEnter\s*=\s*False"
_LEFT = r".*\bclearOnEnd\s*=\s*False|[^,]*,\s*False"
# What our reader lets pass in a program, and this controller does not in a statement.
_UNLINKED = ("unknown-routine", "unknown-name", "urscript-kept-as-text")
_DEFINES = re.compile(r"\s*(?:def|thread|sec|global|local)\b")
_STORES = re.compile(r"([A-Za-z_]\w*)\s*(?<![=!<>])=(?!=)")
_FUNCTION = re.compile(r"\s*(?:def|thread|sec)\b")
_INNERMOST = re.compile(r"[(\[][^()\[\]]*[)\]]")


def _mode(keeps: bool, leaves: bool) -> VendorMeaning:
    """`interpreter_mode(clearQueueOnEnter=True, clearOnEnd=True)`, by which of its arguments are False."""
    pattern = rf"\binterpreter_mode\b(?{'=' if keeps else '!'}{_KEPT})(?{'=' if leaves else '!'}{_LEFT})"
    return VendorMeaning(re.compile(pattern), "time", _WAITS_S, set=((_KEEPS, keeps), (_LEAVES, leaves), (_MODE, True)))


MEANINGS = Cell(
    vendor=(
        *(_mode(keeps, leaves) for keeps in (True, False) for leaves in (True, False)),
        VendorMeaning(re.compile(r"\bend_interpreter\s*\("), set=((_MODE, False),)),
        VendorMeaning(re.compile(r"\bclear_interpreter\s*\("), set=((_CLEARED, True),)),
    )
)


@dataclass
class Statement:
    """number: what the client hears. `line`: where it stands in the text that was read (1 ...)."""

    number: int
    text: str
    line: int
    read: ReadProgram


@dataclass
class Interpreter:
    """kept: what earlier statements have defined, and those that wait. `values`: data that only statements have."""

    panel: Panel
    waiting: deque[Statement] = field(default_factory=deque)
    kept: list[str] = field(default_factory=list)
    values: dict[str, Value] = field(default_factory=dict)
    interpreted: int = 0
    executed: int = 0
    cleared: int = 0
    clearing: bool = False
    in_mode: bool = False
    numbers: itertools.count[int] = field(default_factory=lambda: itertools.count(1))
    reading: asyncio.Lock = field(default_factory=asyncio.Lock)

    def __post_init__(self) -> None:
        self.panel.cabinet.cell, self.panel.cabinet.fit = MEANINGS, _fit

    # ---- what comes from outside

    async def serve(self, reader: asyncio.StreamReader, writer: asyncio.StreamWriter) -> None:
        """One client, to its end."""
        cabinet = self.panel.cabinet
        cabinet.told("interpreter", "connect", "", counts=False)
        while (line := await line_of(reader)) is not None:
            if not line:
                continue
            word = line.lower()
            if word in _STATES:
                await answer(cabinet, writer, "interpreter", ("look", line), partial(self._state, word))
            elif word in ("skipbuffer", "abort"):
                await answer(cabinet, writer, "interpreter", ("stop", line), partial(self._control, word))
            else:
                async with self.reading:
                    while self.clearing and cabinet.phase != "stopped":
                        await asyncio.sleep(0.002)  # until `clear_interpreter()` has run
                    said = await self._taken(line)
                await answer(cabinet, writer, "interpreter", ("start", line), partial(str, said))

    def _state(self, word: str) -> str:
        numbers = (self.executed, self.interpreted, self.cleared, len(self.waiting))
        return f"state: {numbers[_STATES.index(word)]}: {word}"

    def _control(self, word: str) -> str:
        if word == "skipbuffer":
            self.waiting.clear()
        else:
            self.panel.cabinet.end_move()
        return f"ack: {self.interpreted}: {word}"

    async def _taken(self, text: str) -> str:
        """Read a statement; it waits for its turn if it can be run."""
        if self.panel.cabinet.phase == "stopped":
            return f"discard: no program is running: {text}"
        lines = [*self.kept, text]
        try:
            read, line, said = await asyncio.to_thread(_read, self.panel.cabinet.sources, lines)
        except RplError as error:
            read, line, said = None, 0, str(error)
        if read is None:
            return f"discard: {said.replace(chr(10), ' ')}: {text}"
        statement = Statement(next(self.numbers), text, line, read)
        self.interpreted = statement.number
        self.kept.append(text)
        self.waiting.append(statement)
        self.clearing = self.clearing or re.match(r"clear_interpreter\s*\(", text) is not None
        return f"ack: {statement.number}: {text}"

    # ---- what goes on in the program

    def look(self, tick: int) -> None:
        """Follow the program: it enters the mode and leaves it, ends, or is ready for the next statement."""
        cabinet = self.panel.cabinet
        with cabinet.lock:
            outer = cabinet.outer
            if outer is None or cabinet.phase == "stopped":
                self._forget()
                self.in_mode = False
                return
            signals, was = outer.signals, self.in_mode
            self.in_mode = bool(signals.get(_MODE))
            if self.in_mode and not was and not signals.get(_KEEPS):
                for statement in self.waiting:
                    cabinet.messages.append(f"discard: cleaned up before interpretation: {statement.text}")
                    self.kept.remove(statement.text)
                self.waiting.clear()
            if was and not self.in_mode:
                self._left(outer)
            if self.in_mode and cabinet.phase == "running" and not cabinet.is_within:
                self._next(outer)

    def _left(self, outer: Simulation) -> None:
        if not outer.signals.get(_LEAVES):
            self._forget()
        for task in outer.tasks:
            if task.wait is not None and task.wait.deadline is not None and task.wait.deadline >= _WAITS_S:
                task.awake(False)
                outer.ready(task)

    def _forget(self) -> None:
        """What statements have defined is gone; those that wait are not."""
        if self.kept or self.values:
            self.kept = [one.text for one in self.waiting]
            self.values.clear()
            self.cleared = self.executed
        self.clearing = False

    def _next(self, outer: Simulation) -> None:
        if not self.waiting or not within.is_at_rest(outer):
            return
        cabinet, statement = self.panel.cabinet, self.waiting.popleft()
        self.executed = statement.number
        try:
            inner = cabinet.made(statement.read, _ROUTINE)
        except RplError as error:
            cabinet.messages.append(str(error))
            return
        code = inner.tasks[0].frame.code
        places = [place for place, origin in enumerate(code.origins) if origin.line == statement.line]
        inner.tasks[0].frame.counter = places[0] if places else len(code.instructions) - 1
        within.give_data(inner, self.values, cabinet.fit)
        cabinet.run_within(inner, partial(self._done, statement))

    def _done(self, statement: Statement, inner: Simulation) -> None:
        """Its variables stay; a statement that defines nothing need not be read again."""
        outer = self.panel.cabinet.outer
        known = within.data_of(outer) if outer is not None else {}
        self.values |= {name: value for name, value in within.data_of(inner).items() if name not in known}
        if statement.text in self.kept and not _defines(statement.text):
            self.kept.remove(statement.text)
        if outer is not None and outer.signals.get(_CLEARED):
            outer.signals[_CLEARED] = False
            self._forget()


def _fit(type: ir.Type, value: Value) -> Value:
    """A list of six angles (rad) is joints where a program drives the arm there, else a list."""
    if isinstance(type, ir.JointsType) and isinstance(value, Array) and len(value.items) == _AXES:
        return JointsValue(
            AxesValue(tuple(math.degrees(angle) for angle in value.items)), ExternalValue((0.0,) * _AXES)
        )
    if isinstance(type, ir.ArrayType) and isinstance(value, JointsValue):
        return Array([math.radians(angle) for angle in value.axes.values[:_AXES] if angle is not None], 0)
    return value


def _read(sources: Sequence[Source], lines: Sequence[str]) -> tuple[ReadProgram | None, int, str]:
    """The program with these statements as a function inside of it (which leaves its own lines where they are), the
    line of the last one, and what is wrong with them. Raises RplError."""
    names = sorted({name for line in lines if not _FUNCTION.match(line) for name in _stored(line)})
    body = [f"def {_ROUTINE}():", *(f"global {name}" for name in names), *lines, "end"]
    main = next((one for one in sources if "interpreter_mode" in one.text), sources[-1])
    text = main.text.splitlines()
    at = _last_line(text)
    whole = source_from_bytes(main.path, "\n".join([*text[:at], *body, *text[at:], ""]).encode())
    diagnostics = Diagnostics()
    read = read_sources([whole if one is main else one for one in sources], "urscript", diagnostics)
    first, last = at + 1, at + len(body)
    wrong = [
        one.message
        for one in diagnostics.items
        if first <= one.origin.line <= last
        and (one.severity == Severity.ERROR or (one.origin.line == last - 1 and one.code.name in _UNLINKED))
    ]
    return (None, 0, wrong[0]) if wrong else (read, last - 1, "")


def _last_line(lines: Sequence[str]) -> int:
    """The place of the `end` of the function that waits in `interpreter_mode()`; without one behind all lines."""
    depth, waits = 0, False
    for place, line in enumerate(lines):
        said = line.partition("#")[0].strip()
        waits = waits or "interpreter_mode" in said
        if BLOCK.search(said):
            depth += 1
        elif said == "end":
            depth -= 1
            if depth == 0 and waits:
                return place
    return len(lines)


def _stored(text: str) -> list[str]:
    """The names that a statement assigns; names of arguments are none."""
    bare, left = text, ""
    while bare != left:
        bare, left = _INNERMOST.sub("", bare), bare
    return _STORES.findall(bare)


def _defines(text: str) -> bool:
    """Does a statement give a name a meaning?"""
    return _DEFINES.match(text) is not None or bool(_stored(text))

"""What a run shows: its events, and the result made of them in the shape that `rpl run --json` prints."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

from rpl.runtime.values import SignalRef, Value
from rpl.showing import counted, heading, line, table
from rpl.source import NOWHERE, Origin

if TYPE_CHECKING:
    from rpl.emulator.planner import PlannedMove
    from rpl.runtime.assumed import Assumed
    from rpl.runtime.moves.orders import Payload, Programmed
    from rpl.runtime.reached import Reached
    from rpl.runtime.waits import Awaited, Waited

KINDS = ("move", "output", "input", "message", "warning", "wait", "call", "fault", "end")


@dataclass(frozen=True, slots=True, eq=False)
class Leg:
    """A piece of a move as it was driven: from `start_s` on the clock for `duration_s`, beginning `offset_s` into the
    planned piece."""

    plan: PlannedMove
    start_s: float
    duration_s: float
    offset_s: float = 0.0

    def __deepcopy__(self, memo: object) -> Leg:
        return self


@dataclass(frozen=True, slots=True, eq=False)
class Event:
    """One happening. `data` is what the trace prints beside time, task, kind and place. For comparing runs: `port` is
    the signal of an output or input, `names` all its names, of a fault the routine that an error left unhandled; `legs`
    is how a move was driven (empty without a robot) and `stops` whether it ended in rest; `blend` the kind of its
    corner (see orders.BlendOrder); `payloads` what it carries in it, as the program says; `programmed` what the program
    asks of it (None without a robot).
    `timed`: of an output that is switched after a time, whether that is the end of a `pulse` or a `delay`, and its
    seconds. `named`: what the registers hold that the text of a message names in place of their values."""

    t: float
    task: str
    kind: str
    data: dict[str, Value]
    origin: Origin = NOWHERE
    port: SignalRef | None = None
    names: tuple[str, ...] = ()
    legs: tuple[Leg, ...] = ()
    stops: bool = True
    blend: str = ""
    payloads: tuple[Payload, ...] = ()
    programmed: Programmed | None = None
    timed: tuple[str, float] | None = None
    named: tuple[tuple[str, Value], ...] = ()

    def __deepcopy__(self, memo: object) -> Event:
        return self

    def as_json(self) -> dict[str, Value]:
        origin = self.origin
        place = {"file": origin.file, "line": origin.line}
        return {"t": round(self.t, 6), "task": self.task, "kind": self.kind, **place, **self.data}


@dataclass(frozen=True, slots=True)
class Fault:
    """Why a run ended early. code: a kebab-case word for the kind of fault."""

    code: str
    message: str
    task: str = ""
    origin: Origin = field(default=NOWHERE, compare=False)

    def as_json(self) -> dict[str, Value]:
        return {
            "code": self.code,
            "message": self.message,
            "task": self.task,
            "file": self.origin.file,
            "line": self.origin.line,
        }


class RunInterrupted(KeyboardInterrupt):
    """A key ended the run. `result`: what it has shown so far, with the status `interrupted`; `places`: the tasks that
    had not ended, and where each was."""

    def __init__(self, result: RunResult, places: tuple[tuple[str, Origin], ...]) -> None:
        super().__init__("the run was interrupted")
        self.result = result
        self.places = places


@dataclass(frozen=True, slots=True)
class RunResult:
    """How a run ended. status: finished, stopped, fault, deadlock, limit, interrupted. `outputs` are changes in order:
    time, name of the physical signal, value. `joints` at the end (None without a robot). `awaited`: the tasks that had
    not ended. `waited`: the waits for conditions that ended, met or timed out. `reached`: which statements it came to
    (see rpl.proof.reach). `assumed`: data that had no value and got one (None: the run was not asked to)."""

    status: str
    time_s: float
    moves: int
    statements: int
    messages: tuple[str, ...]
    outputs: tuple[tuple[float, str, Value], ...]
    fault: Fault | None
    trace: tuple[Event, ...]
    joints: tuple[float, ...] | None = None
    awaited: tuple[Awaited, ...] = field(default=(), compare=False)
    waited: tuple[Waited, ...] = ()
    reached: Reached | None = field(default=None, compare=False, repr=False)
    assumed: tuple[Assumed, ...] | None = None

    def _parts(self) -> list[str]:
        return [
            f"{self.status} after {self.time_s:.3f} s",
            counted(self.moves, "move"),
            counted(len(self.outputs), "output"),
            counted(len(self.messages), "message") if self.messages else "",
            f"with {counted(len(self.assumed), 'assumed value')}" if self.assumed else "",
            self._why(),
        ]

    def _why(self) -> str:
        if self.fault is None:
            return ""
        origin = self.fault.origin
        place = f" at {origin.file}:{origin.line}" if origin.source else ""
        return f"{self.fault.code}: {self.fault.message}{place}"

    def __repr__(self) -> str:
        return line("RunResult", self._parts())

    def _repr_html_(self) -> str:
        outputs = [(f"{t:.3f}", name, value) for t, name, value in self.outputs]
        messages = [(text,) for text in self.messages]
        return heading("run", self._parts()) + table(("s", "output", "value"), outputs) + table(("message",), messages)

    def as_json(self) -> dict[str, Value]:
        return {
            "status": self.status,
            "time_s": round(self.time_s, 6),
            "moves": self.moves,
            "statements": self.statements,
            "messages": list(self.messages),
            "outputs": [[round(t, 6), name, value] for t, name, value in self.outputs],
            "fault": self.fault.as_json() if self.fault else None,
            **({} if self.assumed is None else {"assumed": [one.as_json() for one in self.assumed]}),
        }

    def trace_lines(self) -> Iterator[dict[str, Value]]:
        """The events as JSON objects, one a line of the trace."""
        for event in self.trace:
            yield event.as_json()

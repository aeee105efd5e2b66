"""The inside of a virtual controller: files, the program that runs in real or scaled time, mode, drives, signals.

Makers' interfaces stand in front of it and say everything in their words; what happens is here, once. Requests are
reported with `told`, which keeps the transcript and is where faults come.
"""

from __future__ import annotations

import threading
import time
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Literal, Protocol

from rpl import ir
from rpl.controllers.virtual import within
from rpl.controllers.virtual.faults import DroppedError, Faults
from rpl.controllers.virtual.store import NotDoneError, Store
from rpl.controllers.virtual.transcript import Kind, Transcript
from rpl.diagnostics import Diagnostic, Diagnostics, Severity
from rpl.errors import RplError
from rpl.project import ReadProgram, read_sources
from rpl.runtime.limits import Limits
from rpl.runtime.trace import Event
from rpl.runtime.values import Value
from rpl.simulation import Simulation
from rpl.source import Source, source_from_bytes

if TYPE_CHECKING:
    from rpl.cell import Cell
    from rpl.emulator.model import RobotModel
    from rpl.emulator.rotations import FloatArray
    from rpl.runtime.signals import Key

Mode = Literal["manual", "automatic", "remote"]
Phase = Literal["stopped", "running", "paused"]
# Nobody ends the run of a controller; the trace is emptied as it is shown (s, entries).
# How long a program may be run on at once (s of real time), and in which pieces (s of simulated time).
BUSY_S, SLICE_S = 0.02, 0.002
_ENDLESS = Limits(time_s=1e9, steps=50_000, events=100_000_000)


def _run_on(simulation: Simulation, seconds: float) -> bool:
    """Run for so much simulated time, but for no longer than BUSY_S of real time: a program that takes more than this
    machine can do falls behind, and clients are answered all the same. FALSE when the run is over."""
    began, until = time.monotonic(), simulation.now + seconds
    slice_s = max(seconds / 16.0, SLICE_S)
    goes_on = True
    while goes_on and simulation.now < until and time.monotonic() - began < BUSY_S:
        goes_on = simulation.run_until(min(until, simulation.now + slice_s))
    return goes_on


class Keeper(Protocol):
    """Data that outlive programs (registers): they go into one that is selected, and stay when it ends."""

    def given(self, simulation: Simulation) -> None: ...
    def taken(self, simulation: Simulation) -> None: ...


@dataclass
class Cabinet:
    """dialect: the language of its programs. `store`: its files. `time_scale`: simulated seconds of one real second.
    `cell`: what its own statements stand for. `sources`: the texts of the selected program. `keeper`: of data that
    outlive programs."""

    vendor: str
    dialect: str
    model: RobotModel | None
    store: Store
    faults: Faults = field(default_factory=Faults)
    transcript: Transcript = field(default_factory=Transcript)
    time_scale: float = 1.0
    mode: Mode = "remote"
    motors_on: bool = True
    emergency_stop: bool = False
    serial: str = "20260001"
    password: str = "robot"
    program: str = ""
    phase: Phase = "stopped"
    messages: list[str] = field(default_factory=list)
    lock: threading.RLock = field(default_factory=threading.RLock, repr=False)
    requests: int = 0
    cell: Cell | None = None
    fit: within.Fit = within.as_it_is
    keeper: Keeper | None = field(default=None, repr=False)
    sources: tuple[Source, ...] = ()
    _simulation: Simulation | None = field(default=None, repr=False)
    _waiting: tuple[Simulation, Callable[[Simulation], None]] | None = field(default=None, repr=False)
    _keys: tuple[Simulation | None, dict[str, frozenset[Key]]] = field(default=(None, {}), repr=False)
    _standing: tuple[float, ...] | None = field(default=None, repr=False)
    _wall_s: float = 0.0
    _signals: dict[str, Value] = field(default_factory=dict, repr=False)

    def __post_init__(self) -> None:
        if self.model is not None:
            self._standing = tuple(float(value) for value in self.model.home)
        if self.faults.comes("busy", counted=False):
            self.phase = "running"

    # ---- what comes from outside

    def told(self, interface: str, kind: Kind, text: str, counts: bool = True) -> None:
        """A request has come: kept in the transcript; a fault may come with it. Raises DroppedError when the
        connection is to be lost; call `after` behind carrying it out. `counts` is false for what a client sends by
        itself in short cycles: faults are counted by what it does."""
        with self.lock:
            self.transcript.add(interface, kind, text)
            if not counts:
                return
            self.requests += 1
            if self.faults.comes("before"):
                raise DroppedError(False)
            if self.faults.comes("estop"):
                self.press_emergency_stop()

    def after(self) -> None:
        """A request was carried out. Raises DroppedError when the answer is to be lost."""
        with self.lock:
            if self.faults.comes("drop"):
                raise DroppedError(True)

    def login(self, user: str, password: str) -> bool:
        """Is this one let in? `after` tells a refusal by fault from the right password."""
        return password == self.password and not self.faults.comes("login")

    def may_write(self, name: str) -> None:
        """Programs are not replaced while one runs, nor with the emergency stop pressed. Raises NotDoneError."""
        if self.phase == "running":
            raise NotDoneError("busy", self.program or "a program")

    # ---- programs

    def check(self, names: Sequence[str]) -> list[Diagnostic]:
        """What the controller's loader says of these files: errors of the reader, first one first."""
        return list(self._read(names)[1].of(Severity.ERROR))

    def _read(self, names: Sequence[str]) -> tuple[ReadProgram, Diagnostics]:
        return self._read_sources([source_from_bytes(name, self.store.kept(name)) for name in names])

    def _read_sources(self, sources: Sequence[Source]) -> tuple[ReadProgram, Diagnostics]:
        diagnostics = Diagnostics()
        return read_sources(sources, self.dialect, diagnostics), diagnostics

    def select(self, names: Sequence[str], entry: str | None = None) -> list[Diagnostic]:
        """Load a program for running, from its beginning; the errors that keep it from that."""
        sources = [source_from_bytes(name, self.store.kept(name)) for name in names]
        return self.select_sources(sources, entry)

    def select_sources(self, sources: Sequence[Source], entry: str | None = None, anew: str = "") -> list[Diagnostic]:
        """The same for texts that are no files of the controller. They are read before anything is held: in another
        thread, the controller goes on answering meanwhile. `anew`: a module whose data begin as its text says."""
        read, diagnostics = self._read_sources(sources)
        if diagnostics.has_errors:
            return list(diagnostics.of(Severity.ERROR))
        simulation = self.made(read, entry)
        with self.lock:
            for name, value in self._signals.items():
                simulation.set_input(name, value)
            if self.keeper is not None and self.outer is not None:
                self.keeper.taken(self.outer)
            self._keep_data(simulation, anew.lower())
            if self.keeper is not None:
                self.keeper.given(simulation)
            self._stand(simulation)
            self._simulation, self._waiting, self.sources = simulation, None, tuple(sources)
            self.program = entry or sources[0].path
            self.phase = "stopped"
            return []

    def made(self, read: ReadProgram, entry: str | None) -> Simulation:
        """A program as it begins on this controller. Raises RplError."""
        return Simulation(read.program, self.model, self.cell, entry, on_event=self._happened, limits=_ENDLESS)

    def run_within(self, other: Simulation, ended: Callable[[Simulation], None]) -> None:
        """Run another program in the place of the one that waits, from where it stands, to its end; then `ended` hears
        of it and the first one goes on. A fault in it ends both."""
        with self.lock:
            if self._simulation is None or self._waiting is not None:
                raise NotDoneError("busy", self.program)
            self.advance()
            within.carry(self._simulation, other, self.fit)
            self._waiting, self._simulation = (self._simulation, ended), other

    @property
    def outer(self) -> Simulation | None:
        """The selected program, also while another one runs in its place."""
        return self._waiting[0] if self._waiting is not None else self._simulation

    @property
    def is_within(self) -> bool:
        """Does another program run in the place of the selected one?"""
        return self._waiting is not None

    def _keep_data(self, simulation: Simulation, anew: str) -> None:
        """Data that the controller keeps from one run to the next has its last value."""
        if self._simulation is None or not self._simulation.globals:
            return
        old = zip(self._simulation.program.slots, self._simulation.globals, strict=False)
        for name, value in {slot.qualified: value for slot, value in old if slot.kept}.items():
            slot = simulation.program.variable_slot(name)
            if slot is not None and not (anew and name.lower().startswith(f"{anew}.")):
                simulation.variable(name)  # has given all data its first value
                simulation.globals[slot] = value

    def _stand(self, simulation: Simulation) -> None:
        """The robot begins where it stands."""
        for task in simulation.tasks:
            robot = task.robot
            if robot is not None and self._standing is not None and self.model is not None:
                import numpy as np

                robot.joints = robot.planned_joints = np.array(self._standing)
                break

    def start(self) -> None:
        """Run what is selected, from where it is. Raises NotDoneError."""
        with self.lock:
            if self.emergency_stop:
                raise NotDoneError("emergency-stop")
            if self._simulation is None:
                raise NotDoneError("missing", "no program is selected")
            self._wall_s = time.monotonic()
            self.phase = "running"

    def pause(self) -> None:
        with self.lock:
            self.advance()
            if self.phase == "running":
                self.phase = "paused"

    def stop(self) -> None:
        """End the program; it would begin anew."""
        with self.lock:
            self.advance()
            self._keep_standing()
            if self.keeper is not None and self.outer is not None:
                self.keeper.taken(self.outer)
            self.phase, self._simulation, self._waiting = "stopped", None, None

    def end_move(self) -> None:
        """Brake the move that is driven now; the program goes on behind it."""
        with self.lock:
            self.advance()
            task = within.moving_task(self._simulation) if self._simulation is not None else None
            if task is not None and task.robot is not None and not task.robot.is_standing():
                task.robot.halt(False, ends_move=True)

    def press_emergency_stop(self) -> None:
        with self.lock:
            self.pause()
            self.emergency_stop, self.motors_on = True, False

    def release_emergency_stop(self) -> None:
        self.emergency_stop = False

    # ---- time

    def advance(self) -> None:
        """Let the program run on to the present moment of real time, scaled."""
        with self.lock:
            simulation, now = self._simulation, time.monotonic()
            if self.phase != "running" or simulation is None:
                return
            passed, self._wall_s = now - self._wall_s, now
            try:
                goes_on = _run_on(simulation, passed * self.time_scale)
            except RplError as error:
                self.messages.append(str(error))
                goes_on = False
            simulation.trace.clear()
            if not goes_on or simulation.ended or (self._waiting is not None and simulation.tasks[0].has_ended):
                self._ended(simulation)

    def _ended(self, simulation: Simulation) -> None:
        fault = simulation.end_fault
        if self._waiting is not None:
            outer, ended = self._waiting
            within.carry(simulation, outer, self.fit)
            self._simulation, self._waiting = outer, None
            ended(simulation)
            if fault is None:
                return
        if fault is not None:
            self.messages.append(f"{fault.code}: {fault.message}")
        self._keep_standing()
        self.phase = "stopped"

    def _keep_standing(self) -> None:
        found = self.joints
        self._standing = found if found is not None else self._standing

    def _happened(self, event: Event) -> None:
        if event.kind == "message":
            self.messages.append(str(event.data.get("text", "")))

    # ---- what is seen

    @property
    def joints(self) -> tuple[float, ...] | None:
        """Where the axes are now, in the robot's own units (degrees, mm) and signs; None without a robot."""
        with self.lock:
            if self._simulation is not None:
                for task in self._simulation.tasks:
                    if task.robot is not None and (found := task.robot.joints_now()) is not None:
                        return found
            return self._standing

    @property
    def flange(self) -> FloatArray | None:
        """The flange in the robot's base, shape (4, 4), mm."""
        joints = self.joints
        return None if joints is None or self.model is None else self.model.forward(joints)

    def tool_at(self, joints: Sequence[float]) -> FloatArray | None:
        """The tool that the program has now, with the axes there, in the robot's base, shape (4, 4), mm."""
        from rpl.runtime.functions.neutral import tool_pose
        from rpl.runtime.moves.chain import matrix_of

        if self.model is None:
            return None
        flange = self.model.forward(joints)
        with self.lock:
            tasks = self._simulation.tasks if self._simulation is not None else []
            task = next((one for one in tasks if one.robot is not None), None)
            return flange if task is None else flange @ matrix_of(tool_pose(task))

    @property
    def line(self) -> int:
        """The line that the program is at; 0 without one."""
        with self.lock:
            return self._simulation.where()[1] if self._simulation is not None else 0

    @property
    def is_over(self) -> bool:
        """Has the selected program come to its end?"""
        with self.lock:
            return self._simulation is not None and self._simulation.ended

    @property
    def place(self) -> tuple[str, int]:
        """The file and the line (1 ...) that the program is at; "" and 0 without one."""
        with self.lock:
            return self._simulation.where() if self._simulation is not None else ("", 0)

    def signal(self, name: str) -> Value:
        """The value of a signal, by a name or number as its language spells it; None: nobody has set it."""
        with self.lock:
            if self._simulation is not None:
                for key in self._keys_of(name, self._simulation):
                    if key in self._simulation.signals:
                        return self._simulation.signals[key]
            return self._signals.get(name)

    def _keys_of(self, name: str, simulation: Simulation) -> frozenset[Key]:
        """Under which keys the selected program may have the signal: worked out once for each program."""
        from rpl.runtime.signals import keys_named

        if self._keys[0] is not simulation:
            self._keys = (simulation, {})
        found = self._keys[1].get(name)
        if found is None:
            found = self._keys[1][name] = keys_named(name, simulation.linked.alias(name))
        return found

    def signal_names(self) -> list[str]:
        """The signals that are known by a name: somebody has set them, from outside or in the program."""
        with self.lock:
            set_inside = self._simulation.signals if self._simulation is not None else {}
            return sorted({*self._signals, *(key for key in set_inside if isinstance(key, str))})

    def set_signal(self, name: str, value: Value) -> None:
        """Switch a signal from outside; a program that runs sees it."""
        self.set_signals({name: value})

    def set_signals(self, values: Mapping[str, Value]) -> None:
        """Switch several at one moment."""
        with self.lock:
            self.advance()
            self._signals |= values
            if self._simulation is not None:
                for name, value in values.items():
                    self._simulation.set_input(name, value)
                self._simulation.trace.clear()

    def variable(self, name: str) -> Value:
        """The value of a variable of the selected program. Raises UsageError when there is none."""
        with self.lock:
            if self._simulation is None:
                raise NotDoneError("missing", name)
            self.advance()
            return self._simulation.variable(name)

    def set_variable(self, name: str, changed: Callable[[Value], Value]) -> None:
        """Give a global variable of the selected program another value: `changed` makes it from the present one, so
        that it keeps its shape. Raises UsageError when there is none, and what `changed` raises."""
        with self.lock:
            old = self.variable(name)
            simulation = self._simulation
            slot = simulation.program.variable_slot(name) if simulation is not None else None
            if simulation is None or slot is None:
                raise NotDoneError("missing", name)
            simulation.globals[slot] = changed(old)
            simulation.changed()

    def data_names(self) -> list[str]:
        """The global data of the selected program that it keeps between runs, as `module.name`, in order."""
        with self.lock:
            modules = () if self._simulation is None else self._simulation.program.program.modules
            return sorted(
                f"{module.name}.{one.name}"
                for module in modules
                for one in module.declarations
                if isinstance(one, ir.Variable) and one.storage == "persistent"
            )

    def stand_at(self, joints: Sequence[float]) -> None:
        """The robot is led to other joints from outside (its own units). Raises NotDoneError."""
        with self.lock:
            if self.emergency_stop or not self.motors_on:
                raise NotDoneError("emergency-stop" if self.emergency_stop else "busy", "the drives are off")
            self._standing = tuple(joints)
            if self._simulation is not None:
                self._stand(self._simulation)

"""The machine that a program runs on: clock, agenda of events, signals, messages, trace, and how a run ends.

The agenda is a heap ordered by (moment, phase, priority, task, sequence): two runs of one program give equal events.
All state is plain data; what never changes (linked program, robot model, cell) is shared between snapshots.
"""

from __future__ import annotations

import copy
import random
import re
from collections import Counter
from collections.abc import Callable, Iterable, Sequence
from heapq import heappop, heappush
from typing import TYPE_CHECKING, Any

from rpl.runtime import meetings, tasks
from rpl.runtime.assumed import Assumed
from rpl.runtime.awaited import awaited, words
from rpl.runtime.code import Code, Read, Values
from rpl.runtime.faults import ProgramError
from rpl.runtime.interrupts import Interrupt
from rpl.runtime.limits import EVENTS_OF_MOTION, MOST_WAITING, STEPS_OF_EVENT, Limits
from rpl.runtime.moves import searching
from rpl.runtime.moves.queue import MotionQueue
from rpl.runtime.moves.scene import Scene
from rpl.runtime.reached import Reached
from rpl.runtime.reactions import Reactions
from rpl.runtime.signals import Key, bit_kind, group_bits, is_bit_group, key_of, keys_named, usual_key, zero_of
from rpl.runtime.task import ENDED, READY, WAITING
from rpl.runtime.trace import Event, Fault, RunResult
from rpl.runtime.values import SignalRef, StopWatch, Value, whole
from rpl.runtime.waits import CYCLE_S, TIMED_OUT, Arrival, Wait, Waited, poll_step
from rpl.source import NOWHERE, Origin

if TYPE_CHECKING:
    from rpl.cell import Cell, Reaction
    from rpl.emulator.model import RobotModel
    from rpl.motionmodel import MotionModel
    from rpl.runtime.linked import Linked
    from rpl.runtime.ports import Bodies, Task

# Phases of one moment, in order.
INPUTS, ARRIVALS, TIMERS, TASKS, MOTION = range(5)
MOST_CALLS_SHOWN = 100_000
# Moments that differ by less (s) are one: how the arithmetic of two ways to one moment rounds decides no order.
SAME_MOMENT_PLACES = 9
Entry = tuple[float, int, int, int, int, float, str, tuple[Any, ...]]


class Machine:
    """Everything that changes while a program runs."""

    def __init__(
        self,
        linked: Linked,
        model: RobotModel | None,
        cell: Cell,
        limits: Limits,
        on_event: Callable[[Event], None] | None = None,
        controller: MotionModel | None = None,
        further: tuple[RobotModel, ...] = (),
    ) -> None:
        self.linked = linked
        self.model = model
        self.further = further  # the robots of the second and further motion tasks
        self.controller = controller
        self.cell = cell
        self.scene = Scene(model.among(cell.mechanisms, cell.path).mechanisms if model is not None else cell.mechanisms)
        self.limits = limits
        self.on_event = on_event
        self.now = 0.0
        self.agenda: list[Entry] = []
        self.sequence = 0
        self.globals: Values = self._new_globals()
        self.marks: dict[Code, bytearray] = {}
        self.signals: dict[Key, Value] = self._new_signals()
        self.names: dict[Key, str] = {}
        self.tasks: list[Task] = []
        self.latest: dict[str, str] = {}  # routine -> its task that was started last, where it has several
        self.trace: list[Event] = []
        self.outputs: list[tuple[float, str, Value]] = []
        self.messages: list[str] = []
        self.assumed: dict[str, Assumed] = {}  # data without a value that got one, folded
        self.moves = 0
        self.status = ""
        self.end_fault: Fault | None = None
        self.paused = False
        self.stepping = False
        self.happened = 0  # at this moment: entries of the agenda and of the trace
        self.timed_outputs = 0
        self.timed: tuple[str, float] | None = None  # what the output that is switched now was told
        self.calls = 0
        self.tokens = 0
        self.answered = 0
        self.critical: int | None = None
        self.arrivals: list[Arrival] = []  # tasks that wait for others
        self.waited: list[Waited] = []  # conditions that tasks waited for
        self.held: list[int] = []
        self.timers: dict[int, StopWatch] = {}
        self.cyclic: dict[int, tuple[Values, Read]] = {}  # flag -> frame and expression
        self.evaluating: list[int] = []  # cyclic flags that are being read
        self.bodies: Bodies | None = None  # what is around the robot, in a cell that has bodies
        self.outside = False  # may a machine of another robot still switch something here?
        self.random = random.Random(cell.seed)
        self.reactions = Reactions(linked, cell.reactions)
        self.reacted: Counter[Reaction] = Counter()  # how often there was a cause, of those that do not always come
        for given in cell.inputs:
            self.schedule(given.time_s, INPUTS, "input", 0, given.signal, given.value)

    def _new_globals(self) -> Values:
        """Where global data is kept."""
        return []

    def _new_signals(self) -> dict[Key, Value]:
        """Where the values of signals are kept."""
        return {}

    def __deepcopy__(self, memo: dict[int, Any]) -> Machine:
        shared = (self.linked, self.model, self.further, self.controller, self.cell, self.scene, self.on_event)
        for each in (*shared, self.reactions):
            memo[id(each)] = each
        twin = self.__class__.__new__(self.__class__)
        memo[id(self)] = twin
        for name, value in self.__dict__.items():
            setattr(twin, name, copy.deepcopy(value, memo))
        return twin

    # ---- agenda

    def schedule(self, time: float, phase: int, kind: str, task: int, *data: Any, priority: int = 0) -> None:
        """Put an event on the agenda."""
        self.sequence += 1
        moment = round(time, SAME_MOMENT_PLACES)
        heappush(self.agenda, (moment, phase, priority, task, self.sequence, time, kind, data))

    def token(self) -> int:
        """A number that no other wait has."""
        self.tokens += 1
        return self.tokens

    def has_future(self) -> bool:
        """Is anything to come that the present task does not do itself?"""
        return self.outside or bool(self.agenda)

    def ready(self, task: Task) -> None:
        """Let the task run at this moment."""
        self.schedule(self.now, TASKS, "run", task.index, priority=0 if task.kind == "motion" else 1)

    def schedule_wait(self, task: Task, wait: Wait) -> None:
        """Wake up for a deadline, or to look at a condition that time changes."""
        if wait.deadline is not None:
            self.schedule(wait.deadline, TIMERS, "wake", task.index, wait.token)
        if wait.polls:
            self._poll_later(task, wait)

    def schedule_interrupt(self, task: Task, interrupt: Interrupt, seconds: float) -> None:
        data = (interrupt.key, interrupt.token)
        self.schedule(self.now + max(seconds, 0.001), TIMERS, "interrupt", task.index, *data)

    def advance(self) -> bool:
        """Take the next event off the agenda and let it happen; FALSE when the run is over."""
        if self.status:
            return False
        if self._is_finished():
            self.end("finished")
            return False
        if not self.agenda:
            self._stuck()
            return False
        _, _, _, index, _, time, kind, data = heappop(self.agenda)
        if time > self.now:
            if time > self.limits.time_s:
                self.now = max(self.now, self.limits.time_s)
                self.end_at_limit("max-time", f"the run was ended after {self.limits.time_s:g} s")
                return False
            self.now = time
            self.happened = 0
        self.happened += 1
        self._happen(kind, index, data)
        self.end_beyond_limits(self.tasks[index])
        return not self.status

    def _happen(self, kind: str, index: int, data: tuple[Any, ...]) -> None:
        match kind:
            case "run":
                task = self.tasks[index]
                if task.state == READY and tasks.may_run(self, task):
                    task.run()
            case "wake":
                self._wake(self.tasks[index], data[0])
            case "poll":
                self._poll(self.tasks[index], data[0])
            case "interrupt":
                self._interrupt_time(self.tasks[index], data[0], data[1])
            case "input":
                self.set_input(data[0], data[1])
            case "deed" if self.bodies is not None:
                self.bodies.happen(data[0])
            case "output":
                self.timed_outputs -= 1
                self.timed = data[4]
                self.set_output(self.tasks[index], data[0], data[1], data[2].origin(data[3]))
                self.timed = None
            case "motion":
                self.happened += EVENTS_OF_MOTION if self.model is not None else 0
                robot = tasks.robot_of(self.tasks[index])  # the one that asked may have given it to another task
                if robot is not None:
                    robot.happen(*data)

    def _is_finished(self) -> bool:
        motion = False
        for task in self.tasks:
            if task.kind == "motion":
                if task.state != ENDED:
                    return False
                motion = True
        if not motion and any(task.state != ENDED for task in self.tasks):
            return False
        return self.timed_outputs == 0 and not any(task.busy for task in self.tasks)

    # ---- waking tasks

    def _wake(self, task: Task, token: int) -> None:
        wait = task.wait
        if wait is None or wait.token != token:
            return
        over = wait.kind in ("condition", "meeting") and self._is_over(task, wait)
        if task.wait is wait:
            task.awake(not over and wait.kind in TIMED_OUT)
        self.ready(task)

    def _poll(self, task: Task, token: int) -> None:
        wait = task.wait
        if wait is None or wait.token != token:
            return
        if self._is_over(task, wait):
            task.awake(False)
            self.ready(task)
        elif task.wait is wait:
            self._poll_later(task, wait)

    def _poll_later(self, task: Task, wait: Wait) -> None:
        """Look again; while a robot moves, whose place may be waited for, in each cycle of short ones."""
        step = poll_step(self.now - wait.since, wait.poll_s)
        if wait.poll_s < CYCLE_S and any(other.busy for other in self.tasks):
            step = wait.poll_s
        self.schedule(self.now + step, TIMERS, "poll", task.index, wait.token)

    def _is_over(self, task: Task, wait: Wait) -> bool:
        """Is the wait over? A condition that cannot be evaluated lets its statement fail in its own place."""
        try:
            return task.is_over(wait)
        except ProgramError as error:
            task.fail(error, wait.at)
            self.ready(task)
            return False

    def wait_again(self, task: Task, wait: Wait) -> None:
        """An interrupt has ended: take its task's wait up again."""
        if wait.deadline is not None and self.now >= wait.deadline:
            over = wait.kind in ("condition", "meeting") and self._is_over(task, wait)
            if task.wait is wait:
                task.awake(not over and wait.kind in TIMED_OUT)
        elif self._is_over(task, wait):
            task.awake(False)
        elif task.wait is wait:
            self.schedule_wait(task, wait)

    def look_at(self, task: Task) -> None:
        """Something changed: has the task's wait come to its end, or an interrupt come?"""
        if task.state == ENDED:
            return
        if task.interrupts.known:
            try:
                task.interrupts.look()
            except ProgramError as error:
                self.fault(
                    error.name.replace("_", "-"), f"condition of an interrupt: {error.message}", task, task.where()
                )
                return
        if task.state != WAITING or task.wait is None:
            return
        if task.triggers or (task.interrupts.pending and task.interrupts.urgent(task.running_priority()) is not None):
            task.state = READY
            self.ready(task)
        elif task.wait.kind not in ("time", "tick", "answer") and self._is_over(task, task.wait):
            task.awake(False)
            self.ready(task)

    def changed(self) -> None:
        """A signal or a watched variable has another value: look who waited for that."""
        for task in self.tasks:
            if task.robot is not None:
                searching.look(task.robot)
            self.look_at(task)

    def _interrupt_time(self, task: Task, key: int, token: int) -> None:
        interrupt = task.interrupts.known.get(key)
        if interrupt is None or not interrupt.on or interrupt.token != token:
            return
        if interrupt.event == "timer":
            task.interrupts.came(interrupt)
            if interrupt.on:
                self.schedule_interrupt(task, interrupt, interrupt.period)
        else:
            self.schedule_interrupt(task, interrupt, 0.012)
        self.look_at(task)

    def error_came(self, task: Task) -> None:
        """Interrupts on errors."""
        for interrupt in task.interrupts.known.values():
            if interrupt.on and interrupt.event == "error":
                task.interrupts.came(interrupt)

    # ---- data

    def marks_of(self, code: Code) -> bytearray:
        """What the run has done in the code: place n is 1 when instruction n has been executed, place ~n (from the end)
        when it was a branch whose condition did not hold."""
        found = self.marks.get(code)
        if found is None:
            found = self.marks[code] = bytearray(2 * len(code.instructions))
        return found

    def provide(self, code: Code) -> None:
        """Make sure that the global data which the code uses exists."""
        if code.globals_needed > len(self.globals):
            self.linked.initialise(self.globals, self)

    def global_value(self, name: str) -> Value:
        """The value of a program's global variable; None where there is none of that name."""
        slot = self.linked.variable_slot(name)
        if slot is not None and slot >= len(self.globals):
            self.linked.initialise(self.globals, self)
        return None if slot is None else self.globals[slot]

    # ---- signals

    def read_unset(self, key: Key, kind: str) -> Value:
        """The value of a signal that nothing has set: that of its usual number when it has such a name, else zero."""
        if isinstance(key, str):
            usual = usual_key(key)
            value = self.signals.get(usual) if usual is not None else None
            if value is not None:
                return value
        return zero_of(kind)

    def read(self, port: SignalRef) -> Value:
        """The value of a signal or a group of bits."""
        if is_bit_group(port):
            return sum(1 << place for place, key in enumerate(group_bits(port)) if self.signals.get(key))
        value = self.signals.get(key_of(port))
        return value if value is not None else self.read_unset(key_of(port), port.kind)

    def set_output(self, task: Task, port: SignalRef, value: Value, origin: Origin) -> None:
        """Write a signal; what it changes is shown and wakes who waits for it."""
        if is_bit_group(port):
            self._set_group(task, port, whole(value), origin)
            return
        key = key_of(port)
        if port.kind.startswith(("digital", "flag")):
            value = bool(value)
        if self.read(port) == value:
            self.signals[key] = value
            return
        self.signals[key] = value
        if port.kind.endswith("_out"):
            name = self.physical_name(key, port, task)
            self.outputs.append((self.now, name, value))
            self._show_output(task, port, name, value, origin, (key,))
            self._react(self.reactions.to_groups((key,), self.signals))
        self.changed()

    def _set_group(self, task: Task, port: SignalRef, value: int, origin: Origin) -> None:
        keys = group_bits(port)
        if not 0 <= value < 1 << len(keys):
            raise ProgramError("overflow", f"{value} does not fit into {len(keys)} bits")
        if self.read(port) == value:
            return
        kind = bit_kind(port.kind)
        turned: set[Key] = set()
        for place, key in enumerate(keys):
            bit = bool(value >> place & 1)
            if bool(self.signals.get(key)) != bit:
                self.signals[key] = bit
                turned.add(key)
                if kind.endswith("_out"):
                    name = self.physical_name(key, SignalRef(kind, whole(key[1])), task)
                    self.outputs.append((self.now, name, bit))
                    self._react(self.reactions.to_signal(bit, (key,)))  # each bit is an output by itself
        if kind.endswith("_out"):
            first, last = (self.physical_name(key, SignalRef(kind, whole(key[1])), task) for key in (keys[0], keys[-1]))
            group = port._replace(last=port.last if port.last is not None else port.number)
            self._show_output(task, group, f"{first} TO {last}", value, origin, ())
            self._react(self.reactions.to_groups(turned, self.signals))
        self.changed()

    def _show_output(
        self, task: Task, port: SignalRef, name: str, value: Value, origin: Origin, keys: tuple[Key, ...]
    ) -> None:
        names = (name, *self.linked.alias_names(port))
        data = {"signal": name, "value": value}
        if port.kind == "analog_out":
            data |= self._level(task.frame.code.rules.name, port, names, value)
        self.event("output", data, task, origin, port=port, names=names, timed=self.timed)
        self._react(self.reactions.to_signal(value, keys))

    def _level(self, language: str, port: SignalRef, names: Sequence[str], value: Value) -> dict[str, Value]:
        """What the number of an analogue signal stands for, in V or mA, where that is known."""
        found = self.linked.analog_range(language, self.cell.analog, port, names)
        if found is None or isinstance(value, bool) or not isinstance(value, int | float):
            return {}
        return {"level": round(found.level(value), 9), "unit": found.unit}

    def _react(self, reactions: Iterable[Reaction]) -> None:
        """The world's answers to an output."""
        for each in reactions:
            if each.unanswered:
                self.reacted[each] += 1
            if each.deed and self.bodies is not None:
                self.bodies.happen(each.deed)  # at once: the program may end with it
            elif self.reacted[each] not in each.unanswered:
                self.schedule(self.now + each.after_s, INPUTS, "input", 0, each.signal, each.result)

    def physical_name(self, key: Key, port: SignalRef, task: Task) -> str:
        """The one name of a signal: its own, or its number as its language spells it."""
        name = self.names.get(key)
        if name is None:
            name = port.name or self.linked.signal_name(task.frame.code.rules.name, port.kind, port.number or 0)
            self.names[key] = name
        return name

    def output_later(
        self, task: Task, port: SignalRef, value: Value, timed: tuple[str, float], code: Code, at: int
    ) -> None:
        """Write a signal after a time (s), whatever the program does meanwhile: the end of a `pulse`, or a `delay`."""
        self.timed_outputs += 1
        if self.timed_outputs > MOST_WAITING:
            raise ProgramError("internal_limit", f"more than {MOST_WAITING} outputs wait to be switched later")
        self.schedule(self.now + max(timed[1], 0.0), INPUTS, "output", task.index, port, value, code, at, timed)

    def set_input(self, signal: str, value: Value) -> None:
        """The cell switches a signal: by any of its names."""
        alias = self.linked.alias(signal)
        if alias is not None and is_bit_group(alias):
            for place, key in enumerate(group_bits(alias)):
                self.signals[key] = bool(whole(value) >> place & 1)
        else:
            for key in keys_named(signal, alias):
                self.signals[key] = value
        kind, number = (alias.kind, alias.number) if alias is not None else usual_key(signal) or ("", None)
        data: dict[str, Value] = {"signal": signal, "value": value}
        languages = self.linked.languages() if kind == "analog_in" else ()
        if len(languages) == 1:  # of two languages nobody knows whose number it is
            data |= self._level(languages[0], SignalRef(kind, number), (signal,), value)
        self.event("input", data, None, NOWHERE, port=alias)
        self.changed()

    # ---- what is shown

    def event(
        self,
        kind: str,
        data: dict[str, Value],
        task: Task | None,
        origin: Origin = NOWHERE,
        **more: Any,
    ) -> Event:
        """Add an event to the trace."""
        shown = Event(self.now, task.name if task is not None else "", kind, data, origin, **more)
        self.trace.append(shown)
        self.happened += kind != "call"  # calls are counted by their steps
        if self.on_event is not None:
            self.on_event(shown)
        return shown

    def called(self, task: Task, name: str) -> None:
        """A routine of the program is called; a run that calls without end shows only the first of them."""
        if self.calls < MOST_CALLS_SHOWN:
            self.calls += 1
            self.event("call", {"routine": name}, task, task.frame.code.origin(task.frame.at))

    def message(self, task: Task, kind: str, text: str, origin: Origin, **more: Value) -> None:
        """A message to the operator."""
        if kind != "clear":
            self.messages.append(text)
        self.event("message", {"text": text, "type": kind, **more}, task, origin, named=self._named(task, text))

    def _named(self, task: Task, text: str) -> tuple[tuple[str, Value], ...]:
        """What is held by the registers that a text names, in a language whose messages show constant text only."""
        rules = task.frames[-1].code.rules if task.frames else None
        if rules is None or not (rules.message_numbers or rules.message_texts):
            return ()
        patterns = "|".join(one for one in (rules.message_numbers, rules.message_texts) if one)
        found = dict.fromkeys(re.findall(rf"\b(?:{patterns})\b", text))
        held = {name: self.global_value(name) for name in found}
        return tuple((name, value) for name, value in held.items() if isinstance(value, bool | int | float | str))

    # ---- ends

    def task_ended(self, task: Task) -> None:
        """A task has come to its end; the run ends with the last motion task."""
        self.changed()
        if task.kind == "motion" and self._is_finished():
            self.end("finished")
            return
        waiting = meetings.in_vain(self, task)
        if waiting is not None:
            self.deadlock(waiting, f"task {task.name}, which has ended ({waiting.where().text.strip()[:80]})")

    def end_beyond_limits(self, task: Task) -> None:
        """End a run that has done more than it may; `task` was the last that did something."""
        most = self.limits.statements
        if task.spent >= self.limits.steps or self.happened >= self.limits.steps // STEPS_OF_EVENT:
            done = f"{task.spent:,} steps" if task.spent >= self.limits.steps else f"{self.happened:,} events"
            self.fault("no-time", f"no time passes here: {done} at this moment, and no end", task, task.where())
        elif most is not None and sum(task.statements for task in self.tasks) > most:
            self.end_at_limit("max-statements", f"the run was ended after {most:,} statements")
        elif len(self.trace) > self.limits.events:
            self.end_at_limit("max-events", f"the run was ended after {self.limits.events:,} events")

    def end_at_limit(self, code: str, message: str) -> None:
        """The run has done as much as it may; it is told where it was."""
        if self.status:
            return
        task = next((task for task in self.tasks if task.state != ENDED), self.tasks[0])
        self.end_fault = Fault(code, message, task.name, task.where())
        self.end("limit")

    def halt(self, task: Task) -> None:
        """The program's own stop."""
        self.end("stopped")

    def fault(self, code: str, message: str, task: Task, origin: Origin, unhandled: str = "") -> None:
        """The run ends here: the controller would stop with an error. `unhandled`: the routine that an error left which
        a handler could have taken."""
        if self.status:
            return
        self.end_fault = Fault(code, message, task.name, origin)
        names = (unhandled,) if unhandled else ()
        self.event("fault", {"code": code, "message": message}, task, origin, names=names)
        self.end("fault")

    def deadlock(self, task: Task, what: str) -> None:
        """Nothing can go on any more."""
        if self.status:
            return
        self.end_fault = Fault("deadlock", f"{task.name} waits for {what}", task.name, task.where())
        self.end("deadlock")

    def _stuck(self) -> None:
        waiting = [task for task in self.tasks if task.state != ENDED]
        first = waiting[0] if waiting else self.tasks[0]
        said = "; ".join(words(self, task) for task in waiting)
        self.end_fault = Fault("deadlock", said, first.name, first.where())
        self.end("deadlock")

    def end(self, status: str) -> None:
        """Close the run."""
        if self.status:
            return
        self.status = status
        self.paused = True
        for task in self.tasks:
            if task.robot is not None:
                task.robot.finish()
        for task in self.tasks:
            self.event("end", {"status": status}, task, NOWHERE)

    def pauses_at(self, task: Task) -> bool:
        """For debugging: does the run stop before the task's next instruction? (see Simulation)"""
        return False

    def result(self) -> RunResult:
        """What the run has shown so far."""
        robots = [task.robot for task in self.tasks if task.robot is not None]
        joints = robots[0].joints_now() if robots else None
        return RunResult(
            status=self.status,
            time_s=self.now,
            moves=self.moves,
            statements=sum(task.statements for task in self.tasks),
            messages=tuple(self.messages),
            outputs=tuple(self.outputs),
            fault=self.end_fault,
            trace=tuple(self.trace),
            joints=joints,
            assumed=tuple(self.assumed.values()) if self.linked.assumes else None,
            waited=tuple(self.waited),
            awaited=awaited(self),
            reached=Reached(self.linked, {code: bytes(marks) for code, marks in self.marks.items()}),
        )

    def new_robot(self, task: Task) -> MotionQueue:
        """The motion queue of a motion task: the first one has the first robot, the next ones the further robots."""
        before = sum(other.robot is not None for other in self.tasks)
        return MotionQueue(self, task.index, self.further[before - 1] if before else self.model)

"""One task: its frames, the loop that executes instructions, calls and returns, errors and handlers, interrupts, waits.

A task runs until it blocks. Everything it does to the outside (clock, signals, other tasks) goes through its machine.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from rpl.depth import has_more_depth
from rpl.runtime.awaited import polled
from rpl.runtime.code import ATTEND, BLOCKED, SWITCHED, Code, Frame, Handling, Read, Values, Write
from rpl.runtime.faults import BEYOND, FATAL, UNNUMBERED, ProgramError, name_of, number_of
from rpl.runtime.interrupts import Interrupt, Interrupts
from rpl.runtime.moves.velocities import let_rest
from rpl.runtime.values import Record, SignalRef, Value
from rpl.runtime.waits import CYCLE_S, TIMED_OUT, Wait, Waited, poll_step
from rpl.source import NOWHERE, Origin

if TYPE_CHECKING:
    from rpl.ir.rules import PassingRules, Rules
    from rpl.runtime.moves.orders import Order, TriggerOrder
    from rpl.runtime.ports import Machine, Robot
    from rpl.runtime.signals import Key

READY, WAITING, ENDED = "ready", "waiting", "ended"
# Instructions that a task may execute at one moment before a loop that looks at the outside lets a cycle pass, and how
# many it gets in each such cycle.
SPIN, SPIN_AGAIN = 2000, 500
# The priority of a task's error routine: no interrupt is more urgent.
MOST_URGENT = -1


class Task:
    """A task of the program. `busy`: its robot has moves to drive. `modal` are its system variables."""

    def __init__(self, machine: Machine, name: str, index: int, kind: str, entry: Code, cyclic: bool = False) -> None:
        self.machine = machine
        self.name = name
        self.index = index
        self.kind = kind
        self.cyclic = cyclic
        self.entry = entry
        self.g: Values = machine.globals
        self.signals: dict[Key, Value] = machine.signals
        self.modal: dict[str, Value] = {}
        self.frames: list[Frame] = []
        self.state = READY
        self.wait: Wait | None = None
        self.suspended: Wait | None = None
        self.interrupts = Interrupts()
        self.robot: Robot | None = None
        self.busy = False
        self.held = False
        self.together: frozenset[int] = frozenset()  # the tasks whose robots are driven together with this one's
        self.aside = 0  # frames of interrupts and triggers: there the program pointer never waits for the main motion
        self.looked = False
        self.looked_at_time = False
        self.inputs: dict[SignalRef, float] = {}  # looked at since it last began to wait for a condition, and when last
        self.look_ahead = -1
        self.error_number: float = 0
        self.interrupt_number: float = 0
        self.statements = 0
        self.marks = bytearray()  # of the present frame's code (see Machine.marks_of)
        self.spent = 0
        self.spent_at = -1.0
        self.due = SPIN  # what it may have spent until somebody looks whether it spins
        self.spinning_since: float | None = None
        self.triggers: list[Frame] = []
        self.next_triggers: list[TriggerOrder] = []
        self.next_settings: dict[str, Value] = {}
        self.gathered: dict[int, Order] = {}  # of a spline block, by the places of its moves in the code
        self.error_routine: Code | None = None
        self.last_error: tuple[ProgramError, Origin] | None = None
        self.passes: tuple[Frame, int] | None = None  # an error of the statement that begins there is passed over
        self.frame = self._start()

    # ---- frames

    def _start(self) -> Frame:
        frame = self.new_frame(self.entry)
        self.frames = [frame]
        for prepare in frame.code.prepare:
            prepare(frame.values)
        return frame

    def restart(self) -> None:
        """Begin the entry routine again (end of a cyclic task's pass, end of cycle asked for)."""
        self.interrupts = Interrupts()
        self.aside = 0
        self.frame = self._start()

    def new_frame(self, code: Code, kind: str = "call") -> Frame:
        """A frame with its own values; entering it initialises its local data."""
        self.machine.provide(code)
        values: Values = [None] * code.size
        values[0] = self
        return Frame(code, values, kind)

    def call(self, frame: Frame, at: int, next: int, result: int | None = None) -> int:
        """Enter a frame; the present one goes on at `next`."""
        caller = self.frame
        caller.at, caller.counter = at, next
        frame.result = result
        return self.enter(frame)

    def enter(self, frame: Frame) -> int:
        if len(self.frames) > frame.code.rules.call_depth * 10:
            raise ProgramError("too_deep", f"more than {frame.code.rules.call_depth * 10} calls are nested")
        if frame.kind == "call" and not frame.code.predefined:
            self.machine.called(self, frame.code.name)
        self.frames.append(frame)
        self.frame = frame
        for prepare in frame.code.prepare:
            prepare(frame.values)
        return SWITCHED

    def leave(self, at: int, value: Value = None) -> int:
        """Return from the present frame. The entry routine ends when the robot has arrived."""
        if len(self.frames) == 1 and self.busy:
            if self.robot is not None:
                let_rest(self.robot)
            return self.wait_for("idle", at, at)
        frame = self.frames.pop()
        if self.interrupts.known:
            self.interrupts.drop_level(frame)
        if not self.frames:
            return self._ended()
        self.frame = caller = self.frames[-1]
        if frame.kind == "call":
            if frame.result is not None:
                caller.values[frame.result] = value
            return SWITCHED
        if frame.kind == "error":
            assert frame.handling is not None  # an error routine always handles one
            caller.counter = frame.handling.retry
            return SWITCHED
        self.interrupt_number = 0
        self.aside -= 1
        if frame.kind == "interrupt" and self.robot is not None:
            self.robot.interrupt_ended(goes_on=frame.goes_on)
        wait = frame.wait
        if isinstance(wait, Wait):
            self.wait = wait
            if self.triggers or self.interrupts.urgent(self.running_priority()) is not None:
                return ATTEND
            self.state = WAITING
            self.machine.wait_again(self, wait)
            return BLOCKED if self.wait is not None else ATTEND
        return ATTEND

    def _ended(self) -> int:
        if self.cyclic:
            self.restart()
            return self.sleep_tick(0)
        self.state = ENDED
        self.machine.task_ended(self)
        return BLOCKED

    @property
    def has_ended(self) -> bool:
        return self.state == ENDED

    # ---- the loop

    def run(self) -> None:
        """Execute until the task blocks or ends."""
        if self.spent_at != self.machine.now:
            self.spent, self.spent_at = 0, self.machine.now
            self.due = SPIN if self.spinning_since is None else SPIN_AGAIN
            self.looked = self.looked_at_time = False
        if self.interrupts.pending or self.triggers:
            self.attend()
        while self.state == READY and not self.machine.paused:
            frame = self.frame
            values, instructions, counter = frame.values, frame.code.instructions, frame.counter
            marks = self.marks = self.machine.marks_of(frame.code)
            used = 0
            try:
                for used in range(1, self._budget() + 1):  # noqa: B007 (how far it came)
                    marks[counter] = 1
                    counter = instructions[counter](values)
                    if counter < 0:
                        break
                else:
                    frame.counter = counter
            except ProgramError as error:
                self.fail(error, counter)
            except OPERATION_ERRORS as error:
                self.fail(_as_program_error(error), counter)
            except KeyboardInterrupt:  # whoever asks where the run was finds the task at this statement
                frame.counter = counter if counter >= 0 else frame.counter
                self.statements += used
                raise
            self.spent += used
            self.statements += used
            if counter == ATTEND:
                self.attend()
            if self.spent >= self.due and self.state == READY and not self.machine.paused:
                self._spun()

    def _budget(self) -> int:
        if self.machine.stepping:
            return 0 if self.machine.pauses_at(self) else 1
        return self.due - self.spent

    def _spun(self) -> None:
        """Many instructions and no time: let time pass for who polls, give up on who cannot be ended."""
        machine = self.machine
        if machine.has_future() or self.looked_at_time:
            self.sleep_tick(self.frame.counter)
        elif self.looked and self.spent >= machine.limits.steps // 2:
            machine.deadlock(self, polled(machine, self))
        else:
            machine.end_beyond_limits(self)
        self.due = min(self.spent + SPIN, max(machine.limits.steps, self.spent + 1))

    def sleep_tick(self, next: int) -> int:
        """A cycle of the controller passes before the task goes on."""
        now = self.machine.now
        if self.spinning_since is None or now - self.spinning_since < 0.0:
            self.spinning_since = now
        step = poll_step(now - self.spinning_since, CYCLE_S)
        return self.block(Wait("tick", next, next, self.machine.token(), now, now + step))

    # ---- waits

    def block(self, wait: Wait) -> int:
        """Wait; gives the answer for the instruction."""
        if wait.kind != "tick":
            self.spinning_since = None
        self.frame.at, self.frame.counter = wait.at, wait.next
        self.wait = wait
        self.state = WAITING
        self.machine.schedule_wait(self, wait)
        return BLOCKED

    def wait_until(
        self,
        condition: Read,
        values: Values,
        at: int,
        next: int,
        polls: bool,
        timeout: float | None = None,
        timed_out: Write | None = None,
        error: str | None = None,
        subject: str = "",
    ) -> int:
        """Block until the condition holds."""
        now = self.machine.now
        deadline = None if timeout is None else now + max(timeout, 0.0)
        wait = Wait("condition", at, next, self.machine.token(), now, deadline, condition, values, polls)
        wait.timed_out, wait.error, wait.subject = timed_out, error, subject
        wait.poll_s = self.frame.code.rules.wait_poll_s or CYCLE_S
        self.machine.event("wait", {"condition": subject}, self, self.frame.code.origin(at))
        return self.block(wait)

    def sleep(self, seconds: float, at: int, next: int) -> int:
        """Block for a time."""
        if seconds <= 0.0:
            return next
        self.machine.event("wait", {"seconds": round(seconds, 9)}, self, self.frame.code.origin(at))
        now = self.machine.now
        return self.block(Wait("time", at, next, self.machine.token(), now, now + seconds))

    def wait_for(self, kind: str, at: int, next: int, move: int = 0) -> int:
        """Block for the robot: idle, room, released, standing."""
        wait = Wait(kind, at, next, self.machine.token(), self.machine.now, move=move)
        if self.is_over(wait):
            return next
        return self.block(wait)

    def is_over(self, wait: Wait) -> bool:
        """Has what is waited for come? A deadline that passed is the caller's business."""
        match wait.kind:
            case "condition":
                assert wait.condition is not None and wait.values is not None  # set by wait_until
                return bool(wait.condition(wait.values))
            case "idle":
                return not self.busy or (self.robot is not None and self.robot.is_stopped())
            case "room":
                return self.robot is None or self.robot.has_room()
            case "released":
                return self.robot is None or self.robot.has_released(wait.move)
            case "standing":
                return self.robot is None or self.robot.is_standing()
            case "meeting":
                return all(one.token != wait.token for one in self.machine.arrivals)
            case "task":
                return self.machine.tasks[wait.move].has_ended
        return False

    def awake(self, timed_out: bool) -> None:
        """The wait is over: go on behind it, or at its time-out."""
        wait, self.wait = self.wait, None
        self.state = READY
        if wait is None:
            return
        if wait.kind in ("condition", "meeting"):
            self.machine.waited.append(Waited(self.name, wait.since, self.machine.now, timed_out))
        if wait.kind not in TIMED_OUT:
            return
        if wait.timed_out is not None and wait.values is not None:
            wait.timed_out(wait.values, timed_out)
        elif timed_out and wait.error is not None:
            name = "dialog_timeout" if wait.kind == "answer" else "timeout"
            error = ProgramError(name, "the wait has timed out")
            error.number = self.frame.code.rules.errors.get(wait.error)
            self.fail(error, wait.at)

    # ---- interrupts

    def running_priority(self) -> int | None:
        """The most urgent interrupt that runs now."""
        found = [frame.priority for frame in self.frames if frame.priority is not None]
        return min(found) if found else None

    def attention(self, next: int) -> int:
        """An instruction changed something that interrupts watch: set the counter and look."""
        self.frame.counter = next
        return ATTEND

    def attend(self) -> None:
        """Start what is due: the actions of triggers that were passed, then the most urgent interrupt."""
        if self.state == ENDED:
            return
        if self.triggers:
            self._interrupt_with(self.triggers.pop(0))
            return
        interrupt = self.interrupts.urgent(self.running_priority())
        if interrupt is None:
            return
        self.interrupts.forget(interrupt.key)
        values = interrupt.values
        if values is None:
            frame = self.new_frame(interrupt.action, "interrupt")
        else:
            frame = Frame(interrupt.action, values, "interrupt")
            frame.goes_on = True  # it was declared; what a trap routine braked waits for its start
        frame.priority, frame.level, frame.number = interrupt.priority, interrupt.level, interrupt.key
        if interrupt.stops and self.robot is not None:
            self.robot.halt(True, ends_move=True)
        self.interrupt_number = interrupt.key
        if self.robot is not None:
            self.robot.mark_interrupted()
        self._interrupt_with(frame)

    def _interrupt_with(self, frame: Frame) -> None:
        frame.wait, self.wait = self.wait, None
        self.state = READY
        self.aside += 1
        self.enter(frame)

    def trigger(self, routine: Code, values: Values) -> None:
        """A place on the path was passed whose action is a routine: it runs as soon as the task can."""
        self.triggers.append(Frame(routine, values, "trigger"))

    def take_triggers(self) -> list[TriggerOrder]:
        """The triggers set for the next move."""
        taken, self.next_triggers = self.next_triggers, []
        return taken

    def take_settings(self) -> dict[str, Value]:
        """The system variables that are set for the next move only."""
        if not self.next_settings:
            return {}
        taken, self.next_settings = self.next_settings, {}
        return taken

    def watch_time(self, interrupt: Interrupt) -> None:
        """Schedule what time alone brings: timer interrupts and conditions that read the clock."""
        if interrupt.event == "timer":
            self.machine.schedule_interrupt(self, interrupt, interrupt.period)
        elif interrupt.polls:
            self.machine.schedule_interrupt(self, interrupt, CYCLE_S)

    def resume_level(self, at: int) -> int:
        """Leave the interrupt and every routine down to the one that declared it; its motion is dropped. One that was
        not braked is driven to its end first: it stops the advance run (expert programming, table of stops)."""
        level = next((frame.level for frame in reversed(self.frames) if frame.kind == "interrupt"), None)
        if level is None or level not in self.frames:
            raise ProgramError("bad_call", "RESUME outside an interrupt routine")
        if self.robot is not None and not self.is_over(Wait("idle", at, at, 0, 0.0)):
            return self.wait_for("idle", at, at)
        while self.frames[-1] is not level:
            frame = self.frames.pop()
            self.aside -= frame.kind != "call"
            self.interrupts.drop_level(frame)
        self.frame = level
        self.wait = None
        if self.robot is not None:
            self.robot.clear()
        return ATTEND

    # ---- errors

    def fail(self, error: ProgramError, counter: int) -> None:
        """An instruction failed: go to the nearest handler, or end the run with a fault."""
        frame = self.frame
        frame.at = counter
        self.state = READY
        self.wait = None
        self.machine.error_came(self)
        passed, self.passes = self.passes, None
        start, following = frame.code.statements[counter]
        if passed == (frame, start) and error.name not in BEYOND:
            rules = frame.code.rules.passing
            if rules is not None:
                self.tell_error(rules, number_of(error, frame.code.rules.errors) or UNNUMBERED)
            frame.counter = following
            return
        self._unwind(error, frame.code.origin(counter), frame.code.rules)

    def tell_error(self, rules: PassingRules, number: float) -> None:
        """The variable of the last error shows this number."""
        slot = self.machine.linked.variable_slot(rules.variable)
        if slot is None:
            return
        if slot >= len(self.machine.globals):
            self.machine.linked.initialise(self.machine.globals, self.machine)
        record = self.machine.globals[slot]
        if isinstance(record, Record):
            record.parts[rules.component] = number

    def _unwind(self, error: ProgramError, origin: Origin, rules: Rules) -> None:
        number = number_of(error, rules.errors)
        if self._trapped(error, number, origin, rules):
            return
        while True:
            frame = self.frame
            try:
                start = None if error.name in FATAL else self._handler(frame, 0 if number is None else number)
            except ProgramError as unknown:  # a handler that names what has no value
                self._unhandled(unknown, None, origin, rules)
                return
            if start is not None:
                retry, following = frame.code.statements[frame.at]
                name = name_of(number, rules.errors) if number is not None else error.name
                frame.handling = Handling(number or 0, name, error.message, retry, following)
                self.error_number = number or 0
                self.last_error = (error, origin)
                frame.counter = start
                return
            if frame.code.undo is not None and frame.leaving is None and error.name not in FATAL:
                frame.leaving = (error, origin)
                frame.counter = frame.code.undo
                return
            if frame.kind != "call" or len(self.frames) == 1:
                self._unhandled(error, number, origin, rules)
                return
            self.frames.pop()
            self.interrupts.drop_level(frame)
            self.frame = self.frames[-1]

    def _trapped(self, error: ProgramError, number: float | None, origin: Origin, rules: Rules) -> bool:
        """Call the task's error routine, which nothing interrupts; not for errors inside it."""
        code, failed = self.error_routine, self.frame
        if code is None or error.name in FATAL or any(frame.kind == "error" for frame in self.frames):
            return False
        retry, following = failed.code.statements[failed.at]
        name = name_of(number, rules.errors) if number is not None else error.name
        failed.counter = retry
        trap = self.new_frame(code, "error")
        trap.handling = Handling(number or 0, name, error.message, retry, following)
        trap.priority = MOST_URGENT
        self.error_number = number or 0
        self.last_error = (error, origin)
        self.enter(trap)
        return True

    def _handler(self, frame: Frame, number: float) -> int | None:
        if frame.handling is not None or frame.leaving is not None:
            return None
        for handler in frame.code.handlers:
            if not handler.codes or any(code(frame.values) == number for code in handler.codes):
                return handler.start
        return None

    def _unhandled(self, error: ProgramError, number: float | None, origin: Origin, rules: Rules) -> None:
        named = name_of(number, rules.errors) if number is not None else ""
        message = f"{error.message} ({named})" if named and named not in error.message else error.message
        left = self.frame.code.name if number is not None and error.name not in FATAL else ""
        self.machine.fault(error.name.replace("_", "-"), message, self, origin, left)

    def undone(self) -> int:
        """The undo part has run: the error goes on to the caller."""
        leaving = self.frame.leaving
        if leaving is None:
            return self.leave(self.frame.counter)
        assert isinstance(leaving, tuple)
        error, origin = leaving
        if self.frame.kind != "call" or len(self.frames) == 1:
            self._unhandled(error, number_of(error, self.frame.code.rules.errors), origin, self.frame.code.rules)
            return BLOCKED
        rules = self.frame.code.rules
        self.frames.pop()
        self.frame = self.frames[-1]
        self._unwind(error, origin, rules)
        return SWITCHED

    def handling(self) -> Handling:
        """The error that the present frame handles."""
        if self.frame.handling is None:
            raise ProgramError("bad_call", "this statement belongs into an error handler")
        return self.frame.handling

    def handled(self, counter: int) -> int:
        """Leave the handler for an instruction of the routine; the task's error routine for one of its caller."""
        if self.frame.kind == "error":
            self.frames.pop()
            self.frame = self.frames[-1]
            self.frame.counter = counter
            return SWITCHED
        self.frame.handling = None
        return counter

    def pass_on(self) -> int:
        """Raise the error being handled in the caller."""
        handling = self.handling()
        error, origin = self.last_error or (ProgramError("bad_raise", handling.message), NOWHERE)
        passed = ProgramError(error.name, handling.message, handling.number)
        self._unwind(passed, origin, self.frame.code.rules)
        return SWITCHED

    def where(self) -> Origin:
        """The place of the statement that the task is at."""
        frame = self.frame
        counter = self.wait.at if self.wait is not None else frame.counter
        return frame.code.origin(counter)


# Python's own complaints about an operation of the program.
OPERATION_ERRORS = (
    ArithmeticError,
    TypeError,
    AttributeError,
    KeyError,
    IndexError,
    ValueError,
    MemoryError,
    RecursionError,
)


def _as_program_error(error: Exception) -> ProgramError:
    """Python's own complaint about an operation, as the error of the program that asked for it."""
    match error:
        case ZeroDivisionError():
            return ProgramError("division_by_zero", "division by zero")
        case OverflowError():
            return ProgramError("overflow", "the number is too large")
        case ValueError() if "index(" in str(error):
            return ProgramError("wrong_kind", "a value has no component of the name asked for")
        case ValueError():
            told = "" if str(error).startswith("math ") else f": {error}"
            return ProgramError("negative_argument", f"a function is not defined for this argument{told}")
        case AttributeError() if "'NoneType' object has no attribute" in str(error):
            return ProgramError("no_value", "a structure without a value is asked for a part of it")
        case KeyError():
            return ProgramError("wrong_kind", f"there is no component {error}")
        case MemoryError():
            return ProgramError("internal_limit", "the program's data do not fit into memory")
        case RecursionError():
            if has_more_depth():
                raise error
            return ProgramError("too_deep", "expressions that use each other are nested too deep")
    return ProgramError("wrong_kind", f"an operation does not fit its values: {error}")

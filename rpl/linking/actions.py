"""Instructions of the statements that wait, talk, interrupt, stop, raise and handle."""

from __future__ import annotations

from typing import TYPE_CHECKING

from rpl import ir
from rpl.linking import interrupts
from rpl.linking.conditions import depends_on_time
from rpl.linking.meetings import meet
from rpl.linking.places import writer
from rpl.runtime import answers, tasks
from rpl.runtime.code import SWITCHED, Branch, Instruction, Read, Values, Write
from rpl.runtime.faults import ProgramError
from rpl.runtime.functions import system
from rpl.runtime.functions.texts import value_text
from rpl.runtime.moves import resting
from rpl.runtime.values import StopWatch, Value

if TYPE_CHECKING:
    from rpl.linking.assembler import Make
    from rpl.linking.linker import Fill, Linker


def action(statement: ir.Statement, linker: Linker) -> Make | None:
    """The instruction of a statement without inner structure; None when it is of another kind."""
    match statement:
        case ir.Wait():
            return _wait(statement, linker)
        case ir.WaitUntil():
            return _wait_until(statement, linker)
        case ir.WaitForMotion():
            return wait_for_robot
        case ir.LookAhead():
            return _look_ahead
        case ir.Pulse() | ir.SetAfter():
            return _timed_output(statement, linker)
        case ir.Message():
            return _message(statement, linker)
        case ir.Dialog():
            return _dialog(statement, linker)
        case ir.Clock():
            return _clock(statement, linker)
        case ir.Vendor(text=text, effect=effect):
            return _passing(text, linker) or _vendor(text, effect)
        case ir.Opaque(text=text):
            return _failing("opaque", f"this statement could not be read: {text.strip()[:80]}")
        case ir.TaskControl():
            return _task_control(statement, linker)
        case ir.Meet():
            return meet(statement, linker)
        case ir.Critical(enter=enter):
            return _critical(enter)
        case ir.SetForNextMove():
            return _for_next_move(statement, linker)
        case ir.OnError(routine=name):
            return _on_error(name, linker)
    return interrupts.action(statement, linker) or _control(statement, linker)


def _control(statement: ir.Statement, linker: Linker) -> Make | None:
    match statement:
        case ir.Halt(kind=kind):
            return _halt(kind)
        case ir.StopMotion(hard=hard):
            return _stop_motion(hard)
        case ir.StartMotion():
            return _robot("start")
        case ir.ClearMotion():
            return _robot("clear")
        case ir.StoreMotion(restore=restore):
            return _robot("restore" if restore else "store")
        case ir.ResumeLevel():
            return lambda here, next: lambda f: f[0].resume_level(here)
        case ir.Raise(code=code):
            return _raise(linker.compiler.value(code) if code is not None else None)
        case ir.Retry():
            return lambda here, next: lambda f: f[0].handled(f[0].handling().retry)
        case ir.TryNext():
            return lambda here, next: lambda f: f[0].handled(f[0].handling().next)
    return None


def _failing(error: str, message: str) -> Make:
    def make(here: int, next: int) -> Instruction:
        def fail(f: Values) -> int:
            raise ProgramError(error, message)

        return fail

    return make


# ---- waiting


def wait_for_robot(here: int, next: int) -> Instruction:
    """Wait until everything commanded is driven."""

    def wait(f: Values) -> int:
        task = f[0]
        done: int = next if not task.busy else task.wait_for("idle", here, next)
        return done

    return wait


def _standing(in_position: bool, f: Values, here: int) -> int | None:
    """With `in_position` the wait begins when the robot stands: come back then."""
    task = f[0]
    if in_position and task.busy:
        answer: int = task.wait_for("idle", here, here)
        return answer
    return None


def _wait(statement: ir.Wait, linker: Linker) -> Make:
    seconds, in_position = linker.compiler.value(statement.time), statement.in_position
    queues = in_position and linker.compiler.scope.rules.advance.waits_queue

    def make(here: int, next: int) -> Instruction:
        def wait(f: Values) -> int:
            first = _standing(in_position, f, here)
            if first is not None:
                return first
            if queues and f[0].robot is not None:
                resting.rest(f[0].robot, seconds(f))
                return next
            done: int = f[0].sleep(seconds(f), here, next)
            return done

        return wait

    return make


def timed_out(statement: ir.WaitUntil, linker: Linker) -> Write | None:
    """What writes whether the wait has timed out."""
    if statement.timed_out is None:
        return None
    return writer(linker.compiler, statement.timed_out, statement.origin)


def _wait_until(statement: ir.WaitUntil, linker: Linker) -> Make:
    condition, polls = linker.compiler.value(statement.condition), depends_on_time(statement.condition, linker.linked)
    timeout = linker.compiler.value(statement.timeout) if statement.timeout is not None else None
    late, error, in_position = timed_out(statement, linker), statement.error, statement.in_position
    subject, code = statement.origin.text.strip()[:80], linker.code

    def make(here: int, next: int) -> Instruction:
        code.branches.append(Branch(here, next, here))

        def wait(f: Values) -> int:
            first = _standing(in_position, f, here)
            if first is not None:
                return first
            f[0].inputs.clear()
            if condition(f):
                if late is not None:
                    late(f, False)
                return next
            limit = timeout(f) if timeout is not None else None
            f[0].marks[~here] = 1
            blocked: int = f[0].wait_until(condition, f, here, next, polls, limit, late, error, subject)
            return blocked

        return wait

    return make


def _look_ahead(here: int, next: int) -> Instruction:
    def look_ahead(f: Values) -> int:
        f[0].look_ahead = next
        return next

    return look_ahead


# ---- outputs over time


def _timed_output(statement: ir.Pulse | ir.SetAfter, linker: Linker) -> Make:
    compiler = linker.compiler
    signal = statement.signal
    if isinstance(signal, ir.Convert):
        signal = signal.operand
    if isinstance(signal, ir.Name):
        found = compiler.place_of(signal.id)
        if isinstance(found, ir.SignalDeclaration):
            signal = found.signal
        else:
            signal = ir.Signal("digital_out", name=signal.id)
    if not isinstance(signal, ir.Signal):
        return _failing("wrong_kind", "only a signal can be switched for a time")
    port, write = compiler.port(signal), writer(compiler, signal, statement.origin)
    value = compiler.value(statement.value)
    seconds = compiler.value(statement.duration if isinstance(statement, ir.Pulse) else statement.delay)
    pulse = isinstance(statement, ir.Pulse)
    step = compiler.scope.rules.pulse_step_s if pulse else 0.0

    def make(here: int, next: int) -> Instruction:
        def switch(f: Values) -> int:
            task, level = f[0], value(f)
            physical = port(f) if callable(port) else port
            if pulse:
                write(f, level)
            later = (not level) if pulse else level
            timed = ("pulse" if pulse else "delay", _in_steps(seconds(f), step))
            task.machine.output_later(task, physical, later, timed, task.frame.code, here)
            return next if not task.interrupts.pending else task.attention(next)

        return switch

    return make


def _in_steps(seconds: float, step: float) -> float:
    """The length of a pulse to the nearest step of the controller; what is shorter than half of one stays."""
    if step <= 0.0 or seconds < 0.5 * step:
        return seconds
    return float(int(seconds / step + 0.5) * step)


# ---- operator


def _shown(value: Value) -> str:
    return value if isinstance(value, str) else value_text(value)


def _message(statement: ir.Message, linker: Linker) -> Make:
    text, kind = linker.compiler.value(statement.text), statement.kind
    sender = linker.compiler.value(statement.sender) if statement.sender is not None else None

    def make(here: int, next: int) -> Instruction:
        def show(f: Values) -> int:
            task = f[0]
            more = {"sender": _shown(sender(f))} if sender is not None else {}
            task.machine.message(task, kind, _shown(text(f)), task.frame.code.origin(here), **more)
            return next

        return show

    return make


def _dialog(statement: ir.Dialog, linker: Linker) -> Make:
    compiler, origin = linker.compiler, statement.origin
    text, answer = compiler.value(statement.text), writer(compiler, statement.answer, origin)
    keys = [compiler.value(key) if key is not None else None for key in statement.keys]
    timeout = compiler.value(statement.timeout) if statement.timeout is not None else None
    late = writer(compiler, statement.timed_out, origin) if statement.timed_out is not None else None
    kind = statement.kind

    def make(here: int, next: int) -> Instruction:
        def ask(f: Values) -> int:
            task = f[0]
            names = [_shown(key(f)) if key is not None else None for key in keys]
            limit = timeout(f) if timeout is not None else None
            shown = _shown(text(f))
            return answers.ask(task.machine, task, f, shown, names, kind, answer, limit, late, here, next)

        return ask

    return make


def _clock(statement: ir.Clock, linker: Linker) -> Make:
    read, op = linker.compiler.raw(statement.clock), statement.op

    def make(here: int, next: int) -> Instruction:
        def turn(f: Values) -> int:
            clock, now = read(f), f[0].machine.now
            if not isinstance(clock, StopWatch):
                raise ProgramError("wrong_kind", "a clock is needed")
            if op == "reset":
                clock.counted, clock.running = 0.0, False
            elif op == "start" and not clock.running:
                clock.since, clock.running = now, True
            elif op == "stop" and clock.running:
                clock.counted, clock.running = clock.seconds(now), False
            return next

        return turn

    return make


# ---- what only one controller has


def _passing(text: str, linker: Linker) -> Make | None:
    """A statement that says whether an error of the next one is passed over; None for any other."""
    rules = linker.compiler.scope.rules.passing
    if rules is None or not text.strip().lower().startswith((rules.statement, rules.clearing)):
        return None
    passes = text.strip().lower().startswith(rules.statement)

    def make(here: int, next: int) -> Instruction:
        def say(f: Values) -> int:
            task = f[0]
            if passes:
                task.passes = (task.frame, next)
            else:
                task.tell_error(rules, 0)
            return next

        return say

    return make


def _vendor(text: str, effect: str) -> Make:
    def make(here: int, next: int) -> Instruction:
        def run(f: Values) -> int:
            task = f[0]
            seconds = answers.vendor(task.machine, task, text, effect, task.frame.code.origin(here))
            done: int = task.sleep(seconds, here, next)
            return done

        return run

    return make


# ---- stops and tasks


def _halt(kind: str) -> Make:
    def make(here: int, next: int) -> Instruction:
        def halt(f: Values) -> int:
            task = f[0]
            if kind == "cycle":
                task.restart()
                return SWITCHED
            task.machine.halt(task)
            return SWITCHED

        return halt

    return make


def _stop_motion(hard: bool) -> Make:
    def make(here: int, next: int) -> Instruction:
        def stop(f: Values) -> int:
            task = f[0]
            if task.together:
                raise ProgramError("synchronisation", "a stop of robots that go together is not driven")
            if task.robot is None and not tasks.take_robot(task, moving=True):
                return next
            task.robot.halt(hard)
            done: int = task.wait_for("standing", here, next)
            return done

        return stop

    return make


def _robot(what: str) -> Make:
    def make(here: int, next: int) -> Instruction:
        def command(f: Values) -> int:
            task = f[0]
            if task.robot is not None:
                getattr(task.robot, what)()
            return next

        return command

    return make


def _raise(code: Read | None) -> Make:
    def make(here: int, next: int) -> Instruction:
        def raise_(f: Values) -> int:
            task = f[0]
            if code is None:
                passed: int = task.pass_on()
                return passed
            number = code(f)
            raise ProgramError("raised", f"the program raises error {_shown(number)}", number)

        return raise_

    return make


def _task_control(statement: ir.TaskControl, linker: Linker) -> Make:
    op, name, linked = statement.op, statement.task, linker.linked
    routine = linked.routine(linker.compiler.scope, name)
    fills = linker.calls.plan(routine, statement.arguments, statement.origin).fills if routine is not None else ()

    def make(here: int, next: int) -> Instruction:
        def control(f: Values) -> int:
            task = f[0]
            if op == "join":
                return tasks.join(task, name, here, next)
            if op == "start":
                code = linked.code_of(routine) if routine is not None else None
                tasks.start(task.machine, task, name, code, lambda g: _filled(f, g, fills))
            else:
                tasks.control(task.machine, task, op, name)
            return next

        return control

    return make


def _filled(f: Values, g: Values, fills: tuple[Fill, ...]) -> None:
    for fill in fills:
        fill(f, g)


def _critical(enter: bool) -> Make:
    def make(here: int, next: int) -> Instruction:
        def section(f: Values) -> int:
            tasks.critical(f[0], enter)
            return next

        return section

    return make


def _on_error(name: str | None, linker: Linker) -> Make:
    linked = linker.linked
    routine = linked.routine(linker.compiler.scope, name) if name is not None else None

    def make(here: int, next: int) -> Instruction:
        def trap(f: Values) -> int:
            if name is not None and routine is None:
                raise ProgramError("unknown_routine", f"the routine {name} is not in what was read")
            f[0].error_routine = linked.code_of(routine) if routine is not None else None
            return next

        return trap

    return make


def _for_next_move(statement: ir.SetForNextMove, linker: Linker) -> Make:
    setting, value = statement.setting, statement.value
    if isinstance(setting, ir.Magnitude):
        value = ir.Quantity(value, setting.unit)
        setting = setting.value
    if not isinstance(setting, ir.System):
        return _failing("wrong_kind", "only a modal setting can be set for the next move")
    read, name = linker.compiler.value(value), setting.name
    index = linker.compiler.value(setting.indices[0]) if setting.indices else None

    def make(here: int, next: int) -> Instruction:
        def set_once(f: Values) -> int:
            key = system.modal_key(name, index(f) if index is not None else None)
            f[0].next_settings[key] = read(f)
            return next

        return set_once

    return make

"""Statements to instructions. Structure becomes jumps; a statement that the advance run stops for waits for the robot
in its own instruction.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING

from rpl import ir
from rpl.errors import InternalError
from rpl.linking import actions
from rpl.linking.assembler import Label
from rpl.linking.calls import leaving
from rpl.linking.expressions import Place, Precision
from rpl.linking.flatten import has_call
from rpl.linking.motion import MotionStatements
from rpl.linking.places import assignment, procedure, watches
from rpl.linking.stops import stops_before
from rpl.runtime.code import Branch, Code, Instruction, Read, Values
from rpl.runtime.faults import ProgramError
from rpl.runtime.values import Value, equal

if TYPE_CHECKING:
    from rpl.linking.assembler import Assembler, Make
    from rpl.linking.linker import Linker


class Statements:
    """Compiles the statements of one routine."""

    def __init__(self, linker: Linker) -> None:
        self.linker = linker
        self.labels: dict[str, Label] = {}
        self.exits: list[tuple[Label, Label]] = []
        self.motion = MotionStatements(linker)

    @property
    def assembler(self) -> Assembler:
        return self.linker.assembler

    def value(self, expression: ir.Expression) -> Read:
        """An expression, its calls moved in front."""
        return self.linker.compiler.value(self.linker.flattener.expression(expression))

    def emit(self, make: Make) -> None:
        self.assembler.emit(make)

    def body(self, body: ir.Body) -> None:
        for statement in body:
            self.statement(statement)

    def statement(self, statement: ir.Statement) -> None:
        """Emit one statement."""
        if isinstance(statement, ir.Nothing):
            return
        if isinstance(statement, ir.Label):
            self.assembler.place(self.label(statement.name))
            return
        outer = self.assembler.begin(statement.origin)
        if not isinstance(statement, ir.While | ir.Repeat):
            self._stop_advance(statement)
        self._dispatch(statement)
        self.assembler.end(outer)

    def _stop_advance(self, statement: ir.Statement) -> None:
        """The advance run stops here if it must, unless the statement before has said that it must not."""
        if not stops_before(statement, self.linker):
            return

        def make(here: int, next: int) -> Instruction:
            def wait(f: Values) -> int:
                task = f[0]
                if not task.busy or task.aside:
                    return next
                if task.look_ahead == here:
                    task.look_ahead = -1
                    return next
                waiting: int = task.wait_for("idle", here, next)
                return waiting

            return wait

        self.emit(make)

    def label(self, name: str) -> Label:
        return self.labels.setdefault(self.linker.compiler.scope.fold(name), Label())

    def _dispatch(self, statement: ir.Statement) -> None:
        match statement:
            case ir.If():
                self._if(statement)
            case ir.Switch():
                self._switch(statement)
            case ir.For():
                self._for(statement)
            case ir.While():
                self._while(statement)
            case ir.Repeat():
                self._repeat(statement)
            case ir.Loop():
                self._loop(statement)
            case ir.ExitLoop() | ir.NextPass():
                self._leave_loop(isinstance(statement, ir.ExitLoop))
            case ir.Goto(label=name):
                self.emit(_goto(self.label(name), name))
            case ir.WaitUntil() if has_call(statement.condition):
                self._poll_until(statement)
            case _:
                self._simple(statement)

    # ---- simple statements

    def _simple(self, statement: ir.Statement) -> None:
        if isinstance(statement, ir.CallRoutine):
            if statement.dynamic is None:
                self.linker.calls.emit(statement.name, statement.arguments, statement.origin, None)
            else:
                flat = self.linker.flattener.statement(statement)
                assert isinstance(flat, ir.CallRoutine)
                self.emit(self.linker.calls.dynamic(flat))
            return
        flat_statement = self.linker.flattener.statement(statement)
        match flat_statement:
            case ir.Assign():
                self.emit(assignment(self.linker.compiler, flat_statement))
            case ir.Return(value=value):
                self.emit(leaving(self.linker.compiler.copy_of(value) if value is not None else None))
            case ir.Do(procedure=name, arguments=arguments):
                self.emit(
                    _run(procedure(self.linker.compiler, name, arguments), _may_wake(flat_statement, self.linker))
                )
            case ir.Move() | ir.MoveExternal() | ir.Spline() | ir.Trigger() | ir.DefineTrigger() | ir.PathRule():
                self.motion.statement(flat_statement)
            case _:
                make = actions.action(flat_statement, self.linker)
                if make is None:
                    raise InternalError(f"no code for {flat_statement.__class__.__name__}")
                self.emit(make)

    # ---- branches

    def _if(self, statement: ir.If) -> None:
        done = Label()
        for condition, body in statement.branches:
            otherwise = Label()
            self.emit(_branch(self.value(condition), otherwise, self.linker.code))
            self.body(body)
            self.assembler.jump(done)
            self.assembler.place(otherwise)
        self.body(statement.otherwise)
        self.assembler.place(done)

    def _switch(self, statement: ir.Switch) -> None:
        selector = self.linker.compiler.new_place()
        self.emit(_keep(selector, self.value(statement.selector)))
        done = Label()
        for case in statement.cases:
            otherwise = Label()
            if any(has_call(value) for value in case.values):
                self._case_with_calls(selector, case, otherwise)
            else:
                values = [self.linker.compiler.value(value) for value in case.values]
                self.emit(_case(selector, values, otherwise, self.linker.code))
            self.body(case.body)
            self.assembler.jump(done)
            self.assembler.place(otherwise)
        if statement.default is not None:
            self.body(statement.default)
        self.assembler.place(done)

    def _case_with_calls(self, selector: int, case: ir.Case, otherwise: Label) -> None:
        """Values that call functions are evaluated one by one, until one fits."""
        found = Label()
        for value in case.values:
            differs = Label()
            self.emit(_case(selector, [self.value(value)], differs, self.linker.code))
            self.assembler.jump(found)
            self.assembler.place(differs)
        self.assembler.jump(otherwise)
        self.assembler.place(found)

    # ---- loops

    def _in_loop(self, body: ir.Body, leave: Label, again: Label) -> None:
        self.exits.append((leave, again))
        self.body(body)
        self.exits.pop()

    def _while(self, statement: ir.While) -> None:
        again, leave = Label(), Label()
        self.assembler.place(again)
        self._stop_advance(statement)
        self.emit(_branch(self.value(statement.condition), leave, self.linker.code))
        self._in_loop(statement.body, leave, again)
        self.assembler.jump(again)
        self.assembler.place(leave)

    def _repeat(self, statement: ir.Repeat) -> None:
        begin, again, leave = Label(), Label(), Label()
        self.assembler.place(begin)
        self._in_loop(statement.body, leave, again)
        self.assembler.place(again)
        self._stop_advance(statement)
        self.emit(_branch(self.value(statement.until), begin, self.linker.code))
        self.assembler.place(leave)

    def _loop(self, statement: ir.Loop) -> None:
        again, leave = Label(), Label()
        self.assembler.place(again)
        before = self.assembler.here()
        self._in_loop(statement.body, leave, again)
        if not any(item.make is not None for item in self.assembler.items[before:]):
            self.emit(_nothing)
        self.assembler.jump(again)
        self.assembler.place(leave)

    def _leave_loop(self, leaves: bool) -> None:
        if not self.exits:
            self.emit(_failing("bad_call", "there is no loop around this statement"))
            return
        leave, again = self.exits[-1]
        self.emit(_goto(leave if leaves else again))

    def _for(self, loop: ir.For) -> None:
        """Bounds and step are evaluated once. Behind the loop the counter is the first value past the end."""
        compiler = self.linker.compiler
        stop, step = compiler.new_place(), compiler.new_place()
        key = compiler.scope.fold(loop.counter)
        before = compiler.places.get(key)
        start = self._kept_if_needed(loop.start, (loop.stop, loop.step))
        last = self._kept_if_needed(loop.stop, (loop.step,))
        by = compiler.operand(self.linker.flattener.expression(loop.step)) if loop.step is not None else None
        if loop.scoped:
            compiler.places[key] = Place(compiler.new_place())
        counter = compiler.place_of(loop.counter)
        again, leave, begin = Label(), Label(), Label()
        if not isinstance(counter, Place):
            self.emit(_failing("unknown_data", f"{loop.counter} is not declared in what was read"))
            return
        read, write = _counter(counter)
        self.emit(_begin_loop(write, start, last, by, (stop, step), loop.automatic, loop.at_least_once, leave))
        self.assembler.place(begin)
        self._in_loop(loop.body, leave, again)
        self.assembler.place(again)
        simple = counter.number if not (counter.is_global or counter.is_reference) else None
        if loop.keeps_last:
            self.emit(_next_if_inside(read, write, stop, step, begin, compiler.single))
        else:
            self.emit(_next_pass(read, write, stop, step, begin, simple, compiler.single))
        self.assembler.place(leave)
        if loop.scoped:
            if before is None:
                del compiler.places[key]
            else:
                compiler.places[key] = before

    def _kept_if_needed(self, expression: ir.Expression, later: tuple[ir.Expression | None, ...]) -> Read:
        """A bound; evaluated aside when a later one calls a function."""
        flat = self.linker.flattener.expression(expression)
        if any(each is not None and has_call(each) for each in later):
            flat = self.linker.flattener.kept(flat)
        return self.linker.compiler.operand(flat)

    # ---- waiting for what only a function can tell

    def _poll_until(self, statement: ir.WaitUntil) -> None:
        """The condition calls a function: it is asked again in the controller's cycle."""
        again, leave = Label(), Label()
        compiler = self.linker.compiler
        deadline = compiler.new_place()
        timeout = self.value(statement.timeout) if statement.timeout is not None else None
        if statement.in_position:
            self.emit(actions.wait_for_robot)
        self.emit(_set_deadline(deadline, timeout))
        self.assembler.place(again)
        self.emit(_branch_if(self.value(statement.condition), leave, self.linker.code))
        timed_out = actions.timed_out(statement, self.linker)
        self.emit(_tick(deadline, timed_out, again, statement.error))
        self.assembler.place(leave)
        if timed_out is not None:
            late = timed_out
            self.emit(_effect(lambda f: late(f, f[deadline] == "passed")))


# ---- instructions


def _goto(label: Label, name: str = "") -> Make:
    def make(here: int, next: int) -> Instruction:
        if label.position is None:
            return _failing("bad_call", f"there is no label {name} in this routine")(here, next)
        target = label.pc
        return lambda f: target

    return make


def _nothing(here: int, next: int) -> Instruction:
    return lambda f: next


def _failing(error: str, message: str) -> Make:
    def make(here: int, next: int) -> Instruction:
        def fail(f: Values) -> int:
            raise ProgramError(error, message)

        return fail

    return make


def _branch(condition: Read, otherwise: Label, code: Code) -> Make:
    def make(here: int, next: int) -> Instruction:
        target = otherwise.pc
        code.branches.append(Branch(here, next, target))

        def branch(f: Values) -> int:
            if condition(f):
                return next
            f[0].marks[~here] = 1
            return target

        return branch

    return make


def _branch_if(condition: Read, then: Label, code: Code) -> Make:
    def make(here: int, next: int) -> Instruction:
        target = then.pc
        code.branches.append(Branch(here, target, next))

        def branch(f: Values) -> int:
            if condition(f):
                return target
            f[0].marks[~here] = 1
            return next

        return branch

    return make


def _keep(place: int, read: Read) -> Make:
    def make(here: int, next: int) -> Instruction:
        def keep(f: Values) -> int:
            f[place] = read(f)
            return next

        return keep

    return make


def _case(selector: int, values: list[Read], otherwise: Label, code: Code) -> Make:
    def make(here: int, next: int) -> Instruction:
        target = otherwise.pc
        code.branches.append(Branch(here, next, target))

        def select(f: Values) -> int:
            chosen = f[selector]
            for value in values:
                if equal(chosen, value(f)):
                    return next
            f[0].marks[~here] = 1
            return target

        return select

    return make


def _effect(run: Callable[[Values], object]) -> Make:
    def make(here: int, next: int) -> Instruction:
        def effect(f: Values) -> int:
            run(f)
            return next

        return effect

    return make


def _run(run: Read, wakes: bool) -> Make:
    if not wakes:
        return _effect(run)

    def make(here: int, next: int) -> Instruction:
        def effect(f: Values) -> int:
            run(f)
            task = f[0]
            task.machine.changed()
            return next if not task.interrupts.pending and not task.triggers else task.attention(next)

        return effect

    return make


def _may_wake(statement: ir.Do, linker: Linker) -> bool:
    return any(
        argument is not None
        and isinstance(argument, ir.Name | ir.Index | ir.Field)
        and watches(linker.compiler, argument)
        for argument in statement.arguments
    )


# ---- counting loops

Write = Callable[[Values, Value], None]


def _counter(place: Place) -> tuple[Read, Write]:
    number = place.number
    if place.is_global:
        return (lambda f: f[0].g[number]), (lambda f, value: f[0].g.__setitem__(number, value))
    if place.is_reference:
        return (lambda f: f[number].get()), (lambda f, value: f[number].set(value))
    return (lambda f: f[number]), (lambda f, value: f.__setitem__(number, value))


def _begin_loop(
    write: Write,
    start: Read,
    stop: Read,
    step: Read | None,
    places: tuple[int, int],
    automatic: bool,
    at_least_once: bool,
    leave: Label,
) -> Make:
    stop_place, step_place = places

    def make(here: int, next: int) -> Instruction:
        target = leave.pc

        def begin(f: Values) -> int:
            first, last = start(f), stop(f)
            by = step(f) if step is not None else -1 if automatic and first > last else 1
            if by == 0:
                raise ProgramError("negative_argument", "the step of a loop must not be 0")
            f[stop_place], f[step_place] = last, by
            write(f, first)
            if at_least_once or (first <= last if by > 0 else first >= last):
                return next
            return target

        return begin

    return make


def _next_pass(
    read: Read, write: Write, stop: int, step: int, begin: Label, simple: int | None, to: Precision | None
) -> Make:
    """`to` rounds a sum as the language does."""

    def make(here: int, next: int) -> Instruction:
        target = begin.pc

        def general(f: Values) -> int:
            by = f[step]
            value = read(f) + by if to is None else to(read(f) + by)
            write(f, value)
            return target if (value <= f[stop] if by > 0 else value >= f[stop]) else next

        if simple is None:
            return general
        place = simple

        def local(f: Values) -> int:
            by = f[step]
            value = f[place] = f[place] + by if to is None else to(f[place] + by)
            return target if (value <= f[stop] if by > 0 else value >= f[stop]) else next

        return local

    return make


def _next_if_inside(read: Read, write: Write, stop: int, step: int, begin: Label, to: Precision | None) -> Make:
    """The counter keeps the value of the last pass."""

    def make(here: int, next: int) -> Instruction:
        target = begin.pc

        def pass_on(f: Values) -> int:
            by = f[step]
            value = read(f) + by if to is None else to(read(f) + by)
            if value <= f[stop] if by > 0 else value >= f[stop]:
                write(f, value)
                return target
            return next

        return pass_on

    return make


# ---- polling a function


def _set_deadline(place: int, timeout: Read | None) -> Make:
    def make(here: int, next: int) -> Instruction:
        def set_deadline(f: Values) -> int:
            f[place] = None if timeout is None else f[0].machine.now + timeout(f)
            return next

        return set_deadline

    return make


def _tick(place: int, timed_out: Write | None, again: Label, error: str | None) -> Make:
    def make(here: int, next: int) -> Instruction:
        target = again.pc

        def tick(f: Values) -> int:
            task = f[0]
            if f[place] is not None and task.machine.now >= f[place]:
                f[place] = "passed"
                if timed_out is None and error is not None:
                    number = task.frame.code.rules.errors.get(error)
                    raise ProgramError("timeout", "the wait has timed out", number)
                return next
            waiting: int = task.sleep_tick(target)
            return waiting

        return tick

    return make

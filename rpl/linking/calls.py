"""Calls: arguments by position, name, omitted, optional, switch, `if_present`; by value or by reference; dynamic names.

References are made when the call is, so indices are evaluated then.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from rpl import ir
from rpl.linking.expressions import Compiler, Place
from rpl.linking.flatten import has_call
from rpl.linking.linker import Fill, Linker, Plan
from rpl.linking.places import reference
from rpl.runtime import answers
from rpl.runtime.code import SWITCHED, Code, Frame, Instruction, Read, Values
from rpl.runtime.faults import ProgramError
from rpl.runtime.values import SignalRef, Value
from rpl.source import Origin

if TYPE_CHECKING:
    from rpl.linking.assembler import Make
    from rpl.linking.symbols import Symbols
    from rpl.runtime.task import Task

FIRST = 1  # place of the first parameter in a routine's frame


class Calls:
    """Compiles the calls of one routine."""

    def __init__(self, linker: Linker) -> None:
        self.linker = linker

    @property
    def compiler(self) -> Compiler:
        return self.linker.compiler

    def emit(self, name: str, arguments: tuple[ir.Argument, ...], origin: Origin, result: int | None) -> None:
        """The instruction of a call by name; arguments hold no calls any more after this."""
        routine = self.linker.linked.routine(self.compiler.scope, name)
        if routine is None:
            kind = "unknown_function" if result is not None else "unknown_routine"
            self.linker.assembler.emit(_missing(kind, name, result))
            return
        place_arguments = self._flat(routine, arguments)
        vendor = _vendor_body(routine)
        if vendor is not None:
            self.linker.assembler.emit(self.linker.vendor_function(vendor, result))
            return
        plan = self.plan(routine, place_arguments, origin)
        self.linker.assembler.emit(_call(plan, result, self.linker.linked, routine))

    def _flat(self, routine: ir.Routine, arguments: tuple[ir.Argument, ...]) -> tuple[ir.Argument, ...]:
        """Arguments without calls; values in front of one that calls a function are kept as they are before it."""
        flat = self.linker.flattener
        parameters = self._matching(routine, arguments)
        waiting = sum(argument.value is not None and has_call(argument.value) for argument in arguments)
        done = []
        for argument, place in zip(arguments, parameters, strict=True):
            value = argument.value
            if value is not None and has_call(value):
                waiting -= 1
                value = flat.expression(value)
            elif value is not None and waiting and place is not None and _by_value(routine.parameters[place], value):
                value = flat.kept(value)
            done.append(ir.Argument(value, argument.name, argument.if_present))
        return tuple(done)

    def _matching(self, routine: ir.Routine, arguments: tuple[ir.Argument, ...]) -> list[int | None]:
        """For each argument the number of its parameter."""
        fold = self.compiler.scope.fold
        parameters = routine.parameters
        by_name = {fold(parameter.name): place for place, parameter in enumerate(parameters)}
        some_optional = any(parameter.optional for parameter in parameters)
        positions = iter([n for n, parameter in enumerate(parameters) if not (some_optional and parameter.optional)])
        return [
            by_name.get(fold(argument.name)) if argument.name is not None else next(positions, None)
            for argument in arguments
        ]

    def plan(self, routine: ir.Routine, arguments: tuple[ir.Argument, ...], origin: Origin) -> Plan:
        """How each argument gets into its parameter's place."""
        parameters = routine.parameters
        fills: list[Fill] = []
        for argument, place in zip(arguments, self._matching(routine, arguments), strict=True):
            if place is None:
                message = f"{routine.name} has no parameter {argument.name or 'for all its arguments'}"
                fills.append(_refusing(message))
                continue
            fill = self.fill(parameters[place], FIRST + place, argument, origin)
            if fill is not None:
                fills.append(fill)
        linked = self.linker.linked
        return Plan(lambda: linked.code_of(routine), tuple(fills))

    def fill(self, parameter: ir.Parameter, place: int, argument: ir.Argument, origin: Origin) -> Fill | None:
        """What puts one argument into its place; None for one that is left out."""
        compiler = self.compiler
        given = self._present(argument.if_present)
        if argument.value is None:
            if argument.name is None:
                return None
            if given is None:
                return _constant(place, True)
            return lambda f, g: g.__setitem__(place, f[given] if f[given] is None else True)
        if isinstance(compiler.scope.resolve(parameter.type), ir.SignalType):
            return self._signal(place, argument.value, compiler)
        if parameter.mode == "reference":
            make_reference = reference(compiler, argument.value, origin)
            if given is None:
                return lambda f, g: g.__setitem__(place, make_reference(f))
            return lambda f, g: g.__setitem__(place, None if f[given] is None else make_reference(f))
        read = compiler.copy_of(argument.value)
        if given is None:
            return lambda f, g: g.__setitem__(place, read(f))
        return lambda f, g: g.__setitem__(place, None if f[given] is None else read(f))

    def _signal(self, place: int, value: ir.Expression, compiler: Compiler) -> Fill:
        """A signal parameter gets the signal itself."""
        while isinstance(value, ir.Convert):
            value = value.operand
        if isinstance(value, ir.Name):
            found = compiler.place_of(value.id)
            if isinstance(found, Place):
                read = compiler.name(value, checked=False)
                return lambda f, g: g.__setitem__(place, read(f))
            value = found.signal if found is not None else ir.Signal("digital_out", name=value.id)
        if not isinstance(value, ir.Signal):
            return _refusing("a signal is needed as argument")
        port = compiler.port(value)
        if isinstance(port, SignalRef):
            return _constant(place, port)
        return lambda f, g: g.__setitem__(place, port(f))

    def _present(self, name: str | None) -> int | None:
        """The place of the optional parameter that decides whether an argument is passed on."""
        if name is None:
            return None
        place = self.compiler.place_of(name)
        return place.number if isinstance(place, Place) else None

    def dynamic(self, statement: ir.CallRoutine) -> Make:
        """A call whose routine is named by a text at run time."""
        assert statement.dynamic is not None
        name = self.compiler.value(statement.dynamic)
        scope, linked = self.compiler.scope, self.linker.linked
        plans: dict[str, Plan] = {}
        seen = dict(self.compiler.places)  # what the arguments see: a loop's own counter is gone behind the loop

        def plan_for(text: str) -> Plan:
            found = plans.get(text)
            if found is None:
                routine = linked.routine(scope, text.rpartition(":")[2])
                if routine is None:
                    raise ProgramError("unknown_routine", f"there is no routine {text!r}")
                later, self.compiler.places = self.compiler.places, seen
                found = plans[text] = self.plan(routine, statement.arguments, statement.origin)
                self.compiler.places = later
            return found

        def make(here: int, next: int) -> Instruction:
            def call(f: Values) -> int:
                text = name(f)
                if not isinstance(text, str):
                    raise ProgramError("bad_call", "the name of a routine must be a text")
                return _enter(f, plan_for(text), here, next, None)

            return call

        return make


def _enter(f: Values, plan: Plan, here: int, next: int, result: int | None) -> int:
    code = plan.code()
    task: Task = f[0]
    frame = task.new_frame(code)
    values = frame.values
    for fill in plan.fills:
        fill(f, values)
    return task.call(frame, here, next, result)


def _call(plan: Plan, result: int | None, linked: Symbols, routine: ir.Routine) -> Make:
    fills = plan.fills

    def make(here: int, next: int) -> Instruction:
        known: list[Code] = []

        def call(f: Values) -> int:
            if not known:
                known.append(linked.code_of(routine))
            code = known[0]
            task = f[0]
            if code.globals_needed > len(task.g):
                task.machine.provide(code)
            values: Values = [None] * code.size
            values[0] = task
            for fill in fills:
                fill(f, values)
            caller = task.frame
            caller.at, caller.counter = here, next
            frame = Frame(code, values)
            frame.result = result
            task.enter(frame)
            return SWITCHED

        return call

    return make


def _by_value(parameter: ir.Parameter, value: ir.Expression) -> bool:
    return parameter.mode != "reference" and not isinstance(value, ir.Signal)


def _vendor_body(routine: ir.Routine) -> ir.Vendor | None:
    """A predefined function of one controller: its body is the vendor statement alone."""
    match routine.body:
        case (ir.Vendor() as vendor,) if routine.kind == "function":
            return vendor
    return None


def _missing(kind: str, name: str, result: int | None) -> Make:
    """A call of what is not there: what the cell file says of it, else a fault. Its arguments are not looked at."""

    def make(here: int, next: int) -> Instruction:
        def stand_in(f: Values) -> int:
            task = f[0]
            meaning = answers.unknown_routine(task.machine, task, name, task.frame.code.origin(here))
            if meaning is None or (result is not None and meaning.value is None):
                what = "is not in what was read" if meaning is None else "gives no value in the cell file"
                raise ProgramError(kind, f"the routine {name} {what} (see [[routine]] of a cell file)")
            if result is not None:
                f[result] = meaning.value
            done: int = task.sleep(meaning.seconds, here, next)
            return done

        return stand_in

    return make


def _constant(place: int, value: Value) -> Fill:
    return lambda f, g: g.__setitem__(place, value)


def _refusing(message: str) -> Fill:
    def refuse(f: Values, g: Values) -> None:
        raise ProgramError("bad_call", message)

    return refuse


__all__ = ["FIRST", "Calls", "Read"]


def leaving(read: Read | None) -> Make:
    """Return from the frame."""

    def make(here: int, next: int) -> Instruction:
        if read is None:
            return lambda f: f[0].leave(here)
        value = read
        return lambda f: f[0].leave(here, value(f))

    return make

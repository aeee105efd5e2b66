"""A small independent interpreter of control flow, for comparing a program before and after a pass.

It walks the tree and uses Python exceptions where the product uses a program counter, so that the two cannot share a
mistake. It knows numbers, texts, arrays, calls, errors and timers; no motion. `run` gives what an observer sees: the
messages, outputs and the way the run ended.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field, replace
from typing import Any

from rpl import ir
from rpl.passes.fold import constant
from rpl.passes.legalise.context import rules_of
from rpl.passes.scope import ProgramScope

from .machine_functions import BINARY, FUNCTIONS, convert

STEPS = 6000


class Left(Exception):
    pass


class Next(Exception):
    pass


class Back(Exception):
    def __init__(self, value: Any) -> None:
        self.value = value


class Jump(Exception):
    def __init__(self, label: str) -> None:
        self.label = label


class Raised(Exception):
    def __init__(self, number: int) -> None:
        self.number = number


class Again(Exception):
    pass


class GoOn(Exception):
    pass


class Stopped(Exception):
    pass


class TooLong(Exception):
    pass


class Fault(Exception):
    """A mistake of the pass: something undefined is used."""


@dataclass
class Frame:
    module: ir.Module
    routine: ir.Routine
    values: dict[str, list[Any]] = field(default_factory=dict)
    present: set[str] = field(default_factory=set)


def run(program: ir.Program, entry: str = "main", inputs: Any = None, handler_ends: str = "return") -> list[Any]:
    machine = Machine(program, inputs, handler_ends)
    try:
        machine.call_entry(entry)
        machine.trace.append(("end", "finished"))
    except Stopped:
        machine.trace.append(("end", "stopped"))
    except Raised as error:
        machine.trace.append(("end", "stopped"))
        del error
    except TooLong:
        machine.trace.append(("end", "limit"))
    return machine.trace


class Machine:
    def __init__(self, program: ir.Program, inputs: Any, handler_ends: str) -> None:
        self.program = program
        self.scopes = ProgramScope(program)
        self.inputs = inputs or {}
        self.handler_ends = handler_ends
        self.trace: list[Any] = []
        self.globals: dict[tuple[int, str], list[Any]] = {}
        self.time = 0.0
        self.steps = 0
        self.errno = 0
        self.outputs: dict[str, Any] = {}
        self.timers: dict[int, tuple[float, float | None]] = {}
        self.clocks: dict[int, tuple[float, float | None]] = {}
        for module in program.modules:
            for declaration in module.declarations:
                if isinstance(declaration, ir.Variable):
                    frame = Frame(module, ir.Routine(""))
                    self.globals[id(module), declaration.name.lower()] = [self.initial(declaration, frame)]
                elif isinstance(declaration, ir.Initialise):
                    self.leaf(declaration.assign, Frame(module, ir.Routine("")))

    def scope(self, frame: Frame) -> Any:
        return self.scopes.routine(frame.module, frame.routine)

    def initial(self, variable: ir.Variable, frame: Frame) -> Any:
        if variable.initial is not None:
            return self.stored(self.value(variable.initial, frame), variable.type)
        return self.zero(self.scopes.module(frame.module).resolve(variable.type), frame)

    def zero(self, type: ir.Type, frame: Frame) -> Any:
        match type:
            case ir.ArrayType(element=element, dimensions=dimensions):
                size = self.value(dimensions[0], frame) if dimensions[0] is not None else 1
                rest = ir.ArrayType(element, dimensions[1:]) if len(dimensions) > 1 else element
                return [self.zero(rest, frame) for _ in range(size)]
            case ir.BoolType():
                return False
            case ir.StringType():
                return ""
            case ir.RealType():
                return 0.0
            case ir.ClockType():
                return ["clock", 0.0, None]
            case ir.NamedType(name=name):
                declared = self.scopes.module(frame.module).type(name)
                if isinstance(declared, ir.RecordDeclaration):
                    return {field.lower(): self.zero(inner, frame) for field, inner in declared.fields}
        return 0

    def stored(self, value: Any, type: ir.Type | None) -> Any:
        if isinstance(type, ir.RealType) and isinstance(value, int) and not isinstance(value, bool):
            return float(value)
        if isinstance(value, list) and value[:1] != ["clock"]:
            return [self.stored(one, None) for one in value]
        return dict(value) if isinstance(value, dict) else value

    # ---- routines

    def call_entry(self, name: str) -> None:
        for module in self.program.modules:
            for routine in module.routines:
                if routine.name.lower() == name.lower():
                    self.call(module, routine, (), None)
                    return
        raise Fault(f"no routine {name}")

    def routine(self, name: str, frame: Frame) -> tuple[ir.Module, ir.Routine]:
        routine = self.scope(frame).routine(name)
        if routine is None:
            raise Fault(f"no routine {name}")
        return self.scopes.home(routine) or frame.module, routine

    def call(self, module: ir.Module, routine: ir.Routine, arguments: Any, caller: Frame | None) -> Any:
        self.tick()
        frame = Frame(module, routine)
        names = {p.name.lower(): p for p in routine.parameters}
        positional = iter([p for p in routine.parameters if not p.optional])
        for argument in arguments:
            parameter = names[argument.name.lower()] if argument.name else next(positional)
            key = parameter.name.lower()
            if argument.if_present and argument.if_present.lower() not in caller.present:
                continue
            if argument.value is None or parameter.switch:
                if argument.name:
                    frame.present.add(key)
                continue
            frame.present.add(key)
            if parameter.mode == "reference":
                frame.values[key] = self.place(argument.value, caller)
            else:
                frame.values[key] = [self.stored(self.value(argument.value, caller), parameter.type)]
        for declaration in routine.declarations:
            if isinstance(declaration, ir.Variable) and declaration.name.lower() not in frame.values:
                frame.values[declaration.name.lower()] = [self.initial(declaration, frame)]
        try:
            self.body(routine.body, frame)
        except Back as back:
            return back.value
        except Jump as jump:
            raise Fault(f"no label {jump.label}") from None
        return None

    def handle(self, error: Raised, frame: Frame) -> None:
        """Runs the routine's handler: Again, GoOn, Back or Raised come out of it."""
        self.errno = error.number
        for handler in frame.routine.handlers:
            if not handler.codes or any(self.value(one, frame) == error.number for one in handler.codes):
                plain = Frame(frame.module, replace(frame.routine, handlers=()), frame.values, frame.present)
                self.body(handler.body, plain)
                raise Back(0)  # the end of a handler returns
        self.body(frame.routine.undo, Frame(frame.module, replace(frame.routine, handlers=()), frame.values))
        raise error

    def guarded(self, action: Any, frame: Frame) -> bool:
        """Runs an action; an error goes to the handler. FALSE: the handler said to go on behind it."""
        while True:
            try:
                action()
                return True
            except Raised as error:
                try:
                    self.handle(error, frame)
                except Again:
                    self.tick()
                    continue
                except GoOn:
                    return False

    # ---- statements

    def tick(self) -> None:
        self.steps += 1
        if self.steps > STEPS:
            raise TooLong

    def body(self, body: ir.Body, frame: Frame) -> None:
        at = 0
        while at < len(body):
            try:
                self.statement(body[at], frame)
                at += 1
            except Jump as jump:
                found = [i for i, s in enumerate(body) if isinstance(s, ir.Label) and s.name.lower() == jump.label]
                if not found:
                    raise
                at = found[0]

    def condition(self, expression: ir.Expression, frame: Frame) -> bool | None:
        got: list[bool] = []
        if not self.guarded(lambda: got.append(self.value(expression, frame)), frame):
            return None
        if not isinstance(got[0], bool):
            raise Fault(f"no truth value: {expression}")
        return got[0]

    def statement(self, s: ir.Statement, frame: Frame) -> None:
        self.tick()
        match s:
            case ir.If(branches=branches, otherwise=otherwise):
                for condition, body in branches:
                    holds = self.condition(condition, frame)
                    if holds is None:
                        return None
                    if holds:
                        return self.body(body, frame)
                return self.body(otherwise, frame)
            case ir.Switch():
                return self.switch(s, frame)
            case ir.For():
                return self.counting(s, frame)
            case ir.While(condition=condition, body=body):
                while self.condition(condition, frame):
                    self.tick()
                    if self.one_pass(body, frame):
                        return None
                return None
            case ir.Repeat(until=until, body=body):
                while True:
                    self.tick()
                    if self.one_pass(body, frame) or self.condition(until, frame) is not False:
                        return None
            case ir.Loop(body=body):
                while not self.one_pass(body, frame):
                    self.tick()
                return None
            case ir.ExitLoop():
                raise Left
            case ir.NextPass():
                raise Next
            case ir.Label() | ir.Nothing():
                return None
            case ir.Goto(label=label):
                raise Jump(label.lower())
            case ir.Retry():
                raise Again
            case ir.TryNext():
                raise GoOn
            case ir.Halt():
                raise Stopped
        self.guarded(lambda: self.leaf(s, frame), frame)
        return None

    def one_pass(self, body: ir.Body, frame: Frame) -> bool:
        try:
            self.body(body, frame)
        except Left:
            return True
        except Next:
            pass
        return False

    def switch(self, s: ir.Switch, frame: Frame) -> None:
        got: list[Any] = []
        if not self.guarded(lambda: got.append(self.value(s.selector, frame)), frame):
            return
        for case in s.cases:
            for value in case.values:
                if self.value(value, frame) == got[0]:
                    self.body(case.body, frame)
                    return
        self.body(s.default or (), frame)

    def counting(self, s: ir.For, frame: Frame) -> None:
        bounds: list[Any] = []
        parts = [s.start, s.stop] + ([] if s.step is None else [s.step])
        if not self.guarded(
            lambda: bounds.__setitem__(slice(None), [self.value(part, frame) for part in parts]), frame
        ):
            return
        first, last = bounds[:2]
        step = bounds[2] if len(bounds) > 2 else -1 if s.automatic and first > last else 1
        key = s.counter.lower()
        hidden = frame.values.get(key)
        if s.scoped:
            place = frame.values[key] = [first]
            scope_routine = frame.routine
            variable = ir.Variable(s.counter, ir.RealType(), scope="routine")
            frame.routine = replace(scope_routine, declarations=(*scope_routine.declarations, variable))
        else:
            place = self.place(ir.Name(s.counter), frame)
            place[0] = first
        check = not s.at_least_once
        while True:
            value = place[0]
            if check and ((step > 0 and value > last) or (step < 0 and value < last)):
                break
            check = True
            self.tick()
            if self.one_pass(s.body, frame):
                break
            further = place[0] + step
            if s.keeps_last and (further > last if step > 0 else further < last):
                break
            place[0] = further
        if s.scoped:
            frame.routine = scope_routine
            frame.values.pop(key)
            if hidden is not None:
                frame.values[key] = hidden

    def leaf(self, s: ir.Statement, frame: Frame) -> None:
        match s:
            case ir.Assign(target=ir.Signal(index=index, name=name), value=value):
                key = name or f"out{self.value(index, frame)}"
                self.outputs[key] = self.value(value, frame)
                self.trace.append(("output", key, self.outputs[key]))
            case ir.Assign(target=ir.System(name="advance")):
                return  # how far the program pointer may be ahead shows in motion only
            case ir.Assign(target=ir.System(name="timer", indices=(index,)), value=value):
                number, started = self.value(index, frame), self.timers.get(self.value(index, frame), (0, 0.0))[1]
                self.timers[number] = (self.value(value, frame), None if started is None else self.time)
            case ir.Assign(target=ir.System(name="timer_stopped", indices=(index,)), value=value):
                number = self.value(index, frame)
                now = self.timer(number)
                self.timers[number] = (now, None if self.value(value, frame) else self.time)
            case ir.Assign(target=target, value=value):
                if isinstance(target, ir.Index) and isinstance(self.value(target.base, frame), str):
                    self.set_character(target, self.value(value, frame), frame)
                    return
                result = self.value(value, frame)
                place = self.place(target, frame)
                place[0] = self.stored(result, ir.RealType() if isinstance(place[0], float) else None)
            case ir.CallRoutine(name=name, arguments=arguments, dynamic=dynamic):
                called = name if dynamic is None else self.value(dynamic, frame)
                self.call(*self.routine(called, frame), arguments, frame)
            case ir.Return(value=value):
                raise Back(None if value is None else self.value(value, frame))
            case ir.Raise(code=None):
                raise Raised(self.errno)
            case ir.Raise(code=number):
                raise Raised(int(self.value(number, frame)))
            case ir.Message(text=text):
                self.trace.append(("message", self.value(text, frame)))
            case ir.Wait(time=time):
                self.time += self.value(time, frame)
            case ir.WaitUntil():
                self.wait(s, frame)
            case ir.Clock(op=op, clock=clock):
                self.clock(op, self.place(clock, frame)[0])
            case ir.Do():
                self.do(s.procedure, s.arguments, frame)
            case _:
                raise Fault(f"unknown statement {s}")

    def wait(self, s: ir.WaitUntil, frame: Frame) -> None:
        limit = math.inf if s.timeout is None else self.time + self.value(s.timeout, frame)
        late = False
        while not self.value(s.condition, frame):
            self.tick()
            if self.time >= limit:
                late = True
                break
            self.time += 0.125
        if s.timed_out is not None:
            self.place(s.timed_out, frame)[0] = late
        elif late:
            raise Raised(rules_of("rapid").errors.get(s.error, 1))

    def clock(self, op: str, clock: list[Any]) -> None:
        now = clock[1] + (0.0 if clock[2] is None else self.time - clock[2])
        clock[1:] = {"reset": [0.0, None], "start": [now, self.time], "stop": [now, None]}[op]

    def timer(self, number: int) -> float:
        value, started = self.timers.get(number, (0, 0.0))
        return value if started is None else value + self.time - started

    def do(self, procedure: str, arguments: Any, frame: Frame) -> Any:
        place = self.place(arguments[0], frame)
        values = [None if one is None else self.value(one, frame) for one in arguments[1:]]
        match procedure:
            case "text_append":
                place[0] = place[0] + values[0]
            case "text_copy":
                place[0] = values[0]
            case "text_clear":
                place[0] = ""
            case "increment":
                place[0] = place[0] + (values[0] if values else 1)
            case "decrement":
                place[0] = place[0] - (values[0] if values else 1)
            case "clear":
                place[0] = 0
            case "format_into":
                place[0] = place[0][: values[1] or 0] + values[2] % tuple(values[3:])
            case _:
                raise Fault(f"unknown procedure {procedure}")
        return True

    def set_character(self, target: ir.Index, value: str, frame: Frame) -> None:
        place = self.place(target.base, frame)
        at = self.value(target.indices[0], frame)
        text = place[0].ljust(at, "\0")
        place[0] = text[: at - 1] + value + text[at:]

    # ---- places and values

    def place(self, target: ir.Expression, frame: Frame) -> Any:
        match target:
            case ir.Name(id=name):
                if name.lower() in frame.values:
                    return frame.values[name.lower()]
                symbol = self.scope(frame).value(name)
                if symbol is None:
                    raise Fault(f"unknown name {name}")
                if symbol.module is None:
                    return [self.predefined(name, frame)]
                return self.globals[id(symbol.module), name.lower()]
            case ir.Index(base=base, indices=indices):
                whole = self.place(base, frame)[0]
                for index in indices[:-1]:
                    whole = whole[self.element(whole, index, frame)]
                return Element(whole, self.element(whole, indices[-1], frame))
            case ir.Field(base=base, name=name):
                return Element(self.place(base, frame)[0], name.lower())
        return [self.value(target, frame)]

    def predefined(self, name: str, frame: Frame) -> Any:
        errors = {word.lower(): number for word, number in rules_of(frame.module.dialect).errors.items()}
        if name.lower() in errors:
            return errors[name.lower()]
        found = constant(ir.Name(name), self.scope(frame))
        if found is None:
            raise Fault(f"unknown predefined {name}")
        return found

    def element(self, whole: Any, index: ir.Expression, frame: Frame) -> int:
        at = self.value(index, frame)
        if not 1 <= at <= len(whole):
            raise Raised(rules_of("rapid").errors["ERR_OUTOFBND"])
        return int(at) - 1

    def value(self, e: ir.Expression, frame: Frame) -> Any:
        self.tick()
        match e:
            case ir.IntLiteral(value=value) | ir.RealLiteral(value=value) | ir.BoolLiteral(value=value):
                return value
            case ir.TextLiteral(value=value):
                return value
            case ir.EnumLiteral(member=member):
                return member.lower()
            case ir.Index(base=base, indices=(index,)) if isinstance(self.value(base, frame), str):
                text = self.value(base, frame)
                return text[self.element(text, index, frame)]
            case ir.Name() | ir.Index() | ir.Field():
                return self.place(e, frame)[0]
            case ir.Unary(op=op, operand=operand):
                value = self.value(operand, frame)
                return {"-": lambda: -value, "+": lambda: value, "not": lambda: not value, "bnot": lambda: ~value}[op]()
            case ir.Binary():
                return self.binary(e, frame)
            case ir.Call(name=name, arguments=arguments):
                return self.call(*self.routine(name, frame), arguments, frame)
            case ir.Builtin(function=function, arguments=arguments):
                return self.builtin(function, arguments, frame)
            case ir.Quantity(value=inner, unit=unit):
                return self.value(inner, frame) * ir.UNITS[unit]
            case ir.Convert(how=how, operand=operand):
                return convert(how, self.value(operand, frame))
            case ir.Present(name=name):
                return name.lower() in frame.present
            case ir.Signal(index=index, name=name):
                return self.inputs[name or f"in{self.value(index, frame)}"](self.time)
            case ir.System(name="error_number"):
                return self.errno
            case ir.System(name="timer_positive", indices=(index,)):
                return self.timer(self.value(index, frame)) > 0
            case ir.Magnitude(value=inner, unit=unit):
                return self.value(inner, frame) / ir.UNITS[unit]
            case ir.System(name="timer", indices=(index,)):
                return self.timer(self.value(index, frame))
            case ir.Aggregate(entries=entries, type_name=word):
                declared = self.scope(frame).type(word) if word else None
                values = [self.value(value, frame) for _, value in entries]
                if not isinstance(declared, ir.RecordDeclaration):
                    return values
                fields = [name for name, _ in declared.fields]
                names = [name or fields[at] for at, (name, _) in enumerate(entries)]
                return {name.lower(): value for name, value in zip(names, values, strict=True)}
        raise Fault(f"unknown expression {e}")

    def binary(self, e: ir.Binary, frame: Frame) -> Any:
        left = self.value(e.left, frame)
        if e.op == "cand" and not left:
            return False
        if e.op == "cor" and left:
            return True
        right = self.value(e.right, frame)
        if e.op in ("/", "div", "mod") and right == 0:
            raise Raised(rules_of("rapid").errors.get("ERR_DIVZERO", 1))
        return BINARY[e.op](left, right)

    def builtin(self, function: str, arguments: Any, frame: Frame) -> Any:
        if function in ir.PROCEDURES:
            return self.do(function, arguments, frame)
        if function == "is_uninitialised":
            return arguments[0].id.lower() not in frame.present
        values = [self.value(one, frame) for one in arguments]
        match function:
            case "clock_seconds":
                clock = values[0]
                return clock[1] + (0.0 if clock[2] is None else self.time - clock[2])
        return FUNCTIONS[function](*values)


class Element:
    """One element of an array or record as a place."""

    def __init__(self, whole: Any, key: Any) -> None:
        self.whole, self.key = whole, key

    def __getitem__(self, at: int) -> Any:
        return self.whole[self.key]

    def __setitem__(self, at: int, value: Any) -> None:
        self.whole[self.key] = value

"""What a program of tests/ir/programs.py does, computed straight from the tree and independent of the product's own
linking and runtime: slow, small, and obvious."""

from __future__ import annotations

import operator
from collections.abc import Callable
from math import trunc

from rpl import ir

Value = int | float | bool | str
_MOST_STEPS = 100_000
_BINARY: dict[str, Callable[..., Value]] = {
    "+": operator.add,
    "-": operator.sub,
    "*": operator.mul,
    "/": operator.truediv,
    "div": lambda a, b: trunc(a / b) if abs(a) < 2**50 else a // b,
    "mod": operator.mod,
    "&": operator.add,
    "=": operator.eq,
    "<>": operator.ne,
    "<": operator.lt,
    ">": operator.gt,
    "<=": operator.le,
    ">=": operator.ge,
    "and": lambda a, b: a and b,
    "or": lambda a, b: a or b,
    "xor": operator.ne,
}
_FUNCTIONS: dict[str, Callable[..., Value]] = {"abs": abs, "min": min, "max": max}
_CONVERSIONS: dict[str, Callable[..., Value]] = {"trunc": trunc, "real": float}


class _Exit(Exception):
    pass


class _Return(Exception):
    def __init__(self, value: Value | None) -> None:
        super().__init__()
        self.value = value


def expected_outputs(program: ir.Program) -> dict[int, bool]:
    """Final state of every digital output that the program writes."""
    machine = Machine(program)
    machine.call("main", [])
    return machine.outputs


class Machine:
    """A place is (dictionary, key), so that a parameter by reference is the place itself."""

    def __init__(self, program: ir.Program) -> None:
        self.routines = {routine.name: routine for module in program.modules for routine in module.routines}
        self.globals: dict[object, Value] = {}
        self.outputs: dict[int, bool] = {}
        self.steps = 0

    def call(self, name: str, given: list[object]) -> Value | None:
        routine = self.routines[name]
        frame: dict[object, object] = {}
        for parameter, argument in zip(routine.parameters, given, strict=True):
            frame[parameter.name] = argument if parameter.mode == "reference" else ({"": argument}, "")
        for declaration in routine.declarations:
            if isinstance(declaration, ir.Variable):
                frame[declaration.name] = ({}, "")
        try:
            self.body(routine.body, frame)
        except _Return as done:
            return done.value
        return None

    def body(self, body: ir.Body, frame: dict[object, object]) -> None:
        for statement in body:
            self.steps += 1
            assert self.steps < _MOST_STEPS, "the program does not end"
            self.statement(statement, frame)

    def place(self, node: ir.Expression, frame: dict[object, object]) -> tuple[dict[object, Value], object]:
        match node:
            case ir.Name(id=name):
                return frame.get(name, (self.globals, name))  # type: ignore[return-value]
            case ir.Index(base=ir.Name(id=name), indices=(index,)):
                return self.globals, (name, self.value(index, frame))
            case ir.Field(base=ir.Name(id=name), name=field):
                return self.globals, (name, field)
        raise AssertionError(node)

    def value(self, node: ir.Expression, frame: dict[object, object]) -> Value:
        match node:
            case ir.IntLiteral(value=value) | ir.RealLiteral(value=value):
                return value
            case ir.BoolLiteral(value=value) | ir.TextLiteral(value=value):
                return value
            case ir.Binary(op=op, left=left, right=right):
                return _BINARY[op](self.value(left, frame), self.value(right, frame))
            case ir.Unary(op="-", operand=operand):
                return -self.value(operand, frame)  # type: ignore[operator]
            case ir.Unary(op="not", operand=operand):
                return not self.value(operand, frame)
            case ir.Builtin(function=function, arguments=arguments):
                return _FUNCTIONS[function](*(self.value(argument, frame) for argument in arguments))
            case ir.Convert(how=how, operand=operand):
                return _CONVERSIONS[how](self.value(operand, frame))
            case ir.Call(name=name, arguments=arguments):
                done = self.call(name, [self.value(a.value, frame) for a in arguments if a.value])
                assert done is not None
                return done
        place, key = self.place(node, frame)
        return place[key]

    def statement(self, node: ir.Statement, frame: dict[object, object]) -> None:
        match node:
            case ir.Assign(target=ir.Signal(index=index), value=value) if index is not None:
                self.outputs[int(self.value(index, frame))] = bool(self.value(value, frame))
            case ir.Assign(target=target, value=value):
                done = self.value(value, frame)
                place, key = self.place(target, frame)
                place[key] = done
            case ir.CallRoutine(name=name, arguments=arguments):
                modes = [parameter.mode for parameter in self.routines[name].parameters]
                given: list[object] = [
                    self.place(a.value, frame) if mode == "reference" else self.value(a.value, frame)
                    for a, mode in zip(arguments, modes, strict=True)
                    if a.value is not None
                ]
                self.call(name, given)
            case ir.Return(value=value):
                raise _Return(None if value is None else self.value(value, frame))
            case ir.ExitLoop():
                raise _Exit
            case _:
                self.block(node, frame)

    def block(self, node: ir.Statement, frame: dict[object, object]) -> None:
        match node:
            case ir.If(branches=branches, otherwise=otherwise):
                chosen = next((body for condition, body in branches if self.value(condition, frame)), otherwise)
                self.body(chosen, frame)
            case ir.Switch(selector=selector, cases=cases, default=default):
                value = self.value(selector, frame)
                found = [case.body for case in cases if any(self.value(v, frame) == value for v in case.values)]
                self.body(found[0] if found else default or (), frame)
            case ir.For(counter=counter, start=start, stop=stop, step=step, body=body):
                place, key = self.place(ir.Name(counter), frame)
                last, by = self.value(stop, frame), 1 if step is None else self.value(step, frame)
                place[key] = self.value(start, frame)
                while place[key] <= last if by > 0 else place[key] >= last:  # type: ignore[operator]
                    self.body(body, frame)
                    place[key] += by  # type: ignore[operator]
            case ir.While(condition=condition, body=body):
                while self.value(condition, frame):
                    self.body(body, frame)
            case ir.Repeat(until=until, body=body):
                self.body(body, frame)
                while not self.value(until, frame):
                    self.body(body, frame)
            case ir.Loop(body=body):
                try:
                    while True:
                        self.body(body, frame)
                except _Exit:
                    return
            case _:
                raise AssertionError(node)

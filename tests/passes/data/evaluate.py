"""A small evaluator of routines without motion: what numbers a program computes, before and after a pass."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Any

from rpl import ir
from rpl.passes import rigid
from rpl.passes.scope import ProgramScope, Scope
from rpl.passes.typewords import component_names, component_type, word_type
from rpl.passes.typing import type_of
from rpl.passes.values import Member, Target, binary, component, composed, converted, pose_of, pure, unary

ZERO: dict[type, Any] = {
    ir.IntType: 0,
    ir.RealType: 0.0,
    ir.BoolType: False,
    ir.StringType: "",
    ir.VectorType: rigid.Vector(0.0, 0.0, 0.0),
    ir.RotationType: rigid.NO_TURN,
    ir.PoseType: rigid.IDENTITY,
}


class ReturnedError(Exception):
    def __init__(self, value: Any) -> None:
        self.value = value


class LeftError(Exception):
    pass


class Evaluator:
    def __init__(self, program: ir.Program) -> None:
        self.scopes = ProgramScope(program)
        self.globals: dict[str, Any] = {}
        self.routines = {routine.name.lower(): (module, routine) for module, routine in self.scopes.routines()}
        for module in program.modules:
            scope = self.scopes.module(module)
            for one in module.declarations:
                if isinstance(one, ir.Variable):
                    self.globals[one.name.lower()] = Frame(self, scope, {}).initial(one)
            for one in module.declarations:
                if isinstance(one, ir.Initialise):
                    Frame(self, scope, {}).run((one.assign,))

    def call(self, name: str, arguments: list[Any]) -> Any:
        module, routine = self.routines[name.lower()]
        scope = self.scopes.routine(module, routine)
        frame = Frame(self, scope, {})
        for parameter, value in zip(routine.parameters, arguments, strict=True):
            frame.local[parameter.name.lower()] = fitted(value, scope.resolve(parameter.type))
        for one in routine.declarations:
            if isinstance(one, ir.Variable):
                frame.local[one.name.lower()] = frame.initial(one)
        try:
            frame.run(routine.body)
        except ReturnedError as done:
            return done.value
        self.last = frame.local
        return None


def fitted(value: Any, type: ir.Type) -> Any:
    if isinstance(type, ir.IntType) and isinstance(value, float):
        return converted("round_half_away", value)
    if isinstance(type, ir.RealType) and isinstance(value, int) and not isinstance(value, bool):
        return float(value)
    if isinstance(type, ir.PoseType) and isinstance(value, Target):
        return value.pose
    return value


class Frame:
    def __init__(self, whole: Evaluator, scope: Scope, local: dict[str, Any]) -> None:
        self.whole, self.scope, self.local = whole, scope, local

    def initial(self, variable: ir.Variable) -> Any:
        type = self.scope.resolve(variable.type)
        if variable.initial is not None:
            return self.value(variable.initial, type)
        return self.zero(type)

    def zero(self, type: ir.Type) -> Any:
        match type:
            case ir.TargetType():
                return Target(type, rigid.IDENTITY, (), ())
            case ir.ArrayType(element=element, dimensions=(first, *rest)):
                inner = ir.ArrayType(element, tuple(rest)) if rest else self.scope.resolve(element)
                return [self.zero(inner) for _ in range(int(self.value(first)))] if first is not None else []
            case ir.NamedType(name=name):
                record = self.scope.type(name)
                if not isinstance(record, ir.RecordDeclaration):
                    return None
                return {field.lower(): self.zero(self.scope.resolve(inner)) for field, inner in record.fields}
        return ZERO[type.__class__]

    def run(self, body: ir.Body) -> None:
        for statement in body:
            self.statement(statement)

    def statement(self, statement: ir.Statement) -> None:
        match statement:
            case ir.Assign(target=ir.System()):
                return None  # how the controller moves is not the matter here
            case ir.Assign(target=target, value=value):
                type = type_of(target, self.scope)
                assert type is not None, target
                if isinstance(value, ir.Aggregate) and isinstance(type, ir.PoseType | ir.TargetType | ir.NamedType):
                    return self.partly(target, value, type)
                self.store(target, fitted(self.value(value, type), type))
            case ir.If(branches=branches, otherwise=otherwise):
                for condition, body in branches:
                    if self.value(condition):
                        return self.run(body)
                self.run(otherwise)
            case ir.Switch(selector=selector, cases=cases, default=default):
                chosen = self.value(selector)
                for case in cases:
                    if chosen in [self.value(one) for one in case.values]:
                        return self.run(case.body)
                self.run(default or ())
            case ir.For():
                self.counting(statement)
            case ir.While(condition=condition, body=body):
                while self.value(condition):
                    self.run(body)
            case ir.Loop(body=body):
                try:
                    while True:
                        self.run(body)
                except LeftError:
                    return None
            case ir.ExitLoop():
                raise LeftError
            case ir.Return(value=value):
                routine = self.scope.routine_here
                type = self.scope.resolve(routine.returns) if routine and routine.returns else None
                done = None if value is None else self.value(value, type)
                raise ReturnedError(done if type is None else fitted(done, type))
            case ir.CallRoutine(name=name, arguments=arguments):
                self.called(name, arguments)
            case ir.Nothing():
                pass
            case _:
                raise AssertionError(statement)
        return None

    def partly(self, target: ir.Expression, value: ir.Aggregate, type: ir.Type) -> None:
        """Components that are left out keep their values."""
        new = self.value(target)
        names = component_names(type, self.scope)
        whole = {name for name, _ in value.entries}
        if isinstance(type, ir.PoseType | ir.TargetType) and whole >= {"a", "b", "c"}:
            new = rigid.IDENTITY if isinstance(type, ir.PoseType) else new
        for at, (name, one) in enumerate(value.entries):
            key = (name or names[at]).lower()
            inner = component_type(type, key, self.scope)
            done = self.value(one, inner)
            if isinstance(done, dict) and isinstance(new, dict):
                done = {**new[key], **done}
            if not isinstance(type, ir.TargetType) or key in ("trans", "rot", "x", "y", "z", "a", "b", "c"):
                new = changed(new, key, done if inner is None else fitted(done, inner))
        self.store(target, new)

    def counting(self, loop: ir.For) -> None:
        at, stop = self.value(loop.start), self.value(loop.stop)
        step = 1 if loop.step is None else self.value(loop.step)
        outer = self.scope
        if loop.scoped:
            self.scope = outer.with_value(ir.Variable(loop.counter, ir.RealType()))
        while (at <= stop) if step > 0 else (at >= stop):
            self.local[loop.counter.lower()] = at
            self.run(loop.body)
            at += step
        self.scope = outer
        self.local[loop.counter.lower()] = at

    def called(self, name: str, arguments: tuple[ir.Argument, ...]) -> Any:
        _, routine = self.whole.routines[name.lower()]
        values = []
        for parameter, argument in zip(routine.parameters, arguments, strict=True):
            assert argument.value is not None
            values.append(self.value(argument.value, self.scope.resolve(parameter.type)))
        return self.whole.call(name, values)

    def store(self, target: ir.Expression, value: Any) -> None:
        match target:
            case ir.Name(id=name):
                (self.local if name.lower() in self.local else self.whole.globals)[name.lower()] = value
            case ir.Index(base=base, indices=indices):
                whole = [*self.value(base)]
                inner: Any = whole
                for index in indices[:-1]:
                    inner = inner[self.value(index) - 1]
                place = self.value(indices[-1])
                assert isinstance(place, int) or float(place).is_integer(), f"index {place}"
                inner[int(place) - 1] = value
                self.store(base, whole)
            case ir.Field(base=base, name=name):
                self.store(base, changed(self.value(base), name.lower(), value))
            case _:
                raise AssertionError(target)

    def value(self, expression: ir.Expression, wanted: ir.Type | None = None) -> Any:
        match expression:
            case ir.Name(id=name):
                found = self.local.get(name.lower())
                return self.whole.globals[name.lower()] if found is None else found
            case ir.Index(base=base, indices=indices):
                found = self.value(base)
                for index in indices:
                    found = found[int(self.value(index)) - 1]
                return found
            case ir.Field(base=base, name=name):
                whole = self.value(base)
                return whole[name.lower()] if isinstance(whole, dict) else component(whole, name)
            case ir.Call(name=name, arguments=arguments):
                return self.called(name, arguments)
            case ir.Binary(op=op, left=left, right=right):
                one, other = self.value(left), self.value(right)
                if op == "div" and isinstance(one, float):
                    return float(math.trunc(one / other))
                return binary(op, one, other)
            case ir.Unary(op=op, operand=operand):
                return unary(op, self.value(operand))
            case ir.Convert(how=how, operand=operand):
                return converted(how, self.value(operand))
            case ir.Builtin(function=function, arguments=arguments):
                values = [self.value(one, self.hint(function, at)) for at, one in enumerate(arguments)]
                return pure(function, values, len(values))
            case ir.Aggregate():
                return self.aggregate(expression, wanted)
            case ir.IntLiteral() | ir.RealLiteral() | ir.BoolLiteral() | ir.TextLiteral():
                return expression.value
            case ir.EnumLiteral(member=member):
                return Member(member.lower())
        raise AssertionError(expression)

    def hint(self, function: str, at: int) -> ir.Type | None:
        kinds = ir.FUNCTIONS[function].parameters.replace("?", "")
        return {"v": ir.VectorType(), "r": ir.RotationType()}.get(kinds[at]) if at < len(kinds) else None

    def aggregate(self, expression: ir.Aggregate, wanted: ir.Type | None) -> Any:
        type = word_type(expression.type_name, self.scope) if expression.type_name else wanted
        if type is None or isinstance(type, ir.ArrayType):
            inner = self.scope.resolve(type.element) if isinstance(type, ir.ArrayType) else None
            return [self.value(one, inner) for _, one in expression.entries]
        names = component_names(type, self.scope)
        parts = {(name or names[at]).lower(): self.value(one) for at, (name, one) in enumerate(expression.entries)}
        if isinstance(type, ir.NamedType):
            return parts
        return composed(type, parts)


def changed(whole: Any, name: str, value: Any) -> Any:
    """The value with one component changed."""
    match whole:
        case dict():
            return {**whole, name: value}
        case rigid.Vector():
            return replace(whole, **{name: float(value)})
        case rigid.Rotation():
            angles = dict(zip("abc", whole.zyx, strict=True)) | {name: float(value)}
            return rigid.rotation_of_zyx(*angles.values())
        case rigid.Pose():
            if name in ("trans", "x", "y", "z"):
                return replace(whole, position=value if name == "trans" else changed(whole.position, name, value))
            return replace(whole, rotation=value if name == "rot" else changed(whole.rotation, name, value))
        case Target():
            if name in ("trans", "rot", "x", "y", "z", "a", "b", "c"):
                return replace(whole, pose=changed(whole.pose, name, value))
            return replace(whole, flags=(*((n, v) for n, v in whole.flags if n != name), (name, value)))
    raise AssertionError(whole)


def results(program: ir.Program, name: str = "t") -> dict[str, Any]:
    """The numbers of the routine's variables and the module's data after a run."""
    machine = Evaluator(program)
    machine.call(name, [])
    found: dict[str, Any] = {}
    for key, value in {**machine.globals, **machine.last}.items():
        pose = pose_of(value) if not isinstance(value, dict | list) else None
        found[key] = value if pose is None else [entry for row in pose.matrix for entry in row]
    return found

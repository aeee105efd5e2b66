"""Poses with x, y, z, a, b, c as nested positions and quaternions, for targets that have those (RAPID).

`p.a := v` becomes `p.rot := rotation_zyx(v, ...)` with the other two angles kept; angles assigned in a row become
one rotation. What is a FRAME in one place and a POS in another gets the conversions that a strictly typed target needs.
"""

from __future__ import annotations

from dataclasses import replace

from rpl import ir
from rpl.ir.columns import as_float
from rpl.passes import rigid
from rpl.passes.fold import lasting, literal, real
from rpl.passes.legalise.context import Context
from rpl.passes.legalise.facts.usage import base_name
from rpl.passes.legalise.rewriting.wanted import WantedRewriter
from rpl.passes.rewrite import rewrite_parts
from rpl.passes.typewords import type_word
from rpl.passes.values import Target, Value

_POSITION, _ANGLES = ("x", "y", "z"), ir.ANGLES
_AXES, _EXTERNAL = tuple(ir.COMPONENTS[ir.AxesType]), tuple(ir.COMPONENTS[ir.ExternalType])
_EULER = {"a": "euler_z", "b": "euler_y", "c": "euler_x"}
_UNUSED = ir.RealLiteral(9e9, "9E9")
_POSES = (ir.PoseType, ir.TargetType)


def to_quaternions(program: ir.Program, context: Context) -> ir.Program:
    """The program with nested positions and quaternions."""
    worker = _ToQuaternions(program, context)
    worker.look()
    return worker.program()


class _ToQuaternions(WantedRewriter):
    def __init__(self, program: ir.Program, context: Context) -> None:
        super().__init__(program, context)
        self.used_external: set[str] = set()

    def look(self) -> None:
        """Which external axes exist: a fact about the whole program."""

        def expression(one: ir.Expression) -> ir.Expression:
            match one:
                case ir.Field(name=name):
                    self.used_external.update({name} & set(_EXTERNAL))
                case ir.Aggregate(entries=entries):
                    self.used_external.update(n for n, v in entries if n in _EXTERNAL and n and not _is_zero(v))
            return rewrite_parts(one, expression)

        def body(statements: ir.Body) -> ir.Body:
            return tuple(rewrite_parts(one, expression, body) for one in statements)

        rewrite_parts(self.source, expression, body)

    # ---- statements

    def body(self, body: ir.Body) -> ir.Body:
        return super().body(self.joined(body))

    def joined(self, body: ir.Body) -> ir.Body:
        """Angles of one pose assigned in a row as one rotation."""
        done: list[ir.Statement] = []
        at = 0
        while at < len(body):
            run = self.run(body, at)
            if len(run) < 2:
                done.append(body[at])
                at += 1
                continue
            first = body[at]
            place = next(iter(run.values())).target
            assert isinstance(place, ir.Field)  # as `run` found it
            rot = ir.Field(place.base, "rot")
            angles = tuple(run[name].value if name in run else ir.Builtin(_EULER[name], (rot,)) for name in _ANGLES)
            done.append(ir.Assign(rot, ir.Builtin("rotation_zyx", angles), origin=first.origin))
            at += len(run)
        return tuple(done)

    def run(self, body: ir.Body, start: int) -> dict[str, ir.Assign]:
        found: dict[str, ir.Assign] = {}
        base: ir.Expression | None = None
        for statement in body[start : start + 3]:
            match statement:
                case ir.Assign(target=ir.Field(base=place, name=name), value=value) if (
                    name in _ANGLES and name not in found and (base is None or place == base)
                ):
                    if not isinstance(place, ir.Name | ir.Index | ir.Field) or not self.is_a(place, *_POSES):
                        return found
                    if _reads(value, place) or (found and statement.origin.comments):
                        return found
                    base = place
                    found[name] = statement
                case _:
                    return found
        return found

    def statement(self, statement: ir.Statement) -> list[ir.Statement]:
        match statement:
            case ir.Move(target=target, via=via) if statement.relative is None:
                bare = replace(statement, target=ir.IntLiteral(0), via=None)
                done = rewrite_parts(bare, self.expression, self.actions)
                place = self.destination(target)
                return [replace(done, target=place, via=None if via is None else self.destination(via))]
        return super().statement(statement)

    def assignment(self, statement: ir.Assign) -> list[ir.Statement]:
        target, value = statement.target, statement.value
        match target:
            case ir.Field(base=base, name=name) if name in _ANGLES and self.is_a(base, *_POSES):
                rot = ir.Field(self.lvalue(base), "rot")
                new = self.expression(value)
                angles = tuple(new if one == name else ir.Builtin(_EULER[one], (rot,)) for one in _ANGLES)
                return [replace(statement, target=rot, value=ir.Builtin("rotation_zyx", angles))]
        type = self.type_of(target)
        place = self.expression(target)
        if isinstance(type, ir.TargetType) and self.is_a(value, ir.PoseType):
            pose = self.lvalue(value)
            return [ir.Assign(ir.Field(place, name), ir.Field(pose, name)) for name in ("trans", "rot")]
        return [replace(statement, target=place, value=self.valued(value, type))]

    def destination(self, target: ir.Expression) -> ir.Expression:
        """Where a move goes: a target or joints; what is left out stays as the robot is now."""
        type = self.type_of(target)
        if isinstance(target, ir.Aggregate) and isinstance(type, ir.JointsType | ir.TargetType | ir.PoseType):
            given = {name for name, _ in target.entries}
            needed = _AXES if isinstance(type, ir.JointsType) else (*_POSITION, *_ANGLES)
            if None not in given and not {"trans", "rot", "robax"} & given and not set(needed) <= given:
                return self.now_except(target, isinstance(type, ir.JointsType))
        if isinstance(type, ir.PoseType):
            pose = self.lvalue(target)
            name = self.kept(ir.Builtin("current_target", ()), ir.TargetType(self.context.capabilities.places.notation))
            self.before.extend(ir.Assign(ir.Field(name, part), ir.Field(pose, part)) for part in ("trans", "rot"))
            return name
        return self.expression(target)

    def now_except(self, target: ir.Aggregate, joints: bool) -> ir.Expression:
        if joints:
            name = self.kept(ir.Builtin("current_joints", ()), ir.JointsType())
        else:
            name = self.kept(ir.Builtin("current_target", ()), ir.TargetType(self.context.capabilities.places.notation))
        angles = {written: self.expression(value) for written, value in target.entries if written in _ANGLES}
        for written, value in target.entries:
            if written is not None and written not in _ANGLES:
                self.before.append(ir.Assign(_component(name, written), self.expression(value)))
        if angles:
            rot = ir.Field(name, "rot")
            three = tuple(angles.get(one) or ir.Builtin(_EULER[one], (rot,)) for one in _ANGLES)
            self.before.append(ir.Assign(rot, ir.Builtin("rotation_zyx", three)))
        return name

    # ---- expressions

    def lvalue(self, base: ir.Expression) -> ir.Expression:
        """A base whose components can be named; a computed value gets a variable first."""
        done = self.expression(base)
        if isinstance(done, ir.Name | ir.Index | ir.Field):
            return done
        type = self.type_of(base)
        return self.kept(done, type if type is not None else ir.PoseType())

    def valued(self, value: ir.Expression, wanted: ir.Type | None) -> ir.Expression:
        """The value as its place needs it: poses and targets are not assigned to each other."""
        match wanted:
            case ir.PoseType() if self.is_a(value, ir.TargetType):
                return self.pose(value)
            case ir.TargetType() if self.is_a(value, ir.PoseType):
                pose = self.lvalue(value)
                return self.target({"trans": ir.Field(pose, "trans"), "rot": ir.Field(pose, "rot")}, wanted)
        return super().valued(value, wanted)

    def pose(self, value: ir.Expression) -> ir.Expression:
        """The pose of a target (or of what is a pose already)."""
        if self.is_a(value, ir.PoseType):
            return self.expression(value)
        known = lasting(value, self.scope) if isinstance(value, ir.Aggregate) else None
        if isinstance(known, Target):
            return self.literal(known.pose)
        base = self.lvalue(value)
        return ir.Aggregate(
            (("trans", ir.Field(base, "trans")), ("rot", ir.Field(base, "rot"))), type_name="pose", origin=value.origin
        )

    def literal(self, value: Value) -> ir.Expression:
        made = literal(value)
        return made if made is not None else ir.IntLiteral(0)

    def expression(self, expression: ir.Expression) -> ir.Expression:
        match expression:
            case ir.Field(base=base, name=name) if self.is_a(base, *_POSES) and name in _ANGLES:
                return ir.Builtin(_EULER[name], (ir.Field(self.lvalue(base), "rot"),), origin=expression.origin)
            case ir.Field(base=base, name=name):
                if self.is_a(base, *_POSES, ir.JointsType):
                    return replace(_component(self.lvalue(base), name), origin=expression.origin)
                return replace(expression, base=self.lvalue(base))
            case ir.Aggregate():
                return self.aggregated(expression)
            case ir.Call(name=name, arguments=arguments):
                return replace(expression, arguments=self.arguments(name, arguments))
            case ir.Binary(op=":", left=left, right=right):
                return self.composed(expression, left, right)
            case ir.Builtin(function="inverse", arguments=(one,)):
                return replace(expression, arguments=(self.pose(one),))
            case ir.Builtin(function="target_to_joints_near" as name, arguments=(place, _, *frames)) if (
                name not in self.context.capabilities.functions and self.is_a(place, ir.TargetType)
            ):  # the target's own configuration chooses first
                solved = (self.expression(place), *map(self.expression, frames))
                return ir.Builtin("target_to_joints", solved, origin=expression.origin)
            case ir.System(name="null_frame" | "world" as name) if self.lacks(name):
                return self.literal(rigid.IDENTITY)
            case ir.System(name="actual_pose") if self.lacks("actual_pose"):
                return ir.Builtin("current_target", (), origin=expression.origin)
            case ir.System(name="actual_joints") if self.lacks("actual_joints"):
                return ir.Builtin("current_joints", (), origin=expression.origin)
            case ir.System(name="actual_joint", indices=(ir.IntLiteral(value=axis),)) if self.lacks("actual_joint"):
                joints = self.kept(ir.Builtin("current_joints", ()), ir.JointsType())
                return _component(joints, f"j{axis}")
        return super().expression(expression)

    def lacks(self, name: str) -> bool:
        return name not in self.context.capabilities.system_variables

    def composed(self, expression: ir.Binary, left: ir.Expression, right: ir.Expression) -> ir.Expression:
        if not self.is_a(left, *_POSES):
            return super().expression(expression)
        product = ir.Builtin("compose", (self.pose(left), self.pose(right)), origin=expression.origin)
        if not self.is_a(right, ir.TargetType):
            return product
        pose, type = self.kept(product, ir.PoseType()), self.type_of(right)
        name = self.kept(self.expression(right), type if type is not None else ir.PoseType())
        self.before.extend(ir.Assign(ir.Field(name, part), ir.Field(pose, part)) for part in ("trans", "rot"))
        return name

    def arguments(self, name: str, given: tuple[ir.Argument, ...]) -> tuple[ir.Argument, ...]:
        routine = self.scope.routine(name)
        parameters = routine.parameters if routine else ()
        done = []
        for at, argument in enumerate(given):
            parameter = parameters[at] if at < len(parameters) and argument.name is None else None
            value = argument.value
            if value is None or parameter is None or parameter.mode == "reference":
                done.append(rewrite_parts(argument, self.expression))
            else:
                done.append(replace(argument, value=self.valued(value, self.scope.resolve(parameter.type))))
        return tuple(done)

    # ---- aggregates

    def aggregated(self, expression: ir.Aggregate) -> ir.Expression:
        type = self.type_of(expression)
        given = {name: value for name, value in expression.entries if name is not None}
        if len(given) != len(expression.entries):
            return super().expression(expression)
        match type:
            case ir.PoseType():
                entries = (("trans", self.position(given)), ("rot", self.rotation(given)))
                return ir.Aggregate(entries, type_name="pose", origin=expression.origin)
            case ir.TargetType():
                return replace(self.target(given, type), origin=expression.origin)
            case ir.JointsType():
                axes = given.get("robax")
                robax = self.expression(axes) if axes is not None else self.group(given, _AXES, "axes")
                joints = (("robax", robax), ("ext", self.external(given)))
                return ir.Aggregate(joints, type_name=type_word(type), origin=expression.origin)
        return super().expression(expression)

    def target(self, given: dict[str, ir.Expression], type: ir.TargetType) -> ir.Aggregate:
        """A whole target; flags that are left out stay out for the pass that knows configurations."""
        entries = [("trans", self.position(given)), ("rot", self.rotation(given))]
        known = {*_POSITION, *_ANGLES, *_EXTERNAL, "trans", "rot", "ext"}
        entries.extend((name, self.expression(value)) for name, value in given.items() if name not in known)
        entries.append(("ext", self.external(given)))
        return ir.Aggregate(tuple(entries), type_name=type_word(type))

    def position(self, given: dict[str, ir.Expression]) -> ir.Expression:
        return self.expression(given["trans"]) if "trans" in given else self.group(given, _POSITION, "vector")

    def group(self, given: dict[str, ir.Expression], names: tuple[str, ...], word: str) -> ir.Expression:
        zero = ir.IntLiteral(0)
        entries = tuple((name, self.expression(given[name]) if name in given else zero) for name in names)
        return ir.Aggregate(entries, type_name=word)

    def rotation(self, given: dict[str, ir.Expression]) -> ir.Expression:
        if "rot" in given:
            return self.expression(given["rot"])
        angles = tuple(given.get(name) or ir.IntLiteral(0) for name in _ANGLES)
        values = [lasting(angle, self.scope) for angle in angles]
        numbers = [as_float(value) for value in values if isinstance(value, int | float)]
        if len(numbers) < 3:
            return ir.Builtin("rotation_zyx", tuple(map(self.expression, angles)))
        rotation = rigid.rotation_of_zyx(*numbers)
        names = ("q1", "q2", "q3", "q4")
        entries = tuple((name, real(part)) for name, part in zip(names, rotation.quaternion, strict=True))
        return ir.Aggregate(entries, type_name="rotation")

    def external(self, given: dict[str, ir.Expression]) -> ir.Expression:
        """External axes: those that the program never moves do not exist on the robot."""
        if "ext" in given:
            return self.expression(given["ext"])
        entries = []
        for name in _EXTERNAL:
            value = given.get(name)
            used = name in self.used_external
            zero: ir.Expression = ir.IntLiteral(0) if used else _UNUSED
            entries.append((name, zero if value is None or not used else self.expression(value)))
        return ir.Aggregate(tuple(entries), type_name="external")


def _component(base: ir.Expression, name: str) -> ir.Field:
    """A component in its nested place."""
    for group, names in (("trans", _POSITION), ("robax", _AXES), ("ext", _EXTERNAL)):
        if name in names:
            return ir.Field(ir.Field(base, group), name)
    return ir.Field(base, name)


def _is_zero(value: ir.Expression) -> bool:
    if isinstance(value, ir.Unary):
        return _is_zero(value.operand)
    return isinstance(value, ir.IntLiteral | ir.RealLiteral) and (value.value == 0 or abs(value.value) >= 9e8)


def _reads(value: ir.Expression, place: ir.Expression) -> bool:
    """May the value depend on the place?"""
    found, own = False, base_name(place)

    def look(one: ir.Expression) -> ir.Expression:
        nonlocal found
        found = found or isinstance(one, ir.Call) or (isinstance(one, ir.Name) and one.id.lower() == own)
        return rewrite_parts(one, look)

    look(value)
    return found

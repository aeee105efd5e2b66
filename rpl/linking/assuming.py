"""Reading data that has no value, for runs that are asked to go on: it gets one by its type and keeps it.

That is for what outlives a program: module data, registers, taught places. A variable of a routine that is read before
it is set stays a fault, because no controller has a value for it either. The value: zero, FALSE, an empty text, the
first member of an enumeration; of a place to which moves go (see `rpl.passes.roles`) where the arm stands at the start,
in the tool and frame that are in force; of another place zero, as a shift or a frame that nobody has set; of a number
that says which element of an array is meant 1.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Any

from rpl import ir
from rpl.linking.places import writer
from rpl.passes.roles import last_name
from rpl.runtime.assumed import Assumed
from rpl.runtime.code import Read, Ref, Values
from rpl.runtime.faults import ProgramError
from rpl.runtime.values import (
    STRUCTURED,
    Array,
    JointsValue,
    PoseValue,
    Record,
    RotationValue,
    TargetValue,
    Value,
    VectorValue,
    is_unset,
    whole,
)
from rpl.source import Origin

if TYPE_CHECKING:
    from rpl.linking.expressions import Compiler, Place

_SCALARS = (ir.IntType, ir.RealType, ir.BoolType, ir.CharType, ir.StringType)
_PLACES = (ir.TargetType, ir.JointsType, ir.PoseType)
_STRUCTURES = (*_PLACES, ir.VectorType, ir.RotationType, ir.ConfigType, ir.AxesType)


def assuming(compiler: Compiler, expression: ir.Expression, raw: Read, goal: bool = False) -> Read | None:
    """What reads the place and gives it a value where it has none; None where that is not to be. goal: a move goes
    there."""
    root = _root(expression)
    place = compiler.place_of(root.id) if root is not None else None
    if root is None or place is None or isinstance(place, ir.SignalDeclaration):
        return None
    if not (place.is_global or place.is_reference):
        return None
    type = compiler.types.of(expression)
    roles = compiler.linked.roles
    make = _maker(compiler, type, goal or root.id.lower() in roles.goals)
    if isinstance(type, ir.NUMBER_TYPES) and last_name(expression) in roles.indices:
        make = _first
    if type is None or make is None:
        return None
    put = writer(compiler, expression, expression.origin)
    partly = compiler.scope.rules.whole_targets
    origin = expression.origin if expression.origin.source is not None else root.origin
    called, kept = _called(compiler, expression), _kept(place)

    def read(f: Values) -> Value:
        value = raw(f)
        if value is not None and not _lacks(value, partly):
            return value
        if not kept(f):
            if value is None and not goal:
                raise ProgramError("no_value", f"{called(f)} has no value yet")
            return value
        made = filled(value, make(f[0]))
        put(f, made)
        note(f[0], called(f), made, origin)
        return made

    return read


def note(task: Any, name: str, value: Value, origin: Origin) -> None:
    """The task goes on with that value, which nothing has given; a datum is kept once. origin: of the place in the
    statement; where that is not known it is the statement that the task is at."""
    where = origin if origin.source is not None else task.where()
    task.machine.assumed.setdefault(name.lower(), Assumed(name, value, task.name, where))


def _first(task: Any) -> Value:
    return 1


def _root(expression: ir.Expression) -> ir.Name | None:
    while isinstance(expression, ir.Index | ir.Field):
        expression = expression.base
    return expression if isinstance(expression, ir.Name) else None


def _kept(place: Place) -> Callable[[Values], bool]:
    """Does the value outlive the routine? A reference may lead to a variable of a routine."""
    if place.is_global:
        return lambda f: True
    number = place.number

    def led(f: Values) -> bool:
        reference = f[number]
        local = isinstance(reference, Ref) and bool(reference.store) and reference.store[0] is f[0]
        return reference is not None and not local

    return led


def _lacks(value: Value, partly: bool) -> bool:
    """Has a structure no value? partly: where a component alone may be missing."""
    if value.__class__ not in STRUCTURED or value.__class__ in (Record, Array):
        return False
    if is_unset(value):
        return True
    match value:
        case TargetValue(pose=pose) | (PoseValue() as pose):
            return partly and None in (*pose.trans, *pose.rot.parts)
    return False


def filled(value: Value, default: Value) -> Value:
    """The value with the default's components where it has none."""
    match value, default:
        case TargetValue(), TargetValue():
            conf = default.conf if is_unset(value.conf) else value.conf
            return TargetValue(filled(value.pose, default.pose), conf, value.ext)
        case PoseValue(), PoseValue():
            return PoseValue(filled(value.trans, default.trans), filled(value.rot, default.rot))
        case VectorValue(), VectorValue():
            return VectorValue(*(new if old is None else old for old, new in zip(value, default, strict=True)))
        case RotationValue(convention=convention), RotationValue() if default.convention == convention:
            pairs = zip(value.parts, default.parts, strict=True)
            return RotationValue(convention, tuple(new if old is None else old for old, new in pairs))
        case JointsValue(ext=ext), JointsValue():
            return JointsValue(default.axes, ext)
    return default


def _maker(compiler: Compiler, type: ir.Type | None, goal: bool) -> Callable[[Any], Value] | None:
    """What makes the value for a task; None for a type whose data is no single value."""
    types, rules = compiler.types, compiler.scope.rules
    if isinstance(type, _PLACES) and goal:
        zero = types.zero(type)

        def stands(task: Any) -> Value:
            robot = task.robot
            if robot is None or robot.at_start is None:
                return zero
            if isinstance(type, ir.JointsType):
                return robot.joints_as_value(rules, robot.at_start)
            there = robot.target_now(None, None, rules, robot.at_start)
            return there.pose if isinstance(type, ir.PoseType) else there

        return stands
    if isinstance(type, (*_SCALARS, *_STRUCTURES)) or _is_enumeration(compiler, type):
        zero = types.zero(type)
        return (lambda task: zero) if zero is not None else None
    return None


def _is_enumeration(compiler: Compiler, type: ir.Type | None) -> bool:
    return isinstance(type, ir.NamedType) and isinstance(compiler.scope.type(type.name), ir.EnumDeclaration)


def _called(compiler: Compiler, expression: ir.Expression) -> Callable[[Values], str]:
    """How the program calls the place, with the numbers of elements."""
    match expression:
        case ir.Index(base=base, indices=indices):
            outer, reads = _called(compiler, base), [compiler.value(index) for index in indices]
            return lambda f: f"{outer(f)}[{','.join(str(whole(read(f))) for read in reads)}]"
        case ir.Field(base=base, name=name):
            outer = _called(compiler, base)
            return lambda f: f"{outer(f)}.{name}"
        case ir.Name(id=name):
            return lambda f: name
    return lambda f: "?"


__all__ = ["assuming", "filled"]

"""Poses, joints, lists, records, signals and system variables as URScript values, and their parts as places."""

from __future__ import annotations

import re
from collections.abc import Callable

from rpl import ir
from rpl.passes import rigid
from rpl.passes.fold import constant_number, lasting, lasting_number
from rpl.passes.scope import Scope
from rpl.passes.typewords import word_type
from rpl.passes.values import Target
from rpl.writing.precedence import Printed
from rpl.writing.statements import CannotSayError

from . import spelling, tables
from .saying import Saying

_POSES = (ir.PoseType, ir.TargetType, ir.VectorType, ir.RotationType)
_ZERO = ir.RealLiteral(0.0)
_UNUSED = 9e8  # an external axis that does not exist stands at 9E9
_REGISTER = re.compile(r"((?:input|output)_(?:boolean|integer|float)_register|port_bit|port_register)_(\d+)")
_INTERFACES = {"digital_in": "digital", "digital_out": "digital", "analog_in": "analog", "analog_out": "analog"}


class Places:
    """Structured values of one scope. `three` writes the three components of a rotation as the function that gives
    them all, where they are that."""

    def __init__(self, expressions: Saying, three: Callable[[ir.Aggregate], str | None]) -> None:
        self.expressions, self.three = expressions, three

    def refuse(self, reason: str) -> Exception:
        return CannotSayError(reason)

    def value(self, expression: ir.Expression) -> str | Printed:
        match expression:
            case ir.Index():
                return self.index(expression)
            case ir.Field(base=ir.System(name="load"), name="mass"):
                return "get_target_payload()"
            case ir.Field(base=ir.System(name="load"), name="cog"):
                return "get_target_payload_cog()"
            case ir.Field(base=base, name=name):
                found = self.component(base, name)
                if found is None:
                    return f"{self.base(base)}.{name}"
                return self.read(*found)
            case ir.Aggregate():
                return self.aggregate(expression)
            case ir.Signal():
                return self.signal(expression)
            case ir.System(name=name):
                return self.system(name, expression.indices)
        raise self.refuse("there is no such value")

    def base(self, base: ir.Expression) -> str:
        """What a component or element is taken of."""
        return self.expressions.atom(base)

    # ---- elements and components

    def index(self, expression: ir.Index) -> str:
        """An element. A matrix is asked for row and column; an array of more dimensions, or of anything else than
        numbers, is one list that its indices count through."""
        base, indices = expression.base, expression.indices
        if isinstance(base, ir.Index) and len(self.dimensions(base.base)) > 1:
            return self.index(ir.Index(base.base, (*base.indices, *indices)))
        type = self.expressions.type(base)
        if isinstance(type, ir.StringType):
            return f"str_at({self.expressions.text(base)}, {self.expressions.text(_less(indices[0], 1))})"
        if not isinstance(type, ir.ArrayType):
            return f"{self.base(base)}[{self.expressions.listed(indices)}]"
        shifted = [_less(index, type.base) for index in indices]
        if len(type.dimensions) == 1 or is_matrix(type, self.expressions.scope):
            return f"{self.base(base)}[{self.expressions.listed(tuple(shifted))}]"
        if len(indices) != len(type.dimensions):
            raise self.refuse("a part of an array of several dimensions")
        flat = shifted[0]
        for at, index in enumerate(shifted[1:], 1):
            bound = type.dimensions[at]
            if bound is None:
                raise self.refuse("an array of several dimensions whose size is not known here")
            flat = _plus(_times(flat, _less(bound, type.base - 1)), index)
        return f"{self.base(base)}[{self.expressions.text(flat)}]"

    def dimensions(self, array: ir.Expression) -> tuple[ir.Expression | None, ...]:
        type = self.expressions.type(array)
        return type.dimensions if isinstance(type, ir.ArrayType) else ()

    def component(self, base: ir.Expression, name: str) -> tuple[str, str] | None:
        """How a component of a pose or of joints is read, and its unit; None for a field of a record."""
        type = self.expressions.type(base)
        match type:
            case ir.JointsType() | ir.AxesType():
                if name not in tables.AXES:
                    raise self.refuse("the controller has no external axes")
                return f"{self.base(base)}[{tables.AXES.index(name)}]", "rad"
            case ir.PoseType() | ir.TargetType() | ir.VectorType() | ir.RotationType():
                if name in tables.PLACES:
                    return f"{self.base(base)}[{tables.PLACES[name]}]", "m"
                if name in tables.EULER:
                    angle = str(tables.EULER[name])
                    return self.expressions.helper("rpl_angle", self.expressions.text(base), angle), "deg"
                raise self.refuse(f"a pose has no component {name} of its own")
            case ir.ToolType() if name == "frame" and base == ir.Builtin("current_tool", ()):
                return "get_tcp_offset()", ""
        return None

    def read(self, text: str, unit: str) -> str | Printed:
        """A component in the neutral unit."""
        if unit == "m":
            return Printed(f"{text} * 1000.0", tables.PRODUCT)
        return f"r2d({text})" if unit == "rad" else text

    # ---- structured values

    def constant(self, expression: ir.Expression) -> str | None:
        """The pose that an expression always is, whatever is taught anew."""
        value = lasting(expression, self.expressions.scope)
        if isinstance(value, Target):
            value = value.pose
        return spelling.pose_text(value) if isinstance(value, rigid.Pose) else None

    def aggregate(self, aggregate: ir.Aggregate) -> str | Printed:
        scope = self.expressions.scope
        type = word_type(aggregate.type_name, scope) if aggregate.type_name else None
        named = {name: value for name, value in aggregate.entries if name is not None}
        match type:
            case ir.PoseType() | ir.TargetType() | ir.VectorType() | ir.RotationType():
                known = self.constant(aggregate)
                self.no_external(named)
                return known if known is not None else self.pose(named)
            case ir.JointsType() | ir.AxesType():
                self.no_external(named)
                return self.joints(named)
        if named and len(named) == len(aggregate.entries):
            fields = ", ".join(f"{name}={self.expressions.given(value)}" for name, value in named.items())
            return f"struct({fields})"
        if named:
            raise self.refuse("a value with some components named and some not")
        whole = self.three(aggregate)
        return whole if whole is not None else f"[{', '.join(self.items(aggregate))}]"

    def items(self, aggregate: ir.Aggregate) -> list[str]:
        """The elements of a list in order."""
        return [self.expressions.given(value) for _, value in aggregate.entries]

    def no_external(self, named: dict[str, ir.Expression]) -> None:
        """External axes may be given where they stand still at zero or do not exist."""
        for name in tables.EXTERNAL:
            value = named.get(name)
            if value is None:
                continue
            number = constant_number(value, self.expressions.scope)
            if number is None or (number != 0 and abs(number) < _UNUSED):
                raise self.refuse("the controller has no external axes")

    def pose(self, named: dict[str, ir.Expression]) -> str:
        """A pose of computed components."""
        if {"trans", "rot"} & set(named):
            raise self.refuse("a pose whose position and rotation are values of their own")
        values = {name: named.get(name, _ZERO) for name in ir.POSE}
        angles = [lasting_number(values[name], self.expressions.scope) for name in ir.ANGLES]
        if any(angle is None for angle in angles):
            return self.expressions.helper("rpl_pose", *(self.expressions.text(values[name]) for name in ir.POSE))
        turn = spelling.rotation_vector(rigid.rotation_of_zyx(*(angle or 0.0 for angle in angles)))
        place = [self.expressions.measured(values[name], "m") for name in ("x", "y", "z")]
        numbers = [short(one) for one in place]
        return f"p[{', '.join((*numbers, *(spelling.plain_text(v, spelling.RADIAN_PLACES) for v in turn)))}]"

    def joints(self, named: dict[str, ir.Expression]) -> str:
        shown = []
        for axis in tables.AXES:
            value = named.get(axis)
            if value is None:
                raise self.refuse(f"the axis {axis} is not given")
            number = lasting_number(value, self.expressions.scope)
            shown.append(
                spelling.radians(number, point=True) if number is not None else self.expressions.measured(value, "rad")
            )
        return f"[{', '.join(shown)}]"

    # ---- signals and system variables

    def declared(self, name: str) -> ir.Signal | None:
        """The signal that a name is declared for."""
        symbol = self.expressions.scope.value(name)
        if symbol is None or not isinstance(symbol.declaration, ir.SignalDeclaration):
            return None
        return symbol.declaration.signal

    def numbered(self, signal: ir.Signal) -> ir.Signal:
        """A signal by its number, where it is declared."""
        found = self.declared(signal.name) if signal.name is not None and signal.index is None else None
        return signal if found is None else found

    def flag(self, index: ir.Expression) -> str:
        """An internal signal's number, counted from 0."""
        number = constant_number(index, self.expressions.scope)
        if number is not None and not 1 <= number <= tables.FLAGS:
            raise self.refuse(f"the controller has {tables.FLAGS} flags, no flag {number:g}")
        return self.expressions.text(_less(index, 1))

    def signal(self, signal: ir.Signal) -> str | Printed:
        """The value of a signal."""
        signal = self.numbered(signal)
        if signal.index is None and signal.name is not None:
            return f"{self.register(signal, 'read')})"
        if signal.kind in ("group_in", "group_out") or signal.last is not None:
            first, last = self.group(signal)
            helper = "rpl_group_in" if signal.kind.endswith("_in") else "rpl_group_out"
            return self.expressions.helper(helper, first, last)
        if signal.index is None:
            raise self.refuse("a signal without a number")
        if signal.kind == "flag":
            return f"get_flag({self.flag(signal.index)})"
        interface = _INTERFACES.get(signal.kind)
        if interface is None:
            raise self.refuse(f"there is no signal of kind {signal.kind.replace('_', ' ')}")
        way = signal.kind.rpartition("_")[2]
        number = constant_number(signal.index, self.expressions.scope)
        if number is None:
            if interface == "analog":
                raise self.refuse("an analog signal by a computed number")
            return self.expressions.helper(f"rpl_digital_{way}", self.expressions.text(signal.index))
        where, at = self.interface(interface, int(number), signal.index)
        if where in tables.REGISTERS:
            return f"read_{way}put_{where}_register({at})"
        if (where, interface, way) == ("tool", "analog", "out"):
            raise self.refuse("the tool has no analog output")
        return f"get_{where}_{interface}_{way}({at})"

    def register(self, signal: ir.Signal, way: str) -> str:
        """The call that reads or writes a register of the fieldbus or of RTDE, up to its number."""
        found = _REGISTER.fullmatch(signal.name or "")
        if found is None:
            raise self.refuse(f"signals have numbers; {signal.name} has none")
        return f"{way}_{found[1]}({found[2]}"

    def interface(self, interface: str, number: int, index: ir.Expression | None = None) -> tuple[str, str]:
        """The controller's interface that a signal belongs to, and the signal's number there (from 0), by the name of
        the data that holds it where the index has one."""
        table = tables.DIGITAL if interface == "digital" else tables.ANALOG
        for first, last, where in table:
            if first <= number <= last:
                match index:
                    case ir.Binary(op="+", left=ir.Name() as data, right=ir.IntLiteral(value=more)) if more == first:
                        return where, self.expressions.text(data)
                return where, str(number - first)
        raise self.refuse(f"the controller has no {interface} signal {number}, only {table[0][0]} to {table[-1][1]}")

    def group(self, signal: ir.Signal) -> tuple[str, str]:
        if signal.index is None or signal.last is None:
            raise self.refuse("a group of signals without its first and last number")
        for bound in (signal.index, signal.last):
            number = constant_number(bound, self.expressions.scope)
            if number is not None:
                self.interface("digital", int(number))
        return self.expressions.text(signal.index), self.expressions.text(signal.last)

    def output(self, signal: ir.Signal, value: ir.Expression) -> str:
        """Switching an output."""
        signal, text = self.numbered(signal), self.expressions.text(value)
        if signal.index is None:
            return f"{self.register(signal, 'write')}, {text})"
        if signal.kind == "group_out" or (signal.last is not None and signal.kind == "digital_out"):
            first, last = self.group(signal)
            return self.expressions.helper("rpl_set_group_out", first, last, text)
        if signal.kind == "flag":
            return f"set_flag({self.flag(signal.index)}, {text})"
        if signal.kind not in ("digital_out", "analog_out"):
            raise self.refuse("this signal cannot be written")
        interface = _INTERFACES[signal.kind]
        number = constant_number(signal.index, self.expressions.scope)
        if number is None:
            if interface == "analog":
                raise self.refuse("an analog signal by a computed number")
            return self.expressions.helper("rpl_set_digital_out", self.expressions.text(signal.index), text)
        where, at = self.interface(interface, int(number), signal.index)
        if where == "tool" and interface == "analog":
            raise self.refuse("the tool has no analog output")
        if where in tables.REGISTERS:
            return f"write_output_{where}_register({at}, {text})"
        return f"set_{where}_{interface}_out({at}, {text})"

    def system(self, name: str, indices: tuple[ir.Expression, ...]) -> str | Printed:
        match name, indices:
            case "null_frame" | "world", ():
                return "p[0, 0, 0, 0, 0, 0]"
            case "actual_pose", ():
                return "get_actual_tcp_pose()"
            case "actual_joints", ():
                return "get_actual_joint_positions()"
            case "moving", ():
                return Printed("not is_steady()", tables.NOT)
            case "time", ():
                return Printed("time().sec + time().nanosec / 1000000000", tables.SUM)
            case "step_time", ():
                return "get_steptime()"
            case "actual_joint", (ir.IntLiteral(value=axis),) if 1 <= axis <= 6:
                return f"r2d(get_actual_joint_positions()[{axis - 1}])"
            case "tool", ():
                return "get_tcp_offset()"
            case "flag", (number,):
                return f"get_flag({self.flag(number)})"
        raise self.refuse(f"there is no system variable for {name.replace('_', ' ')}")


def is_matrix(type: ir.ArrayType, scope: Scope) -> bool:
    """Is it written as rows of numbers?"""
    return len(type.dimensions) == 2 and isinstance(scope.resolve(type.element), ir.NUMBER_TYPES)


def _less(index: ir.Expression, by: int) -> ir.Expression:
    if by == 0:
        return index
    match index:
        case ir.IntLiteral(value=number):
            return ir.IntLiteral(number - by)
        case ir.Binary(op="+", left=left, right=ir.IntLiteral(value=number)) if number == by:
            return left  # an index that a pass has shifted to arrays from one
    return ir.Binary("-", index, ir.IntLiteral(by))


def _times(one: ir.Expression, other: ir.Expression) -> ir.Expression:
    if isinstance(one, ir.IntLiteral) and isinstance(other, ir.IntLiteral):
        return ir.IntLiteral(one.value * other.value)
    return ir.Binary("*", one, other)


def _plus(one: ir.Expression, other: ir.Expression) -> ir.Expression:
    if isinstance(one, ir.IntLiteral) and isinstance(other, ir.IntLiteral):
        return ir.IntLiteral(one.value + other.value)
    return ir.Binary("+", one, other)


def short(text: str) -> str:
    """Inside of a pose a whole number needs no point."""
    return text.removesuffix(".0") if text.endswith(".0") and " " not in text and "(" not in text else text

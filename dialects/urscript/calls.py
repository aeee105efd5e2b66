"""Calls that give a value: own functions, and the controller's functions in neutral words."""

from __future__ import annotations

from collections.abc import Callable

from rpl import ir

from . import nodes
from .arguments import Bound, given, written
from .bits import BITS
from .expressions import BUILTINS, Expressions, time_part
from .functions import RESULTS, BindError, Builtin, bind
from .kinds import INT, REAL, Kind, is_joints, is_number
from .levels import level
from .nodes import Expr
from .rules import FIRST_REGISTER, FIRST_SIGNAL, LEGACY_ANALOG, LEGACY_DIGITAL, POSE_DIST_COUNTS_ANGLE
from .scopes import Function
from .texts import TEXTS, as_text, one_more

Make = Callable[["Calls", Bound], ir.Expression | None]


class Calls(Expressions):
    """Adds calls to expressions."""

    def call(self, expression: nodes.Apply, wanted: Kind | None) -> ir.Expression:
        """The value of a call."""
        if expression.base is not None:
            return self.text_of(expression, wanted)
        if expression.name == "struct":
            return self.struct(expression)
        function = self.project.function(expression.name, self.here)
        if function is not None:
            return ir.Call(function.name, self.own_arguments(expression, function))
        builtin = BUILTINS.get(expression.name)
        if builtin is None:
            given = tuple(ir.Argument(self.value(value), name) for name, value in expression.arguments)
            return ir.Call(expression.name, given)
        make = VALUES.get(expression.name)
        if builtin.effect or make is None:
            return self.text_of(expression, wanted)
        try:
            bound = bind(builtin, expression.arguments)
        except BindError as error:
            return self.refused(expression, str(error), wanted)
        made = make(self, bound)
        return made if made is not None else self.refused(expression, "this form has no neutral meaning", wanted)

    def struct(self, expression: nodes.Apply) -> ir.Expression:
        kind = self.kind(expression)
        assert kind is not None and kind.word == "struct"  # infer makes it so
        type = self.type(kind)
        assert isinstance(type, ir.NamedType)  # a struct's type
        entries = [(name or "", self.element_value(value, self.kind(value))) for name, value in expression.arguments]
        return ir.Aggregate(tuple(entries), type.name)

    def own_arguments(self, expression: nodes.Apply, function: Function) -> tuple[ir.Argument, ...]:
        """All arguments in the order of the parameters; a default is written where none is given."""
        names = list(function.parameters)
        given: dict[str, Expr] = {}
        place = 0
        extra: list[ir.Argument] = []
        for name, value in expression.arguments:
            if name is None:
                name = names[place] if place < len(names) else None
                place += 1
            if name in function.parameters:
                given[name] = value
            else:
                extra.append(ir.Argument(self.value(value)))
        done = []
        for name, default in function.node.parameters:
            symbol = function.parameters[name]
            passed = given.get(name, default)
            if passed is None:
                done.append(ir.Argument(None))
            else:
                done.append(ir.Argument(self.stored(passed, symbol.kind, symbol.is_joints)))
        while done and done[-1].value is None:
            done.pop()
        return (*done, *extra)

    # ---- signals

    def signal(self, group: str, direction: str, number: Expr | None) -> ir.Signal:
        """The signal of a function such as get_standard_digital_in."""
        assert number is not None  # the parameter has to be given
        analog = group.endswith("analog")
        kind = ("analog_" if analog else "digital_") + direction
        first = FIRST_SIGNAL[group]
        if isinstance(number, nodes.Number) and isinstance(number.value, int):
            legacy = LEGACY_ANALOG if analog else LEGACY_DIGITAL
            place = legacy.get(number.value) if group in ("analog", "digital") else None
            return ir.Signal(kind, ir.IntLiteral(place if place is not None else number.value + first))
        return ir.Signal(kind, ir.Binary("+", self.value(number, INT), ir.IntLiteral(first)))

    def register(self, name: str, kind: str, address: Expr | None) -> ir.Signal | None:
        """A register of the fieldbus or of RTDE: a signal with a number where it holds a truth or a real number,
        else one with a name, whose number has to be written out. Where a program works out the number of an integer
        register, all of them are numbered, the first one 1."""
        first = FIRST_REGISTER.get(name.partition("_")[2])
        if first is not None and address is not None:
            if isinstance(address, nodes.Number) and isinstance(address.value, int):
                return ir.Signal(kind, ir.IntLiteral(address.value + first))
            return ir.Signal(kind, ir.Binary("+", self.value(address, INT), ir.IntLiteral(first)))
        if self.project.counts_registers and name.endswith("integer_register") and address is not None:
            return ir.Signal(kind, one_more(self.value(address, INT)))
        if not isinstance(address, nodes.Number):
            return None
        return ir.Signal(kind, name=f"{name}_{address.spelling}")

    # ---- geometry

    def rotation_of(self, vector: Expr | None) -> ir.Expression | None:
        """The rotation of a list that is a rotation vector in rad."""
        parts = self.three(vector)
        if parts is None:
            return None
        zeros = [ir.RealLiteral(0.0, "0.0") for _ in range(3)]
        turned = ir.Builtin("pose_from_rotation_vector", (*zeros, *(ir.Quantity(part, "rad") for part in parts)))
        return ir.Field(turned, "rot")

    def three(self, vector: Expr | None) -> list[ir.Expression] | None:
        if vector is None:
            return None
        parts = [self.element(vector, place) for place in range(3)]
        found = [part for part in parts if part is not None]
        return found if len(found) == 3 else None

    def pose(self, expression: Expr | None) -> ir.Expression:
        """A pose; joints in its place mean where the arm would be."""
        assert expression is not None  # the parameter has to be given
        if is_joints(self.kind(expression)):
            return ir.Builtin("pose_of", (ir.Builtin("joints_to_target", (self.joints(expression),)),))
        return self.value(expression)


def _of_angle(function: str) -> Make:
    """sin, cos, tan of radians."""
    return lambda calls, bound: ir.Builtin(function, (ir.Quantity(given(calls, bound, "f"), "rad"),))


def _angle(function: str, *names: str) -> Make:
    """An angle in radians."""
    return lambda calls, bound: ir.Magnitude(
        ir.Builtin(function, tuple(given(calls, bound, name) for name in names)), "rad"
    )


def _plain(function: str, *names: str) -> Make:
    return lambda calls, bound: ir.Builtin(function, tuple(given(calls, bound, name) for name in names))


def _reading(group: str, direction: str) -> Make:
    return lambda calls, bound: calls.signal(group, direction, bound["n"])


def _output_level(calls: Calls, bound: Bound) -> ir.Expression | None:
    return level(calls, "get_standard_analog_out", "standard_analog", bound["n"])


def _register(name: str, kind: str) -> Make:
    return lambda calls, bound: calls.register(name, kind, bound["address"])


def _here(tool: bool) -> Make:
    """Where the tool centre point is, or the flange."""
    arguments = () if tool else (ir.Builtin("pose_from_rotation_vector", (ir.RealLiteral(0.0, "0.0"),) * 6),)
    return lambda calls, bound: ir.Builtin("pose_of", (ir.Builtin("current_target", arguments),))


def _forward(calls: Calls, bound: Bound) -> ir.Expression:
    joints, tool = bound["q"], bound["tcp"]
    more = (calls.value(tool),) if tool is not None else ()
    if joints is None:
        return ir.Builtin("pose_of", (ir.Builtin("current_target", more),))
    return ir.Builtin("pose_of", (ir.Builtin("joints_to_target", (calls.joints(joints), *more)),))


def _inverse(function: str) -> Make:
    def make(calls: Calls, bound: Bound) -> ir.Expression:
        target = bound["x"] if "x" in bound else bound["pose"]
        near, tool = bound["qnear"], bound["tcp"]
        more = (calls.value(tool),) if tool is not None else ()
        if near is None and function == "target_to_joints_near":
            return ir.Builtin("target_to_joints", (calls.pose(target), *more))
        reference = ir.Builtin("current_joints", ()) if near is None else calls.joints(near)
        return ir.Builtin(function, (calls.pose(target), reference, *more))

    return make


def _within(calls: Calls, bound: Bound) -> ir.Expression:
    """is_within_safety_limits. M: what the arm can reach is within its limits; others are not known here."""
    place = written(bound, "pose")
    if is_joints(calls.kind(place)):
        joints = calls.joints(place)
        return ir.Builtin("is_reachable", (calls.pose(place), joints))
    near = bound["qnear"]
    return ir.Builtin("is_reachable", (calls.pose(place), calls.joints(near) if near else ir.Builtin(*_HERE)))


_HERE = ("current_joints", ())


def _centre(calls: Calls, bound: Bound) -> ir.Expression:
    """The centre of gravity of the load, in metres."""
    centre = ir.Field(ir.System("load"), "cog")
    return ir.Aggregate(tuple((None, ir.Magnitude(ir.Field(centre, axis), "m")) for axis in "xyz"))


def _pose_add(calls: Calls, bound: Bound) -> ir.Expression:
    return ir.Builtin("pose_sum", (calls.pose(bound["p_1"]), calls.pose(bound["p_2"])))


def _pose_sub(calls: Calls, bound: Bound) -> ir.Expression:
    return ir.Builtin("pose_difference", (calls.pose(bound["p_to"]), calls.pose(bound["p_from"])))


def _distance(angles: bool) -> Make:
    def make(calls: Calls, bound: Bound) -> ir.Expression:
        one, other = calls.pose(bound["p_from"]), calls.pose(bound["p_to"])
        way = ir.Magnitude(ir.Builtin("distance", (ir.Field(one, "trans"), ir.Field(other, "trans"))), "m")
        if not angles:
            return way
        turn = ir.Magnitude(ir.Builtin("rotation_angle", (one, other)), "rad")
        return ir.Builtin("sqrt", (ir.Binary("+", _squared(way), _squared(turn)),))

    return make


def _squared(value: ir.Expression) -> ir.Expression:
    return ir.Binary("**", value, ir.IntLiteral(2))


def _to_angles(calls: Calls, bound: Bound) -> ir.Expression | None:
    """rotvec2rpy: roll, pitch, yaw of Rz(yaw) Ry(pitch) Rx(roll)."""
    rotation = calls.rotation_of(bound["rotation_vector"])
    if rotation is None:
        return None
    parts = [ir.Magnitude(ir.Builtin(f"euler_{axis}", (rotation,)), "rad") for axis in "xyz"]
    return ir.Aggregate(tuple((None, part) for part in parts))


def _to_vector(calls: Calls, bound: Bound) -> ir.Expression | None:
    parts = calls.three(bound["rpy_vector"])
    if parts is None:
        return None
    roll, pitch, yaw = (ir.Quantity(part, "rad") for part in parts)
    rotation = ir.Builtin("rotation_zyx", (yaw, pitch, roll))
    found = [ir.Magnitude(ir.Builtin(f"rotation_vector_{axis}", (rotation,)), "rad") for axis in "xyz"]
    return ir.Aggregate(tuple((None, part) for part in found))


def _log(calls: Calls, bound: Bound) -> ir.Expression:
    base, value = given(calls, bound, "b"), given(calls, bound, "f")
    return ir.Binary("/", ir.Builtin("log", (value,)), ir.Builtin("log", (base,)))


def _norm(calls: Calls, bound: Bound) -> ir.Expression | None:
    """Of a number its size, of a list its length as a vector."""
    value = bound["a"]
    assert value is not None  # it has to be given
    kind = calls.kind(value)
    if kind is None or is_number(kind):
        return ir.Builtin("abs", (calls.value(value, REAL),))
    count = 6 if kind.word == "pose" else kind.length
    if kind.word not in ("list", "pose") or count is None or not 0 < count <= 12:
        return None
    parts = [calls.element(value, place) for place in range(count)]
    total: ir.Expression | None = None
    for part in parts:
        if part is None:
            return None
        total = _squared(part) if total is None else ir.Binary("+", total, _squared(part))
    return ir.Builtin("sqrt", (total,)) if total is not None else None


def _normalized(calls: Calls, bound: Bound) -> ir.Expression | None:
    """A list as a vector of length 1."""
    value = written(bound, "v")
    kind = calls.kind(value)
    length = _norm(calls, {"a": value}) if kind is not None and kind.word == "list" else None
    if kind is None or kind.length is None or length is None:
        return None
    size = calls.kept_apart(length, REAL)
    parts = [calls.element(value, place) for place in range(kind.length)]
    return ir.Aggregate(tuple((None, ir.Binary("/", part, size)) for part in parts if part is not None))


def _length(calls: Calls, bound: Bound) -> ir.Expression | None:
    value = bound["v"]
    assert value is not None  # it has to be given
    kind = calls.kind(value)
    if kind is not None and kind.word == "pose":
        return ir.IntLiteral(6)
    if kind is not None and kind.word == "list" and kind.length is not None:
        return ir.IntLiteral(kind.length)
    if kind is not None and kind.word == "text":
        return ir.Builtin("text_length", (calls.value(value),))
    return ir.Builtin("length", (calls.array(value),))


def _time(calls: Calls, bound: Bound) -> ir.Expression | None:
    """The time since the controller began, in whole seconds and billionths; the time of day is only its own."""
    kind = RESULTS["s"]
    type = calls.type(kind)
    if bound["mode"] != nodes.Number(0, "0") or not isinstance(type, ir.NamedType):
        return None
    parts = (("sec", time_part("sec")), ("nanosec", time_part("nanosec")))
    return ir.Aggregate(parts, type.name)


VALUES: dict[str, Make] = {
    **{
        f"get_{group}_{direction}": _reading(group, direction)
        for group in FIRST_SIGNAL
        for direction in ("in", "out")
        if f"get_{group}_{direction}" in BUILTINS
    },
    "get_analog_out": lambda calls, bound: level(calls, "get_analog_out", "analog", bound["n"]),
    "get_standard_analog_out": _output_level,
    "get_flag": lambda calls, bound: ir.Signal("flag", one_more(given(calls, bound, "n", INT))),
    **{
        f"read_{way}_{word}_register": _register(f"{way}_{word}_register", f"{kind}_{way[:-3]}")
        for way in ("input", "output")
        for word, kind in (("boolean", "digital"), ("integer", "group"), ("float", "analog"))
    },
    "read_port_bit": _register("port_bit", "digital_in"),
    "read_port_register": _register("port_register", "group_in"),
    **dict.fromkeys(("get_actual_tcp_pose", "get_target_tcp_pose"), _here(True)),
    **dict.fromkeys(("get_actual_tool_flange_pose", "get_target_tool_flange_pose"), _here(False)),
    **dict.fromkeys(
        ("get_actual_joint_positions", "get_joint_positions", "get_target_joint_positions"),
        lambda calls, bound: ir.Builtin("current_joints", ()),
    ),
    "get_tcp_offset": lambda calls, bound: ir.System("tool"),
    "get_forward_kin": _forward,
    "get_inverse_kin": _inverse("target_to_joints_near"),
    "get_inverse_kin_has_solution": _inverse("is_reachable"),
    "get_target_payload": lambda calls, bound: ir.Field(ir.System("load"), "mass"),
    "get_target_payload_cog": _centre,
    "is_within_safety_limits": _within,
    "is_steady": lambda calls, bound: ir.Unary("not", ir.System("moving")),
    "get_steptime": lambda calls, bound: ir.System("step_time"),
    "time": _time,
    "pose_trans": lambda calls, bound: ir.Binary(":", calls.pose(bound["p_from"]), calls.pose(bound["p_from_to"])),
    "pose_inv": lambda calls, bound: ir.Builtin("inverse", (calls.pose(bound["p_from"]),)),
    "pose_add": _pose_add,
    "pose_sub": _pose_sub,
    "pose_dist": _distance(POSE_DIST_COUNTS_ANGLE),
    "point_dist": _distance(False),
    "interpolate_pose": lambda calls, bound: ir.Builtin(
        "interpolate_pose", (calls.pose(bound["p_from"]), calls.pose(bound["p_to"]), given(calls, bound, "alpha"))
    ),
    "rotvec2rpy": _to_angles,
    "rpy2rotvec": _to_vector,
    "d2r": lambda calls, bound: ir.Magnitude(given(calls, bound, "d"), "rad"),
    "r2d": lambda calls, bound: ir.Quantity(given(calls, bound, "r"), "rad"),
    **{name: _of_angle(name) for name in ("sin", "cos", "tan")},
    **{name: _angle(name, "f") for name in ("asin", "acos", "atan")},
    "atan2": _angle("atan2", "x", "y"),  # the manual names them so; the first is the height
    "sqrt": _plain("sqrt", "f"),
    "pow": _plain("power", "base", "exponent"),
    "log": _log,
    "floor": _plain("floor", "f"),
    "ceil": _plain("ceil", "f"),
    "norm": _norm,
    "normalize": _normalized,
    "random": _plain("random"),
    "length": _length,
    "get_list_length": _length,
    **BITS,
    **TEXTS,
}

__all__ = ["VALUES", "Builtin", "Calls", "as_text", "one_more"]

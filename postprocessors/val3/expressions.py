"""IR expressions as VAL3. What VAL3 cannot say raises CannotSayError, and the statement around it is guarded."""

from __future__ import annotations

from collections.abc import Callable, Mapping

from rpl import ir
from rpl.passes import rigid
from rpl.passes.fold import constant
from rpl.passes.scope import Scope
from rpl.passes.typing import type_of
from rpl.writing.numbers import scaled
from rpl.writing.precedence import ExpressionPrinter, Printed
from rpl.writing.statements import CannotSayError
from rpl.writing.text import number_text, quoted

from . import tables
from .data import Store

NULL = ir.System("null_frame")
_STANDS = ir.Unary("not", ir.System("moving"))
ZERO = "{0,0,0,0,0,0}"
_ESCAPES = {"\\": "\\\\", '"': '\\"', "\n": " "}


class _Printer(ExpressionPrinter):
    """VAL3 asks whether the robot stands, not whether it moves."""

    def printed(self, expression: ir.Expression) -> Printed:
        return Printed("isSettled()") if expression == _STANDS else super().printed(expression)


class Expressions:
    """Prints the expressions of one scope. `roles`: variables of poses that are tools or frames; `fathers`: points and
    the frames they hang on."""

    def __init__(self, scope: Scope, store: Store, roles: Mapping[str, str], fathers: Mapping[str, str]) -> None:
        self.scope, self.store, self.roles, self.fathers = scope, store, roles, fathers
        self.printer = _Printer(tables.OPERATORS, self._hook)
        self.around: tuple[str, str] | None = None  # tool and frame of the movement whose places are printed

    def text(self, expression: ir.Expression) -> str:
        return self.printer.text(expression)

    def type(self, expression: ir.Expression) -> ir.Type | None:
        return type_of(expression, self.scope)

    def listed(self, values: tuple[ir.Expression, ...]) -> str:
        return ",".join(self.text(value) for value in values)

    # ---- leaves

    def _hook(self, expression: ir.Expression, printer: ExpressionPrinter) -> str | Printed:
        match expression:
            case ir.IntLiteral(value=number):
                return str(number)
            case ir.RealLiteral(value=real):
                return number_text(real, None, tables.NUMBERS)
            case ir.BoolLiteral(value=truth):
                return "true" if truth else "false"
            case ir.TextLiteral(value=text):
                return quoted(text, '"', _ESCAPES)
            case ir.Name(id=name):
                return self.name(name)
            case ir.Index(base=base) if isinstance(self.type(base), ir.ArrayType):
                hangs = self.is_point(expression) or root_of(base) in self.roles
                return self.storage(expression) + (".trsf" if hangs else "")
            case ir.Field():
                return self.component(expression)
            case ir.Signal(kind=kind, name=name) if name is not None and not kind.startswith("group"):
                return self.signal(expression)
            case ir.Aggregate():
                return self.aggregate(expression)
            case ir.System(name=name):
                return self.system(name)
            case ir.Builtin():
                return self.builtin(expression)
            case ir.Binary(op="div", left=left, right=right):
                return f"trunc({self.text(ir.Binary('/', left, right))})"
            case ir.Convert(how=how, operand=operand):
                return self.converted(how, operand)
            case ir.Quantity(value=value, unit=unit):
                return printer.printed(scaled(value, ir.UNITS[unit]))
            case ir.Magnitude(value=value, unit=unit):
                return printer.printed(scaled(value, 1.0 / ir.UNITS[unit]))
        raise CannotSayError(f"there is no {expression.__class__.__name__}")

    def name(self, name: str) -> str:
        self.known(name)
        symbol = self.scope.value(name)
        declared = symbol.declaration if symbol is not None else None
        if isinstance(declared, ir.SignalDeclaration):
            return self.text(declared.signal)
        hangs = name in self.roles or isinstance(symbol.type if symbol is not None else None, ir.TargetType)
        return f"{name}.trsf" if hangs else name

    def known(self, name: str) -> None:
        if name in self.store.lost or self.scope.value(name) is None:
            raise CannotSayError(f"{name}, which cannot be declared")

    def storage(self, place: ir.Expression) -> str:
        """A variable or element itself, whatever it is."""
        match place:
            case ir.Name(id=name):
                self.known(name)
                return name
            case ir.Index(base=ir.Index(base=base, indices=outer), indices=inner):
                return self.storage(ir.Index(base, (*outer, *inner)))
            case ir.Index(base=base, indices=indices):
                return f"{self.storage(base)}[{self.listed(indices)}]"
        raise CannotSayError("a value that stands in no variable")

    def signal(self, signal: ir.Signal) -> str:
        name = signal.name or ""
        symbol = self.scope.value(name)
        if symbol is not None and isinstance(symbol.type, ir.SignalType):
            return name  # a parameter
        text = self.store.signal(name, signal.kind)
        return text if signal.kind.startswith("digital") else f"aioGet({text})"

    def component(self, field: ir.Field) -> str:
        base, name = field.base, field.name
        match self.type(base):
            case ir.JointsType() if name in tables.JOINTS:
                return f"{self.storage(base)}.{name}"
            case ir.TargetType() if name in "xyz":
                return f"{self.storage(base)}.trsf.{name}"
            case ir.TargetType() if name in tables.FLAGS:
                return f"{self.storage(base)}.config.{name}"
            case ir.PoseType() if name in "xyz" and isinstance(base, ir.Name | ir.Index):
                return f"{self.text(base)}.{name}"
        raise CannotSayError(f"the component {name} of this value")

    def aggregate(self, value: ir.Aggregate) -> str:
        """A pose or joints in braces; a point is data of its own."""
        known = {name or "": part for name, part in value.entries}
        match self.type(value):
            case ir.JointsType():
                return "{" + ",".join(self.text(known.get(name, ir.IntLiteral(0))) for name in tables.JOINTS) + "}"
            case ir.PoseType():
                return self.pose(known)
            case ir.TargetType():
                return self.pose({name: part for name, part in known.items() if name not in tables.FLAGS})
        raise CannotSayError("a list of values")

    def pose(self, parts: Mapping[str, ir.Expression]) -> str:
        place = [self.text(parts.get(name, ir.IntLiteral(0))) for name in "xyz"]
        angles = [parts.get(name, ir.IntLiteral(0)) for name in "abc"]
        numbers = [constant(angle, self.scope) for angle in angles]
        if all(isinstance(number, int | float) for number in numbers):
            turned = xyz_angles(*(float(number) for number in numbers if isinstance(number, int | float)))
            return "{" + ",".join((*place, *(number_text(a, 10, tables.NUMBERS) for a in turned))) + "}"
        a, b, c = (self.text(angle) for angle in angles)
        return f"{{{','.join(place)},0,0,{a}}}*{{0,0,0,0,{b},0}}*{{0,0,0,{c},0,0}}"

    def taught(self, value: ir.Aggregate, father: str = "world") -> str:
        """A point that is written out: data with its numbers."""
        return self.store.once("pPoint", "pointRx", point_row(value, self.scope), father)

    def system(self, name: str) -> str | Printed:
        match name:
            case "null_frame" | "world":
                return ZERO
            case "time":
                return "clock()"
            case "actual_pose" if self.around is not None:
                return f"position({self.point(ir.System(name))},{self.around[1]})"
            case "override":
                return "getMonitorSpeed()"
            case "moving":
                return Printed("!isSettled()", tables.SIGN)
        raise CannotSayError(f"there is no {name.replace('_', ' ')}")

    def converted(self, how: str, operand: ir.Expression) -> str | Printed:
        match how:
            case "real":
                return self.printer.printed(operand)
            case "trunc":
                return f"trunc({self.text(operand)})"
            case "round_half_away":
                return f"round({self.text(operand)})"
            case "floor":
                return f"roundDown({self.text(operand)})"
            case "bit":
                return f"sel({self.text(operand)},1,0)"
            case "truth":
                return self.printer.printed(ir.Binary("<>", operand, ir.IntLiteral(0)))
        raise CannotSayError(f"there is no conversion {how}")

    # ---- functions

    def builtin(self, call: ir.Builtin) -> str | Printed:
        name, values = call.function, call.arguments
        if name in tables.FUNCTIONS:
            return f"{tables.FUNCTIONS[name]}({self.listed(values)})"
        if name in _ANGLES:
            return self.angle(_ANGLES[name], values[0])
        special = _SPECIAL.get(name)
        if special is not None:
            return special(self, values)
        return self.posed(name, values)

    def angle(self, name: str, rotation: ir.Expression) -> Printed:
        """rx, ry, rz are the angles of the turn back with the other sign, which is how the reader puts them."""
        match rotation:
            case ir.Field(base=ir.Builtin(function="inverse", arguments=(place,)), name="rot"):
                inner = place.arguments[0] if isinstance(place, ir.Builtin) and place.function == "pose_of" else place
                if isinstance(inner, ir.Name | ir.Index):
                    return Printed(f"-{self.text(inner)}.{name}", tables.SIGN)
        raise CannotSayError("an angle of a place about an axis of its frame")

    def posed(self, name: str, values: tuple[ir.Expression, ...]) -> str | Printed:
        """Functions of poses."""
        match name, values:
            case "inverse", (pose,):
                return Printed(f"!{self.printer.text(pose, tables.SIGN)}", tables.SIGN)
            case "compose", (one, other):
                return self.printer.printed(ir.Binary(":", one, other))
            case "pose_of", (value,):
                return self.printer.printed(value)
            case "current_target", () if self.around is not None:
                return f"position({self.point(ir.Builtin(name, values))},{self.around[1]})"
            case "current_target", (_, frame):
                return f"position({self.point(ir.Builtin(name, values))},{self.frame(frame)})"
            case "joints_to_target", (_, _, frame):
                return f"position({self.point(ir.Builtin(name, values))},{self.frame(frame)})"
            case "tool_offset", (pose, *parts):
                shift = "{" + ",".join([*map(self.text, parts), *["0"] * (6 - len(parts))]) + "}"
                if pose == NULL:
                    return shift
                return f"{self.printer.text(pose, tables.SIGN)}*{shift}"
            case "displaced_in_tool", (pose, shift):
                return self.printer.printed(ir.Binary(":", pose, shift))
            case "displaced", (pose, shift):
                return self.printer.printed(ir.Binary(":", shift, pose))
            case "offset", (pose, x, y, z):
                return f"{{{self.listed((x, y, z))},0,0,0}}*{self.printer.text(pose, tables.SIGN)}"
            case "distance", (ir.Field(base=one, name="trans"), ir.Field(base=other, name="trans")):
                return f"distance({self.text(one)},{self.text(other)})"
            case "distance", (one, other) if all(isinstance(self.type(v), ir.PoseType | ir.TargetType) for v in values):
                return f"distance({self.text(one)},{self.text(other)})"
        raise CannotSayError(f"there is no function {name.replace('_', ' ')}")

    # ---- points: what they hang on is part of them

    def is_point(self, value: ir.Expression) -> bool:
        return isinstance(self.type(value), ir.TargetType)

    def father(self, point: ir.Expression) -> str:
        """The name of the frame that a printed point hangs on."""
        match point:
            case ir.Name(id=name):
                return self.fathers.get(name, "world")
            case ir.Index(base=base):
                return self.father(base)
            case ir.Builtin(function="current_target", arguments=()) | ir.System() if self.around is not None:
                return self.around[1]
            case ir.Builtin(function="current_target" | "joints_to_target", arguments=(*_, frame)):
                return self.frame(frame)
            case ir.Builtin(arguments=(first, *_)):
                return self.father(first)
        return "world"

    def point(self, point: ir.Expression) -> str:
        """A point as VAL3 writes one."""
        match point:
            case ir.Name() | ir.Index():
                return self.storage(point)
            case ir.Aggregate():
                return self.taught(point)
            case ir.Builtin(function="current_target", arguments=()) | ir.System(name="actual_pose") if (
                self.around is not None
            ):
                return f"here({','.join(self.around)})"
            case ir.Builtin(function="current_target", arguments=(tool, frame)):
                return f"here({self.tool(tool)},{self.frame(frame)})"
            case ir.Builtin(function="joints_to_target", arguments=(joints, tool, frame)):
                return f"jointToPoint({self.tool(tool)},{self.frame(frame)},{self.text(joints)})"
            case ir.Builtin(function="tool_offset", arguments=(first, *parts)):
                shift = [*map(self.text, parts), *["0"] * (6 - len(parts))]
                return f"appro({self.point(first)},{{{','.join(shift)}}})"
            case ir.Builtin(function="displaced_in_tool", arguments=(first, shift)):
                return f"appro({self.point(first)},{self.text(shift)})"
            case ir.Builtin(function="offset", arguments=(first, x, y, z)):
                return f"compose({self.point(first)},{self.father(first)},{{{self.listed((x, y, z))},0,0,0}})"
            case ir.Builtin(function="displaced", arguments=(first, shift)):
                return f"compose({self.point(first)},{self.father(first)},{self.text(shift)})"
        raise CannotSayError("this point")

    def tool(self, tool: ir.Expression | None) -> str:
        """The name of a tool of this value."""
        return self.hung(tool, "flange", "tool", "tTool")

    def frame(self, frame: ir.Expression | None) -> str:
        """The name of a frame of this value."""
        return self.hung(frame, "world", "frame", "fFrame")

    def hung(self, value: ir.Expression | None, root: str, role: str, wish: str) -> str:
        if value is None or value in (NULL, ir.System("world")):
            return root
        if isinstance(value, ir.Name | ir.Index) and self.roles.get(root_of(value)) == role:
            return self.storage(value)
        known = constant(value, self.scope)
        if isinstance(known, rigid.Pose):
            if known == rigid.IDENTITY:
                return root
            return self.store.once(wish, role, pose_row(known), root)
        raise CannotSayError(f"a {role} that is worked out at the movement")


def root_of(value: ir.Expression) -> str:
    match value:
        case ir.Name(id=name):
            return name
        case ir.Index(base=base):
            return root_of(base)
    return ""


def xyz_angles(a: float, b: float, c: float) -> tuple[float, float, float]:
    """rx, ry, rz (about x, new y, new z) of a turn by a, b, c (about z, new y, new x): the ZYX angles of the turn back,
    with the other sign."""
    if b == 0.0 and c == 0.0:
        return 0.0, 0.0, a
    if a == 0.0 and b == 0.0:
        return c, 0.0, 0.0
    rz, ry, rx = rigid.rotation_of_turns((3, a), (2, b), (1, c)).inverse.zyx
    return rigid.clean(-rx), rigid.clean(-ry), rigid.clean(-rz)


def pose_row(pose: rigid.Pose) -> str:
    """The attributes of a pose in the data."""
    place = pose.position
    numbers = (place.x, place.y, place.z, *xyz_angles(*pose.rotation.zyx))
    return " ".join(
        f'{name}="{number_text(number, 10, tables.NUMBERS)}"'
        for name, number in zip(("x", "y", "z", "rx", "ry", "rz"), numbers, strict=True)
    )


def point_row(value: ir.Aggregate, scope: Scope) -> str:
    """The attributes of a taught point: its pose and configuration."""
    flags = []
    place = ir.Aggregate(tuple(entry for entry in value.entries if entry[0] not in tables.FLAGS), "pose")
    known = constant(place, scope)
    if not isinstance(known, rigid.Pose):
        raise CannotSayError("a point that is not of plain numbers")
    given = dict(value.entries)
    for name, words in tables.FLAGS.items():
        flag = given.get(name)
        if flag is not None and not (isinstance(flag, ir.IntLiteral) and 0 <= flag.value < len(words) - 1):
            raise CannotSayError("a configuration that is worked out")
        flags.append(f'{name}="{words[flag.value + 1 if isinstance(flag, ir.IntLiteral) else 0]}"')
    return f"{pose_row(known)} {' '.join(flags)}"


def _decimals(e: Expressions, values: tuple[ir.Expression, ...], word: str) -> str:
    places = values[1] if len(values) > 1 else ir.IntLiteral(0)
    if not isinstance(places, ir.IntLiteral):
        raise CannotSayError("a computed count of decimals")
    if places.value == 0:
        return f"{word}({e.text(values[0])})"
    scale = 10**places.value
    return f"({word}({e.printer.atom(values[0])}*{scale})/{scale})"


def _before(position: ir.Expression) -> ir.Expression:
    if isinstance(position, ir.IntLiteral):
        return ir.IntLiteral(position.value - 1)
    return ir.Binary("-", position, ir.IntLiteral(1))


def _find(e: Expressions, v: tuple[ir.Expression, ...]) -> Printed:
    if v[1] != ir.IntLiteral(1):
        raise CannotSayError("a search in a text from a place in it")
    return Printed(f"find({e.text(v[0])},{e.text(v[2])})+1", tables.SUM)


def _number_text(e: Expressions, v: tuple[ir.Expression, ...]) -> str:
    if not isinstance(v[1], ir.IntLiteral):
        raise CannotSayError("a computed count of decimals")
    return f'toString(".{v[1].value}",{e.text(v[0])})'


def _value_text(e: Expressions, v: tuple[ir.Expression, ...]) -> str:
    if not isinstance(e.type(v[0]), ir.IntType | ir.RealType):
        raise CannotSayError("a text of a value that is no number")
    return f'toString("",{e.text(v[0])})'


_ANGLES = {"euler_x": "rx", "euler_y": "ry", "euler_z": "rz"}
_SPECIAL: dict[str, Callable[[Expressions, tuple[ir.Expression, ...]], str | Printed]] = {
    "round": lambda e, v: _decimals(e, v, "round"),
    "trunc": lambda e, v: _decimals(e, v, "trunc"),
    "sign": lambda e, v: f"sel({e.text(v[0])}>0,1,sel({e.text(v[0])}<0,-1,0))",
    "text_part": lambda e, v: f"mid({e.text(v[0])},{e.text(v[2])},{e.text(_before(v[1]))})",
    "text_find": _find,
    "character_code": lambda e, v: f"asc({e.text(v[0])},0)",
    "number_text": _number_text,
    "value_text": _value_text,
    "current_joints": lambda e, v: "herej()",
    "task_runs": lambda e, v: Printed(f"taskStatus({e.text(v[0])})>0", tables.ORDER),
}

"""Assignments as TP lines: registers, outputs, timers, position registers whole and element by element."""

from __future__ import annotations

import re
from dataclasses import dataclass

from rpl import ir
from rpl.writing.statements import CannotSayError

from . import tables
from .expressions import Expressions, constant
from .lines import Line
from .positions import Points, flat, position_of
from .texts import number

_NUMBER = re.compile(r"\s*[-+]?(\d+\.?\d*|\.\d+)([eE][-+]?\d+)?\s*")
_POSITIONS = (ir.PoseType, ir.TargetType, ir.JointsType)


@dataclass(slots=True)
class Assignments:
    """Prints assignments of one program."""

    expressions: Expressions
    points: Points
    scratch: int = tables.PR.last  # position register for values that have none
    moved_to: frozenset[int] = frozenset()  # position registers that only moves look at

    def lines(self, assign: ir.Assign) -> list[Line]:
        target, value = assign.target, assign.value
        match target:
            case ir.System():
                return [Line(f"  {self.system(target, value)}")]
            case ir.Signal():
                return [Line(f"  {set_output(target, value, self.expressions)}")]
        place = self.expressions.place(target)
        match value:
            case ir.Field(base=ir.System(name="actual_pose"), name=name):
                read = self.expressions.component(ir.Index(ir.Name("PR"), (ir.IntLiteral(self.scratch),)), name)
                return [Line(f"  PR[{self.scratch}]=LPOS"), Line(f"  {place}={read}")]
            case ir.Builtin(function="text_value", arguments=(ir.TextLiteral(value=written),)) if _NUMBER.fullmatch(
                written
            ) and place.startswith("R["):
                known = constant(ir.RealLiteral(float(written)))
                return [Line(f"  {place}={number(0 if known is None else known)}")]
            case ir.Builtin(function="text_value", arguments=(text,)):
                held = self.expressions.element(text)  # a text stored in a number register becomes its number
                if held is not None and held.startswith(("SR[", "AR[")) and place.startswith("R["):
                    return [Line(f"  {place}={held}")]
        if place.startswith("AR["):
            raise CannotSayError("an argument is not assigned to")
        if place.startswith(("PR[", "P[")) and not isinstance(target, ir.Field):
            return [Line(f"  {one}") for one in self.position(place, value)]
        if place.startswith("F["):
            return [Line(f"  {place}=({self.expressions.mixed(value)})")]
        return [Line(f"  {place}={self.expressions.value(value)}")]

    def system(self, target: ir.System, value: ir.Expression) -> str:
        match target.name, target.indices, value:
            case "override", (), _:
                shown = self.expressions.operand(value)
                if constant(value) is None and not shown.startswith(("R[", "AR[")):
                    raise CannotSayError("OVERRIDE takes a number or a register")
                # Counted: 127 of 127 public lines with a register have no unit, 45 of 45 with a number have one.
                return f"OVERRIDE={shown}" + ("" if constant(value) is None else "%")
            case "timer", (index,), _ if constant(value) == 0:
                return f"{self.expressions.numbered('TIMER', index)}=RESET"
            case "timer", (index,), _:
                shown = self.expressions.value(value)
                place = self.expressions.numbered("TIMER", index)
                return f"{place}={shown}" if shown.startswith("(") else f"{place}=({shown})"
            case "timer_stopped", (index,), ir.BoolLiteral(value=stopped):
                return f"{self.expressions.numbered('TIMER', index)}={'STOP' if stopped else 'START'}"
            case "flag", (index,), _:
                return f"{self.expressions.numbered('F', index)}=({self.expressions.mixed(value)})"
        raise CannotSayError(f"{target.name.replace('_', ' ')} cannot be set like this")

    # ---- position registers

    def position(self, place: str, value: ir.Expression) -> list[str]:
        """The whole of a position register."""
        match value:
            case ir.System(name="actual_pose") | ir.Builtin(function="current_target", arguments=()):
                return [f"{place}=LPOS"]
            case ir.System(name="actual_joints") | ir.Builtin(function="current_joints", arguments=()):
                return [f"{place}=JPOS"]
            case ir.Builtin(function="element_sum" | "element_difference" as how, arguments=(one, other)):
                sign = "+" if how == "element_sum" else "-"
                return [f"{place}={self.sum_of_registers(one)}{sign}{self.operand(other)}"]
            case ir.Builtin(function="offset", arguments=(base, *shift)):
                first = [] if self.same(place, base) else self.position(place, base)
                return [*first, *self.shifted(place, shift)]
            case ir.Builtin(function="pose_of", arguments=(base,)):
                return self.position(place, base)
            case ir.Builtin(function="joints_to_target" | "target_to_joints", arguments=(base,)):
                if self.expressions.limited and self.number(place) not in self.moved_to:
                    raise CannotSayError("the place of joint values and the joints of a place are not calculated")
                return self.position(place, base)
            case ir.System(name="null_frame" | "world"):
                zero = {name: ir.RealLiteral(0.0) for name in ir.POSE}
                return self.taught(place, ir.Aggregate(tuple(zero.items())))
            case ir.Aggregate():
                return self.aggregate(place, value)
            case ir.Index(base=ir.Name(id="UFRAME" | "UTOOL" as table), indices=(ir.IntLiteral(value=number),)):
                return [f"{place}={table}[{number}]"]
            case ir.Index(base=ir.Name(id="UFRAME" | "UTOOL" as table), indices=(index,)):
                return [f"{place}={table}[{self.expressions.index(index)}]"]
            case ir.Index() | ir.Name():
                return [f"{place}={self.register(value)}"]
        raise CannotSayError("TP does not calculate with positions like this")

    def number(self, place: str) -> int:
        """Of a position register; 0 where it is computed."""
        digits = place.partition("[")[2].partition(":")[0].rstrip("]")
        return int(digits) if digits.isdigit() else 0

    def same(self, place: str, base: ir.Expression) -> bool:
        return isinstance(base, ir.Index | ir.Name) and self.expressions.element(base) == place

    def sum_of_registers(self, value: ir.Expression) -> str:
        """`PR[1]+PR[2]-PR[3]`, from left to right; `LPOS-LPOS` is how a register is cleared."""
        match value:
            case ir.Builtin(function="element_sum", arguments=(one, other)):
                return f"{self.sum_of_registers(one)}+{self.operand(other)}"
            case ir.Builtin(function="element_difference", arguments=(one, other)):
                return f"{self.sum_of_registers(one)}-{self.operand(other)}"
        return self.operand(value)

    def operand(self, value: ir.Expression) -> str:
        """A position register, a taught point, or where the robot stands."""
        match value:
            case ir.System(name="actual_pose") | ir.Builtin(function="current_target", arguments=()):
                return "LPOS"
            case ir.System(name="actual_joints") | ir.Builtin(function="current_joints", arguments=()):
                return "JPOS"
        return self.register(value)

    def register(self, value: ir.Expression) -> str:
        shown = self.expressions.element(value)
        if shown is None or not shown.startswith(("PR[", "P[")):
            raise CannotSayError("this is neither a position register nor a point")
        return shown

    def shifted(self, place: str, shift: list[ir.Expression]) -> list[str]:
        done = []
        for element, way in enumerate(shift, 1):
            if constant(way) == 0:
                continue
            at = _element(place, element)
            done.append(f"{at}={self.sum(at, way)}")
        return done

    def sum(self, at: str, way: ir.Expression) -> str:
        value = constant(way)
        if value is not None:
            return f"{at}-{number(-value)}" if value < 0 else f"{at}+{number(value)}"
        simple = self.expressions.simple(way)
        return f"{at}+{simple}" if simple is not None else f"({at}+({self.expressions.mixed(way)}))"

    def aggregate(self, place: str, value: ir.Aggregate) -> list[str]:
        """A constant value goes through a taught point; computed components are filled in behind."""
        parts = flat(value)
        computed = {name: part for name, part in parts.items() if constant(part) is None}
        if not computed:
            return self.taught(place, value)
        names = tables.JOINT_ELEMENTS if "j1" in parts else tables.POSE_ELEMENTS
        if not set(computed) <= set(names) or not set(names[:6]) <= set(parts):
            raise CannotSayError("a position with computed flags or missing components")
        zeros = {name: ir.RealLiteral(0.0) if name in computed else part for name, part in parts.items()}
        lines = self.taught(place, ir.Aggregate(tuple(zeros.items()), type_name=value.type_name))
        for name, part in computed.items():
            lines.append(f"{_element(place, names.index(name) + 1)}={self.expressions.value(part)}")
        return lines

    def taught(self, place: str, value: ir.Expression) -> list[str]:
        point = self.points.add(position_of(value, self.expressions.scope))
        return [f"{place}={self.points.place(point)}"]


def _element(place: str, element: int) -> str:
    """`PR[3:name]` -> `PR[3,1:name]`; `PR[R[2]]` -> `PR[R[2],1]`."""
    inner = place[3:-1]
    if inner[:1].isdigit():
        inner, _, label = inner.partition(":")
        return f"PR[{inner},{element}{':' + label if label else ''}]"
    return f"PR[{inner},{element}]"


def truth(value: ir.Expression, expressions: Expressions) -> str:
    """What an output is set to: ON, OFF, or mixed logic."""
    if isinstance(value, ir.BoolLiteral):
        return "ON" if value.value else "OFF"
    if isinstance(value, ir.Convert) and value.how == "truth":
        shown = expressions.simple(value.operand)
        if shown is not None:
            return shown  # any number but zero is ON
    return f"({expressions.mixed(value)})"


def set_output(signal: ir.Signal, value: ir.Expression, expressions: Expressions) -> str:
    """`DO[1]=ON`, `GO[2]=5`."""
    shown = expressions.signal(signal)
    word = shown.partition("[")[0]
    if word in ("F", "M"):
        return f"{shown}=({expressions.mixed(value)})"
    if word in ("DO", "RO", "SO", "UO", "WO", "WSO", "SEMAPHORE"):
        return f"{shown}={truth(value, expressions)}"
    if word == "GO" and isinstance(value, ir.Convert) and value.how == "trunc":
        value = value.operand  # the controller cuts the number by itself
    if word in ("GO", "AO"):
        return f"{shown}={expressions.value(value)}"
    raise CannotSayError(f"{word} is no output")

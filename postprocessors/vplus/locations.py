"""Transformations and precision points: written out, composed, taken apart.

Constants are folded to TRANS(x, y, z, yaw, pitch, roll). ZYX angles that are calculated become a product of RZ, RY, RX.
What V+ gives only by DECOMPOSE (angles, single joints) asks for that step in front.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from rpl import ir
from rpl.passes import rigid
from rpl.passes.fold import lasting
from rpl.passes.values import Target
from rpl.writing.precedence import Printed
from rpl.writing.statements import CannotSayError

from . import spelling, tables

if TYPE_CHECKING:
    from .expressions import Expressions

_ZERO = ir.IntLiteral(0)
_TURNS = (("a", "RZ"), ("b", "RY"), ("c", "RX"))
_ZYZ = {"zyz_yaw": 3, "zyz_pitch": 4, "zyz_roll": 5}
_SHORT = 9
_LONG_JOINTS = 85  # characters of joints; longer ones are calculated in front


class Locations:
    """Locations of one routine."""

    def __init__(self, expressions: Expressions) -> None:
        self.expressions = expressions

    def refuse(self, reason: str) -> Exception:

        return CannotSayError(reason)

    # ---- written out

    def folded(self, expression: ir.Expression) -> str | None:
        """The transformation that an expression always is, whatever is taught anew."""
        value = lasting(expression, self.expressions.scope)
        if isinstance(value, Target):
            value = value.pose
        return spelling.trans(spelling.components(value)) if isinstance(value, rigid.Pose) else None

    def pose(self, aggregate: ir.Aggregate, named: dict[str, ir.Expression]) -> str | Printed:
        known = self.folded(aggregate)
        if known is not None:
            return known
        if "trans" in named or "rot" in named or not named:
            raise self.refuse("a location whose position and rotation are values of their own")
        place = [self.expressions.text(named.get(axis, _ZERO)) for axis in tables.PLACES]
        angles = {name: self.expressions.known(named.get(name, _ZERO)) for name, _ in _TURNS}
        if None not in angles.values():
            turn = rigid.rotation_of_zyx(*(float(angles[name] or 0.0) for name, _ in _TURNS))
            return spelling.trans([*place, *spelling.components(rigid.Pose(_NOWHERE, turn))[3:]])
        parts = [] if all(one == "0" for one in place) else [spelling.trans(place)]
        for name, word in _TURNS:
            if angles[name] != 0:
                parts.append(f"{word}({self.expressions.text(named[name])})")
        return Printed(":".join(parts), tables.COMPOUND) if len(parts) > 1 else parts[0]

    def joints(self, named: dict[str, ir.Expression]) -> str:
        given = [self.expressions.text(named.get(axis, _ZERO)) for axis in tables.AXES]
        if "robax" in named:
            raise self.refuse("joints whose axes are a value of their own")
        if sum(map(len, given)) > _LONG_JOINTS and self.expressions.notes.steps:
            given = [one if len(one) <= _SHORT else self.expressions.kept(one, "r") for one in given]
        return f"#PPOINT({', '.join(given)})"

    # ---- components

    def component(self, base: ir.Expression, name: str) -> str | Printed:
        """A component of a location or of joints as a number."""
        type = self.expressions.type(base)
        match type:
            case ir.JointsType() | ir.AxesType():
                if name not in tables.AXES:
                    raise self.refuse("there are no external axes")
                return self.decomposed(base, tables.AXES.index(name))
            case ir.PoseType() | ir.TargetType() | ir.VectorType() | ir.RotationType():
                if name in tables.PLACES:
                    return f"D{name.upper()}({self.expressions.text(base)})"
                if name in ir.ANGLES:
                    return self.euler(base, name)
                if name in ("trans", "rot"):
                    return self.expressions.printer.printed(base)
                raise self.refuse(f"a location has no component {name}")
        raise self.refuse("there are no records")

    def decomposed(self, base: ir.Expression, at: int) -> str:
        """One number of a location or of joints, by DECOMPOSE into an array of the program's own."""
        notes = self.expressions.notes
        value = self.expressions.text(base)
        name = notes.parts.get(value)
        if name is None:
            name = notes.temporary("part")
            notes.step(f"DECOMPOSE {name}[0] = {value}")
            notes.autos.append(f"{name}[5]")
            if isinstance(base, ir.Name):
                notes.parts[value] = name
        return f"{name}[{at}]"

    def euler(self, base: ir.Expression, name: str) -> str:
        """An angle about z (a), new y (b) or new x (c), by a program that comes along; inside of a condition from where
        unit vectors along the axes point, which says nothing of a and c where b is 90 or -90."""
        known = self.expressions.known(ir.Field(base, name))
        if known is not None:
            return spelling.number(rigid.clean(known), spelling.PLACES)
        place = self.expressions.printer.text(base, tables.COMPOUND)
        notes = self.expressions.notes
        if len(place) > _SHORT or (notes.steps and not isinstance(base, ir.Name)):
            place = self.expressions.kept(place, "p", "SET ")
        if notes.steps:
            angle = notes.temporary(f"angle.{name}")
            notes.autos.append(angle)
            notes.step(f"CALL rpl.angle({place}, {'abc'.index(name) + 1}, {angle})")
            notes.helpers.add("rpl.angle")
            return angle

        def row(axis: str, along: str) -> str:
            unit = {"x": "1", "y": "0, 1", "z": "0, 0, 1"}[along]
            return f"D{axis}({place}:TRANS({unit}))-D{axis}({place})"

        if name == "a":
            text = f"ATAN2({row('Y', 'x')}, {row('X', 'x')})"
        elif name == "b":
            text = f"ATAN2(-({row('Z', 'x')}), SQRT(SQR({row('Z', 'y')})+SQR({row('Z', 'z')})))"
        else:
            text = f"ATAN2({row('Z', 'y')}, {row('Z', 'z')})"
        return text

    def with_component(self, base: ir.Expression, name: str, value: ir.Expression) -> str:
        """A location or joints with one number changed."""
        if isinstance(self.expressions.type(base), ir.JointsType | ir.AxesType):
            at = tables.AXES.index(name) if name in tables.AXES else -1
            if at < 0:
                raise self.refuse("there are no external axes")
            new = self.expressions.text(value)
            part = self.decomposed(base, 0).partition("[")[0]
            if len(new) > _SHORT and self.expressions.notes.steps:
                self.expressions.notes.step(f"{part}[{at}] = {new}")
                new = f"{part}[{at}]"
            given = [new if one == at else f"{part}[{one}]" for one in range(6)]
            return f"#PPOINT({', '.join(given)})"
        place = self.expressions.text(base)
        if name in tables.PLACES:
            step = self.expressions.text(_change(value, ir.Field(base, name)))
            steps = [step if axis == name else "0" for axis in tables.PLACES]
            while steps[-1] == "0":
                steps.pop()
            return f"SHIFT({place} BY {', '.join(steps)})"
        if name not in ir.ANGLES:
            raise self.refuse(f"the component {name} cannot be set")
        at_place = f"TRANS(DX({place}), DY({place}), DZ({place}))"
        turns = [
            f"{word}({self.expressions.text(value) if one == name else self.euler(base, one)})" for one, word in _TURNS
        ]
        return ":".join((at_place, *turns))

    def composed(self, place: ir.Expression, parts: dict[str, ir.Expression]) -> str:
        """A location whose x, y, z and perhaps a, b, c are all given anew."""
        if len(parts) > len(tables.PLACES):
            shown = self.pose(ir.Aggregate(tuple(parts.items()), "pose"), parts)
            return shown if isinstance(shown, str) else shown.text
        steps = [self.expressions.text(_change(parts[axis], ir.Field(place, axis))) for axis in tables.PLACES]
        return f"SHIFT({self.expressions.text(place)} BY {', '.join(steps)})"

    # ---- functions

    def function(self, call: ir.Builtin) -> str | Printed | None:
        name, values = call.function, call.arguments
        text, atom = self.expressions.text, self.composable
        if name in ("compose", "displaced", "displaced_in_tool", "offset", "tool_offset", "inverse", "pose_of"):
            known = self.folded(call)
            if known is not None:
                return known
        match name, values:
            case "pose_of", (place,):
                return self.expressions.printer.printed(place)
            case "joints_to_target", (place,):  # a precision point has no place in a compound
                return self.expressions.kept(text(place), "p", "SET ")
            case (("compose" | "displaced_in_tool"), (one, other)):
                return Printed(f"{atom(one)}:{self.inner(other)}", tables.COMPOUND)
            case "displaced", (place, by):
                return Printed(f"{atom(by)}:{self.inner(place)}", tables.COMPOUND)
            case "offset", (place, *steps):
                return f"SHIFT({text(place)} BY {', '.join(text(step) for step in steps)})"
            case "tool_offset", (place, *steps):
                return self.in_tool(place, steps)
            case "distance", (one, other):
                return f"DISTANCE({text(one)}, {text(other)})"
            case "pose_zyz", _:
                return spelling.trans([text(value) for value in values])
            case (("zyz_yaw" | "zyz_pitch" | "zyz_roll"), (place,)):
                return self.decomposed(place, _ZYZ[name])
            case "is_reachable", (place, *_):
                return Printed(f"INRANGE({text(place)}) == 0", tables.RELATION)
            case "frame_from_points", (one, two, three):
                return f"FRAME({text(one)}, {text(two)}, {text(three)}, {text(one)})"
            case "frame_from_points", (one, two, three, ir.IntLiteral(value=origin)) if origin in (1, 2):
                return f"FRAME({text(one)}, {text(two)}, {text(three)}, {text(two if origin == 2 else one)})"
        return None

    def in_tool(self, place: ir.Expression, steps: list[ir.Expression]) -> Printed:
        """Moved along its own axes, then turned about x, new y, new z."""
        moved = [self.expressions.text(step) for step in steps[:3]]
        parts = [self.composable(place), spelling.trans(moved)]
        for turn, word in zip(steps[3:], ("RX", "RY", "RZ"), strict=False):
            if self.expressions.known(turn) != 0:
                parts.append(f"{word}({self.expressions.text(turn)})")
        return Printed(":".join(part for part in parts if part != "NULL"), tables.COMPOUND)

    def composable(self, place: ir.Expression) -> str:
        return self.expressions.printer.text(place, tables.COMPOUND)

    def inner(self, place: ir.Expression) -> str:
        return self.expressions.printer.text(place, tables.COMPOUND + 1)


def _change(value: ir.Expression, old: ir.Expression) -> ir.Expression:
    """What is added to a component."""
    match value:
        case ir.Binary(op="+", left=left, right=right) if left == old:
            return right
        case ir.Binary(op="-", left=left, right=right) if left == old:
            return ir.Unary("-", right)
    return ir.Binary("-", value, old)


_NOWHERE = rigid.Vector(0.0, 0.0, 0.0)

"""Geometric functions as URScript: products, offsets, kinematics, and rotations as vectors of three numbers.

A rotation by itself is a list: its rotation vector `[rx, ry, rz]`, or its angles `[roll, pitch, yaw]`, in radians.
"""

from __future__ import annotations

import math

from rpl import ir
from rpl.passes import rigid
from rpl.passes.fold import constant, constant_number
from rpl.writing.precedence import Printed

from . import spelling, tables
from .places import short
from .saying import Saying

_VECTOR = ("rotation_vector_x", "rotation_vector_y", "rotation_vector_z")
_ANGLES = ("euler_x", "euler_y", "euler_z")


class Geometry:
    """Functions of one scope."""

    def __init__(self, expressions: Saying) -> None:
        self.expressions = expressions

    # ---- rotations

    def radians(self, name: str, rotation: ir.Expression) -> str | None:
        """One component of a rotation's vector, or one of its angles, in radians."""
        if name in _VECTOR:
            place = _VECTOR.index(name)
            match rotation:
                case ir.Builtin(function="rotation_zyx", arguments=angles):
                    return f"{self.turned(angles)}[{place}]"
                case ir.Field(base=ir.Builtin(function="pose_from_rotation_vector", arguments=six), name="rot"):
                    return self.expressions.measured(six[3 + place], "rad")
                case ir.Field(base=base, name="rot"):
                    return f"{self.expressions.atom(base)}[{3 + place}]"
            return f"{self.expressions.atom(rotation)}[{3 + place}]"
        if name in _ANGLES:
            vector = self.vector(rotation)
            return None if vector is None else f"rotvec2rpy({vector})[{_ANGLES.index(name)}]"
        return None

    def vector(self, rotation: ir.Expression) -> str | None:
        """The list of a rotation's vector."""
        match rotation:
            case ir.Builtin(function="rotation_zyx", arguments=angles):
                return self.turned(angles)
            case ir.Field(base=ir.Builtin(function="pose_from_rotation_vector", arguments=six), name="rot"):
                return f"[{', '.join(self.expressions.measured(one, 'rad') for one in six[3:])}]"
            case ir.Field(base=base, name="rot"):
                place = self.expressions.atom(base)
                return f"[{place}[3], {place}[4], {place}[5]]"
        return None

    def turned(self, angles: tuple[ir.Expression, ...]) -> str:
        """The rotation vector of angles about z, new y, new x."""
        shown = [self.expressions.measured(angle, "rad") for angle in reversed(angles)]
        return f"rpy2rotvec([{', '.join(shown)}])"

    def rotated(self, angles: tuple[ir.Expression, ...]) -> str:
        """A pose that only turns."""
        zero = ("0", "0", "0")
        return self.expressions.helper("rpl_pose", *zero, *map(self.expressions.text, angles))

    def three(self, aggregate: ir.Aggregate) -> str | None:
        """A list of the three components of one rotation, written as the function that gives them all."""
        names, rotations = [], []
        for name, value in aggregate.entries:
            match value:
                case ir.Magnitude(value=ir.Builtin(function=function, arguments=(rotation,)), unit="rad") if (
                    name is None
                ):
                    names.append(function)
                    rotations.append(rotation)
                case _:
                    return None
        if len(names) != 3 or any(one != rotations[0] for one in rotations):
            return None
        if tuple(names) == _VECTOR:
            return self.vector(rotations[0])
        vector = self.vector(rotations[0]) if tuple(names) == _ANGLES else None
        return None if vector is None else f"rotvec2rpy({vector})"

    def turned_in_tool(self, place: str, turns: list[ir.Expression]) -> str:
        """A place turned in the tool about x, then the new y, then the new z (degrees)."""
        for axis, turn in enumerate(turns):
            if constant(turn, self.expressions.scope) != 0:
                about = ["0", "0", "0"]
                about[axis] = short(self.expressions.measured(turn, "rad"))
                place = f"pose_trans({place}, p[0, 0, 0, {', '.join(about)}])"
        return place

    # ---- poses and joints

    def apart(self, one: ir.Expression, other: ir.Expression) -> str:
        """How far two places are from each other, in m."""
        if isinstance(one, ir.Field) and isinstance(other, ir.Field) and one.name == other.name == "trans":
            one, other = one.base, other.base
        return f"point_dist({self.expressions.text(one)}, {self.expressions.text(other)})"

    def function(self, name: str, values: tuple[ir.Expression, ...]) -> str | Printed | None:
        """Geometric functions; None when URScript has no such function."""
        text = self.expressions.text
        match name, values:
            case "pose_of", (one,):
                return text(one)
            case "offset", (place, x, y, z):
                return f"pose_trans({self.shift(x, y, z)}, {text(place)})"
            case "tool_offset", (place, x, y, z):
                return f"pose_trans({text(place)}, {self.shift(x, y, z)})"
            case "tool_offset", (place, x, y, z, *turns):
                return self.turned_in_tool(f"pose_trans({text(place)}, {self.shift(x, y, z)})", turns)
            case "displaced", (place, by):
                return f"pose_trans({text(by)}, {text(place)})"
            case "displaced_in_tool", (place, by):
                return f"pose_trans({text(place)}, {text(by)})"
            case "pose_from_rotation_vector", (x, y, z, rx, ry, rz):
                place_text = [short(self.expressions.measured(one, "m")) for one in (x, y, z)]
                turn = [short(self.expressions.measured(one, "rad")) for one in (rx, ry, rz)]
                return f"p[{', '.join((*place_text, *turn))}]"
            case "distance", (one, other):
                return Printed(f"{self.apart(one, other)} * 1000.0", tables.PRODUCT)
            case "rotation_angle", (one, other):
                return self.expressions.helper("rpl_turn", text(one), text(other))
            case "rotation_zyx", angles:
                return self.rotated(angles)
            case "euler_x" | "euler_y" | "euler_z", (ir.Name() as rotation,):
                angle = str("xyz".index(name[-1]))
                return self.expressions.helper("rpl_angle", text(rotation), angle)
            case "current_target", ():
                return "get_actual_tcp_pose()"
            case "current_target", (tool,):
                if constant(tool, self.expressions.scope) == rigid.IDENTITY:
                    return "get_actual_tool_flange_pose()"
                return f"get_forward_kin(get_actual_joint_positions(), tcp={text(tool)})"
            case "current_joints", ():
                return "get_actual_joint_positions()"
            case "target_to_joints", (place,):
                return f"get_inverse_kin({text(place)})"
            case "target_to_joints_near" | "is_reachable", (place, near):
                return self.solution(name, text(place), near)
            case "pose_sum" | "pose_difference", (one, other):
                return f"{'pose_add' if name == 'pose_sum' else 'pose_sub'}({text(one)}, {text(other)})"
            case "joints_to_target", (joints,):
                return f"get_forward_kin({text(joints)})"
            case "joints_to_target", (joints, tool):
                return f"get_forward_kin({text(joints)}, tcp={text(tool)})"
        return None

    def solution(self, name: str, place: str, near: ir.Expression) -> str:
        """Inverse kinematics of a pose's text, nearest to joints; without these, to where the arm is."""
        function = "get_inverse_kin" if name == "target_to_joints_near" else "get_inverse_kin_has_solution"
        if near == ir.Builtin("current_joints", ()):
            return f"{function}({place})"
        return f"{function}({place}, qnear={self.near(near)})"

    def near(self, joints: ir.Expression) -> str:
        """Joints that only choose a solution: three decimals are plenty where they are constants."""
        if isinstance(joints, ir.Aggregate):
            values = [constant_number(value, self.expressions.scope) for _, value in joints.entries]
            if len(values) == len(tables.AXES) and all(value is not None for value in values):
                shown = [spelling.real_text(round(math.radians(value or 0.0), 3)) for value in values]
                return f"[{', '.join(shown)}]"
        return self.expressions.text(joints)

    def shift(self, x: ir.Expression, y: ir.Expression, z: ir.Expression) -> str:
        """A pose that only moves."""
        place = [short(self.expressions.measured(one, "m")) for one in (x, y, z)]
        return f"p[{', '.join(place)}, 0, 0, 0]"

"""IR moves as URScript: movej, movel, movec, movep with acceleration, speed, time and blend radius.

A target in a frame is `pose_trans(frame, target)`, because moves go to poses in the base of the robot. Joint speeds in
percent are percent of the slowest axis of the arm, which then leads.
"""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

from rpl import ir
from rpl.diagnostics import Diagnostics, Severity, code
from rpl.passes import rigid
from rpl.passes.fold import constant, constant_number
from rpl.source import Origin
from rpl.writing.statements import CannotSayError

from . import spelling, tables
from .expressions import Expressions
from .units import scaled

if TYPE_CHECKING:
    from rpl.emulator.model import RobotModel

NO_ARM = code(
    "urscript-joint-speed",
    Severity.WARNING,
    "no arm is named: joint speeds in percent are written as percent of {limit:g} deg/s",
    "name the arm with --to-robot",
)
_WORDS = {"joint": "movej", "linear": "movel", "circular": "movec"}
_ACCELERATION = {"joint": "axis_acceleration", "linear": "path_acceleration", "circular": "path_acceleration"}

Words = dict[str, object]  # of a macro


class Motion:
    """Prints moves inside of one scope."""

    def __init__(self, expressions: Expressions, diagnostics: Diagnostics, robot: RobotModel | None) -> None:
        self.expressions, self.diagnostics, self.robot = expressions, diagnostics, robot

    def move(self, move: ir.Move, blended: bool = True) -> Words:
        """The words of the call. `blended` False: what follows wants the robot to stand."""
        if move.motion_class == "velocity":
            return self.rates(move)
        self.refuse(move)
        if move.motion_class == "servo" and move.kind == "joint":
            return {"word": "servoj", "places": [self.place(move, move.target)], "settings": self.speed(move)}
        word = _WORDS.get(move.kind)
        if word is None:
            raise CannotSayError(f"there is no {move.kind} move")
        if move.motion_class == "process" and move.kind == "linear":
            word = "movep"
        places = [self.place(move, move.target)]
        if move.kind == "circular":
            if move.via is None:
                raise CannotSayError("a circle needs its point on the way")
            places.insert(0, self.place(move, move.via))
        settings = [*self.speed(move), *(self.blend(move.blend) if blended else ())]
        if move.kind == "circular" and move.circle_orientation == "path":
            settings.append("mode=1")
        return {"word": word, "places": places, "settings": settings}

    def rates(self, move: ir.Move) -> Words:
        """`speedl` and `speedj`: the way in a second."""
        self.refuse(replace(move, relative=None))
        joints, speed = move.relative == "joints", move.speed or ir.Speed()
        found = [self.rate(one) for one in _ways(move.target)]
        if len(found) != _WAYS or move.kind != ("joint" if joints else "linear"):
            raise CannotSayError("a move with a relative move")
        given = speed.axis_acceleration if joints else speed.path_acceleration
        usual = tables.USUAL_ACCELERATION["joint" if joints else "linear"]
        settings = [f"a={usual if given is None else self.number(given, 'rad/s2' if joints else 'm/s2')}"]
        if speed.duration is not None:
            settings.append(f"t={self.number(speed.duration, 's')}")
        places = [f"[{', '.join(found)}]"]
        return {"word": "speedj" if joints else "speedl", "places": places, "settings": settings}

    def rate(self, part: ir.Expression) -> str:
        return "0" if part == ir.RealLiteral(0.0) else self.expressions.text(part)

    def refuse(self, move: ir.Move) -> None:
        """What URScript has no argument for."""
        for what, found in (
            ("a relative move", move.relative),
            ("a circle by its angle", move.swept),
            ("a tool of its own", move.tool),
            ("a load of its own", move.load),
            ("an orientation rule of its own", not _says_orientation(move)),
            ("actions on its path", move.triggers),
            ("a search", move.search),
            ("settings of its own", move.settings),
            ("a motion group", move.group != 1),
            ("a program that goes on at once", move.concurrent),
            ("spline blocks", move.motion_class == "spline"),
        ):
            if found:
                raise CannotSayError(f"a move with {what}")

    # ---- where to

    def place(self, move: ir.Move, target: ir.Expression) -> str:
        """A target in the robot's base."""
        frame = self.frame(move.frame)
        if isinstance(target, ir.Builtin) and target.function == "target_to_joints_near" and len(target.arguments) == 2:
            inner, near = target.arguments
            return self.expressions.geometry.solution(target.function, self.place(move, inner), near)
        if frame is None or isinstance(self.expressions.type(target), ir.JointsType):
            return self.expressions.text(target)
        if isinstance(target, ir.Aggregate) and isinstance(frame, ir.Aggregate):
            return self.expressions.text(ir.Binary(":", frame, target))
        return f"pose_trans({self.expressions.text(frame)}, {self.expressions.text(target)})"

    def frame(self, frame: ir.Expression | None) -> ir.Expression | None:
        """The frame as a pose; None where it is the robot's base."""
        if frame is None:
            return None
        if isinstance(self.expressions.type(frame), ir.WorkObjectType):
            frame = ir.Binary(":", ir.Field(frame, "user_frame"), ir.Field(frame, "object_frame"))
        known = constant(frame, self.expressions.scope)
        return None if known == rigid.IDENTITY else frame

    # ---- how

    def speed(self, move: ir.Move) -> list[str]:
        speed, shown = move.speed or ir.Speed(), []
        acceleration = getattr(speed, _ACCELERATION[move.kind])
        if acceleration is not None:
            shown.append(f"a={self.number(acceleration, 'rad/s2' if move.kind == 'joint' else 'm/s2')}")
        velocity = self.joint_velocity(speed, move.origin) if move.kind == "joint" else self.path_velocity(speed)
        if velocity:
            shown.append(f"v={velocity}")
        if speed.duration is not None:
            if move.motion_class == "process" or move.kind == "circular":
                raise CannotSayError("a circle or a process move takes no time")
            shown.append(f"t={self.number(speed.duration, 's')}")
        return shown

    def path_velocity(self, speed: ir.Speed) -> str:
        path = speed.path
        if path is None and isinstance(speed.profile, ir.Aggregate):
            path = next((value for name, value in speed.profile.entries if name == "path"), None)
        return "" if path is None else self.number(path, "m/s")

    def joint_velocity(self, speed: ir.Speed, origin: Origin) -> str:
        """Speed of the leading axis in rad/s."""
        if speed.axis is not None:
            return self.number(speed.axis, "rad/s")
        if speed.joint is None:
            return ""
        limit = tables.JOINT_LIMIT_DEG_S
        if self.robot is not None:
            limit = float(min(self.robot.speeds))
        elif not any(item.code == NO_ARM for item in self.diagnostics.items):
            self.diagnostics.report(NO_ARM, origin, limit=limit)
        return self.number(scaled(_bare(speed.joint), limit / 100.0), "rad/s")

    def number(self, value: ir.Expression, unit: str) -> str:
        """A setting in its unit, short."""
        if isinstance(value, ir.Quantity) and value.unit == unit:
            return self.expressions.text(value.value)
        known = constant_number(value, self.expressions.scope) if _literal(value) else None
        if known is None:
            return self.expressions.measured(value, unit)
        if unit == "s":
            return spelling.plain_text(known)
        if unit.startswith("rad"):
            return spelling.plain_text(known / ir.UNITS[unit], 4)
        return spelling.metres(known)

    def blend(self, blend: ir.Blend | None) -> list[str]:
        match blend:
            case None | ir.BlendStop():
                return []
            case ir.BlendDistance(distance=distance) if distance is not None:
                return [f"r={self.number(distance, 'm')}"]
            case ir.BlendZone(zone=zone, distance=distance, in_position=None):
                if distance is None and isinstance(zone, ir.Aggregate):
                    distance = next((value for name, value in zone.entries if name == "path"), None)
                if distance is not None:
                    return [f"r={self.number(distance, 'm')}"]
        raise CannotSayError("a blend is given by the distance to the target only")


def _says_orientation(move: ir.Move) -> bool:
    """The tool turns evenly, or on a circle stays as it is to the arc."""
    on_arc = move.kind == "circular" and move.orientation == "constant" and move.circle_orientation == "path"
    return on_arc or move.orientation in (None, "variable")


def _bare(value: ir.Expression) -> ir.Expression:
    return value.value if isinstance(value, ir.Quantity) and value.unit == "percent" else value


def _literal(value: ir.Expression) -> bool:
    """Is it a number as written?"""
    if isinstance(value, ir.Quantity):
        return _literal(value.value)
    if isinstance(value, ir.Unary | ir.Convert):
        return _literal(value.operand)
    return isinstance(value, ir.IntLiteral | ir.RealLiteral)


_WAYS = 6


def _ways(target: ir.Expression) -> list[ir.Expression]:
    """The six speeds of a motion that goes on, in metres and radians."""
    match target:
        case ir.Aggregate(entries=entries):
            parts = [value for _, value in entries]
        case ir.Builtin(function="pose_from_rotation_vector", arguments=arguments):
            parts = list(arguments)
        case _:
            return []
    return [one.value if isinstance(one, ir.Quantity) and one.unit in ("m", "rad") else one for one in parts]

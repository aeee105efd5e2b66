"""IR moves as V+ steps: MOVE, MOVES, APPRO, DEPART, DRIVE, MOVEC, and the settings in front of them.

Locations of V+ say nothing of the arm's posture. Where a move must reach one, the words (LEFTY, ABOVE, FLIP) stand in
front of it, unless the arm is known to be in it.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING

from rpl import ir, registry
from rpl.diagnostics import Code, Diagnostics, Severity, code
from rpl.passes import rigid
from rpl.passes.fold import constant
from rpl.source import Origin
from rpl.writing.statements import CannotSayError

from . import settings, spelling, tables
from .expressions import Expressions
from .facts.corners import size_of
from .facts.moves import lacking
from .units import in_unit, scaled

if TYPE_CHECKING:
    from rpl.emulator.model import RobotModel

LEFT_OUT = code("vplus-left-out", Severity.WARNING, "V+ has no place for {what} at a move; it is left out")
ARC = code("vplus-arc", Severity.WARNING, "only eV+ controllers have MOVEC")
NO_ARM = code(
    "vplus-joint-speed",
    Severity.WARNING,
    "no arm is named: speeds of the leading axis are written as percent of {limit:g} deg/s",
    "name the arm with --to-robot",
)
POSTURE = code(
    "vplus-posture",
    Severity.WARNING,
    "the posture of the arm is not written, because no arm is named",
    "name the arm with --to-robot",
)
_WORDS = {"joint": "MOVE", "linear": "MOVES"}
_AXIS_DEG_S = 180.0  # M: stands in for the slowest axis where no arm is named
_LONG_SUM = 80  # characters of the joints in one line, from which they are added up before


@dataclass(slots=True)
class MotionFacts:
    """What all programs of one file share. `usual`: percent that the program sets for all its joint moves."""

    diagnostics: Diagnostics
    robot: RobotModel | None
    foreign: bool
    usual: float | None = None
    reported: set[tuple[Code, str]] = field(default_factory=set)

    def once(self, about: Code, origin: Origin, key: str = "", **arguments: object) -> None:
        if (about, key) not in self.reported:
            self.reported.add((about, key))
            self.diagnostics.report(about, origin, **arguments)


class Motion:
    """Prints moves inside of one routine. `posture`: words that the arm is known to obey."""

    def __init__(self, expressions: Expressions, facts: MotionFacts) -> None:
        self.expressions, self.facts = expressions, facts
        self.posture: tuple[str, ...] = ()

    def forget(self) -> None:
        """The arm may be in any posture from here on."""
        self.posture = ()

    def move(self, move: ir.Move) -> tuple[list[str], str, list[str]]:
        """Steps in front, the move, steps behind."""
        self.refuse(move)
        before = [line for place, value in move.settings for line in self.own(place, value)]
        target, asked = self.solved(move)
        frame = self.frame(move.frame)
        before += self.postured(asked)
        before += self.speed(move)
        step = self.step(move, target, frame)
        if move.kind == "joint" and isinstance(self.expressions.type(target), ir.JointsType):
            self.forget()
        return before, step, self.behind(move)

    def own(self, place: ir.Expression, value: ir.Expression) -> list[str]:
        if not isinstance(place, ir.System):
            raise CannotSayError("a move with a setting of its own")
        return settings.setting(place.name, value, False, self.expressions)

    def refuse(self, move: ir.Move) -> None:
        lost = lacking(move)
        if lost:
            raise CannotSayError(f"a move with {lost}")

    # ---- where to

    def solved(self, move: ir.Move) -> tuple[ir.Expression, tuple[str, ...]]:
        """The target, and the posture in which it is to be reached."""
        target = move.target
        if not (isinstance(target, ir.Builtin) and target.function == "target_to_joints_near"):
            return target, ()
        place, near = target.arguments[0], target.arguments[1]
        entries = dict(near.entries) if isinstance(near, ir.Aggregate) else {}
        joints = [self.expressions.known(value) for name, value in entries.items() if name in tables.AXES]
        if move.kind != "joint" or not joints or None in joints or len(target.arguments) > 2:
            raise CannotSayError("a move to the solution nearest to joints")
        angles = [float(value or 0.0) for value in joints]
        return place, self.words(angles, move.origin)

    def words(self, joints: list[float], origin: Origin) -> tuple[str, ...]:
        """The posture of joints."""
        robot = self.facts.robot
        make = registry.dialect("vplus").notation
        if robot is None or make is None:
            self.facts.once(POSTURE, origin)
            return ()
        import numpy as np

        flags = make().encode(robot, np.array(joints[: robot.axes], dtype=np.float64))
        elbow_only = len({branch.shoulder for branch in robot.arm.branches}) == 1
        used = ("shoulder",) if elbow_only else ("shoulder", "elbow", "wrist")
        return tuple(tables.FLAGS[name][flags[name]] for name in used if name in flags)

    def postured(self, asked: tuple[str, ...]) -> list[str]:
        new = [word for word in asked if word not in self.posture]
        if asked:
            self.posture = asked
        return new

    def frame(self, frame: ir.Expression | None) -> ir.Expression | None:
        """The frame that the target stands in; None where it is the robot's base."""
        if frame is None or constant(frame, self.expressions.scope) == rigid.IDENTITY:
            return None
        if isinstance(self.expressions.type(frame), ir.WorkObjectType):
            return ir.Binary(":", ir.Field(frame, "user_frame"), ir.Field(frame, "object_frame"))
        return frame

    def placed(self, target: ir.Expression, frame: ir.Expression | None) -> ir.Expression:
        """A target in the robot's base: `frame:target`."""
        if frame is None or isinstance(self.expressions.type(target), ir.JointsType):
            return target
        return ir.Binary(":", frame, target)

    def step(self, move: ir.Move, target: ir.Expression, frame: ir.Expression | None) -> str:
        text = self.expressions.text
        if move.relative is not None:
            return self.relative(move, target, frame)
        if move.kind == "circular":
            if move.via is None:
                raise CannotSayError("a circle needs its point on the way")
            self.facts.once(ARC, move.origin)
            return self.fitting("MOVEC", self.placed(move.via, frame), self.placed(target, frame))
        word = _WORDS.get(move.kind)
        if word is None:
            raise CannotSayError(f"there is no {move.kind} move")
        match target:
            case ir.System(name="home_joints"):
                return "READY"
            case ir.Builtin(function="aligned"):
                return "ALIGN"
            case ir.Builtin(function="tool_offset", arguments=(place, x, y, z)) if self.zero(x) and self.zero(y):
                suffix = "S" if word == "MOVES" else ""
                return f"APPRO{suffix} {text(self.placed(place, frame))}, {text(_negated(z))}"
        return self.fitting(word, self.placed(target, frame))

    def fitting(self, word: str, *places: ir.Expression) -> str:
        """The step to these places; the longest of them are kept by a SET before it where the line is too short."""
        texts = [self.expressions.text(one) for one in places]
        for at in sorted(range(len(texts)), key=lambda one: -len(texts[one])):
            if len(word) + 1 + len(", ".join(texts)) > tables.LONGEST_LINE:
                stem = "#p" if isinstance(self.expressions.type(places[at]), ir.JointsType) else "p"
                texts[at] = self.expressions.kept(texts[at], stem, "SET ")
        return f"{word} {', '.join(texts)}"

    def zero(self, value: ir.Expression) -> bool:
        return self.expressions.known(value) == 0

    def relative(self, move: ir.Move, target: ir.Expression, frame: ir.Expression | None) -> str:
        """An offset from where the move before ends."""
        word, text = _WORDS.get(move.kind), self.expressions.text
        if word is None:
            raise CannotSayError(f"there is no relative {move.kind} move")
        if not isinstance(target, ir.Aggregate):
            return f"{word} {self.displaced(move, target, frame)}"
        steps = {name: value for name, value in target.entries if name is not None and not self.zero(value)}
        if move.relative == "joints":
            return self.drive(move, steps)
        place = [text(steps.get(axis, ir.IntLiteral(0))) for axis in tables.PLACES]
        turned = set(steps) - set(tables.PLACES)
        if move.relative == "tool":
            if not turned and set(steps) <= {"z"}:
                suffix = "S" if word == "MOVES" else ""
                return f"DEPART{suffix} {text(_negated(steps.get('z', ir.IntLiteral(0))))}"
            offset = text(ir.Binary(":", ir.System("end_pose"), target))
            return f"{word} {offset}"
        if turned:
            return f"{word} {self.displaced(move, target, frame)}"
        if frame is not None:
            here = ir.Binary(":", ir.Builtin("inverse", (frame,)), ir.System("end_pose"))
            return f"{word} {self.expressions.atom(frame)}:SHIFT({text(here)} BY {', '.join(place)})"
        return f"{word} SHIFT(DEST BY {', '.join(place)})"

    def displaced(self, move: ir.Move, by: ir.Expression, frame: ir.Expression | None) -> str:
        """Where a move by a whole location or by joints goes to: in the axes of the frame it is moved and turned about
        its own point."""
        expressions = self.expressions
        if move.relative == "joints":
            part = expressions.places.locations.decomposed(by, 0).partition("[")[0]
            return self.joints_by({axis: ir.Name(f"{part}[{at}]") for at, axis in enumerate(tables.AXES)})
        if move.relative == "tool":
            return expressions.text(ir.Binary(":", ir.System("end_pose"), by))
        old: ir.Expression = ir.System("end_pose")
        if frame is not None:
            old = ir.Binary(":", ir.Builtin("inverse", (frame,)), old)
        here, step = (expressions.kept(expressions.text(one), "p", "SET ") for one in (old, by))
        turns = [f"SHIFT({one} BY -DX({one}), -DY({one}), -DZ({one}))" for one in (step, here)]
        turned = expressions.kept(":".join(turns), "p", "SET ")
        place = f"SHIFT({turned} BY {', '.join(f'D{axis}({here})+D{axis}({step})' for axis in 'XYZ')})"
        return place if frame is None else f"{expressions.atom(frame)}:{place}"

    def joints_by(self, steps: dict[str, ir.Expression]) -> str:
        """The joints where the motion ends, and these changes."""
        if set(steps) - set(tables.AXES):
            raise CannotSayError("there are no external axes")
        notes = self.expressions.notes
        part = notes.temporary("part")
        notes.step(f"DECOMPOSE {part}[0] = #PDEST")
        notes.autos.append(f"{part}[5]")
        given = []
        for at, axis in enumerate(tables.AXES):
            change = f"+{self.number(steps[axis])}" if axis in steps else ""
            given.append(f"{part}[{at}]{change}")
        if sum(map(len, given)) > _LONG_SUM:
            for at, value in enumerate(given):
                notes.step(f"{part}[{at}] = {value}")
            given = [f"{part}[{at}]" for at in range(len(given))]
        return f"#PPOINT({', '.join(given)})"

    def number(self, value: ir.Expression) -> str:
        return value.id if isinstance(value, ir.Name) and "[" in value.id else self.expressions.atom(value)

    def drive(self, move: ir.Move, steps: dict[str, ir.Expression]) -> str:
        """DRIVE moves one joint."""
        if len(steps) != 1 or move.kind != "joint":
            return f"{_WORDS[move.kind]} {self.joints_by(steps)}"
        ((name, value),) = steps.items()
        if name not in tables.AXES:
            raise CannotSayError("there are no external axes")
        speed = ""
        if move.speed is not None and move.speed.joint is not None:
            speed = f", {self.expressions.text(self.bare(move.speed.joint))}"
        return f"DRIVE {tables.AXES.index(name) + 1}, {self.expressions.text(value)}{speed}"

    # ---- how

    def bare(self, value: ir.Expression) -> ir.Expression:
        return value.value if isinstance(value, ir.Quantity) and value.unit == "percent" else value

    def speed(self, move: ir.Move) -> list[str]:
        speed, found = move.speed, []
        if speed is None or move.relative == "joints":
            return []
        for what, value in (
            ("an acceleration", speed.path_acceleration or speed.axis_acceleration or move.acceleration),
            ("a turning speed", speed.rotation if speed.path is None else None),
            ("a speed profile", speed.profile),
        ):
            if value is not None:
                self.facts.once(LEFT_OUT, move.origin, what, what=what)
        if move.kind == "joint":
            percent = self.percent(speed, move.origin)
            known = None if percent is None else self.expressions.known(percent)
            if percent is not None and (known is None or known != self.facts.usual):
                found.append(f"SPEED {self.rounded(percent)}")
        elif speed.path is not None:
            found.append(f"SPEED {self.rounded(speed.path)} MMPS")
        if speed.duration is not None:
            if not found:
                found.append("SPEED 100")  # the duration alone decides
            found.append(f"DURATION {self.expressions.measured(speed.duration, 's')}")
        return found

    def percent(self, speed: ir.Speed, origin: Origin) -> ir.Expression | None:
        if speed.joint is not None:
            return self.bare(speed.joint)
        if speed.axis is None:
            return None
        limit = _AXIS_DEG_S
        if self.facts.robot is not None:
            limit = float(min(self.facts.robot.speeds))
        else:
            self.facts.once(NO_ARM, origin, limit=limit)
        return scaled(in_unit(speed.axis, "deg/s"), 100.0 / limit)

    def rounded(self, value: ir.Expression) -> str:
        known = self.expressions.known(value) if not isinstance(value, ir.Name) else None
        return self.expressions.measured(value, "mm/s") if known is None else spelling.number(known, 4)

    def is_stop(self, blend: ir.Blend | None) -> bool:
        """Is it an exact stop, or a corner of no size?"""
        size = None if blend is None else size_of(blend)
        return blend is None or isinstance(blend, ir.BlendStop) or (size is not None and self.zero(size))

    def behind(self, move: ir.Move) -> list[str]:
        """BREAK where the robot stops at the target."""
        stops = self.is_stop(move.blend) if self.facts.foreign else isinstance(move.blend, ir.BlendStop)
        return ["BREAK"] if stops else []


def _negated(value: ir.Expression) -> ir.Expression:
    match value:
        case ir.Unary(op="-", operand=operand):
            return operand
        case ir.IntLiteral(value=number):
            return ir.IntLiteral(-number)
        case ir.RealLiteral(value=real):
            return ir.RealLiteral(-real if real else 0.0)
    return ir.Unary("-", value)

"""IR moves as TP motion lines: point, speed, termination, options."""

from __future__ import annotations

import math
import re
from collections.abc import Callable
from dataclasses import dataclass, field, replace
from typing import NamedTuple, Protocol

from rpl import ir
from rpl.diagnostics import Code, Diagnostics, Severity, code
from rpl.passes.percents import MM_S_PER_PERCENT
from rpl.source import Origin
from rpl.writing.statements import CannotSayError
from rpl.writing.text import number_text

from . import tables
from .expressions import Expressions, constant, measured
from .lines import Line, pulse_length
from .positions import Points, Position, position_of, step_of

ROUNDED = code("tp-rounded", Severity.WARNING, "{what} {value} is written as {written}", "TP takes whole numbers here")
TOOL_SPEED = code(
    "tp-joint-speed",
    Severity.WARNING,
    "a joint move's tool speed has no counterpart; it is written in percent of the axes ({factor:g} mm/s a percent)",
)
JOINT_CORNER = code(
    "tp-joint-corner",
    Severity.WARNING,
    "a joint move has no corner distance; it is written as CNT ({factor:g} mm each)",
)
LEADER = code(
    "tp-leader",
    Severity.WARNING,
    "the move is coordinated with '{unit}'; COORD says {leader}, which must be that mechanism",
)
LEFT_OUT = code("tp-left-out", Severity.WARNING, "TP has no place for {what} at a move; it is left out")
NO_SPEED = code("tp-no-speed", Severity.WARNING, "the move says no speed; it is written with {speed}")

STOPPED = code(
    "tp-stop-before",
    Severity.WARNING,
    "the place that this move starts from is known only when the robot stands; it stops before the move",
)

CORNER_STOPPED = code(
    "tp-corner-stopped",
    Severity.WARNING,
    "the place that this move starts from is known only when the robot stands; the corner before it becomes a stop",
)

_NUMBER = re.compile(r"PR\[(\d+)")
_HIGH = ir.BoolLiteral(True)


class Action(Protocol):
    """How an assignment or a call is written behind a trigger."""

    def __call__(self, action: ir.Assign | ir.CallRoutine) -> str: ...


class State(NamedTuple):
    """What is known at a place of the program; see Motion."""

    frame: str
    tool: str
    last: Position | None
    place: str
    stands: bool
    handed: frozenset[str]


_SETTINGS = ("coordinated", "external_speed", "remote_tool")


def _named(move: ir.Move) -> list[tuple[str, ir.Expression]]:
    """The settings of a move by the names of their system variables."""
    return [(place.name if isinstance(place, ir.System) else "", value) for place, value in move.settings]


@dataclass(slots=True)
class Motion:
    """Prints the moves of one program. `frame` and `tool` are the numbers in force, '' when not known."""

    expressions: Expressions
    points: Points
    diagnostics: Diagnostics
    action: Action
    keeper: Callable[[str], str]  # a register of the writer's own, by its comment
    reported: set[tuple[Code, str]] = field(default_factory=set)
    frame: str = ""
    tool: str = ""
    scratch: int = tables.PR.last
    second: int = tables.PR.last - 1
    before: list[Line] = field(default_factory=list)  # lines that a move needs in front of it
    place: str = ""  # the point that the move before went to
    stands: bool = False  # the move before ended with FINE
    rounded_last: bool = False  # the move above in the text did not
    last: Position | None = None  # where the move before ended, in the frame in force
    handed: frozenset[str] = frozenset()  # registers unchanged since their value became a frame or tool

    @property
    def state(self) -> State:
        return State(self.frame, self.tool, self.last, self.place, self.stands, self.handed)

    @state.setter
    def state(self, state: State) -> None:
        self.frame, self.tool, self.last, self.place, self.stands, self.handed = state

    def forget(self) -> None:
        """Neither frame, tool nor place are known from here on."""
        self.frame = self.tool = ""
        self.handed = frozenset()
        self.moved()

    def moved(self) -> None:
        """The place is not known from here on; frame and tool are as they were."""
        self.last, self.stands, self.place = None, False, ""

    def stored(self, lines: list[Line]) -> None:
        """What these lines put into position registers is no longer what was moved to or handed over."""
        for line in lines:
            if not line.first.startswith("  PR["):
                continue
            number = register_number(line.first.strip())
            self.place = ""
            self.handed = frozenset(one for one in self.handed if number and register_number(one) != number)

    def join(self, other: State) -> None:
        """What holds on both ways."""
        if self.frame != other.frame:
            self.frame = ""
        if self.tool != other.tool:
            self.tool = ""
        self.handed &= other.handed
        if (self.last, self.place, self.stands) != (other.last, other.place, other.stands):
            self.moved()

    def report_once(self, about: Code, origin: Origin, key: str = "", **arguments: object) -> None:
        if (about, key) not in self.reported:
            self.reported.add((about, key))
            self.diagnostics.report(about, origin, **arguments)

    def move(self, move: ir.Move, skip: str = "") -> Line:
        """The line of a move; `skip` is what stands behind Skip. `before` holds the lines in front of it."""
        self.before = []
        letter = tables.LETTERS.get(move.kind)
        if letter is None:
            raise CannotSayError(f"there is no {move.kind} move")
        self.refuse(move)
        via, via_offsets = self.via(move)
        target, offsets = self.in_tool(move) if move.relative == "tool" else self.target(move, move.target)
        speed, term = self.speed(move), self.blend(move)
        goal = self.reached(move, target, offsets)
        length = self.step_length(move)
        if length is None:
            length = path_length(move.kind, self.last, self.reached(move, via, via_offsets), goal)
        options = offsets + self.options(move, length) + skip
        self.last, self.stands = goal, term == "FINE"
        self.rounded_last = not self.stands
        self.place = target if not offsets and move.relative is None else ""
        return move_line(letter, f"{via}{via_offsets}", target, speed, term, options)

    def via(self, move: ir.Move) -> tuple[str, str]:
        if move.kind != "circular":
            return "", ""
        if move.via is None:
            raise CannotSayError("a circle needs its point on the way")
        return self.target(move, move.via)

    def in_tool(self, move: ir.Move) -> tuple[str, str]:
        """A way along the tool: from the point of the move before, else from where the robot stands, moved by
        Tool_Offset."""
        start = self.place
        if not start:
            if not self.stands:
                self.report_once(CORNER_STOPPED if self.rounded_last else STOPPED, move.origin)
                self.before.append(self.standstill())
            start = f"PR[{self.second}]"
            self.before.append(Line(f"  {start}=LPOS"))
        way = self.expressions.element(move.target) if isinstance(move.target, ir.Index | ir.Name) else None
        if way is None:
            way = self.points.place(self.points.add(step_of(move.target, turned=True)))
        if not way.startswith("PR["):
            self.before.append(Line(f"  PR[{self.scratch}]={way}"))
            way = f"PR[{self.scratch}]"
        return start, f" Tool_Offset,{way}"

    def standstill(self) -> Line:
        """A way of no length that ends with FINE: the lines behind it come when the robot stands."""
        point = self.points.place(self.points.add(Position("pose", (0.0,) * 6)))
        self.stands = True
        return move_line("L", "", point, "100mm/sec", "FINE", " INC")

    def reached(self, move: ir.Move, shown: str, offsets: str) -> Position | None:
        """The constant position that a move ends at; None when it is computed."""
        inner = shown[2:-1].partition(":")[0]
        if move.relative is not None or offsets or not shown.startswith("P[") or not inner.isdigit():
            return None
        found = self.points.found.get(int(inner))
        return found if found is not None and found.kind == "pose" else None

    def step_length(self, move: ir.Move) -> float | None:
        """The length of a constant straight step, mm."""
        if move.relative not in ("base", "tool") or move.kind != "linear":
            return None
        try:
            step = step_of(move.target, turned=True)
        except CannotSayError:
            return None
        return math.hypot(*step.values[:3]) if step.kind == "pose" else None

    def refuse(self, move: ir.Move) -> None:
        for what, found in (
            ("a circle by its angle", move.swept),
            ("settings of system variables", any(name not in _SETTINGS for name, _ in _named(move))),
            ("a load", move.load),
            ("a motion group of its own", move.group != 1),
        ):
            if found:
                raise CannotSayError(f"a move has no place for {what}")
        led = next((value for name, value in _named(move) if name == "coordinated"), None)
        if led not in (None, ir.TextLiteral(tables.LEADER)):
            unit = led.value if isinstance(led, ir.TextLiteral) else "what the program chooses"
            self.report_once(LEADER, move.origin, unit, unit=unit, leader=tables.LEADER)
        left = {
            "a speed of the external axes": any(name == "external_speed" for name, _ in _named(move)),
            "an orientation rule": move.orientation not in (None, "variable", "wrist"),
            "a circle's orientation rule": move.circle_orientation not in (None, "base", "path"),
            "an acceleration in mm/s2": move.speed is not None and move.speed.path_acceleration is not None,
            "an acceleration in deg/s2": move.speed is not None and move.speed.axis_acceleration is not None,
        }
        for what, found in left.items():
            if found:
                self.report_once(LEFT_OUT, move.origin, what, what=what)

    # ---- points

    def target(self, move: ir.Move, target: ir.Expression) -> tuple[str, str]:
        """`P[1]` or `PR[2]`, and the options that move it."""
        match target:
            case ir.Builtin(function="element_sum" | "displaced_in_tool" as how, arguments=(base, offset)):
                shown, more = self.target(move, base)
                word = "Offset" if how == "element_sum" else "Tool_Offset"
                return shown, f"{more} {word},{self.register(offset)}"
            case ir.Builtin(function="joints_to_target" | "target_to_joints" | "pose_of", arguments=(base,)):
                return self.target(move, base)
            case ir.Binary(op=":", left=base, right=pose) | ir.Builtin(function="compose", arguments=(base, pose)):
                shown, more = self.target(move, base)
                return shown, f"{more} Tool_Offset,{self.register(pose)}"
        known = self.expressions.element(target) if isinstance(target, ir.Index | ir.Name) else None
        if known is not None:
            if not known.startswith(("P[", "PR[")):
                raise CannotSayError(f"{known} is no position")
            if move.relative is None:
                self.noted(known, move)
            return known, ""
        number_of = self.points.add(self.position(move, target))
        shown = self.points.place(number_of)
        if move.relative is None:
            self.noted(shown, move)
        return shown, ""

    def noted(self, shown: str, move: ir.Move) -> None:
        inner = shown[2:-1].partition(":")[0]
        if shown.startswith("P[") and inner.isdigit():
            self.points.used(int(inner), self.frame, self.tool, move.kind == "joint", move.origin)

    def register(self, pose: ir.Expression) -> str:
        if isinstance(pose, ir.Builtin) and pose.function == "pose_of":
            (pose,) = pose.arguments
        shown = self.expressions.element(pose) if isinstance(pose, ir.Index | ir.Name) else None
        if shown is not None and shown.startswith("PR["):
            return shown
        point = shown if shown is not None and shown.startswith("P[") else None
        if (shown is None or point is not None) and not self.before:
            point = point or self.points.place(self.points.add(position_of(pose, self.expressions.scope)))
            self.before.append(Line(f"  PR[{self.scratch}]={point}"))
            return f"PR[{self.scratch}]"
        raise CannotSayError("an offset is constant or in a position register")

    def position(self, move: ir.Move, target: ir.Expression) -> Position:
        return position_of(target, self.expressions.scope) if move.relative is None else step_of(target)

    # ---- speed

    def speed(self, move: ir.Move) -> str:
        speed = move.speed or ir.Speed()
        if speed.profile is not None:
            raise CannotSayError("speed data have no register")
        if isinstance(speed.duration, ir.Quantity) and speed.duration.unit == "ms":
            return self.measured_in(speed.duration, "ms", "msec", move, 0)
        if speed.duration is not None:
            return self.measured_in(speed.duration, "s", "sec", move, 1)
        if move.kind == "joint":
            return self.joint_speed(move, speed)
        if speed.path is not None:
            if speed.rotation is not None:
                self.report_once(LEFT_OUT, move.origin, "rotation", what="a speed of turning beside that of the tool")
            return self.path_speed(move, speed.path)
        if speed.rotation is not None:
            return self.measured_in(speed.rotation, "deg/s", "deg/sec", move, 0, tables.LARGEST_DEG_S)
        self.report_once(NO_SPEED, move.origin, "path", speed="250 mm/sec")
        return "250mm/sec"

    def joint_speed(self, move: ir.Move, speed: ir.Speed) -> str:
        if speed.joint is not None:
            return self.percent(speed.joint, move, "the speed", 1, tables.LARGEST_PERCENT) + "%"
        if speed.path is not None:
            self.report_once(TOOL_SPEED, move.origin, factor=MM_S_PER_PERCENT)
            value = constant(speed.path)
            if value is None:
                raise CannotSayError("a joint move's speed is in percent of the axes")
            return f"{max(1, min(tables.LARGEST_PERCENT, round(value / MM_S_PER_PERCENT)))}%"
        if speed.axis is not None or speed.rotation is not None:
            raise CannotSayError("a joint move's speed is in percent of the axes")
        self.report_once(NO_SPEED, move.origin, "joint", speed="100 percent")
        return "100%"

    def path_speed(self, move: ir.Move, path: ir.Expression) -> str:
        """In the unit of the source, else in one that says the value exactly; the controller's units are coarse."""
        value = constant(path)
        if value is None or (isinstance(path, ir.Quantity) and path.unit in ("cm/min", "inch/min")):
            unit = path.unit if isinstance(path, ir.Quantity) else "mm/s"
            places = 1 if unit == "inch/min" else 0
            return self.measured_in(path, unit, unit.replace("/s", "/sec"), move, places)
        for unit, word, scale in (("mm/s", "mm/sec", 1), ("cm/min", "cm/min", 1), ("inch/min", "inch/min", 10)):
            shown = float(f"{value / ir.UNITS[unit] * scale:.9g}")
            fits = value <= tables.LARGEST_MM_S or not self.expressions.limited
            if shown == int(shown) and shown >= 1 and fits:
                return f"{number_text(shown / scale, style=tables.NUMBERS)}{word}"
        return self.measured_in(path, "mm/s", "mm/sec", move, 0, tables.LARGEST_MM_S)

    def measured_in(
        self, value: ir.Expression, unit: str, word: str, move: ir.Move, places: int, most: float = 1e9
    ) -> str:
        """A number with its unit behind it, or a register in that unit."""
        found = measured(value, unit)
        if found is None:
            inner = value.value if isinstance(value, ir.Quantity) and value.unit == unit else value
            if isinstance(value, ir.Quantity) and value.unit != unit:
                raise CannotSayError(f"a register holds this speed in another unit than {word}")
            return f"{self.expressions.index(inner)}{word}"
        shown = min(most, max(10.0**-places, round(float(found), places)))
        if shown != found and not self.expressions.limited:
            return f"{number_text(float(found), style=tables.NUMBERS)}{word}"
        if shown != found:
            written = f"{number_text(shown, style=tables.NUMBERS)} {word}"
            self.rounded(move, "the speed", found, written)
        return f"{number_text(shown, style=tables.NUMBERS)}{word}"

    def rounded(self, move: ir.Move, what: str, value: float, written: str) -> None:
        self.report_once(ROUNDED, move.origin, f"{what}{value}", what=what, value=f"{value:g}", written=written)

    def percent(self, value: ir.Expression, move: ir.Move, what: str, least: int, most: int) -> str:
        found = constant(value)
        if found is None:
            return self.expressions.index(value)
        shown = int(min(most, max(least, round(found))))
        if shown != found:
            self.rounded(move, what, float(found), str(shown))
        return str(shown)

    # ---- termination

    def blend(self, move: ir.Move) -> str:
        match move.blend:
            case None | ir.BlendStop():
                return "FINE"
            case ir.BlendPercent(percent=percent) | ir.BlendSpeed(percent=percent):
                return self.continuous(move, percent)
            case ir.BlendDistance(distance=distance) if distance is not None:
                return self.corner(move, distance)
        raise CannotSayError("TP rounds corners by CNT or by a distance")

    def continuous(self, move: ir.Move, percent: ir.Expression) -> str:
        if constant(percent) is None:
            return f"CNT {self.expressions.index(percent)}"
        return "CNT" + self.percent(percent, move, "the continuous value", 0, 100)

    def corner(self, move: ir.Move, distance: ir.Expression) -> str:
        value = measured(distance, "mm")
        if value is None and move.kind != "joint":
            inner = distance.value if isinstance(distance, ir.Quantity) and distance.unit == "mm" else distance
            return f"CR {self.expressions.index(inner)}"  # M: a register, as with CNT
        if value is None:
            return self.joint_corner(move, distance)
        if value == 0:
            return "FINE"
        if move.kind == "joint":
            self.report_once(JOINT_CORNER, move.origin, factor=tables.MM_PER_CNT)
            return f"CNT{max(1, min(100, round(value / tables.MM_PER_CNT)))}"
        shown = max(1, min(tables.LARGEST_CORNER_MM, round(value)))
        if shown != value:
            self.rounded(move, "the corner distance", float(value), str(shown))
        return f"CR{shown}"

    def joint_corner(self, move: ir.Move, distance: ir.Expression) -> str:
        """A computed corner distance as CNT: the register is within its range."""
        self.report_once(JOINT_CORNER, move.origin, factor=tables.MM_PER_CNT)
        inner = distance.value if isinstance(distance, ir.Quantity) and distance.unit == "mm" else distance
        register = self.keeper("corner")
        value = number_text(tables.MM_PER_CNT, style=tables.NUMBERS)
        self.before.append(Line(f"  {register}={self.expressions.index(inner)}/{value}"))
        self.before.append(Line(f"  IF ({register}>100),{register}=(100)"))
        return f"CNT {register}"

    # ---- options

    def options(self, move: ir.Move, length: float | None = None) -> str:
        shown = ""
        if move.acceleration is not None:
            least, most = tables.ACCELERATION
            percent = self.percent(move.acceleration, move, "the acceleration", least, most)
            shown += f" ACC{percent}" if percent.isdigit() else f" ACC {percent}"
        if move.orientation == "wrist":
            shown += " Wjnt"
        if any(name == "coordinated" for name, _ in _named(move)):
            shown += " COORD"
        if any(name == "remote_tool" and value == ir.BoolLiteral(True) for name, value in _named(move)):
            shown += " RTCP"
        if move.relative in ("base", "joints"):
            shown += " INC"
        elif move.relative not in (None, "tool"):
            raise CannotSayError(f"a move relative to the {move.relative}")
        triggers = _pulses(move.triggers)
        if length is None and not (self.rounded_last and not self.stands):
            first = [one for one in triggers if _at_beginning(one[0])]
            triggers = [one for one in triggers if one not in first]
            self.at_beginning(move, first)
        if not (self.rounded_last and not self.stands):
            later = [one for one in triggers if _behind_beginning(one[0])]
            triggers = [one for one in triggers if one not in later]
            self.behind_beginning(later)
        if len(triggers) > tables.MOST_TRIGGERS:
            raise CannotSayError(f"a move has at most {tables.MOST_TRIGGERS} actions on its path")
        for trigger, pulse in triggers:
            shown += f" {self.trigger(trigger, pulse, length)}"
        return shown

    def at_beginning(self, move: ir.Move, triggers: list[tuple[ir.Expression | ir.Trigger, float | None]]) -> None:
        """Actions at the beginning of a way of unknown length: in front of the move, where the robot stands."""
        if triggers and not self.stands:
            self.report_once(STOPPED, move.origin)
            self.before.append(self.standstill())
        for trigger, pulse in triggers:
            if isinstance(trigger, ir.Trigger):
                self.before.append(Line(f"  {self.deed(trigger, pulse)}"))

    def behind_beginning(self, triggers: list[tuple[ir.Expression | ir.Trigger, float | None]]) -> None:
        """Actions some time behind the beginning of a way: behind the end of one of no length in front of it."""
        if not triggers:
            return
        if len(triggers) > tables.MOST_TRIGGERS:
            raise CannotSayError(f"a move has at most {tables.MOST_TRIGGERS} actions on its path")
        shown = ""
        for trigger, pulse in triggers:
            if isinstance(trigger, ir.Trigger):
                shown += f" {self.trigger(replace(trigger, reference='end', distance=None), pulse)}"
        words = dict(self.standstill().words or {})
        self.before.append(move_line(**words | {"options": f"{words['options']}{shown}"}))

    def deed(self, trigger: ir.Trigger, pulse: float | None) -> str:
        """What an action on the path does."""
        if pulse is not None and isinstance(trigger.action, ir.Assign):
            signal = self.expressions.place(trigger.action.target)
            return f"{signal}=PULSE,{pulse_length(pulse, trigger.origin, self.diagnostics)}sec"
        return self.action(trigger.action)

    def trigger(
        self, trigger: ir.Expression | ir.Trigger, pulse: float | None = None, length: float | None = None
    ) -> str:
        """`TB .20sec,DO[1]=ON`, `TA`, `DB 10.0mm`: before or after the end of the move. What counts from its start is
        counted from the end where the `length` of the way is known (mm)."""
        if not isinstance(trigger, ir.Trigger):
            raise CannotSayError("stored actions on the path")
        action = self.deed(trigger, pulse)
        timed = trigger.delay is not None and constant(trigger.delay) != 0
        distance = measured(trigger.distance, "mm") if trigger.distance is not None else 0
        if distance is None:
            raise CannotSayError("an action by distance comes at a constant distance")
        if trigger.reference == "start":
            if length is None:
                raise CannotSayError("an action on the path counts from the end, and this way has no known length")
            distance = distance - length
        if distance != 0 or trigger.reference == "start":
            if timed:
                raise CannotSayError("an action by distance and by time")
            if distance > 1e-6:
                raise CannotSayError("an action by distance comes before the end of the move")
            return f"DB {number_text(max(0.0, -float(distance)), 1, tables.DISTANCES)}mm,{action}"
        delay = measured(trigger.delay, "s") if trigger.delay is not None else 0
        if delay is None:
            raise CannotSayError("an action by time comes at a constant time")
        return f"{'TA' if delay > 0 else 'TB'} {number_text(abs(float(delay)), 2, tables.NUMBERS)}sec,{action}"


def register_number(place: str) -> str:
    """`PR[3:name]`, `PR[3,1]` -> `3`; nothing for a number that is computed."""
    found = _NUMBER.match(place)
    return found[1] if found else ""


def path_length(kind: str, start: Position | None, via: Position | None, goal: Position | None) -> float | None:
    """Length of a line or an arc in mm; None when an end is not known."""
    if start is None or goal is None:
        return None
    if kind == "linear":
        return math.dist(start.values[:3], goal.values[:3])
    if kind != "circular" or via is None:
        return None
    one, other, whole = (
        math.dist(start.values[:3], via.values[:3]),
        math.dist(via.values[:3], goal.values[:3]),
        math.dist(start.values[:3], goal.values[:3]),
    )
    half = (one + other + whole) / 2
    area = math.sqrt(max(0.0, half * (half - one) * (half - other) * (half - whole)))
    if area < 1e-9:
        return None
    radius = one * other * whole / (4 * area)
    return 2 * radius * (_half_angle(one, radius) + _half_angle(other, radius))


def _half_angle(chord: float, radius: float) -> float:
    """Half the angle of an arc of less than half a turn over a chord, rad."""
    return math.asin(min(1.0, chord / (2 * radius)))


def _pulses(triggers: tuple[ir.Expression | ir.Trigger, ...]) -> list[tuple[ir.Expression | ir.Trigger, float | None]]:
    """The triggers, each with the seconds of its pulse: an output that is switched off a constant time later."""
    done: list[tuple[ir.Expression | ir.Trigger, float | None]] = []
    for trigger in triggers:
        pulse = trigger.action if isinstance(trigger, ir.Trigger) else None
        if isinstance(trigger, ir.Trigger) and isinstance(pulse, ir.Pulse):
            seconds = measured(pulse.duration, "s")
            if seconds is None or pulse.value != _HIGH:
                raise CannotSayError("a pulse on the path is to high and lasts a constant time")
            done.append((replace(trigger, action=ir.Assign(pulse.signal, pulse.value)), float(seconds)))
            continue
        match trigger, done[-1][0] if done else None:
            case (
                ir.Trigger(
                    action=ir.Assign(target=ir.Signal() as target, value=ir.BoolLiteral(value=False)), delay=later
                ) as off,
                ir.Trigger(action=ir.Assign(target=before, value=ir.BoolLiteral(value=True)), delay=first) as on,
            ) if target == before and later is not None and _same_place(on, off):
                seconds = _width(first, later)
                if seconds is not None:
                    done[-1] = (on, float(seconds))
                    continue
        done.append((trigger, None))
    return done


def _width(first: ir.Expression | None, later: ir.Expression) -> float | None:
    """How long it is from one time to the other, s; None where that is not known or nothing."""
    if isinstance(later, ir.Binary):
        return measured(later.right, "s")
    begin, end = 0 if first is None else measured(first, "s"), measured(later, "s")
    return None if begin is None or end is None or end <= begin else round(end - begin, 6)


def _at_beginning(trigger: ir.Expression | ir.Trigger) -> bool:
    """Does an action come where the way begins?"""
    if not isinstance(trigger, ir.Trigger) or trigger.reference != "start":
        return False
    given = [measured(one, unit) for one, unit in ((trigger.distance, "mm"), (trigger.delay, "s")) if one is not None]
    return not any(one is None or one != 0 for one in given)


def _behind_beginning(trigger: ir.Expression | ir.Trigger) -> bool:
    """Does an action come a constant time behind the place where the way begins?"""
    if not isinstance(trigger, ir.Trigger) or trigger.reference != "start" or trigger.delay is None:
        return False
    distance = measured(trigger.distance, "mm") if trigger.distance is not None else 0
    return distance == 0 and (measured(trigger.delay, "s") or 0) > 0


def _same_place(one: ir.Trigger, other: ir.Trigger) -> bool:
    """Do two actions count from one place of the path, apart from their times?"""
    places = [measured(each.distance, "mm") if each.distance is not None else 0 for each in (one, other)]
    return one.reference == other.reference and None not in places and places[0] == places[1]


def move_line(letter: str, via: str, target: str, speed: str, term: str, options: str) -> Line:
    """The line of a move, and the words of its macro."""
    words = {"letter": letter, "via": via, "target": target, "speed": speed, "term": term, "options": options}
    settings = f"{speed} {term}{options}    "
    if not via:
        return Line(f"{letter} {target} {settings}", words=words)
    return Line(f"{letter} {via}    ", (f"  {target} {settings}",), words)

"""IR moves as MOVJ, MOVL, MOVC and IMOV: the point with its tool and frame, speed, positioning, condition."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from itertools import zip_longest

from rpl import ir
from rpl.diagnostics import Code, Diagnostics, Severity, code
from rpl.passes.percents import MM_S_PER_PERCENT
from rpl.source import Origin
from rpl.writing.statements import CannotSayError
from rpl.writing.text import number_text

from . import tables
from .conditions import single
from .operands import bank_of, constant, element
from .places import WORLD, Position, between, flat, product, way_of
from .positions import Positions, rounded

RANGE = code(
    "inform-range",
    Severity.WARNING,
    "{tag}={value:g} is written as {written}; a controller takes {least:g} to {most:g}",
)
TOOL_SPEED = code(
    "inform-joint-speed",
    Severity.WARNING,
    "a joint move's tool speed has no counterpart; it is written in percent of the axes ({factor:g} mm/s a percent)",
)
JOINT_CORNER = code(
    "inform-joint-corner",
    Severity.WARNING,
    "a joint move has positioning levels, no corner distance: {distance:g} mm is written as {written}",
)
COMPUTED_CORNER = code(
    "inform-computed-corner",
    Severity.WARNING,
    "a joint move has positioning levels, no corner distance: the job chooses the largest level that is not wider",
)
LEADER = code(
    "inform-station-name",
    Severity.WARNING,
    "the move is coordinated with '{unit}'; a job says station {station}, which must be that mechanism",
)
LEFT_OUT = code("inform-left-out", Severity.WARNING, "INFORM has no place for {what} at a move; it is left out")
NO_SPEED = code("inform-no-speed", Severity.WARNING, "the move says no speed; it is written without one")

Number = Callable[[str, ir.Expression], None]


@dataclass(frozen=True, slots=True)
class Seen:
    """A constant position in a frame that may be computed; `changes`: how many position variables had changed then."""

    position: Position
    frame: ir.Expression | None
    changes: int


@dataclass(slots=True)
class Goal:
    """Where a move went: the point as it is written, and its position where that is constant."""

    place: str
    tool: int
    frame: int
    position: Position | None
    seen: Seen | None = None
    arc: bool = False  # it was the end of an arc


_STATION = "ST1"
_DOWN = "deceleration_percent"
_KNOWN_SETTINGS = ("coordinated", "external_speed", _DOWN)


def _named(move: ir.Move) -> list[tuple[str, ir.Expression]]:
    """The settings of a move by the names of their system variables."""
    return [(place.name if isinstance(place, ir.System) else "", value) for place, value in move.settings]


# Instructions that calculate a point: they do not part the points of an arc.
_PLACE_WORDS = ("MULMAT ", "INVMAT ", "SET ", "GETE ", "SETE ")
# What parts them.
_PARTING = ("IF", "ENDIF", "WHILE", "FOR ", "*", "JUMP ", "CALL ", "MOV")


@dataclass(slots=True)
class Motion:
    """Prints the moves of one job. `line_of_last`: the line of the last move, as long as nothing can come between."""

    positions: Positions
    number: Number
    diagnostics: Diagnostics
    names: dict[str, int] = field(default_factory=dict)  # point of the IR -> its number
    last: Goal | None = None
    line_of_last: int | None = None
    stands: bool = False  # the move before ended in a stop
    running: bool = False  # the move before has NWAIT
    exact: bool = False  # it ends in a stop, as soon as it is waited for
    corners: bool = False  # moves of this program go round corners, and this job does not run beside it
    shift: str = ""  # what the move at hand is shifted by, and the axes
    before: Goal | None = None  # where the move before the last one went, when that was an arc
    reported: set[tuple[Code, str]] = field(default_factory=set)

    @property
    def lines(self) -> list[str]:
        return self.positions.lines

    def forget(self) -> None:
        """Neither place nor line of the last move are known here."""
        self.last, self.line_of_last, self.stands, self.before = None, None, False, None
        self.positions.in_tools.clear()

    def arrive(self) -> None:
        """Behind CWAIT."""
        self.running, self.stands = False, self.exact

    def report_once(self, about: Code, origin: Origin, key: str = "", **arguments: object) -> None:
        if (about, key) not in self.reported:
            self.reported.add((about, key))
            self.diagnostics.report(about, origin, **arguments)

    def move(self, move: ir.Move, done: list[str]) -> list[str]:
        """The lines of a move behind those that are `done`; the move before may become the start of an arc."""
        self.positions.lines, self.shift = [], ""
        self.refuse(move)
        tool = self.tool(move.tool)
        if move.relative is not None:
            goal, shown = self.relative(move, tool)
        elif move.kind in tables.MOVES:
            goal = self.goal(move.target, move, tool)
            known = self.positions.constants.known(move.target)
            if known is not None and known.kind == "pose" and not self.shift:
                goal.seen = Seen(known, move.frame, self.positions.changes)
            shown = f"{tables.MOVES[move.kind]} {goal.place}"
        else:
            raise CannotSayError(f"there is no {move.kind} move")
        speed, blend = self.speed(move), [*self.blend(move), *self.strengths(move)]
        ending, beside = self.ending(move), self.station_speed(move)
        led = self.led(move)
        if move.kind == "circular" and move.relative is None:
            self.arc(move, tool, speed, done, led, beside)
        line = " ".join(part for part in (led + shown, *speed, *blend, *ending) if part)
        if self.shift:
            self.lines.append(f"SFTON {self.shift}")
        self.lines.append(line if move.relative is not None else self.with_axes(line, goal.place, beside))
        self.before = self.last if self.last is not None and self.last.arc else None
        goal.arc = move.kind == "circular"
        self.last, self.exact, self.running = goal, blend[:1] == ["PL=0"], move.concurrent
        self.stands = self.exact and not move.concurrent
        self.line_of_last = len(done) + len(self.lines) - 1
        self.positions.job.moves = True
        if self.shift:
            self.lines.append("SFTOF")
        if move.search is not None or move.relative is not None or self.shift:
            self.line_of_last = None
            self.last = self.last if move.search is None else None
        return self.lines

    def refuse(self, move: ir.Move) -> None:
        for what, found in (
            ("a circle by its angle", move.swept),
            ("a load", move.load),
            ("a motion group of its own", move.group != 1),
        ):
            if found:
                raise CannotSayError(f"a move has no place for {what}")
        left = {
            "settings of its own": any(name not in _KNOWN_SETTINGS for name, _ in _named(move)),
            "an orientation rule": move.orientation not in (None, "variable"),
            "a circle's orientation rule": move.circle_orientation not in (None, "base"),
            "an acceleration in mm/s2": move.speed is not None and move.speed.path_acceleration is not None,
            "an acceleration in deg/s2": move.speed is not None and move.speed.axis_acceleration is not None,
        }
        for what, found in left.items():
            if found:
                self.report_once(LEFT_OUT, move.origin, what, what=what)

    # ---- base axes and stations

    def led(self, move: ir.Move) -> str:
        """`S` in front of the word of a path move that is straight (round) on the station."""
        unit = next((value for name, value in _named(move) if name == "coordinated"), None)
        if unit is None or move.kind == "joint":
            return ""
        if self.positions.job.cell.external <= self.positions.job.cell.bases:
            raise CannotSayError("a move that is coordinated with a station that the program does not move")
        if unit != ir.TextLiteral(_STATION):
            shown = unit.value if isinstance(unit, ir.TextLiteral) else "what the program chooses"
            self.report_once(LEADER, move.origin, shown, unit=shown, station=_STATION)
        return "S"

    def station_speed(self, move: ir.Move) -> str:
        """VJ= behind the `+` of the station."""
        speed = next((value for name, value in _named(move) if name == "external_speed"), None)
        return "" if speed is None else f" {self.tag('VJ', speed, move.origin)}"

    def with_axes(self, line: str, place: str, beside: str = "") -> str:
        """The line of a move with the base axes and the station, which go with the taught point."""
        cell = self.positions.job.cell
        if not cell.external:
            return line
        if not place.startswith("C"):
            raise CannotSayError("a computed place in a program that moves external axes")
        number = place[1:]
        if cell.bases:
            line = line.replace(place, f"{place} BC{number}", 1)
        return f"{line}  +MOVJ EC{number}{beside}" if cell.external > cell.bases else line

    # ---- points

    def tool(self, tool: ir.Expression | None) -> int:
        """The tool's number; one that is kept in a variable is set first."""
        if tool is None:
            return self.positions.job.tool
        place = element(tool)
        if self.positions.constants.known(tool) is None and (place is None or bank_of(place) != "P"):
            raise CannotSayError("a tool is a constant or in a position variable")
        return self.positions.number_of_tool(tool)

    def goal(self, target: ir.Expression, move: ir.Move, tool: int) -> Goal:
        """The taught point or position variable of a target of the move."""
        job, constants, frame = self.positions.job, self.positions.constants, move.frame
        base = Position("pose", WORLD) if frame is None else constants.known(frame)
        while isinstance(target, ir.Builtin) and target.function in ("joints_to_target", "pose_of"):
            target = target.arguments[0]
        shifted = None if move.kind == "circular" or base is None else self.shifted(target, frame)
        if shifted is not None:
            target, self.shift = shifted
        known = constants.known(target)
        if known is not None and (base is not None or known.kind == "joints"):
            number = 0 if base is None else job.cell.frame(base.values, frame)
            wanted = self.names.get(target.id) if isinstance(target, ir.Name) else None
            if known.kind == "joints" and job.taught_scale is None and job.cell.value_of_tool(tool) is None:
                return Goal(self.with_computed_tool(known, tool), tool, 0, None)
            point = job.point_of(known, tool, number, wanted, constants.name(target))
            job.cell.stands(job.name, constants.name(target), point)
            if number and frame is not None:
                for one in constants.operands(frame):
                    job.cell.stands(job.name, constants.name(one), f"UF#({number})")
                    if one is not frame and (shown := element(one)) is not None:
                        job.cell.stands(job.name, constants.name(one), shown)
            return Goal(point, tool, number, None if self.shift else known)
        if self.is_joints(target):
            return Goal(self.positions.as_variable(target), tool, 0, None)
        if base is None or base.values != WORLD:
            assert frame is not None  # no frame is the base
            target = ir.Binary(":", frame, target)
            place = self.positions.as_variable(target)
        else:
            place = self.positions.as_variable(target)
            if job.cell.tool_of_variables != job.tool and tool == job.tool:
                helper = self.positions.registers.helper("P")
                unit = job.constant(Position("pose", WORLD), tool)
                self.lines.append(f"MULMAT {helper} {unit} {place}")
                place = helper
        if tool != job.tool and move.kind == "joint":
            place = self.positions.with_tool_and_posture(place, tool)
        elif tool != job.tool:
            place = self.positions.with_tool(place, tool)
        return Goal(place, tool, 0, None)

    def shifted(self, target: ir.Expression, frame: ir.Expression | None) -> tuple[ir.Expression, str] | None:
        """The taught point of a shifted place, and what shifts it: `P010 UF#(2)`."""
        match target:
            case ir.Builtin(function="displaced", arguments=(point, ir.Name() | ir.Index() as shift)):
                known, place, cell = self.positions.constants.known(point), element(shift), self.positions.job.cell
                base = Position("pose", WORLD) if frame is None else self.positions.constants.known(frame)
                if known is None or known.kind != "pose" or place is None or base is None:
                    return None
                number = cell.frame(base.values, frame)
                return point, f"{place} UF#({number})" if number else f"{place} BF"
        return None

    def with_computed_tool(self, joints: Position, tool: int) -> str:
        """Joints whose tool is kept in a variable: the flange's posture, and the components of flange . tool."""
        job, registers = self.positions.job, self.positions.registers
        kept = job.constant(job.flange_of(joints), tool)
        goal, reached = registers.helper("P"), registers.helper("P")
        self.lines.extend([f"SET {goal} {kept}", f"MULMAT {reached} {kept} {self.positions.in_tools[tool]}"])
        self.positions.copy_components(reached, goal)
        return goal

    def is_joints(self, target: ir.Expression) -> bool:
        return self.positions.constants.is_joints(target)

    def relative(self, move: ir.Move, tool: int) -> tuple[Goal, str]:
        """IMOV with the way in a position variable, or the place itself where it is known."""
        way = way_of(move.target) or self.positions.constants.known(move.target)
        frame = self.positions.constants.known(move.frame) if move.frame is not None else Position("pose", WORLD)
        if move.relative == "tool":
            frame = frame or Position("pose", WORLD)  # the tool's axes are the same in any frame
        job = self.positions.job
        if move.kind == "joint":
            reached = None if way is None or frame is None else self.reached(move, way, tool, frame)
            if reached is None:
                place = self.counted_way(move)
                return Goal(place, tool, 0, None), f"MOVJ {place}"
            return reached, f"MOVJ {reached.place}"
        if move.kind != "linear" or move.relative == "joints":
            raise CannotSayError("a relative move in joints or on a circle")
        if frame is None:
            return Goal("", tool, 0, None), f"IMOV {self.turned_way(move, way, tool)} BF"
        number = job.cell.frame(frame.values, move.frame)
        place = self.positions.as_variable(move.target) if way is None else job.constant(way, tool)
        if way is None and (tool != job.tool or job.cell.tool_of_variables != tool):
            place = self.positions.with_tool(place, tool)
        word = "TF" if move.relative == "tool" else f"UF#({number})" if number else "BF"
        goal = None if way is None else self.reached(move, way, tool, frame)
        return goal or Goal("", tool, 0, None), f"IMOV {place} {word}"

    def counted_way(self, move: ir.Move) -> str:
        """Where a relative move of the joints comes to: the robot's pulses, and those of the way added."""
        known = way_of(move.target) or self.positions.constants.known(move.target)
        way = flat(move.target)
        if known is not None and known.kind == "joints":
            way = dict(zip(tables.JOINT_ELEMENTS, map(ir.RealLiteral, known.values), strict=False))
        if move.relative != "joints" and not set(way) & set(tables.JOINT_ELEMENTS):
            raise CannotSayError("a relative joint move from a place that is not known here")
        registers = self.positions.registers
        place = registers.helper("P", "pulses")
        count, real, whole = (registers.helper(bank) for bank in ("D", "R", "D"))
        if not way:
            if not self.is_joints(move.target):
                raise CannotSayError("a relative joint move by a computed way")
            self.positions.job.pulses(1)  # known, or the way cannot be joints here
            kept = self.positions.as_variable(move.target)
            self.lines.extend([f"GETS {place} $PX000", f"ADD {place} {kept}"])
            return place
        self.lines.append(f"GETS {place} $PX000")
        for number, name in enumerate(tables.JOINT_ELEMENTS, 1):
            part = way.get(name)
            if part is None or constant(part) == 0:
                continue
            per_degree = self.positions.job.pulses(number)
            degrees = constant(part)
            self.lines.append(f"GETE {count} {place} ({number})")
            if degrees is not None:
                self.lines.append(f"ADD {count} {round(degrees * per_degree)}")
            else:
                self.number(real, part)
                self.lines.extend([f"MUL {real} {per_degree!r}", *rounded(real, whole), f"ADD {count} {whole}"])
            self.lines.append(f"SETE {place} ({number}) {count}")
        return place

    def turned_way(self, move: ir.Move, way: Position | None, tool: int) -> str:
        """A way in the axes of a computed frame as one in those of the base: frame . way - frame."""
        if move.frame is None or move.relative == "tool" or way is None or any(way.values[3:]):
            raise CannotSayError("a turned relative move in a computed frame")
        helper, frame = self.positions.registers.helper("P"), self.positions.as_variable(move.frame)
        kept = self.positions.job.constant(way, tool)
        self.lines.extend([f"MULMAT {helper} {frame} {kept}", f"SUB {helper} {frame}"])
        return helper if tool == self.positions.job.tool else self.positions.with_tool(helper, tool)

    def reached(self, move: ir.Move, way: Position, tool: int, frame: Position) -> Goal | None:
        """Where a relative move comes to from the last place."""
        last = self.last
        if last is None or last.position is None or last.position.kind != way.kind or last.tool != tool:
            return None
        job = self.positions.job
        start = last.position
        if way.kind == "joints":
            values = tuple(a + b for a, b in zip_longest(start.values, way.values, fillvalue=0.0))
            return Goal(job.point_of(Position("joints", values), tool, 0, None), tool, 0, Position("joints", values))
        if move.relative == "tool":
            found = product(start.values, way.values)
        elif not any(way.values[3:]) and job.cell.frame(frame.values, move.frame) == last.frame:
            found = (*(a + b for a, b in zip(start.values[:3], way.values[:3], strict=True)), *start.values[3:])
        else:
            return None
        position = Position("pose", found, start.flags)
        place = job.point_of(position, tool, last.frame, None) if move.kind == "joint" else ""
        return Goal(place, tool, last.frame, position)

    def arc(self, move: ir.Move, tool: int, speed: list[str], done: list[str], led: str = "", beside: str = "") -> None:
        """The start of the arc and the point on the way. The start is the end of the move before, where that is linear
        or an arc; else it is taught once more."""
        if move.via is None:
            raise CannotSayError("a circle needs its point on the way")
        via = self.goal(move.via, move, tool)
        retaught = True
        between_them = [] if self.line_of_last is None else [*done[self.line_of_last + 1 :], *self.lines]
        if self.line_of_last is not None and not any(line.startswith(_PARTING) for line in between_them):
            line = done[self.line_of_last]
            kept = all(one.startswith(_PLACE_WORDS) and line.split()[1] not in one.split()[:2] for one in self.lines)
            if line.startswith(f"{led}MOVC "):
                own, plus, rest = line.partition("  +")
                done[self.line_of_last] = f"{own} FPT{plus}{rest}"
                retaught = False
            elif kept and line.startswith(f"{led}MOVL "):
                between = self.between_arcs(tool, speed) if self.before is not None else []
                if between is not None:
                    done[self.line_of_last : self.line_of_last + 1] = [*between, f"{led}MOVC {line.partition(' ')[2]}"]
                    retaught = False
        if retaught:
            if self.last is not None and self.last.place and self.last.position is not None:
                start = self.last.place
            else:
                start = self.positions.registers.helper("P", "pulses")
                self.lines.append(f"GETS {start} $PX000")
            if self.last is not None and self.last.arc:  # its points would go on as those of the arc before
                self.lines.append(self.with_axes(" ".join((f"{led}MOVL", start, *speed, "PL=0")), start, beside))
            self.lines.append(self.with_axes(" ".join((f"{led}MOVC", start, *speed, "PL=0")), start, beside))
        self.lines.append(self.with_axes(" ".join((f"{led}MOVC", via.place, *speed)), via.place, beside))

    def between_arcs(self, tool: int, speed: list[str]) -> list[str] | None:
        """A point in the middle of the straight way between two arcs. Without it the start of the second would be one
        more point of the first. None: it is not known."""
        one, other = self.before, self.last
        if one is None or other is None or one.seen is None or other.seen is None:
            return None
        same = one.seen.frame == other.seen.frame and one.seen.changes == other.seen.changes
        if not same or one.tool != tool or other.tool != tool:
            return None
        middle = between(one.seen.position.values, other.seen.position.values, 0.5)
        target = Position("pose", middle, other.seen.position.flags)
        known = Position("pose", WORLD) if one.seen.frame is None else self.positions.constants.known(one.seen.frame)
        if known is None:
            return None
        place = self.positions.job.point_of(
            target, tool, self.positions.job.cell.frame(known.values, one.seen.frame), None
        )
        line = " ".join(("MOVL", place, *speed, f"CR={tables.TAGS['CR'][0]:.1f}"))
        return [self.with_axes(line, place)]

    # ---- tags

    def tag(self, tag: str, value: ir.Expression, origin: Origin) -> str:
        """`V=100.0`; a computed value counts in parts of the unit."""
        known = constant(value)
        least, most, decimals = tables.TAGS[tag]
        if known is not None:
            written = number_text(min(max(known, least), most), decimals)
            if abs(float(written) - known) > 10.0**-decimals * 0.5000001:
                self.report_once(
                    RANGE, origin, f"{tag}{known}", tag=tag, value=known, written=written, least=least, most=most
                )
            return f"{tag}={float(written):.{decimals}f}"
        registers = self.positions.registers
        real, whole = registers.helper("R"), registers.helper("D")
        self.number(real, value)
        self.lines.extend([f"MUL {real} {float(tables.COUNTS[tag]):.1f}", f"ADD {real} 0.5", f"SET {whole} {real}"])
        return f"{tag}={whole}"

    def speed(self, move: ir.Move) -> list[str]:
        """VJ of a joint move, V or VR of another one."""
        speed, found = move.speed or ir.Speed(), []
        if move.kind == "joint":
            if speed.joint is not None:
                found.append(self.tag("VJ", speed.joint, move.origin))
            elif speed.path is not None:
                value = constant(speed.path)
                if value is None:
                    raise CannotSayError("a joint move with a computed tool speed")
                self.report_once(TOOL_SPEED, move.origin, factor=MM_S_PER_PERCENT)
                found.append(self.tag("VJ", ir.RealLiteral(value / MM_S_PER_PERCENT), move.origin))
        elif speed.path is not None:
            found.append(self.tag("V", speed.path, move.origin))
        elif speed.rotation is not None:
            found.append(self.tag("VR", speed.rotation, move.origin))
        if speed.duration is not None:
            self.report_once(LEFT_OUT, move.origin, "duration", what="a duration")
        if not found:
            self.report_once(NO_SPEED, move.origin)
        return found

    def strengths(self, move: ir.Move) -> list[str]:
        """ACC= and DEC=, in whole percent; nothing for the full one."""
        down = dict(_named(move)).get(_DOWN)
        found = []
        for tag, percent in (("ACC", move.acceleration), ("DEC", down)):
            known = None if percent is None else constant(percent)
            if percent is not None and known is None:
                self.report_once(LEFT_OUT, move.origin, tag, what="a computed acceleration")
            elif percent is not None and known is not None and known < tables.TAGS[tag][1]:
                found.append(self.tag(tag, percent, move.origin))
        return found

    def blend(self, move: ir.Move) -> list[str]:
        match move.blend:
            case None if move.kind == "spline":
                return []  # a point on the way
            case None | ir.BlendStop():
                return ["PL=0"]
            case ir.BlendLevel(level=level):
                return self.level(level)
            case ir.BlendDistance(distance=distance) if distance is not None:
                known = constant(distance)
                if known == 0:
                    return ["PL=0"]
                if move.kind != "joint":
                    return [self.tag("CR", distance, move.origin)]
                if known is None:
                    return self.computed_level(distance, move.origin)
                # a corner stays one: where it would be a stop, what follows would come later
                level_of = max(1, *(n for n, size in enumerate(tables.LEVELS) if size <= known))
                written = f"PL={level_of}"
                if tables.LEVELS[level_of] != known:
                    self.report_once(JOINT_CORNER, move.origin, written, distance=known, written=written)
                return [written]
        raise CannotSayError("this kind of corner")

    def computed_level(self, distance: ir.Expression, origin: Origin) -> list[str]:
        """The level of a corner that is not known before: looked up in the table of distances."""
        self.report_once(COMPUTED_CORNER, origin)
        registers = self.positions.registers
        real, level = registers.helper("R"), registers.helper("B")
        self.number(real, distance)
        for number in range(len(tables.LEVELS) - 1, 1, -1):
            word = "ELSEIFEXP" if number < len(tables.LEVELS) - 1 else "IFTHENEXP"
            self.lines.extend([f"{word} {real}>={tables.LEVELS[number]!r}", f"SET {level} {number}"])
        self.lines.extend([f"ELSEIFEXP {real}>0.0", f"SET {level} 1", "ELSE", f"SET {level} 0", "ENDIF"])
        return [f"PL={level}"]

    def level(self, level: ir.Expression) -> list[str]:
        known = constant(level)
        if known is None:
            shown = element(level)
            if shown is None:
                raise CannotSayError("a computed positioning level")
            return [f"PL={shown}"]
        if known == tables.STANDARD_LEVEL:
            return []
        if not 0 <= known < len(tables.LEVELS):
            raise CannotSayError(f"there is no positioning level {known:g}")
        return [f"PL={int(known)}"]

    def ending(self, move: ir.Move) -> list[str]:
        """NWAIT and UNTIL."""
        found = ["NWAIT"] if move.concurrent else []
        if move.search is not None:
            if move.search.stop == "none":
                raise CannotSayError("a search that does not stop the robot")
            condition = single(move.search.condition)
            if condition is None or "#" not in condition:
                raise CannotSayError("UNTIL looks at one input")
            found.append(f"UNTIL {condition}")
        return found


# Instructions during which a shift may hold; of those with a variable first, one that is not the shift's.
_QUIET = ("'", "DOUT ", "PULSE ", "TIMER ", "WAIT ", "MSG ", "AOUT ", "DIN ", "CLS")
_CHANGING = ("SET ", "ADD ", "SUB ", "MUL ", "DIV ", "INC ", "DEC ", "SETE ", "GETE ")


def joined_shifts(lines: Sequence[str]) -> list[str]:
    """The lines without a shift that ends and begins again in the same way before the next move."""
    done: list[str] = []
    ended: int | None = None  # the place of the last SFTOF, as long as nothing but quiet instructions follows
    shift = ""
    for line in lines:
        if line.startswith("SFTON "):
            if ended is not None and line == shift:
                del done[ended]
                ended = None
                continue
            shift, ended = line, None
        elif line == "SFTOF":
            ended = len(done)
        elif not line.startswith(_QUIET):
            quiet = line.startswith(_CHANGING) and shift != "" and line.split()[1] != shift.split()[1]
            ended = ended if quiet else None
        done.append(line)
    return done

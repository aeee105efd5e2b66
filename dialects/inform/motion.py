"""Moves: MOVJ, MOVL, MOVC, MOVS, IMOV, their coordinated forms (SMOVL ...), SPEED, searches and shifts.

A MOVC becomes a circular move without its auxiliary point; `arcs` puts consecutive ones together.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import cast

from rpl import ir
from rpl.diagnostics import Severity, code
from rpl.reading.shapes import StatementError

from . import tables
from .data import Data, Statements
from .early import Early, before
from .jobs import PULSE, Frame, Job
from .kinds import JOINTS, SHIFTED, TARGET, Flow, Kind, frame_of
from .operands import Shared, plain_bank, tags_of
from .points import Points
from .syntax import Command, Joined, LabelName, Numbered, Operand, Relation, Word

COORDINATED = code(
    "inform-coordinated",
    Severity.WARNING,
    "no station goes with {text}, so that nothing says what it is coordinated with; its path is taken in the room",
)
SECOND_ROBOT = code(
    "inform-second-robot", Severity.WARNING, "{text} moves a second robot at the same time; a run stops there"
)
UNKNOWN_TAG = code("inform-unknown-tag", Severity.WARNING, "{tag} at a move has no meaning here and is ignored")
OVERRUN = code(
    "inform-search-limits",
    Severity.WARNING,
    "{limits} at {word} is left out: it ends at the taught point and keeps the place of the signal",
    "teach the point so far that the signal comes before it",
)


Settings = tuple[tuple[ir.Expression, ir.Expression], ...]
FIRST_STATION = "ST1"


@dataclass(slots=True)
class _Segment:
    """One group's part of a move."""

    word: str
    positions: list[ir.Index] = field(default_factory=list)
    others: list[Operand] = field(default_factory=list)


_SEARCHES = (
    ("UNTIL", tables.UNTIL_MET),
    ("SRCH", tables.SEARCH_FOUND),
    ("NSRCH", tables.SEARCH_FOUND),  # M: the place is kept, the move goes on to its end
)
_UNDERSTOOD = frozenset(("NWAIT", "UNTIL", "SRCH", "NSRCH", "ENWAIT"))


class Motion(Data):
    """Instructions that move."""

    def __init__(self, shared: Shared, job: Job, flow: Flow) -> None:
        super().__init__(shared, job, flow)
        self.points = Points(job, self.diagnostics)
        self.early: Early | None = None  # the move just read has ENWAIT

    # ---- parts

    def segments(self, command: Command) -> list[_Segment]:
        found = [_Segment(command.word)]
        for item in command.items:
            if isinstance(item, Joined):
                found.append(_Segment(item.word))
            elif isinstance(item, ir.Index) and isinstance(item.base, ir.Name) and not found[-1].others:
                found[-1].positions.append(item)
            else:
                found[-1].others.append(item)
        return found

    def on_move(self, command: Command) -> Statements:
        main, *joined = self.segments(command)
        word = main.word.removeprefix("S")
        further = [position for segment in joined for position in segment.positions]
        if any(_bank(position) in ("C", "P") for position in further):
            text = " ".join(self.origin.text.split())
            self.report_once(SECOND_ROBOT, text, text=text)
            return (ir.Vendor("inform", text, "unknown", origin=self.origin),)
        arms = [position for position in main.positions if _bank(position) in ("C", "P")]
        axes = [position for position in (*main.positions, *further) if _bank(position) not in ("C", "P")]
        if len(arms) > 1:
            raise StatementError("two positions of one arm", 0)
        if not arms:
            return self.external_move(axes, main)
        target, kind = self.goal(arms[0], axes)
        beside = self.beside(joined)
        if main.word != word:
            beside = (*beside, *self.coordinated(axes))
        return self.move(word, target, kind, main, beside)

    def beside(self, joined: list[_Segment]) -> Settings:
        """What the parts behind a `+` say of their axes: VJ, the station's own speed in percent."""
        found: list[tuple[ir.Expression, ir.Expression]] = []
        for segment in joined:
            for tag, relation in tags_of(tuple(segment.others)):
                if tag in ("VJ", "VE"):
                    found.append((ir.System("external_speed", origin=self.origin), self.tagged(tag, relation.right)))
                else:
                    self.report_once(UNKNOWN_TAG, f"tag +{tag}", tag=f"{tag}= behind +{segment.word}")
        return tuple(found)

    def coordinated(self, axes: list[ir.Index]) -> Settings:
        """The path is straight (round) on the station that moves along. M: positions count in the room, as all others;
        the speed is that on the station; of several stations the first leads."""
        stations = [name for group in self.job.groups for name in group.split(",") if name.strip().startswith("ST")]
        leads = any(_bank(each) in ("EC", "EX") for each in axes)
        if not leads:
            text = " ".join(self.origin.text.split())
            self.report_once(COORDINATED, "coordinated", text=text)
            return ()
        leader = ir.TextLiteral(stations[0].strip() if stations else FIRST_STATION)
        return ((ir.System("coordinated", origin=self.origin), leader),)

    def goal(self, arm: ir.Index, axes: list[ir.Index]) -> tuple[ir.Expression, Kind]:
        """The target of a move with the base axes and station that go with it."""
        if _bank(arm) == "C":
            base = next((_number(each) for each in axes if _bank(each) == "BC"), None)
            station = next((_number(each) for each in axes if _bank(each) == "EC"), None)
            found = self.points.taught(_number(arm), base, station, self.origin)
            if found is None:
                raise StatementError("the point is not taught", 0)
            value, kind = found
            axes = [each for each in axes if _bank(each) not in ("BC", "EC")]
        else:
            value, kind = self.position(arm)
        for each in axes:
            value = self.call("with_external", value, self.axis_position(each))
        return value, kind

    def axis_position(self, position: ir.Index) -> ir.Expression:
        if _bank(position) in ("EC", "BC", "RC"):
            found = self.points.station(_bank(position), _number(position), self.origin)
            if found is None:
                raise StatementError("the point is not taught", 0)
            return found
        variable, number = self.variable(position), position.indices[0]
        saved = self.job.points.get((_bank(position), number.value)) if isinstance(number, ir.IntLiteral) else None
        return variable if saved is not None and saved.form != PULSE else self.call("external_from_pulses", variable)

    # ---- moves

    def move(self, word: str, target: ir.Expression, kind: Kind, main: _Segment, beside: Settings = ()) -> Statements:
        relative: str | None = None
        frame: ir.Expression | None = None
        if word == "IMOV":
            relative, frame = self.increment(kind, main)
        elif kind.frame.kind != "base":
            frame = self.frame(kind.frame)
        tool = self.tool(kind.tool)
        if self.flow.held(SHIFTED, self.state).form != "off" and relative is None:
            target, frame = self.shifted(target, kind, tool, frame)
        speed, blend, settings, acceleration = self.dynamics(main)
        search = self.search(main)
        move = ir.Move(
            tables.MOVE_KINDS[word],
            target,
            relative=relative,
            tool=tool,
            frame=frame,
            speed=speed,
            acceleration=acceleration,
            blend=ir.BlendStop() if search is not None and search.stop != "none" else blend,
            search=search,
            settings=(*settings, *beside),
            concurrent=Word("NWAIT") in main.others,
            group=self.group(),
            origin=self.origin,
        )
        self.check(main)
        if Word("ENWAIT") in main.others:
            self.early = self.before_the_end(main)
        if search is not None and search.found is not None and frame is not None:
            place = search.found
            in_base = self.call("displaced", place, frame)
            return move, ir.Assign(place, in_base, origin=self.origin)
        return (move,)

    def group(self) -> int:
        first = self.job.groups[0].split(",")[0] if self.job.groups else "RB1"
        return int(first[2:]) if first.startswith("RB") and first[2:].isdigit() else 1

    def increment(self, kind: Kind, main: _Segment) -> tuple[str, ir.Expression | None]:
        """IMOV: by how much, in which axes. M: without a frame those of the base."""
        where = next((found for item in main.others if (found := frame_of(item)) is not None), Frame())
        if kind.form == JOINTS:
            return "joints", None
        if where.kind == "tool":
            return "tool", None
        return "base", self.frame(where) if where.kind != "base" else None

    def shifted(
        self, target: ir.Expression, kind: Kind, tool: ir.Expression, frame: ir.Expression | None
    ) -> tuple[ir.Expression, ir.Expression]:
        """The goal while positions are shifted: in a frame that is moved by the shift."""
        self.shared.used.scalar(tables.SHIFT, ir.PoseType(), self.origin)
        shift: ir.Expression = ir.Name(tables.SHIFT, origin=self.origin)
        if kind.form == JOINTS:
            base = ir.System("null_frame", origin=self.origin)
            target = self.call("joints_to_target", target, tool, base)
        if self.shared.shifts_in_tool:
            self.shared.used.scalar(tables.SHIFT_IN_TOOL, ir.PoseType(), self.origin)
            target = self.call("displaced_in_tool", target, ir.Name(tables.SHIFT_IN_TOOL, origin=self.origin))
        return target, shift if frame is None else ir.Binary(":", shift, frame, origin=self.origin)

    def external_move(self, axes: list[ir.Index], main: _Segment) -> Statements:
        """A station alone."""
        if not axes:
            raise StatementError(f"{main.word} needs a position", len(main.word))
        target = self.axis_position(axes[0])
        speed, blend, _, _ = self.dynamics(main)
        self.check(main)
        if main.word == "IMOV":  # the arm by nothing, the station by so much
            still = tuple((f"j{n}", cast(ir.Expression, ir.RealLiteral(0.0))) for n in range(1, 7))
            amount = self.call("with_external", ir.Aggregate(still, "joints", origin=self.origin), target)
            return (ir.Move("joint", amount, relative="joints", speed=speed, blend=blend, origin=self.origin),)
        return (ir.MoveExternal(target, speed, blend, origin=self.origin),)

    def dynamics(
        self, main: _Segment
    ) -> tuple[ir.Speed | None, ir.Blend, tuple[tuple[ir.Expression, ir.Expression], ...], ir.Expression | None]:
        """Speed, blend, settings of this move only, acceleration."""
        parts: dict[str, ir.Expression] = {}
        level: ir.Expression = ir.IntLiteral(tables.STANDARD_LEVEL)
        blend: ir.Blend | None = None
        acceleration: ir.Expression | None = None
        settings: list[tuple[ir.Expression, ir.Expression]] = []
        for tag, relation in tags_of(tuple(main.others)):
            if tag not in ("V", "VR", "VJ", "VE", "PL", "CR", "ACC", "DEC"):
                continue
            value = self.tagged(tag, relation.right)
            match tag:
                case "V":
                    parts["path"] = value
                case "VR":
                    parts["rotation"] = value
                case "VJ" | "VE":
                    parts["joint"] = value
                case "PL":
                    number = value.value if isinstance(value, ir.IntLiteral) else 0
                    if number not in range(tables.STANDARD_LEVEL):
                        raise StatementError(f"there is no positioning level {number}", 0)
                    level = value
                case "CR":
                    blend = ir.BlendDistance(value)
                case "ACC":
                    acceleration = value
                case "DEC":
                    settings.append((ir.System("deceleration_percent", origin=self.origin), value))
        speed = ir.Speed(**parts) if parts else None
        return speed, blend or ir.BlendLevel(level), tuple(settings), acceleration

    def search(self, main: _Segment) -> ir.Search | None:
        """UNTIL stops the move by a condition; SRCH also keeps the place. M: both stop on the path."""
        for word, hit in _SEARCHES:
            if Word(word) not in main.others:
                continue
            at = main.others.index(Word(word))
            relation = main.others[at + 1] if at + 1 < len(main.others) else None
            if not isinstance(relation, Relation):
                raise StatementError(f"{word} needs a condition", 0)
            condition = self.comparison(relation)
            self.shared.used.scalar(hit, ir.BoolType(), self.origin)
            found: ir.Expression | None = None
            if word != "UNTIL":
                self.shared.used.scalar(tables.SEARCH_PLACE, ir.TargetType("inform"), self.origin)
                found = ir.Name(tables.SEARCH_PLACE, origin=self.origin)
                limits = [f"{tag}=" for tag, _ in tags_of(tuple(main.others[at + 2 :])) if tag in ("T", "DIS")]
                if limits:
                    self.diagnostics.report(OVERRUN, self.origin, limits=" and ".join(limits), word=word)
            stop = "none" if word == "NSRCH" else "path"
            return ir.Search(condition, found, stop, "rising", ir.Name(hit, origin=self.origin))
        return None

    def before_the_end(self, main: _Segment) -> Early:
        """`ENWAIT T=0.50`, `ENWAIT DIS=80.0`."""
        given = {
            tag: before(self.tagged(tag, relation.right), self.origin) for tag, relation in tags_of(tuple(main.others))
        }
        distance, delay = given.get("DIS"), given.get("T")
        if distance is None and delay is None:
            raise StatementError("ENWAIT needs T= or DIS=", 0)
        return Early(distance, delay)

    def check(self, main: _Segment) -> None:
        """Nothing at a move is dropped in silence."""
        searching = any(Word(word) in main.others for word in ("SRCH", "NSRCH", "UNTIL", "ENWAIT"))
        for item in main.others:
            match item:
                case Relation(left=Word(text=tag)):
                    known = tag in ("V", "VR", "VJ", "VE", "PL", "CR", "ACC", "DEC") or tag in tables.PLAIN_MOVE_TAGS
                    if not known and not (searching and tag in ("T", "DIS")):
                        self.report_once(UNKNOWN_TAG, f"tag {tag}", tag=f"{tag}=")
                case Relation() if searching:
                    continue
                case Word(text=text) if text in _UNDERSTOOD or text in tables.PLAIN_MOVE_WORDS:
                    continue
                case Word() | Numbered() if frame_of(item) is not None and main.word.endswith("IMOV"):
                    continue
                case LabelName(name=name) if Word("TRAP") in main.others:
                    self.report_once(UNKNOWN_TAG, f"trap {name}", tag=f"*{name}")
                case Numbered(word=word):
                    self.report_once(UNKNOWN_TAG, f"tag {word}", tag=f"{word}#")
                case Word(text=text):
                    self.report_once(UNKNOWN_TAG, f"tag {text}", tag=text)
                case _:
                    raise StatementError("an operand that a move does not take", 0)

    # ---- settings of motion

    def on_speed(self, command: Command) -> Statements:
        """SPEED VJ= V= VR=: of the moves that name none."""
        done: list[ir.Statement] = []
        names = {"VJ": ("joint_speed",), "V": ("path_speed",), "VR": ("swivel_speed", "twist_speed")}
        names["VE"] = ("external_speed",)
        for tag, relation in tags_of(command.items):
            if tag not in names:
                raise StatementError(f"SPEED has no {tag}=", 0)
            value = self.tagged(tag, relation.right)
            for name in names[tag]:
                done.append(ir.Assign(ir.System(name, origin=self.origin), value, origin=self.origin))
        return tuple(done)

    def on_shift(self, command: Command) -> Statements:
        """SFTON P frame: all positions are moved until SFTOF. M: by the pose P in the axes of the frame or the tool.
        SFTON3D P: by the pose P in the base, rotation included."""
        none = ir.System("null_frame", origin=self.origin)
        if command.word.startswith("SFTOF"):
            return self.shift_by(none, none)
        value, kind = self.position(self.needs(command, 1)[0])
        frame = frame_of(command.items[1]) if len(command.items) > 1 else kind.frame
        if kind.form != TARGET or frame is None or frame.kind not in ("base", "user", "tool"):
            raise StatementError(
                "SFTON is read with a pose in the base frame, in a user frame or in that of the tool", 0
            )
        shift = self.call("pose_of", value)
        if frame.kind == "tool":
            return self.shift_by(none, shift)
        if frame.kind == "user":
            axes = self.frame(frame)
            shift = ir.Binary(
                ":",
                ir.Binary(":", axes, shift, origin=self.origin),
                self.call("inverse", axes),
                origin=self.origin,
            )
        return self.shift_by(shift, none)

    def shift_by(self, in_base: ir.Expression, in_tool: ir.Expression) -> Statements:
        """The shift that holds from here on; M: one takes the place of the one before."""
        done: list[ir.Statement] = []
        for name, value in ((tables.SHIFT, in_base), (tables.SHIFT_IN_TOOL, in_tool)):
            if name == tables.SHIFT or self.shared.shifts_in_tool:
                self.shared.used.scalar(name, ir.PoseType(), self.origin)
                done.append(ir.Assign(ir.Name(name, origin=self.origin), value, origin=self.origin))
        return tuple(done)

    def on_getpos(self, command: Command) -> Statements:
        """GETPOS a STEP#(n): the n-th taught point of the job."""
        target, source = self.needs(command, 2)[:2]
        number = source.number if isinstance(source, Numbered) else None
        if not isinstance(number, ir.IntLiteral) or ("C", number.value) not in self.job.points:
            raise StatementError("GETPOS is read for a taught point of this job: STEP#(n)", 0)
        found = self.points.taught(number.value, *self.points.first.get(number.value, (None, None)), self.origin)
        assert found is not None  # it is among the points
        return self.set_position(target, *found)


def _bank(position: ir.Index) -> str:
    return plain_bank(cast(ir.Name, position.base).id)


def _number(position: ir.Index) -> int:
    number = position.indices[0]
    if not isinstance(number, ir.IntLiteral):
        raise StatementError("a taught point is named by its number", 0)
    return number.value

"""Actions on the way of a straight move whose ends are computed: the program computes the point and drives through it.

Moves between known points are cut in front of the writer (`cutmoves`). The pieces follow each other with the smallest
corner there is; the action stands behind its point. Behind the passes that give each move its tool, frame and speed,
and before those that take positions and functions apart.
"""

from __future__ import annotations

from dataclasses import dataclass, field, replace

from rpl import ir
from rpl.diagnostics import Severity, code
from rpl.ir.walk import walk
from rpl.passes import rigid
from rpl.passes.fold import Unchanged, constant, constant_number
from rpl.passes.legalise.context import Context
from rpl.passes.legalise.facts.motion.knownends import ends_known, in_base, seen_by_writers, written
from rpl.passes.legalise.facts.usage import base_name
from rpl.passes.legalise.kinds import walk_for
from rpl.passes.legalise.rewriting.beside import closure, moves_or_waits, tidy
from rpl.passes.legalise.rewriting.editing import Editor, edit_bodies, edit_routines
from rpl.passes.legalise.rewriting.formulas import plain
from rpl.passes.legalise.rewriting.jumps import inside
from rpl.passes.legalise.rewriting.library import Library
from rpl.passes.legalise.rewriting.refusedactions import ON_JOINT_MOVE
from rpl.passes.legalise.rewriting.stopping import stopped
from rpl.passes.legalise.stages import legalising
from rpl.passes.typing import type_of
from rpl.passes.values import Target

from .. import tables

COMPUTED = code(
    "path-event-point",
    Severity.WARNING,
    "an action on the path stands behind a point of the move that the program computes from its ends{order}",
)
SMALLER = code(
    "path-event-corner",
    Severity.WARNING,
    "an action on the path is {rest:.1f} mm before a corner of {corner:.1f} mm, which may be cut to half of that way",
)
_MOVED = {"base": "offset", "tool": "tool_offset"}  # what a relative move does to the place where it begins
_ORDER = "; what is counted from its start is done before what is counted from its end"
_NEAR_MM = 0.5  # an action that near to an end of the move is at the end
_SAME_TURN = 1.0 - 1e-12  # product of two quaternions
_CORNER_MM = tables.TAGS["CR"][0]  # of the points where moves are cut
_MOTION = (ir.Move, ir.MoveExternal, ir.Spline, ir.StopMotion, ir.StartMotion, ir.ClearMotion, ir.ResumeLevel)


@legalising(sees=("Trigger",))
def path_points(program: ir.Program, context: Context) -> ir.Program:
    """What happens at such a point stands behind it as a statement."""
    if not any(isinstance(node, ir.Trigger) for node in walk_for({"Trigger"}, *program.modules)):
        return program
    drivers = closure(program, _MOTION)
    unchanged, library = seen_by_writers(program, context), Library(context, ("geometry",))

    def work(editor: Editor, routine: ir.Routine) -> ir.Routine:
        return edit_bodies(routine, _Points(context, editor, drivers, unchanged, library).body)

    done = edit_routines(program, context, work)
    return library.added_to(done, done.modules[0].task)


@dataclass(frozen=True, slots=True)
class _Event:
    """An action `way` mm behind the start of a move or before its end; `known` where that is a constant."""

    trigger: ir.Trigger
    from_end: bool
    way: ir.Expression
    known: float | None

    @property
    def order(self) -> tuple[bool, float]:
        known = self.known or 0.0
        return self.from_end, -known if self.from_end else known


@dataclass(slots=True)
class _Points:
    context: Context
    editor: Editor
    drivers: frozenset[str]
    unchanged: Unchanged
    library: Library
    last: ir.Move | None = None  # the move before, as far as it is known and nothing has changed its data
    temporaries: dict[str, ir.Name] = field(default_factory=dict)

    # ---- bodies

    def body(self, body: ir.Body) -> ir.Body:
        done: list[ir.Statement] = []
        waiting: list[ir.Trigger] = []
        outer, self.last = self.last, None
        for at, statement in enumerate(body):
            match statement:
                case ir.Trigger():
                    waiting.append(statement)
                case ir.Move():
                    done.extend(self.move(statement, waiting, _goes_on(body, at + 1)))
                    waiting, self.last = [], statement
                case ir.Assign(target=target):
                    done.append(statement)
                    name = base_name(target)
                    if self.last is not None and any(_is(node, name) for node in walk(self.last)):
                        self.last = replace(self.last, target=ir.System("actual_pose"))
                case ir.Nothing() | ir.LookAhead():
                    done.append(statement)
                case _:
                    done.extend(waiting)
                    waiting = []
                    done.append(inside(statement, self.body))
                    if moves_or_waits(statement, self.drivers):
                        self.last = None
        done.extend(waiting)
        self.last = outer
        same = len(done) == len(body) and all(new is old for new, old in zip(done, body, strict=True))
        return body if same else tuple(done)

    def move(self, move: ir.Move, before: list[ir.Trigger], goes_on: bool) -> ir.Body:
        """The move in pieces, looked at on its way, or as it is. `goes_on`: the next move follows at once."""
        own = [one for one in move.triggers if isinstance(one, ir.Trigger)]
        given = [*before, *own]
        if not given or len(own) != len(move.triggers):
            return (*before, move)
        first = self.absolute(move)
        if first is not None:
            return (first[0], *self.move(first[1], before, goes_on))
        plain_move = move.kind == "linear" and not move.relative and move.search is None and not move.concurrent
        if not plain_move:
            told = move.kind == "circular" and written(move, given, self.editor.scope, self.unchanged)
            known = told and self.is_known(move, [])
            refused = [] if known else [one for one in given if self.on_joint_move(one, move)]
            if not refused:
                return (*before, move)
            stops = (stopped(one, ON_JOINT_MOVE, self.context) for one in refused)
            others = tuple(one for one in given if one not in refused)
            return (*stops, *others, replace(move, triggers=()))
        events = [self.event(one, move) for one in given]
        apart = sorted((one for one in events if one is not None), key=lambda one: one.order)
        unmeasured = any(_delayed(one) for one in given) and (move.speed is None or move.speed.path is None)
        timed = unmeasured or all(_by_time(one.trigger) for one in apart)
        unordered = len(apart) > 1 and any(one.known is None for one in apart)
        if not apart or timed or unordered or self.is_known(move, apart):
            return (*before, move)
        rest = [one for one, event in zip(given, events, strict=True) if event is None]
        starting = [one for one in rest if one.reference == "start"]
        ending = [one for one in rest if one.reference != "start"]
        mixed = len({one.from_end for one in apart}) > 1
        self.context.diagnostics.report(COMPUTED, given[0].origin, order=_ORDER if mixed else "")
        self.look_at_corner(move, apart[-1])
        pieces = self.pieces(replace(move, triggers=()), apart)
        return (*starting, *pieces, *ending, replace(move, triggers=(), origin=tidy(move.origin)))

    def absolute(self, move: ir.Move) -> tuple[ir.Statement, ir.Move] | None:
        """A straight move by a distance, from where the robot stands, with the step that computes where it ends."""
        last, way = self.last, move.target
        stands = last is None or last.blend in (None, ir.BlendStop())
        if move.kind != "linear" or move.relative not in _MOVED or not isinstance(way, ir.Aggregate) or not stands:
            return None
        given = dict(way.entries)
        if not given.keys() <= {"x", "y", "z"}:
            return None
        tool = move.tool if move.tool is not None else ir.System("tool")
        frame = move.frame if move.frame is not None else ir.System("null_frame")
        parts = tuple(given.get(name, ir.RealLiteral(0.0)) for name in "xyz")
        goal = self.temporary("goal", ir.PoseType())
        here = _pose(ir.Builtin("current_target", (tool, frame)))
        step = ir.Assign(goal, ir.Builtin(_MOVED[move.relative], (here, *parts)), origin=move.origin)
        return step, replace(move, target=goal, relative=None, origin=tidy(move.origin))

    def look_at_corner(self, move: ir.Move, last: _Event) -> None:
        """A corner takes at most half of the way between two points."""
        if not isinstance(move.blend, ir.BlendDistance) or move.blend.distance is None or not last.from_end:
            return
        size = constant_number(move.blend.distance, self.editor.scope, self.unchanged)
        if size is not None and last.known is not None and last.known - _CORNER_MM < 2 * size:
            self.context.diagnostics.report(SMALLER, move.origin, rest=last.known - _CORNER_MM, corner=size)

    def event(self, trigger: ir.Trigger, move: ir.Move) -> _Event | None:
        """None: it comes at an end of the move."""
        from_end = trigger.reference != "start"
        parts: list[ir.Expression] = []
        if trigger.distance is not None:
            parts.append(plain(trigger.distance))
        if trigger.delay is not None and move.speed is not None and move.speed.path is not None:
            parts.append(ir.Binary("*", plain(trigger.delay), plain(move.speed.path)))
        numbers = [constant_number(one, self.editor.scope, self.unchanged) for one in parts]
        if None not in numbers:
            sign = -1.0 if from_end else 1.0
            known = sign * sum(one for one in numbers if one is not None)
            if known < _NEAR_MM + (_CORNER_MM if from_end else 0.0):
                return None
            return _Event(trigger, from_end, ir.RealLiteral(float(f"{known:.9g}")), known)
        if from_end and self.is_late(trigger):
            return None
        far = [part for part, number in zip(parts, numbers, strict=True) if number != 0]
        way = far[0] if len(far) == 1 else ir.Binary("+", *far)
        return _Event(trigger, from_end, _opposite(way) if from_end else way, None)

    def is_late(self, trigger: ir.Trigger) -> bool:
        """Does it come some time behind the end, whatever the speed is?"""
        parts = (trigger.distance, trigger.delay)
        numbers = [
            0.0 if one is None else constant_number(plain(one), self.editor.scope, self.unchanged) for one in parts
        ]
        return None not in numbers and all(number >= 0.0 for number in numbers if number is not None)

    def on_joint_move(self, trigger: ir.Trigger, move: ir.Move) -> bool:
        """Does it come on the way of a joint move, before its end?"""
        if move.kind != "joint" or move.relative is not None or move.search is not None or move.concurrent:
            return False
        way, delay = (
            0.0 if one is None else constant_number(plain(one), self.editor.scope, self.unchanged)
            for one in (trigger.distance, trigger.delay)
        )
        return way is None or (trigger.reference != "start" and delay is not None and (way < 0.0 or delay < 0.0))

    def is_known(self, move: ir.Move, events: list[_Event]) -> bool:
        """Are both ends and the places constants that the writer sees as such?"""
        measured = all(one.known is not None for one in events)
        return measured and ends_known(self.last, move, self.editor.scope, self.unchanged)

    # ---- the pieces

    def pieces(self, move: ir.Move, events: list[_Event]) -> list[ir.Statement]:
        """Up to the last action."""
        done: list[ir.Statement] = []
        start, end, frame = self.ends(move)
        turns = not self.same_rotation(start, end)
        one, other, point = (self.temporary(name, ir.PoseType()) for name in ("from", "to", "point"))
        length, share = (self.temporary(name, ir.RealType()) for name in ("length", "share"))
        done.append(ir.Assign(one, start, origin=move.origin))
        done.append(ir.Assign(other, end))
        done.append(ir.Assign(length, ir.Builtin("distance", (ir.Field(one, "trans"), ir.Field(other, "trans")))))
        smallest = ir.BlendDistance(ir.RealLiteral(_CORNER_MM))
        for at, event in enumerate(events):
            again = at > 0 and event.known is not None and event.order == events[at - 1].order
            if not again:
                done.extend(_shared(event, length, share))
                done.extend(self.placed(one, other, point, share) if turns else _placed(one, other, point, share))
                done.append(replace(move, target=point, frame=frame, blend=smallest, origin=tidy(move.origin)))
            action = event.trigger.action
            done.append(replace(action, origin=event.trigger.origin))
        return [s if s.origin.source is not None else replace(s, origin=tidy(move.origin)) for s in done]

    def placed(self, one: ir.Name, other: ir.Name, point: ir.Name, share: ir.Name) -> ir.Body:
        """The point between ends where the tool is turned differently."""
        return (ir.Assign(point, self.library.call("rpl_interpolate_pose", one, other, share)),)

    def temporary(self, stem: str, type: ir.Type) -> ir.Name:
        if stem not in self.temporaries:
            self.temporaries[stem] = self.editor.temporary(stem, type)
        return self.temporaries[stem]

    def ends(self, move: ir.Move) -> tuple[ir.Expression, ir.Expression, ir.Expression | None]:
        """Start and end of the move in the frame that is the third."""
        last, scope = self.last, self.editor.scope
        known = last is not None and last.relative is None and last.tool == move.tool
        if known and last is not None and last.target != ir.System("actual_pose"):
            type = type_of(last.target, scope)
            if last.frame == move.frame and isinstance(type, ir.PoseType | ir.TargetType):
                return _pose(last.target), _pose(move.target), move.frame
            if not isinstance(last.blend, ir.BlendStop | None):
                return in_base(last, last.target, type), in_base(move, move.target, ir.PoseType()), None
        tool = move.tool if move.tool is not None else ir.System("tool")
        frame = move.frame if move.frame is not None else ir.System("null_frame")
        return _pose(ir.Builtin("current_target", (tool, frame))), _pose(move.target), move.frame

    def same_rotation(self, one: ir.Expression, other: ir.Expression) -> bool:
        """Is the tool certainly turned the same way at both?"""
        values = [constant(_rotated_as(end), self.editor.scope, self.unchanged) for end in (one, other)]
        poses = [value.pose if isinstance(value, Target) else value for value in values]
        first, second = poses
        if not isinstance(first, rigid.Pose) or not isinstance(second, rigid.Pose):
            return False
        pairs = zip(first.rotation.quaternion, second.rotation.quaternion, strict=True)
        return abs(sum(a * b for a, b in pairs)) > _SAME_TURN


def _goes_on(body: ir.Body, begin: int) -> bool:
    """Does the next move follow from there on without anything that is seen or takes time?"""
    for at in range(begin, len(body)):
        match body[at]:
            case ir.Move():
                return True
            case ir.Nothing() | ir.LookAhead() | ir.Trigger():
                continue
            case ir.Assign(target=target) if base_name(target) is not None:
                continue
        return False
    return False


def _is(node: object, name: str | None) -> bool:
    return isinstance(node, ir.Name) and node.id.lower() == name


def _opposite(way: ir.Expression) -> ir.Expression:
    return way.operand if isinstance(way, ir.Unary) and way.op == "-" else ir.Unary("-", way)


def _by_time(trigger: ir.Trigger) -> bool:
    """Does it come some time behind the start of the move, which a writer can count?"""
    return trigger.reference == "start" and trigger.distance in (None, ir.IntLiteral(0), ir.RealLiteral(0.0))


def _delayed(trigger: ir.Trigger) -> bool:
    return trigger.delay is not None and plain(trigger.delay) not in (ir.IntLiteral(0), ir.RealLiteral(0.0))


def _pose(target: ir.Expression) -> ir.Expression:
    return ir.Builtin("pose_of", (target,))


def _rotated_as(place: ir.Expression) -> ir.Expression:
    """A place that is turned the same way."""
    while isinstance(place, ir.Builtin) and place.function in ("offset", "pose_of"):
        place = place.arguments[0]
    return place


def _shared(event: _Event, length: ir.Name, share: ir.Name) -> ir.Body:
    """How much of the way is done at the point; what stands behind the point is done where its corner begins."""
    far = _moved(event, -_CORNER_MM if event.from_end else _CORNER_MM)
    part: ir.Expression = ir.Binary("/", far, length)
    if event.from_end:
        part = ir.Binary("-", ir.RealLiteral(1.0), part)
    beyond = ir.RealLiteral(0.0 if event.from_end else 1.0)
    too_short = (ir.Binary("<=", length, far), (ir.Assign(share, beyond),))
    return (ir.If((too_short,), (ir.Assign(share, part),)),)


def _moved(event: _Event, by: float) -> ir.Expression:
    if event.known is not None:
        return ir.RealLiteral(float(f"{event.known + by:.9g}"))
    return ir.Binary("+", event.way, ir.RealLiteral(by))


def _placed(one: ir.Name, other: ir.Name, point: ir.Name, share: ir.Name) -> ir.Body:
    """The point between ends where the tool is turned the same way."""
    done: list[ir.Statement] = [ir.Assign(point, one)]
    for name in ("x", "y", "z"):
        way = ir.Binary("-", ir.Field(other, name), ir.Field(one, name))
        value = ir.Binary("+", ir.Field(one, name), ir.Binary("*", way, share))
        done.append(ir.Assign(ir.Field(point, name), value))
    return tuple(done)


__all__ = ["path_points"]

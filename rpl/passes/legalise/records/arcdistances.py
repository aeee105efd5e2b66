"""Places on the way of an arc for targets that look how far the tool is straight from the arc's end (or its start).

Two points of an arc that lie w apart along it are 2 R sin(w / 2R) from each other. Where the three points of the arc
are constants, the number is; else the program computes it in front of the move. Behind the passes that give each move
its tool and frame, and before those that take positions and functions apart.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, field, replace

from rpl import ir
from rpl.diagnostics import Severity, code
from rpl.ir.walk import walk
from rpl.passes import rigid
from rpl.passes.capabilities import PathRule
from rpl.passes.curves import circle_through
from rpl.passes.fold import Unchanged, constant, constant_number
from rpl.passes.legalise.context import Context
from rpl.passes.legalise.facts.usage import base_name, usage_of
from rpl.passes.legalise.records.pathevents import in_base
from rpl.passes.legalise.rewriting.beside import closure, moves_or_waits, tidy
from rpl.passes.legalise.rewriting.editing import Editor, edit_bodies, edit_routines
from rpl.passes.legalise.rewriting.jumps import inside
from rpl.passes.legalise.rewriting.library import function, minus, number, plus, times
from rpl.passes.legalise.rewriting.stopping import stopped
from rpl.passes.legalise.rewriting.support import with_support
from rpl.passes.legalise.settings.movesettings import plain
from rpl.passes.legalise.stages import legalising
from rpl.passes.typing import type_of
from rpl.passes.values import Target

STRAIGHT = code(
    "path-event-straight",
    Severity.WARNING,
    "the target measures straight from the end of an arc (or its start) to a place on its way; the program computes how"
    " far that is",
)
TIMED = code(
    "path-event-timed-on-arc",
    Severity.LOSS,
    "an action on an arc comes a time before or behind a place on its way; the target knows only how far straight the"
    " tool is from the arc's ends",
    "give the place on the arc as a constant distance from its end, or the action to a move of its own",
    stops=True,
)
_MOTION = (ir.Move, ir.MoveExternal, ir.Spline, ir.StopMotion, ir.StartMotion, ir.ClearMotion, ir.ResumeLevel)
_REAL = ir.RealType()
_WITHIN = 0.999  # of the arc: a place farther than that from one end is at the other


@legalising()
def arc_distances(program: ir.Program, context: Context) -> ir.Program:
    """Only for targets that measure places on a path straight."""
    nodes = walk(*program.modules) if PathRule.STRAIGHT_DISTANCES in context.capabilities.motion.paths else ()
    if not any(isinstance(node, ir.Trigger) for node in nodes):
        return program
    unchanged = Unchanged(usage_of(program).assigned)
    shared = _Shared(closure(program, _MOTION), unchanged, context.fresh("rpl_straight"))

    def work(editor: Editor, routine: ir.Routine) -> ir.Routine:
        return edit_bodies(routine, _Arcs(context, editor, shared).body)

    done = edit_routines(program, context, work)
    return with_support(done, context, (), (_function(shared.name),)) if shared.used else done


@dataclass(slots=True)
class _Shared:
    drivers: frozenset[str]
    unchanged: Unchanged
    name: str
    used: bool = False


@dataclass(slots=True)
class _Arcs:
    context: Context
    editor: Editor
    shared: _Shared
    last: ir.Move | None = None  # the move before, as far as it is known and nothing has changed its data
    temporaries: dict[str, ir.Name] = field(default_factory=dict)

    def body(self, body: ir.Body) -> ir.Body:
        done: list[ir.Statement] = []
        waiting: list[ir.Trigger] = []
        outer, self.last = self.last, None
        for statement in body:
            match statement:
                case ir.Trigger():
                    waiting.append(statement)
                    continue
                case ir.Move():
                    done.extend(self.move(statement, waiting))
                    waiting, self.last = [], statement
                    continue
                case ir.Assign(target=target):
                    name = base_name(target)
                    if self.last is not None and any(_is(node, name) for node in walk(self.last)):
                        self.last = None
                    done.append(statement)
                    continue
                case ir.Nothing() | ir.LookAhead():
                    done.append(statement)
                    continue
            done.extend(waiting)
            waiting = []
            done.append(inside(statement, self.body))
            if moves_or_waits(statement, self.shared.drivers):
                self.last = None
        done.extend(waiting)
        self.last = outer
        same = len(done) == len(body) and all(new is old for new, old in zip(done, body, strict=True))
        return body if same else tuple(done)

    def move(self, move: ir.Move, before: list[ir.Trigger]) -> ir.Body:
        given = [one for one in (*before, *move.triggers) if isinstance(one, ir.Trigger)]
        cut = self.context.capabilities.motion.cut_from_mm and written(move, given, self.editor, self.shared.unchanged)
        if cut and ends_known(self.last, move, self.editor, self.shared.unchanged):
            return (*before, move)  # the writer cuts the arc itself
        stops, move, before = self.without(move, before)
        return (*stops, *self.straight(move, before))

    def without(self, move: ir.Move, before: list[ir.Trigger]) -> tuple[ir.Body, ir.Move, list[ir.Trigger]]:
        """The stops for actions that are refused on an arc, and the move with the others."""
        if move.kind != "circular":
            return (), move, before
        own = [one for one in move.triggers if isinstance(one, ir.Trigger)]
        refused = [one for one in (*before, *own) if self.is_timed(one, move)]
        if not refused:
            return (), move, before
        stops = tuple(stopped(one, TIMED, self.context) for one in refused)
        kept = tuple(one for one in move.triggers if one not in refused)
        return stops, replace(move, triggers=kept), [one for one in before if one not in refused]

    def is_timed(self, trigger: ir.Trigger, move: ir.Move) -> bool:
        """Does it come a time before or behind a place on the way? At the start, and behind an end where the robot
        stands, the way does not matter."""
        delay = None if trigger.delay is None else self.number(trigger.delay)
        if trigger.delay is None or delay == 0.0:
            return False
        at_point = self.known(trigger) == 0.0 and delay is not None
        stands = isinstance(move.blend, ir.BlendStop | None)
        late = trigger.reference == "end" and stands and delay is not None and delay > 0.0
        return not (at_point and (trigger.reference == "start" or late))

    def straight(self, move: ir.Move, before: list[ir.Trigger]) -> ir.Body:
        own = [one for one in move.triggers if isinstance(one, ir.Trigger)]
        far = [one for one in (*before, *own) if self.is_far(one)]
        if move.kind != "circular" or move.via is None or move.relative or move.swept is not None or not far:
            return (*before, move)
        if any(self.known(one) is None for one in far):
            return self.computed(move, before)
        points = self.points(move)
        if points is None:
            return self.computed(move, before)
        arc = _arc(points)
        if arc is None:
            return (*before, move)
        given = [_constant(one, self.known(one) or 0.0, *arc) if one in far else one for one in before]
        at_move = tuple(
            _constant(one, self.known(one) or 0.0, *arc) if isinstance(one, ir.Trigger) and one in far else one
            for one in move.triggers
        )
        return (*given, replace(move, triggers=at_move))

    def is_far(self, trigger: ir.Trigger) -> bool:
        return trigger.distance is not None and self.known(trigger) != 0.0 and trigger.reference != "middle"

    def known(self, trigger: ir.Trigger) -> float | None:
        """The distance in mm, where it is a constant."""
        return 0.0 if trigger.distance is None else self.number(trigger.distance)

    def number(self, value: ir.Expression) -> float | None:
        return constant_number(plain(value), self.editor.scope, self.shared.unchanged)

    # ---- the arc

    def points(self, move: ir.Move) -> list[rigid.Vector] | None:
        """Start, point on the way and end, where all are constants."""
        if self.last is None or self.last.relative or move.via is None:
            return None
        found = []
        for one, target in ((self.last, self.last.target), (move, move.via), (move, move.target)):
            value = constant(self.in_base(one, target), self.editor.scope, self.shared.unchanged)
            pose = value.pose if isinstance(value, Target) else value
            if not isinstance(pose, rigid.Pose):
                return None
            found.append(pose.position)
        return found

    def in_base(self, move: ir.Move, target: ir.Expression) -> ir.Expression:
        return in_base(move, target, type_of(target, self.editor.scope))

    def computed(self, move: ir.Move, before: list[ir.Trigger]) -> ir.Body:
        """The distances are worked out in front of the move, in its frame."""
        assert move.via is not None  # asked for by the caller
        self.shared.used = True
        self.context.diagnostics.report(STRAIGHT, move.origin)
        places = [self.temporary(f"arc_{name}", ir.PoseType()) for name in ("start", "via", "end")]
        sides = [self.temporary(f"side{n}", _REAL) for n in (1, 2, 3)]
        steps: list[ir.Statement] = []
        steps += [ir.Assign(place, value) for place, value in zip(places, self.ends(move), strict=True)]
        for side, one, other in zip(sides, (1, 0, 0), (2, 2, 1), strict=True):
            steps.append(ir.Assign(side, ir.Builtin("distance", (places[one], places[other]))))
        ways: list[tuple[ir.Expression, ir.Name]] = []

        def straight(trigger: ir.Trigger) -> ir.Trigger:
            if not self.is_far(trigger) or trigger.distance is None:
                return trigger
            distance = plain(trigger.distance)
            at_start = trigger.reference == "start"
            way = distance if at_start else _opposite(distance)
            goal = next((name for one, name in ways if one == way), None)
            if goal is None:
                goal = self.editor.temporary("straight", _REAL)
                ways.append((way, goal))
                steps.append(ir.Assign(goal, ir.Call(self.shared.name, tuple(map(ir.Argument, (way, *sides))))))
            return replace(trigger, distance=goal if at_start else ir.Unary("-", goal))

        given = [straight(one) for one in before]
        at_move = tuple(straight(one) if isinstance(one, ir.Trigger) else one for one in move.triggers)
        done = replace(move, triggers=at_move)
        if steps[2] == ir.Assign(places[2], _pose(move.target)):  # in the move's frame: the places serve it too
            done = replace(done, via=self.served(move.via, places[1]), target=self.served(move.target, places[2]))
        return (*(replace(one, origin=tidy(move.origin)) for one in steps), *given, done)

    def served(self, target: ir.Expression, place: ir.Name) -> ir.Expression:
        return place if isinstance(self.editor.type_of(target), ir.PoseType) else target

    def temporary(self, stem: str, type: ir.Type) -> ir.Name:
        if stem not in self.temporaries:
            self.temporaries[stem] = self.editor.temporary(stem, type)
        return self.temporaries[stem]

    def ends(self, move: ir.Move) -> tuple[ir.Expression, ir.Expression, ir.Expression]:
        """Start, point on the way and end, all in one frame."""
        last = self.last
        assert move.via is not None  # asked for by the caller
        here = (_pose(move.via), _pose(move.target))
        if last is not None and last.relative is None and last.tool == move.tool and last.search is None:
            type = type_of(last.target, self.editor.scope)
            if last.frame == move.frame and isinstance(type, ir.PoseType | ir.TargetType):
                return _pose(last.target), *here
            if not isinstance(last.blend, ir.BlendStop | None):
                inner = self.in_base(move, move.via), self.in_base(move, move.target)
                return self.in_base(last, last.target), *inner
        tool = move.tool if move.tool is not None else ir.System("tool")
        frame = move.frame if move.frame is not None else ir.System("null_frame")
        return _pose(ir.Builtin("current_target", (tool, frame))), *here


def ends_known(last: ir.Move | None, move: ir.Move, editor: Editor, unchanged: Unchanged) -> bool:
    """Are both ends of a move constants that a writer sees as such?"""
    if last is None or any(isinstance(one.target, ir.Builtin) for one in (last, move)):
        return False  # not known, or computed from a constant by the program itself
    type = type_of(last.target, editor.scope)
    start = last.target if type is None else in_base(last, last.target, type)
    ends = (start, in_base(move, move.target, type_of(move.target, editor.scope)))
    return all(constant(one, editor.scope, unchanged) is not None for one in ends)


def written(move: ir.Move, triggers: Sequence[ir.Trigger], editor: Editor, unchanged: Unchanged) -> bool:
    """Are the places of these actions along the move constants?"""
    parts = [one for trigger in triggers for one in (trigger.distance, trigger.delay) if one is not None]
    delays = [plain(one.delay) for one in triggers if one.delay is not None]
    if (
        move.speed is not None
        and move.speed.path is not None
        and any(constant_number(one, editor.scope) != 0 for one in delays)
    ):
        parts.append(move.speed.path)
    return all(constant_number(plain(one), editor.scope, unchanged) is not None for one in parts)


def _arc(points: list[rigid.Vector]) -> tuple[float, float] | None:
    """Radius and length of an arc through three points, mm; None where they are on a line."""
    start, via, end = points
    circle = circle_through(start, via, end)
    return None if circle is None else (circle.radius, circle.radius * circle.sweep)


def _constant(trigger: ir.Trigger, distance: float, radius: float, length: float) -> ir.Trigger:
    """The trigger by how far the place is straight from that end of the arc which is less than half a circle away."""
    at_start = trigger.reference == "start"
    way = distance if at_start else -distance
    half = math.pi * radius
    if half < way < length and length - way < half:
        way, at_start = length - way, not at_start
    straight = 2.0 * radius * math.sin(min(way, _WITHIN * length, half) / (2.0 * radius))
    value = ir.RealLiteral(float(f"{straight if at_start else -straight:.9g}"))
    return replace(trigger, reference="start" if at_start else "end", distance=value)


def _function(name: str) -> ir.Routine:
    """How far two points of an arc are from each other straight that lie `way` mm apart along it. `a`, `b`, `c`: the
    distances between the arc's point on the way and its end, its start and its end, its start and that point."""
    way, a, b, c, square, half, far = map(ir.Name, ("way", "a", "b", "c", "square", "half", "far"))
    shorter = function("min", far, times(number(_WITHIN), b))  # of at most half a circle: no farther than its ends
    whole = plus(a, b, c)
    product = times(whole, minus(plus(b, c), a), minus(plus(a, c), b), minus(plus(a, b), c))
    twice = function("sqrt", square)  # a b c / its root is the radius
    turned = ir.Binary("/", times(way, twice), times(number(2.0), a, b, c))
    body: ir.Body = (
        ir.Assign(square, product),
        ir.If(((ir.Binary("<=", square, number(1e-9)), (ir.Return(way),)),)),
        ir.Assign(half, function("min", times(turned, number(round(math.degrees(1.0), 9))), number(90.0))),
        ir.Assign(far, ir.Binary("/", times(number(2.0), a, b, c, function("sin", half)), twice)),
        ir.If(((ir.Binary(">=", times(b, b), plus(times(a, a), times(c, c))), (ir.Return(shorter),)),)),
        ir.Return(far),
    )
    return ir.Routine(
        name,
        "function",
        tuple(ir.Parameter(one, _REAL) for one in ("way", "a", "b", "c")),
        _REAL,
        tuple(ir.Variable(one, _REAL, scope="routine") for one in ("square", "half", "far")),
        body,
        scope="global",
    )


def _is(node: object, name: str | None) -> bool:
    return isinstance(node, ir.Name) and node.id.lower() == name


def _opposite(way: ir.Expression) -> ir.Expression:
    return way.operand if isinstance(way, ir.Unary) and way.op == "-" else ir.Unary("-", way)


def _pose(target: ir.Expression) -> ir.Expression:
    return ir.Builtin("pose_of", (target,))


__all__ = ["TIMED", "arc_distances", "ends_known", "written"]

"""Places on the way of an arc for targets that look how far the tool is straight from the arc's end (or its start).

Two points of an arc that lie w apart along it are 2 R sin(w / 2R) from each other. Where the three points of the arc
and the place are constants, so is that number; else the action is refused. Behind the passes that give each move its
tool and frame, and before those that take positions and functions apart.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

from rpl import ir
from rpl.diagnostics import Code, Severity, code
from rpl.ir.walk import walk
from rpl.passes import rigid
from rpl.passes.capabilities import PathRule
from rpl.passes.curves import circle_through
from rpl.passes.fold import Unchanged, constant, constant_number
from rpl.passes.legalise.context import Context
from rpl.passes.legalise.facts.motion.knownends import ends_known, in_base, seen_by_writers, written
from rpl.passes.legalise.facts.usage import base_name
from rpl.passes.legalise.kinds import walk_for
from rpl.passes.legalise.rewriting.beside import closure, moves_or_waits
from rpl.passes.legalise.rewriting.editing import Editor, edit_bodies, edit_routines
from rpl.passes.legalise.rewriting.formulas import plain
from rpl.passes.legalise.rewriting.jumps import inside
from rpl.passes.legalise.rewriting.stopping import stopped
from rpl.passes.legalise.stages import legalising
from rpl.passes.typing import type_of
from rpl.passes.values import Target

STRAIGHT = code(
    "path-event-computed-on-arc",
    Severity.LOSS,
    "the target measures straight from the end of an arc (or its start) to a place on its way, and how far that is only"
    " the run knows",
    "give the points of the arc and the place as constants, or end a move at the place",
    stops=True,
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
_WITHIN = 0.999  # of the arc: a place farther than that from one end is at the other


@legalising(
    unless=lambda context: PathRule.STRAIGHT_DISTANCES not in context.capabilities.motion.paths, sees=("Trigger",)
)
def arc_distances(program: ir.Program, context: Context) -> ir.Program:
    """Only for targets that measure places on a path straight."""
    if not any(isinstance(node, ir.Trigger) for node in walk_for({"Trigger"}, *program.modules)):
        return program
    unchanged = seen_by_writers(program, context)
    drivers = closure(program, _MOTION)

    def work(editor: Editor, routine: ir.Routine) -> ir.Routine:
        return edit_bodies(routine, _Arcs(context, editor, drivers, unchanged).body)

    return edit_routines(program, context, work)


@dataclass(slots=True)
class _Arcs:
    context: Context
    editor: Editor
    drivers: frozenset[str]
    unchanged: Unchanged
    last: ir.Move | None = None  # the move before, as far as it is known and nothing has changed its data

    @property
    def cuts(self) -> bool:
        """Are moves between constants cut, so that what is not cut here has no constants?"""
        return PathRule.CUT in self.context.capabilities.motion.paths

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
            if moves_or_waits(statement, self.drivers):
                self.last = None
        done.extend(waiting)
        self.last = outer
        same = len(done) == len(body) and all(new is old for new, old in zip(done, body, strict=True))
        return body if same else tuple(done)

    def move(self, move: ir.Move, before: list[ir.Trigger]) -> ir.Body:
        given = [one for one in (*before, *move.triggers) if isinstance(one, ir.Trigger)]
        cut = self.cuts and written(move, given, self.editor.scope, self.unchanged)
        if cut and ends_known(self.last, move, self.editor.scope, self.unchanged):
            return (*before, move)  # a pass of the target cuts the arc itself
        if move.kind != "circular":
            return (*before, move)
        stops, move, before = self.without(move, before, [one for one in given if self.is_timed(one, move)], TIMED)
        return (*stops, *self.straight(move, before))

    def without(
        self, move: ir.Move, before: list[ir.Trigger], refused: list[ir.Trigger], why: Code
    ) -> tuple[ir.Body, ir.Move, list[ir.Trigger]]:
        """The stops for actions that are refused on an arc, and the move with the others."""
        if not refused:
            return (), move, before
        stops = tuple(stopped(one, why, self.context) for one in refused)
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
        if move.via is None or move.relative or move.swept is not None or not far:
            return (*before, move)
        points = self.points(move)
        computed = far if points is None else [one for one in far if self.known(one) is None]
        stops, move, before = self.without(move, before, computed, STRAIGHT)
        arc = None if points is None else _arc(points)
        if arc is None:
            return (*stops, *before, move)
        given = [_constant(one, self.known(one) or 0.0, *arc) if one in far else one for one in before]
        at_move = tuple(
            _constant(one, self.known(one) or 0.0, *arc) if isinstance(one, ir.Trigger) and one in far else one
            for one in move.triggers
        )
        return (*stops, *given, replace(move, triggers=at_move))

    def is_far(self, trigger: ir.Trigger) -> bool:
        return trigger.distance is not None and self.known(trigger) != 0.0 and trigger.reference != "middle"

    def known(self, trigger: ir.Trigger) -> float | None:
        """The distance in mm, where it is a constant."""
        return 0.0 if trigger.distance is None else self.number(trigger.distance)

    def number(self, value: ir.Expression) -> float | None:
        return constant_number(plain(value), self.editor.scope, self.unchanged)

    # ---- the arc

    def points(self, move: ir.Move) -> list[rigid.Vector] | None:
        """Start, point on the way and end, where all are constants."""
        if self.cuts or self.last is None or self.last.relative or move.via is None:
            return None
        found = []
        for one, target in ((self.last, self.last.target), (move, move.via), (move, move.target)):
            value = constant(self.in_base(one, target), self.editor.scope, self.unchanged)
            pose = value.pose if isinstance(value, Target) else value
            if not isinstance(pose, rigid.Pose):
                return None
            found.append(pose.position)
        return found

    def in_base(self, move: ir.Move, target: ir.Expression) -> ir.Expression:
        return in_base(move, target, type_of(target, self.editor.scope))


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


def _is(node: object, name: str | None) -> bool:
    return isinstance(node, ir.Name) and node.id.lower() == name


__all__ = ["STRAIGHT", "TIMED", "arc_distances"]

"""Actions on the way of a move become steps beside it; a linear or circular move is cut at the points where they are.

A controller has no instruction that says a distance on a path. Where both ends of a move are constants, the point is
computed, and the robot goes through it with the smallest corner; the action stands behind that point. What acts where
the move begins stands behind one that the program does not wait for (NWAIT), so does what acts some time later.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field, replace

from rpl import ir
from rpl.diagnostics import Severity, code
from rpl.emulator.rotations import rotation_angle
from rpl.passes.legalise.facts.effects import blocks
from rpl.passes.legalise.kinds import walk_for
from rpl.passes.legalise.rewriting.editing import edit_each
from rpl.passes.rewrite import rewrite_bodies, same
from rpl.source import Origin
from rpl.writing.statements import CannotSayError
from rpl.writing.target import WriteContext

from .. import tables
from ..facts.reached import Ends, Reached, ends_exactly, same_tool
from ..facts.tasks import started_first
from ..job import pose_of_joints
from ..operands import constant
from ..places import WORLD, Constants, Position, Values, inverse, matrix, product
from ..unchanged import unchanged
from ..ways import Flags, Way, arc, line

CUT = code(
    "inform-path-event",
    Severity.WARNING,
    "an action on the path stands behind a point that the move is cut at, {along:.1f} mm from its start",
)
IN_CORNER = code(
    "inform-corner-event",
    Severity.WARNING,
    "an action in the corner between two moves is done where the corner begins",
)
SMALLER = code(
    "inform-smaller-corner",
    Severity.WARNING,
    "an action on the path is {rest:.1f} mm before a corner of {corner:.1f} mm, which is cut to half of that way",
)
LOST = code(
    "inform-path-event-lost",
    Severity.LOSS,
    "INFORM cannot say an action at a place on the path here: {reason}",
    "the program stops there with PAUSE; teach a point where the action happens",
)
Action = ir.Assign | ir.CallRoutine
_NEAR_MM = 0.5  # an action that near to an end of the move is at the end
_SAME_RAD = 1e-4
_CORNER_MM = tables.TAGS["CR"][0]


def cut_moves(program: ir.Program, context: WriteContext) -> ir.Program:
    """A move keeps its actions where nothing can say where they happen, and in jobs that nobody has changed."""
    if not any(isinstance(node, ir.Move) and node.triggers for node in walk_for({"Move"}, *program.modules)):
        return program
    if not context.foreign and not context.templates and unchanged(program, context) is not None:
        return program  # the jobs are written as they stand in their files
    constants = Constants.of(program, started_first(program))
    constants.names = {f"{bank}{number}": name for (bank, number), name in context.register_names.items()}
    known: dict[int, Constants] = {}

    def of(routine: ir.Routine) -> Constants:
        return known.setdefault(id(routine), constants.routine(routine))

    ends = Ends(program, of)

    def work(_: ir.Module, routine: ir.Routine) -> ir.Routine:
        cuts = _Cuts(context, of(routine), ends)
        body = cuts.body(routine.body)
        return routine if body is routine.body else replace(routine, body=body)

    return edit_each(program, work)


@dataclass(slots=True)
class _Parts:
    """A move with what happens on its way: at its start, some time later, where it is cut, and at its end."""

    begun: list[Action] = field(default_factory=list)
    later: list[tuple[ir.Expression, Action]] = field(default_factory=list)  # so long after the start, in order
    cuts: list[tuple[ir.Move, list[Action]]] = field(default_factory=list)
    ended: list[Action] = field(default_factory=list)
    last: ir.Move | None = None  # what is left behind the cuts, where it is not the move itself


@dataclass(slots=True)
class _Cuts:
    context: WriteContext
    constants: Constants
    ends: Ends
    cornered: set[int] = field(default_factory=set)  # lines whose actions in a corner are reported

    # ---- bodies

    def body(self, body: ir.Body) -> ir.Body:
        """The statements with the steps of the actions. Behind a move with NWAIT the program goes on to anything but
        the next move only where the robot has arrived."""
        done: list[ir.Statement] = []
        going: ir.Move | None = None
        for statement in body:
            if isinstance(statement, ir.Move):
                steps = self.move(statement) if statement.triggers else (statement,)
                if going is not None and not _drives_on(steps):
                    done.append(_arrived(going))
                done.extend(steps)
                going = _going(steps, statement)
                continue
            if isinstance(statement, ir.WaitForMotion) and going is not None:
                if ends_exactly(replace(going, concurrent=False)):  # waited for where it matters
                    statement = ir.Nothing(origin=statement.origin)
                else:
                    going = None
            elif going is not None and not isinstance(statement, ir.Nothing | ir.Trigger):
                done.append(_arrived(going))
                going = None
            if blocks(statement):
                statement = rewrite_bodies(statement, self.body)
            done.append(statement)
        if going is not None:
            done.append(_arrived(going))
        return body if same(done, body) else tuple(done)

    def move(self, move: ir.Move) -> ir.Body:
        """The move and the steps of its actions."""
        before = self.ends.before.get(id(move), Reached())
        try:
            parts = self.parts(move, before)
        except CannotSayError as error:
            self.context.left_alone.note(move, str(error))
            return (move,)
        done: list[ir.Statement] = []
        first = list(parts.begun)
        waited = bool(parts.ended or parts.cuts or before.stands or move.search is not None)
        if first and not parts.later and waited:
            done += first  # behind the move before, which may go round its corner
            first = []
        for piece, actions in (*parts.cuts, (parts.last or replace(move, triggers=()), parts.ended)):
            going = bool(first or parts.later) and not piece.concurrent
            done.append(replace(piece, concurrent=True) if going else piece)
            done += first
            for delay, action in parts.later:
                if constant(delay) != 0:
                    done.append(ir.Wait(delay))
                done.append(action)
            if actions and going:
                done.append(ir.WaitForMotion())
            done += actions
            first = []
        own, *others = (_at(one, move.origin) for one in done)
        return (replace(own, origin=move.origin), *others)

    # ---- one move

    def parts(self, move: ir.Move, before: Reached) -> _Parts:
        """Raises CannotSayError for an action whose place cannot be said."""
        done = _Parts()
        apart: list[ir.Trigger] = []
        for trigger in move.triggers:
            if not isinstance(trigger, ir.Trigger):
                raise CannotSayError("it is kept in a variable")
            if any(constant(one) != 0 for one in (trigger.distance, trigger.delay) if one is not None):
                apart.append(trigger)
            else:
                (done.begun if trigger.reference == "start" else done.ended).append(_action(trigger))
        if apart:
            whole = _Parts(begun=[*done.begun], ended=[*done.ended])
            try:
                self.cut(move, apart, before, done)
            except CannotSayError:
                if not all(map(_by_time, apart)) or move.search is not None or move.concurrent:
                    raise
                done = replace(whole, later=_in_order(apart))
        blended = move.blend is not None and move.blend != ir.BlendStop()
        cornered = (done.ended and blended) or (done.begun and done.ended and not before.stands)
        if cornered and move.origin.line not in self.cornered:
            self.cornered.add(move.origin.line)
            self.context.diagnostics.report(IN_CORNER, move.origin)
        return done

    def cut(self, move: ir.Move, triggers: Sequence[ir.Trigger], before: Reached, done: _Parts) -> None:
        """Puts the actions in the order of their places."""
        if move.kind not in ("linear", "circular") or move.relative or move.search or move.concurrent or move.swept:
            raise CannotSayError(f"the move is no plain linear or circular one ({move.kind})")
        way = self.way(move, before)
        events = sorted(((_along(one, move, way.length), _action(one)) for one in triggers), key=lambda one: one[0])
        for along, action in events:
            if not -_NEAR_MM <= along <= way.length + _NEAR_MM:
                raise CannotSayError(f"the place is outside of the move, {along:.1f} mm from its start")
            if along < _NEAR_MM:
                done.begun.append(action)
        last = way.length - _NEAR_MM - _CORNER_MM
        done.ended[:0] = [action for along, action in events if along > last]
        begin = 0.0
        for along, action in events:
            if along < _NEAR_MM or along > last:
                continue
            self.context.diagnostics.report(CUT, move.origin, along=along)
            if done.cuts and along < begin + _NEAR_MM:
                done.cuts[-1][1].append(action)
                continue
            point = along + _CORNER_MM  # what stands behind it is done where its corner begins
            piece = way.piece(move, begin, point)
            done.cuts.append((replace(piece, blend=ir.BlendDistance(ir.RealLiteral(_CORNER_MM))), [action]))
            begin = point
        size = constant(move.blend.distance) if isinstance(move.blend, ir.BlendDistance) else None
        if done.cuts and size is not None and way.length - begin < 2 * size:
            self.context.diagnostics.report(SMALLER, move.origin, rest=way.length - begin, corner=size)
        if done.cuts and move.kind == "circular":
            done.last = way.piece(move, begin, way.length)

    def way(self, move: ir.Move, before: Reached) -> Way:
        start, end, flags = self.both_ends(move, before)
        if move.kind == "linear":
            return line(start, end, flags)
        via = None if move.via is None else self.constants.known(move.via)
        if via is None or via.kind != "pose":
            raise CannotSayError("the point on the way of the circle is computed")
        if float(rotation_angle(matrix(inverse(start))[:3, :3] @ matrix(end)[:3, :3])) > _SAME_RAD:
            raise CannotSayError("the tool turns on the circle")
        round_it = arc(start, via.values, end, flags)
        if round_it is None:
            raise CannotSayError("the points of the circle are on a line")
        return round_it

    def both_ends(self, move: ir.Move, before: Reached) -> tuple[Values, Values, Flags]:
        """Start and end of the move in its frame, and the posture of its end."""
        target = self.constants.known(move.target)
        if target is None or target.kind != "pose":
            raise CannotSayError("the end of the move is computed")
        if before.position is None or not same_tool(before.tool, move.tool, self.constants):
            raise CannotSayError("the start of the move is not known, or its tool is another one")
        if before.position.kind == "pose" and before.frame == move.frame:
            return before.position.values, target.values, target.flags
        frame = Position("pose", WORLD) if move.frame is None else self.constants.known(move.frame)
        if frame is None or (before.position.kind == "pose" and before.base is None):
            raise CannotSayError("the start of the move is not known in its frame")
        return product(inverse(frame.values), self.in_base(before)), target.values, target.flags

    def in_base(self, before: Reached) -> Values:
        position = before.position
        assert position is not None  # asked for by the caller
        if position.kind == "pose":
            return product(before.base or WORLD, position.values)
        if self.context.robot is None:
            raise CannotSayError("the start of the move is in joints, and there is no arm (--robot)")
        tool = Position("pose", WORLD) if before.tool is None else self.constants.known(before.tool)
        return pose_of_joints(position, self.context.robot, None if tool is None else tool.values).values


def _along(trigger: ir.Trigger, move: ir.Move, length: float) -> float:
    """Where the action happens, mm from the start of the move; a time is a way at the move's speed."""
    distance, delay = (constant(one) if one is not None else 0.0 for one in (trigger.distance, trigger.delay))
    if distance is None or delay is None:
        raise CannotSayError("its distance is computed")
    if delay:
        speed = None if move.speed is None or move.speed.path is None else constant(move.speed.path)
        if speed is None:
            raise CannotSayError("a time before or behind a place, and the speed is computed")
        distance += delay * speed
    along = distance if trigger.reference == "start" else length + distance
    return max(along, 0.0) if delay < 0 else along  # a longer time than the move takes: at its start


def _by_time(trigger: ir.Trigger) -> bool:
    """Does it come some time behind the start of the move?"""
    distance, delay = trigger.distance, trigger.delay
    if trigger.reference != "start" or delay is None or (distance is not None and constant(distance) != 0):
        return False
    known = constant(delay)
    return known is None or known > 0


def _in_order(triggers: Sequence[ir.Trigger]) -> list[tuple[ir.Expression, Action]]:
    """Each with the time behind the one before it."""
    if len(triggers) == 1 and triggers[0].delay is not None:
        return [(triggers[0].delay, _action(triggers[0]))]
    delays = [0.0 if one.delay is None else constant(one.delay) for one in triggers]
    found: list[tuple[ir.Expression, Action]] = []
    before = 0.0
    for delay, trigger in sorted(zip(delays, triggers, strict=True), key=lambda pair: pair[0] or 0.0):
        if delay is None:
            raise CannotSayError("several times behind its start, one of them computed")
        found.append((ir.RealLiteral(round(delay - before, 6)), _action(trigger)))
        before = delay
    return found


def _action(trigger: ir.Trigger) -> Action:
    origin = trigger.action.origin if trigger.action.origin.source is not None else trigger.origin
    return replace(trigger.action, origin=replace(origin, comments=()))


def _at(statement: ir.Statement, origin: Origin) -> ir.Statement:
    """The statement at its own place, or where the move is; the remarks stand in front of all."""
    own = statement.origin if statement.origin.source is not None else origin
    return replace(statement, origin=replace(own, comments=()))


def _drives_on(steps: ir.Body) -> bool:
    """Do they begin with a move that can be said?"""
    return isinstance(steps[0], ir.Move) and not steps[0].triggers


def _going(steps: ir.Body, move: ir.Move) -> ir.Move | None:
    """The move that the program has not waited for behind these steps, though its own language does."""
    last = next((one for one in reversed(steps) if isinstance(one, ir.Move | ir.WaitForMotion)), None)
    return last if isinstance(last, ir.Move) and last.concurrent and not move.concurrent else None


def _arrived(move: ir.Move) -> ir.WaitForMotion:
    return ir.WaitForMotion(origin=replace(move.origin, comments=()))


__all__ = ["LOST", "cut_moves"]

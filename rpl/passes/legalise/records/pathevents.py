"""Actions on the path for targets that have tasks but no path events: a task beside the move watches the place.

The task waits until the tool is near enough to the end of the move (or far enough from its start) and acts then; one
cycle of the target's controller is how exactly it does. Events at a point where the robot stands need no task. Behind
the passes that give each move its settings, because speed and corner decide where an event comes.
"""

from __future__ import annotations

from dataclasses import dataclass, field, replace

from rpl import ir
from rpl.diagnostics import Severity, code
from rpl.ir.walk import walk
from rpl.passes.capabilities import TriggerRule, Watched
from rpl.passes.legalise.context import Context, rules_of
from rpl.passes.legalise.facts.motion.knownends import in_base
from rpl.passes.legalise.facts.usage import base_name
from rpl.passes.legalise.rewriting.beside import Beside, local_names, moves_or_waits, tidy
from rpl.passes.legalise.rewriting.editing import Editor, edit_bodies, edit_routines
from rpl.passes.legalise.rewriting.formulas import plain
from rpl.passes.legalise.rewriting.jumps import inside
from rpl.passes.legalise.rewriting.support import with_support
from rpl.passes.legalise.stages import legalising
from rpl.passes.typing import type_of
from rpl.source import Origin

WATCHED = code(
    "path-event-watched",
    Severity.WARNING,
    "an action on the path is done by a task that watches the tool: it comes up to one cycle of the controller later",
)
NOT_WATCHED = code(
    "path-event-lost",
    Severity.LOSS,
    "an action on the path cannot be done by a task that watches the tool: {reason}",
    "drive straight there, or do it where the robot stands",
    stops=True,
)
_EVENT = "rpl_on_path"


@legalising(
    unless=lambda context: (
        context.capabilities.interrupts.watched is not Watched.ALL
        and TriggerRule.LATE in context.capabilities.motion.triggers
    ),
    sees=("Trigger",),
)
def path_events(program: ir.Program, context: Context) -> ir.Program:
    """Only for targets whose path events are tasks, all of them or those that come behind the end of a move."""
    watched = context.capabilities.interrupts.watched is Watched.ALL
    beside = Beside(program, context)

    def work(editor: Editor, routine: ir.Routine) -> ir.Routine:
        worker = _Events(context, editor, routine, beside)
        return edit_bodies(routine, worker.body if watched else worker.late_body)

    done = beside.placed(edit_routines(program, context, work))
    if beside.moving is not None:
        done = with_support(done, context, (beside.moving_flag(),), (), done.modules[0].task)
    return done


@dataclass(slots=True)
class _Way:
    """One move: its ends in the robot's base, its speed (mm/s) and acceleration (mm/s2), the sizes of the corners at
    its ends (mm; None: it stands there)."""

    move: ir.Move
    start: ir.Expression | None
    end: ir.Expression
    begins_in: ir.Expression | None
    ends_in: ir.Expression | None
    speed: ir.Expression | None
    acceleration: float


@dataclass(slots=True)
class _Events:
    context: Context
    editor: Editor
    routine: ir.Routine
    beside: Beside
    last: ir.Move | None = None  # the move before, as far as it is known
    started: bool = False
    watching: list[str] = field(default_factory=list)  # tasks that look where the move is

    # ---- bodies

    def body(self, body: ir.Body) -> ir.Body:
        done: list[ir.Statement] = []
        waiting: list[ir.Trigger] = []
        outer, self.last = self.last, None
        for statement in body:
            match statement:
                case ir.Trigger():
                    waiting.append(statement)
                case ir.Move():
                    done.extend(self.move(statement, waiting))
                    waiting = []
                    self.last = statement
                case ir.Assign() | ir.Nothing() | ir.LookAhead():
                    done.append(statement)
                case _:
                    done.extend(map(self.lost, waiting))
                    waiting = []
                    inner = inside(statement, self.body)
                    if moves_or_waits(statement, self.beside.routines):
                        self.last = None
                    done.append(inner)
        done.extend(map(self.lost, waiting))
        self.last = outer
        same = len(done) == len(body) and all(new is old for new, old in zip(done, body, strict=True))
        return body if same else tuple(done)

    def lost(self, trigger: ir.Trigger) -> ir.Statement:
        self.context.diagnostics.report(NOT_WATCHED, trigger.origin, reason="no move follows it")
        return trigger

    def move(self, move: ir.Move, triggers: list[ir.Trigger]) -> ir.Body:
        """The move with what is done before it and behind it."""
        if not triggers or any(not isinstance(one, ir.Trigger) for one in move.triggers):
            return (*triggers, move)
        self.started, self.watching = False, []
        before: list[ir.Statement] = []
        behind: list[ir.Statement] = []
        way = self.way(move, triggers, before)
        for trigger in triggers:
            reason = self.refused(trigger, move)
            if reason:
                self.context.diagnostics.report(NOT_WATCHED, trigger.origin, reason=reason)
                return (*triggers, move)
            self.event(trigger, way, before, behind)
        if self.started:
            self.context.diagnostics.report(WATCHED, triggers[0].origin)
        if self.watching:
            before.insert(0, _told(self.beside.moving_name(), True, move.origin))
            ended = [_told(self.beside.moving_name(), False, move.origin)]
            ended += [ir.TaskControl("join", name, origin=_later(move.origin)) for name in self.watching]
            behind = [*(ended if way.ends_in is None else ()), *behind]
        first = replace(triggers[0].origin, comments=tuple(c for one in triggers for c in one.origin.comments))
        note: ir.Body = (ir.Nothing(origin=first),) if first.comments else ()
        return (*note, *before, move, *behind)

    def refused(self, trigger: ir.Trigger, move: ir.Move) -> str:
        """Why no task can do it; empty when one can."""
        written = trigger.action.target if isinstance(trigger.action, ir.Assign) else None
        if written is not None and base_name(written) in local_names(self.routine):
            return "it writes a variable of its routine"
        if isinstance(trigger.action, ir.CallRoutine) and moves_or_waits(trigger.action, self.beside.routines):
            return f"{trigger.action.name} moves the robot"
        if move.kind not in ("joint", "linear", "circular") or move.relative:
            return f"the move is a {'relative' if move.relative else move.kind} one"
        delay = 0.0 if trigger.delay is None else _number(trigger.delay)
        if delay is None:
            return "its time is computed"
        on_way = trigger.distance is not None and _number(trigger.distance) != 0.0
        if move.kind == "joint" and (on_way or delay < 0.0):
            return "it is on the way of a joint move"
        return ""

    # ---- only what comes when the robot stands already

    def late_body(self, body: ir.Body) -> ir.Body:
        """The triggers that stand before a move go behind it, as a task each."""
        done: list[ir.Statement] = []
        waiting: list[int] = []  # places in `done` of triggers that the next move may take
        for statement in body:
            match statement:
                case ir.Trigger():
                    waiting.append(len(done))
                    done.append(statement)
                case ir.Move():
                    late = [at for at in waiting if self.late(done[at], statement)]
                    events = [one for at in late if isinstance(one := done[at], ir.Trigger)]
                    for at in late:
                        done[at] = ir.Nothing(origin=done[at].origin)
                    done.append(statement)
                    for one in sorted(events, key=lambda each: _number(each.delay) or 0.0):
                        action = replace(one.action, origin=_later(one.origin))
                        done.extend(self.later(one, action, _number(one.delay) or 0.0))
                    waiting = []
                case ir.Assign() | ir.Nothing() | ir.LookAhead():
                    done.append(statement)
                case _:
                    waiting = []
                    done.append(inside(statement, self.late_body))
        same = len(done) == len(body) and all(new is old for new, old in zip(done, body, strict=True))
        return body if same else tuple(done)

    def late(self, trigger: ir.Statement, move: ir.Move) -> bool:
        """Does it come a constant time behind the end of the move, where the robot stands?"""
        if not isinstance(trigger, ir.Trigger) or self.refused(trigger, move):
            return False
        stands = move.blend in (None, ir.BlendStop()) and move.search is None and not move.concurrent
        at_end = trigger.reference == "end" and (trigger.distance is None or _number(trigger.distance) == 0.0)
        return stands and at_end and (_number(trigger.delay) or 0.0) > 0.0

    # ---- one event

    def event(self, trigger: ir.Trigger, way: _Way, before: list[ir.Statement], behind: list[ir.Statement]) -> None:
        """The action before the move, behind it, or in a task that begins before it."""
        delay = _number(trigger.delay) or 0.0
        known = _number(trigger.distance if trigger.distance is not None else ir.RealLiteral(0.0))
        distance = (
            plain(trigger.distance) if known is None and trigger.distance is not None else ir.RealLiteral(known or 0.0)
        )
        at_point = known == 0.0
        action = replace(trigger.action, origin=_later(trigger.origin))
        if trigger.reference == "start":
            if way.begins_in is None and at_point and delay <= 0.0:
                before.append(action)
                return
            steps = self.from_start(way, distance, at_point)
            steps += [_pause(delay)] if delay > 0.0 else []
        else:
            if way.ends_in is None and at_point and delay == 0.0:
                behind.append(action)
                return
            if way.ends_in is None and at_point and delay > 0.0:
                behind.extend(self.later(trigger, action, delay))
                return
            steps = self.before_end(way, distance, at_point, delay, before)
            steps += [_pause(delay)] if delay > 0.0 else []
        if way.begins_in is None and delay > 0.0 and len(steps) == 1:
            before.extend(self.later(trigger, action, delay))
            return
        before.extend(self.task(steps, action, trigger))

    def later(self, trigger: ir.Trigger, action: ir.Statement, delay: float) -> ir.Body:
        """A time behind a place where the robot stands."""
        if isinstance(action, ir.Assign) and isinstance(action.target, ir.Signal) and "SetAfter" in self.says():
            return (ir.SetAfter(action.target, action.value, _seconds(delay), origin=action.origin),)
        return self.task([_pause(delay)], action, trigger)

    def says(self) -> frozenset[str]:
        return self.context.capabilities.statements

    def task(self, steps: list[ir.Statement], action: ir.Statement, trigger: ir.Trigger) -> ir.Body:
        """Begins a task that waits for the event and acts."""
        before: list[ir.Statement] = []
        body = self.beside.own(self.editor, self.routine, (*steps, action), before)
        name = self.beside.task(self.routine, _EVENT, body)
        self.started = True
        if any(isinstance(node, ir.Name) and node.id == self.beside.moving for node in walk(*steps)):
            self.watching.append(name)
        later = _later(trigger.origin)
        return (*before, ir.TaskControl("start", name, origin=later))

    # ---- where it comes

    def from_start(self, way: _Way, distance: ir.Expression, at_point: bool) -> list[ir.Statement]:
        """Waits until the tool is that far from where the move begins. Behind a corner that is the corner's end."""
        if way.start is None or (way.begins_in is None and at_point):
            return []
        steps: list[ir.Statement] = []
        goal = distance
        if way.begins_in is not None:
            near = _distance(way.start)
            steps.append(_until(ir.Binary("<=", near, _half(way.begins_in)), self.beside.moving_name()))
            known, size = _number(distance), _number(way.begins_in)
            if at_point or (known is not None and size is not None and known < size):
                goal = way.begins_in
        return [*steps, _until(ir.Binary(">=", _distance(way.start), goal), self.beside.moving_name())]

    def before_end(
        self, way: _Way, distance: ir.Expression, at_point: bool, delay: float, before: list[ir.Statement]
    ) -> list[ir.Statement]:
        """Waits until the tool is that far (or that time) before the end; at a corner its middle is the end."""
        moving, left = self.beside.moving_name(), _distance(way.end)
        size = ir.RealLiteral(0.0) if at_point else _positive(distance)  # of an arc: measured straight (arcdistances)
        if delay < 0.0:
            size = _sum(size, self.braking(way, -delay, before))
        steps: list[ir.Statement] = []
        if way.move.kind == "circular" and _number(size) != 0.0:  # an arc may begin nearer to its end than that
            steps.append(_until(ir.Binary(">=", left, size), moving))
        if way.ends_in is None or not (at_point and delay >= 0.0):
            return [*steps, _until(ir.Binary("<=", left, size), moving)]
        near = ir.Name("nearest")
        away = ir.If(((ir.Binary(">", ir.Name("now"), near), (ir.ExitLoop(),)),))
        steps += [
            _until(ir.Binary("<=", left, way.ends_in), moving),
            ir.Assign(near, left),
            ir.Assign(ir.Name("now"), near),
            ir.Loop(
                (
                    ir.Wait(_seconds(self.context.capabilities.io.poll_s)),
                    ir.Assign(ir.Name("now"), left),
                    away,
                    ir.Assign(near, ir.Name("now")),
                )
            ),
        ]
        return steps

    def braking(self, way: _Way, seconds: float, before: list[ir.Statement]) -> ir.Expression:
        """The way in mm that is left that time before the end: the move brakes evenly, or goes on through a corner."""
        speed = way.speed if way.speed is not None else ir.RealLiteral(0.0)
        whole: ir.Expression = ir.Binary("*", speed, ir.RealLiteral(seconds))
        known = _number(speed)
        if way.ends_in is not None or way.acceleration <= 0.0:
            return ir.RealLiteral(_short(known * seconds)) if known is not None else whole
        if known is None:  # it brakes from what it reaches in that time
            reaches = ir.Builtin("min", (speed, ir.RealLiteral(_short(way.acceleration * seconds))))
            left = ir.Binary("/", reaches, ir.RealLiteral(2.0 * way.acceleration))
            kept = self.beside.kept(self.editor, self.routine, "rpl_left", ir.RealType())
            given = ir.Binary("*", reaches, ir.Binary("-", ir.RealLiteral(seconds), left))
            before.append(ir.Assign(kept, given, origin=_later(way.move.origin)))
            return kept
        ramp = known / way.acceleration
        if seconds <= ramp:
            return ir.RealLiteral(_short(0.5 * way.acceleration * seconds**2))
        return ir.RealLiteral(_short(known * seconds - 0.5 * known * ramp))

    # ---- the move

    def way(self, move: ir.Move, triggers: list[ir.Trigger], before: list[ir.Statement]) -> _Way:
        last = self.last
        begins_in = _corner(last.blend) if last is not None else None
        if begins_in is not None and any(isinstance(node, ir.Call) for node in walk(begins_in)):
            begins_in = None  # computed for where the robot was then: it is another number now
        start = self.place(last, last.target) if last is not None and last.relative is None else None
        looked = any(one.reference == "start" and _number(one.distance or ir.IntLiteral(0)) != 0.0 for one in triggers)
        if start is None or begins_in is None:
            begins_in, start = None, None
            if looked:
                start = self.beside.kept(self.editor, self.routine, "rpl_from", ir.PoseType())
                before.append(ir.Assign(start, ir.System("actual_pose"), origin=_later(move.origin)))
        elif any(one.reference == "start" for one in triggers):
            start = self.beside.settled(self.editor, self.routine, start, "rpl_from", before)
        end = self.place(move, move.target)
        if any(one.reference != "start" for one in triggers):
            end = self.beside.settled(self.editor, self.routine, end, "rpl_to", before)
        ends_in = _corner(move.blend)
        if ends_in is not None and triggers:  # the task has names of its own
            ends_in = self.beside.settled(self.editor, self.routine, ends_in, "rpl_size", before, ir.RealType())
        speed = move.speed.path if move.speed is not None else None
        rules = rules_of(self.context.target).system_defaults
        rate = rules.get("path_acceleration", 0.0)
        own = move.speed.path_acceleration if move.speed is not None else None
        known = _number(own) if own is not None else None
        acceleration = known if known is not None else float(rate)
        return _Way(move, start, end, begins_in, ends_in, speed, acceleration)

    def place(self, move: ir.Move, target: ir.Expression) -> ir.Expression:
        """A target in the robot's base."""
        return in_base(move, target, type_of(target, self.editor.scope))


def _corner(blend: ir.Blend | None) -> ir.Expression | None:
    return plain(blend.distance) if isinstance(blend, ir.BlendDistance) and blend.distance is not None else None


def _number(value: ir.Expression | None) -> float | None:
    match value:
        case ir.RealLiteral(value=number) | ir.IntLiteral(value=number):
            return float(number)
        case ir.Unary(op="-", operand=operand):
            inner = _number(operand)
            return None if inner is None else -inner
        case ir.Convert(how="real", operand=operand) | ir.Unary(op="+", operand=operand):
            return _number(operand)
        case ir.Quantity(value=operand, unit=unit):
            inner = _number(operand)
            return None if inner is None else inner * ir.UNITS[unit]
    return None


def _positive(distance: ir.Expression) -> ir.Expression:
    known = _number(distance)
    if known is not None:
        return ir.RealLiteral(_short(abs(known)))
    negated = isinstance(distance, ir.Unary) and distance.op == "-"
    return distance.operand if negated and isinstance(distance, ir.Unary) else ir.Builtin("abs", (distance,))


def _half(size: ir.Expression) -> ir.Expression:
    """Somewhat less than the size of a corner: nearer to its point than that comes only the corner itself."""
    known = _number(size)
    return ir.RealLiteral(_short(0.95 * known)) if known is not None else size


def _sum(one: ir.Expression, other: ir.Expression) -> ir.Expression:
    left, right = _number(one), _number(other)
    if left is not None and right is not None:
        return ir.RealLiteral(_short(left + right))
    return other if left == 0.0 else ir.Binary("+", one, other)


def _short(value: float) -> float:
    return float(f"{value:.9g}")


def _distance(place: ir.Expression) -> ir.Expression:
    return ir.Builtin("distance", (ir.System("actual_pose"), place))


def _until(condition: ir.Expression, moving: str) -> ir.Statement:
    """Waits for a place; where the move is over, waits no longer."""
    return ir.WaitUntil(ir.Binary("cor", condition, ir.Unary("not", ir.Name(moving))))


def _told(name: str, value: bool, origin: Origin) -> ir.Statement:
    return ir.Assign(ir.Name(name), ir.BoolLiteral(value), origin=_later(origin))


def _seconds(value: float) -> ir.Expression:
    return ir.Quantity(ir.RealLiteral(_short(value)), "s")


def _pause(delay: float) -> ir.Statement:
    return ir.Wait(_seconds(delay))


def _later(origin: Origin) -> Origin:
    return tidy(origin)

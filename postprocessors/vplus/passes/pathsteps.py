"""What acts on the way, for a language without such statements: a V+ program goes on while the robot moves, so a step
behind a move acts when the move has begun, and `WAIT DISTANCE(HERE, DEST) <= d` holds it until a place is reached.

What acts in the corner at a move's end stands behind the next move: that begins in the corner. Where another language's
program would act at a corner before the next move, the corner becomes a stop (`facts.corners`). A move with steps
behind it goes on in the corner of V+ itself, and a wait for the robot behind the steps is its stop. A move that the
other program does not wait for has its stop in front of the next move, and of what leads nobody knows where.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, field, replace

from rpl import ir
from rpl.diagnostics import Code, Severity, code
from rpl.passes.fold import lasting_number
from rpl.passes.legalise.facts.effects import blocks
from rpl.passes.legalise.rewriting.editing import edit_each
from rpl.passes.rewrite import rewrite_bodies, same
from rpl.passes.scope import ProgramScope, Scope
from rpl.source import Origin
from rpl.writing.anywhere import Anywhere
from rpl.writing.statements import CannotSayError
from rpl.writing.target import WriteContext

from ..facts.corners import Corners, deferred, size_of
from ..facts.moves import hand, lacking
from ..facts.names import names_of
from ..units import in_unit

CYCLE = code(
    "vplus-path-cycle",
    Severity.WARNING,
    "the program looks for the place on the path once in a trajectory cycle (16 ms); the action may come as much later",
)
STRAIGHT = code(
    "vplus-path-straight",
    Severity.WARNING,
    "V+ measures distances in a straight line; along this {kind} path the place differs a little",
)
AHEAD = code(
    "vplus-path-time",
    Severity.WARNING,
    "a time before a place is written as the distance at the programmed speed; with a lower MONITOR it comes earlier",
)
CALLED = code(
    "vplus-path-call", Severity.WARNING, "the program goes on with its moves only when {name}, called on the path, ends"
)
LATE = code(
    "vplus-late-call",
    Severity.WARNING,
    "the program itself waits for the time behind the move, and calls {name}; only then it goes on",
)
HELD = code(
    "vplus-path-corner",
    Severity.WARNING,
    "the next move is commanded behind the place on the path; near the corner this makes the corner smaller",
)
CORNER = code(
    "vplus-corner",
    Severity.WARNING,
    "V+ takes corners by its own measure; the size given here is not carried over",
)
STOPPED = code(
    "vplus-corner-stopped",
    Severity.WARNING,
    "the robot stops at this corner: V+ would execute the next step when the move begins",
)
LOOSE = code(
    "vplus-corner-may-stop",
    Severity.WARNING,
    "the robot stops at this corner where no move follows at once: V+ would execute the next step when the move begins",
)
_OWN_CORNER = ir.BlendSpeed(ir.IntLiteral(100))  # what V+ makes of two moves without a BREAK between them
_LEAVING = (ir.Goto, ir.Return, ir.ExitLoop, ir.NextPass)
_HERE, _DEST = ir.System("actual_pose"), ir.System("end_pose")
_STOP = ir.WaitForMotion()


def path_steps(program: ir.Program, context: WriteContext) -> ir.Program:
    """Actions on the way and the stops at corners as steps; a trigger that cannot be said stays."""
    shared = _Shared(
        context,
        Corners.of(program) if context.foreign else Corners(program),
        names_of(program),
        Anywhere(lambda node: isinstance(node, ir.Move)),
        Anywhere(lambda node: isinstance(node, (ir.Move, ir.CallRoutine, *_LEAVING))),
    )
    scopes = ProgramScope(program)

    def work(module: ir.Module, routine: ir.Routine) -> ir.Routine:
        steps = _Steps(shared, scopes.routine(module, routine))
        body = steps.body(routine.body)
        if body is routine.body:
            return routine
        return replace(routine, body=body, declarations=(*routine.declarations, *steps.declared))

    return edit_each(program, work)


@dataclass(frozen=True, slots=True)
class _Event:
    """A trigger and the steps that it takes."""

    trigger: ir.Trigger
    steps: ir.Body


@dataclass(slots=True)
class _Around:
    """Steps around a move: in front of it, behind it while it is under way, and behind its end."""

    before: list[ir.Statement] = field(default_factory=list)
    behind: list[ir.Statement] = field(default_factory=list)
    last: list[ir.Statement] = field(default_factory=list)


@dataclass(slots=True)
class _Shared:
    """What all programs share. `taken`: names, folded; `reported`: what is said once for the whole program."""

    context: WriteContext
    corners: Corners
    taken: set[str]
    may_move: Anywhere
    goes_on: Anywhere
    reported: set[tuple[Code, str]] = field(default_factory=set)

    def once(self, about: Code, origin: Origin, **words: object) -> None:
        if (about, str(words)) not in self.reported:
            self.reported.add((about, str(words)))
            self.context.diagnostics.report(about, origin, **words)

    def temporary(self) -> str:
        number = 1
        while f"p{number}" in self.taken:
            number += 1
        self.taken.add(f"p{number}")
        return f"p{number}"


@dataclass(slots=True)
class _Steps:
    """Of one routine. `waiting`: what happens on the way of the next move; `carried`: what comes in the corner at its
    beginning or behind that; `deferred`: steps that stand behind the next move; `going`: the
    program goes on, and the robot to an exact end."""

    shared: _Shared
    scope: Scope
    waiting: list[_Event] = field(default_factory=list)
    carried: list[_Event] = field(default_factory=list)
    deferred: list[ir.Statement] = field(default_factory=list)
    going: bool = False
    declared: list[ir.Variable] = field(default_factory=list)

    # ---- bodies

    def body(self, body: ir.Body) -> ir.Body:
        corners = self.shared.corners
        outer, self.waiting, self.going = (self.waiting, self.going), [], False
        done: list[ir.Statement] = []
        at = 0
        while at < len(body):
            statement = body[at]
            at += 1
            if id(statement) in corners.broken or (self.going and _needs_standing(statement, self.shared.goes_on)):
                done.append(_STOP)
                self.going = False
            match statement:
                case ir.Trigger() if hand(body[at - 1 : at + 1]):
                    done += body[at - 1 : at + 1]
                    at += 1
                case ir.Trigger():
                    done.append(statement)
                    self.trigger(statement)
                case ir.Move():
                    self.take_waiting(done)
                    done += self.move(statement, deferred(body, at) is not None)
                case _ if id(statement) in corners.deferred:
                    self.deferred.append(statement)
                case _:
                    if blocks(statement):
                        if self.shared.may_move.within(statement):
                            self.waiting = []  # which move is the next one depends on the run
                        statement = rewrite_bodies(statement, self.body)
                    done.append(statement)
                    self.going = self.going and not _waits_for_robot(statement)
        if self.going:
            done.append(_STOP)
        self.waiting, self.going = outer
        return body if same(done, body) else tuple(done)

    def trigger(self, trigger: ir.Trigger) -> None:
        """One of the next move."""
        try:
            late = [one for one in self.waiting if self.delayed(one) and self.early(one.trigger) is None]
            if not all(self.not_behind(trigger, one.trigger, equal=False) for one in late):
                raise CannotSayError("an action on the path behind a call some time behind a place")
            self.waiting.append(_Event(trigger, tuple(self.steps(trigger))))
        except CannotSayError as error:
            self.shared.context.left_alone.note(trigger, str(error))

    def take_waiting(self, done: list[ir.Statement]) -> None:
        """The triggers whose move is here leave their remarks."""
        taken = {id(event.trigger) for event in self.waiting}
        at = len(done)
        while taken:  # they stand in front of the move, nothing goes further back than to the first of them
            at -= 1
            if id(done[at]) in taken:
                taken.discard(id(done[at]))
                origin = done[at].origin
                done[at : at + 1] = [ir.Nothing(origin=origin)] if origin.comments else []

    def move(self, move: ir.Move, goes_on: bool) -> list[ir.Statement]:
        """The move with the steps around it. `goes_on`: the next move follows, so that what acts in the corner can
        stand behind that."""
        mine, kept = [*self.carried, *self.waiting], self.deferred
        self.carried, self.waiting, self.deferred = [], [], []
        stop = self.stop(move)
        if lacking(move):  # the writer refuses it
            return [move, *(step for event in mine for step in event.steps), *kept]
        try:
            around = self.around(move, mine, bool(stop), goes_on)
        except CannotSayError as error:
            for event in mine:
                self.shared.context.left_alone.note(event.trigger, str(error))
            return [*(event.trigger for event in mine), *self.plain(move, stop), *kept]
        around.behind[:0] = kept
        if around.last and not stop:
            self.shared.context.diagnostics.report(STOPPED, move.origin)
            stop = (_STOP,)
        if not around.behind and not (move.concurrent and around.last):
            return [*self.at(move, around.before), *self.plain(move, stop), *self.at(move, around.last)]
        if move.concurrent and not around.last and self.shared.context.foreign:
            return [*self.at(move, around.before), *self.plain(move, stop), *self.at(move, around.behind)]
        begun = replace(move, blend=_OWN_CORNER, concurrent=False)
        ending = [*stop, *self.at(move, around.last)]
        return [*self.at(move, around.before), begun, *self.at(move, around.behind), *ending]

    def at(self, move: ir.Move, steps: Iterable[ir.Statement]) -> list[ir.Statement]:
        """Steps that have no place of their own stand where the move does."""
        return [one if one.origin.source is not None else _placed(one, move.origin) for one in steps]

    def plain(self, move: ir.Move, stop: ir.Body) -> list[ir.Statement]:
        """The move without steps while it is under way, or none that belong to it."""
        if stop and move.concurrent and self.shared.context.foreign:
            self.going = True
            return [replace(move, blend=_OWN_CORNER, concurrent=False)]
        if stop == (_STOP,):
            return [move if isinstance(move.blend, ir.BlendStop) else replace(move, blend=ir.BlendStop())]
        return [move, *stop]

    # ---- corners

    def stop(self, move: ir.Move) -> ir.Body:
        """What stops the robot at the end of the move; nothing at a corner."""
        if not self.shared.context.foreign:
            return (_STOP,) if isinstance(move.blend, ir.BlendStop) else ()
        corners, size = self.shared.corners, None if move.blend is None else size_of(move.blend)
        if move.blend is None or isinstance(move.blend, ir.BlendStop) or (size is not None and self.known(size) == 0):
            return (_STOP,)
        if id(move) in corners.stopped:
            self.shared.context.diagnostics.report(STOPPED, move.origin)
            return (_STOP,)
        if id(move) in corners.loose:
            self.shared.once(LOOSE, move.origin)
        if move.blend != _OWN_CORNER:
            self.shared.once(CORNER, move.origin)
        decided = isinstance(size, ir.Name | ir.System | ir.Index | ir.Field) and self.known(size) is None
        if not decided or not isinstance(move.blend, ir.BlendDistance) or size is None:
            return ()
        if move.concurrent:
            return (_STOP,)
        none = ir.Binary("<=", size, ir.IntLiteral(0))  # the run decides
        return (ir.If(((none, (_STOP,)),), origin=replace(move.origin, comments=())),)

    # ---- places

    def around(self, move: ir.Move, events: list[_Event], stops: bool, goes_on: bool) -> _Around:
        """Raises CannotSayError."""
        around = _Around()
        placed = [(event, self.place(event.trigger, move)) for event in events]
        for event, place in sorted(placed, key=self.order):
            at_start = event.trigger.reference == "start"
            sign = 0 if place is None else self.sign(place, at_start)
            if not at_start and sign >= 0 and not stops and goes_on:
                moved = replace(event.trigger, reference="start", distance=place, delay=None)
                self.carried.append(_Event(moved, event.steps))
            elif not at_start and sign >= 0:
                around.last += event.steps
            else:
                if place is not None and sign != 0:
                    self.reach(event.trigger, place, move, around)
                if not stops and ((place is not None and sign != 0) or self.delayed(event)):
                    self.shared.once(HELD, event.trigger.origin)
                around.behind += event.steps
        return around

    def known(self, value: ir.Expression) -> float | None:
        return lasting_number(value, self.scope)

    def order(self, placed: tuple[_Event, ir.Expression | None]) -> tuple[int, float]:
        """From the start on, then towards the end."""
        event, place = placed
        far = self.known(place) if place is not None else 0.0
        return (0 if event.trigger.reference == "start" else 1), far or 0.0

    def sign(self, place: ir.Expression, at_start: bool) -> int:
        """Of a distance; a computed one lies on the move."""
        number = self.known(place)
        if number is None:
            return 1 if at_start else -1
        return (number > 0) - (number < 0)

    def place(self, trigger: ir.Trigger, move: ir.Move) -> ir.Expression | None:
        """Distance in mm from the reference; a time before it is the way at the programmed speed."""
        distance = None if trigger.distance is None else in_unit(trigger.distance, "mm")
        early = self.early(trigger)
        if early is None:
            return distance
        speed = move.speed.path if move.speed is not None else None
        if speed is None or move.kind == "joint":
            raise CannotSayError("an action some time before a place of a move whose path speed is not known")
        self.shared.once(AHEAD, trigger.origin)
        way: ir.Expression = ir.Binary("*", in_unit(speed, "mm/s"), early)
        if distance is not None:
            way = ir.Binary("+", distance, way)
        known = self.known(way)
        return ir.RealLiteral(float(f"{known:.9g}")) if known is not None else way

    def early(self, trigger: ir.Trigger) -> ir.Expression | None:
        """The delay in s, if it is negative."""
        if trigger.delay is None:
            return None
        known = self.known(in_unit(trigger.delay, "s"))
        if known is None:
            raise CannotSayError("an action on the path with a computed delay")
        return ir.RealLiteral(known) if known < 0 else None

    def reach(self, trigger: ir.Trigger, place: ir.Expression, move: ir.Move, around: _Around) -> None:
        """The wait for the place, and what is kept in front of the move for it."""
        self.shared.once(CYCLE, trigger.origin)
        if move.kind == "joint" or (move.kind == "circular" and self.early(trigger) is not None):
            self.shared.once(STRAIGHT, trigger.origin, kind="curved" if move.kind == "circular" else "joint")
        if trigger.reference != "start":
            around.behind.append(_reached(_distance(_HERE, _DEST), "<=", self.opposite(place)))
            return
        start = ir.Name(self.shared.temporary())
        self.declared.append(ir.Variable(start.id, ir.PoseType()))
        around.before.append(ir.Assign(start, _DEST))
        way = self.plainly(place)
        if move.kind == "circular":
            around.behind.append(_reached(_distance(_HERE, start), ">=", way))
        else:
            left = ir.Binary("-", _distance(start, _DEST), way)
            around.behind.append(_reached(_distance(_HERE, _DEST), "<=", left))

    def plainly(self, value: ir.Expression) -> ir.Expression:
        known = self.known(value)
        return value if known is None else ir.RealLiteral(known)

    def opposite(self, value: ir.Expression) -> ir.Expression:
        known = self.known(value)
        if known is not None:
            return ir.RealLiteral(-known)
        return value.operand if isinstance(value, ir.Unary) and value.op == "-" else ir.Unary("-", value)

    # ---- actions

    def steps(self, trigger: ir.Trigger) -> list[ir.Statement]:
        """The action itself, at once or after its delay."""
        action: ir.Statement = trigger.action
        delay, origin = trigger.delay, replace(trigger.origin, comments=())
        if delay is not None and self.early(trigger) is None and self.known(delay) != 0:
            if not isinstance(trigger.action, ir.Assign) or not isinstance(trigger.action.target, ir.Signal):
                return self.later_call(trigger, delay)
            action = ir.SetAfter(trigger.action.target, trigger.action.value, delay)
        if isinstance(action, ir.CallRoutine):
            self.shared.once(CALLED, trigger.origin, name=action.name)
        return [replace(action, origin=origin)]

    def later_call(self, trigger: ir.Trigger, delay: ir.Expression) -> list[ir.Statement]:
        """The program itself waits for the time and calls, where no other action of the move could come meanwhile."""
        others = [*self.carried, *self.waiting]
        if not all(self.is_over(one, trigger) for one in others) or not isinstance(trigger.action, ir.CallRoutine):
            raise CannotSayError("a call some time behind a place on the path")
        self.shared.once(LATE, trigger.origin, name=trigger.action.name)
        origin = replace(trigger.origin, comments=())
        return [ir.Wait(delay, origin=origin), replace(trigger.action, origin=origin)]

    def is_over(self, event: _Event, trigger: ir.Trigger) -> bool:
        """Is the event over when the other comes to its place? Not when the program waits at it itself."""
        waits = self.delayed(event) and self.early(event.trigger) is None
        return not waits and self.not_behind(event.trigger, trigger)

    def not_behind(self, one: ir.Trigger, other: ir.Trigger, equal: bool = True) -> bool:
        """Does the program look for the first no later than for the other (or earlier)? As `order` puts them."""
        first, second = self.written_place(one), self.written_place(other)
        if first is None or second is None:
            return False
        return first < second or (equal and first == second)

    def written_place(self, trigger: ir.Trigger) -> tuple[int, float] | None:
        """From which end it counts and how far, in mm; None when that is computed."""
        far = 0.0 if trigger.distance is None else self.known(in_unit(trigger.distance, "mm"))
        return None if far is None else (0 if trigger.reference == "start" else 1, far)

    def delayed(self, event: _Event) -> bool:
        """Does the program wait at this action?"""
        trigger = event.trigger
        signal = isinstance(trigger.action, ir.Assign)
        return not signal and trigger.delay is not None and self.known(trigger.delay) != 0


def _needs_standing(statement: ir.Statement, goes_on: Anywhere) -> bool:
    """Does it move the robot, or go where nobody knows?"""
    return isinstance(statement, ir.Label | ir.TaskControl) or goes_on.within(statement)


def _waits_for_robot(statement: ir.Statement) -> bool:
    match statement:
        case ir.WaitForMotion() | ir.Wait(in_position=True) | ir.WaitUntil(in_position=True):
            return True
    return False


def _distance(one: ir.Expression, other: ir.Expression) -> ir.Expression:
    return ir.Builtin("distance", (one, other))


def _reached(far: ir.Expression, how: str, way: ir.Expression) -> ir.WaitUntil:
    return ir.WaitUntil(ir.Binary(how, far, way))


def _placed(statement: ir.Statement, origin: Origin) -> ir.Statement:
    return replace(statement, origin=replace(origin, comments=()))


__all__ = ["path_steps"]

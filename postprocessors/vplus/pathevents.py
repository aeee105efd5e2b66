"""What acts on the way, for a language without such statements: a V+ program goes on while the robot moves, so a step
behind a move acts when the move has begun, and `WAIT DISTANCE(HERE, DEST) <= d` holds it until a place is reached.

What acts in the corner at a move's end stands behind the next move: that begins in the corner.
"""

from __future__ import annotations

from dataclasses import dataclass, field, replace

from rpl import ir
from rpl.diagnostics import Code, Severity, code
from rpl.writing.statements import CannotSayError

from . import spelling
from .output import BodyPrinter

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


@dataclass(frozen=True, slots=True)
class Event:
    """A trigger and the steps that it takes."""

    trigger: ir.Trigger
    steps: tuple[str, ...]


@dataclass(slots=True)
class Around:
    """Steps around a move: in front of it, behind it while it is under way, and behind its end."""

    before: list[str] = field(default_factory=list)
    behind: list[str] = field(default_factory=list)
    last: list[str] = field(default_factory=list)


class PathEvents:
    """Prints the actions on the path of each move. `waiting`: those of the next move; `carried`: those that come in the
    corner at its beginning or behind that; `deferred`: steps that stand behind the next move."""

    def __init__(self, printer: BodyPrinter) -> None:
        self.printer = printer
        self.waiting: list[Event] = []
        self.carried: list[Event] = []
        self.deferred: list[str] = []

    def add(self, trigger: ir.Trigger) -> None:
        """A trigger of the next move. Refuses what cannot be said, where it stands."""
        late = [event for event in self.waiting if self.delayed(event) and self.early(event.trigger) is None]
        if not all(self.not_behind(trigger, event.trigger, equal=False) for event in late):
            raise CannotSayError("an action on the path behind a call some time behind a place")
        self.waiting.append(Event(trigger, tuple(self.steps(trigger))))

    def pending(self) -> list[str]:
        """The steps that still wait for a move that cannot be said."""
        found = [line for event in (*self.carried, *self.waiting) for line in event.steps] + self.deferred
        self.carried, self.waiting, self.deferred = [], [], []
        return found

    def of(self, move: ir.Move, stops: bool, goes_on: bool) -> Around:
        """Of one move. `goes_on`: the next move follows, so that what acts in the corner can stand behind that."""
        mine, around = [*self.carried, *self.waiting], Around()
        self.waiting, self.carried = [], []
        placed = [(event, self.place(event.trigger, move)) for event in mine]
        for event, place in sorted(placed, key=self.order):
            at_start = event.trigger.reference == "start"
            sign = 0 if place is None else self.sign(place, at_start)
            if not at_start and sign >= 0 and not stops and goes_on:
                moved = replace(event.trigger, reference="start", distance=place, delay=None)
                self.carried.append(Event(moved, event.steps))
            elif not at_start and sign >= 0:
                around.last += event.steps
            else:
                if place is not None and sign != 0:
                    self.reach(event.trigger, place, move, around)
                if not stops and ((place is not None and sign != 0) or self.delayed(event)):
                    self.once(HELD, event.trigger)
                around.behind += event.steps
        around.behind[:0] = self.deferred
        self.deferred = []
        return around

    def order(self, placed: tuple[Event, ir.Expression | None]) -> tuple[int, float]:
        """From the start on, then towards the end."""
        event, place = placed
        far = self.printer.expressions.known(place) if place is not None else 0.0
        return (0 if event.trigger.reference == "start" else 1), far or 0.0

    def sign(self, place: ir.Expression, at_start: bool) -> int:
        """Of a distance; a computed one lies on the move."""
        number = self.printer.expressions.known(place)
        if number is None:
            return 1 if at_start else -1
        return (number > 0) - (number < 0)

    def once(self, about: Code, trigger: ir.Trigger, **words: object) -> None:
        self.printer.output.facts.once(about, trigger.origin, str(words), **words)

    def place(self, trigger: ir.Trigger, move: ir.Move) -> ir.Expression | None:
        """Distance in mm from the reference; a time before it is the way at the programmed speed."""
        expressions = self.printer.expressions
        distance = None if trigger.distance is None else expressions.in_unit(trigger.distance, "mm")
        early = self.early(trigger)
        if early is None:
            return distance
        speed = move.speed.path if move.speed is not None else None
        if speed is None or move.kind == "joint":
            raise CannotSayError("an action some time before a place of a move whose path speed is not known")
        self.once(AHEAD, trigger)
        way: ir.Expression = ir.Binary("*", expressions.in_unit(speed, "mm/s"), early)
        if distance is not None:
            way = ir.Binary("+", distance, way)
        known = expressions.known(way)
        return ir.RealLiteral(float(f"{known:.9g}")) if known is not None else way

    def early(self, trigger: ir.Trigger) -> ir.Expression | None:
        """The delay in s, if it is negative."""
        if trigger.delay is None:
            return None
        known = self.printer.expressions.known(self.printer.expressions.in_unit(trigger.delay, "s"))
        if known is None:
            raise CannotSayError("an action on the path with a computed delay")
        return ir.RealLiteral(known) if known < 0 else None

    def reach(self, trigger: ir.Trigger, place: ir.Expression, move: ir.Move, around: Around) -> None:
        """The wait for the place, and what is kept in front of the move for it."""
        self.once(CYCLE, trigger)
        expressions = self.printer.expressions
        if move.kind == "joint" or (move.kind == "circular" and self.early(trigger) is not None):
            self.once(STRAIGHT, trigger, kind="curved" if move.kind == "circular" else "joint")
        if trigger.reference != "start":
            number = expressions.known(place)
            negated = isinstance(place, ir.Unary) and place.op == "-"
            opposite = place.operand if negated and isinstance(place, ir.Unary) else ir.Unary("-", place)
            left = self.number(ir.RealLiteral(-number)) if number is not None else expressions.text(opposite)
            around.behind.append(f"WAIT DISTANCE(HERE, DEST) <= {left}")
            return
        start = expressions.notes.temporary("p")
        expressions.notes.autos.append(start)
        around.before.append(f"SET {start} = DEST")
        if move.kind == "circular":
            around.behind.append(f"WAIT DISTANCE(HERE, {start}) >= {self.number(place)}")
        else:
            around.behind.append(f"WAIT DISTANCE(HERE, DEST) <= DISTANCE({start}, DEST)-{self.number(place)}")

    def number(self, value: ir.Expression) -> str:
        known = self.printer.expressions.known(value)
        return self.printer.expressions.atom(value) if known is None else spelling.number(known)

    def later_call(self, trigger: ir.Trigger, delay: ir.Expression) -> list[str]:
        """The program itself waits for the time and calls, where no other action of the move could come meanwhile."""
        earlier = [event for event in (*self.carried, *self.waiting) if self.before(event, trigger)]
        if len(earlier) < len(self.carried) + len(self.waiting) or not isinstance(trigger.action, ir.CallRoutine):
            raise CannotSayError("a call some time behind a place on the path")
        self.once(LATE, trigger, name=trigger.action.name)
        origin = replace(trigger.origin, comments=())
        steps = self.printer.captured(ir.Wait(delay, origin=origin))
        return [*steps, *self.printer.captured(replace(trigger.action, origin=origin))]

    def before(self, event: Event, trigger: ir.Trigger) -> bool:
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
        expressions = self.printer.expressions
        far = 0.0 if trigger.distance is None else expressions.known(expressions.in_unit(trigger.distance, "mm"))
        return None if far is None else (0 if trigger.reference == "start" else 1, far)

    def delayed(self, event: Event) -> bool:
        """Does the program wait at this action?"""
        trigger = event.trigger
        signal = isinstance(trigger.action, ir.Assign)
        return not signal and trigger.delay is not None and self.printer.expressions.known(trigger.delay) != 0

    def steps(self, trigger: ir.Trigger) -> list[str]:
        """The action itself, at once or after its delay."""
        action: ir.Statement = trigger.action
        delay = trigger.delay
        if delay is not None and self.early(trigger) is None and self.printer.expressions.known(delay) != 0:
            if not isinstance(trigger.action, ir.Assign) or not isinstance(trigger.action.target, ir.Signal):
                return self.later_call(trigger, delay)
            action = ir.SetAfter(trigger.action.target, trigger.action.value, delay)
        if isinstance(action, ir.CallRoutine):
            self.once(CALLED, trigger, name=action.name)
        return self.printer.captured(replace(action, origin=replace(trigger.origin, comments=())))

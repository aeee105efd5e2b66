"""Moves of other languages that V+ has to be told to stop behind.

A V+ program goes on as soon as a move begins, so a step behind a move acts early. Where another language's program acts
at the corner (signals, messages, waits) before the next move, the corner becomes a stop (BREAK); exact stops always do.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from functools import cache, partial

from rpl import ir
from rpl.ir.walk import expressions, walk

MOVES, ACTS, ENDS = "moves", "acts", "ends"
_QUIET = (ir.Nothing, ir.Label, ir.LookAhead, ir.SetForNextMove, ir.Trigger, ir.ExitLoop, ir.NextPass, ir.Do)
_LOOKS = frozenset(("current_target", "current_joints", "current_position"))


@dataclass(frozen=True, slots=True)
class Followed:
    """A move over a corner, the step behind it, and what comes first on all ways from there."""

    move: ir.Move
    next: ir.Statement | None
    rest: Callable[[], str]


@dataclass(slots=True)
class Corners:
    """Which moves are followed by an action before the next move. `stopped`: identities of such moves that had a
    corner."""

    program: ir.Program
    stopped: set[int] = field(default_factory=set)
    deferred: set[int] = field(default_factory=set)  # identities of steps that stand behind the next move instead
    broken: set[int] = field(default_factory=set)  # identities of steps with a BREAK in front
    loose: set[int] = field(default_factory=set)  # identities of moves that are stopped by one of these
    actors: dict[int, ir.Statement | None] = field(default_factory=dict)  # of the move that is looked at
    routines: dict[str, ir.Routine] = field(default_factory=dict)
    callers: dict[str, list[Callable[[], str]]] = field(default_factory=dict)
    open: set[str] = field(default_factory=set)
    behind: dict[tuple[str, frozenset[str]], str] = field(default_factory=dict)  # what follows routines, of one move
    labels: dict[tuple[str, str], Callable[[], str]] = field(default_factory=dict)
    homes: dict[int, str] = field(default_factory=dict)  # routine of each jump, by the jump's identity
    current: str = ""

    @classmethod
    def of(cls, program: ir.Program) -> Corners:
        found = cls(program)
        for module in program.modules:
            for routine in module.routines:
                found.routines.setdefault(routine.name.lower(), routine)
        moves: list[Followed] = []
        for key, routine in found.routines.items():
            found.current = key
            found.collect(routine.body, partial(found.after, key), moves)
        for one in moves:
            found.decide(one)
        return found

    def decide(self, move: Followed) -> None:
        """Stop at the corner where what acts stands right behind it; where only some ways lead to something that acts,
        in front of that."""
        self.actors.clear()
        self.behind.clear()
        if move.rest() != ACTS:
            return
        actors = [actor for actor in self.actors.values() if actor is not None]
        if len(actors) < len(self.actors) or (len(actors) == 1 and actors[0] is move.next):
            self.stopped.add(id(move.move))
        else:
            self.loose.add(id(move.move))
            self.broken |= set(self.actors)

    def acts(self, statement: ir.Statement | None) -> str:
        """Something that acts was met; None: no step can stand in front of it."""
        self.actors[id(statement)] = statement
        return ACTS

    def collect(self, body: ir.Body, rest: Callable[[], str], moves: list[Followed]) -> None:
        """Every move that goes over a corner, and every call, with what follows it."""
        for at, statement in enumerate(body):
            follows = partial(self.first, body, rest, at + 1)
            match statement:
                case ir.Move(blend=blend, concurrent=False) if blend is not None and not isinstance(
                    blend, ir.BlendStop
                ):
                    between = deferred(body, at + 1) if has_size(blend) else None
                    if between is None:
                        moves.append(Followed(statement, _next(body, at + 1), follows))
                    else:
                        self.deferred |= set(map(id, between))
                case ir.Label(name=name):
                    self.labels[self.current, name.lower()] = follows
                case ir.Goto():
                    self.homes[id(statement)] = self.current
                case ir.CallRoutine(name=name):
                    self.callers.setdefault(name.lower(), []).append(follows)
                case ir.While() | ir.Repeat() | ir.For() | ir.Loop():
                    self.collect(statement.body, self.around(statement, follows), moves)
                case _:
                    for inner in _bodies(statement):
                        self.collect(inner, follows, moves)

    def around(self, loop: ir.While | ir.Repeat | ir.For | ir.Loop, follows: Callable[[], str]) -> Callable[[], str]:
        """What follows the end of a loop's body: its condition, its body again, what stands behind it."""

        def again() -> str:
            condition = loop.condition if isinstance(loop, ir.While) else None
            condition = loop.until if isinstance(loop, ir.Repeat) else condition
            if condition is not None and looks(condition):
                return self.acts(None)
            first = self.first(loop.body, lambda: MOVES)
            if isinstance(loop, ir.Loop):
                return first
            other = follows()
            return first if first == ACTS else other

        return again

    def after(self, key: str) -> str:
        """What follows a routine's end at any of its calls."""
        if key in self.open:
            return MOVES
        asked = key, frozenset(self.open)
        if asked not in self.behind:
            self.open.add(key)
            found = [rest() for rest in self.callers.get(key, ())]
            self.open.discard(key)
            self.behind[asked] = ACTS if ACTS in found else MOVES
        return self.behind[asked]

    def first(self, body: ir.Body, rest: Callable[[], str], begin: int = 0) -> str:
        """What comes first from there on: a move, or something that acts or looks at the world."""
        for at in range(begin, len(body)):
            statement = body[at]
            match statement:
                case ir.Move() | ir.WaitForMotion():
                    return MOVES
                case ir.Assign(target=target):
                    if isinstance(target, ir.Signal | ir.System) or looks(statement):
                        return self.acts(statement)
                case ir.CallRoutine(name=name):
                    found = self.called(name, statement)
                    if found != ENDS:
                        return found
                case ir.If() | ir.Switch():
                    return self.choice(statement, partial(self.first, body, rest, at + 1))
                case ir.While() | ir.For() | ir.Repeat() | ir.Loop():
                    found = self.around(statement, lambda: ENDS)()
                    if found != ENDS:
                        return found
                case ir.Return():
                    return rest()
                case ir.Goto():
                    return self.jumped(statement)
                case _ if not isinstance(statement, _QUIET):
                    return self.acts(statement)
        return rest()

    def jumped(self, jump: ir.Goto) -> str:
        """What follows a jump's label."""
        key = self.homes.get(id(jump), ""), jump.label.lower()
        mark = f"{key[0]}:{key[1]}"
        if mark in self.open:
            return MOVES
        if key not in self.labels:
            return self.acts(None)
        self.open.add(mark)
        found = self.labels[key]()
        self.open.discard(mark)
        return found

    def choice(self, statement: ir.If | ir.Switch, rest: Callable[[], str]) -> str:
        asked: list[ir.Expression]
        if isinstance(statement, ir.If):
            asked = [condition for condition, _ in statement.branches]
        else:
            asked = [statement.selector]
        if any(map(looks, asked)):
            return self.acts(statement)
        behind = cache(rest)  # the ways meet again behind: looked at once, however many choices follow each other
        found = [self.first(body, behind) for body in (*_bodies(statement), ())]
        return ACTS if ACTS in found else found[0]

    def called(self, name: str, call: ir.Statement) -> str:
        routine = self.routines.get(name.lower())
        if routine is None:
            return self.acts(call)
        if name.lower() in self.open:
            return MOVES
        self.open.add(name.lower())
        found = self.first(routine.body, lambda: ENDS)
        self.open.discard(name.lower())
        return found


def _next(body: ir.Body, begin: int) -> ir.Statement | None:
    """The step that comes first from there on, apart from those that do nothing outside of the program."""
    rest = (body[at] for at in range(begin, len(body)))
    return next((one for one in rest if not isinstance(one, _QUIET) and not _is_quiet(one)), None)


def deferred(body: ir.Body, behind: int) -> list[ir.Statement] | None:
    """The steps from `behind` a move to the next one in the same body that can stand behind that; None: there is no
    next move, or something between them has to come first."""
    found: list[ir.Statement] = []
    for at in range(behind, len(body)):
        statement = body[at]
        if isinstance(statement, ir.Move):
            return found
        if acts_in_corner(statement):
            found.append(statement)
        elif not _is_quiet(statement):
            return None
    return None


def acts_in_corner(statement: ir.Statement) -> bool:
    """Is it a step that acts, and does the same when it stands behind the next move's step?"""
    match statement:
        case ir.Assign(target=ir.Signal(index=index), value=value):
            return _written(index) and _written(value)
        case ir.Pulse(signal=signal, value=value, duration=time) | ir.SetAfter(signal=signal, value=value, delay=time):
            return _written(signal) and _written(value) and _written(time)
        case ir.Message(text=text, kind=kind):
            return kind not in ("quit", "clear") and isinstance(text, ir.TextLiteral)
    return False


def _written(value: ir.Expression | None) -> bool:
    """Does it stand there as a number, depending on no variable?"""
    return not any(
        isinstance(one, ir.Name | ir.Call | ir.Builtin | ir.System | ir.VendorValue) for one in walk((value,))
    )


def _is_quiet(statement: ir.Statement) -> bool:
    """Does it neither act nor depend on where the robot is?"""
    if isinstance(statement, ir.Assign):
        return not isinstance(statement.target, ir.Signal | ir.System) and not looks(statement)
    return isinstance(statement, ir.Nothing | ir.LookAhead | ir.SetForNextMove | ir.Trigger)


def size_of(blend: ir.Blend) -> ir.Expression | None:
    """What says how large a corner is."""
    match blend:
        case ir.BlendDistance(distance=size) | ir.BlendPercent(percent=size) | ir.BlendSpeed(percent=size):
            return size
        case ir.BlendZone(distance=size):
            return size
    return None


def has_size(blend: ir.Blend) -> bool:
    """Is it a corner for certain, and no stop in disguise?"""
    match size_of(blend):
        case ir.IntLiteral(value=number) | ir.RealLiteral(value=number):
            return number > 0
        case ir.Quantity(value=ir.IntLiteral(value=number) | ir.RealLiteral(value=number)):
            return number > 0
    return False


def looks(node: object) -> bool:
    """Does it read a signal, the clock or where the robot is?"""
    for one in expressions((node,)):
        match one:
            case ir.Signal() | ir.VendorValue():
                return True
            case ir.System(name=name):
                row = ir.SYSTEM_VARIABLES.get(name)
                if name in ("timer", "time") or (row is not None and row.stops_advance):
                    return True
            case ir.Builtin(function=function) if function in _LOOKS:
                return True
    return False


def _bodies(statement: ir.Statement) -> tuple[ir.Body, ...]:
    match statement:
        case ir.If(branches=branches, otherwise=otherwise):
            return (*(body for _, body in branches), otherwise)
        case ir.Switch(cases=cases, default=default):
            return (*(case.body for case in cases), default or ())
        case ir.While(body=body) | ir.For(body=body) | ir.Repeat(body=body) | ir.Loop(body=body):
            return (body,)
    return ()

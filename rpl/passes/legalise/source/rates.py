"""Motion at a given speed (URScript speedl, speedj), which goes on until it is told otherwise, for targets whose moves
have an end.

A loop that does nothing but repeat it until a signal comes becomes searches of the way of one second, repeated; what
lasts a known time is a move by speed times time. Anything else is refused: a loop that counts its passes or does other
work would make a robot stop and go in each of them.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import replace

from rpl import ir
from rpl.diagnostics import Code, Severity, code
from rpl.ir.walk import walk
from rpl.passes.capabilities import MoveSetting
from rpl.passes.conditions import negation
from rpl.passes.legalise.context import Context, rules_of
from rpl.passes.legalise.rewriting.editing import Editor, edit_bodies, edit_routines, expansion
from rpl.passes.legalise.rewriting.jumps import LOOPS, inside
from rpl.passes.legalise.rewriting.stopping import stopped
from rpl.passes.legalise.stages import legalising
from rpl.passes.rewrite import rewrite_parts

SEARCHED = code(
    "velocity-search",
    Severity.WARNING,
    "a motion at a given speed that goes on until a condition is written as searches of the way of {seconds:g} s each,"
    " repeated: the robot stands for a moment between two of them",
)
WAY = code(
    "velocity-way",
    Severity.WARNING,
    "a motion at a given speed for a time is written as a move by speed times time, which comes to rest at its end",
)
LOST = code(
    "velocity-motion-lost",
    Severity.LOSS,
    "a motion that goes on at a given speed until it is told otherwise has no form in the target: {reason}",
    "give it a time and a stop right behind it, or let a loop that does nothing else repeat it until a signal comes",
    stops=True,
)
_NO_SPEED = "the run decides its speed in several directions, and the target's moves have no time"
_NOT_FOUND = "ERR_WHLSEARCH"
_PART_S = 1.0  # s: how much of an endless way is written at once; less would stop more often, more might not be reached
_LOGIC = (ir.Signal, ir.Unary, ir.Binary, ir.BoolLiteral, ir.IntLiteral, ir.RealLiteral)
_PAUSE_S = 0.1  # s: a loop that waits longer than this between two such motions does something else meanwhile


@legalising(sees=("velocity move",))
def rates(program: ir.Program, context: Context) -> ir.Program:
    """For every target of another language; none can say it."""

    def work(editor: Editor, routine: ir.Routine) -> ir.Routine:
        return edit_bodies(routine, _Rates(editor).body)

    return edit_routines(program, context, work)


def _is_rate(node: object) -> bool:
    return isinstance(node, ir.Move) and node.motion_class == "velocity"


class _Rates:
    def __init__(self, editor: Editor) -> None:
        self.editor, self.context = editor, editor.context

    def searched(self, move: ir.Move, going: ir.Expression) -> ir.While:
        """Searches, repeated while the condition holds. Where the target makes an error of a search that finds nothing,
        it is asked whether it did."""
        self.told(SEARCHED, move, seconds=_PART_S)
        asked = _NOT_FOUND in rules_of(self.context.target).errors
        hit = self.editor.temporary("hit", ir.BoolType()) if asked else None
        part = self.way(move, ir.RealLiteral(_PART_S), tidy=True)
        return ir.While(going, (replace(part, search=ir.Search(negation(going), stop="path", hit=hit)),))

    def body(self, body: ir.Body) -> ir.Body:
        done: list[ir.Statement] = []
        at = 0
        while at < len(body):
            statement = body[at]
            if isinstance(statement, ir.Move) and _is_rate(statement):
                made, used = self.single(statement, body[at + 1 :])
                done += made
                at += 1 + used
                continue
            if isinstance(statement, LOOPS) and any(map(_is_rate, statement.body)):
                done += self.loop(statement)
            else:
                done.append(inside(statement, self.body))
            at += 1
        return body if all(a is b for a, b in zip(done, body, strict=False)) and len(done) == len(body) else tuple(done)

    # ---- loops

    def loop(self, loop: ir.Statement) -> ir.Body:
        """A loop that repeats one motion."""
        assert isinstance(loop, LOOPS)  # asked by the caller
        moves = [one for one in loop.body if isinstance(one, ir.Move)]
        (move, *more) = moves
        if not more and _is_rate(move) and self.has_no_speed(move):
            return (inside(loop, lambda body: tuple(self.refused(one, _NO_SPEED) for one in body)),)
        going = _going(loop)
        if more or any(not _is_rate(one) for one in moves):
            return (inside(loop, self.body),)
        others = [one for one in loop.body if one is not move and not _is_idle(one) and not _is_exit(one)]
        if going is not None and not others and all(map(_is_outside, walk(going))):
            return (replace(self.searched(move, going), origin=loop.origin),)
        if going is None and isinstance(loop, ir.Loop) and not others and not _leaves(loop.body):
            self.told(SEARCHED, move, seconds=_PART_S)
            return (replace(loop, body=(self.way(move, ir.RealLiteral(_PART_S)),)),)
        return (inside(loop, lambda body: tuple(self.refused(one) for one in body)),)

    def refused(self, one: ir.Statement, reason: str = "its loop counts its passes or does other work") -> ir.Statement:
        return stopped(one, LOST, self.context, reason=reason) if isinstance(one, ir.Move) else inside(one, self.body)

    def has_no_speed(self, move: ir.Move) -> bool:
        """Does the run decide the speed in several directions, while the target's moves say no time? The move would go
        as fast as the one before it."""
        can = self.context.capabilities.settings
        timed = "duration" in (can.speeds or ("duration",)) and (MoveSetting.SPEED in can.of_moves or not can.modal)
        return not timed and any(value is None for _, value in _parts(move.target)) and _only(move.target) is None

    # ---- single ones

    def single(self, move: ir.Move, behind: ir.Body) -> tuple[ir.Body, int]:
        """What stands for the motion, and how many of the statements behind it are part of that."""
        if self.has_no_speed(move):
            return (stopped(move, LOST, self.context, reason=_NO_SPEED),), 0
        time = _seconds(move.speed.duration) if move.speed is not None and move.speed.duration is not None else None
        used = 0
        while used < len(behind) and isinstance(behind[used], ir.Nothing | ir.Wait):
            pause = behind[used]
            if isinstance(pause, ir.Wait):
                given = _seconds(pause.time)
                time = given if time is None else ir.Binary("+", time, given)
            used += 1
        after = behind[used] if used < len(behind) else None
        if isinstance(after, ir.StopMotion | ir.Move | None) and time is not None:
            self.told(WAY, move)
            kept = tuple(one for one in behind[:used] if one.origin.comments)
            notes = tuple(ir.Nothing(origin=one.origin) for one in kept)
            return (self.way(move, time), *notes), used
        if used == 0 and isinstance(after, ir.WaitUntil) and after.timeout is None and time is None:
            going = negation(after.condition)
            stops = len(behind) > 1 and isinstance(behind[1], ir.StopMotion)
            if stops and all(map(_is_outside, walk(going))):
                return expansion(move.origin, (self.searched(move, going),)), 1
        reason = "the program does other work meanwhile" if after is not None else "nothing says how long it lasts"
        return (stopped(move, LOST, self.context, reason=reason),), 0

    def told(self, what: Code, move: ir.Move, **more: float) -> None:
        self.context.diagnostics.report(what, move.origin, **more)

    def way(self, move: ir.Move, seconds: ir.Expression, tidy: bool = False) -> ir.Move:
        """The move by what the speed makes in that time."""
        seconds = _seconds(seconds)
        parts = list(_parts(move.target))
        target = rewrite_parts(move.target, lambda part: _times(part, seconds))
        given = move.speed or ir.Speed()
        speed = ir.Speed(duration=ir.Quantity(seconds, "s"))
        turns = [value for name, value in parts if name in "abc"]
        size = None if any(value != 0.0 for value in turns) else _size(parts, move.relative == "joints")
        number: ir.Expression | None = ir.RealLiteral(size) if size else None
        if size is None and all(value == 0.0 for value in turns):
            number = _only(move.target)
        if number is not None:
            if move.relative == "joints":
                speed = ir.Speed(axis=ir.Quantity(number, "rad/s"), axis_acceleration=given.axis_acceleration)
            else:
                speed = ir.Speed(path=ir.Quantity(number, "m/s"), path_acceleration=given.path_acceleration)
        origin = replace(move.origin, comments=()) if tidy else move.origin
        return replace(move, target=target, speed=speed, motion_class="classic", origin=origin)


def _going(loop: ir.Statement) -> ir.Expression | None:
    """While what the loop goes on, as far as that can be told from its head and from exits."""
    found: list[ir.Expression] = []
    if isinstance(loop, ir.While):
        found.append(loop.condition)
    elif isinstance(loop, ir.Repeat):
        found.append(negation(loop.until))
    elif not isinstance(loop, ir.Loop):
        return None
    found += [negation(condition) for one in loop.body if (condition := _exit(one)) is not None]
    going: ir.Expression | None = None
    for one in found:
        going = one if going is None else ir.Binary("and", going, one)
    return going


def _exit(statement: ir.Statement) -> ir.Expression | None:
    match statement:
        case ir.If(branches=((condition, (ir.ExitLoop(),)),), otherwise=()):
            return condition
    return None


def _is_exit(statement: ir.Statement) -> bool:
    return _exit(statement) is not None


def _leaves(body: ir.Body) -> bool:
    return any(isinstance(node, ir.ExitLoop | ir.Return | ir.Goto) for node in walk(*body))


def _is_idle(statement: ir.Statement) -> bool:
    """Does it let one cycle pass, or nothing at all?"""
    if isinstance(statement, ir.Nothing):
        return True
    if not isinstance(statement, ir.Wait):
        return False
    time = _number(_seconds(statement.time))
    return time is not None and time <= _PAUSE_S


def _is_outside(node: object) -> bool:
    """Is it part of a condition that signals alone decide?"""
    return not isinstance(node, ir.Expression) or isinstance(node, _LOGIC)


def _seconds(time: ir.Expression) -> ir.Expression:
    match time:
        case ir.Quantity(value=value, unit="s"):
            return value
    return time


def _number(value: ir.Expression) -> float | None:
    match value:
        case ir.IntLiteral(value=number) | ir.RealLiteral(value=number):
            return float(number)
        case ir.Unary(op="-", operand=operand):
            inner = _number(operand)
            return None if inner is None else -inner
        case ir.Quantity(value=inner_value):
            return _number(inner_value)
    return None


def _times(part: ir.Expression, seconds: ir.Expression) -> ir.Expression:
    if isinstance(part, ir.Quantity):
        return replace(part, value=_times(part.value, seconds))
    one, other = _number(part), _number(seconds)
    if one is not None and other is not None:
        return ir.RealLiteral(round(one * other, 12) + 0.0)
    if one == 0.0:
        return ir.RealLiteral(0.0)
    return ir.Binary("*", part, seconds)


def _parts(target: ir.Expression) -> Iterator[tuple[str, float | None]]:
    match target:
        case ir.Aggregate(entries=entries):
            yield from ((name or "", _number(value)) for name, value in entries)
        case ir.Builtin(arguments=arguments):
            names = ir.POSE
            yield from ((name, _number(value)) for name, value in zip(names, arguments, strict=False))


def _only(target: ir.Expression) -> ir.Expression | None:
    """The speed of the one direction that is not zero, where the run decides how fast it is."""
    if not isinstance(target, ir.Aggregate):
        return None
    given = [value for _, value in target.entries if _number(value) != 0.0]
    if len(given) != 1 or any(isinstance(node, ir.Call) for node in walk(*given)):
        return None
    (value,) = given
    return ir.Builtin("abs", (value.value if isinstance(value, ir.Quantity) else value,))


def _size(parts: list[tuple[str, float | None]], joints: bool) -> float | None:
    """The leading speed, where it is written out: m/s of the tool, rad/s of the axes."""
    numbers = [value for _, value in parts]
    if any(value is None for value in numbers):
        return None
    known = [value for value in numbers if value is not None]
    if not known:
        return None
    return round(max(map(abs, known)) if joints else math.hypot(*known), 9)


__all__ = ["rates"]

"""What a program does while a task moves the robot: which conditions it looks at in order to end the task, and what
is left to do when the task has ended.

A region is what stands between the start of the task and its last mention: statements that take no time, then one thing
that waits (a join, a wait for a condition, a loop that looks in each pass), then anything.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field, replace

from rpl import ir
from rpl.ir.walk import bodies, walk
from rpl.passes.legalise.context import Context
from rpl.passes.legalise.facts.usage import assigned_in
from rpl.passes.legalise.rewriting.beside import moves_or_waits
from rpl.passes.legalise.rewriting.editing import map_body, negation
from rpl.passes.legalise.rewriting.jumps import LOOPS, inside
from rpl.passes.legalise.settings.movesettings import plain

_WAITING = (ir.Wait, ir.WaitUntil, ir.WaitForMotion, ir.Dialog, ir.Pulse)
_STOPPING = (ir.StopMotion, ir.ClearMotion, ir.StartMotion)
_JUMPING = (ir.Goto, ir.Label, ir.Raise, ir.Halt)
_OPPOSITE = {"and": "or", "cand": "cor", "or": "and", "cor": "cand"}
_LEAVES = "the program leaves the place from where it looks at it"
_LONGEST_LOOK = 0.1  # s: a loop that looks less often is no watching


class UnfitError(Exception):
    """Why a task cannot be called as a routine."""


@dataclass(frozen=True, slots=True)
class Event:
    """A condition that ends the task, what is done first (takes no time), and the flag that says that it came."""

    condition: ir.Expression
    before: ir.Body
    hit: ir.Name


@dataclass(slots=True)
class WatchedTask:
    """The task's routine; routines (folded) that take time, that drive; `hidden`: names unseen by interrupts."""

    context: Context
    routine: ir.Routine
    timed: frozenset[str]
    driving: frozenset[str]
    hidden: frozenset[str] = frozenset()
    own: frozenset[str] = field(init=False)
    ended: frozenset[str] = field(init=False)
    events: list[Event] = field(default_factory=list)

    def __post_init__(self) -> None:
        self.own = frozenset(assigned_in(*bodies(self.routine)))
        tail: list[ir.Statement] = []
        for statement in reversed(self.routine.body):
            if self.takes_time(statement):
                break
            tail.append(statement)
        self.ended = frozenset(assigned_in(tuple(tail)))

    # ---- what is asked of statements

    def takes_time(self, statement: ir.Statement) -> bool:
        if moves_or_waits(statement, self.timed):
            return True
        return any(isinstance(node, (*_WAITING, *LOOPS)) for node in walk(statement))

    def controls(self, statement: object) -> bool:
        return any(
            isinstance(n, ir.TaskControl) and n.task.lower() == self.routine.name.lower() for n in walk(statement)
        )

    def names(self, condition: ir.Expression) -> set[str]:
        return {node.id.lower() for node in walk(condition) if isinstance(node, ir.Name)}

    def is_control(self, statement: ir.Statement, op: str) -> bool:
        return isinstance(statement, ir.TaskControl) and statement.op == op and self.controls(statement)

    def last_word(self, body: ir.Body, start: int) -> int | None:
        """The last statement of the body that concerns the task, or waits for what it says at its end; None when the
        program never does."""
        last = -1
        for at in range(start + 1, len(body)):
            statement = body[at]
            if self.is_control(statement, "start"):
                break
            waits = isinstance(statement, (*LOOPS, ir.WaitUntil)) and self.names_end(statement)
            if self.controls(statement) or waits:
                last = at
        if last < 0:
            return None
        while last + 1 < len(body) and isinstance(body[last + 1], _STOPPING):
            last += 1
        return last

    def names_end(self, statement: ir.Statement) -> bool:
        return any(isinstance(node, ir.Name) and node.id.lower() in self.ended for node in walk(statement))

    # ---- parts of a region

    def parted(self, region: ir.Body) -> tuple[ir.Body, list[Event], ir.Body]:
        """What stands before the waiting, what ends the task meanwhile, and what is left when it has ended."""
        for node in walk(*region):
            if isinstance(node, _JUMPING):
                raise UnfitError(_LEAVES)
            if isinstance(node, ir.CallRoutine | ir.Call) and node.name.lower() in self.driving:
                raise UnfitError("the program moves the robot too")
        self.events = []
        at = 0
        while at < len(region) and not self.controls(region[at]) and not self.takes_time(region[at]):
            at += 1
        before, rest = region[:at], region[at:]
        if not rest:
            raise UnfitError("the program does not wait for its end")
        first, after = rest[0], rest[1:]
        if any(isinstance(node, ir.Return) for node in walk(*before, first)):
            raise UnfitError(_LEAVES)
        match first:
            case ir.TaskControl(op="join"):
                done: ir.Body = ()
            case ir.TaskControl():
                raise UnfitError("the program ends it as soon as it has begun")
            case ir.WaitUntil():
                done, after = self.wait(first, after)
            case ir.While() | ir.Loop() | ir.Repeat():
                done, after = self.loop(first, after)
            case _:
                raise UnfitError("what the program does meanwhile takes time")
        return before, self.events, self.quiet((*done, *after))

    def ends(self, region: ir.Body) -> bool:
        """Does the program end the task there?"""
        return any(
            isinstance(node, ir.TaskControl) and node.op == "stop" and self.controls(node) for node in walk(*region)
        )

    def alone(self, region: ir.Body) -> ir.Body:
        """The region as the work of a task of its own."""
        for node in walk(*region):
            if isinstance(node, (*_JUMPING, ir.Return)):
                raise UnfitError(_LEAVES)
            calls = isinstance(node, ir.CallRoutine | ir.Call) and node.name.lower() in self.driving
            if calls or isinstance(node, (*_STOPPING, ir.Move, ir.MoveExternal, ir.Spline)):
                raise UnfitError("the program moves the robot too")
            if isinstance(node, ir.Name) and node.id.lower() in self.hidden:
                raise UnfitError(f"{node.id} is a variable of the routine that works meanwhile")
        return self.quiet(region)

    def quiet(self, body: ir.Body) -> ir.Body:
        """The statements with nothing that concerns the task, which has ended."""
        done: list[ir.Statement] = []
        removed = False
        for statement in body:
            if isinstance(statement, ir.TaskControl) and self.controls(statement):
                removed = statement.op == "stop"
                if statement.origin.comments:
                    done.append(ir.Nothing(origin=statement.origin))
            elif not (removed and isinstance(statement, _STOPPING)):
                removed = False
                done.append(inside(statement, self.quiet))
        return tuple(done)

    def event(self, condition: ir.Expression, before: ir.Body) -> ir.Expression:
        """A condition that ends the task; what says so afterwards."""
        for node in walk(condition, *before):
            if isinstance(node, ir.Name) and node.id.lower() in self.hidden:
                raise UnfitError(f"{node.id} is a variable of the routine that looks at it")
        hit = ir.Name(self.context.fresh(f"rpl_{self.routine.name}_ended"))
        self.events.append(Event(condition, before, hit))
        return hit

    def until_stop(self, body: ir.Body) -> tuple[ir.Body, ir.Body] | None:
        """What stands before the end of the task, and from there on; None when the task is not ended at once."""
        for at, statement in enumerate(body):
            if self.is_control(statement, "stop"):
                return body[:at], body[at:]
            if self.takes_time(statement) or self.controls(statement):
                return None
        return None

    def first_then(self, hit: ir.Expression, before: ir.Body) -> ir.Body:
        """What the interrupt has done already, unless it did not come."""
        wanted = tuple(one for one in before if not isinstance(one, ir.Nothing))
        return (ir.If(((negation(hit), wanted),)),) if wanted else ()

    # ---- what waits

    def wait(self, wait: ir.WaitUntil, after: ir.Body) -> tuple[ir.Body, ir.Body]:
        if wait.timeout is not None:
            raise UnfitError("the program waits for a limited time")
        terms = _terms(wait.condition, ("or", "cor"))
        watched = [one for one in terms if not self.names(one) & self.ended]
        if not watched:
            return (wait,), after
        hit, rest = self.behind(_joined(watched, "cor"), after)
        return (replace(wait, condition=ir.Binary("cor", wait.condition, hit)),), rest

    def loop(self, loop: ir.While | ir.Loop | ir.Repeat, after: ir.Body) -> tuple[ir.Body, ir.Body]:
        """A loop that looks: each branch ends the task, or has found it ended."""
        set_here = assigned_in(loop.body)
        done: ir.Statement = replace(loop, body=self.looks(loop.body))
        if not isinstance(loop, ir.While):
            if isinstance(loop, ir.Repeat) and not self.names(loop.until) & (self.ended | set_here):
                raise UnfitError("the loop that looks at it ends by another condition")
            return (done,), after
        terms = _terms(loop.condition, ("and", "cand"))
        left = [
            one
            for one in terms
            if not isinstance(one, ir.BoolLiteral) and not self.names(one) & (self.ended | set_here)
        ]
        if not left:
            return (done,), after
        hit, rest = self.behind(negation(_joined(left, "cand")), after)
        assert isinstance(done, ir.While)  # replace keeps the class
        return (replace(done, condition=ir.Binary("cand", negation(hit), loop.condition)),), rest

    def behind(self, condition: ir.Expression, after: ir.Body) -> tuple[ir.Expression, ir.Body]:
        """What says that the condition came, and what is left to do: the program may leave first when the task has
        ended by itself, or choose by the condition between that and ending the task."""
        guards = 0
        while guards < len(after) and self.found_ended(after[guards]):
            guards += 1
        told, rest = after[:guards], after[guards:]
        parts = self.until_stop(rest)
        if parts is not None:
            hit = self.event(condition, parts[0])
            return hit, (*told, *self.first_then(hit, parts[0]), *parts[1])
        if rest and isinstance(choice := rest[0], ir.If):
            ends = [body for body in (*(b for _, b in choice.branches), choice.otherwise) if self.controls(body)]
            parts = self.until_stop(ends[0]) if len(ends) == 1 else None
            decided = all(one == condition or self.known_at_end(one) for one, _ in choice.branches)
            if parts is not None and decided:
                hit = self.event(condition, parts[0])
                ending = (*self.first_then(hit, parts[0]), *parts[1])
                branches = tuple(
                    (hit if one == condition else one, ending if body is ends[0] else body)
                    for one, body in choice.branches
                )
                otherwise = ending if choice.otherwise is ends[0] else choice.otherwise
                return hit, (*told, replace(choice, branches=branches, otherwise=otherwise), *rest[1:])
        raise UnfitError("the program goes on while it moves")

    def found_ended(self, statement: ir.Statement) -> bool:
        """Does it leave the routine where the task has ended, and nothing else?"""
        if not isinstance(statement, ir.If) or statement.otherwise or self.controls(statement):
            return False
        return all(
            self.known_at_end(condition) and bool(body) and isinstance(body[-1], ir.Return)
            for condition, body in statement.branches
        )

    def known_at_end(self, condition: ir.Expression) -> bool:
        """Is the condition made of nothing but what the task says at its end?"""
        if any(isinstance(node, ir.Signal | ir.System | ir.Call | ir.Builtin) for node in walk(condition)):
            return False
        names = self.names(condition)
        return bool(names) and names <= self.ended

    def looks(self, body: ir.Body) -> ir.Body:
        return map_body(body, self.look)

    def look(self, statement: ir.Statement) -> ir.Body:
        match statement:
            case ir.Nothing():
                return (statement,)
            case ir.Wait(time=time):
                value = plain(time)
                if isinstance(value, ir.RealLiteral | ir.IntLiteral) and value.value <= _LONGEST_LOOK:
                    return (statement,)
                raise UnfitError("the loop that looks at it waits for too long")
            case ir.If(branches=branches, otherwise=otherwise):
                done = tuple(self.branch(condition, inner) for condition, inner in branches)
                return (replace(statement, branches=done, otherwise=self.looks(otherwise)),)
        raise UnfitError("the loop that looks at it does other work as well")

    def branch(self, condition: ir.Expression, body: ir.Body) -> tuple[ir.Expression, ir.Body]:
        if self.names(condition) & self.ended:
            return condition, body
        parts = self.until_stop(body)
        if parts is None:
            raise UnfitError("the loop that looks at it does other work as well")
        hit = self.event(condition, parts[0])
        return ir.Binary("cor", hit, condition), (*self.first_then(hit, parts[0]), *parts[1])


def _terms(condition: ir.Expression, ops: tuple[str, ...]) -> list[ir.Expression]:
    match condition:
        case ir.Binary(op=op, left=left, right=right) if op in ops:
            return [*_terms(left, ops), *_terms(right, ops)]
        case ir.Unary(op="not", operand=ir.Binary(op=op, left=left, right=right)) if (
            op in _OPPOSITE and _OPPOSITE[op] in ops
        ):
            return [*_terms(negation(left), ops), *_terms(negation(right), ops)]
    return [condition]


def _joined(terms: Sequence[ir.Expression], op: str) -> ir.Expression:
    done = terms[0]
    for one in terms[1:]:
        done = ir.Binary(op, done, one)
    return done


__all__ = ["Event", "UnfitError", "WatchedTask"]

"""Waits for a condition or a timer that has just been started: they are waits with a time limit.

People of languages without such a wait write one with a timer. Where nothing else reads the timer, all that sets it is
gone as well.
"""

from __future__ import annotations

from collections import Counter
from dataclasses import replace

from rpl import ir
from rpl.ir.walk import walk
from rpl.passes.fold import constant_number
from rpl.passes.legalise.context import Context
from rpl.passes.legalise.kinds import walk_for
from rpl.passes.legalise.rewriting.editing import Editor, edit_bodies, edit_routines, expansion
from rpl.passes.legalise.stages import legalising
from rpl.passes.rewrite import rewrite_bodies, visit_bodies
from rpl.passes.scope import ProgramScope, Scope

_READ = ("timer", "timer_positive")
_TIMERS = (*_READ, "timer_stopped")
_PAST = frozenset((">", ">="))


@legalising(unless=lambda context: not context.capabilities.io.wait_timeout, sees=("WaitUntil",))
def timed_waits(program: ir.Program, context: Context) -> ir.Program:
    """Only for targets that have a wait with a limit."""
    limited = _limited(program)
    if not limited:
        return program

    def work(editor: Editor, routine: ir.Routine) -> ir.Routine:
        return edit_bodies(routine, lambda body: _written(body, editor, limited))

    return edit_routines(program, context, work)


def _limited(program: ir.Program) -> frozenset[int]:
    """The timers that nothing reads but waits behind their start."""
    read: Counter[int] = Counter()
    for node in walk_for({"System"}, program):
        if isinstance(node, ir.System) and node.name in _TIMERS:
            number = _number(node)
            if number is None:
                return frozenset()  # any of them may be meant
            read[number] += 1
    scopes, waits = ProgramScope(program), Counter[int]()
    for module in program.modules:
        for routine in module.routines:
            scope = scopes.routine(module, routine)
            for statement in walk(routine):
                if isinstance(statement, ir.Assign) and (set_timer := _set(statement)) is not None:
                    read[set_timer] -= 1
            for body in _bodies(routine):
                for at in range(len(body)):
                    found = _wait(body, at, scope)
                    if found is not None:
                        waits[found[0]] += 1
    return frozenset(number for number, count in waits.items() if read[number] == count)


def _bodies(routine: ir.Routine) -> list[ir.Body]:
    found: list[ir.Body] = []

    def note(body: ir.Body) -> ir.Body:
        found.append(body)
        for statement in body:
            visit_bodies(statement, note)
        return body

    edit_bodies(routine, note)
    return found


def _written(body: ir.Body, editor: Editor, limited: frozenset[int]) -> ir.Body:
    done: list[ir.Statement] = []
    at = 0
    while at < len(body):
        found = _wait(body, at, editor.scope)
        if found is not None and found[0] in limited:
            _, seconds, condition, end = found
            late = editor.temporary("timed_out", ir.BoolType())
            wait = body[end - 1]
            assert isinstance(wait, ir.WaitUntil)  # what `_wait` found
            limit = ir.Quantity(ir.RealLiteral(seconds), "s")
            timed = replace(wait, condition=condition, timeout=limit, timed_out=late)
            done += expansion(body[at].origin, (timed,))
            at = end
            continue
        statement = body[at]
        at += 1
        if isinstance(statement, ir.Assign) and _set(statement) in limited:
            done.append(ir.Nothing(origin=statement.origin))
            continue
        done.append(rewrite_bodies(statement, lambda one: _written(one, editor, limited)))
    same = len(done) == len(body) and all(one is other for one, other in zip(done, body, strict=True))
    return body if same else tuple(done)


def _wait(body: ir.Body, at: int, scope: Scope) -> tuple[int, float, ir.Expression, int] | None:
    """A timer that is set and started here, and the wait behind it: the timer, the seconds, what else is waited for,
    and where it ends."""
    match body[at]:
        case ir.Assign(target=ir.System(name="timer") as timer, value=value):
            number, start = _number(timer), _seconds(value, scope)
        case _:
            return None
    end = at + 1
    if end < len(body) and body[end] == ir.Assign(replace(timer, name="timer_stopped"), ir.BoolLiteral(False)):
        end += 1
    match body[end : end + 1]:
        case (ir.WaitUntil(condition=ir.Binary(op="or" | "cor", left=left, right=right), timeout=None),):
            pass
        case _:
            return None
    if number is None or start is None:
        return None
    for past, other in ((right, left), (left, right)):
        limit = _limit(past, number, scope)
        if limit is not None and limit > start and not _reads(other):
            return number, round(limit - start, 6), other, end + 1
    return None


def _limit(past: ir.Expression, number: int, scope: Scope) -> float | None:
    """The seconds that the timer has to show; None for another condition."""
    match past:
        case ir.System(name="timer_positive") if _number(past) == number:
            return 0.0
        case ir.Binary(op=op, left=left, right=right) if op in _PAST:
            factor = _unit(left, number)
            seconds = _seconds(right, scope)
            return None if factor is None or seconds is None else seconds * factor
    return None


def _unit(shown: ir.Expression, number: int) -> float | None:
    """The seconds of one where that is what the timer shows; None for anything else."""
    match shown:
        case ir.System(name="timer"):
            return 1.0 if _number(shown) == number else None
        case ir.Convert(how="round_half_away", operand=inner):
            return _unit(inner, number)
        case ir.Magnitude(value=inner, unit=unit):
            found = _unit(inner, number)
            return None if found is None else found * ir.UNITS[unit]
    return None


def _seconds(value: ir.Expression, scope: Scope) -> float | None:
    if isinstance(value, ir.Quantity):
        found = constant_number(value.value, scope)
        return None if found is None else found * ir.UNITS[value.unit]
    return constant_number(value, scope)


def _reads(condition: ir.Expression) -> bool:
    return any(isinstance(one, ir.System) and one.name in _TIMERS for one in walk(condition))


def _number(timer: ir.System) -> int | None:
    match timer.indices:
        case (ir.IntLiteral(value=number),):
            return number
    return None


def _set(assign: ir.Assign) -> int | None:
    """The timer that an assignment sets, starts or stops."""
    match assign.target:
        case ir.System(name=name) as timer if name in _TIMERS:
            return _number(timer)
    return None


__all__ = ["timed_waits"]

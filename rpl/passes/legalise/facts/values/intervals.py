"""Which subscripts surely stay inside their arrays: intervals of variables, carried through a routine's statements.

What is known of a variable comes from constants, counting loops, comparisons in front of a branch and earlier
subscripts (outside, the program would have stopped there). A label forgets everything, a call what it may change;
globals are known only where no interrupt and no second task runs. Nothing here recurses on the depth of a program: the
blocks are generators that a loop drives.
"""

from __future__ import annotations

import math
from collections.abc import Generator, Iterable
from dataclasses import dataclass, replace

from rpl import ir
from rpl.ir.walk import bodies, walk
from rpl.passes.fold import constant_number
from rpl.passes.legalise.facts.effects import blocks, children, statements_in
from rpl.passes.legalise.facts.usage import assigned_in, base_name, given_beside
from rpl.passes.scope import Scope
from rpl.passes.typing import type_of

_DEEPEST = 12  # operators of a subscript; what is nested deeper is not looked into
_NONE: frozenset[tuple[str, int]] = frozenset()
_OPPOSITE = {"<": ">=", ">": "<=", "<=": ">", ">=": "<", "=": "<>", "<>": "="}
_MIRRORED = {"<": ">", ">": "<", "<=": ">=", ">=": "<=", "=": "=", "<>": "<>"}
_LEAVING = (ir.Return, ir.ExitLoop, ir.NextPass, ir.Goto, ir.Raise, ir.Retry, ir.TryNext)
_QUIET = (ir.Assign, ir.Nothing, ir.Do, ir.Clock, ir.Message)


@dataclass(frozen=True, slots=True)
class Span:
    """Values from `low` to `high`; `whole`: whole numbers only. `within`: at most as large as these dimensions of
    arrays, by name."""

    low: float = -math.inf
    high: float = math.inf
    whole: bool = False
    within: frozenset[tuple[str, int]] = _NONE

    def joined(self, other: Span) -> Span:
        """What holds of both."""
        low, high = min(self.low, other.low), max(self.high, other.high)
        return Span(low, high, self.whole and other.whole, self.within & other.within)


ANY = Span()
Known = dict[str, Span]
_Flowing = Generator["_Flowing", Known | None, Known | None]


def unproven(routine: ir.Routine, scope: Scope, alone: bool) -> set[int]:
    """Index expressions of the routine (by identity) that may be outside of their arrays. `alone`: nothing runs beside
    the routine, so that globals keep their values."""
    flow = _Flow(routine, scope, alone)
    for body in bodies(routine):
        _driven(flow.body(body, flow.beginning() if body is routine.body else {}))
    return flow.unproven


def _driven(first: _Flowing) -> None:
    stack: list[_Flowing] = [first]
    given: Known | None = None
    while stack:
        try:
            further = stack[-1].send(given)
        except StopIteration as done:
            stack.pop()
            given = done.value
        else:
            stack.append(further)
            given = None


class _Flow:
    def __init__(self, routine: ir.Routine, scope: Scope, alone: bool) -> None:
        self.routine, self.scope, self.alone = routine, scope, alone
        self.own = {one.name.lower() for one in routine.parameters if one.mode == "value"}
        self.referred = {one.name.lower() for one in routine.parameters if one.mode != "value"}
        for one in routine.declarations:
            if isinstance(one, ir.Variable) and one.storage == "variable":
                self.own.add(one.name.lower())
        self.own -= self.referred | given_beside(routine)
        self.unproven: set[int] = set()

    def beginning(self) -> Known:
        """First values of the routine's own variables."""
        known: Known = {}
        for one in self.routine.declarations:
            if not isinstance(one, ir.Variable) or one.name.lower() not in self.own:
                continue
            if one.initial is not None:
                known[one.name.lower()] = self.span(one.initial, {})
            elif not self.scope.rules.undefined:
                known[one.name.lower()] = Span(0, 0, True)
        return known

    # ---- statements

    def body(self, body: ir.Body, known: Known | None) -> _Flowing:
        for statement in body:
            if known is None:  # reached by a label only
                known = {}
            known = yield self.statement(statement, known)
        return known

    def statement(self, statement: ir.Statement, known: Known) -> _Flowing:
        match statement:
            case ir.If(branches=branches, otherwise=otherwise):
                ends: list[Known | None] = []
                for condition, inner in branches:
                    self.look((condition,), known)
                    ends.append((yield self.body(inner, self.holding(known, condition, True))))
                    known = self.holding(known, condition, False)
                ends.append((yield self.body(otherwise, known)))
                return _joined(ends)
            case ir.Switch(selector=selector, cases=cases, default=default):
                self.look((selector, *(value for case in cases for value in case.values)), known)
                ends = []
                for case in cases:
                    ends.append((yield self.body(case.body, self.chosen(known, selector, case.values))))
                ends.append((yield self.body(default or (), dict(known))))
                return _joined(ends)
            case ir.For():
                return (yield self.counting(statement, known))
            case ir.While(condition=condition, body=inner):
                known = self.in_loop(known, inner)
                head = dict(known)
                self.look((condition,), head)
                yield self.body(inner, self.holding(head, condition, True))
                return known if _left(inner) else self.holding(head, condition, False)
            case ir.Repeat(until=until, body=inner):
                known = self.in_loop(known, inner)
                end = yield self.body(inner, dict(known))
                self.look((until,), dict(known) if end is None or _left(inner) else end)
                return known if end is None or _left(inner) else self.holding(end, until, True)
            case ir.Loop(body=inner):
                known = self.in_loop(known, inner)
                yield self.body(inner, dict(known))
                return known
            case ir.Label():
                return {}
        self.simple(statement, known)
        ends_here = isinstance(statement, _LEAVING) or (isinstance(statement, ir.Halt) and statement.kind == "exit")
        return None if ends_here else known

    def simple(self, statement: ir.Statement, known: Known) -> None:
        """A statement without blocks: its subscripts, and what it changes."""
        expressions = children(statement)
        self.look(expressions, known)
        value: Span | None = None
        if isinstance(statement, ir.Assign) and isinstance(statement.target, ir.Name):
            value = self.span(statement.value, known)
        calls = any(isinstance(node, ir.Call) for node in walk(tuple(expressions)))
        if calls or not isinstance(statement, _QUIET):
            for name in [name for name in known if name not in self.own]:
                del known[name]
        for name in assigned_in((statement,)):
            known.pop(name, None)
        if value is not None and isinstance(statement, ir.Assign) and isinstance(statement.target, ir.Name):
            self.set(known, statement.target.id, value)

    def counting(self, loop: ir.For, known: Known) -> _Flowing:
        step_given = () if loop.step is None else (loop.step,)
        self.look((loop.start, loop.stop, *step_given), known)
        start, stop = self.span(loop.start, known), self.span(loop.stop, known)
        step = Span(1, 1, True) if loop.step is None else self.span(loop.step, known)
        at_least_once = loop.at_least_once and not start.high <= stop.low
        if loop.step is None and loop.automatic and start.high > stop.low:
            step = Span(-1, 1, True)
        known = self.in_loop(known, loop.body)
        name = loop.counter.lower()
        counter = Span(min(start.low, stop.low), max(start.high, stop.high), start.whole and step.whole)
        if step.low > 0:
            high = max(start.high, stop.high) if at_least_once else stop.high
            within = stop.within if not at_least_once else _NONE
            counter = replace(counter, low=start.low, high=high, within=within)
        elif step.high < 0:
            counter = replace(counter, low=min(start.low, stop.low) if loop.at_least_once else stop.low)
            counter = replace(counter, high=start.high)
        inner = dict(known)
        outer = name in self.own
        if loop.scoped:
            self.own.add(name)
        inner.pop(name, None)
        if name not in assigned_in(loop.body) and not _entered(loop.body):
            self.set(inner, name, counter)
        yield self.body(loop.body, inner)
        if loop.scoped and not outer:
            self.own.discard(name)
        if not loop.scoped:
            known.pop(name, None)
        return known

    def in_loop(self, known: Known, body: ir.Body) -> Known:
        """What holds at every place of a loop's body, however often it has run. What is only counted up stays above
        where it was, what is only counted down below."""
        if _entered(body):
            return {}
        left = dict(known)
        changes = _assignments(body)
        calls = any(isinstance(node, ir.Call | ir.CallRoutine) for node in walk(body))
        loud = calls or any(not isinstance(one, _QUIET) and not blocks(one) for one in statements_in(body))
        for name in [*left]:
            if loud and name not in self.own:
                del left[name]
        for name in assigned_in(body):
            span = left.pop(name, None)
            steps = [_step(name, value) for value in changes.get(name, [None])]
            known_steps = [step for step in steps if step is not None]
            if span is None or len(known_steps) != len(steps):
                continue
            whole = span.whole and all(isinstance(step, int) for step in known_steps)
            if all(step >= 0 for step in known_steps):
                self.set(left, name, Span(span.low, math.inf, whole))
            elif all(step <= 0 for step in known_steps):
                self.set(left, name, Span(-math.inf, span.high, whole))
        return left

    # ---- values

    def set(self, known: Known, name: str, span: Span) -> None:
        key = name.lower()
        if (key in self.own or self.alone) and key not in self.referred and span != ANY:
            known[key] = span
        else:
            known.pop(key, None)

    def span(self, value: ir.Expression, known: Known, depth: int = 0) -> Span:
        """Between which numbers a value lies."""
        if depth > _DEEPEST:
            return ANY
        match value:
            case ir.IntLiteral(value=number):
                return Span(number, number, True)
            case ir.RealLiteral(value=number):
                return Span(number, number, float(number).is_integer())
            case ir.Name(id=name):
                found = known.get(name.lower())
                if found is None:
                    fixed = constant_number(value, self.scope)
                    if fixed is not None:
                        return Span(fixed, fixed, fixed.is_integer())
                    found = ANY
                return found if found.whole or not self.counts(value) else replace(found, whole=True)
            case ir.Unary(op="-", operand=operand):
                inner = self.span(operand, known, depth + 1)
                return Span(-inner.high, -inner.low, inner.whole)
            case ir.Binary(op=op, left=left, right=right):
                return _combined(op, self.span(left, known, depth + 1), self.span(right, known, depth + 1))
            case ir.Convert(how="round_half_away" | "trunc" | "floor", operand=operand):
                return _rounded(self.span(operand, known, depth + 1))
            case ir.Convert(how="real", operand=operand):
                return self.span(operand, known, depth + 1)
            case ir.Builtin(function="round" | "trunc" | "floor" | "ceil", arguments=(operand,)):
                return _rounded(self.span(operand, known, depth + 1))
            case ir.Builtin(function="dimension", arguments=(ir.Name(id=name) as array, ir.IntLiteral(value=number))):
                return self.size(array, number - 1) or Span(1, math.inf, True, frozenset(((name.lower(), number - 1),)))
            case ir.Builtin(function="length", arguments=(ir.Name(id=name) as array,)):
                return self.size(array, 0) or Span(1, math.inf, True, frozenset(((name.lower(), 0),)))
        return Span(whole=self.counts(value))

    def counts(self, value: ir.Expression) -> bool:
        return isinstance(type_of(value, self.scope), ir.IntType)

    def size(self, array: ir.Name, dimension: int) -> Span | None:
        """The number of elements that an array is declared with (from one)."""
        type = type_of(array, self.scope)
        if not isinstance(type, ir.ArrayType) or dimension >= len(type.dimensions) or type.base != 1:
            return None
        bound = type.dimensions[dimension]
        number = None if bound is None else constant_number(bound, self.scope)
        return None if number is None else Span(number, number, True)

    def chosen(self, known: Known, selector: ir.Expression, values: Iterable[ir.Expression]) -> Known:
        """In a case: the selector has one of its values."""
        inner = dict(known)
        spans = [self.span(value, known) for value in values]
        if isinstance(selector, ir.Name) and spans:
            union = spans[0]
            for span in spans[1:]:
                union = union.joined(span)
            self.set(inner, selector.id, union)
        return inner

    def holding(self, known: Known, condition: ir.Expression, truth: bool) -> Known:
        """What is known where a condition has that value."""
        left = dict(known)
        work = [(condition, truth)]
        while work:
            one, holds = work.pop()
            match one:
                case ir.Unary(op="not", operand=operand):
                    work.append((operand, not holds))
                case ir.Binary(op="and" | "cand", left=first, right=second) if holds:
                    work += [(second, True), (first, True)]
                case ir.Binary(op="or" | "cor", left=first, right=second) if not holds:
                    work += [(second, False), (first, False)]
                case ir.Binary(op=op, left=first, right=second) if op in _OPPOSITE:
                    said = op if holds else _OPPOSITE[op]
                    self.compared(left, first, said, self.span(second, left))
                    self.compared(left, second, _MIRRORED[said], self.span(first, left))
        return left

    def compared(self, known: Known, place: ir.Expression, op: str, other: Span) -> None:
        if not isinstance(place, ir.Name):
            return
        span = self.span(place, known)
        gap = 1 if span.whole and other.whole else 0
        match op:
            case "<":
                span = replace(span, high=min(span.high, other.high - gap), within=span.within | other.within)
            case "<=":
                span = replace(span, high=min(span.high, other.high), within=span.within | other.within)
            case ">":
                span = replace(span, low=max(span.low, other.low + gap))
            case ">=":
                span = replace(span, low=max(span.low, other.low))
            case "=":
                low, high = max(span.low, other.low), min(span.high, other.high)
                span = Span(low, high, span.whole or other.whole, span.within | other.within)
            case _:
                return
        self.set(known, place.id, span)

    # ---- subscripts

    def look(self, expressions: Iterable[ir.Expression], known: Known) -> None:
        """Notes the subscripts that may be outside. Behind one the variable in it is inside (else the program has
        stopped), unless what stands in front of it decides whether it is evaluated."""
        nodes = list(walk(tuple(expressions)))
        decided = any(isinstance(node, ir.Binary) and node.op in ("cand", "cor") for node in nodes)
        for node in nodes:
            if not isinstance(node, ir.Index):
                continue
            if self.outside(node, known):
                self.unproven.add(id(node))
                self.within(node, {} if decided else known)

    def within(self, node: ir.Index, known: Known) -> None:
        type = type_of(node.base, self.scope)
        bounds = type.dimensions if isinstance(type, ir.ArrayType) else ()
        for index, bound in zip(node.indices, bounds, strict=False):
            size = None if bound is None else constant_number(bound, self.scope)
            if isinstance(index, ir.Name) and size is not None:
                span = self.span(index, known)
                self.set(known, index.id, replace(span, low=max(span.low, 1), high=min(span.high, size)))

    def outside(self, node: ir.Index, known: Known) -> bool:
        type = type_of(node.base, self.scope)
        if not isinstance(type, ir.ArrayType):
            return False
        array = node.base.id.lower() if isinstance(node.base, ir.Name) else ""
        for at, (index, bound) in enumerate(zip(node.indices, type.dimensions, strict=False)):
            span = self.span(index, known)
            size = None if bound is None else constant_number(bound, self.scope)
            if bound is None and isinstance(index, ir.IntLiteral):
                continue  # what is given has that element, or there is no room of its own for it
            inside = (size is not None and span.high <= size) or (array, at) in span.within
            if span.low < type.base or not inside:
                return True
        return False


def _joined(ends: list[Known | None]) -> Known | None:
    reached = [end for end in ends if end is not None]
    if not reached:
        return None
    first, *others = reached
    for other in others:
        first = {name: span.joined(other[name]) for name, span in first.items() if name in other}
    return first


def _left(body: ir.Body) -> bool:
    """May a loop with this body be left from inside?"""
    return any(isinstance(one, ir.ExitLoop | ir.Goto | ir.NextPass) for one in statements_in(body))


def _entered(body: ir.Body) -> bool:
    """May the program jump into the body, past what stands in front of it?"""
    return any(isinstance(one, ir.Label) for one in statements_in(body))


def _assignments(body: ir.Body) -> dict[str, list[ir.Expression | None]]:
    """What is assigned to each name; None: by something else than an assignment."""
    found: dict[str, list[ir.Expression | None]] = {}
    for one in statements_in(body):
        match one:
            case ir.Assign(target=ir.Name(id=name), value=value):
                found.setdefault(name.lower(), []).append(value)
            case ir.For(counter=name):
                found.setdefault(name.lower(), []).append(None)
            case _ if not blocks(one):
                for name in assigned_in((one,)):
                    found.setdefault(name, []).append(None)
    for node in walk(body):
        for argument in node.arguments if isinstance(node, ir.Call) else ():
            given = None if argument.value is None else base_name(argument.value)
            if given is not None:
                found.setdefault(given, []).append(None)
    return found


def _step(name: str, value: ir.Expression | None) -> float | None:
    """How far an assignment counts its variable on."""
    match value:
        case ir.Binary(op="+" | "-" as op, left=ir.Name(id=own), right=right) if own.lower() == name:
            if isinstance(right, ir.IntLiteral | ir.RealLiteral):
                return right.value if op == "+" else -right.value
        case ir.Binary(op="+", left=ir.IntLiteral(value=number), right=ir.Name(id=own)) if own.lower() == name:
            return number
    return None


def _combined(op: str, left: Span, right: Span) -> Span:
    whole = left.whole and right.whole
    match op:
        case "+":
            return Span(left.low + right.low, left.high + right.high, whole)
        case "-":
            within = left.within if right.low >= 0 else _NONE
            return Span(left.low - right.high, left.high - right.low, whole, within)
        case "*" if math.inf not in {*map(abs, (left.low, left.high, right.low, right.high))}:
            corners = [a * b for a in (left.low, left.high) for b in (right.low, right.high)]
            return Span(min(corners), max(corners), whole)
        case "div" if right.low == right.high > 0 and left.low >= 0:
            return Span(left.low // right.low, left.high // right.low, True)
        case "mod" if right.low == right.high > 0 and whole:
            most = right.low - 1
            return Span(0 if left.low >= 0 else -most, min(most, max(left.high, 0)), True)
    return Span(whole=whole and op in "+-*")


def _rounded(span: Span) -> Span:
    low = span.low if math.isinf(span.low) else math.floor(span.low)
    high = span.high if math.isinf(span.high) else math.ceil(span.high)
    return Span(low, high, True)

"""Comparisons that may come out otherwise where the target calculates with more or fewer digits than the source.

Sums of 0.1 reach 1 after ten steps with four bytes and after eleven with eight. Where whole numbers, halves and
quarters are added, or a value is only handed on, both are exact; what is named here was added up in steps that are not
exact, or is looked at for equality behind a calculation with fractions.
"""

from __future__ import annotations

from collections.abc import Iterator

from rpl import ir
from rpl.diagnostics import Severity, code
from rpl.ir.walk import walk
from rpl.passes.fold import constant_number
from rpl.passes.legalise.context import Context, rules_of
from rpl.passes.legalise.wholes import Key, place_key
from rpl.passes.scope import ProgramScope, Scope
from rpl.passes.typing import type_of

PRECISION = code(
    "precision-differs",
    Severity.WARNING,
    "{what}: the source calculates with {source} bits and the target with {target}, so it may come out otherwise",
    "compare with a tolerance, or count whole steps",
)
WHOLE = code(
    "whole-number-rounded",
    Severity.WARNING,
    "whole numbers may get beyond {most} here, up to which the target's numbers are exact",
    "keep them smaller, or calculate in two parts",
)
Element = tuple[Key, tuple[int, ...]]
_EQUAL, _ORDER = ("=", "<>"), ("<", ">", "<=", ">=")
_STEPS = frozenset(("increment", "decrement"))
_FINEST = 2.0**10  # a step of a whole number of these parts of one is added without rounding, up to 16,000


def precisions(program: ir.Program, context: Context) -> ir.Program:
    """Reports only."""
    ours, theirs = rules_of(context.source), rules_of(context.target)
    if ours.whole_bits > theirs.whole_bits == theirs.real_bits:
        for statement in _Spans(program, 2**theirs.whole_bits).beyond():
            context.diagnostics.report(WHOLE, statement.origin, most=2**theirs.whole_bits)
    bits = ours.real_bits, theirs.real_bits
    if bits[0] == bits[1]:
        return program
    for what, statement in _Facts(program).compared():
        context.diagnostics.report(PRECISION, statement.origin, what=what, source=bits[0], target=bits[1])
    return program


class _Facts:
    """`added`: places that grow in steps that are not exact. `rounded`: those, and results of calculations."""

    def __init__(self, program: ir.Program) -> None:
        self.scopes = ProgramScope(program)
        self.added: set[Element | None] = set()
        self.rounded: set[Element | None] = set()
        self.loops: list[ir.For] = []
        for module, routine in self.scopes.routines():
            scope = self.scopes.routine(module, routine)
            for node in walk(routine):
                self.note(node, scope)

    def note(self, node: object, scope: Scope) -> None:
        match node:
            case ir.Assign(target=target, value=ir.Binary() as value) if inexact(value, scope):
                key = _element(target, scope)
                if key is not None:
                    self.rounded.add(key)
                    if value.op in ("+", "-") and target in (value.left, value.right):
                        self.added.add(key)
            case ir.Do(procedure=procedure, arguments=(place, step)) if procedure in _STEPS and place and step:
                key = _element(place, scope)
                if key is not None and not _exact(step, scope):
                    self.added.add(key)
                    self.rounded.add(key)
            case ir.For(step=step) if step is not None and not _exact(step, scope):
                self.loops.append(node)

    def compared(self) -> Iterator[tuple[str, ir.Statement]]:
        for module, routine in self.scopes.routines():
            scope = self.scopes.routine(module, routine)
            for statement in walk(routine):
                match statement:
                    case ir.If() | ir.While() | ir.Repeat() | ir.Assign() | ir.WaitUntil():
                        for condition in _conditions(statement):
                            if self.differs(condition, scope):
                                yield "a comparison behind calculations with fractions", statement
                                break
                    case ir.For() if any(statement is one for one in self.loops):
                        yield "a loop that counts in fractions", statement

    def differs(self, condition: ir.Expression, scope: Scope) -> bool:
        for node in walk((condition,)):
            if not isinstance(node, ir.Binary) or node.op not in (*_EQUAL, *_ORDER):
                continue
            sides = [node.left, node.right]
            if any(_element(side, scope) in self.added for side in sides):
                return True
            if node.op in _EQUAL and any(
                _element(side, scope) in self.rounded or inexact(side, scope) for side in sides
            ):
                return True
        return False


class _Spans:
    """How large whole numbers get, as far as literals, remainders and what is stored say: sums and products of them."""

    def __init__(self, program: ir.Program, most: int) -> None:
        self.scopes, self.most = ProgramScope(program), most
        self.stored: dict[Key, int | None] = {}  # None: it may be any
        self.sizes: dict[int, int | None] = {}  # of the statement that is looked at
        for module, routine in self.scopes.routines():
            scope = self.scopes.routine(module, routine)
            for node in walk(routine):
                if isinstance(node, ir.Assign) and (key := place_key(node.target, scope)) is not None:
                    size = self.plain(node.value)
                    known = self.stored.get(key, 0)
                    self.stored[key] = None if size is None or known is None else max(size, known)
                elif isinstance(node, ir.For) and (key := place_key(ir.Name(node.counter), scope)) is not None:
                    self.stored[key] = None

    @staticmethod
    def plain(value: ir.Expression) -> int | None:
        match value:
            case ir.IntLiteral(value=number):
                return abs(number)
            case ir.Binary(op="mod", right=ir.IntLiteral(value=number)):
                return max(0, abs(number) - 1)
        return None

    def beyond(self) -> Iterator[ir.Statement]:
        for module, routine in self.scopes.routines():
            scope = self.scopes.routine(module, routine)
            for statement in walk(routine):
                if isinstance(statement, ir.Assign):
                    self.sizes.clear()
                    if any(self.large(node, scope) for node in walk(statement.value)):
                        yield statement

    def large(self, node: object, scope: Scope) -> bool:
        """A whole number that is written out, or calculated of known ones, beyond what is exact."""
        if not isinstance(node, ir.IntLiteral | ir.Binary):
            return False
        size = self.size(node, scope)
        return size is not None and size >= self.most

    def size(self, value: ir.Expression, scope: Scope) -> int | None:
        """At most so far from zero; None: not known. What a statement asks twice is worked out once."""
        if id(value) not in self.sizes:
            self.sizes[id(value)] = self.worked_out(value, scope)
        return self.sizes[id(value)]

    def worked_out(self, value: ir.Expression, scope: Scope) -> int | None:
        match value:
            case ir.Name() | ir.Index() | ir.Field():
                key = place_key(value, scope)
                whole = key is not None and isinstance(type_of(value, scope), ir.IntType)
                return self.stored.get(key) if whole and key is not None else None
            case ir.Binary(op="+" | "-" | "*" as op, left=left, right=right):
                one, other = self.size(left, scope), self.size(right, scope)
                if one is None or other is None:
                    return None
                return one * other if op == "*" else one + other
        return self.plain(value)


def _conditions(statement: ir.If | ir.While | ir.Repeat | ir.Assign | ir.WaitUntil) -> list[ir.Expression]:
    match statement:
        case ir.If(branches=branches):
            return [condition for condition, _ in branches]
        case ir.While(condition=condition) | ir.WaitUntil(condition=condition) | ir.Repeat(until=condition):
            return [condition]
        case ir.Assign(value=value):
            return [value]


def inexact(value: ir.Expression, scope: Scope) -> bool:
    """Is it a calculation of real numbers whose result may be rounded?"""
    match value:
        case ir.Binary(op="/", right=right):
            number = constant_number(right, scope)
            rounds = number is None or number == 0 or not _power_of_two(abs(number))
            return rounds and isinstance(type_of(value, scope), ir.RealType)
        case ir.Binary(op="+" | "-" | "*" | "**"):
            literals = (one for one in walk((value,)) if isinstance(one, ir.RealLiteral | ir.IntLiteral))
            return any(not _exact(one, scope) for one in literals) and isinstance(type_of(value, scope), ir.RealType)
    return False


def _element(place: ir.Expression, scope: Scope) -> Element | None:
    """A variable, component or list; of elements with a number each is a place of its own."""
    key = place_key(place, scope)
    numbers = tuple(one.value if isinstance(one, ir.IntLiteral) else -1 for one in getattr(place, "indices", ()))
    return None if key is None else (key, numbers)


def _power_of_two(number: float) -> bool:
    return number >= 1 and number.is_integer() and not int(number) & (int(number) - 1)


def _exact(value: ir.Expression, scope: Scope) -> bool:
    """A number that both precisions hold and add exactly. One that is not known counts as such: it may be whole."""
    number = constant_number(value, scope)
    return number is None or (number * _FINEST).is_integer()

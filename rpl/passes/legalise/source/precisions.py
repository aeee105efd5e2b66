"""Comparisons that may come out otherwise where the target calculates with more or fewer digits than the source.

Sums of 0.1 reach 1 after ten steps with four bytes and after eleven with eight. Where whole numbers, halves and
quarters are added, or a value is only handed on, both are exact; what is named here was added up in steps that are not
exact, or is looked at for equality behind a calculation with fractions, or with a tolerance that four bytes do not
resolve, or cut to whole numbers behind one. Values are followed through assignments, arguments and results.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterator

from rpl import ir
from rpl.diagnostics import Severity, code
from rpl.ir.walk import statements, walk
from rpl.passes.fold import constant_number
from rpl.passes.legalise.context import Context, rules_of
from rpl.passes.legalise.facts.effects import children
from rpl.passes.legalise.facts.values.wholes import Key, Wholes, place_key
from rpl.passes.legalise.stages import legalising
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
_TOLERANCE = 1e-4  # numbers of four bytes near 1,000 lie 0.00006 apart: a finer tolerance says nothing
_CUTS = frozenset(("trunc", "floor", "ceil"))
# Functions whose result is rounded, whatever they are given.
_ROUNDING = frozenset(
    (
        *("sqrt", "sin", "cos", "tan", "asin", "acos", "atan", "atan2", "exp", "power", "log", "log10", "distance"),
        *("magnitude", "dot", "euler_x", "euler_y", "euler_z", "rotation_vector_x", "rotation_vector_y"),
        *("rotation_vector_z", "zyz_yaw", "zyz_pitch", "zyz_roll", "rotation_angle"),
    )
)
_ANY = -1  # a subscript that is computed


@legalising()
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


class _Places:
    """A set of places. One of a list counts for its elements; elements whose subscript is computed are a place of their
    own, or one of them would make all registers of a controller suspect."""

    def __init__(self) -> None:
        self.elements: set[Element] = set()
        self.keys: set[Key] = set()

    def add(self, element: Element) -> bool:
        """Is it new?"""
        if element in self.elements:
            return False
        self.elements.add(element)
        self.keys.add(element[0])
        return True

    def __contains__(self, element: Element | None) -> bool:
        if element is None or element[0] not in self.keys:
            return False
        key, numbers = element
        return element in self.elements or not numbers or (key, ()) in self.elements


class _Facts:
    """`added`: places that grow in steps that are not exact. `rounded`: those, and results of calculations. `fine`:
    places that hold a tolerance which four bytes do not resolve."""

    def __init__(self, program: ir.Program) -> None:
        self.scopes = ProgramScope(program)
        self.added, self.rounded, self.fine = _Places(), _Places(), _Places()
        self.loops: set[int] = set()
        self.steps: list[tuple[Element, Element]] = []
        self.edges: defaultdict[Key, list[tuple[Element, Element, bool]]] = defaultdict(list)
        passing: set[Key] = set()
        for module, routine in self.scopes.routines():
            scope = self.scopes.routine(module, routine)
            passing |= {id(routine), *map(id, routine.parameters)}
            for node in walk(routine):
                self.note(node, scope)
        wholes = Wholes.of(program, self.scopes)
        for place, value, scope in wholes.flows:
            if place in passing:
                self.flow((place, ()), value, scope)
        for one, others in wholes.equal.items():
            for other in others:
                self.edges[one].append(((one, ()), (other, ()), True))
        self.grown()
        for places in (self.added, self.rounded, self.fine):
            self.spread(places, plainly=places is self.fine)

    def note(self, node: object, scope: Scope) -> None:
        match node:
            case ir.Assign(target=target, value=value) if isinstance(type_of(target, scope), ir.RealType):
                element = _element(target, scope)
                if element is None:
                    return
                self.flow(element, value, scope)
            case ir.Do(procedure=procedure, arguments=(place, step)) if procedure in _STEPS and place and step:
                element = _element(place, scope)
                if element is not None and not _exact(step, scope):
                    self.added.add(element)
                    self.rounded.add(element)
            case ir.For(step=step) if step is not None and not _exact(step, scope):
                self.loops.add(id(node))

    def flow(self, target: Element, value: ir.Expression, scope: Scope) -> None:
        number = constant_number(value, scope)
        if number is not None:
            if 0 < abs(number) < _TOLERANCE:
                self.fine.add(target)
            return
        if inexact(value, scope):
            self.rounded.add(target)
        plainly = _element(value, scope) is not None
        reads = _reads(value, scope)
        for read in reads:
            self.edges[read[0]].append((read, target, plainly))
        if isinstance(value, ir.Binary) and value.op in ("+", "-") and inexact(value, scope):
            self.steps.extend((read, target) for read in reads)

    def grown(self) -> None:
        """What is added to comes back to where it was read: in its own statement, or by way of calls and copies."""
        known: dict[Element, _Places] = {}
        for read, target in self.steps:
            if read != target and target not in known:
                known[target] = _Places()
                known[target].add(target)
                self.spread(known[target], plainly=False)
            if read == target or read in known[target]:
                self.added.add(target)

    def spread(self, places: _Places, plainly: bool) -> None:
        """Adds what gets its value from them, by arithmetic too unless `plainly`."""
        work = list(places.keys)
        while work:
            for read, target, plain in self.edges.get(work.pop(), ()):
                if (plain or not plainly) and read in places and places.add(target):
                    work.append(target[0])

    def compared(self) -> Iterator[tuple[str, ir.Statement]]:
        for module, routine in self.scopes.routines():
            scope = self.scopes.routine(module, routine)
            for statement in statements(routine):
                if id(statement) in self.loops:
                    yield "a loop that counts in fractions", statement
                    continue
                for node in walk(tuple(children(statement))):
                    what = self.differs(node, scope)
                    if what:
                        yield what, statement
                        break

    def differs(self, node: object, scope: Scope) -> str:
        """What may come out otherwise in this expression; empty when nothing."""
        match node:
            case ir.Binary(op="=" | "<>" | "<" | ">" | "<=" | ">=" as op, left=left, right=right):
                sides = (left, right)
                if any(_element(side, scope) in self.added for side in sides):
                    return _COMPARISON
                if op in _EQUAL and any(self.is_rounded(side, scope) for side in sides):
                    return _COMPARISON
                if op in _ORDER and (self.resolves(left, right, scope) or self.resolves(right, left, scope)):
                    return "a comparison with a tolerance that four bytes do not resolve"
            case ir.Builtin(function=function, arguments=(value,)) if function in _CUTS and self.cut(value, scope):
                return _CUT
            case ir.Convert(how="trunc", operand=value) if self.cut(value, scope):
                return _CUT
        return ""

    def is_rounded(self, side: ir.Expression, scope: Scope) -> bool:
        return _element(side, scope) in self.rounded or inexact(side, scope)

    def resolves(self, tolerance: ir.Expression, value: ir.Expression, scope: Scope) -> bool:
        """Is a calculated value compared with a tolerance that is too fine for four bytes?"""
        number = constant_number(tolerance, scope)
        if not (0 < abs(number) < _TOLERANCE if number is not None else _element(tolerance, scope) in self.fine):
            return False
        return constant_number(value, scope) is None and (
            isinstance(value, ir.Binary | ir.Builtin) or self.is_rounded(value, scope)
        )

    def cut(self, value: ir.Expression, scope: Scope) -> bool:
        """May a value that is cut lie on either side of a whole number?"""
        if constant_number(value, scope) is not None:
            return False
        if isinstance(value, ir.Binary) and value.op in ("+", "-", "*") and inexact(value, scope):
            return True
        return any(read in self.added for read in _reads(value, scope))


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


_COMPARISON = "a comparison behind calculations with fractions"
_CUT = "the whole part of what is calculated with fractions"


def _reads(value: ir.Expression, scope: Scope) -> list[Element]:
    """The places and the results of calls that a number is calculated from, without what only chooses or rounds."""
    found: list[Element] = []
    work: list[object] = [value]
    while work:
        node = work.pop()
        match node:
            case ir.Name() | ir.Index() | ir.Field() | ir.Call():
                element = _element(node, scope)
                if element is not None:
                    found.append(element)
            case ir.Binary(op="+" | "-" | "*" | "/" | "**", left=left, right=right):
                work += (left, right)
            case ir.Unary(op="-" | "+", operand=operand):
                work.append(operand)
            case ir.Builtin(function="abs" | "min" | "max", arguments=arguments):
                work += arguments
    return found


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
        case ir.Builtin(function=function):
            return function in _ROUNDING
    return False


def _element(place: object, scope: Scope) -> Element | None:
    """A variable, component or list; of elements with a number each is a place of its own; what a function gives."""
    if isinstance(place, ir.Call):
        routine = scope.routine(place.name)
        return None if routine is None else (id(routine), ())
    if not isinstance(place, ir.Name | ir.Index | ir.Field):
        return None
    key = place_key(place, scope)
    numbers = tuple(one.value if isinstance(one, ir.IntLiteral) else _ANY for one in getattr(place, "indices", ()))
    return None if key is None else (key, numbers)


def _power_of_two(number: float) -> bool:
    return number >= 1 and number.is_integer() and not int(number) & (int(number) - 1)


def _exact(value: ir.Expression, scope: Scope) -> bool:
    """A number that both precisions hold and add exactly. One that is not known counts as such: it may be whole."""
    number = constant_number(value, scope)
    return number is None or (number * _FINEST).is_integer()

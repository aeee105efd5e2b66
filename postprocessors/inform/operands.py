"""Operands of instructions: numbered variables, constants, signals; and variables that the writer itself needs.

A helper variable is taken from the top of its bank, where the program has none, and is free again behind its statement.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field

from rpl import ir
from rpl.ir.walk import walk
from rpl.passes.rewrite import rewrite_parts
from rpl.writing.refusals import UNDECLARED_PLACE
from rpl.writing.statements import CannotSayError

from . import tables
from .texts import quoted, real

_NAMED = re.compile(r"(?P<bank>L?[BIDRSP])(?P<number>\d+)(?:_PULSES)?")
_KNOWN = re.compile(r"(?P<word>SIN|SOUT|EXIN|EXOUT|IU|OU|AX|RIN)#?\(?(?P<number>\d+)\)?")


@dataclass(slots=True)
class _Settings:
    """What sets the R variables, statement by statement."""

    whole: set[int] = field(default_factory=set)
    otherwise: set[int] = field(default_factory=set)
    any: bool = False  # an element is set that the run chooses

    def statement(self, statement: ir.Statement) -> None:
        match statement:
            case ir.Assign(target=target, value=value):
                place = numbered(target)
                self.any |= place is None and isinstance(target, ir.Index) and target.base == ir.Name("R")
                if place is not None and place[0] == "R":
                    (self.whole if _is_whole(value) else self.otherwise).add(place[1])
            case ir.For(counter=counter):
                self.otherwise |= _reals(ir.Name(counter))
            case ir.If() | ir.While() | ir.Repeat() | ir.Loop() | ir.Switch() | ir.Wait() | ir.Pulse():
                pass  # what is in them is looked at by itself
            case _:
                self.otherwise |= _reals(statement)

    def only_whole(self) -> frozenset[int]:
        return frozenset() if self.any else frozenset(self.whole - self.otherwise)


def _is_whole(value: ir.Expression) -> bool:
    known = constant(value)
    return known is not None and float(known).is_integer()


def _reals(node: object) -> set[int]:
    """The numbers of all R variables that are named in it."""
    places = (numbered(one) for one in walk(node) if isinstance(one, ir.Index | ir.Name))
    return {place[1] for place in places if place is not None and place[0] == "R"}


@dataclass(slots=True)
class Registers:
    """Which numbers of the banks are taken in the whole program."""

    used: dict[str, set[int]] = field(default_factory=dict)
    helpers: dict[tuple[str, ...], list[str]] = field(default_factory=dict)
    in_use: dict[tuple[str, ...], int] = field(default_factory=dict)
    set_whole: frozenset[int] = frozenset()  # numbers of R variables that are never set to anything but whole constants
    jobs: str = ""  # which jobs that run beside each other the lines at hand belong to; each have their own helpers

    @classmethod
    def of(cls, program: ir.Program, named: Iterable[tuple[str, int]] = ()) -> Registers:
        """`named`: numbers that stand for data of the source; elements chosen at run time are named nowhere else."""
        found, settings = cls(), _Settings()
        for bank, number in named:
            found.used.setdefault(bank, set()).add(number)

        def look(expression: ir.Expression) -> ir.Expression:
            place = numbered(expression)
            if place is not None:
                found.used.setdefault(place[0], set()).add(place[1])
            if isinstance(expression, ir.Call):
                settings.otherwise |= _reals(expression)
            return rewrite_parts(expression, look)

        def body(statements: ir.Body) -> ir.Body:
            for statement in statements:
                settings.statement(statement)
                if isinstance(statement, ir.For):
                    look(ir.Name(statement.counter))
                rewrite_parts(statement, look, body)
            return statements

        for module in program.modules:
            for declaration in module.declarations:
                if isinstance(declaration, ir.Variable):
                    look(ir.Name(declaration.name))
                    if declaration.initial is not None and not _is_whole(declaration.initial):
                        settings.otherwise |= _reals(ir.Name(declaration.name))
                elif isinstance(declaration, ir.Initialise):
                    body((declaration.assign,))
            for routine in module.routines:
                body(routine.body)
        found.set_whole = settings.only_whole()
        return found

    def take(self, bank: str) -> int:
        """The highest number of a controller as it is delivered that nobody has, else the next one above."""
        limits, used = tables.BANKS[bank], self.used.setdefault(bank, set())
        standard = tables.STANDARD_LAST[bank]
        numbers: list[int] = [*range(standard, limits.first - 1, -1), *range(standard + 1, limits.last + 1)]
        for number in numbers:
            if number not in used:
                used.add(number)
                return number
        raise CannotSayError(f"there is no free {bank} variable")

    def begin(self) -> None:
        """A new statement: its helpers are free."""
        self.in_use.clear()

    def helper(self, bank: str, holds: str = "") -> str:
        """`holds`: pulses are kept in other position variables than poses, because a variable of both is neither."""
        pool = (bank, self.jobs, holds)
        at = self.in_use.get(pool, 0)
        known = self.helpers.setdefault(pool, [])
        if at == len(known):
            known.append(f"{bank}{self.take(bank):03d}")
        self.in_use[pool] = at + 1
        return known[at]

    def is_helper(self, place: str) -> bool:
        return any(place in known for known in self.helpers.values())


def numbered(expression: ir.Expression) -> tuple[str, int] | None:
    """Bank and number of a variable with a constant number."""
    match expression:
        case ir.Index(base=ir.Name(id=bank), indices=(ir.IntLiteral(value=number),)) if bank in tables.BANKS:
            return bank, number
        case ir.Name(id=name):
            found = _NAMED.fullmatch(name)
            if found is not None:
                return found["bank"], int(found["number"])
    return None


def selected(expression: ir.Expression) -> tuple[str, int] | None:
    """Bank and number of a tool or a user frame of the controller."""
    match expression:
        case ir.Index(base=ir.Name(id=tables.TL | tables.UF as bank), indices=(ir.IntLiteral(value=number),)):
            return bank, number
    return None


def element(expression: ir.Expression) -> str | None:
    """`D004`, `P[D004]`; None when it is no numbered variable."""
    place = numbered(expression)
    if place is not None:
        bank, number = place
        limits = tables.BANKS[bank.removeprefix("L")]
        if not bank.startswith("L") and not limits.first <= number <= limits.last:
            raise CannotSayError(f"{bank}{number:03d} is outside of {limits.first}..{limits.last}")
        return f"{bank}{number:03d}"
    match expression:
        case ir.Index(base=ir.Name(id=bank), indices=(index,)) if bank.removeprefix("L") in tables.BANKS:
            inner = element(_whole(index))
            if inner is None or bank_of(inner) not in tables.WHOLE:
                raise CannotSayError("a computed number of a variable is in a variable of whole numbers")
            return f"{bank}[{inner}]"
    return None


def _whole(index: ir.Expression) -> ir.Expression:
    return index.operand if isinstance(index, ir.Convert) and index.how in ("trunc", "real") else index


def bank_of(place: str) -> str:
    """The bank of a printed variable: `D004` -> D, `LP[I000]` -> P."""
    return place.removeprefix("L")[:1]


def constant(expression: ir.Expression | None) -> float | None:
    """The number that an expression is, in base units."""
    match expression:
        case ir.IntLiteral(value=value) | ir.RealLiteral(value=value):
            return value
        case ir.Unary(op="-" | "+" as op, operand=operand):
            value_of = constant(operand)
            return None if value_of is None else -value_of if op == "-" else value_of
        case ir.Quantity(value=inner, unit=unit):
            value_of = constant(inner)
            return None if value_of is None else float(f"{value_of * ir.UNITS[unit]:.12g}")
        case ir.Convert(how="real", operand=operand):
            return constant(operand)
    return None


def simple(expression: ir.Expression) -> str | None:
    """A constant or a variable as an operand; None when it is more."""
    value = constant(expression)
    if value is not None:
        return str(value) if isinstance(value, int) else real(value)
    match expression:
        case ir.BoolLiteral(value=truth):
            return "1" if truth else "0"
        case ir.TextLiteral(value=text):
            return quoted(text)
        case ir.Convert(how="real" | "bit", operand=operand) if not isinstance(operand, ir.Signal):
            return simple(operand)
        case ir.Quantity(value=inner, unit=unit) if ir.UNITS[unit] == 1:
            return simple(inner)
        case ir.Index() | ir.Name():
            return element(expression)
    return None


def operand(expression: ir.Expression) -> str:
    shown = simple(expression)
    if shown is None:
        raise CannotSayError(f"{_what(expression)} inside of another instruction")
    return shown


def variable(expression: ir.Expression) -> str:
    shown = element(expression)
    if shown is None:
        if isinstance(expression, ir.Name):
            raise CannotSayError(expression.id, UNDECLARED_PLACE)
        raise CannotSayError(f"this is no numbered variable: {_what(expression)}")
    return shown


def _what(expression: ir.Expression) -> str:
    match expression:
        case ir.Builtin(function=name):
            return f"the function {name}"
        case ir.Name(id=name) | ir.System(name=name) | ir.Field(name=name):
            return name
        case ir.Binary(op=op) | ir.Unary(op=op):
            return f"the operation {op}"
    return expression.__class__.__name__


# ---- signals


def signal(given: ir.Signal) -> str:
    """`OT#(5)`, `IG#(2)`, `OGH#(1)`, `RIN#(1)`; a computed number stands as a variable."""
    if given.name is not None:
        found = _KNOWN.fullmatch(given.name)
        if found is None:
            raise CannotSayError(f"the signal {given.name} has no number")
        return f"{found['word']}#({int(found['number'])})"
    if given.index is None:
        raise CannotSayError("a signal needs a number")
    if given.last is not None:
        return _group(given)
    word = tables.SIGNALS.get(given.kind)
    if word is None:
        raise CannotSayError(f"there is no signal of the kind {given.kind}")
    number = constant(given.index)
    if number is None:
        return f"{word}#({variable(_whole(given.index))})"
    if word == "IN" and number > tables.DIRECT_INPUTS:
        return f"RIN#({int(number) - tables.DIRECT_INPUTS})"
    if not 1 <= number <= tables.LAST_SIGNAL[word]:
        raise CannotSayError(f"{word}#({number:g}) is outside of 1..{tables.LAST_SIGNAL[word]}")
    return f"{word}#({int(number)})"


def _group(given: ir.Signal) -> str:
    first, last = constant(given.index), constant(given.last)
    letter = "I" if given.kind.endswith("_in") else "O"
    if first is not None and last is not None:
        for word, bits in (("G", 8), ("GH", 4)):
            if last - first == bits - 1 and (first - 1) % bits == 0:
                return f"{letter}{word}#({int(first - 1) // bits + 1})"
    raise CannotSayError("a group has 8 signals from 1, 9, 17 ... or 4 from 1, 5, 9 ...")


def is_digital(given: ir.Expression) -> bool:
    return isinstance(given, ir.Signal) and given.last is None and not given.kind.startswith("analog")


def signals_of(given: ir.Signal) -> Iterator[ir.Signal]:
    """The single signals of a group, from the lowest bit."""
    first, last = constant(given.index), constant(given.last)
    if first is None or last is None:
        raise CannotSayError("a group with a computed number")
    kind = "digital_in" if given.kind == "group_in" else "digital_out"
    for number in range(int(first), int(last) + 1):
        yield ir.Signal(kind, ir.IntLiteral(number))

"""Which number each variable gets in a controller's banks: the plan, before any code is rewritten.

Numbers do not move when unrelated lines change: first those that an earlier translation gave, then those that the
source's own names say (R5, B003) or a remark behind them (`count ;R5`), then what is free in order of declaration;
generated variables come last.
"""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field, replace

from rpl import ir
from rpl.diagnostics import Severity, code
from rpl.passes.capabilities import Bank
from rpl.passes.fold import constant
from rpl.passes.legalise.context import Context
from rpl.passes.legalise.kinds import walk_for
from rpl.passes.scope import Scope
from rpl.passes.typewords import type_word
from rpl.source import NOWHERE, Origin

FULL = code(
    "registers-exceeded",
    Severity.LOSS,
    "the program needs {needed} numbers of {bank}, which has {count} ({first} to {last}); {name} gets none",
    "the program stops where it is used; make arrays smaller, or share variables",
)
MORE = code(
    "registers-set-up",
    Severity.WARNING,
    "the program needs {needed} numbers of {bank}; a controller as it is delivered has {count}",
    "set the number of {bank} to {last} or more when you set the controller up, before you load the program",
)
MIXED = code(
    "registers-mixed",
    Severity.LOSS,
    "an array whose element is chosen at run time shares {bank} with one of another type; {name} keeps its name",
)
NO_BANK = code("no-register", Severity.LOSS, "{name}: the target has no numbered storage for this type")


_SPARE, _STEP = 20, 50  # numbers kept for what later passes and the writer need; set-ups are made in round figures
_CHOSEN = 100_000  # an array whose element is chosen at run time decides the type of its bank


@dataclass(slots=True)
class Wanted:
    """A variable that wants numbers: `key` and other names it may have had, elements (1: no array), its declaration."""

    key: str
    aliases: tuple[str, ...]
    bank: Bank
    type: ir.Type
    sizes: tuple[int, ...]
    base: int
    declaration: ir.Variable
    origin: Origin = NOWHERE
    alone: bool = False  # as a variable of its own name, not as an element of the bank's array
    chosen: bool = False  # an array whose element is chosen at run time

    @property
    def count(self) -> int:
        total = 1
        for size in self.sizes:
            total *= size
        return total

    def element(self, offset: int) -> str:
        """The source's name of an element by its place in the array."""
        if not self.sizes:
            return self.key
        places: list[str] = []
        for size in reversed(self.sizes):
            places.insert(0, str(offset % size + self.base))
            offset //= size
        return f"{self.key}[{','.join(places)}]"


@dataclass(slots=True)
class Numbers:
    """Numbers given so far."""

    context: Context
    used: dict[str, set[int]] = field(default_factory=dict)
    needed: Counter[str] = field(default_factory=Counter)
    earlier: dict[tuple[str, str], int] = field(default_factory=dict)

    def __post_init__(self) -> None:
        for (bank, number), name in self.context.registers.items():
            self.earlier.setdefault((bank, name.lower()), number)
            self.earlier[bank, name] = number  # where capitals tell names apart
        for at in self.context.there.numbers:
            if at not in self.context.registers:  # a number of the map is the program's own
                self.used.setdefault(at[0], set()).add(at[1])

    def plan(self, wanted: Sequence[Wanted]) -> dict[int, int]:
        """id of a declaration -> its (first) number; what gets none is missing."""
        found: dict[int, int] = {}
        for one in wanted:
            self.needed[one.bank.name] += one.count
        for choice in (self.given_before, self.said_by_name):
            for one in wanted:
                number = None if id(one.declaration) in found else choice(one)
                if number is not None and self.take(one, number):
                    found[id(one.declaration)] = number
        kept = {(bank, number) for bank, number in self.context.registers}
        for one in wanted:
            if id(one.declaration) not in found:
                number = self.free(one, kept)
                number = self.free(one, set()) if number is None else number
                if number is None:
                    self.full(one)
                elif self.take(one, number):
                    found[id(one.declaration)] = number
        return found

    def given_before(self, one: Wanted) -> int | None:
        for key in (one.key, *one.aliases):
            first = key if not one.sizes else one.element(0).replace(one.key, key, 1)
            number = self.earlier.get((one.bank.name, first), self.earlier.get((one.bank.name, first.lower())))
            if number is not None:
                return number
        return None

    def said_by_name(self, one: Wanted) -> int | None:
        if one.sizes:
            return None
        name = one.declaration.name
        bank, number = self.context.said_numbers.get(name.lower(), ("", 0))
        return number if bank == one.bank.name else own_number(name, one.bank)

    def take(self, one: Wanted, number: int) -> bool:
        used = self.used.setdefault(one.bank.name, set())
        numbers = range(number, number + one.count)
        if numbers.start < one.bank.first or numbers.stop > one.bank.last + 1 or not used.isdisjoint(numbers):
            return False
        used.update(numbers)
        for offset, at in enumerate(numbers):
            self.context.register_names[one.bank.name, at] = one.element(offset)
            self.context.register_types[one.bank.name, at] = type_word(one.type) or ""
        return True

    def free(self, one: Wanted, kept: set[tuple[str, int]]) -> int | None:
        """The first free run of numbers; those of an earlier map are taken last, their owners may come back."""
        used = self.used.setdefault(one.bank.name, set())
        run = 0
        for number in range(one.bank.first, one.bank.last + 1):
            run = 0 if number in used or (one.bank.name, number) in kept else run + 1
            if run == one.count:
                return number - one.count + 1
        return None

    def full(self, one: Wanted) -> None:
        bank = one.bank
        self.context.diagnostics.report(
            FULL,
            one.origin,
            needed=self.needed[bank.name],
            bank=bank.name,
            count=bank.last - bank.first + 1,
            first=bank.first,
            last=bank.last,
            name=one.key,
        )


def enlarged(wanted: Sequence[Wanted], context: Context) -> dict[str, Bank]:
    """Banks that are too small as delivered, with as many numbers as the controller has to be set up for; by name."""
    needed: Counter[str] = Counter()
    for one in wanted:
        needed[one.bank.name] += one.count
    for bank_name, number in context.registers:
        needed[bank_name] = max(needed[bank_name], number)
    made: dict[str, Bank] = {}
    for one in wanted:
        bank, count = one.bank, needed[one.bank.name]
        delivered = bank.last - bank.first + 1
        if bank.name in made or count <= delivered or bank.first - 1 + count > bank.most:
            continue
        last = min(bank.most, -(-(bank.first - 1 + count + _SPARE) // _STEP) * _STEP)
        made[bank.name] = replace(bank, last=last)
        context.diagnostics.report(MORE, one.origin, needed=count, bank=bank.name, count=delivered, last=last)
    return made


def held(program: ir.Program, banks: Iterable[Bank]) -> dict[str, set[int]]:
    """Numbers of banks (by name) that signals and system variables of the program have. Where one is chosen at run
    time, the upper quarter of the bank is left for variables."""
    found: dict[str, set[int]] = {}
    by_use = {bank.holds: bank for bank in banks if bank.holds}
    for node in walk_for({"Signal", "System"}, *program.modules):
        match node:
            case ir.Signal(kind=use, index=index, name=None) if use in by_use and index is not None:
                number: ir.Expression = index
            case ir.System(name=name, indices=(index,)) if name.partition("_")[0] in by_use:
                use, number = name.partition("_")[0], index
            case _:
                continue
        bank = by_use[use]
        most = bank.last - (bank.last - bank.first + 1) // 4
        numbers = {number.value} if isinstance(number, ir.IntLiteral) else set(range(bank.first, most + 1))
        found.setdefault(bank.name, set()).update(numbers)
    return found


def own_number(name: str, bank: Bank) -> int | None:
    """The number that a name of the source says (`R5`, `B003`, `PR_7`), when the bank has it."""
    found = re.fullmatch(rf"{re.escape(bank.name)}_?0*(\d+)", name, re.IGNORECASE)
    number = int(found[1]) if found else bank.first - 1
    return number if bank.first <= number <= bank.last else None


def sizes_of(type: ir.ArrayType, scope: Scope) -> tuple[int, ...] | None:
    """How many elements each dimension has; None when that is not known while writing."""
    found = [constant(bound, scope) if bound is not None else None for bound in type.dimensions]
    if not all(isinstance(one, int) for one in found):
        return None
    return tuple(int(one) - type.base + 1 for one in found if isinstance(one, int))


def main_types(wanted: Iterable[Wanted]) -> dict[str, ir.Type]:
    """Bank -> the type of its array: what arrays with a chosen element have, else what most have; numbers are real."""
    counts: dict[str, Counter[str]] = {}
    types: dict[tuple[str, str], ir.Type] = {}
    for one in wanted:
        kind = one.type.__class__.__name__
        weight = _CHOSEN if one.chosen else 0 if one.alone else 1
        counts.setdefault(one.bank.name, Counter())[kind] += weight
        types.setdefault((one.bank.name, kind), one.type)
    found: dict[str, ir.Type] = {}
    for bank, kinds in counts.items():
        if "RealType" in kinds and "IntType" in kinds:
            found[bank] = ir.RealType()
        elif min(kinds["PoseType"], kinds["TargetType"]) >= _CHOSEN:
            found[bank] = types[bank, "TargetType"]  # a pose is a target that leaves the posture open
        else:
            found[bank] = types[bank, kinds.most_common(1)[0][0]]
        if isinstance(found[bank], ir.StringType):
            found[bank] = ir.StringType()
    return found


def fits(one: Wanted, main: ir.Type) -> bool:
    """Can it be an element of the bank's array?"""
    if isinstance(main, ir.NUMBER_TYPES) and isinstance(one.type, ir.NUMBER_TYPES):
        return True
    if one.chosen and isinstance(main, ir.TargetType) and isinstance(one.type, ir.PoseType):
        return True
    return one.type.__class__ is main.__class__

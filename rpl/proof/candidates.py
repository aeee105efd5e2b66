"""Values that could send a program another way, and cells that give them.

A value is worth trying when the program compares with it or when it lies just beside such a value. A cell is changed in
one source at a time: from the start on, or from a moment on, so that what came before stays as it was.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace

from rpl import ir
from rpl.cell import Answer, Cell, Input
from rpl.ir.walk import walk
from rpl.proof.unreached import Key, key_of
from rpl.proof.watched import Look, Side, Source
from rpl.runtime.signals import keys_named, usual_key
from rpl.runtime.values import Member, SignalRef, Value

MOST_VALUES = 24
_SEEDS = 6
# A whole step beside a number that the program compares with, and a part of a real one.
_PART = 0.1
_LEAST_PART = 1e-3
_ELEMENT = re.compile(r"(\w+)\[(\d+)\](.*)", re.DOTALL)


@dataclass(frozen=True, slots=True)
class Given:
    """A source, as a cell file names it, gets a value. `texts`: the signal, or the bits of a group lowest first; the
    variable."""

    source: Source
    texts: tuple[str, ...]
    value: Value


class Names:
    """How the first program's cell names what either program looks at."""

    def __init__(self, sides: Sequence[Side]) -> None:
        self.sides = sides
        self.dialect = sides[0].program.modules[0].dialect
        self.found: dict[tuple[int, Source], tuple[str, ...]] = {}
        self.set_first: list[set[Source]] = [set() for _ in sides]
        self.choices = _of_enumerations(sides[0].program)
        self.foreign = len({side.program.modules[0].dialect for side in sides}) > 1

    def texts(self, side: int, source: Source) -> tuple[str, ...]:
        """The texts for a source that this side looks at; none when the other side could not be given the same."""
        if source.kind == "variable":
            return self._texts(side, source)  # what a program sets itself shows only as it runs
        key = (side, source)
        if key not in self.found:
            self.found[key] = self._texts(side, source)
        return self.found[key]

    def _texts(self, side: int, source: Source) -> tuple[str, ...]:
        match source:
            case Source("answer" | "seed"):
                return ("",)
            case Source("data"):
                return ()
            case Source("variable", str() as name):
                own = self._own(side, name)
                return (own,) if own else ()
            case Source("bits", (str() as kind, int() as first, int() as last)):
                return tuple(self._signal(side, (kind, number)) for number in range(first, last + 1))
            case Source(_, str() as name):
                usual = usual_key(name) if name not in self.sides[0].kinds else None
                return (name if usual is None else self._signal(side, usual),)
            case Source(_, (str() as kind, int() as number)):
                return (self._signal(side, (kind, number)),)
        return ()

    def _own(self, side: int, name: str) -> str:
        """The first program's name of a kept value that a side looks at; empty where not all keep it: one has none
        such, or sets it itself before it looks at it."""
        for own in self._names(name) if side else (name,):
            names = [_named(each, own) for each in self.sides]
            if names[side].lower() != name.lower() or not all(map(_variable, self.sides, names)):
                continue
            set_first = (self._is_set(number, there) for number, there in enumerate(names) if number != side)
            return "" if self.foreign and any(set_first) else own
        return ""

    def _names(self, name: str) -> Iterator[str]:
        """What the first program may call a kept value of the second one; its arrays may begin elsewhere."""
        yield from (name, *self.sides[-1].kept.get(name.lower(), ()))
        found = _ELEMENT.fullmatch(name)
        if found is not None:
            for own in (found[1], *self.sides[-1].kept.get(found[1].lower(), ())):
                yield from (f"{own}[{int(found[2]) + step}]{found[3]}" for step in (0, 1, -1))

    def means(self, side: int, look: Look) -> bool:
        """Can all sides be given other values for what one looks at? A member of an enumeration where they know it."""
        texts = self.texts(side, look.source)
        if side and look.source.kind == "variable" and not isinstance(look.value, Member) and texts:
            return texts[0].partition("[")[0].lower() not in self.choices  # what a number means there is not known
        if not texts or not isinstance(look.value, Member) or not self.foreign:
            return bool(texts)
        values = (
            next(iter(each.words(Cell(variables={texts[0]: look.value})).variables.values())) for each in self.sides
        )
        return all(
            not isinstance(value, Member) or value in _members(each)
            for value, each in zip(values, self.sides, strict=True)
        )

    def _is_set(self, side: int, name: str) -> bool:
        whole = name.partition("[")[0].lower()
        return any(str(one.key).lower() in (name.lower(), whole) for one in self.set_first[side])

    def _signal(self, side: int, key: tuple[str, int]) -> str:
        """The name that the first program declares for a signal, also for one of the second; else its number."""
        first = self.sides[0].linked
        port = SignalRef(*key)
        for name in self.sides[side].linked.alias_names(port):
            if side == 0 or first.alias(name) is not None:
                return name
        return first.signal_name(self.dialect, *key)

    def same(self, text: str, other: str) -> bool:
        """Do two texts of a cell mean one signal?"""
        alias = self.sides[0].linked.alias
        return bool(keys_named(text, alias(text)) & keys_named(other, alias(other)))


def _members(side: Side) -> set[str]:
    """All members of the enumerations of a program, folded."""
    declared = (one for module in side.program.modules for one in module.declarations)
    return {member.lower() for one in declared if isinstance(one, ir.EnumDeclaration) for member in one.members}


def _of_enumerations(program: ir.Program) -> set[str]:
    """The variables of a program that hold members of its enumerations, folded."""
    declared = [one for module in program.modules for one in module.declarations]
    enumerations = {one.name.lower() for one in declared if isinstance(one, ir.EnumDeclaration)}
    found = set()
    for one in declared:
        if isinstance(one, ir.Variable):
            type = one.type.element if isinstance(one.type, ir.ArrayType) else one.type
            if isinstance(type, ir.NamedType) and type.name.lower() in enumerations:
                found.add(one.name.lower())
    return found


def _named(side: Side, name: str) -> str:
    """A variable of the first program's cell in the words of a side."""
    return next(iter(side.words(Cell(variables={name: 0})).variables))


def _variable(side: Side, name: str) -> bool:
    """Has the program a kept variable of that name that a cell can give?"""
    slot = side.linked.variable_slot(name.partition("[")[0])
    return slot is not None and side.linked.slots[slot].kept


# ---- values


@dataclass(frozen=True, slots=True)
class Constants:
    """What conditions of the programs compare with, in the order of their places; the members of each enumeration.
    `of_statement`: the numbers of one statement's conditions."""

    numbers: tuple[float, ...]
    texts: tuple[str, ...]
    enumerations: tuple[tuple[str, ...], ...] = ()
    of_statement: Mapping[Key, tuple[float, ...]] = field(default_factory=dict)


def constants_of(sides: Sequence[Side]) -> Constants:
    """Numbers and texts in the conditions of all sides."""
    numbers: dict[float, None] = {}
    texts: dict[str, None] = {}
    by_key: dict[Key, dict[float, None]] = {}
    for side in sides:
        for statement, condition in _conditions(side.program):
            own = by_key.setdefault(key_of(statement.origin), {})
            for node in walk(condition):
                match node:
                    case ir.Unary(op="-", operand=ir.IntLiteral(value=value) | ir.RealLiteral(value=value)):
                        own.setdefault(-value)
                    case ir.IntLiteral(value=value) | ir.RealLiteral(value=value):
                        own.setdefault(value)
                    case ir.TextLiteral(value=text):
                        texts.setdefault(text)
            numbers.update(own)
    enumerations = tuple(
        tuple(member.lower() for member in declaration.members)
        for side in sides
        for module in side.program.modules
        for declaration in module.declarations
        if isinstance(declaration, ir.EnumDeclaration)
    )
    of_statement = {key: tuple(own) for key, own in by_key.items()}
    return Constants(tuple(numbers), tuple(texts), enumerations, of_statement)


def _conditions(program: ir.Program) -> Iterator[tuple[ir.Statement, object]]:
    for node in walk(*program.modules):
        match node:
            case ir.If(branches=branches):
                yield from ((node, condition) for condition, _ in branches)
            case ir.Switch(cases=cases):
                yield from ((node, value) for case in cases for value in case.values)
            case ir.While(condition=found) | ir.Repeat(until=found) | ir.WaitUntil(condition=found):
                yield node, found
            case ir.DeclareInterrupt(condition=found):
                yield node, found
            case ir.OrderInterrupt(condition=found) if found is not None:
                yield node, found
            case ir.For(start=start, stop=stop):
                yield from ((node, start), (node, stop))


def values_for(
    source: Source, now: Value, choices: Sequence[int], known: Constants, statement: Key | None = None
) -> list[Value]:
    """Other values that the source may have, the most likely first. `now`: what it has; `choices`: keys of a dialog;
    `statement`: of whose conditions the numbers count, where it has some."""
    if source.kind == "seed":
        return [int(now) + more for more in range(1, _SEEDS + 1)]
    if source.kind == "answer" and choices:
        found: list[Value] = list(choices)
    elif isinstance(now, bool) or source.kind == "digital_in":
        return [not now]
    elif isinstance(now, Member):
        found = [member for members in known.enumerations if now in members for member in members]
    elif isinstance(now, str):
        found = [*known.texts, ""]
    else:
        whole = source.kind in ("bits", "group_in") or isinstance(now, int)
        own = known.of_statement.get(statement, ()) if statement is not None else ()
        found = list(_numbers(own or known.numbers, whole))
        if source.kind == "bits":
            assert isinstance(source.key, tuple) and len(source.key) == 3
            most = 1 << (source.key[2] - source.key[1] + 1)
            found = [value for value in found if 0 <= value < most]
        elif source.kind == "group_in":
            found = [value for value in found if value >= 0]
    return [value for value in dict.fromkeys(found) if value != now][:MOST_VALUES]


def _numbers(compared: Sequence[float], whole: bool) -> Iterator[Value]:
    """The numbers compared with, then those beside them."""
    exact = [number for number in compared if not whole or number == int(number)]
    yield from (int(number) if whole else float(number) for number in exact)
    for number in compared:
        step = 1 if whole else max(_LEAST_PART, abs(number) * _PART)
        for beside in (number + step, number - step):
            yield int(beside) if whole else float(beside)
    yield from (1, 0) if whole else (1.0, 0.0)


# ---- cells


def with_given(cell: Cell, given: Given, time_s: float, names: Names) -> Cell:
    """The cell in which the source has the value from a time (s) on; before that it is as it was. Answers and variables
    are not a matter of time."""
    match given.source:
        case Source("variable"):
            return replace(cell, variables={**cell.variables, given.texts[0]: given.value})
        case Source("seed"):
            return replace(cell, seed=int(given.value))
        case Source("answer", (_, int() as number)):
            return replace(cell, answers=_answers(cell.answers, number, given.value))
    inputs = list(cell.inputs)
    for place, text in enumerate(given.texts):
        value = given.value if len(given.texts) == 1 else bool(int(given.value) >> place & 1)
        inputs = [one for one in inputs if one.time_s < time_s or not names.same(one.signal, text)]
        inputs.append(Input(time_s, text, value))
    inputs.sort(key=lambda one: one.time_s)
    reactions = tuple(one for one in cell.reactions if not any(names.same(one.signal, text) for text in given.texts))
    return replace(cell, inputs=tuple(inputs), reactions=reactions)


def _answers(answers: tuple[Answer, ...], number: int, value: Value) -> tuple[Answer, ...]:
    """The answers with another one for the dialog of that number in the run (from 0)."""
    matched = tuple(one for one in answers if one.text is not None)
    plain = [one for one in answers if one.text is None]
    if matched:
        return (Answer(value, text=re.compile("")), *answers)
    if number < len(plain):
        plain[number] = Answer(value, plain[number].after_s)
    else:
        plain += [Answer(value)] * (number + 1 - len(plain))
    return tuple(plain)


__all__ = ["Constants", "Given", "Names", "constants_of", "values_for", "with_given"]

"""A quick look over all texts of a project before reading: what its programs are called, and which whole numbers a name
can stand for. SIGNAL and SIG need that: the size of a number tells which kind of signal it is.
"""

from __future__ import annotations

import re
from collections.abc import Iterable

from . import tables
from .events import tasks_of
from .expressions import Facts, significant

_PROGRAM = re.compile(r"^[ \t]*\.PROGRAM[ \t]+([A-Za-z_][\w.]*)", re.IGNORECASE | re.MULTILINE)
_ASSIGNED = re.compile(
    r"^[ \t]*(?:\d+[ \t]+)?([A-Za-z_][\w.]*)[ \t]*(?:\[[^\]\r\n]*\])?[ \t]*=(?!=)[ \t]*([^;\r\n]*)",
    re.IGNORECASE | re.MULTILINE,
)
_COUNTED = re.compile(
    r"^[ \t]*FOR[ \t]+([A-Za-z_][\w.]*)[ \t]*=([^;\r\n]*?)\bTO\b([^;\r\n]*)", re.IGNORECASE | re.MULTILINE
)
_STEP = re.compile(r"\bSTEP\b", re.IGNORECASE)
_HEADER = re.compile(r"^[ \t]*\.PROGRAM[ \t]+([\w.]+)[ \t]*\(([^)\r\n]*)\)", re.IGNORECASE | re.MULTILINE)
_CALLED = re.compile(
    r"^[ \t]*(?:\d+[ \t]+)?(?:CALL|EXECUTE(?:[ \t]+/C)?(?:[ \t]+[\w.]+)??)[ \t]+([A-Za-z_][\w.]*)[ \t]*"
    r"\(([^;\r\n]*)\)",
    re.IGNORECASE | re.MULTILINE,
)
_TAKEN = re.compile(r"^[ \t]*(?:\d+[ \t]+)?(?:CALLS|READ|PROMPT|ATTACH)\b([^;\r\n]*)", re.IGNORECASE | re.MULTILINE)
_STORED = re.compile(r"^[ \t]*([A-Za-z_][\w.]*)(?:\[[\d, \t]*\])?[ \t]+(\d+)[ \t]*$", re.MULTILINE)
_NAME = re.compile(r"[A-Za-z_][\w.]*")
_EXECUTED = re.compile(
    r"^[ \t]*(?:\d+[ \t]+)?EXECUTE[ \t]+(?:/C[ \t]+)?(\d+|[A-Za-z_][\w.]*)[ \t]+([A-Za-z_][\w.]*)"
    r"(?:[ \t]*\([^;\r\n]*\))?(?:[ \t]*,[ \t]*(-?\d+))?",
    re.IGNORECASE | re.MULTILINE,
)
_JOINS = re.compile(
    r"^[ \t]*(?:\d+[ \t]+)?(?:CPON|CPOFF)\b|^[ \t]*(?:\d+[ \t]+)?(?:ENABLE|DISABLE|SWITCH)\b[^;\r\n]*\bCP\b",
    re.IGNORECASE | re.MULTILINE,
)
_LOCKS = re.compile(r"^[ \t]*(?:\d+[ \t]+)?(?:LOCK|REACT[IE]?)\b", re.IGNORECASE | re.MULTILINE)
_SWITCHED = re.compile(r"^[ \t]*(?:\d+[ \t]+)?(ENABLE|DISABLE|SWITCH)[ \t]+([^;\r\n]*)", re.IGNORECASE | re.MULTILINE)
_HAND_TIME = re.compile(r"^[ \t]*(?:\d+[ \t]+)?PARAMETER[ \t]+HAND\.TIME[ \t]*=[ \t]*([^;\r\n]*)", re.I | re.MULTILINE)
_TERM = re.compile(
    r"[ \t]*([+-]?)[ \t]*(?:(\d{1,8})(?:[ \t]*\*[ \t]*([A-Za-z_][\w.]*))?|([A-Za-z_][\w.]*))[ \t]*(?=[+-]|$)"
)
_MOST_VALUES = 64  # of a name; one with more can be anything
_ROUNDS = 40  # a name whose values still grow then counts without end
_PLAIN_NUMBER = re.compile(r"\d+\.?\d*|\.\d+")


def facts_of(texts: Iterable[str]) -> Facts:
    """Programs, names that only ever stand for whole numbers, programs executed in each task."""
    kept = list(texts)
    programs: set[str] = set()
    executed: dict[str, set[str]] = {}
    bases: dict[str, set[str]] = {}
    cycles: dict[str, int] = {}
    joins = locks = False
    hand: set[str] = set()
    switches: set[tuple[str, str]] = set()
    for text in kept:
        hand.update(value.strip() for value in _HAND_TIME.findall(text))
        programs.update(significant(name) for name in _PROGRAM.findall(text))
        for task, program, times in _EXECUTED.findall(text):
            name = program
            bases.setdefault(task.lower(), set()).add(program)
            if times not in ("", "1"):
                name = round_of(program, int(times))
                cycles[significant(name)] = int(times)
            executed.setdefault(task.lower(), set()).add(name)
        locks = locks or _LOCKS.search(text) is not None
        for word, inner in _SWITCHED.findall(text):
            switches.update((word.lower(), name.lower()) for name in _NAME.findall(inner))
        joins = joins or _JOINS.search(text) is not None
    tasks = {task: frozenset(names) for task, names in executed.items()}
    return Facts(
        frozenset(programs),
        _Numbers().of(kept),
        tasks,
        joins,
        _hand_time(hand),
        locks,
        frozenset(name for word, name in switches if word != "enable"),
        _upper({word for word, name in switches if name == "upper"}),
        tasks_of(kept, bases),
        cycles,
    )


def round_of(program: str, cycles: int) -> str:
    """The name of the program that executes another one several times."""
    mark = f".x{cycles}" if cycles > 0 else ".x"
    return program[: tables.NAME_LENGTH - len(mark)] + mark


def _upper(words: set[str]) -> bool | None:
    """Whether texts are compared without looking at capitals, where the project always says the same."""
    return None if len(words) != 1 or "switch" in words else "enable" in words


def _hand_time(values: set[str]) -> float | None:
    """Seconds that OPENI and the like wait, where the project sets it to one number; None: nobody can say."""
    if not values:
        return tables.HAND_TIME_S
    numbers = {float(value) if _PLAIN_NUMBER.fullmatch(value) else None for value in values}
    return numbers.pop() if len(numbers) == 1 else None


Sum = tuple[tuple[int, str | None], ...]  # factors and names (None: of one)


def sum_of(text: str) -> Sum | None:
    """The terms of a sum of whole numbers and names, such as 101+10*n; None where it is something else."""
    terms: list[tuple[int, str | None]] = []
    at = 0
    while at < len(text):
        found = _TERM.match(text, at)
        if found is None or (terms and not found[1]):
            return None
        sign = -1 if found[1] == "-" else 1
        name = found[3] or found[4]
        terms.append((sign * int(found[2] or 1), significant(name) if name else None))
        at = found.end()
    return tuple(terms) or None


class _Numbers:
    """Whole numbers by name, whatever program the name belongs to. None: it can be anything."""

    def __init__(self) -> None:
        self.known: dict[str, set[int] | None] = {}
        self.links: set[tuple[str, str]] = set()
        self.sums: list[tuple[str, Sum]] = []

    def of(self, texts: list[str]) -> dict[str, frozenset[int]]:
        headers = {
            significant(name): [_plain(parameter) for parameter in inner.split(",")]
            for text in texts
            for name, inner in _HEADER.findall(text)
        }
        for text in texts:
            for name, value in (*_ASSIGNED.findall(text), *_STORED.findall(text)):
                self.gets(significant(name), value.strip())
            for name, first, last in _COUNTED.findall(text):
                self.gets(significant(name), first.strip())
                self.gets(significant(name), _STEP.split(last)[0].strip())
            for inner in _TAKEN.findall(text):
                for name in _NAME.findall(inner):
                    self.known[significant(name)] = None
            for name, inner in _CALLED.findall(text):
                self.called(headers.get(significant(name), []), _split(inner))
        self.connect()
        return {name: frozenset(values) for name, values in self.known.items() if values}

    def gets(self, name: str, value: str) -> None:
        known = self.known.setdefault(name, set())
        if known is None:
            return
        if value.removeprefix("-").isdigit() and len(value) < 9:
            known.add(int(value))
        elif (terms := sum_of(value)) is not None:
            self.sums.append((name, terms))
        else:
            self.known[name] = None

    def called(self, parameters: list[str], arguments: list[str]) -> None:
        """An argument is what the parameter is; a variable and its parameter are the same."""
        for position, argument in enumerate(arguments):
            parameter = parameters[position] if position < len(parameters) else ""
            if _NAME.fullmatch(argument):
                if parameter:
                    self.links.add((significant(argument), significant(parameter)))
                else:
                    self.known[significant(argument)] = None
            elif parameter and argument:
                self.gets(significant(parameter), argument)

    def connect(self) -> None:
        changed, rounds = True, 0
        while changed:
            changed = False
            for one, other in self.links:
                first, second = self.known.setdefault(one, set()), self.known.setdefault(other, set())
                both = None if first is None or second is None else first | second
                if (first, second) != (both, both):
                    self.known[one], self.known[other] = both, None if both is None else set(both)
                    changed = True
            rounds += 1
            for name, terms in self.sums:
                before = self.known.get(name)
                if before is None:
                    continue
                added = self.values(terms)
                now = None if added is None else before | added
                if now != before:
                    ends = now is not None and len(now) <= _MOST_VALUES and rounds < _ROUNDS
                    self.known[name] = now if ends else None
                    changed = True

    def values(self, terms: Sum) -> set[int] | None:
        """What a sum can be, from what is known of its names so far; None: anything."""
        found = {0}
        for factor, name in terms:
            some = {1} if name is None else self.known.get(name)
            if some is None or len(some) * len(found) > _MOST_VALUES**2:
                return None
            found = {whole + factor * one for whole in found for one in some}
        return found


def _plain(parameter: str) -> str:
    return parameter.partition("[")[0].strip()


def _split(arguments: str) -> list[str]:
    """The arguments of a call, commas inside of brackets and texts left alone."""
    parts, depth, quoted, start = [], 0, False, 0
    for at, sign in enumerate(arguments):
        if sign == '"':
            quoted = not quoted
        elif quoted:
            continue
        elif sign in "([":
            depth += 1
        elif sign in ")]":
            depth -= 1
        elif sign == "," and depth == 0:
            parts.append(arguments[start:at].strip())
            start = at + 1
    return [*parts, arguments[start:].strip()]


__all__ = ["facts_of", "round_of"]

"""Which declarations of two versions of a module or routine differ: points, frames, tools and other data by value."""

from __future__ import annotations

import re
from collections import defaultdict
from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field

from rpl import ir
from rpl.comparing.changes import ADDED, CHANGED, REMOVED, Change, Moved, Spot
from rpl.comparing.statements import taught_kind
from rpl.comparing.values import known, value_change
from rpl.passes.scope import Scope
from rpl.passes.values import Record, Target
from rpl.source import Origin, Source

_TOKEN = re.compile(r"\d+\.?\d*(?:[eE][-+]?\d+)?|\.\d+(?:[eE][-+]?\d+)?|\w+|\"[^\"]*\"|\S")

Span = tuple[Source | None, int, int]


def spot(origin: Origin) -> Spot | None:
    """Where it stands, with the text; None where it stands nowhere."""
    return spot_of((origin.source, origin.start, origin.end))


def spot_of(span: Span) -> Spot | None:
    source, start, end = span
    if source is None:
        return None
    text = source.text[start:end]
    first = source.position(start)[0]
    return Spot(source.path, first, source.position(max(start, end - 1))[0], " ".join(text.split()))


@dataclass(frozen=True, slots=True)
class Side:
    """One version: what its names mean, and the places of its statements, which declare data by the way."""

    scope: Scope
    statements: frozenset[tuple[int, int]] = frozenset()  # identity of the source, offset


@dataclass(slots=True)
class Declared:
    """What was found. `same`: places that are written otherwise and say the same."""

    module: str
    routine: str
    changes: list[Change] = field(default_factory=list)
    same: list[tuple[Origin, Origin]] = field(default_factory=list)
    by_use: set[int] = field(default_factory=set)  # identities of new declarations that a statement makes by the way

    def compare(self, old: Iterable[ir.Declaration], new: Iterable[ir.Declaration], before: Side, after: Side) -> None:
        here, there = _by_key(old, before.scope), _by_key(new, after.scope)
        for key in dict.fromkeys((*here, *there)):
            a, b = here.get(key, []), there.get(key, [])
            self.by_use |= {id(one) for one in b if not _own(one, after)}
            for one, other in zip(a, b, strict=False):
                self.pair(one, other, before.scope, after.scope)
            self.changes += [self.alone(REMOVED, one, before) for one in a[len(b) :] if _own(one, before)]
            self.changes += [self.alone(ADDED, one, after) for one in b[len(a) :] if _own(one, after)]

    def alone(self, what: str, one: ir.Declaration, side: Side) -> Change:
        places = (spot(one.origin), None) if what == REMOVED else (None, spot(one.origin))
        name = _name(one) or " ".join(one.origin.text.split())[:60]
        return Change(_kind(one, side.scope), what, name, self.module, self.routine, *places)

    def pair(self, old: ir.Declaration, new: ir.Declaration, before: Scope, after: Scope) -> None:
        a, b = old.origin, new.origin
        if a.source is not None and b.source is not None and a.text == b.text and a.text and old == new:
            return
        if isinstance(old, ir.Variable) and isinstance(new, ir.Variable):
            if old.type == new.type and old.storage == new.storage:
                self.values(old, new, before, after)
                return
        elif old == new:
            self.written_otherwise(old, new, after)
            return
        kind = _kind(new, after)
        words = _declared_otherwise(old, new)
        self.changes.append(Change(kind, CHANGED, _name(new), self.module, self.routine, spot(a), spot(b), words))

    def written_otherwise(self, old: ir.Declaration, new: ir.Declaration, scope: Scope) -> None:
        """Both mean the same to us: what differs in the text is told, unless it is numbers, blanks or capitals."""
        if id(new) in self.by_use:
            return
        words = other_words(old.origin.text, new.origin.text, not scope.rules.case_sensitive)
        if not words:
            if old.origin.text != new.origin.text:
                self.same.append((old.origin, new.origin))
            return
        places = spot(old.origin), spot(new.origin)
        self.changes.append(Change(_kind(new, scope), CHANGED, _name(new), self.module, self.routine, *places, words))

    def values(self, old: ir.Variable, new: ir.Variable, before: Scope, after: Scope) -> None:
        if old.initial == new.initial:
            self.written_otherwise(old, new, after)
            return
        kind, places = _kind(new, after), (spot(old.origin), spot(new.origin))
        told = False
        for name, one, other in _elements(new.name, old.initial, new.initial, after.resolve(new.type)):
            words, moved = _told(one, other, before, after) or ((), None)
            if words is not None and (words or one is None or other is None):
                what = ADDED if one is None else REMOVED if other is None else CHANGED
                self.changes.append(Change(kind, what, name, self.module, self.routine, *places, words, moved))
                told = True
        if not told:
            self.written_otherwise(old, new, after)


def _told(
    old: ir.Expression | None, new: ir.Expression | None, before: Scope, after: Scope
) -> tuple[tuple[str, ...], Moved | None] | None:
    """What has changed in a value, in words; None when both are the same number or place."""
    if old is None or new is None:
        return (), None
    one, other = known(old, before), known(new, after)
    if one is None or other is None:
        return ("its value",), None
    return value_change(one, other)


def _elements(
    name: str, old: ir.Expression | None, new: ir.Expression | None, type: ir.Type
) -> Iterator[tuple[str, ir.Expression | None, ir.Expression | None]]:
    """Values that differ; in a list of as many elements each for itself."""
    if (
        isinstance(type, ir.ArrayType)
        and isinstance(old, ir.Aggregate)
        and isinstance(new, ir.Aggregate)
        and len(old.entries) == len(new.entries)
    ):
        rest = type.dimensions[1:]
        inner = ir.ArrayType(type.element, rest, type.base) if rest else type.element
        for at, ((_, one), (_, other)) in enumerate(zip(old.entries, new.entries, strict=True), type.base):
            if one != other:
                yield from _elements(f"{name}[{at}]", one, other, inner)
        return
    yield name, old, new


def other_words(old: str, new: str, fold: bool) -> tuple[str, ...]:
    """The first words that differ in two texts, beyond the spelling of numbers, blanks and (`fold`) capitals."""
    one, other = list(_tokens(old, fold)), list(_tokens(new, fold))
    if one == other:
        return ()
    at = next((at for at, (a, b) in enumerate(zip(one, other, strict=False)) if a != b), min(len(one), len(other)))
    a = " ".join(str(token) for token in one[max(0, at - 2) : at + 1]) or "nothing"
    b = " ".join(str(token) for token in other[max(0, at - 2) : at + 1]) or "nothing"
    return (f"{a} → {b}",)


def _tokens(text: str, fold: bool) -> Iterator[str | float]:
    for token in _TOKEN.findall(text):
        if token[0] in ".0123456789" and token != ".":
            try:
                yield float(token)
                continue
            except ValueError:
                pass
        yield token.lower() if fold and token[0] != '"' else token


def _name(one: ir.Declaration) -> str:
    match one:
        case ir.Initialise(assign=assign):
            return " ".join(one.origin.text.partition("=")[0].split()) or _target(assign.target)
        case ir.Unread():
            return ""
    return one.name


def _target(expression: ir.Expression) -> str:
    return expression.id if isinstance(expression, ir.Name) else "data"


def _key(one: ir.Declaration, scope: Scope) -> str:
    if isinstance(one, ir.Unread):
        return "unread " + " ".join(one.text.split())
    if isinstance(one, ir.Initialise):
        return f"= {scope.fold(_name(one))}"
    return scope.fold(one.name)


def _by_key(declarations: Iterable[ir.Declaration], scope: Scope) -> dict[str, list[ir.Declaration]]:
    found: dict[str, list[ir.Declaration]] = defaultdict(list)
    for one in declarations:
        if isinstance(one, ir.VariableRows):
            for variable in one.variables():
                found[_key(variable, scope)].append(variable)
        elif not isinstance(one, ir.Unread) or one.text.strip():
            found[_key(one, scope)].append(one)
    return found


def _own(one: ir.Declaration, side: Side) -> bool:
    """Does it stand in the text as a declaration? What a use declares by the way is told with the statement."""
    source = one.origin.source
    return source is not None and (id(source), one.origin.start) not in side.statements


def _kind(one: ir.Declaration, scope: Scope) -> str:
    match one:
        case ir.Variable(type=type):
            return taught_kind(type, scope)
        case ir.SignalDeclaration():
            return "io"
        case ir.Initialise(assign=ir.Assign(value=value)):
            at = known(value, scope)
            place = isinstance(at, Target) or (isinstance(at, Record) and isinstance(at.type, ir.JointsType))
            return "point" if place else "data"
    return "data"


def _declared_otherwise(old: ir.Declaration, new: ir.Declaration) -> tuple[str, ...]:
    match old, new:
        case ir.Variable(), ir.Variable():
            words = ["its type"] if old.type != new.type else []
            words += [f"{old.storage} → {new.storage}"] if old.storage != new.storage else []
            words += ["its value"] if old.initial != new.initial else []
            return tuple(words)
        case ir.Initialise(), ir.Initialise():
            return ("its value",)
    return ()

"""Two read projects compared: modules, routines and data by their names, statements in their order.

Texts align both versions, nodes decide whether what is written otherwise says otherwise. In the end each place where
the files differ must be accounted for: a line that no change tells is reported as it stands, so that nothing goes
unseen.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, field, replace
from typing import TypeVar

from rpl import ir, registry
from rpl.comparing.changes import ADDED, CHANGED, KINDS, REMOVED, Change, Differences, Spot
from rpl.comparing.data import Declared, Side, spot, spot_of
from rpl.comparing.files import paired_sources, unaccounted
from rpl.comparing.listing import Listing, listing, remarks
from rpl.comparing.routines import comments, compared
from rpl.comparing.statements import goals
from rpl.depth import at_any_depth
from rpl.passes.collector import paused_cycle_collector
from rpl.passes.scope import ProgramScope
from rpl.project import ReadProgram
from rpl.source import Origin, Source
from rpl.trivia import Trivia

_Named = TypeVar("_Named", ir.Module, ir.Routine)


def differences(a: ReadProgram, b: ReadProgram) -> Differences:
    """What has changed from project `a` to project `b`, both in one language. Files of no meaning in common (another
    language on the other side) are told as added and removed."""
    with paused_cycle_collector():
        return at_any_depth(lambda: _Comparing(a, b).all())


@dataclass(slots=True)
class _Comparing:
    """One comparison under way. `same`: places, on both sides, that are written otherwise and say the same."""

    a: ReadProgram
    b: ReadProgram
    changes: list[Change] = field(default_factory=list)
    same: list[tuple[Spot | None, Spot | None]] = field(default_factory=list)
    scopes: tuple[ProgramScope, ProgramScope] = field(init=False)
    lists: dict[int, Listing] = field(default_factory=dict)  # of all routines, by identity
    statements: tuple[frozenset[tuple[int, int]], frozenset[tuple[int, int]]] = field(init=False)

    def __post_init__(self) -> None:
        self.scopes = ProgramScope(self.a.reduced), ProgramScope(self.b.reduced)
        self.statements = self.listed(self.a.reduced), self.listed(self.b.reduced)

    def listed(self, program: ir.Program) -> frozenset[tuple[int, int]]:
        """Where the statements of a program stand; its routines are listed on the way."""
        lists = []
        for module in program.modules:
            trivia = registry.dialect(module.dialect).trivia
            lists += [self.lists.setdefault(id(one), listing(one, trivia)) for one in module.routines]
        return _statements(lists)

    def all(self) -> Differences:
        pairs, removed, added = paired(self.a.reduced.modules, self.b.reduced.modules, _module_key)
        files = paired_sources(self.a.sources, self.b.sources, [_homes(one, other) for one, other in pairs])
        for one, other in pairs:
            self.modules(one, other)
        whole = [*(one for one, other in files if other is None), *(other for one, other in files if one is None)]
        told = {one.path for one in whole if one is not None}
        for source in whole:
            if source is not None:
                self.alone_file(source, any(source is one for one in self.a.sources))
        for what, modules in ((REMOVED, removed), (ADDED, added)):
            for module in modules:
                if module.origin.source is not None and module.origin.file not in told:
                    self.alone("file", what, module.name, "", module.origin)
        self.rest([(one, other) for one, other in files if one is not None and other is not None])
        self.points()
        order = {kind: at for at, kind in enumerate(KINDS)}
        changes = tuple(dict.fromkeys(sorted(self.changes, key=lambda one: order[one.kind])))
        return Differences(changes, len(self.same), tuple(dict.fromkeys((*self.a.dialects, *self.b.dialects))))

    def points(self) -> None:
        """A place without a configuration that moves go to is a point and no frame."""
        if any(one.kind == "frame" and one.name for one in self.changes):
            names = goals(self.a.reduced, self.b.reduced)
            self.changes = [
                replace(one, kind="point")
                if one.kind == "frame" and one.name.partition("[")[0].lower() in names
                else one
                for one in self.changes
            ]

    def alone_file(self, source: Source, old: bool) -> None:
        place = Spot(source.path, 1, max(1, len(source.line_starts())), "")
        a, b = (place, None) if old else (None, place)
        self.changes.append(Change("file", REMOVED if old else ADDED, source.path, "", "", a, b))

    def alone(self, kind: str, what: str, name: str, module: str, origin: Origin) -> None:
        a, b = (spot(origin), None) if what == REMOVED else (None, spot(origin))
        self.changes.append(Change(kind, what, name, module, "", a, b))

    # ---- modules

    def modules(self, old: ir.Module, new: ir.Module) -> None:
        trivia = registry.dialect(new.dialect).trivia
        self.attributes(old, new, trivia)
        self.changes += comments(remarks(old), remarks(new), (new.name, ""))
        pairs, removed, added = paired(old.routines, new.routines, lambda one: one.name.lower())
        before = Side(self.scopes[0].module(old), self.statements[0])
        after = Side(self.scopes[1].module(new), self.statements[1])
        declared = Declared(new.name, "")
        declared.compare(old.declarations, new.declarations, before, after)
        self.take(declared)
        for one, other in pairs:
            self.routines(old, one, new, other)
        for what, routines in ((REMOVED, removed), (ADDED, added)):
            for routine in routines:
                self.alone_routine(what, routine, new.name, self.lists[id(routine)])

    def attributes(self, old: ir.Module, new: ir.Module, trivia: Trivia) -> None:
        here, there = dict(old.attributes), dict(new.attributes)
        for name in dict.fromkeys((*here, *there)):
            a, b = here.get(name), there.get(name)
            word = name.upper().rpartition(" ")[2]  # a data list has attributes of its own: `dat ACCESS`
            if a == b or word in trivia.attributes:
                continue
            kind = "comment" if word in trivia.remarks else "header"
            what = ADDED if a is None else REMOVED if b is None else CHANGED
            words = (" → ".join(f'"{one.strip()}"' for one in (a, b) if one is not None),)
            places = _attribute_spot(old, name), _attribute_spot(new, name)
            self.changes.append(Change(kind, what, name, new.name, "", *places, words))

    def alone_routine(self, what: str, routine: ir.Routine, module: str, units: Listing) -> None:
        last = max((one.end for one in units.units if one.source is routine.origin.source), default=0)
        place = spot_of((routine.origin.source, routine.origin.start, max(last, routine.origin.end)))
        if place is not None:
            place = Spot(place.file, place.line, place.last, " ".join(routine.origin.text.split())[:120])
        a, b = (place, None) if what == REMOVED else (None, place)
        count = sum(not one.mark for one in units.units)
        words = (f"{count} statement{'' if count == 1 else 's'}",)
        self.changes.append(Change("routine", what, routine.name, module, routine.name, a, b, words))

    def routines(self, module: ir.Module, one: ir.Routine, home: ir.Module, other: ir.Routine) -> None:
        here, there = self.lists[id(one)], self.lists[id(other)]
        scopes = self.scopes[0].routine(module, one), self.scopes[1].routine(home, other)
        if _signature(one) != _signature(other):
            places = spot(one.origin), spot(other.origin)
            self.changes.append(Change("logic", CHANGED, "", home.name, other.name, *places, ("how it is called",)))
        declared = Declared(home.name, other.name)
        declared.compare(
            one.declarations,
            other.declarations,
            Side(scopes[0], self.statements[0]),
            Side(scopes[1], self.statements[1]),
        )
        self.take(declared)
        changes, same = compared(here, there, scopes, (home.name, other.name))
        self.changes += changes
        self.same += same

    def take(self, declared: Declared) -> None:
        self.changes += declared.changes
        self.same += [(spot(one), spot(other)) for one, other in declared.same]

    # ---- what nobody has told

    def rest(self, pairs: Sequence[tuple[Source, Source]]) -> None:
        languages = {report.path: report.dialect for report in (*self.a.files, *self.b.files)}
        seen: dict[str, list[tuple[int, int]]] = defaultdict(list)
        for change in self.changes:
            for place in (change.a, change.b):
                if place is not None:
                    seen[place.file].append((place.line, place.last))
        for same in self.same:
            for place in same:
                if place is not None:
                    seen[place.file].append((place.line, place.last))
        for one, other in pairs:
            language = languages.get(other.path) or languages.get(one.path)
            dialect = registry.dialect(language) if language is not None else None
            changes, alike = unaccounted(one, other, dialect, seen)
            self.changes += changes
            self.same += alike


def paired(
    old: Sequence[_Named], new: Sequence[_Named], key: Callable[[_Named], object]
) -> tuple[list[tuple[_Named, _Named]], list[_Named], list[_Named]]:
    """Those of one key on both sides, in the order of the new ones; then those that one side alone has. A single one
    that is left on each side is the same under another name."""
    there: dict[object, list[_Named]] = defaultdict(list)
    for one in old:
        there[key(one)].append(one)
    pairs, added = [], []
    for one in new:
        if there[key(one)]:
            pairs.append((there[key(one)].pop(0), one))
        else:
            added.append(one)
    removed = [one for some in there.values() for one in some]
    if len(old) == len(new) == len(added) == 1:
        return [(removed[0], added[0])], [], []
    return pairs, removed, added


def _module_key(module: ir.Module) -> object:
    return module.dialect, module.task.lower(), module.name.lower()


def _homes(old: ir.Module, new: ir.Module) -> tuple[Source | None, Source | None]:
    return old.origin.source, new.origin.source


def _signature(routine: ir.Routine) -> object:
    fold = tuple((one.name.lower(), one.type, one.mode, one.optional, one.switch) for one in routine.parameters)
    return routine.kind, fold, routine.returns, routine.scope


def _statements(lists: Iterable[Listing]) -> frozenset[tuple[int, int]]:
    return frozenset((id(unit.source), unit.start) for one in lists for unit in one.units if unit.run is None)


def _attribute_spot(module: ir.Module, name: str) -> Spot | None:
    """The line of the file that has the attribute."""
    source = module.origin.source
    if source is None:
        return None
    trivia = registry.dialect(module.dialect).trivia
    if trivia.header is None:
        return None
    for number, line in enumerate(source.text.splitlines(), 1):
        found = trivia.header.match(line)
        if found is not None and found[1].upper() == name.upper():
            return Spot(source.path, number, number, line.strip())
    return None

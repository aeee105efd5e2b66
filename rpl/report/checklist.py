"""What has to be done at the cell before a translation runs, in the order in which a cell is brought up.

Everything is taken from the programs: declarations and settings of the source with the lines that came of them, signals
under both names, data that got a number, and the reports that stand at moves.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from itertools import groupby
from pathlib import PurePath

from rpl import ir
from rpl.diagnostics import Diagnostic, Severity
from rpl.grouping import sentences
from rpl.ir.walk import statements, walk
from rpl.passes.legalise.facts.effects import children
from rpl.project import ReadProgram
from rpl.source import Origin
from rpl.translation import Translation

_FRAMES = (ir.ToolType, ir.WorkObjectType, ir.PoseType)
_POINTS = (ir.TargetType, ir.JointsType)
_FRAME_SETTINGS, _LOAD_SETTINGS = ("tool", "base"), ("load",)
_POSE = frozenset("xyzabc")
_MOST_LINES = 4

# File and line of the source -> the lines of the output that come from it.
Written = Mapping[tuple[str, int], Sequence[str]]


@dataclass(frozen=True, slots=True)
class Item:
    """One thing to do. `detail`: what the programs have about it, a line each."""

    text: str
    place: str = ""
    detail: tuple[str, ...] = ()


@dataclass(frozen=True, slots=True)
class Section:
    """One step of bringing a cell up."""

    title: str
    about: str
    items: tuple[Item, ...]


def checklist(
    read: ReadProgram, translation: Translation, reports: Iterable[Diagnostic], written: Written
) -> tuple[Section, ...]:
    """The steps that have something in them."""
    programs = _Programs(read, translation, written)
    sections = (
        Section("Frames and tools", "Enter or measure them, then compare the values.", tuple(programs.frames())),
        Section("Payloads", "Enter them, and identify them where the controller can.", tuple(programs.loads())),
        Section("Signals", "Wire or map each under its name in the result, then try it.", tuple(programs.signals())),
        Section(
            "Data with numbers and retained values",
            "The numbers must be free; set what the source's controller kept.",
            tuple(programs.retained()),
        ),
        Section("Points to touch up", "Go there slowly with the right tool and frame.", tuple(programs.points())),
        Section("Places to check", "Each with the reason; the worst first.", tuple(programs.to_check(reports))),
    )
    return tuple(section for section in sections if section.items)


class _Programs:
    """Source and result."""

    def __init__(self, read: ReadProgram, translation: Translation, written: Written) -> None:
        self.read, self.translation, self.written = read, translation, written
        self.paths = {source.path for source in read.sources}
        self.numbers = {name.lower(): f"{bank}[{number}]" for (bank, number), name in translation.registers.items()}
        self.declared = [
            one
            for module in read.reduced.modules
            for one in (*module.declarations, *(each for routine in module.routines for each in routine.declarations))
            if isinstance(one, ir.Variable) and one.origin.file in self.paths
        ]

    def frames(self) -> Iterator[Item]:
        yield from (self._datum(one) for one in self.declared if isinstance(one.type, _FRAMES))
        yield from self._initialised(_is_pose)
        yield from self._settings(_FRAME_SETTINGS)

    def loads(self) -> Iterator[Item]:
        yield from (self._datum(one) for one in self.declared if isinstance(one.type, ir.LoadType))
        yield from self._initialised(_is_load)
        yield from self._settings(_LOAD_SETTINGS)

    def points(self) -> Iterator[Item]:
        yield from (
            self._datum(one) for one in self.declared if isinstance(one.type, _POINTS) and one.storage != "variable"
        )

    def retained(self) -> Iterator[Item]:
        numbered = [
            (name, f"{bank}[{number}]")
            for (bank, number), name in sorted(self.translation.registers.items())
            if bank not in ir.SIGNAL_KINDS
        ]
        known = {name.lower() for name, _ in numbered}
        yield from _elements(numbered)
        for one in self.declared:
            kept = one.storage == "persistent" and not isinstance(one.type, (*_FRAMES, *_POINTS, ir.LoadType))
            if kept and one.name.lower() not in known:
                yield self._datum(one)

    def signals(self) -> Iterator[Item]:
        """Signals of the source with the names that the same statements of the result have for them."""
        own, other = _Signals(self.read.reduced), _Signals(self.translation.program)
        theirs: dict[tuple[str, int], dict[ir.Signal, None]] = {}
        for statement in statements(self.translation.written):
            theirs.setdefault((statement.origin.file, statement.origin.start), {}).update(other.of(statement))
        found: dict[str, dict[str, None]] = {}
        for statement in statements(self.read.reduced):
            here = own.of(statement)
            there = list(theirs.get((statement.origin.file, statement.origin.start), ()))
            for signal in here:
                names = found.setdefault(own.name(signal), {})
                if len(here) == len(there) == 1:
                    names[other.name(there[0])] = None
                else:  # which is which: those that are alike
                    names.update(
                        (other.name(one), None) for one in there if one == signal or one.name == own.called(signal)
                    )
        for name, names in sorted(found.items()):
            yield Item(f"{name} is {', '.join(names) if names else 'under no name that is known: see its statements'}")

    def to_check(self, reports: Iterable[Diagnostic]) -> Iterator[Item]:
        """Errors, stops and warnings by their places."""
        places: dict[tuple[str, int], list[Diagnostic]] = {}
        for item in sorted(reports, key=lambda one: -one.severity):
            if item.severity >= Severity.WARNING:
                places.setdefault((item.origin.file, item.origin.line), []).append(item)
        for items in places.values():
            origin = items[0].origin
            text = _first_line(origin) if origin.source else "The program as a whole"
            yield Item(text, self._place(origin), tuple(f"{kind.word}: {said}" for kind, said in sentences(items)))

    def _datum(self, one: ir.Variable) -> Item:
        number = self.numbers.get(one.name.lower())
        text = f"{one.name} is {number}" if number else one.name
        return Item(text, self._place(one.origin), self._lines(one.origin))

    def _initialised(self, wanted: Callable[[ir.Assign], bool]) -> Iterator[Item]:
        """Elements of lists that a data file fills in."""
        for module in self.read.reduced.modules:
            for one in module.declarations:
                if isinstance(one, ir.Initialise) and one.origin.file in self.paths and wanted(one.assign):
                    yield Item(_first_line(one.origin), self._place(one.origin), self._lines(one.origin))

    def _settings(self, names: Sequence[str]) -> Iterator[Item]:
        """Where the source says itself which tool, frame or load holds; each text once."""
        seen = set()
        for statement in statements(self.read.reduced):
            match statement:
                case ir.Assign(target=ir.System(name=name)) if name in names:
                    text = _first_line(statement.origin)
                    if statement.origin.file in self.paths and text not in seen:
                        seen.add(text)
                        yield Item(text, self._place(statement.origin), self._lines(statement.origin))

    def _lines(self, origin: Origin) -> tuple[str, ...]:
        return tuple(self.written.get((origin.file, origin.line), ())[:_MOST_LINES])

    def _place(self, origin: Origin) -> str:
        return f"{PurePath(origin.file).name}:{origin.line}" if origin.source else ""


class _Signals:
    """The signals of a program, and how people call them."""

    def __init__(self, program: ir.Program) -> None:
        declared = [
            one for module in program.modules for one in module.declarations if isinstance(one, ir.SignalDeclaration)
        ]
        self.named = {one.signal: one.name for one in declared}
        self.by_name = {one.name.lower(): one.signal for one in declared}

    def of(self, statement: ir.Statement) -> dict[ir.Signal, None]:
        """Those that the statement itself has, in order; not those in its blocks."""
        found: dict[ir.Signal, None] = {}
        for part in walk(*children(statement)):
            if isinstance(part, ir.Signal):
                found[part] = None
            elif isinstance(part, ir.Name) and part.id.lower() in self.by_name:
                found[self.by_name[part.id.lower()]] = None
        return found

    def name(self, signal: ir.Signal) -> str:
        """Kind and number with the name that the program declares for it, or its own."""
        numbers = [one for one in (signal.index, signal.last) if one is not None]
        number = " to ".join(str(one.value) if isinstance(one, ir.IntLiteral) else "(computed)" for one in numbers)
        return " ".join(part for part in (signal.kind.replace("_", " "), number, self.called(signal)) if part)

    def called(self, signal: ir.Signal) -> str:
        return signal.name or self.named.get(signal, "")


def _is_pose(assign: ir.Assign) -> bool:
    """A place without the flags of a posture, as tables of tools and frames have them."""
    value = assign.value
    return isinstance(value, ir.Aggregate) and {name.lower() for name, _ in value.entries if name} == _POSE


def _is_load(assign: ir.Assign) -> bool:
    """Said by its name only: a table of loads is a record of each maker's own."""
    target = assign.target.base if isinstance(assign.target, ir.Index) else assign.target
    return isinstance(target, ir.Name) and "load" in target.id.lower() and isinstance(assign.value, ir.Aggregate)


def _elements(names: Iterable[tuple[str, str]]) -> Iterator[Item]:
    """Data with its numbers; elements of one list that follow each other as one."""
    for (base, _), group in groupby(names, key=lambda pair: (pair[0].partition("[")[0], pair[1].partition("[")[0])):
        rows = list(group)
        if "[" in rows[0][0] and len(rows) > 1:
            yield Item(f"{base}, {len(rows)} elements, is {rows[0][1]} to {rows[-1][1]}")
        else:
            yield from (Item(f"{name} is {number}") for name, number in rows)


def _first_line(origin: Origin) -> str:
    return origin.text.strip().partition("\n")[0].strip()

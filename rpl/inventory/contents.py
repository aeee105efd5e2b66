"""The contents of a read project, as plain data.

A place is `file:line`. Names are spelled as they are declared; where a language does not tell capitals apart, neither
does anything here.
"""

from __future__ import annotations

from collections import Counter, defaultdict
from collections.abc import Iterator
from dataclasses import dataclass, field, fields
from pathlib import PurePath
from typing import get_args

from rpl import ir
from rpl.diagnostics import Diagnostics
from rpl.ir.walk import bodies, walk
from rpl.passes.legalise.facts.values.heldtexts import named_by_texts
from rpl.passes.scope import ProgramScope, Scope, rules_of
from rpl.passes.typing import UNKNOWN_NAME, UNKNOWN_ROUTINE
from rpl.project import ReadProgram
from rpl.source import Origin

_KINDS = {
    ir.TargetType: "point",
    ir.JointsType: "joint point",
    ir.PoseType: "frame",
    ir.WorkObjectType: "work object",
    ir.ToolType: "tool",
}
_SWITCHING = (ir.Pulse, ir.SetAfter)
_MAIN = "main"
MOTION = "motion"
_LONGEST = 100  # of a statement that is shown
_STATEMENTS = tuple(one for one in get_args(ir.Statement) if one not in (ir.Nothing, ir.Label))


@dataclass(frozen=True, slots=True)
class Program:
    """A routine; one whose name others have too is named behind its task and module. kind: procedure, function, trap.
    `entry`: people can start it, and nothing here calls it: it takes no argument that is needed, gives no value, is no
    task that runs by itself behind the program, and in languages that select a program by its file (`Rules.by_file`) it
    is the first routine of its file. `calls` and `called_by`: routines of the project;
    `by_text`: a text that a program holds names it, so that it may be called too. `missing`: what it calls that the
    project has not."""

    name: str
    module: str
    place: str
    kind: str
    task: str
    entry: bool
    statements: int
    moves: int
    calls: tuple[str, ...] = ()
    called_by: tuple[str, ...] = ()
    missing: tuple[str, ...] = ()
    by_text: bool = False


@dataclass(frozen=True, slots=True)
class Missing:
    """A name that nothing declares. kind: routine or datum; `example`: the first statement with it."""

    name: str
    kind: str
    places: tuple[str, ...]
    example: str = ""


@dataclass(frozen=True, slots=True)
class SignalUse:
    """A signal by kind and number or name, and the programs that write and read it."""

    name: str
    kind: str
    number: str
    writers: tuple[str, ...]
    readers: tuple[str, ...]


@dataclass(frozen=True, slots=True)
class Datum:
    """A point, frame or tool with the programs that use it."""

    name: str
    kind: str
    place: str
    used_by: tuple[str, ...]


@dataclass(frozen=True, slots=True)
class Contents:
    """All of it. `files`: path, language, statements and those that could not be read."""

    languages: tuple[str, ...]
    files: tuple[tuple[str, str, int, int], ...]
    tasks: tuple[tuple[str, str, str], ...]  # name, entry, kind
    programs: tuple[Program, ...]
    missing: tuple[Missing, ...]
    signals: tuple[SignalUse, ...]
    data: tuple[Datum, ...]

    @property
    def entries(self) -> tuple[Program, ...]:
        """The programs that people start."""
        return tuple(one for one in self.programs if one.entry)

    @property
    def unused(self) -> tuple[Program, ...]:
        """Routines that nothing calls and nobody can start as they are: they take arguments or give a value."""
        return tuple(one for one in self.programs if not (one.called_by or one.by_text or one.entry))

    def as_json(self) -> dict[str, object]:
        """The same for machines."""
        return {
            "languages": list(self.languages),
            "files": [
                {"file": path, "dialect": language, "statements": statements, "opaque": opaque}
                for path, language, statements, opaque in self.files
            ],
            "tasks": [{"name": name, "entry": entry, "kind": kind} for name, entry, kind in self.tasks],
            "entries": [one.name for one in self.entries],
            "unused": [one.name for one in self.unused],
            "programs": [_as_json(one) for one in self.programs],
            "missing": [_as_json(one) for one in self.missing],
            "signals": [_as_json(one) for one in self.signals],
            "data": [_as_json(one) for one in self.data],
        }


def _as_json(one: Program | Missing | SignalUse | Datum) -> dict[str, object]:
    """Its fields; that of dataclasses copies every text of them, and a backup has ten thousands of points."""
    return {each.name: getattr(one, each.name) for each in fields(one)}


def contents(read: ReadProgram, diagnostics: Diagnostics) -> Contents:
    """What was read, with what its reading reported."""
    program = read.reduced
    looking = _Looking(program)
    looking.look()
    files = tuple((one.path, one.dialect, one.statements, one.opaque) for one in read.files)
    return Contents(
        read.dialects,
        files,
        tuple((task.name, task.entry, task.kind) for task in program.tasks),
        tuple(looking.programs()),
        tuple(_missing(diagnostics)),
        tuple(looking.signal_uses()),
        tuple(looking.data()),
    )


def place_of(origin: Origin) -> str:
    """`file:line`, with the file's own name only."""
    return f"{PurePath(origin.file).name}:{origin.line}" if origin.source else ""


def _missing(diagnostics: Diagnostics) -> Iterator[Missing]:
    """What the resolver reported; each name once, with all its places."""
    found: dict[tuple[str, str], tuple[str, str, dict[str, None]]] = {}
    for item in diagnostics:
        kind = {UNKNOWN_ROUTINE.name: "routine", UNKNOWN_NAME.name: "datum"}.get(item.code.name)
        if kind is not None:
            name = str(dict(item.arguments)["name"])
            example = " ".join(item.origin.text.split())[:_LONGEST]
            _, _, places = found.setdefault((kind, name.lower()), (name, example, {}))
            places[place_of(item.origin)] = None
    for (kind, _), (name, example, places) in sorted(
        found.items(), key=lambda one: (one[0][0] != "routine", one[0][1])
    ):
        yield Missing(name, kind, tuple(places), example)


@dataclass(slots=True)
class _Looking:
    """One walk over all routines; routines and data by identity."""

    program: ir.Program
    scopes: ProgramScope = field(init=False)
    calls: dict[int, dict[int, ir.Routine]] = field(default_factory=lambda: defaultdict(dict))
    missing: dict[int, dict[str, None]] = field(default_factory=lambda: defaultdict(dict))
    counts: dict[int, list[int]] = field(default_factory=dict)  # statements, moves
    written: dict[ir.Signal, dict[str, None]] = field(default_factory=lambda: defaultdict(dict))
    readings: dict[ir.Signal, dict[str, None]] = field(default_factory=lambda: defaultdict(dict))
    used: dict[int, dict[str, None]] = field(default_factory=lambda: defaultdict(dict))
    named: dict[ir.Signal, str] = field(default_factory=dict)
    called_as: dict[int, str] = field(default_factory=dict)  # a name that several have, behind task and module
    selected: dict[int, str] = field(default_factory=dict)  # frames that a program selects as tool or base
    by_text: bool = False  # is a routine called by a text?

    def __post_init__(self) -> None:
        self.scopes = ProgramScope(self.program)
        routines = [(module, one) for module in self.program.modules for one in module.routines]
        times = Counter(one.name.lower() for _, one in routines)
        for module, one in routines:
            homes = (module.task, module.name) if times[one.name.lower()] > 1 else ()
            self.called_as[id(one)] = ".".join(filter(None, (*homes, one.name)))

    def look(self) -> None:
        for module in self.program.modules:
            for one in module.declarations:
                if isinstance(one, ir.SignalDeclaration):
                    self.named.setdefault(one.signal, one.name)
        for module, routine in self.scopes.routines():
            self.routine(routine, self.scopes.routine(module, routine))

    def routine(self, routine: ir.Routine, scope: Scope) -> None:
        statements = moves = 0
        switched: set[int] = set()
        for node in walk(*bodies(routine), routine.declarations):
            match node:
                case ir.CallRoutine(name=name, dynamic=text):
                    self.by_text |= text is not None
                    if text is None:
                        self.called(name, routine, scope)
                case ir.Call(name=name) | ir.ConnectInterrupt(routine=name) | ir.TaskControl(task=name):
                    self.called(name, routine, scope)
                case ir.OnError(routine=str(name)):
                    self.called(name, routine, scope)
                case ir.Move() | ir.Rows():
                    moves += len(node) if isinstance(node, ir.Rows) else 1
                case ir.Assign(target=ir.System(name="tool" | "base" as what), value=ir.Name(id=name)):
                    symbol = scope.value(name)
                    if symbol is not None:
                        self.selected[id(symbol.declaration)] = "tool" if what == "tool" else "work object"
                case ir.Assign(target=target):
                    switched |= self.writes(target, routine, scope)
                case ir.Pulse() | ir.SetAfter():
                    switched |= self.writes(node.signal, routine, scope)
                case ir.Signal() if id(node) not in switched:
                    self.readings[node][self.called_as[id(routine)]] = None
                case ir.Name(id=name) if id(node) not in switched:
                    self.name(name, routine, scope)
            statements += isinstance(node, _STATEMENTS)
        self.counts[id(routine)] = [statements, moves]

    def called(self, name: str, routine: ir.Routine, scope: Scope) -> None:
        found = scope.routine(name)
        if found is None:
            self.missing[id(routine)][name] = None
        elif self.scopes.home(found) is not None:
            self.calls[id(routine)][id(found)] = found

    def writes(self, target: ir.Expression, routine: ir.Routine, scope: Scope) -> set[int]:
        """The nodes that name an output which is set; nothing reads them there."""
        signal = target if isinstance(target, ir.Signal) else _declared_signal(target, scope)
        if signal is None:
            return set()
        self.written[signal][self.called_as[id(routine)]] = None
        return {id(target)}

    def name(self, name: str, routine: ir.Routine, scope: Scope) -> None:
        symbol = scope.value(name)
        if symbol is None:
            return
        if isinstance(symbol.declaration, ir.SignalDeclaration):
            self.readings[symbol.declaration.signal][self.called_as[id(routine)]] = None
        elif not isinstance(symbol.declaration, ir.Parameter):
            self.used[id(symbol.declaration)][self.called_as[id(routine)]] = None

    # ---- what was found

    def programs(self) -> Iterator[Program]:
        callers: dict[int, dict[str, None]] = defaultdict(dict)
        for module in self.program.modules:
            for routine in module.routines:
                for found in self.calls[id(routine)].values():
                    if found is not routine:
                        callers[id(found)][self.called_as[id(routine)]] = None
        begun = {task.entry.lower() for task in self.program.tasks if task.kind == MOTION}
        behind = {task.entry.lower() for task in self.program.tasks if task.kind != MOTION}
        heads = _first_of_files(self.program)
        texts = named_by_texts(self.program) if self.by_text else set()
        for module in self.program.modules:
            for routine in module.routines:
                statements, moves = self.counts[id(routine)]
                starts = routine.kind == "procedure" and all(one.optional for one in routine.parameters)
                starts &= routine.name.lower() not in behind
                starts &= id(routine) in heads or not rules_of(module.dialect).by_file
                by_text = routine.name.lower() in texts
                alone = not (id(routine) in callers or by_text) or routine.name.lower() in {_MAIN, *begun}
                yield Program(
                    self.called_as[id(routine)],
                    module.name,
                    place_of(routine.origin),
                    routine.kind,
                    module.task,
                    starts and alone and statements > 0,
                    statements,
                    moves,
                    tuple(self.called_as[id(one)] for one in self.calls[id(routine)].values()),
                    tuple(callers[id(routine)]),
                    tuple(self.missing[id(routine)]),
                    by_text,
                )

    def signal_uses(self) -> Iterator[SignalUse]:
        signals = dict.fromkeys((*self.written, *self.readings))
        for signal in sorted(signals, key=_order):
            name = signal.name or self.named.get(signal, "")
            numbers = [_number(one) for one in (signal.index, signal.last) if one is not None]
            yield SignalUse(
                name,
                signal.kind.replace("_", " "),
                " to ".join(numbers),
                tuple(self.written.get(signal, ())),
                tuple(self.readings.get(signal, ())),
            )

    def data(self) -> Iterator[Datum]:
        for module in self.program.modules:
            scope = self.scopes.module(module)
            yield from self.data_of(module.declarations, scope, "")
            for routine in module.routines:
                yield from self.data_of(routine.declarations, scope, self.called_as[id(routine)])

    def data_of(self, declarations: tuple[ir.Declaration, ...], scope: Scope, routine: str) -> Iterator[Datum]:
        """Points, frames and tools that have a value; those of a `routine` are used in it alone."""
        for one in declarations:
            if isinstance(one, ir.VariableRows):
                users = tuple(self.used.get(id(one), ())) or ((routine,) if routine else ())
                yield from (Datum(each.name, "point", place_of(one.origin), users) for each in one.variables())
            elif isinstance(one, ir.Variable) and one.initial is not None and one.origin.source:
                kind = _KINDS.get(scope.resolve(one.type).__class__)
                if kind is not None:
                    kind = self.selected.get(id(one), kind)
                    yield Datum(one.name, kind, place_of(one.origin), tuple(self.used.get(id(one), ())))


def _first_of_files(program: ir.Program) -> set[int]:
    """The routines, by identity, that stand first in their files."""
    found: dict[str, ir.Routine] = {}
    for module in program.modules:
        for routine in module.routines:
            first = found.setdefault(routine.origin.file, routine)
            if routine.origin.start < first.origin.start:
                found[routine.origin.file] = routine
    return {id(one) for one in found.values()}


def _declared_signal(target: ir.Expression, scope: Scope) -> ir.Signal | None:
    symbol = scope.value(target.id) if isinstance(target, ir.Name) else None
    declared = symbol.declaration if symbol is not None else None
    return declared.signal if isinstance(declared, ir.SignalDeclaration) else None


def _number(index: ir.Expression) -> str:
    return str(index.value) if isinstance(index, ir.IntLiteral) else "computed"


def _order(signal: ir.Signal) -> tuple[str, bool, int, str]:
    index = signal.index
    number = index.value if isinstance(index, ir.IntLiteral) else 0
    return signal.kind, isinstance(index, ir.IntLiteral), number, (signal.name or "").lower()

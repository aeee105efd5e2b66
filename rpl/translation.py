"""A whole translation: normal form, legalisation for the target, names, writing. The proof comes after, by others."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from pathlib import PurePosixPath

from rpl import ir, registry
from rpl.depth import at_any_depth
from rpl.diagnostics import Diagnostic, Diagnostics, Severity, code
from rpl.emulator.mechanismfile import Mechanism
from rpl.emulator.model import RobotModel, load_robot
from rpl.errors import UsageError
from rpl.housestyle import compare_house_style
from rpl.ir.analog import AnalogSetting
from rpl.ir.columns import LooksInsideError, Stretch
from rpl.ir.standing import NOTHING, Standing
from rpl.passes.analog import analog_ranges
from rpl.passes.expanded import expanded
from rpl.passes.given import with_given
from rpl.passes.legalise import Context, legalise
from rpl.passes.legalise.kept import keeping
from rpl.passes.legality import report, unguarded
from rpl.passes.stretches import check_rows, settled, with_stretches
from rpl.project import ReadProgram
from rpl.showing import counted, folded, heading, line, table
from rpl.source import NOWHERE, decode
from rpl.writing.beside import report_beside
from rpl.writing.entries import asks_for_name, first_routine, name_entry, unpinned
from rpl.writing.lineorigins import LineOrigins, line_origins
from rpl.writing.namemap import NameMap, check_map
from rpl.writing.names import NO_MAP, named, rename, rename_hiding, renamed_twice
from rpl.writing.target import OutputFile, WriteContext

_MOST_NAMED = 5
# Runs whose moves are told apart, one after the other, before all are taken so.
_MOST_ASKED = 3

SAME_FILE = code(
    "same-output-file",
    Severity.ERROR,
    "two results would be written as {path} (from {names})",
    "give one of them another name, or translate them one by one",
)
NOT_KEPT = code(
    "map-not-kept",
    Severity.WARNING,
    "the map gives {name} the number {number} of {bank}; it has {other}",
    "the source says that number, or another one has the map's: change it in the source, or in the map",
    several="{count} names have another number than the map says: [{name} ({bank} {number}, now {other})]",
)


@dataclass(frozen=True, slots=True)
class Translation:
    """Written files, the program as it was written (moves of one shape as Rows), names that changed, and what was lost
    (guarded stops). `registers`: the source names of data that has numbers in the target, by (bank, number); their
    types beside. `names`: every name that was given, source -> target; `map`: both as a file keeps them, with what an
    earlier map says of names that the program has no more. `setup`: files with what has to be on the controller beside
    the program, such as its signals. `write`: what has made the files of the program; its reports
    are dropped."""

    files: tuple[OutputFile, ...]
    written: ir.Program
    renamed: Mapping[str, str]
    losses: tuple[Diagnostic, ...] = ()
    registers: Mapping[tuple[str, int], str] = field(default_factory=dict)
    register_types: Mapping[tuple[str, int], str] = field(default_factory=dict)
    names: Mapping[str, str] = field(default_factory=dict)
    map: NameMap = field(default_factory=NameMap)
    setup: tuple[OutputFile, ...] = ()
    write: Callable[[ir.Program], Sequence[OutputFile]] | None = field(default=None, repr=False, compare=False)
    _whole: list[ir.Program] = field(default_factory=list, init=False, repr=False, compare=False)

    def line_origins(self) -> LineOrigins:
        """Where the lines of the files come from (the program is written once more for that)."""
        write = self.write
        return {} if write is None else at_any_depth(lambda: line_origins(self.written, self.files, write))

    @property
    def program(self) -> ir.Program:
        """The program as it was written, each move for itself (made when it is first asked for)."""
        if not self._whole:
            self._whole.append(at_any_depth(lambda: expanded(self.written)))
        return self._whole[0]

    def _parts(self) -> list[str]:
        names = [file.path for file in self.files[:_MOST_NAMED]]
        more = ["..."] if len(self.files) > _MOST_NAMED else []
        return [
            f"{counted(len(self.files), 'file')} ({', '.join([*names, *more])})",
            counted(len(self.losses), "loss", "losses"),
        ]

    def __repr__(self) -> str:
        return line("Translation", self._parts())

    def _repr_html_(self) -> str:
        rows = [(item.origin.file, item.origin.line, item.code.name, item.message) for item in self.losses]
        texts = "".join(folded(file.path, decode(file.data)[0]) for file in self.files)
        return heading("translation", self._parts()) + table(("file", "line", "loss", "reason"), rows) + texts


def translate_program(
    read: ReadProgram,
    target_name: str,
    robot: str | None = None,
    to_robot: str | None = None,
    diagnostics: Diagnostics | None = None,
    earlier: NameMap = NO_MAP,
    options: Mapping[str, str] | None = None,
    given: Mapping[str, object] | None = None,
    mechanisms: tuple[Mechanism, ...] = (),
    analog: tuple[AnalogSetting, ...] = (),
    templates: Mapping[str, str] | None = None,
    there: Standing = NOTHING,
) -> Translation:
    """Write a program that was read in another language (or anew in its own).

    target_name: its name or an alias (registry.target_called). robot: the arm the source was written for; to_robot: the
    arm that will run the result (default: the same). Raises UsageError for unknown names. `earlier`: names and numbers
    that an earlier translation gave or a person chose (Translation.map); they are kept. `options`: the target's own, by
    name (Target.options). `given`: values of data that the controller keeps and the program does not set, by name (the
    variables of a cell file); what is written for another controller sets them. `mechanisms`: those of the cell, beside
    those of the robot's file. `analog`: ranges of analogue signals (the cell's `[analog.LANGUAGE]`).
    `templates`: a plant's own for the target, path -> text (rpl.writing.house); one that fails or that writes another
    program is an error. `there`: what stands on the robot that will run it (rpl.standing): nothing of it is given to
    something else, and what is the same is taken.
    What the target cannot say is written as a guarded stop and listed in `losses`.
    """
    collector = diagnostics if diagnostics is not None else Diagnostics()
    target_name = registry.target_called(target_name).name
    first = _load(robot, mechanisms)
    second = _load(to_robot, mechanisms) if to_robot and to_robot != robot else first
    source = read.dialects[0] if read.dialects else target_name
    own = options or {}
    capabilities = registry.target(target_name).capabilities_under(own)
    check_map(earlier, target_name, capabilities.storage)

    languages = (*(module.dialect for module in read.reduced.modules), target_name)

    def translated(program: ir.Program, stretches: tuple[Stretch, ...]) -> Translation:
        context = Context(source, target_name, capabilities, collector, first, second)
        context.registers, context.stretches, context.before = earlier.numbers, stretches, len(collector)
        context.there, context.options = there, own
        context.analog = {one: analog_ranges(program, one, analog) for one in dict.fromkeys(languages)}
        whole = with_given(program, given) if given and source != target_name else program
        return _translated(whole, context, second, own, templates or {}, earlier)

    if source == target_name:
        return at_any_depth(lambda: translated(read.program, ()), collector)
    return at_any_depth(lambda: _by_stretches(read.reduced, translated, collector), collector)


def _by_stretches(
    program: ir.Program,
    translated: Callable[[ir.Program, tuple[Stretch, ...]], Translation],
    diagnostics: Diagnostics,
) -> Translation:
    """The translation with the runs of the program by stretches; those runs whose moves something tells apart, by
    moves."""
    before = len(diagnostics)
    one_by_one: set[ir.Run] = set()
    while True:
        whole, stretches = with_stretches(program, one_by_one)
        try:
            return translated(whole, stretches)
        except LooksInsideError as asked:
            one_by_one.add(asked.stretch.run)
            del diagnostics.items[before:]
        if len(one_by_one) >= _MOST_ASKED:
            return translated(expanded(program), ())


@keeping()
def _translated(
    whole: ir.Program,
    context: Context,
    robot: RobotModel | None,
    options: Mapping[str, str],
    templates: Mapping[str, str],
    earlier: NameMap,
) -> Translation:
    source, target_name, capabilities = context.source, context.target, context.capabilities
    collector, target = context.diagnostics, registry.target(context.target)
    before = len(collector)
    renamed: dict[str, str] = {}
    apart: dict[str, str] = {}
    if source != target_name:
        whole = _joined(whole)
        whole, hiding = rename_hiding(whole, capabilities.names)
        first = first_routine(whole) if asks_for_name(capabilities.names) else None
        legal_program = legalise(whole, context, target.passes())
        kept, hiding = unpinned(earlier, capabilities.names), renamed_twice(hiding, context.renamed)
        taken, numbered = frozenset(context.there.names), bool(capabilities.storage.banks)
        program, legal = rename(legal_program, capabilities.names, kept, hiding, taken, numbered)
        apart = _apart(legal, rename(legal_program, capabilities.names, kept, hiding)[1]) if taken else {}
        program, begun = name_entry(program, legal.get(first, first) if first else None, capabilities.names, taken)
        program = settled(program, context.stretches, collector.items[before:])
        program = program if target.rows else expanded(program)
        check_rows(program, collector.items[before:])
        renamed = renamed_twice(renamed_twice(hiding, legal), begun)
    else:
        program = legalise(whole, context)
    legalised = len(collector)
    asked = WriteContext(collector, robot, options, context.register_names, context.foreign, templates, context.there)
    try:
        files = target.write(program, asked)
    except UnicodeEncodeError as error:
        raise _strange_sign(error, target) if templates else error from None
    if templates:
        shipped = target.write(program, replace(asked, diagnostics=Diagnostics(), templates={}))
        compare_house_style(files, shipped, target_name, collector)
    collector.drop_repeated(before, legalised)
    files = _each_once(files, program, collector)
    if source != target_name and not capabilities.carries_rules:
        report(unguarded(program, capabilities, collector.items[before:]), collector)
    losses = tuple(item for item in collector.items[before:] if item.severity == Severity.LOSS)
    words = renamed if capabilities.io.signal_prefixes else {}
    written, numbers, types = _with_signals(program, context, words), context.register_names, context.register_types
    names = named(program, renamed, bool(capabilities.storage.banks)) if source != target_name else {}
    names = {old: new for old, new in names.items() if new.lower() not in capabilities.names.predefined}
    groups = _groups(context) if names and capabilities.storage.banks else {}
    given = NameMap(target_name, names, {**numbers, **groups, **_signals(context, renamed)}, types).behind(earlier)
    _not_kept(given, earlier, collector)
    used = {**numbers, **context.signal_names}
    report_beside(context.there, given, earlier, apart, used, collector)

    def write(program: ir.Program) -> Sequence[OutputFile]:
        return target.write(program, replace(asked, diagnostics=Diagnostics()))

    setup = target.setup(program, context.there, _signals(context, renamed)) if context.foreign else ()
    return Translation(tuple(files), written, renamed, losses, dict(numbers), dict(types), names, given, setup, write)


def _strange_sign(error: UnicodeEncodeError, target: registry.Target) -> UsageError:
    """A sign of a plant's own template that the controller has not."""
    sign = error.object[error.start]
    return UsageError(f"a template of the plant's own gives {sign!r}, which {target.title} has not")


def _apart(renamed: Mapping[str, str], alone: Mapping[str, str]) -> dict[str, str]:
    """Source name -> new name of what would have another name if nothing stood on the robot."""
    return {name: new for name, new in renamed.items() if alone.get(name, name) != new}


def _groups(context: Context) -> dict[tuple[str, int], str]:
    """Groups of signals that are written by the numbers of their bits: (kind, first number) -> name."""
    return {
        (one.kind.replace("digital", "group"), one.index.value): name
        for name, one in context.signal_groups.items()
        if one.last is not None and isinstance(one.index, ir.IntLiteral)
    }


def _signals(context: Context, renamed: Mapping[str, str]) -> dict[tuple[str, int], str]:
    """Numbered signals by the names that they are written with: (kind, number) -> name."""
    return {at: renamed.get(name, name) for at, name in context.signal_names.items()}


def _not_kept(given: NameMap, earlier: NameMap, diagnostics: Diagnostics) -> None:
    """Report the lines of a map that say another number than the program itself."""
    now = {(bank, name): number for (bank, number), name in given.numbers.items()}
    for (bank, number), name in earlier.numbers.items():
        other = now.get((bank, name), number)
        if other != number:
            diagnostics.report(NOT_KEPT, name=name, bank=bank, number=number, other=other)


def _joined(program: ir.Program) -> ir.Program:
    """Files that hold data only belong to the program of their name: one module, so that they are written as one."""
    homes: dict[tuple[str, str, str], list[ir.Module]] = {}
    for module in program.modules:
        homes.setdefault((module.name.lower(), module.dialect, module.task), []).append(module)
    whole: dict[int, ir.Module | None] = {}
    for modules in homes.values():
        home = next((one for one in modules if one.routines), modules[0])
        data = [one for one in modules if one is not home and not one.routines]
        if data:
            declared = tuple(each for one in (*data, home) for each in one.declarations)
            whole |= {id(one): None for one in data} | {id(home): replace(home, declarations=declared)}
    found = (whole.get(id(module), module) for module in program.modules)
    return replace(program, modules=tuple(module for module in found if module is not None)) if whole else program


def _each_once(files: Sequence[OutputFile], program: ir.Program, diagnostics: Diagnostics) -> list[OutputFile]:
    """Two results never meet in one file, also not on a disk that takes large letters for small ones."""
    kept: dict[str, OutputFile] = {}
    for file in files:
        first = kept.setdefault(file.path.lower(), file)
        if first is not file and first != file:
            stem = PurePosixPath(file.path).stem.lower()
            homes = [module.origin for module in program.modules if module.name.lower() == stem]
            homes += [r.origin for module in program.modules for r in module.routines if r.name.lower() == stem]
            at = next((one for one in reversed(homes) if one.source), NOWHERE)
            names = ", ".join(dict.fromkeys(one.file for one in homes if one.source)) or "two parts of the program"
            diagnostics.report(SAME_FILE, at, path=file.path, names=names)
    return list(kept.values())


def _with_signals(program: ir.Program, context: Context, words: Mapping[str, str]) -> ir.Program:
    """The program with the names of signals that have become numbers, for whoever compares or reads it. `words`: names
    of signals that are written in another way."""
    signals = [
        ir.SignalDeclaration(name, ir.Signal(kind, ir.IntLiteral(number)), scope="global")
        for (kind, number), name in sorted(context.register_names.items())
        if kind in ir.SIGNAL_KINDS
    ]
    signals += [
        ir.SignalDeclaration(words.get(name, name), one, scope="global")
        for name, one in sorted(context.signal_groups.items())
    ]
    if not signals or not program.modules:
        return program
    first = program.modules[0]
    home = ir.Module("signal_names", first.dialect, tuple(signals), task=first.task, public=True)
    return replace(program, modules=(*program.modules, home))


def _load(name: str | None, mechanisms: tuple[Mechanism, ...]) -> RobotModel | None:
    return load_robot(name).among(mechanisms, "cell") if name else None

"""The only door to dialects and targets: found by folder and by entry point, imported when asked for.

A dialect is the folder `dialects/<name>/` whose `__init__` has `DIALECT`; a target is `postprocessors/<name>/` with
`TARGET`. Other distributions add theirs with the entry point groups `rpl.dialects` and `rpl.postprocessors`.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from difflib import get_close_matches
from functools import cache
from importlib import import_module, resources
from importlib.metadata import entry_points
from importlib.util import find_spec
from typing import TYPE_CHECKING, Protocol, cast

from rpl.diagnostics import Diagnostics
from rpl.errors import UsageError
from rpl.ir.standing import NOTHING, Standing
from rpl.source import Source
from rpl.tomlfile import read_toml
from rpl.trivia import NOTHING as NO_TRIVIA
from rpl.trivia import Trivia
from rpl.words import Words

if TYPE_CHECKING:
    from rpl.checks.loading import Loader
    from rpl.emulator.configuration import Notation
    from rpl.ir import Module, Program, Signal
    from rpl.ir.analog import AnalogPorts
    from rpl.ir.rules import Rules
    from rpl.passes.legalise.stages import Placed
    from rpl.reading.ledger import FileReport
    from rpl.writing.target import Capabilities, OutputFile, WriteContext


# The rooms that languages stand in.
_DIALECTS, _TARGETS = "dialects", "postprocessors"


class Fit(Protocol):
    def __call__(self, options: Mapping[str, str]) -> Capabilities: ...


class LastPass(Protocol):
    def __call__(self, program: Program, context: WriteContext) -> Program: ...


@dataclass(frozen=True, slots=True)
class ReadResult:
    """What a dialect's reader gives: the modules of all sources, and per file what became of its text."""

    program: Program
    files: tuple[FileReport, ...]


def _signal_name(kind: str, number: int) -> str:
    return f"{kind}[{number}]"


def _no_signal(text: str) -> Signal | None:
    return None


def _no_companions(path: str) -> tuple[str, ...]:
    return ()


def _nothing_said(program: Program) -> tuple[AnalogPorts, ...]:
    return ()


@cache
def _part(package: str, part: str, name: str) -> object:
    """What a module of a language's folder has under a name, imported when it is asked for; None: neither is there."""
    place = f"{package}.{part}"
    return getattr(import_module(place), name, None) if find_spec(place) is not None else None


@dataclass(frozen=True, slots=True)
class Aside:
    """A file of a controller that stands beside its programs and is none to be read. kind: what it is. text_at: where
    the text of the program is that it holds in another form, "" when it holds none. readable: it can be read itself
    where that text is not there; else `advice` says how to get it."""

    kind: str
    text_at: str = ""
    readable: bool = False
    advice: str = ""


@dataclass(frozen=True, slots=True)
class Dialect:
    """A language that can be read. `package`: its folder as a module, whose parts are imported when asked for:

    `project` (or the module that `reader` names) has `read`, for all sources of one project together; `rules` has
    RULES, the data of its meaning; and where there are any, `prelude` has `prelude()`, its predefined data and system
    routines, `configuration` NOTATION, the flags of the arm's configuration, `loading` LOADER, what its controller
    refuses to load, `standing` has `standing`, what the files of a backup say is on the controller, beside the names
    that its programs declare, `machine` has `arms`, what they call the arm, and `is_backup`, whether a folder is one,
    `trivia` TRIVIA, what of a text says nothing.

    recognise(path, text) -> 0..100: how sure the content is of this language (never from the extension alone).
    companions(path): files that belong to a named one where they exist (a data list). signal_name(kind, number): how
    the language spells a numbered signal. aliases: other words that people ask for it by, such as its maker's name;
    capitals do not count.
    analog_said(program): the ranges of analogue signals that a program of the language itself says. signal_of(text):
    what a spelling of a group of numbered signals means (`OG#(2)`: outputs 9 to 16), or None.
    """

    package: str
    title: str
    extensions: tuple[str, ...]
    recognise: Callable[[str, str], int]
    notation_fields: tuple[str, ...] = ()
    companions: Callable[[str], tuple[str, ...]] = _no_companions
    signal_name: Callable[[str, int], str] = _signal_name
    aliases: tuple[str, ...] = ()
    analog_said: Callable[[Program], tuple[AnalogPorts, ...]] = _nothing_said
    signal_of: Callable[[str], Signal | None] = _no_signal
    reader: str = "project"

    @property
    def name(self) -> str:
        return self.package.rpartition(".")[2]

    def read(self, sources: Sequence[Source], diagnostics: Diagnostics) -> ReadResult:
        """The modules of all sources of one project."""
        return cast("ReadResult", import_module(f"{self.package}.{self.reader}").read(sources, diagnostics))

    def rules(self) -> Rules:
        """The data of its meaning."""
        return cast("Rules", import_module(f"{self.package}.rules").RULES)

    def prelude(self) -> Module | None:
        """Its predefined data and system routines; None where there are none."""
        made = cast("Callable[[], Module] | None", _part(self.package, "prelude", "prelude"))
        return None if made is None else made()

    @property
    def notation(self) -> Callable[[], Notation] | None:
        """Gives the flags of the arm's configuration; None where the language has none."""
        found = cast("Notation | None", _part(self.package, "configuration", "NOTATION"))
        return None if found is None else lambda: found

    @property
    def loading(self) -> Callable[[], Loader] | None:
        """Gives what its controller refuses to load; None where nobody knows."""
        found = cast("Loader | None", _part(self.package, "loading", "LOADER"))
        return None if found is None else lambda: found

    def standing(self, sources: Sequence[Source]) -> Standing:
        """What the files of a backup say is on the controller, beside the names that its programs declare."""
        told = cast("Callable[[Sequence[Source]], Standing] | None", _part(self.package, "standing", "standing"))
        return NOTHING if told is None else told(sources)

    @property
    def trivia(self) -> Trivia:
        """What of a program's text says nothing: numbers of lines, dates of headers."""
        return cast("Trivia | None", _part(self.package, "trivia", "TRIVIA")) or NO_TRIVIA

    def arms(self, sources: Sequence[Source]) -> list[tuple[str, str]]:
        """What the files of a backup call the arm, as its maker writes it, each with the path of the file."""
        told = cast(
            "Callable[[Sequence[Source]], Iterable[tuple[str, str]]] | None", _part(self.package, "machine", "arms")
        )
        return [] if told is None else list(told(sources))

    def aside(self, source: Source) -> Aside | None:
        """What the file is, if it is one of the controller's that stands beside programs."""
        told = cast("Callable[[Source], Aside | None] | None", _part(self.package, "machine", "aside"))
        return None if told is None else told(source)

    def is_backup(self, names: frozenset[str]) -> bool:
        """Is a folder a backup of its controller, by what stands in it and in the folders in it? Names in small
        letters, those of folders with a `/` behind (`rapid/task1/`)."""
        told = cast("Callable[[frozenset[str]], bool] | None", _part(self.package, "machine", "is_backup"))
        return told is not None and told(names)


@dataclass(frozen=True, slots=True)
class Target:
    """A language that can be written. `package`: its folder as a module, whose parts are imported when asked for:

    `capabilities` has CAPABILITIES (and `fitted`, which gives those under some options); `writer` has `write`, which
    raises InternalError when its ledger finds an unwritten node; `passes`, where there are any, has PASSES, rewritings
    that only this target needs, each with its place among those of the core, and LAST, those right in front of the
    writer, also where a program is written in its own language.

    What its controller loads: lines of at most `longest_line` characters (0: any), text in one of the `encodings`.
    `options`: names of the target's own options and what they say. `aliases`: other words for it, beside those of the
    dialect of its name. `rows`: can it write moves of one shape as one node (ir.Rows)?
    """

    package: str
    title: str
    options: Mapping[str, str] = field(default_factory=dict)
    longest_line: int = 0
    encodings: tuple[str, ...] = ("utf-8",)
    aliases: tuple[str, ...] = ()
    rows: bool = False

    @property
    def name(self) -> str:
        return self.package.rpartition(".")[2]

    def capabilities(self) -> Capabilities:
        """What the controller can say."""
        return cast("Capabilities", import_module(f"{self.package}.capabilities").CAPABILITIES)

    def capabilities_under(self, options: Mapping[str, str]) -> Capabilities:
        """What the controller can say when these options are given. Raises UsageError for an option it has not."""
        unknown = next((name for name in options if name not in self.options), None)
        if unknown is not None:
            known = "; ".join(f"{name}: {about}" for name, about in self.options.items())
            raise UsageError(f"{self.name} has no option {unknown!r}" + (f": there is {known}" if known else ""))
        fitted = cast(
            "Callable[[Mapping[str, str]], Capabilities] | None", _part(self.package, "capabilities", "fitted")
        )
        return fitted(options) if fitted is not None and options else self.capabilities()

    def passes(self) -> tuple[Placed, ...]:
        """Rewritings that only it needs, each with its place among those of the core."""
        return cast("tuple[Placed, ...]", _part(self.package, "passes", "PASSES") or ())

    def last(self) -> tuple[LastPass, ...]:
        """Rewritings right in front of the writer: what one instruction of the controller says together."""
        return cast("tuple[LastPass, ...]", _part(self.package, "passes", "LAST") or ())

    def setup(
        self, program: Program, there: Standing, signals: Mapping[tuple[str, int], str]
    ) -> tuple[OutputFile, ...]:
        """Files with what has to be on the controller beside a program, as its people enter it. there: what is;
        signals: (kind, number) of the source -> name in the program."""
        made = cast("Callable[..., list[OutputFile]] | None", _part(self.package, "setup", "setup"))
        return () if made is None else tuple(made(program, there, signals))

    def write(self, program: Program, context: WriteContext) -> list[OutputFile]:
        """The files of a program in the target's terms."""
        for one in self.last():
            program = one(program, context)
        return cast("list[OutputFile]", import_module(f"{self.package}.writer").write(program, context))


@cache
def _names(room: str) -> dict[str, str]:
    """Name -> module path, of folders in the room and of entry points."""
    found = {}
    for entry in resources.files(f"rpl.{room}").iterdir():
        if entry.is_dir() and entry.joinpath("__init__.py").is_file():
            found[entry.name] = f"rpl.{room}.{entry.name}"
    for point in entry_points(group=f"rpl.{room}"):
        found[point.name] = point.value.partition(":")[0]
    return dict(sorted(found.items()))


def _load(room: str, name: str, attribute: str) -> object:
    names = _names(room)
    if name not in names:
        raise UsageError(_unknown(room, name))
    return getattr(import_module(names[name]), attribute)


def _words(room: str) -> dict[str, str]:
    """What a language may be asked for by, in small letters, to its name: the names, then aliases of its records."""
    found = {name.lower(): name for name in _names(room)}
    for name in _names(room):
        own = target(name).aliases if room == _TARGETS else ()
        spoken = dialect(name).aliases if name in _names(_DIALECTS) else ()
        for alias in (*own, *spoken):
            found.setdefault(alias.lower(), name)
    return found


def _meant(room: str, word: str) -> str:
    """The name of the language that the word asks for; the word itself where there is none."""
    if word in _names(room):
        return word
    return _words(room).get(" ".join(word.lower().split()), word)


def _unknown(room: str, name: str) -> str:
    """That there is no such language, with the nearest words."""
    words = _words(room)
    nearest = list(dict.fromkeys(words[word] for word in get_close_matches(name.lower(), words)))
    hint = f"; did you mean {' or '.join(nearest)}?" if nearest else ""
    kind = "language that can be written is" if room == _TARGETS else "language is"
    return f"no {kind} called {name!r}: there are {', '.join(_names(room))}{hint}"


def dialect_names() -> list[str]:
    return list(_names(_DIALECTS))


def target_names() -> list[str]:
    return list(_names(_TARGETS))


@cache
def dialect(name: str) -> Dialect:
    """The dialect of that name. Raises UsageError when there is none."""
    found = _load(_DIALECTS, name, "DIALECT")
    assert isinstance(found, Dialect)  # a promise of our own folders, not of input
    return found


def dialect_meant(word: str) -> str:
    """The name of the dialect that people ask for by this word: its name or an alias, in any capitals; the word itself
    where there is none."""
    return _meant(_DIALECTS, word)


def dialect_called(word: str) -> Dialect:
    """The dialect that people ask for by this word. Raises UsageError with the nearest names when there is none."""
    return dialect(dialect_meant(word))


def controller_text(name: str) -> str:
    """The text of `controller.toml` in a dialect's folder: how its controller moves. Empty when there is none."""
    dialect(name)  # an unknown name is refused there
    file = resources.files(_names(_DIALECTS)[name]).joinpath("controller.toml")
    return file.read_text(encoding="utf-8") if file.is_file() else ""


@cache
def words(name: str) -> Words:
    """What `words.toml` in a dialect's folder says: the vocabulary that reader and writer of the language share."""
    file = resources.files(_names(_DIALECTS)[name]).joinpath("words.toml")
    return Words(read_toml(file.read_text(encoding="utf-8")))


@cache
def target(name: str) -> Target:
    """The target of that name. Raises UsageError when there is none."""
    found = _load(_TARGETS, name, "TARGET")
    assert isinstance(found, Target)
    return found


def target_package(name: str) -> str:
    """The package of a target, which its templates stand in. Raises UsageError when there is no such target."""
    target(name)  # an unknown name is refused there
    return _names(_TARGETS)[name]


def target_called(word: str) -> Target:
    """The target that people ask for by this word, as `dialect_called`."""
    return target(_meant(_TARGETS, word))

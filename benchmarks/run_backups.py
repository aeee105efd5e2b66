"""How far the programs of other people's backups run, as they are: every entry program of every project of a folder.

    python benchmarks/run_backups.py FOLDER... [--jobs N] [--csv F.csv] [--json F.json] [--max-time S] [--seconds S]

Files are grouped into projects (`projects`), each program of a project that nothing in it calls is run from its
beginning, in a cell in which nothing happens, on the arm that the backup names. Where it names none of ours the moves
take no time and nothing is out of reach; a program that asks for places or joints then gets an arm of its maker: the
longest on which it is not refused for reach, joint limits or a singularity, since these say nothing of it. The table
says how many. Nothing is edited, and no cell file is written. How a run ended is
one of CLASSES; the first ones are what a program can come to without its cell.

Each program that stops at data to which no file of the project gives a value is run once more with such data assumed
(`rpl run --assume-data`): it is counted by how it ended then, in classes `... with assumed data` of their own. A
program whose file stands byte for byte in several projects is counted once.
"""

from __future__ import annotations

import argparse
import csv
import hashlib
import json
import multiprocessing
import os
import re
import signal
import sys
import time
import traceback
from collections import Counter, defaultdict
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import asdict, dataclass, field, replace
from functools import cache
from pathlib import Path, PurePath
from types import FrameType

from rpl import registry
from rpl.depth import at_any_depth
from rpl.diagnostics import Diagnostics
from rpl.emulator.robotfile import robot_summaries
from rpl.errors import RplError
from rpl.inventory.contents import Program, contents, place_of
from rpl.inventory.outside import Outside
from rpl.inventory.robots import arms_of
from rpl.linking import link
from rpl.linking.program import LinkedProgram
from rpl.passes.kept import unset_reads
from rpl.passes.unsetsettings import settings_as_they_were
from rpl.project import ReadProgram, read_program, recognise
from rpl.runtime.limits import DEFAULTS
from rpl.runtime.trace import RunInterrupted, RunResult
from rpl.simulation import MAIN, Simulation
from rpl.source import read_source

# What counts as run: the program came as far as a program comes without its cell. What it waits for from outside is an
# output or a datum that nothing in the project changes (rpl.inventory.outside).
COUNTED = ("end", "waits for input", "waits for what is outside", "unknown routine", "routine of the controller")
# A routine of the controller is one that its language or an option has and no backup can hold (a socket, a service, a
# torque that is asked for): it is named. An endless loop is reported beside them and not counted.
# A project without a program that people start (a library): named, and no entry program of the share.
NO_ENTRY = "no entry"
CLASSES = (
    *COUNTED,
    "loops",
    "waits for the operator",
    "waits for something else",
    "limit",
    "unknown data",
    "unknown statement",
    "out of reach",
    "needs an arm",
    "unreadable",
    "other fault",
    "refused",
    "too slow",
    "crash",
    NO_ENTRY,
)
ASSUMED = " with assumed data"
# Folders of a controller's own backup: what lies beside and below them is one project, however deep.
_TREES = frozenset(("r1", "krc", "rapid", "steu"))
# Statements of one run.
_ASKS_FOR_AN_ARM = re.compile(r"run has no robot|needs? a robot")
_OF_THE_ARM = re.compile(r"^out of reach|^refused .*the file of robot|joint-limit|singularity|configuration")
_CALLED = re.compile(r"([A-Za-z_][\w.:]*)(?:\s*\(|\s+\w+(?:[,;\\]|$))")  # `hrd.read(`, `SocketCreate socket1;`
_MOST_STATEMENTS = 500_000
_SHOWN = 120  # signs of what stopped a program
_LEAST_EVENTS = 10
_LATE_SHARE = 0.95  # what it asks for behind this share of its time it asks for in each round
_IDLE_SHARE = 0.5  # a run whose last move or output lies this share of its time behind polls


@dataclass(frozen=True, slots=True)
class Outcome:
    """How one entry program ended. `what`: the input, routine or datum; `place` as file:line; `program`: where it
    stands, `digest` of that file. Then how many data were assumed, how the program ended with them, and which they are,
    with value and place; and how many registers it may read that no file gives and that begin at zero."""

    project: str
    language: str
    entry: str
    kind: str
    what: str
    place: str
    robot: str
    time_s: float
    moves: int
    statements: int
    program: str = ""
    digest: str = ""
    assumed: int = 0
    assumed_kind: str = ""
    assumed_what: str = ""
    assumed_place: str = ""
    assumed_data: str = ""
    zeros: int = 0

    def in_the_end(self) -> str:
        """The class with assumed data: that of the program as it is, or one of its own."""
        return f"{self.assumed_kind}{ASSUMED}" if self.assumed_kind else self.kind

    @property
    def counts(self) -> bool:
        """Did it come as far as a program comes without its cell, perhaps with assumed data?"""
        return (self.assumed_kind or self.kind) in COUNTED


class _TooSlow(KeyboardInterrupt):
    """The seconds of computing that one program gets are over."""


# ---- projects


def projects(folder: Path) -> Iterator[tuple[str, list[Path]]]:
    """The files of each project below a folder, by language: a controller's tree is one; else the files of one folder
    are, with those of folders in it unless a file of one name is in both."""
    suffixes = {suffix for name in registry.dialect_names() for suffix in registry.dialect(name).extensions}
    groups: dict[tuple[str, str], list[Path]] = defaultdict(list)
    for path in _files(folder):
        if path.suffix.lower() in suffixes:
            language = recognise(read_source(path))[0]
            if language is not None:
                groups[_home(folder, path), language].append(path)
    for home, language in sorted(groups, key=lambda key: -len(PurePath(key[0]).parts)):
        above = groups.get((str(PurePath(home).parent), language))
        here = groups[home, language]
        if above is None or _is_tree(above):
            continue
        if not {one.name.lower() for one in above} & {one.name.lower() for one in here}:
            above += here
            del groups[home, language]
    yield from ((name, paths) for (name, _), paths in sorted(groups.items()))


def _files(folder: Path) -> list[Path]:
    if folder.is_file():
        return [folder]
    found = [
        Path(home, name)
        for home, folders, names in os.walk(folder, followlinks=True)
        for name in names
        if not name.startswith(".") and "/." not in home
    ]
    return sorted(found)


def _home(folder: Path, path: Path) -> str:
    """The folder of the project that a file belongs to, from `folder` on."""
    parts = path.relative_to(folder).parts if path != folder else (path.name,)
    for depth, part in enumerate(parts[:-1]):
        if part.lower() in _TREES:
            return str(PurePath(folder.name, *parts[:depth]))
    return str(PurePath(folder.name, *parts[:-1]))


def _is_tree(paths: Sequence[Path]) -> bool:
    return any(part.lower() in _TREES for path in paths for part in path.parts[:-1])


def _versions(read: ReadProgram) -> set[str]:
    """The files of a folder that are no parts of one program but several: they have modules of one name, or a main
    routine each."""
    found: dict[object, dict[int, set[str]]] = defaultdict(dict)
    for module in read.reduced.modules:
        paths = {one.origin.source.path for one in module.routines if one.origin.source is not None}
        found[module.task, module.dialect, module.name.lower()][id(module)] = paths
        if any(one.name.lower() == MAIN for one in module.routines):
            found[MAIN][id(module)] = paths
    return {path for modules in found.values() if len(modules) > 1 for paths in modules.values() for path in paths}


# ---- one project


def measure(task: tuple[str, list[Path], float, float], whole: bool = False) -> list[Outcome]:
    """Run every entry program of a project. `whole`: it is one, whatever its files are called."""
    name, paths, max_time, seconds = task
    try:
        diagnostics = Diagnostics()
        read = read_program(paths, None, diagnostics)
        if not read.files:
            return []
        alone = set() if whole or _is_tree(paths) else _versions(read)
        if alone:
            others = [path for path in paths if str(path) not in alone]
            parts = [
                (f"{name}/{path.name}", [path, *others], max_time, seconds) for path in paths if str(path) in alone
            ]
            return [one for part in parts for one in measure(part, True)]
        found = contents(read, diagnostics)
        language = " and ".join(read.dialects)
        if not found.entries:
            return [Outcome(name, language, "", NO_ENTRY, "", "", "", 0.0, 0, 0)] if found.programs else []
        robot = next((one.robot for one in arms_of(read) if one.robot), "")
        program = settings_as_they_were(read.program, read.program, diagnostics)
        linked = at_any_depth(lambda: link(program))
        digests = {path.name: hashlib.sha256(path.read_bytes()).hexdigest() for path in paths}
        project = _Project(name, read, linked, robot, max_time, seconds)
        zeros = Counter(root.lower() for one in unset_reads(program) if not one.may_be_set for root in one.roots)
        outcomes = [replace(_shortened(project.outcome(one)), zeros=zeros[one.name.lower()]) for one in found.entries]
        return [replace(one, digest=digests.get(one.program.partition(":")[0], "")) for one in outcomes]
    except RplError as error:
        return [Outcome(name, "", "", "refused", str(error)[:120], "", "", 0.0, 0, 0)]
    except Exception:  # noqa: BLE001 (a traceback of ours is what this counts)
        return [Outcome(name, "", "", "crash", _where_ours(), "", "", 0.0, 0, 0)]


@dataclass(slots=True)
class _Project:
    """A project that is ready to run; with assumed data it is linked once more when that is first needed."""

    name: str
    read: ReadProgram
    linked: LinkedProgram
    robot: str
    max_time: float
    seconds: float
    with_data: LinkedProgram | None = None
    outside: dict[int, Outside] = field(default_factory=dict)

    def outcome(self, one: Program) -> Outcome:
        """As it is; and with assumed data where it lacks data."""
        done = self.on_some_arm(self.linked, one)
        if done.kind != "unknown data":
            return done
        if self.with_data is None:
            self.with_data = at_any_depth(lambda: link(self.linked.program, True))
        again = self.on_some_arm(self.with_data, one)
        kind, what, place = again.kind, again.what, again.place
        again = replace(again, assumed_kind=kind, assumed_what=what, assumed_place=place)
        return replace(again, kind=done.kind, what=done.what, place=done.place)

    def on_some_arm(self, linked: LinkedProgram, one: Program) -> Outcome:
        """On the arm that the backup names; where none is named without one, and on one of the maker's where the
        program asks for places or joints: `robot` then says that it is a guess."""
        done = self.run(linked, one, self.robot)
        if self.robot or not _ASKS_FOR_AN_ARM.search(done.what):
            return done
        first: Outcome | None = None
        for guess in _guesses(done.language):
            again = replace(self.run(linked, one, guess), robot=f"{guess} (a guess)")
            if not _OF_THE_ARM.search(f"{again.kind} {again.what}"):
                return again
            first = first or again
        return done if first is None else replace(done, kind="needs an arm", what=f"{done.what}; {first.what}")

    def run(self, linked: LinkedProgram, one: Program, robot: str) -> Outcome:
        limits = replace(DEFAULTS, time_s=self.max_time, statements=_MOST_STATEMENTS)
        said = Outcome(self.name, _language(self.read, one), one.name, "", "", one.place, robot, 0.0, one.moves, 0)
        said = replace(said, program=one.place)

        def run() -> RunResult:
            simulation = Simulation(linked.program, robot or None, None, one.name, limits=limits, linked=linked)
            try:
                simulation.run()
            except KeyboardInterrupt:
                raise simulation.interrupted() from None
            return simulation.result()

        signal.signal(signal.SIGALRM, _end)
        signal.setitimer(signal.ITIMER_REAL, self.seconds)
        try:
            result = at_any_depth(run)
        except RunInterrupted as stopped:
            kind, what = _of_limit(stopped.result)
            return replace(_ended(said, stopped.result), kind=kind if kind != "limit" else "too slow", what=what)
        except _TooSlow:
            return replace(said, kind="too slow", what="before it began")
        except RplError as error:
            return replace(said, kind="refused", what=str(error))
        except Exception:  # noqa: BLE001 (a traceback of ours is what this counts)
            return replace(said, kind="crash", what=_where_ours())
        finally:
            signal.setitimer(signal.ITIMER_REAL, 0.0)
        kind, what = classified(result, self.outside_of(linked))
        return replace(_ended(said, result), kind=kind, what=what)

    def outside_of(self, linked: LinkedProgram) -> Outside:
        """What can only come from outside, for a linked program."""
        if id(linked) not in self.outside:
            self.outside[id(linked)] = Outside(linked.program)
        return self.outside[id(linked)]


@cache
def _guesses(language: str) -> tuple[str, ...]:
    """The six-axis arms of the language's maker, the one that reaches farthest first."""
    title = registry.dialect(language).title.lower() if language in registry.dialect_names() else ""
    arms = [one for one in robot_summaries() if one.maker.lower() in title and one.axes == 6 and one.reach_mm]
    return tuple(one.name for one in sorted(arms, key=lambda one: (-(one.reach_mm or 0.0), one.name)))


def _shortened(one: Outcome) -> Outcome:
    return replace(one, what=one.what[:_SHOWN], assumed_what=one.assumed_what[:_SHOWN])


def _end(number: int, frame: FrameType | None) -> None:
    raise _TooSlow


def _ended(said: Outcome, result: RunResult) -> Outcome:
    origin = result.fault.origin if result.fault is not None else None
    place = f"{PurePath(origin.file).name}:{origin.line}" if origin is not None and origin.source else said.place
    said = replace(said, place=place, time_s=result.time_s, moves=result.moves, statements=result.statements)
    given = result.assumed or ()
    data = "; ".join(f"{one.name} = {one.shown} ({place_of(one.origin)})" for one in given)
    return replace(said, assumed=len(given), assumed_data=data)


def _language(read: ReadProgram, one: Program) -> str:
    for module in read.reduced.modules:
        if module.name == one.module and module.task == one.task:
            return module.dialect
    return " and ".join(read.dialects)


def _where_ours() -> str:
    kind, error, trace = sys.exc_info()
    last = traceback.extract_tb(trace)[-1]
    return f"{kind.__name__ if kind else ''}: {error} ({PurePath(last.filename).name}:{last.lineno})"[:160]


# ---- how it ended


def classified(result: RunResult, outside: Outside) -> tuple[str, str]:
    """The class of a run, and what it is about."""
    fault = result.fault
    if result.status in ("finished", "stopped"):
        return "end", result.status
    assert fault is not None  # every other end has its reason
    if result.status == "deadlock":
        return _of_deadlock(result, outside)
    if result.status == "limit" or fault.code == "no-time":
        return _of_limit(result, outside)
    text = fault.message
    named = text.partition("routine ")[2].partition(" ")[0]
    known = {
        "unknown-routine": ("unknown routine", named),
        "unknown-function": ("unknown routine", named),
        "no-value": ("unknown data", text),
        "unknown-data": ("unknown data", text.partition(" ")[0]),
        "vendor": _of_vendor(text),
        "opaque": ("unreadable", text),
        "unreachable": ("out of reach", text),
    }
    return known.get(fault.code, ("other fault", f"{fault.code}: {text}"))


def _of_vendor(text: str) -> tuple[str, str]:
    """A statement or function that only the controller has: a call is named, anything else is not known."""
    said = text.removeprefix("nothing says what this stands for: ").removeprefix("nothing says what ")
    found = _CALLED.match(said.lstrip("(").removeprefix("call "))
    if found and ":" in found[1]:  # of a library that is not there
        return "unknown routine", found[1]
    return ("routine of the controller", found[1]) if found else ("unknown statement", text)


def _of_deadlock(result: RunResult, outside: Outside) -> tuple[str, str]:
    """Who waits for what for good."""
    for one in result.awaited:
        if one.inputs and one.kind in ("condition", ""):
            return "waits for input", one.inputs[0][0]
    for one in result.awaited:
        if one.kind in ("condition", "") and (names := outside.names(one.origin)):
            return "waits for what is outside", ", ".join(names)
    if any(one.kind == "answer" for one in result.awaited):
        return "waits for the operator", next(one.subject for one in result.awaited if one.kind == "answer")
    return "waits for something else", result.fault.message[:120] if result.fault is not None else ""


def _of_limit(result: RunResult, outside: Outside | None = None) -> tuple[str, str]:
    """A run without an end: one that polls an input, and has done nothing else for long, waits for it."""
    done = max((event.t for event in result.trace if event.kind in ("move", "output")), default=0.0)
    for one in result.awaited:
        asked = [name for name, moment in one.inputs if moment >= done and moment >= result.time_s * _IDLE_SHARE]
        if asked and done <= result.time_s * _IDLE_SHARE:
            return "waits for input", asked[0]
    for one in result.awaited:
        if outside is not None and done <= result.time_s * _IDLE_SHARE:
            if inputs := outside.inputs(one.origin):
                return "waits for input", ", ".join(inputs)
            if names := outside.names(one.origin):
                return "waits for what is outside", ", ".join(names)
    if _comes_round(result):
        timed = any(one.timed_out and one.end >= result.time_s * _IDLE_SHARE for one in result.waited)
        asked = [name for one in result.awaited for name, moment in one.inputs if moment >= result.time_s * _LATE_SHARE]
        return ("waits for input", ", ".join(asked)) if timed and asked else ("loops", "")
    text = result.fault.message[:120] if result.fault is not None else ""
    return "limit", text


def _comes_round(result: RunResult) -> bool:
    """Did the second half of the run come to nothing but places that it had been at before?"""
    half = len(result.trace) // 2
    if half < _LEAST_EVENTS:
        return False
    early = {(event.origin.file, event.origin.start) for event in result.trace[:half]}
    return all((event.origin.file, event.origin.start) in early for event in result.trace[half:] if event.kind != "end")


# ---- the table


def table(outcomes: Sequence[Outcome]) -> Iterator[str]:
    """Counts by class and language, and both shares."""
    languages = sorted({one.language for one in outcomes})
    counts = Counter((one.in_the_end(), one.language) for one in outcomes)
    classes = (*CLASSES[:-1], *(kind + ASSUMED for kind in CLASSES), NO_ENTRY)
    width = max(len(name) for name in classes) + 2

    def row(title: str, cells: Iterable[str]) -> str:
        return title.ljust(width) + "".join(cell.rjust(10) for cell in cells)

    yield row("", (name[:9] for name in (*languages, "all")))
    for kind in classes:
        found = [counts[kind, language] for language in languages]
        if any(found):
            yield row(kind, map(str, (*found, sum(found))))
    groups = [*([one for one in outcomes if one.language == each] for each in languages), outcomes]
    yield row("entries", (str(len(_entries(group))) for group in groups))
    yield row("counted as they are", (str(sum(one.kind in COUNTED for one in group)) for group in groups))
    yield row("counted with assumed data", (str(sum(one.counts for one in group)) for group in groups))
    yield row("share as they are, %", (f"{share(group):.1f}" for group in groups))
    yield row("share with assumed data, %", (f"{share(group, True):.1f}" for group in groups))
    guessed = sum(one.robot.endswith("(a guess)") for one in outcomes)
    named = sum(bool(one.robot) for one in outcomes) - guessed
    yield f"on the arm that the backup names {named}, on a guessed one {guessed}, without an arm the others"
    needed = [one.assumed for one in outcomes if one.assumed]
    yield f"{len(needed)} programs with assumed data, {sum(needed)} data in all, at most {max(needed, default=0)}"
    kept = [one for one in outcomes if one.zeros]
    ran = sum(one.counts for one in kept)
    yield f"{len(kept)} programs ({ran} of those counted) may read registers that no file gives: they begin at zero"


def share(outcomes: Sequence[Outcome], assumed: bool = False) -> float:
    """Of the entries that count, percent. assumed: with assumed data."""
    entries = _entries(outcomes)
    return 100.0 * sum(one.counts if assumed else one.kind in COUNTED for one in entries) / max(len(entries), 1)


def _entries(outcomes: Iterable[Outcome]) -> list[Outcome]:
    return [one for one in outcomes if one.kind != NO_ENTRY]


def without_copies(outcomes: Iterable[Outcome]) -> list[Outcome]:
    """Each program once: one of the same name whose file is the same, byte for byte, is left out."""
    seen: dict[object, Outcome] = {}
    for number, one in enumerate(outcomes):
        seen.setdefault((one.language, one.entry, one.digest) if one.digest else number, one)
    return list(seen.values())


def causes(outcomes: Iterable[Outcome], top: int) -> Iterator[str]:
    """What stops programs, by how many it stops."""
    found = Counter(_ending(one)[:2] for one in outcomes if not one.counts)
    for (kind, what), times in found.most_common(top):
        yield f"{times:5} {kind}: {what}"


def failures(outcomes: Iterable[Outcome]) -> Iterator[str]:
    for one in outcomes:
        if not one.counts:
            kind, what, place = _ending(one)
            yield f"{one.project}: {one.entry}: {kind}: {what} at {place}"


def _ending(one: Outcome) -> tuple[str, str, str]:
    """How it ended in the end: class, what and place."""
    if one.assumed_kind:
        return one.in_the_end(), one.assumed_what, one.assumed_place
    return one.kind, one.what, one.place


class _Rows:
    """The CSV file, whose rows are there as soon as a project is done."""

    def __init__(self, path: Path | None) -> None:
        self.path, self.names = path, list(Outcome.__dataclass_fields__)
        if path is not None:
            path.write_text(",".join(self.names) + "\n", "utf-8")

    def add(self, outcomes: Iterable[Outcome]) -> None:
        if self.path is not None:
            with self.path.open("a", newline="", encoding="utf-8") as file:
                csv.DictWriter(file, self.names).writerows(asdict(one) for one in outcomes)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("folders", nargs="+", type=Path)
    parser.add_argument("--jobs", type=int, default=1)
    parser.add_argument("--csv", type=Path)
    parser.add_argument("--json", type=Path)
    parser.add_argument("--max-time", type=float, default=3600.0, help="simulated seconds of a run")
    parser.add_argument("--seconds", type=float, default=20.0, help="seconds of computing of a run")
    parser.add_argument("--top", type=int, default=40)
    options = parser.parse_args()
    tasks = [
        (name, paths, options.max_time, options.seconds)
        for folder in options.folders
        for name, paths in projects(folder)
    ]
    outcomes: list[Outcome] = []
    begun = time.monotonic()
    rows = _Rows(options.csv)
    with multiprocessing.get_context("spawn").Pool(options.jobs) as pool:
        for number, done in enumerate(pool.imap(measure, tasks), 1):
            outcomes += done
            rows.add(done)
            print(f"{number}/{len(tasks)} projects, {len(outcomes)} programs", end="\r", file=sys.stderr)
    copies = len(outcomes)
    outcomes = without_copies(outcomes)
    for line in (*table(outcomes), *causes(outcomes, options.top), *failures(outcomes)):
        print(line)
    print(f"{copies - len(outcomes)} copies of programs are left out")
    print(f"{len(tasks)} projects in {time.monotonic() - begun:.0f} s")
    if options.json is not None:
        options.json.write_text(json.dumps([asdict(one) for one in outcomes], indent=1, ensure_ascii=False), "utf-8")


if __name__ == "__main__":
    main()

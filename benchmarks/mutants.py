"""Tests the proof by mutants: programs with one change, which it must not call equal.

    python benchmarks/mutants.py [--write] [--seconds 600] [--per-operator N] [--only SAMPLE] [--across] [--seed 14]

Within one controller a sample is compared with its mutants; across two, a sample with what is read back of its
translation, with the change in either. A mutant is told when the verdict is another one than without the change, or
names other measures. A mutant whose statement the run did not reach is not run; one whose run is the same to the last
bit (every event with its moment, every move with its way, speeds, loads and joints) is counted apart: with these inputs
nothing of it can be seen. `--write` puts the table into docs/proof.md.
"""

from __future__ import annotations

import argparse
import json
import random
import time
import tomllib
from collections import Counter, defaultdict
from collections.abc import Iterable, Iterator
from concurrent.futures import ProcessPoolExecutor
from dataclasses import asdict, dataclass, field, replace
from pathlib import Path

import numpy as np
from mutation_operators import Mutant, mutants
from mutation_sites import replaced

from rpl import ir, registry
from rpl.cell import Cell
from rpl.diagnostics import Diagnostics
from rpl.emulator.model import RobotModel, load_robot
from rpl.errors import RplError
from rpl.project import ReadProgram, read_program, read_sources
from rpl.proof.paths import turn_deg
from rpl.proof.prove import load_cell, prove_recorded
from rpl.proof.record import Record
from rpl.proof.recording import record_of
from rpl.proof.unreached import key_of
from rpl.proof.verdict import UNDECIDED, ProofResult
from rpl.proof.wiring import in_words_of, with_signal_names
from rpl.runtime.limits import Limits
from rpl.runtime.trace import Event, RunResult
from rpl.simulation import entry_name, run_program
from rpl.source import source_from_bytes
from rpl.translation import translate_program

ROOT = Path(__file__).parents[1]
PAGE = ROOT / "docs" / "proof.md"
BEGIN, END = "<!-- mutants: generated -->", "<!-- mutants: end -->"
SEED = 14
_NO_TURN_DEG, _NO_WAY = 0.1, 1e-3

TOLD, SURVIVED, UNREACHED, SAME_RUN, NO_PROGRAM = "told", "survived", "not reached", "same run", "no program"


@dataclass(frozen=True, slots=True)
class Outcome:
    """What became of one mutant. pair: `sample` or `sample -> target`; side: which of the two is changed."""

    pair: str
    side: str
    operator: str
    place: str
    result: str
    change: str = ""


@dataclass(frozen=True, slots=True)
class Drawn:
    """Which mutants are chosen: by a seed, at most so many of each operator in one program."""

    seed: int = SEED
    per_operator: int | None = None


@dataclass(slots=True)
class Side:
    """One of two programs of a proof, with what is needed to run it and what its run has shown."""

    program: ir.Program
    robot: RobotModel
    cell: Cell | None
    entry: str | None
    result: RunResult = field(init=False)
    record: Record = field(init=False)

    def __post_init__(self) -> None:
        self.result, self.record = self.run(self.program)

    def run(self, program: ir.Program, limits: Limits | None = None) -> tuple[RunResult, Record]:
        """A run as proofs make it."""
        given = {} if limits is None else {"limits": limits}
        result = run_program(program, self.robot, self.cell, self.entry, controller="plain", **given)
        return result, record_of(result, program, self.robot)

    def limits(self) -> Limits:
        """How much a mutant may do: a few times what the program does."""
        done = self.result
        events = 4 * len(done.trace) + 500
        return Limits(3.0 * done.time_s + 30.0, 4 * done.statements + 20_000, 4 * done.statements + 20_000, events)


@dataclass(frozen=True, slots=True)
class Sample:
    """A sample program with its surroundings."""

    name: str
    language: str
    program: ReadProgram
    robot: RobotModel
    cell: Cell | None
    entry: str | None

    def side(self) -> Side:
        program = self.program.program
        return Side(program, self.robot, self.cell, entry_name(program, self.entry))


def sample_of(folder: Path) -> Sample:
    """The sample in a folder, by its expected.toml."""
    data = tomllib.loads((folder / "expected.toml").read_text("utf-8"))
    cell = load_cell(str(folder / data["cell"])) if "cell" in data else None
    read = read_program([folder], None, Diagnostics())
    name = f"{folder.parent.name}/{folder.name}"
    return Sample(name, folder.parent.name, read, load_robot(data["robot"]), cell, data.get("entry"))


def translated(sample: Sample, target: str) -> Side:
    """What is read back of a sample in another language."""
    cell, read = sample.cell, sample.program
    given, around, levels = (cell.variables, cell.mechanisms, cell.analog) if cell is not None else (None, (), ())
    made = translate_program(
        read,
        target,
        sample.robot.name,
        None,
        Diagnostics(),
        given=given,
        mechanisms=around,
        analog=levels,
    )
    back = read_sources([source_from_bytes(file.path, file.data) for file in made.files], target, Diagnostics())
    named = with_signal_names(back.program, made.program)
    source = read.program
    entry = entry_name(source, sample.entry)
    theirs = in_words_of(cell, source, named) if cell is not None else None
    return Side(named, sample.robot, theirs, made.renamed.get(entry, entry) if entry else None)


class Reached:
    """Which statements and names of a program a run came to."""

    def __init__(self, program: ir.Program, result: RunResult) -> None:
        assert result.reached is not None
        self.came: dict[str, set[tuple[int, int]]] = defaultdict(set)
        self.known: dict[str, set[tuple[int, int]]] = defaultdict(set)
        for _, code in result.reached.linked.codes():
            for origin in code.origins:
                if origin.source is not None:
                    file, start, end, _action = key_of(origin)
                    self.known[file].add((start, end))
        for code, marks in result.reached.marks.items():
            for origin, mark in zip(code.origins, marks, strict=False):  # one mark more, for the end
                if mark and origin.source is not None:
                    self.came[origin.file].add((origin.start, origin.end))

    def holds(self, statement: ir.Statement) -> bool:
        """Did the run come to it, or to a part of it? What has no instructions of its own counts as reached."""
        origin = statement.origin
        if origin.source is None:
            return True
        known = [one for one in self.known[origin.file] if origin.start <= one[0] and one[1] <= origin.end]
        return not known or any(one in self.came[origin.file] for one in known)


def told(result: ProofResult, before: ProofResult) -> bool:
    """Does the verdict say that something is not as it was without the change?"""
    if result.difference is not None or (result.verdict == UNDECIDED) != (before.verdict == UNDECIDED):
        return True
    return _measures(result) != _measures(before)


def _measures(result: ProofResult) -> Counter[tuple[object, ...]]:
    return Counter((one.kind, one.task, one.a.place, one.b.place, round(one.amount, 4)) for one in result.deviations)


def shown(result: RunResult) -> tuple[object, ...]:
    """All that a run shows from outside, to the last bit."""
    events = [_event(event) for event in result.trace if event.kind not in ("call", "input") and not _idle(event)]
    return (result.status, result.time_s, result.joints, *events)


def _idle(event: Event) -> bool:
    """A move to where the robot and its external axes are."""
    if event.kind != "move" or not event.legs:
        return False
    for leg in event.legs:
        way = leg.plan.geometry.tcp(np.linspace(0.0, 1.0, 5))
        axes = leg.plan.start_joints - leg.plan.end_joints, leg.plan.external_start - leg.plan.external_end
        if np.abs(way - way[:1]).max() > _NO_WAY or any(np.abs(one).max(initial=0.0) > _NO_WAY for one in axes):
            return False
    return True


def _event(event: Event) -> tuple[object, ...]:
    """Corners at which the robot stops all the same, turning speeds of moves that do not turn, and the axes of loads
    without inertia mean nothing."""
    ways = [leg.plan.geometry.tcp(np.linspace(0.0, 1.0, 5)) for leg in event.legs]
    legs = tuple(
        (leg.start_s, leg.duration_s, leg.offset_s, way.tobytes()) for leg, way in zip(event.legs, ways, strict=True)
    )
    turns = any(turn_deg(way[:1, :3, :3], way[1:, :3, :3]).max() > _NO_TURN_DEG for way in ways)
    idle = {"corner_mm"} if event.stops else set()
    idle |= set() if turns else {"turning_deg_s", "rate"}
    asked = event.programmed
    said = () if asked is None else tuple(_plain(getattr(asked, name)) for name in asked.__slots__ if name not in idle)
    loads = tuple(
        (load.mass, load.frame.position, load.inertias, load.frame if any(load.inertias) else None)
        for load in event.payloads
    )
    blend = "" if event.stops else event.blend
    what = repr(event.data), repr(event.port), event.names, event.stops, blend, event.timed
    return event.t, event.task, event.kind, what, legs, said, repr(loads)


def _plain(value: object) -> object:
    return value.tobytes() if isinstance(value, np.ndarray) else repr(value)


# ---- one pair


def chosen(program: ir.Program, name: str, drawn: Drawn) -> list[Mutant]:
    """Mutants of a program, the operators in turn; at most so many of each operator, by a seeded choice."""
    by_operator: dict[str, list[Mutant]] = defaultdict(list)
    for mutant in mutants(program):
        by_operator[mutant.operator].append(mutant)
    for operator, many in by_operator.items():
        random.Random(f"{drawn.seed} {name} {operator}").shuffle(many)
        del many[drawn.per_operator if drawn.per_operator is not None else len(many) :]
    rows = list(by_operator.values())
    return [row[turn] for turn in range(max(map(len, rows), default=0)) for row in rows if turn < len(row)]


def results_of(sides: tuple[Side, Side], changed: int, pair: str, drawn: Drawn, until: float) -> Iterator[Outcome]:
    """The mutants of one of two programs, compared with the other one as it is."""
    a, b = sides
    before = prove_recorded(a.record, b.record, a.program, b.program)
    side = sides[changed]
    reached, limits = Reached(side.program, side.result), side.limits()
    as_it_was = shown(side.result)
    word = ("source", "translation")[changed] if "->" in pair else "program"
    for mutant in chosen(side.program, f"{pair} {word}", drawn):
        if time.monotonic() > until:
            return
        said = Outcome(pair, word, mutant.operator, mutant.site.place, UNREACHED, _change(mutant))
        if mutant.needs and not all(reached.holds(one) for one in mutant.needs):
            yield said
            continue
        try:
            program = replaced(side.program, mutant.path, mutant.value)
            result, record = side.run(program, limits)
        except Exception as error:  # noqa: BLE001 (whatever cannot be linked or run is no program)
            yield replace(said, result=NO_PROGRAM, change=f"{said.change} ({type(error).__name__}: {error})")
            continue
        records = (a.record, record) if changed else (record, b.record)
        programs = (a.program, program) if changed else (program, b.program)
        if told(prove_recorded(*records, *programs), before):
            yield replace(said, result=TOLD)
        else:
            yield replace(said, result=SAME_RUN if shown(result) == as_it_was else SURVIVED)


def _change(mutant: Mutant) -> str:
    text = next((one.origin.text for one in mutant.needs if one.origin.source is not None), mutant.site.origin.text)
    return " ".join(text.split())[:70]


def job(folder: str, target: str | None, drawn: Drawn, seconds: float) -> list[Outcome]:
    """All outcomes of a sample within its controller, or of its translation."""
    sample = sample_of(Path(folder))
    source = sample.side()
    if target is None:
        until = time.monotonic() + seconds
        return list(results_of((source, source), 1, sample.name, drawn, until))
    try:
        other = translated(sample, target)
    except RplError:
        return []
    before = prove_recorded(source.record, other.record, source.program, other.program)
    if before.difference is not None or before.verdict == UNDECIDED:
        return []
    pair, found = f"{sample.name} -> {target}", []
    for changed in (0, 1):
        until = time.monotonic() + seconds / 2.0
        found += results_of((source, other), changed, pair, drawn, until)
    return found


def jobs(only: str, targets: int, across: bool) -> Iterator[tuple[str, str | None]]:
    """Every sample by itself (unless only proofs `across` controllers are asked for), and with some of the other
    languages in turn, so that all pairs of languages come."""
    names = [name for name in registry.target_names() if name != "rpl"]
    folders = sorted(path.parent for path in (ROOT / "samples").glob("*/*/expected.toml"))
    kept = [folder for folder in folders if only in f"{folder.parent.name}/{folder.name}"]
    if not across:
        yield from ((str(folder), None) for folder in kept)
    for number, folder in enumerate(kept):
        others = [name for name in names if name != folder.parent.name]
        for turn in range(targets):
            yield str(folder), others[(number + 2 * turn) % len(others)]


# ---- the table


def rate(outcomes: Iterable[Outcome]) -> tuple[int, int, float]:
    """How many were told, how many survived, and the share of the first, %."""
    counts = Counter(one.result for one in outcomes)
    of = counts[TOLD] + counts[SURVIVED]
    return counts[TOLD], counts[SURVIVED], 100.0 * counts[TOLD] / of if of else 100.0


def section(outcomes: list[Outcome]) -> str:
    """The part of docs/proof.md that is made of a run."""
    within = [one for one in outcomes if "->" not in one.pair]
    across = [one for one in outcomes if "->" in one.pair]
    lines = [BEGIN, ""]
    for word, group in (("Within one controller", within), ("Across two controllers", across)):
        count, left, percent = rate(group)
        counts = Counter(one.result for one in group)
        lines.append(
            f"{word}: {len(group)} mutants in {len({one.pair for one in group})} proofs. {counts[UNREACHED]} change"
            f" what the run did not reach, {counts[SAME_RUN]} leave the run the same to the last bit,"
            f" {counts[NO_PROGRAM]} cannot be run. Of the other {count + left} the proof tells {count},"
            f" **{_percent(percent)}**."
        )
        lines.append("")
    lines += [
        "| change | mutants | told | survive | rate | across: mutants | told | survive | rate |",
        "|---" * 9 + "|",
    ]
    for operator in sorted({one.operator for one in outcomes}):
        cells = []
        for group in (within, across):
            mine = [one for one in group if one.operator == operator]
            count, left, percent = rate(mine)
            cells += [str(len(mine)), str(count), str(left), _percent(percent) if count + left else "-"]
        lines.append(f"| {operator} | " + " | ".join(cells) + " |")
    return "\n".join(
        [
            *lines,
            *_survivors("Survivors within one controller:", within),
            *_survivors("Survivors across two controllers (T: changed in the translation):", across),
            "",
            END,
        ]
    )


def _survivors(title: str, outcomes: list[Outcome]) -> list[str]:
    """A line for each operator and pair, with the places."""
    found: dict[str, dict[str, set[str]]] = defaultdict(lambda: defaultdict(set))
    for one in outcomes:
        if one.result == SURVIVED:
            found[one.operator][one.pair].add(one.place + (" T" if one.side == "translation" else ""))
    lines = ["", title, ""]
    for operator, pairs in sorted(found.items()):
        told = [f"{pair} ({', '.join(sorted(many))})" for pair, many in sorted(pairs.items())]
        lines.append(f"- {operator}: {'; '.join(told)}")
    return lines


def _percent(share: float) -> str:
    """Never rounded up."""
    return f"{int(share * 10) / 10:g} %"


def write(outcomes: list[Outcome]) -> None:
    """Put the section into the page in place of the one that is there."""
    text = PAGE.read_text("utf-8")
    before, _, rest = text.partition(BEGIN)
    PAGE.write_text(before + section(outcomes) + rest.partition(END)[2], "utf-8")


def run(given: argparse.Namespace) -> list[Outcome]:
    """All outcomes, sample by sample; each pair has the same share of the time."""
    todo = list(jobs(given.only, given.targets, given.across))
    share = given.seconds / max(len(todo), 1)
    outcomes: list[Outcome] = []
    drawn = Drawn(given.seed, given.per_operator)
    with ProcessPoolExecutor(given.processes) as pool:
        running = [pool.submit(job, folder, target, drawn, share) for folder, target in todo]
        for future, (folder, target) in zip(running, todo, strict=True):
            found = future.result()
            outcomes += found
            count, left, _ = rate(found)
            print(f"{folder} {target or ''}: {len(found)} mutants, {count} told, {left} survive", flush=True)
            if given.json is not None:
                given.json.write_text(json.dumps([asdict(one) for one in outcomes], indent=0), "utf-8")
    return outcomes


def read_outcomes(path: Path) -> list[Outcome]:
    """What an earlier run has written with --json."""
    return [Outcome(**one) for one in json.loads(path.read_text("utf-8"))]


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--seconds", type=float, default=600.0, help="of all processes together, about")
    parser.add_argument("--per-operator", type=int, help="mutants of one operator in one program, at most")
    parser.add_argument("--only", default="", help="samples whose language/name holds this")
    parser.add_argument("--targets", type=int, default=2, help="other languages that each sample is compared in")
    parser.add_argument("--across", action="store_true", help="only proofs across two controllers")
    parser.add_argument("--seed", type=int, default=SEED, help="of the choice of mutants")
    parser.add_argument("--processes", type=int, default=2)
    parser.add_argument("--json", type=Path, help="write every outcome there")
    parser.add_argument("--of", type=Path, help="run nothing: make the table of outcomes that --json wrote")
    parser.add_argument("--write", action="store_true", help="put the table into docs/proof.md")
    given = parser.parse_args()
    outcomes = read_outcomes(given.of) if given.of is not None else run(given)
    if given.write:
        write(outcomes)
    else:
        print(section(outcomes))


if __name__ == "__main__":
    main()

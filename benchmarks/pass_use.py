"""Which passes act: how often each changed or reported something, for which target, over any folder of programs.

    python benchmarks/pass_use.py FOLDER... [--to TARGET ...] [--projects] [--robot R] [--csv FILE]
        [--limit SECONDS] [--most N]

Each file is translated by itself; with --projects each folder that holds programs is one project. --limit gives up a
program whose translations take longer; --most takes an even choice of so many (of each suffix, or of all projects).
A pass has acted when the program behind it is another one (comments and places of origin apart), or when it has
reported something. Passes that never act on real programs are the first to ask whether they earn their lines.
"""

from __future__ import annotations

import argparse
import csv
import os
import signal
import sys
from collections import Counter, defaultdict
from collections.abc import Iterator, Sequence
from concurrent.futures import ProcessPoolExecutor
from dataclasses import dataclass, field, replace
from pathlib import Path

from rpl import ir, registry
from rpl.diagnostics import Diagnostics
from rpl.errors import RplError
from rpl.passes.legalise import pipeline
from rpl.passes.legalise.context import Context
from rpl.passes.legalise.stages import Pass
from rpl.project import read_program
from rpl.translation import translate_program

_LARGEST = 500_000  # bytes of a file


@dataclass
class Use:
    """Of one program in all its targets. acted: (pass, target) of those that changed or reported something."""

    acted: Counter[tuple[str, str]] = field(default_factory=Counter)
    translations: int = 0
    failed: list[str] = field(default_factory=list)


def name_of(one: Pass) -> str:
    """`module.function` of a pass."""
    return f"{one.run.__module__.rpartition('.')[2]}.{one.name}"


def watched(one: Pass, acted: set[str]) -> Pass:
    """The pass, which says by its name when it has acted."""

    named = name_of(one)

    def run(program: ir.Program, context: Context) -> ir.Program:
        told = len(context.diagnostics)
        after = one.run(program, context)
        if len(context.diagnostics) != told or (after is not program and after != program):
            acted.add(named)
        return after

    return replace(one, run=run)


def use_in_time(job: tuple[tuple[Path, ...], tuple[str, ...], str | None], limit: float) -> Use:
    """`use_of`, given up after so many seconds (0: never)."""

    def late(*_: object) -> None:
        raise TimeoutError

    signal.signal(signal.SIGALRM, late)
    signal.setitimer(signal.ITIMER_REAL, limit)
    found = Use()
    try:
        use_of(job, found)
    except TimeoutError:
        found.failed.append(f"{job[0][0]}: longer than {limit:g} s")
    finally:
        signal.setitimer(signal.ITIMER_REAL, 0)
    return found


def use_of(job: tuple[tuple[Path, ...], tuple[str, ...], str | None], found: Use) -> None:
    """Translate one program into the targets and see which passes act."""
    paths, targets, robot = job
    acted = set[str]()
    try:
        read = read_program(list(paths), None, Diagnostics())
    except RplError as error:
        found.failed.append(f"{paths[0]}: {error}")
        return
    if not read.files:
        return
    plain = pipeline.passes_with
    pipeline.passes_with = lambda own: tuple(watched(one, acted) for one in plain(own))
    try:
        for target in targets:
            if target in read.dialects:
                continue
            acted.clear()
            try:
                translate_program(read, target, robot, None, Diagnostics())
            except RplError as error:
                found.failed.append(f"{paths[0]} -> {target}: {error}")
                continue
            found.translations += 1
            found.acted.update((name, target) for name in acted)
    finally:
        pipeline.passes_with = plain


def even(paths: Sequence[Path], most: int) -> Sequence[Path]:
    """So many of them, at even distances; 0: all."""
    return paths if not 0 < most < len(paths) else [paths[n * len(paths) // most] for n in range(most)]


def programs(folders: Sequence[Path], projects: bool, most: int) -> Iterator[tuple[Path, ...]]:
    """Files, or folders of files, that any dialect reads by their suffix."""
    suffixes = {end for name in registry.dialect_names() for end in registry.dialect(name).extensions}
    files = [one for folder in folders for one in ([folder] if folder.is_file() else sorted(folder.rglob("*")))]
    by_suffix = defaultdict[str, list[Path]](list)
    for path in files:
        if path.suffix.lower() in suffixes and path.is_file() and path.stat().st_size <= _LARGEST:
            by_suffix[path.suffix.lower()].append(path)
    if projects:
        parents = {path.parent for found in by_suffix.values() for path in found}
        yield from ((parent,) for parent in even(sorted(parents), most))
    else:
        yield from ((path,) for _, found in sorted(by_suffix.items()) for path in even(found, most))


def rows_of(uses: Sequence[Use], targets: Sequence[str]) -> list[tuple[str, int, dict[str, int]]]:
    """Per pass in the order of the pipeline: its name, in how many translations it acted, and that by target."""
    total: Counter[tuple[str, str]] = Counter()
    for use in uses:
        total.update(use.acted)
    every = tuple(one for name in registry.target_names() for one in registry.target(name).passes())
    names = list(dict.fromkeys(map(name_of, pipeline.passes_with(every))))
    return [(name, sum(by.values()), by) for name in names for by in [{to: total[name, to] for to in targets}]]


def show(uses: Sequence[Use], targets: Sequence[str], file: str | None) -> None:
    rows = rows_of(uses, targets)
    width = max(len(name) for name, _, _ in rows)
    print(f"{'pass':<{width}} {'acted':>6} " + " ".join(f"{to:>9}" for to in targets))
    for name, count, by in rows:
        print(f"{name:<{width}} {count:>6} " + " ".join(f"{by[to] or '':>9}" for to in targets))
    idle = sum(1 for _, count, _ in rows if not count)
    failed = [text for use in uses for text in use.failed]
    print(f"{sum(use.translations for use in uses)} translations; {idle} of {len(rows)} passes never acted")
    print(*(f"failed: {text}" for text in failed), sep="\n", end="\n" if failed else "")
    if file is not None:
        with Path(file).open("w", encoding="utf-8", newline="") as out:
            table = csv.writer(out)
            table.writerow(("pass", "acted", *targets))
            table.writerows((name, count, *(by[to] for to in targets)) for name, count, by in rows)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("folders", nargs="+", type=Path)
    parser.add_argument("--to", action="append", choices=registry.target_names(), help="only these targets")
    parser.add_argument("--projects", action="store_true", help="a folder with programs is one project")
    parser.add_argument("--robot", help="the arm of all of them")
    parser.add_argument("--limit", type=float, default=0, metavar="SECONDS", help="give up a program behind it")
    parser.add_argument("--most", type=int, default=0, metavar="N", help="so many of each suffix, or projects")
    parser.add_argument("--csv", metavar="FILE", help="write the table there as well")
    options = parser.parse_args()
    targets = tuple(options.to or registry.target_names())
    jobs = [(paths, targets, options.robot) for paths in programs(options.folders, options.projects, options.most)]
    uses = []
    with ProcessPoolExecutor(min(2, os.cpu_count() or 1)) as pool:
        for number, use in enumerate(pool.map(use_in_time, jobs, [options.limit] * len(jobs)), 1):
            uses.append(use)
            print(f"\r{number} of {len(jobs)}", end="", file=sys.stderr, flush=True)
    print(file=sys.stderr)
    show(uses, targets, options.csv)


if __name__ == "__main__":
    main()

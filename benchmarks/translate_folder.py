"""How well a folder of programs translates: programs without a loss, losses by kind, what cannot be read back.

    python benchmarks/translate_folder.py FOLDER... [--to TARGET] [--robot R] [--to-robot R2] [--top 30]

Each file is translated by itself (a data list travels with its program) and what was written is read back.
"""

from __future__ import annotations

import argparse
from collections import Counter
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from pathlib import Path

from rpl import registry
from rpl.diagnostics import Diagnostics, Severity
from rpl.errors import RplError
from rpl.project import read_program, read_sources
from rpl.source import source_from_bytes
from rpl.translation import translate_program

_SUFFIXES = frozenset((".src", ".sub", ".mod", ".modx", ".prg", ".sys", ".rpl"))
_LARGEST = 500_000


@dataclass
class Tally:
    """One source language into one target."""

    programs: int = 0
    without_loss: int = 0
    failed: Counter[str] = field(default_factory=Counter)
    losses: Counter[str] = field(default_factory=Counter)
    unread: Counter[str] = field(default_factory=Counter)
    examples: dict[str, str] = field(default_factory=dict)


def programs(folders: Sequence[Path]) -> Iterator[Path]:
    for folder in folders:
        for path in sorted(folder.rglob("*")) if folder.is_dir() else [folder]:
            if path.suffix.lower() in _SUFFIXES and path.is_file() and path.stat().st_size <= _LARGEST:
                yield path


def measure(path: Path, target: str, robots: tuple[str | None, str | None], tallies: dict[str, Tally]) -> None:
    read = read_program([path], None, Diagnostics())
    if not read.files:
        return
    tally = tallies.setdefault(f"{read.dialects[0]} -> {target}", Tally())
    tally.programs += 1
    diagnostics = Diagnostics()
    try:
        translation = translate_program(read, target, *robots, diagnostics)
    except RplError as error:
        tally.failed[str(error)[:100]] += 1
        tally.examples.setdefault(str(error)[:100], str(path))
        return
    losses = diagnostics.of(Severity.LOSS)
    tally.without_loss += not losses
    for item in losses:
        tally.losses[item.message[:100]] += 1
        tally.examples.setdefault(item.message[:100], f"{item.origin.file}:{item.origin.line}: {item.origin.text[:80]}")
    again = Diagnostics()
    read_sources([source_from_bytes(file.path, file.data) for file in translation.files], target, again)
    for item in again.of(Severity.ERROR):
        tally.unread[item.message[:100]] += 1
        tally.examples.setdefault(item.message[:100], f"{path}: {item.origin.text[:80]}")


def show(name: str, tally: Tally, top: int) -> None:
    share = 100.0 * tally.without_loss / max(tally.programs, 1)
    print(f"{name}: {tally.programs} programs, {tally.without_loss} without a loss ({share:.1f} %)")
    for title, counter in (("failed", tally.failed), ("loss", tally.losses), ("not readable", tally.unread)):
        for text, times in counter.most_common(top):
            example = " ".join(tally.examples.get(text, "").split())
            print(f"  {times:6} {title}: {text}\n         {example[:140]}")


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("folders", nargs="+", type=Path)
    parser.add_argument("--to", choices=registry.target_names())
    parser.add_argument("--robot")
    parser.add_argument("--to-robot")
    parser.add_argument("--top", type=int, default=30)
    options = parser.parse_args()
    tallies: dict[str, Tally] = {}
    for path in programs(options.folders):
        for target in [options.to] if options.to else registry.target_names():
            measure(path, target, (options.robot, options.to_robot), tallies)
    for name, tally in sorted(tallies.items()):
        show(name, tally, options.top)


if __name__ == "__main__":
    main()

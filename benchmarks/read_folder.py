"""How well a folder of programs reads: files, statements, opaque ones, false errors, the most frequent unread shapes.

    python benchmarks/read_folder.py FOLDER... [--from DIALECT] [--top 20] [--json]

Each file that is recognised is read in the company of the other files of its folder, because they belong to one
project. A file is clean when it has no opaque statement and no error.
"""

from __future__ import annotations

import argparse
import json
import re
import sys
import time
from collections import Counter, defaultdict
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from pathlib import Path

from rpl import registry
from rpl.diagnostics import Diagnostics, Severity
from rpl.passes.typing import normalise
from rpl.project import recognise
from rpl.reading.ledger import FileReport
from rpl.source import Source, read_source

_SHAPE = re.compile(r'"[^"]*"|\'[^\']*\'|\d+(?:\.\d+)?(?:[eE][+-]?\d+)?|[A-Za-z_$][\w$]*')
_SUFFIXES = frozenset((".src", ".dat", ".sub", ".mod", ".modx", ".sys", ".sysx", ".prg", ".rpl"))


@dataclass
class Tally:
    """What one dialect's files came to."""

    files: int = 0
    clean: int = 0
    statements: int = 0
    opaque: int = 0
    seconds: float = 0.0
    codes: Counter[str] = field(default_factory=Counter)
    shapes: Counter[str] = field(default_factory=Counter)
    examples: dict[str, str] = field(default_factory=dict)
    messages: Counter[str] = field(default_factory=Counter)


def shape(text: str) -> str:
    """A statement with its numbers, texts and names (but for the first word) made equal."""
    words = 0

    def put(match: re.Match[str]) -> str:
        nonlocal words
        token = match.group()
        if token[0] in "\"'":
            return '""'
        if token[0].isdigit():
            return "0"
        words += 1
        return token.upper() if words == 1 else "x"

    return " ".join(_SHAPE.sub(put, text.strip()).split())[:100]


def projects(folders: Sequence[Path]) -> Iterator[tuple[Path, list[Source]]]:
    """The files of each folder, together."""
    by_folder: dict[Path, list[Source]] = defaultdict(list)
    for folder in folders:
        paths = sorted(folder.rglob("*")) if folder.is_dir() else [folder]
        for path in paths:
            if path.is_file() and path.suffix.lower() in _SUFFIXES:
                by_folder[path.parent].append(read_source(path))
    yield from by_folder.items()


def measure(folders: Sequence[Path], dialect: str | None, progress: bool) -> tuple[dict[str, Tally], int]:
    """Tally per dialect, and how many files were recognised as nothing."""
    tallies: dict[str, Tally] = defaultdict(Tally)
    refused = 0
    for folder, sources in projects(folders):
        groups: dict[str, list[Source]] = defaultdict(list)
        for source in sources:
            name = dialect or recognise(source)[0]
            if name is None:
                refused += 1
            else:
                groups[name].append(source)
        for name, group in groups.items():
            diagnostics = Diagnostics()
            started = time.perf_counter()
            result = registry.dialect(name).read(group, diagnostics)
            tallies[name].seconds += time.perf_counter() - started
            normalise(result.program, diagnostics)  # what makes no sense counts like what cannot be read
            count(tallies[name], result.files, diagnostics)
            if progress:
                print(f"\r{tallies[name].files} {name} files, {folder}"[:110].ljust(110), end="", file=sys.stderr)
    return tallies, refused


def count(tally: Tally, files: Sequence[FileReport], diagnostics: Diagnostics) -> None:
    """Add the reports of one project."""
    wrong: set[str] = set()
    for item in diagnostics:
        if item.severity == Severity.ERROR:
            wrong.add(item.origin.file)
            tally.codes[item.code.name] += 1
            tally.messages[f"{item.code.name}: {item.message}"[:120]] += 1
    for report in files:
        tally.files += 1
        tally.statements += report.statements
        tally.opaque += report.opaque
        tally.clean += report.opaque == 0 and report.path not in wrong
        for text in report.unread:
            key = shape(text)
            tally.shapes[key] += 1
            tally.examples.setdefault(key, f"{report.path}: {text.strip()[:100]}")


def as_json(tally: Tally, top: int) -> dict[str, object]:
    return {
        "files": tally.files,
        "clean": tally.clean,
        "statements": tally.statements,
        "opaque": tally.opaque,
        "seconds": round(tally.seconds, 3),
        "codes": dict(tally.codes.most_common()),
        "unread_shapes": [
            {"shape": key, "count": times, "example": tally.examples[key]}
            for key, times in tally.shapes.most_common(top)
        ],
    }


def show(name: str, tally: Tally, top: int) -> None:
    share = 100.0 * tally.clean / max(tally.files, 1)
    rate = tally.statements / max(tally.seconds, 1e-9)
    print(f"{name}: {tally.files} files, {tally.clean} clean ({share:.1f} %), {tally.statements} statements,")
    print(f"  {tally.opaque} opaque, {tally.seconds:.2f} s ({rate:,.0f} statements/s)")
    for code, times in tally.codes.most_common():
        print(f"  {times:6} {code}")
    for key, times in tally.shapes.most_common(top):
        print(f"  {times:6} unread  {key}\n                 {tally.examples[key]}")
    others = [(text, times) for text, times in tally.messages.most_common() if not text.startswith("unreadable")]
    for text, times in others[:top]:
        print(f"  {times:6} {text}")


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("folders", nargs="+", type=Path)
    parser.add_argument("--from", dest="dialect")
    parser.add_argument("--top", type=int, default=20)
    parser.add_argument("--json", action="store_true")
    options = parser.parse_args()
    tallies, refused = measure(options.folders, options.dialect, sys.stderr.isatty())
    if options.json:
        print(json.dumps({name: as_json(tally, options.top) for name, tally in tallies.items()}))
        return
    for name, tally in sorted(tallies.items()):
        show(name, tally, options.top)
    print(f"{refused} files were recognised as no language")


if __name__ == "__main__":
    main()

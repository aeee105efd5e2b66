"""How fast long programs are read and checked: mixed ones, lists of points, taught points by name.

    python benchmarks/read_speed.py [--lines 20000] [--from DIALECT] [--twice]

Processor time of one process for all that `rpl check` does with a text; beside it one pass of a regular expression over
the same text. `--twice`: also twice the lines, which take twice the time. Whole commands, their memory, Lark on the
whole file and sqlglot: point_programs.py.
"""

from __future__ import annotations

import argparse
import re
import time
from collections.abc import Callable, Iterator

from generate import GENERATORS, POINTS, TAUGHT

from rpl.diagnostics import Diagnostics
from rpl.project import read_program
from rpl.source import source_from_text

_WORD = re.compile(r"-?\d+(?:\.\d*)?|\w+|\S")


def cases(names: list[str] | None) -> Iterator[tuple[str, Callable[[int], str], str]]:
    """What is measured, what writes a text of so many lines, and the name of its file."""
    for kind, generators in (("mixed", GENERATORS), ("points", POINTS), ("taught", TAUGHT)):
        for name, (generate, path) in generators.items():
            if not names or name in names:
                yield f"{name} {kind}", generate, path


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--lines", type=int, default=20_000)
    parser.add_argument("--from", dest="names", action="append", choices=GENERATORS, help="only this language")
    parser.add_argument("--twice", action="store_true", help="also twice the lines")
    given = parser.parse_args()
    for what, generate, path in cases(given.names):
        read_program([source_from_text(path, generate(50))])  # imports and tables
        for lines in (given.lines, 2 * given.lines)[: 1 + given.twice]:
            measure(what, source_from_text(path, generate(lines)).text, path)


def measure(what: str, text: str, path: str) -> None:
    lines, diagnostics = text.count("\n"), Diagnostics()
    started = time.process_time()
    read = read_program([source_from_text(path, text)], diagnostics=diagnostics)
    taken = time.process_time() - started
    started = time.process_time()
    words = len(_WORD.findall(text))
    bare = time.process_time() - started
    statements = sum(report.statements for report in read.files)
    print(
        f"{what:16} {lines:>9,} lines {taken:7.2f} s {lines / taken:>9,.0f} lines/s;"
        f" {statements:,} statements, {len(diagnostics)} reports; a regular expression over its {words:,} words:"
        f" {lines / bare:,.0f} lines/s",
        flush=True,
    )


if __name__ == "__main__":
    main()

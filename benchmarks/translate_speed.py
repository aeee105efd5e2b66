"""How fast long lists of points are translated, and how much memory that takes.

    python benchmarks/translate_speed.py [--lines 32000 200000] [--from krl ...] [--to rapid tp ...] [--one-by-one]

Each measurement is a process of its own; its memory is what the translation adds at most to what reading took.
--one-by-one: without taking runs of moves by stretches, for comparison.
"""

from __future__ import annotations

import argparse
import resource
import subprocess
import sys
import time

from generate import POINTS

from rpl import translation
from rpl.diagnostics import Diagnostics
from rpl.passes.expanded import expanded
from rpl.project import read_program
from rpl.source import source_from_text


def measured(source: str, target: str, lines: int) -> str:
    make, name = POINTS[source]
    translation.translate_program(read_program([source_from_text(name, make(200))]), target)  # imports, tables
    text = source_from_text(name, make(lines))
    began = time.perf_counter()
    read = read_program([text])
    reading, before = time.perf_counter() - began, _most_memory()
    began, diagnostics = time.perf_counter(), Diagnostics()
    translation.translate_program(read, target, diagnostics=diagnostics)
    took = time.perf_counter() - began
    memory = (_most_memory() - before) / lines
    told = f"{len(diagnostics)} reports"
    rates = f"read {lines / reading:8.0f} lines/s, translated {lines / took:8.0f} lines/s"
    return f"{source:6} -> {target:9} {lines:7} lines: {rates}, {memory:5.0f} bytes a line, {told}"


def _most_memory() -> int:
    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss * 1024


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--lines", nargs="+", type=int, default=[32_000, 200_000])
    parser.add_argument("--from", dest="sources", nargs="+", default=["krl"], choices=sorted(POINTS))
    parser.add_argument("--to", nargs="+", default=["rapid", "tp"])
    parser.add_argument("--one-by-one", action="store_true")
    options = parser.parse_args()
    if len(options.lines) * len(options.sources) * len(options.to) == 1:
        if options.one_by_one:
            translation.with_stretches = lambda program, one_by_one: (expanded(program), ())
        print(measured(options.sources[0], options.to[0], options.lines[0]), flush=True)
        return
    for source in options.sources:
        for target in options.to:
            for lines in options.lines:
                alone = [sys.executable, __file__, "--lines", str(lines), "--from", source, "--to", target]
                subprocess.run(alone + ["--one-by-one"] * options.one_by_one, check=True)


if __name__ == "__main__":
    main()

"""How fast long programs read: generated ones of 20,000 lines, from text to normal form.

    python benchmarks/read_speed.py [--lines 20000] [--from DIALECT]

Processor time of one process; twice the lines take twice the time in every language. Lines read a second on two cores
that others used too, with Python 3.11: TP 48,000, KRL 27,000, INFORM 12,500, RPL 12,500, V+ 10,500, URScript 10,000,
RAPID 9,600; the normal form takes another tenth to half of that time.
"""

from __future__ import annotations

import argparse
import time

from generate import GENERATORS

from rpl import registry
from rpl.diagnostics import Diagnostics
from rpl.passes.collector import paused_cycle_collector
from rpl.passes.typing import normalise
from rpl.source import source_from_text


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--lines", type=int, default=20_000)
    parser.add_argument("--from", dest="names", action="append", choices=GENERATORS, help="only this language")
    given = parser.parse_args()
    lines: int = given.lines
    for name, (generate, path) in GENERATORS.items():
        if given.names and name not in given.names:
            continue
        source = source_from_text(path, generate(lines))
        registry.dialect(name).read([source_from_text(path, generate(50))], Diagnostics())  # imports and tables
        diagnostics = Diagnostics()
        with paused_cycle_collector():  # as in `rpl.project`
            started = time.process_time()
            result = registry.dialect(name).read([source], diagnostics)
            read = time.process_time()
            normalise(result.program, diagnostics)
            done = time.process_time()
        print(
            f"{name}: {lines} lines, read {read - started:.2f} s ({lines / (read - started):,.0f} lines/s),"
            f" normal form {done - read:.2f} s, {len(diagnostics)} reports"
        )
        for item in list(diagnostics)[:3]:
            print(f"  {item.as_text()}")


if __name__ == "__main__":
    main()

"""What bodies add to a run in which nothing touches: a program with and without its cell, and with the search.

    python benchmarks/cell_run.py [CELL.toml] [--times N]

Seconds of processor time, the least of N runs: the program alone on its arm with the inputs that the cell gave it, the
same among its bodies, and the search for collisions behind it. The default is the palletiser, whose moves are many.
"""

from __future__ import annotations

import argparse
import time
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

from rpl.cell import Input, read_cell
from rpl.cell.layout import Layout
from rpl.diagnostics import Diagnostics
from rpl.simulation import run_program
from rpl.workcell.collisions import find_collisions
from rpl.workcell.loading import robots_of
from rpl.workcell.running import run_cell

_DEFAULT = Path(__file__).parents[1] / "samples" / "cells" / "palletiser" / "cell.toml"


def least(times: int, run: Callable[[], object]) -> float:
    """Seconds of processor time of the quickest of some runs."""
    found = []
    for _ in range(times):
        begun = time.process_time()
        run()
        found.append(time.process_time() - begun)
    return min(found)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("cell", nargs="?", type=Path, default=_DEFAULT)
    parser.add_argument("--times", type=int, default=5)
    options = parser.parse_args()
    cell = read_cell(options.cell)
    (loaded,) = robots_of(cell, Diagnostics())
    driven = loaded.driven
    made = run_cell(cell, [driven])
    inputs = tuple(
        Input(event.t, str(event.data["signal"]), event.data["value"])
        for event in made.robots[0].result.trace
        if event.kind == "input"
    )
    bare = replace(cell, layout=Layout(), inputs=inputs)
    alone = least(options.times, lambda: run_program(driven.program, driven.model, bare))
    among = least(options.times, lambda: run_cell(cell, [driven]))
    search = least(options.times, lambda: find_collisions(made))
    print(f"{made.time_s:.1f} s of the robot, {made.robots[0].result.moves} moves, {len(made.grasps)} grasps")
    more = 100.0 * (among / alone - 1.0)
    print(f"alone {alone:.3f} s, among bodies {among:.3f} s (+{more:.0f} %), search {search:.3f} s")


if __name__ == "__main__":
    main()

"""How large the page of `rpl view` gets, and how long page and picture take, for runs of about a minute.

python benchmarks/view_page.py

One arm that swings for a minute, the cells of samples/cells, and a cell of two hundred parts. The numbers are those of
docs/view.md. How fast a browser plays it cannot be measured here.
"""

from __future__ import annotations

import time
from collections.abc import Iterator
from pathlib import Path

import numpy as np

from rpl.cell import read_cell
from rpl.cell.layout import Layout, Part, RobotPlace
from rpl.cell.record import Placed
from rpl.cell.shapes import Box
from rpl.diagnostics import Diagnostics
from rpl.emulator.model import load_robot
from rpl.project import read_sources
from rpl.simulation import run_program
from rpl.source import source_from_text
from rpl.view.document import view_document
from rpl.view.page import view_page
from rpl.view.picture import picture
from rpl.view.scene import scene_of
from rpl.workcell.loading import robots_of
from rpl.workcell.record import CellRun, RobotRun
from rpl.workcell.running import run_cell

SAMPLES = Path(__file__).parents[1] / "samples/cells"
SWINGS = "PTP {A1 -60,A2 -90,A3 90,A4 0,A5 45,A6 0}\nPTP {A1 60,A2 -70,A3 100,A4 50,A5 -45,A6 90}\n"


def swinging(parts: int) -> CellRun:
    """A minute of one arm, and parts that are each placed ten times."""
    source = source_from_text("swing.src", "DEF swing( )\n" + SWINGS * 42 + "END\n")
    program = read_sources([source], "krl", Diagnostics()).program
    model = load_robot("kuka_kr6r900sixx")
    result = run_program(program, model)
    place = RobotPlace(arm=model.name)
    there = tuple(Part(f"part{number}", Box((30.0, 20.0, 10.0))) for number in range(parts))
    placed = [Placed(6.0 * again, part.name, "falls", np.eye(4) + 0.1 * again) for again in range(10) for part in there]
    robots = (RobotRun(place, model, program, result),)
    return CellRun(Layout((place,), parts=there), robots, tuple(placed), status=result.status, time_s=result.time_s)


def runs() -> Iterator[tuple[str, CellRun]]:
    """What is drawn."""
    yield "one arm", swinging(0)
    yield "one arm, 200 parts", swinging(200)
    for path in sorted(SAMPLES.glob("*/cell.toml")):
        cell = read_cell(str(path))
        if all(one.programs for one in cell.layout.robots):
            yield path.parent.name, run_cell(cell, [one.driven for one in robots_of(cell, Diagnostics())])


def main() -> None:
    print(f"{'cell':<20}{'run s':>8}{'bodies':>8}{'page MB':>9}{'page s':>8}{'picture MB':>12}{'picture s':>11}")
    for name, run in runs():
        begin = time.perf_counter()
        scene = scene_of(run)
        page = view_page(view_document(scene, name))
        between = time.perf_counter()
        taken = picture(scene, run.time_s)
        end = time.perf_counter()
        sizes = f"{len(page.encode()) / 1e6:9.2f}{between - begin:8.2f}{len(taken) / 1e6:12.2f}{end - between:11.2f}"
        print(f"{name:<20}{run.time_s:8.1f}{len(scene.bodies):8d}{sizes}")


if __name__ == "__main__":
    main()

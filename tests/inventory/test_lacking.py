"""Cell files that are written for a project: they are read again, and give values that fit."""

from __future__ import annotations

from pathlib import Path

import pytest

from rpl import registry
from rpl.cell import parse_cell
from rpl.diagnostics import Diagnostics
from rpl.inventory.contents import contents
from rpl.inventory.lacking import lacking
from rpl.inventory.newcell import new_cell
from rpl.linking import link
from rpl.project import read_program, read_sources
from rpl.simulation import Simulation
from rpl.source import source_from_text

ROOT = Path(__file__).parents[2]
SAMPLES = [
    folder
    for language in registry.dialect_names()
    for folder in sorted((ROOT / "samples" / language).glob("*"))[:2]
    if (folder / "expected.toml").exists()
]


@pytest.mark.parametrize("sample", SAMPLES, ids=lambda folder: f"{folder.parent.name}-{folder.name}")
def test_a_new_cell_file_fits_its_program(sample: Path) -> None:
    diagnostics = Diagnostics()
    paths = [path for path in sorted(sample.iterdir()) if path.suffix != ".toml"]
    read = read_program(paths, None, diagnostics)
    cell = parse_cell(new_cell(read, contents(read, diagnostics)), "cell.toml")
    assert cell.assume_data
    linked = link(read.program, cell.assume_data, cell.variables)
    entries = contents(read, diagnostics).entries
    simulation = Simulation(linked.program, None, cell, entries[0].name if entries else None, linked=linked)
    simulation.linked.initialise(simulation.globals, simulation)  # refuses values that do not fit


def test_what_lacks_a_value() -> None:
    texts = {
        "main.src": "DEF main()\nDECL INT n\nn=count+done+box.rows\nPTP there\nPTP taught\n$BASE=shift\nn=list[first]\n"
        "IF n==1 THEN\ndone=2\nENDIF\nEND\n",
        "main.dat": "DEFDAT main\nDECL INT count,done\nDECL E6POS there\nDECL FRAME shift\n"
        "DECL INT list[2]\nlist[1]=1\n"
        "DECL E6POS taught={X 1,Y 2,Z 3,A 0,B 0,C 0}\nENDDAT\n",
    }
    read = read_sources([source_from_text(name, text) for name, text in texts.items()], "krl", Diagnostics())
    zero = "{ x = 0, y = 0, z = 0, a = 0, b = 0, c = 0 }"
    assert [(one.path, one.value, one.left, one.places) for one in lacking(read.program)] == [
        ("box.rows", "0", "", ("main.src:3",)),
        ("count", "0", "", ("main.src:3",)),
        ("first", "1", "", ("main.src:7",)),
        ("shift", zero, "", ("main.src:6",)),
        ("there", zero, "a place, begins where the arm stands", ("main.src:4",)),
    ]

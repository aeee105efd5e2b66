"""Programs of every other language survive RPL: as they were lowered, and in normal form."""

from __future__ import annotations

from pathlib import Path

import pytest

from rpl import registry
from rpl.diagnostics import Diagnostics
from rpl.ir.verify import verify
from rpl.project import read_program
from rpl.source import source_from_text
from rpl.writing.target import WriteContext

SAMPLES = Path(__file__).resolve().parents[2] / "samples"
PROJECTS = sorted(
    folder
    for name in registry.dialect_names()
    if (SAMPLES / name).is_dir()
    for folder in (SAMPLES / name).iterdir()
    if folder.is_dir()
)


@pytest.mark.parametrize("folder", PROJECTS, ids=lambda folder: f"{folder.parent.name}-{folder.name}")
def test_samples_survive(folder: Path) -> None:
    diagnostics = Diagnostics()
    done = read_program([folder], folder.parent.name, diagnostics)
    for program in (done.raw, done.program):
        again = Diagnostics()
        assert verify(program, again), [item.as_text() for item in again]
        text = registry.target("rpl").write(program, WriteContext(again))[0].data.decode()
        back = registry.dialect("rpl").read([source_from_text("t.rpl", text)], again).program
        assert [item.as_text() for item in again] == []
        assert back == program
        assert registry.target("rpl").write(back, WriteContext(again))[0].data.decode() == text

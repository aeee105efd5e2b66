"""The samples in RPL are clean: no report, well built, unchanged by printing and reading."""

from __future__ import annotations

import tomllib
from pathlib import Path

import pytest

from rpl import registry
from rpl.diagnostics import Diagnostics
from rpl.ir.verify import verify
from rpl.project import read_program
from rpl.source import source_from_text
from rpl.writing.target import WriteContext

SAMPLES = sorted((Path(__file__).resolve().parents[2] / "samples" / "rpl").glob("*/*.rpl"))


@pytest.mark.parametrize("path", SAMPLES, ids=lambda path: path.stem)
def test_sample(path: Path) -> None:
    diagnostics = Diagnostics()
    done = read_program([path], None, diagnostics)
    verify(done.program, diagnostics)
    assert [item.as_text() for item in diagnostics] == []
    assert done.dialects == ("rpl",)
    for program in (done.raw, done.program):
        text = registry.target("rpl").write(program, WriteContext(diagnostics))[0].data.decode()
        assert registry.dialect("rpl").read([source_from_text("t.rpl", text)], diagnostics).program == program
    expected = tomllib.loads((path.parent / "expected.toml").read_text("utf-8"))
    assert expected["entry"] in {routine.name for module in done.program.modules for routine in module.routines}

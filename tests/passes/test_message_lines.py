"""A message of several lines is one message for each, where texts of the target have no line ends."""

from __future__ import annotations

import pytest

from rpl.diagnostics import Diagnostics, Severity
from rpl.project import read_sources
from rpl.simulation import run_program
from rpl.source import source_from_bytes, source_from_text
from rpl.translation import translate_program

TEXT = '.PROGRAM main()\n n = 5\n TYPE /C1, "done: ", /I0, n\n TYPE "one", /C2, "two"\n TYPE "last", /C1\n.END\n'


@pytest.mark.parametrize("target", ["krl", "inform", "urscript", "tp", "rapid", "vplus"])
def test_each_line_is_shown(target: str) -> None:
    diagnostics = Diagnostics()
    read = read_sources([source_from_text("p.v2", TEXT)], "vplus", diagnostics)
    done = translate_program(read, target, None, None, diagnostics)
    assert not diagnostics.of(Severity.LOSS)
    back = read_sources([source_from_bytes(f.path, f.data) for f in done.files], target, Diagnostics())
    shown = run_program(back.program, entry=done.renamed.get("main", "main")).messages
    value = "R1" if target == "tp" else "5"
    lines = [line.strip() for message in shown for line in message.splitlines() if line.strip()]
    assert lines == [f"done: {value}", "one", "two", "last"]
    assert len(shown) == (3 if target in ("rapid", "vplus") else 4)

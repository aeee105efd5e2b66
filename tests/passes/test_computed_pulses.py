"""The length of a pulse is a value that the program computes, where the target's pulses have a number for it."""

from __future__ import annotations

import pytest

from rpl.diagnostics import Diagnostics, Severity
from rpl.project import read_sources
from rpl.simulation import run_program
from rpl.source import source_from_bytes, source_from_text
from rpl.translation import translate_program

HEAD = "/JOB\n//NAME BLOW\n//POS\n///NPOS 0,0,0,0,0,0\n//INST\n///DATE 2025/05/14 10:22\n///ATTR SC,RW\n///GROUP1 RB1\n"
JOB = HEAD + "NOP\nSET I021 25\nPULSE OT#(3) T=I021\nTIMER T=0.10\nPULSE OT#(4) T=0.20\nTIMER T=1.00\nEND\n"


@pytest.mark.parametrize("target", ["tp", "krl", "rapid", "urscript", "vplus", "inform"])
def test_outputs_change_at_the_same_times(target: str) -> None:
    diagnostics = Diagnostics()
    read = read_sources([source_from_text("BLOW.JBI", JOB)], "inform", diagnostics)
    done = translate_program(read, target, None, None, diagnostics)
    assert not diagnostics.of(Severity.LOSS)
    again = Diagnostics()
    back = read_sources([source_from_bytes(f.path, f.data) for f in done.files], target, again)
    assert not again.has_errors
    result = run_program(back.program, entry=done.renamed.get("BLOW", "BLOW"), controller="plain")
    seen = [(event.t, event.data["value"]) for event in result.trace if event.kind == "output"]
    seen = [(moment, value) for moment, value in seen if moment > 0 or value]
    assert [value for _, value in seen] == [True, True, False, False]
    long = 0.3 if target == "krl" else 0.25  # KRL's pulses are rounded to tenths of a second
    assert [moment for moment, _ in seen] == pytest.approx([0.0, 0.1, long, 0.3], abs=0.02)
    if target == "tp":
        text = "\n".join(file.data.decode() for file in done.files)
        assert "DO[4]=PULSE,0.2sec" in text
        assert "RUN RPL_PULSE" in text

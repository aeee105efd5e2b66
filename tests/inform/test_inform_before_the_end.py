"""ENWAIT: an output behind a move comes before the robot is there; and texts that are numbers to another base."""

from __future__ import annotations

import pytest
from inform_helpers import job, outputs, read, run

from rpl.diagnostics import Diagnostics, Severity
from rpl.project import read_sources
from rpl.simulation import run_program
from rpl.source import source_from_bytes, source_from_text
from rpl.translation import translate_program

ARM = "motoman_gp7"
POINTS = """///TOOL 0
///POSTYPE ROBOT
///RECTAN
///RCONF 1,0,0,0,0,0
C00000=400.000,-100.000,300.000,180.0000,0.0000,0.0000
C00001=400.000,100.000,300.000,180.0000,0.0000,0.0000
"""
FIRST = "MOVJ C00000 VJ=50.00 PL=0\n"
# Move and what stands behind it -> how long before the last output the first one comes (s), at 100 mm/s.
EARLY = {
    "MOVL C00001 V=100.0 PL=0 ENWAIT DIS=80.0\nDOUT OT#(1) ON\nDOUT OT#(2) ON": 0.8,
    "MOVL C00001 V=100.0 PL=0 ENWAIT T=0.50\n'REMARK\nDOUT OT#(1) ON\nDOUT OT#(2) ON": 0.5,
    "SET I000 30\nMOVL C00001 V=100.0 PL=0 ENWAIT T=I000\nDOUT OT#(1) ON\nDOUT OT#(2) ON": 0.3,
    "IFTHEN IN#(1)=OFF\nMOVL C00001 V=100.0 PL=0 ENWAIT T=0.50\nENDIF\nDOUT OT#(1) ON\nDOUT OT#(2) ON": 0.0,
}


@pytest.mark.parametrize("body", EARLY)
def test_an_output_before_the_end(body: str) -> None:
    """M: only the one instruction behind the move is early."""
    result = run(job(FIRST + body, POINTS))
    assert outputs(result) == [("OT#(1)", True), ("OT#(2)", True)]
    (first, *_), (second, *_) = result.outputs
    assert second - first == pytest.approx(EARLY[body], abs=0.06)


def test_what_is_not_early_says_so() -> None:
    body = f"{FIRST}MOVL C00001 V=100.0 PL=0 ENWAIT T=0.50\nTIMER T=0.20\nDOUT OT#(1) ON"
    _, diagnostics = read(job(body, POINTS))
    assert [item.code.name for item in diagnostics.of(Severity.WARNING)] == ["inform-not-early"]
    _, diagnostics = read(job(f"{FIRST}MOVL C00001 V=100.0 PL=0 ENWAIT\nDOUT OT#(1) ON", POINTS))
    assert diagnostics.has_errors


@pytest.mark.parametrize("target", ["krl", "rapid", "tp", "urscript", "vplus", "inform", "rpl"])
def test_an_output_before_the_end_elsewhere(target: str) -> None:
    body = f"{FIRST}MOVL C00001 V=100.0 PL=0 ENWAIT DIS=80.0\nDOUT OT#(1) ON\nTIMER T=0.10\nDOUT OT#(2) ON"
    ours = read_sources([source_from_text("TEST.JBI", job(body, POINTS))], "inform", Diagnostics())
    diagnostics = Diagnostics()
    done = translate_program(ours, target, ARM, None, diagnostics)
    assert not diagnostics.of(Severity.LOSS), [item.as_text() for item in diagnostics.of(Severity.LOSS)]
    back = read_sources([source_from_bytes(f.path, f.data) for f in done.files], target, Diagnostics())
    result = run_program(back.program, ARM, None, done.renamed.get("TEST", "TEST"), controller="plain")
    times = [t for t, _, _ in result.outputs]
    assert len(times) == 2 and times[1] - times[0] == pytest.approx(0.9, abs=0.08)


NUMBERS = {'"7F3A" RADIX=16': 32570, '"111" RADIX=2': 7, '"1a" RADIX=16': 26, '"17" RADIX=8': 15, '"42" RADIX=10': 42}


@pytest.mark.parametrize("text", NUMBERS)
def test_numbers_to_another_base(text: str) -> None:
    result = run(job(f"VAL D000 {text}\nDOUT OT#(1) ON IF D000={NUMBERS[text]}"))
    assert outputs(result) == [("OT#(1)", True)]


@pytest.mark.parametrize("target", ["krl", "rapid", "tp", "urscript", "vplus", "inform", "rpl"])
def test_a_wait_for_a_state_in_a_variable(target: str) -> None:
    body = "SET B000 5\nSET B001 3\nWAIT IN#(B000)=B001 T=2.00\nDOUT OT#(1) ON IF IN#(5)=ON"
    ours = read_sources([source_from_text("TEST.JBI", job(body))], "inform", Diagnostics())
    diagnostics = Diagnostics()
    translate_program(ours, target, ARM, None, diagnostics)
    assert not diagnostics.of(Severity.LOSS), [item.as_text() for item in diagnostics.of(Severity.LOSS)]

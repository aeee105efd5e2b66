"""Instructions in the forms of newer controllers."""

from __future__ import annotations

import pytest
from inform_helpers import job, outputs, read, run

from rpl import ir
from rpl.diagnostics import Severity

POINTS = """///TOOL 0
///POSTYPE ROBOT
///RECTAN
///RCONF 1,0,0,0,0,0
C00000=400.000,-100.000,300.000,180.0000,0.0000,0.0000
C00001=400.000,100.000,300.000,180.0000,0.0000,0.0000
P00001=350.000,20.000,250.000,0.0000,0.0000,90.0000
P00002=400.000,20.000,250.000,180.0000,0.0000,0.0000
"""
FIRST = "MOVJ C00000 VJ=50.00 PL=0\n"
# Lines and the numbers of the outputs that are on in the end.
LINES = {
    "DOUT OT#(1) INVERT\nDOUT OT#(2) ON\nDOUT OT#(2) INVERT": {1},
    "FOR I000 START=3 TO 7 STEP=2\nDOUT OT#(I000) ON\nNEXT I000": {3, 5, 7},
    "FOR I000 START= 1 TO 2\nDOUT OT#(I000) ON\nNEXT I000": {1, 2},
    "SET D012 5\nSET D009 4\nCLEAR D010 ALL\nDOUT OT#(1) ON IF D012=0\nDOUT OT#(2) ON IF D009=4": {1, 2},
    "SET B000 5\nPULSE OG#(2) B000 T=5.00\nTIMER T=0.10\nDIN B001 OG#(2)\nDOUT OT#(1) ON IF B001=5": {1},
    "PULSE OG#(2) 130 T=5.00\nDIN B001 OG#(2)\nDOUT OT#(1) ON IF B001=130": {1},
    "MFRAME UF#(1) P001 BF\nCNVRT PX003 PX002 UF#(1)\nGETE D000 P003 (1)\nGETE D001 P003 (2)\n"
    "DOUT OT#(1) ON IF D000=0\nDOUT OT#(2) ON IF D001=-50000": {1, 2},
}


@pytest.mark.parametrize("lines", LINES)
def test_newer_forms(lines: str) -> None:
    result = run(job(lines, POINTS))
    assert result.status == "finished"
    state: dict[str, bool] = {}
    for name, value in outputs(result):
        state[name] = bool(value)
    on = {int(name[4:-1]) for name, value in state.items() if value}
    assert {number for number in on if number < 9} == LINES[lines]


def test_a_search_that_does_not_stop() -> None:
    """M: NSRCH keeps the place and drives on."""
    body = f"{FIRST}MOVL C00001 V=100.0 NSRCH RIN#(1)=ON\\nGETS B000 $B002\\nGETS PX005 $PX003\\nGETS PX006 $PX001\\n"
    body = (body + "GETE D000 P005 (2)\\nGETE D001 P006 (2)\\nDOUT OT#(1) ON IF B000=1").replace("\\n", "\n")
    body += "\nDOUT OT#(2) ON IF D000<90000\nDOUT OT#(3) ON IF D001>99900"
    result = run(job(body, POINTS), cell='[[input]]\ntime = 1.5\nsignal = "RIN#(1)"\nvalue = true\n')
    assert outputs(result) == [("OT#(1)", True), ("OT#(2)", True), ("OT#(3)", True)]


@pytest.mark.parametrize("tag", ["UF#(1)", "TL#(2)", "TRAP *ERR"])
def test_what_a_move_says_and_means_nothing_here_is_told(tag: str) -> None:
    program, diagnostics = read(job(f"MOVL C00000 V=100.0 {tag}\n*ERR", POINTS))
    assert not diagnostics.has_errors
    assert {item.code.name for item in diagnostics.of(Severity.WARNING)} == {"inform-unknown-tag"}
    assert any(isinstance(one, ir.Move) for m in program.modules for r in m.routines for one in r.body)


def test_a_pulse_of_a_group_needs_its_number() -> None:
    assert read(job("PULSE OG#(2) T=0.50"))[1].has_errors

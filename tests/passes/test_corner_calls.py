"""A corner in front of a call that sets an output: said where the target's program waits for the robot there."""

from __future__ import annotations

import pytest

from rpl.diagnostics import Diagnostics
from rpl.project import read_sources
from rpl.source import source_from_text
from rpl.translation import translate_program

POINTS = """///NPOS 2,0,0,0,0,0
///TOOL 0
///POSTYPE ROBOT
///RECTAN
///RCONF 1,0,0,0,0,0,0,0
C00000=450.000,20.000,300.000,180.0000,0.0000,0.0000
C00001=450.000,120.000,300.000,180.0000,0.0000,0.0000
"""


def job(name: str, steps: str, points: str = "///NPOS 0,0,0,0,0,0\n") -> str:
    head = f"/JOB\n//NAME {name}\n//POS\n{points}//INST\n///DATE 2025/05/14 10:22\n///ATTR SC,RW\n///GROUP1 RB1\n"
    return f"{head}NOP\n{steps}END\n"


MAIN = "MOVL C00000 V=200.0 PL=0\nMOVL C00001 V=200.0 PL=2\nCALL JOB:SUB\nMOVL C00000 V=200.0 PL=0\n"
SUBS = {
    "sets": ("SET B001 1\nDOUT OT#(3) ON\n", True),
    "sets behind a choice": ("IFTHENEXP B001=1\nSET B002 2\nENDIF\nDOUT OT#(3) ON\n", True),
    "calculates": ("SET B001 1\nINC B002\n", False),
}


@pytest.mark.parametrize("target", ["krl", "rapid"])
@pytest.mark.parametrize("case", SUBS)
def test_said_once(target: str, case: str) -> None:
    steps, stops = SUBS[case]
    sources = [("MAIN", job("MAIN", MAIN, POINTS)), ("SUB", job("SUB", steps))]
    read = read_sources([source_from_text(f"{name}.JBI", text) for name, text in sources], "inform", Diagnostics())
    diagnostics = Diagnostics()
    translate_program(read, target, "motoman_gp7", None, diagnostics)
    told = [item for item in diagnostics if item.code.name == "corner-stops-in-call"]
    assert len(told) == (1 if stops and target == "krl" else 0)
    if told:
        assert told[0].origin.line == 17
        assert "SUB" in told[0].message

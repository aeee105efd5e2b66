"""Outputs behind a corner, where the target's program goes on before the corner."""

from __future__ import annotations

import pytest

from rpl.diagnostics import Diagnostics, Severity
from rpl.project import read_sources
from rpl.source import source_from_text
from rpl.translation import translate_program

JOB = """/JOB
//NAME CORNER
//POS
///NPOS 2,0,0,0,0,0
///TOOL 0
///POSTYPE ROBOT
///RECTAN
///RCONF 1,0,0,0,0,0
C00000=400.000,-100.000,300.000,180.0000,0.0000,0.0000
C00001=400.000,100.000,300.000,180.0000,0.0000,0.0000
//INST
///DATE 2026/01/01 00:00
///ATTR SC,RW
///GROUP1 RB1
NOP
MOVJ C00000 VJ=50.00 PL=0
MOVL C00001 V=100.0 PL={level}
'REMARK
{behind}
MOVL C00000 V=100.0 PL=0
DOUT OT#(2) ON
END
"""


@pytest.mark.parametrize(
    ("target", "level", "behind", "told"),
    [
        ("rapid", 3, "DOUT OT#(1) ON", 1),
        ("rapid", 3, "PULSE OT#(1) T=0.50", 1),
        ("rapid", 3, "IFTHEN B000=0\nDOUT OT#(1) ON\nENDIF", 1),
        ("rapid", 0, "DOUT OT#(1) ON", 0),
        ("rapid", 3, "SET B000 1", 0),
        ("urscript", 3, "DOUT OT#(1) ON", 0),
    ],
)
def test_outputs_that_come_before_the_corner_are_told(target: str, level: int, behind: str, told: int) -> None:
    text = JOB.format(level=level, behind=behind)
    diagnostics = Diagnostics()
    read = read_sources([source_from_text("CORNER.JBI", text)], "inform", diagnostics)
    translate_program(read, target, "motoman_gp7", None, diagnostics)
    names = [item.code.name for item in diagnostics.of(Severity.WARNING)]
    assert names.count("output-before-corner") == told

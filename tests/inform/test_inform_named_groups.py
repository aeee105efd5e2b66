"""Groups of signals that a target can only name keep the bits that they are made of, for a run of the translation."""

from __future__ import annotations

import pytest

from rpl.cell import Cell, Input
from rpl.simulation import run_program
from tests.there_and_back import there_and_back

JOB = """/JOB
//NAME LOOK
//POS
///NPOS 0,0,0,0,0,0
//INST
///DATE 2025/01/10 10:00
///ATTR SC,RW
NOP
TIMER T=0.50
DIN B000 IG#(2)
JUMP *NO IF B000<>5
DOUT OT#(1) ON
*NO
END
"""


@pytest.mark.parametrize("target", ["rapid", "krl"])
def test_a_group_sees_its_bits(target: str) -> None:
    cell = Cell(inputs=tuple(Input(0.1, f"IN#({number})", True) for number in (9, 11)))
    journey = there_and_back({"LOOK.JBI": JOB}, "inform", target)
    assert run_program(journey.source.program, None, cell).outputs
    result = journey.run("LOOK", cell)
    assert result.status == "finished" and result.outputs

"""Groups of signals that a target can only name keep the bits that they are made of, for a run of the translation."""

from __future__ import annotations

import pytest

from rpl import ir
from rpl.cell import Cell, Input
from rpl.diagnostics import Diagnostics
from rpl.project import read_sources
from rpl.proof.wiring import in_words_of, with_signal_names
from rpl.simulation import run_program
from rpl.source import source_from_bytes, source_from_text
from rpl.translation import translate_program

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
    read = read_sources([source_from_text("LOOK.JBI", JOB)], "inform", Diagnostics())
    assert run_program(read.program, None, cell).outputs
    translation = translate_program(read, target, None, None, Diagnostics())
    back = read_sources([source_from_bytes(f.path, f.data) for f in translation.files], target, Diagnostics())
    named = with_signal_names(back.program, translation.program)
    assert isinstance(named, ir.Program)
    result = run_program(named, None, in_words_of(cell, read.program, named), "LOOK")
    assert result.status == "finished" and result.outputs

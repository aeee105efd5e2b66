"""Direct inputs RIN#(n): signals known by name, in the cell file by either spelling, and in other languages."""

from __future__ import annotations

from pathlib import Path

import pytest

from rpl.cell import Cell, Input, read_cell
from rpl.diagnostics import Diagnostics
from rpl.project import read_sources
from rpl.simulation import run_program
from rpl.source import source_from_text
from tests.there_and_back import there_and_back

ARM = "motoman_gp7"
JOB = """/JOB
//NAME FEEL
//POS
///NPOS 2,0,0,0,0,0
///TOOL 0
///POSTYPE ROBOT
///RECTAN
///RCONF 1,0,0,0,0,0,0,0
C00000=480.000,0.000,350.000,180.0000,0.0000,0.0000
C00001=480.000,0.000,250.000,180.0000,0.0000,0.0000
//INST
///DATE 2024/03/05 09:20
///ATTR SC,RW
///GROUP1 RB1
NOP
MOVJ C00000 VJ=50.00 PL=0
MOVL C00001 V=20.0 SRCH RIN#(1)=ON
JUMP *A IF RIN#(1)=OFF
DOUT OT#(1) ON
*A
END
"""


@pytest.mark.parametrize("spelling", ["RIN#(1)", "RIN1", "rin1"])
def test_the_cell_file_names_it(spelling: str, tmp_path: Path) -> None:
    file = tmp_path / "cell.toml"
    file.write_text(f'[[input]]\ntime = 2.5\nsignal = "{spelling}"\nvalue = true\n', "utf-8")
    read = read_sources([source_from_text("FEEL.JBI", JOB)], "inform", Diagnostics())
    assert [value for *_, value in run_program(read.program, ARM, read_cell(str(file))).outputs] == [True]


@pytest.mark.parametrize("target", ["krl", "rapid", "tp", "urscript", "vplus", "inform"])
def test_every_language_has_a_signal_for_it(target: str) -> None:
    journey = there_and_back({"FEEL.JBI": JOB}, "inform", target, ARM)
    assert not journey.losses
    assert "9001" not in journey.text
    if target == "inform":
        assert "SRCH RIN#(1)=ON" in journey.text


@pytest.mark.parametrize("target", ["krl", "rapid", "tp", "urscript", "vplus"])
def test_a_cell_file_in_the_words_of_the_source_serves_the_translation(target: str) -> None:
    journey = there_and_back({"FEEL.JBI": JOB}, "inform", target, ARM)
    result = journey.run("FEEL", Cell(inputs=(Input(2.5, "RIN#(1)", True),)))
    assert [value for *_, value in result.outputs] == [True]

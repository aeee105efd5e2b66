"""The place of joints that have just been asked for, in languages that do not calculate it."""

from __future__ import annotations

import pytest

from rpl.diagnostics import Diagnostics, Severity
from rpl.project import read_sources
from rpl.simulation import run_program
from rpl.source import source_from_bytes, source_from_text
from rpl.translation import translate_program

ARM = "motoman_gp7"
HEAD = """/JOB
//NAME T
//POS
///NPOS 2,0,0,2,0,0
///TOOL 1
///POSTYPE ROBOT
///RECTAN
///RCONF 1,0,0,0,0,0
C00000=440.000,0.000,300.000,180.0000,0.0000,0.0000
C00001=440.000,50.000,250.000,180.0000,0.0000,0.0000
///TOOL 0
P00004=0.000,0.000,100.000,0.0000,0.0000,0.0000
//INST
///DATE 2025/01/01 00:00
///ATTR SC,RW
///GROUP1 RB1
NOP
SETTOOL TL#(1) P004
MOVJ C00000 VJ=50.00 PL=0
GETS PX010 $PX000
"""
CHECK = "GETE D000 P011 (3)\nDOUT OT#(1) ON IFEXPRESS D000>{0} ANDEXP D000<{1}\nEND\n"
# What stands between the joints and their place; whether a language without kinematics can say it.
CASES = {
    "CNVRT PX011 PX010 BF TL#(0)\n" + CHECK.format(399900, 400100): True,
    "SET D001 5\nCNVRT PX011 PX010 BF TL#(1)\n" + CHECK.format(299900, 300100): True,
    "MOVJ C00001 VJ=50.00 PL=0\nCNVRT PX011 PX010 BF TL#(1)\n" + CHECK.format(299900, 300100): False,
}


@pytest.mark.parametrize("target", ["tp", "rapid", "krl", "urscript", "vplus"])
@pytest.mark.parametrize("body", CASES)
def test_the_place_is_asked_for(body: str, target: str) -> None:
    read = read_sources([source_from_text("T.JBI", HEAD + body)], "inform", Diagnostics())
    assert run_program(read.program, ARM, None, "T").outputs
    diagnostics = Diagnostics()
    translation = translate_program(read, target, ARM, None, diagnostics)
    if diagnostics.of(Severity.LOSS):
        assert not CASES[body]
        return
    back = read_sources([source_from_bytes(f.path, f.data) for f in translation.files], target, Diagnostics())
    result = run_program(back.program, ARM, None, translation.renamed.get("T", "T"))
    assert result.status == "finished" and [value for _, _, value in result.outputs] == [True]

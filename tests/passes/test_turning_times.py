"""Straight moves that say how fast they turn, in languages whose moves say a time instead."""

from __future__ import annotations

import pytest

from rpl.diagnostics import Diagnostics, Severity
from rpl.project import read_sources
from rpl.simulation import run_program
from rpl.source import source_from_bytes, source_from_text
from rpl.translation import translate_program
from tests.kept_frames import tool_one

PLACE = """P[{number}]{{
   GP1:
\tUF : 0, UT : 1,\t\tCONFIG : 'N U T, 0, 0, 0',
\tX =   {x}  mm,\tY =   100.000  mm,\tZ =   200.000  mm,
\tW =   180.000 deg,\tP =     0.000 deg,\tR =   {r} deg
}};
"""
STEPS = """/PROG  TURNS
/MN
   1:  UFRAME_NUM=0 ;
   2:  UTOOL_NUM=1 ;
   3:J P[1] 100% FINE    ;
   4:  TIMER[1]=RESET ;
   5:  TIMER[1]=START ;
   6:L P[2] 30deg/sec FINE    ;
   7:  TIMER[1]=STOP ;
   8:  R[1]=TIMER[1] ;
   9:  IF R[1]>1.4 AND R[1]<1.9,DO[1]=(ON) ;
  10:L P[1] 400deg/sec FINE    ;
/POS
"""
ARM = "fanuc_lrmate200id"


@pytest.mark.parametrize(
    ("target", "said"), [("urscript", "t=1.5"), ("vplus", "DURATION 1.5"), ("rapid", ""), ("krl", "")]
)
@pytest.mark.parametrize("x", [400.0, 405.0])
def test_a_turn_takes_its_time(x: float, target: str, said: str) -> None:
    text = STEPS + PLACE.format(number=1, x=400.0, r=0.0) + PLACE.format(number=2, x=x, r=45.0) + "/END\n"
    source = read_sources([source_from_text("TURNS.LS", text), tool_one()], "tp", Diagnostics())
    found = Diagnostics()
    translation = translate_program(source, target, ARM, None, found)
    assert not found.of(Severity.LOSS), [item.as_text() for item in found.of(Severity.LOSS)]
    files = [source_from_bytes(file.path, file.data) for file in translation.files]
    assert said in "".join(file.text for file in files)
    assert ("turn-by-time" in [item.code.name for item in found]) == bool(said)
    back = read_sources(files, target, Diagnostics())
    runs = [
        run_program(source.program, ARM, None, "TURNS"),
        run_program(back.program, ARM, None, translation.renamed.get("TURNS", "TURNS")),
    ]
    assert [run.status for run in runs] == ["finished"] * 2
    assert [[each[2] for each in run.outputs] for run in runs] == [[True]] * 2

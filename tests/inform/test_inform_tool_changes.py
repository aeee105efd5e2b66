"""The place of the robot with a tool that was changed since the last move: the tool file has to be set before it is
read."""

from __future__ import annotations

import pytest

from rpl.diagnostics import Diagnostics, Severity
from rpl.project import read_sources
from rpl.proof.prove import prove_programs
from rpl.source import source_from_bytes, source_from_text
from rpl.translation import translate_program
from tests.kept_frames import tool_one

ARM = "fanuc_lrmate200id"
PROGRAM = """/PROG  MAIN
/MN
   1:  UFRAME_NUM=0 ;
   2:  UTOOL_NUM=1 ;
   3:J P[1] 50% FINE    ;
   4:  PR[1]=LPOS    ;
   5:  PR[2]=PR[1]-PR[1]    ;
   6:  PR[2,3]=100 ;
{lines}
  40:  R[1]=PR[3,3] ;
  41:  DO[1]=(R[1]<{most}) ;
/POS
P[1]{{ GP1: UF : 0, UT : 1, J1 = 7.0 deg, J2 = 10.0 deg, J3 = -20.0 deg, J4 = 0.0 deg, J5 = -70.0 deg, J6 = 0.0 deg }};
/END
"""
CASES = [
    ("UTOOL[2]=PR[2]\nUTOOL_NUM=2\nPR[3]=LPOS", 1),
    ("UTOOL[1]=PR[2]\nPR[3]=LPOS", 1),
    ("UTOOL[2]=PR[2]\nUTOOL_NUM=2\nPR[4]=LPOS\nUTOOL_NUM=1\nPR[3]=LPOS", 101),
    ("UTOOL[2]=PR[2]\nUTOOL_NUM=2\nPR[2,3]=50\nUTOOL[2]=PR[2]\nPR[3]=LPOS", 51),
]


@pytest.mark.parametrize(("lines", "most"), CASES, ids=[lines.replace("\n", ";") for lines, _ in CASES])
def test_the_tool_in_force_counts(lines: str, most: int) -> None:
    body = "\n".join(f"{at:4}:  {line} ;" for at, line in enumerate(lines.splitlines(), 7))
    text = PROGRAM.format(lines=body, most=most)
    read = read_sources([source_from_text("MAIN.LS", text), tool_one()], "tp", Diagnostics())
    diagnostics = Diagnostics()
    files = translate_program(read, "inform", ARM, None, diagnostics).files
    assert not diagnostics.of(Severity.LOSS)
    back = read_sources([source_from_bytes(one.path, one.data) for one in files], "inform", Diagnostics())
    result = prove_programs(read.program, back.program, ARM, None, entry="MAIN", to_entry="MAIN")
    assert result.agrees, result.as_text()

"""Arcs in a row whose points are calculated (the tool is set by the program): the end of one is the start of the next,
and no point of the second belongs to the first."""

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
   4:  PR[1]=LPOS-LPOS    ;
   5:  PR[1,3]=20 ;
   6:  UTOOL[1]=PR[1] ;
   7:{first} P[2] 60{unit} FINE    ;
   8:C P[3]
    :  P[4] 150mm/sec {term}    ;
{between}
   9:C P[5]
    :  P[2] 150mm/sec FINE    ;
/POS
P[1]{{ GP1: UF : 0, UT : 1, J1 = 7.0 deg, J2 = 10.0 deg, J3 = -20.0 deg, J4 = 0.0 deg, J5 = -70.0 deg, J6 = 0.0 deg }};
P[2]{{ GP1: UF : 0, UT : 1, CONFIG : 'N U T, 0, 0, 0', X = 400.0 mm, Y = 60.0 mm, Z = 200.0 mm,
 W = 180.0 deg, P = 0.0 deg, R = 0.0 deg }};
P[3]{{ GP1: UF : 0, UT : 1, CONFIG : 'N U T, 0, 0, 0', X = 340.0 mm, Y = 120.0 mm, Z = 200.0 mm,
 W = 180.0 deg, P = 0.0 deg, R = 0.0 deg }};
P[4]{{ GP1: UF : 0, UT : 1, CONFIG : 'N U T, 0, 0, 0', X = 280.0 mm, Y = 60.0 mm, Z = 200.0 mm,
 W = 180.0 deg, P = 0.0 deg, R = 0.0 deg }};
P[5]{{ GP1: UF : 0, UT : 1, CONFIG : 'N U T, 0, 0, 0', X = 340.0 mm, Y = 0.0 mm, Z = 200.0 mm,
 W = 180.0 deg, P = 0.0 deg, R = 0.0 deg }};
/END
"""
CASES = [
    ("J", "%", "FINE", ""),
    ("L", "mm/sec", "FINE", ""),
    ("J", "%", "CNT100", ""),
    ("J", "%", "FINE", "DO[3]=ON"),
    ("L", "mm/sec", "FINE", "R[4]=1"),
]


@pytest.mark.parametrize(("first", "unit", "term", "between"), CASES)
def test_arcs_in_a_row(first: str, unit: str, term: str, between: str) -> None:
    line = f"  20:  {between} ;" if between else "  20:  !next arc ;"
    text = PROGRAM.format(first=first, unit=unit, term=term, between=line)
    read = read_sources([source_from_text("MAIN.LS", text), tool_one()], "tp", Diagnostics())
    diagnostics = Diagnostics()
    files = translate_program(read, "inform", ARM, None, diagnostics).files
    assert not diagnostics.of(Severity.LOSS)
    back = read_sources([source_from_bytes(one.path, one.data) for one in files], "inform", Diagnostics())
    result = prove_programs(read.program, back.program, ARM, None, entry="MAIN", to_entry="MAIN")
    assert result.agrees, result.as_text()

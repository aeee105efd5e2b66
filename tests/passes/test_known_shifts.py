"""Moves shifted by a way in a variable: by the target's own words where the way is surely along the frame of the move.

INFORM: SFTON P, UF# moves all positions from there on (instruction manual; M for the axes). TP: Offset,PR[n] adds the
components of a register (measured on virtual controllers, see the reading of moves).
"""

from __future__ import annotations

import pytest

from tests.there_and_back import there_and_back

JOB = """/JOB
//NAME PILE
//POS
///NPOS 2,0,0,0,0,0
///USER 2
///TOOL 0
///POSTYPE USER
///RECTAN
///RCONF 1,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0
C00000=300.000,50.000,300.000,180.0000,0.0000,90.0000
C00001=300.000,50.000,250.000,180.0000,0.0000,90.0000
//INST
///DATE 2026/02/10 09:00
///ATTR SC,RW,RJ
////FRAME USER 2
///GROUP1 RB1
NOP
MOVJ C00000 VJ=20.00 PL=0
{lines}
END
"""
FRAMES = "//UFRAME 2\n///NAME PILE\n///TOOL 0\n////BUSER 20.000,30.000,-40.000,0.0000,0.0000,0.0000\n"
SHIFTED = """SUB P010 P010
SETE P010 (3) 40000
SFTON P010 UF#(2)
MOVL C00000 V=200.0 PL=0
MOVL C00001 V=200.0 PL=0
SFTOF
MOVL C00000 V=200.0 PL=0"""
UNSURE = {
    "one of two shifts": SHIFTED.replace("SFTON P010 UF#(2)", "SFTON P010 UF#(2)\nJUMP *ON IF IN#(1)=ON\nSFTOF\n*ON"),
    "the way is changed behind": SHIFTED.replace("SFTON P010 UF#(2)", "SFTON P010 UF#(2)\nSETE P010 (3) 10000"),
}


@pytest.mark.parametrize(
    ("target", "written"),
    [
        ("rapid", ["MoveL Offs(C00000,0,0,40),v200,fine,TL0\\WObj:=UF2;"]),
        ("tp", ["L P[1:C00000] 200mm/sec FINE Offset,PR[1:P010]", "L P[2:C00001] 200mm/sec FINE Offset,PR[1:P010]"]),
        ("krl", ["$BASE=BASE_DATA[2]:P010", "FRAME P010="]),
        ("vplus", [":p010"]),
    ],
)
def test_a_shift_along_the_frame_of_the_move(target: str, written: list[str]) -> None:
    journey = there_and_back(
        {"PILE.JBI": JOB.format(lines=SHIFTED), "UFRAME.CND": FRAMES}, "inform", target, "motoman_gp12"
    )
    assert all(line in journey.text for line in written), journey.text
    assert "SHIFT:=" not in journey.text and "SHIFT=" not in journey.text and "COMPOSE" not in journey.text
    assert journey.prove("PILE").verdict in ("equal", "alike")  # joint speeds and turns by the arms


@pytest.mark.parametrize("case", UNSURE)
def test_a_shift_that_is_not_sure_stays_a_variable(case: str) -> None:
    journey = there_and_back(
        {"PILE.JBI": JOB.format(lines=UNSURE[case]), "UFRAME.CND": FRAMES}, "inform", "rapid", "motoman_gp12"
    )
    assert "PoseMult(SHIFT," in journey.text
    assert journey.prove("PILE").verdict in ("equal", "alike")  # joint speeds and turns by the arms


LISTING = """/PROG  PILE
/MN
   1:  UFRAME_NUM=0 ;
   2:  UTOOL_NUM=0 ;
   3:J P[1] 20% FINE ;
   4:  PR[11:way]=LPOS-LPOS ;
   4:  PR[11,3:way]=40 ;
{more}
   6:L P[1] 200mm/sec FINE Offset,PR[11:way] ;
/POS
P[1]{{
   GP1:
        UF : 0, UT : 0,         CONFIG : 'N U T, 0, 0, 0',
        X =   400.000  mm,      Y =    50.000  mm,      Z =   300.000  mm,
        W =   180.000 deg,      P =     0.000 deg,      R =     0.000 deg
}};
/END
"""


@pytest.mark.parametrize("more", ["", "   5:  PR[11,6:way]=10 ;"])
def test_an_offset_of_a_listing_is_one_where_its_register_turns_nothing(more: str) -> None:
    journey = there_and_back({"PILE.LS": LISTING.format(more=more)}, "tp", "rapid", "fanuc_lrmate200id")
    assert ("Offs(P1,0,0,40)" in journey.text) == (not more)
    assert ("rpl_element_sum" in journey.text) == bool(more)
    assert journey.prove("PILE").verdict in ("equal", "alike")  # joint speeds and turns by the arms

"""Variables that only hold the way by which places are moved: the way stands in the moves."""

import pytest

from tests.there_and_back import Journey, there_and_back

HEAD = """/JOB
//NAME MAIN
//POS
///NPOS 2,0,0,0,0,0
///USER 1
///TOOL 1
///POSTYPE USER
///RECTAN
///RCONF 0,0,0,0,0,0
C00000=600.000,0.000,300.000,180.0000,0.0000,30.0000
C00001=600.000,0.000,200.000,180.0000,0.0000,30.0000
//INST
///DATE 2026/01/01 00:00
///ATTR SC,RW,RJ
////FRAME USER 1
///GROUP1 RB1
NOP
"""
SET = """SET D000 B000
MUL D000 50000
SUB P010 P010
SETE P010 (1) D000
"""
SHIFTED = "SFTON P010 UF#(1)\nMOVJ C00000 VJ=50.00\nMOVL C00001 V=100.0 PL=0\nSFTOF\n"


def written(steps: str, target: str) -> Journey:
    return there_and_back(
        {"MAIN.JBI": f"{HEAD}SET B000 1\n{steps}DOUT OT#(1) ON\nEND\n"}, "inform", target, "motoman_gp12"
    )


def test_a_way_that_is_set_once_stands_in_the_moves() -> None:
    trip = written(SET + SHIFTED, "rapid")
    assert "Offs(C00001,D000*0.001,0,0)" in trip.text
    assert "P010" not in trip.text


@pytest.mark.parametrize(
    "steps",
    [
        SET + "SET D000 7\n" + SHIFTED,  # what it is worked out of has another value at the move
        SET + SHIFTED + "SET P011 P010\n",  # something else looks at it
        SET + SHIFTED + SET + SHIFTED,  # set in two places
    ],
)
def test_else_the_variable_stays(steps: str) -> None:
    trip = written(steps, "rapid")
    assert "P010" in trip.text

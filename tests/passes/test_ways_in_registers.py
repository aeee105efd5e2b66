"""TP moves that registers move: one whose components are set here and that another program empties, and one whose value
nothing sets (`Tool_Offset,PR[12]`), as other languages say such ways."""

from __future__ import annotations

import pytest

from tests.there_and_back import Journey, there_and_back

HEAD = "/PROG {name}\n/ATTR\nDEFAULT_GROUP = 1,*,*,*,*;\n/MN\n"
POINT = """/POS
P[1:"floor"]{
   GP1:
	UF : 0, UT : 0,		CONFIG : 'N U T, 0, 0, 0',
	X =   600.000  mm,	Y =   100.000  mm,	Z =   100.000  mm,
	W =   180.000 deg,	P =     0.000 deg,	R =    30.000 deg
};
/END
"""
BEGIN = HEAD.format(name="BEGIN") + "PR[11:level]=LPOS-LPOS ;\n/POS\n/END\n"
REGISTERS = """[*POSREG*]$POSREG  Storage: CMOS  Access: RW  : ARRAY[1,100] OF Position Reg
     [1,12] =   'back up'   Group: 1
  X:     0.000   Y:     0.000   Z:   -50.000
  W:     0.000   P:     0.000   R:     {turn}
"""
UP = "PR[11,3:level]=R[1]*30 ;\n"
MOVES = """J P[1:floor] 20% FINE Offset,PR[11:level] ;
L P[1:floor] 200mm/sec FINE Offset,PR[11:level] Tool_Offset,PR[12:back up] ;
"""


def written(steps: str, target: str, turn: float = 0.0) -> Journey:
    before = "UFRAME_NUM=0 ;\nUTOOL_NUM=0 ;\nR[1]=2 ;\nCALL BEGIN ;\n"
    main = HEAD.format(name="MAIN") + f"{before}{steps}DO[1]=ON ;\n{POINT}"
    files = {"main.ls": main, "begin.ls": BEGIN, "posreg.va": REGISTERS.format(turn=turn)}
    journey = there_and_back(files, "tp", target, "fanuc_m10ia")
    assert journey.prove().agrees
    return journey


SAID = {
    "rapid": ("Offs(floor,0,0,R1*30)", "RelTool(Offs(floor,0,0,R1*30),0,0,-50)"),
    "vplus": ("SHIFT(p1 BY 0, 0, r1*30)", "APPROS SHIFT(p1 BY 0, 0, r1*30), 50"),
    "krl": ("PTP level:floor", "LIN level:floor:shift_zm50"),
}


@pytest.mark.parametrize("target", SAID)
def test_ways_stand_in_the_moves(target: str) -> None:
    text = written(UP + MOVES, target).text
    for one in SAID[target]:
        assert one in text


@pytest.mark.parametrize(
    "steps",
    [
        UP + "CALL BEGIN ;\n" + MOVES,  # emptied again in between
        "IF R[1]=3,JMP LBL[1] ;\n" + UP + "LBL[1] ;\n" + MOVES,  # a jump comes past
        UP + MOVES + "R[2]=PR[11,3:level] ;\n",  # something else looks at it
    ],
)
def test_else_the_register_stays(steps: str) -> None:
    assert "level.trans.z:=R1*30" in written(steps, "rapid").text


def test_a_way_that_turns_stays_a_register() -> None:
    text = written(UP + MOVES, "rapid", turn=20.0).text
    assert "RelTool" not in text
    assert "PR12" in text

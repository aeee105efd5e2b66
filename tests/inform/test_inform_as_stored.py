"""Position variables keep the numbers of their own frame, the place is seen with the tool of the last move, and jobs
give values back."""

from __future__ import annotations

import pytest
from inform_helpers import job, outputs, run

POINTS = """
///TOOL 0
///POSTYPE ROBOT
///RECTAN
///RCONF 1,0,0,0,0,0
C00000=480.000,0.000,450.000,180.0000,0.0000,0.0000
P00000=400.000,0.000,300.000,180.0000,0.0000,0.0000
P00001=400.000,100.000,300.000,180.0000,0.0000,0.0000
P00002=300.000,0.000,300.000,180.0000,0.0000,0.0000
P00003=390.000,20.000,330.000,180.0000,0.0000,0.0000
P00004=0.000,0.000,100.000,0.0000,0.0000,0.0000
///TOOL 1
C00001=480.000,0.000,300.000,180.0000,0.0000,0.0000
"""
# Where P is: outputs 1 to 3 on when its X, Y and Z are these.
SHOW = job(
    """
GETE D010 P010 (1)
GETE D011 P010 (2)
GETE D012 P010 (3)
SUB D010 D000
SUB D011 D001
SUB D012 D002
JUMP *NO IFEXPRESS D010>20 OREXP D010<-20 OREXP D011>20 OREXP D011<-20 OREXP D012>20 OREXP D012<-20
SET B000 1
*NO
""",
    name="SHOW",
)


def met(x: int, y: int, z: int, number: int) -> str:
    return f"SET B000 0\nSET D000 {x}\nSET D001 {y}\nSET D002 {z}\nCALL JOB:SHOW\nDOUT OT#({number}) ON IF B000=1\n"


CASES = {
    "numbers of a user frame are kept in a copy": (
        "MFRAME UF#(1) P000 P001 P002\nCNVRT P020 P003 UF#(1)\nSET P010 P020\n"
        + met(20000, 10000, 30000, 1)
        + "SET P010 P003\n"
        + met(390000, 20000, 330000, 2)
    ),
    "a copy is driven to in the frame that it came with": (
        "MFRAME UF#(1) P000 P001 P002\nCNVRT P020 P003 UF#(1)\nSET P010 P003\nJUMP *A IF IN#(1)=OFF\nJUMP *B\n"
        "*A\nSET P010 P020\n*B\nMOVJ C000 VJ=50.00\nMOVL P010 V=200.0 PL=0\nGETS P010 $PX001\n"
        + met(390000, 20000, 330000, 1)
        + "DOUT OT#(2) ON\n"
    ),
    "the place is that of the tool of the last move": (
        "SETTOOL TL#(1) P004\nMOVJ C000 VJ=50.00\nMOVJ C001 VJ=50.00 PL=0\nGETS P010 $PX001\n"
        + met(480000, 0, 300000, 1)
        + "MOVJ C000 VJ=50.00 PL=0\nGETS P010 $PX001\n"
        + met(480000, 0, 450000, 2)
    ),
    "a called job finds the tool of its caller and leaves its own": (
        "SETTOOL TL#(1) P004\nMOVJ C000 VJ=50.00\nCALL JOB:LONG\nGETS P010 $PX001\n"
        + met(480000, 0, 300000, 1)
        + "MOVL P010 V=100.0 PL=0\nGETS P010 $PX001\n"
        + met(480000, 0, 300000, 2)
    ),
}
LONG = job("MOVJ C001 VJ=50.00 PL=0", POINTS, "LONG")


@pytest.mark.parametrize("name", CASES)
def test_positions(name: str) -> None:
    result = run(job(CASES[name], POINTS), SHOW, LONG)
    assert result.status == "finished", result.fault
    assert sorted(outputs(result)) == [("OT#(1)", True), ("OT#(2)", True)]


BACK = {
    "RET LD000": ("GETARG LD000 IARG#(1)\nMUL LD000 3", "D000", "D000=21"),
    "RET 2.5": ("NOP", "R000", "R000=2.5"),
    'RET "AB"': ("NOP", "S000", 'S000="AB"'),
    "RET LB000 IF IN#(1)=OFF": ("SET LB000 9", "B000", "B000=9"),
}


@pytest.mark.parametrize("back", BACK)
def test_what_a_job_gives_back(back: str) -> None:
    """M: RET with a value, read by $RV."""
    body, place, condition = BACK[back]
    caller = f"CALL JOB:GIVE ARGF 7\nGETS {place} $RV\nDOUT OT#(1) ON IF {condition}"
    result = run(job(caller), job(f"{body}\n{back}", name="GIVE"))
    assert result.status == "finished" and outputs(result) == [("OT#(1)", True)]

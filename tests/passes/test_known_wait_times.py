"""A time limit that a controller keeps in a setting: FANUC's `$WAITTMOUT`, in hundredths of a second (its manual)."""

from __future__ import annotations

import pytest

from tests.there_and_back import there_and_back

LISTING = """/PROG  LOOK
/MN
   1:  R[1:n]=0 ;
{lines}
   6:  WAIT DI[1]=ON TIMEOUT,LBL[9] ;
   7:  R[1:n]=1 ;
   8:  LBL[9] ;
   9:  DO[1]=ON ;
/POS
/END
"""
SET = "   2:  $WAITTMOUT=150 ;"
CHOSEN = "   2:  IF DI[2]=ON,JMP LBL[1] ;\n   3:  $WAITTMOUT=150 ;\n   4:  LBL[1] ;"
COUNTED = "   2:  R[2:limit]=R[2:limit]+50 ;\n   3:  $WAITTMOUT=R[2:limit] ;"


@pytest.mark.parametrize(
    ("target", "limit"),
    [("rapid", "MaxTime:=1.5"), ("inform", "T=1.50"), ("krl", "1500"), ("urscript", "1.5"), ("vplus", "1.5")],
)
def test_a_limit_that_every_way_sets_is_said_by_the_wait(target: str, limit: str) -> None:
    journey = there_and_back({"LOOK.LS": LISTING.format(lines=SET)}, "tp", target)
    assert limit in journey.text and "=150" not in journey.text
    assert journey.prove("LOOK").equal


@pytest.mark.parametrize("lines", [CHOSEN, COUNTED])
def test_a_limit_that_the_run_decides_stays_a_variable(lines: str) -> None:
    journey = there_and_back({"LOOK.LS": LISTING.format(lines=lines)}, "tp", "rapid")
    assert "MaxTime:=n_WAITTMOUT/100" in journey.text

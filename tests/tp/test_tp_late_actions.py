"""`TA`: an action behind the end of a move. A move with CNT0 stops there as one with FINE does, and a controller that
shifts an action no further than the end of a move that stops (KRL, TRIGGER) does it at the end, which is said."""

import pytest

from tests.there_and_back import there_and_back

TEXT = """/PROG  LATE
/ATTR
/MN
   1:J P[1] 50% FINE    ;
   2:L P[2] 200mm/sec {} TA .30sec,DO[5]=ON    ;
   3:  WAIT    .60(sec) ;
/POS
P[1]{{
   GP1:
	UF : 0, UT : 0,		CONFIG : 'N U T, 0, 0, 0',
	X = 400.0 mm,	Y = 0.0 mm,	Z = 200.0 mm,	W = 180.0 deg,	P = 0.0 deg,	R = 0.0 deg
}};
P[2]{{
   GP1:
	UF : 0, UT : 0,		CONFIG : 'N U T, 0, 0, 0',
	X = 400.0 mm,	Y = 90.0 mm,	Z = 200.0 mm,	W = 180.0 deg,	P = 0.0 deg,	R = 0.0 deg
}};
/END
"""


@pytest.mark.parametrize("end", ["FINE", "CNT0"])
def test_an_action_behind_the_end_of_a_move_that_stops(end: str) -> None:
    journey = there_and_back({"LATE.LS": TEXT.format(end)}, "tp", "krl", "fanuc_lrmate200id")
    assert [item.code.name for item in journey.found].count("late-action-at-end") == 1

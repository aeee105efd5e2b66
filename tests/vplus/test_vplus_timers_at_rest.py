"""Timers that stand: V+ has only running ones, so what nothing has started yet is kept in a variable."""

from __future__ import annotations

import pytest

from tests.there_and_back import there_and_back

# The limits leave room for two hundredths: jobs count in steps of one, and with reals of four bytes.
PROGRAM = """DEF TIMES( )
BAS(#INITMOV,0)
$TIMER[2] = 0
$TIMER_STOP[2] = FALSE
WAIT SEC 0.5
$TIMER_STOP[2] = TRUE
; timer 4 is never started
$TIMER[4] = $TIMER[2]
WAIT SEC 1.0
$OUT[1] = ($TIMER[4]>=480) AND ($TIMER[4]<=520)
$OUT[2] = ($TIMER[6]==0) AND NOT $TIMER_FLAG[6] AND $TIMER_FLAG[4]
; timer 3 is set first and started later
$TIMER[3] = -300
WAIT SEC 1.0
$TIMER_STOP[3] = FALSE
WAIT SEC 0.5
$OUT[3] = ($TIMER[3]>=180) AND ($TIMER[3]<=220)
$OUT[4] = ($TIMER[2]>=480) AND ($TIMER[2]<=520)
END
"""


@pytest.mark.parametrize("target", ["rapid", "tp", "urscript", "vplus", "inform", "rpl"])
def test_a_timer_that_stands_shows_what_it_was_set_to(target: str) -> None:
    journey = there_and_back({"times.src": PROGRAM}, "krl", target, "kuka_kr6r900sixx")
    assert journey.losses == []
    result = journey.run("TIMES")
    assert result.fault is None
    assert journey.switched_on(result) == {1, 2, 3, 4}

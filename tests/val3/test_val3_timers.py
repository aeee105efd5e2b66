"""Timers and stop watches of other languages in VAL3, by `clock()`: what they show is what the source's show."""

from __future__ import annotations

import pytest

from tests.there_and_back import there_and_back

KRL = """DEF job( )
REAL R
INT N
%s
END
"""
RAPID = """MODULE Job
VAR clock ck;
VAR num t;
PROC main()
%s
ENDPROC
ENDMODULE
"""
# Each program sets output 1 where its timers show what they must, and no other one.
TIMERS = {
    "set to zero and read": "$TIMER[1]=0\n$TIMER_STOP[1]=FALSE\nWAIT SEC 0.5\nR=$TIMER[1]\n$OUT[1]=(R>490) AND (R<520)",
    "set ahead": "$TIMER[1]=2000\n$TIMER_STOP[1]=FALSE\nWAIT SEC 0.5\nR=$TIMER[1]\n$OUT[1]=(R>2490) AND (R<2520)",
    "below zero": "$TIMER[1]=-200\n$TIMER_STOP[1]=FALSE\nWAIT FOR $TIMER[1]>=0\nWAIT SEC 0.1\nR=$TIMER[1]\n"
    "$OUT[1]=(R>90) AND (R<140)",
    "stopped in between": "$TIMER[1]=0\n$TIMER_STOP[1]=FALSE\nWAIT SEC 0.3\n$TIMER_STOP[1]=TRUE\nWAIT SEC 0.4\n"
    "R=$TIMER[1]\n$TIMER_STOP[1]=FALSE\nWAIT SEC 0.2\nR=R+$TIMER[1]\n$OUT[1]=(R>790) AND (R<840)",
    "two of them": "$TIMER[1]=0\n$TIMER_STOP[1]=FALSE\nWAIT SEC 0.3\n$TIMER[2]=0\n$TIMER_STOP[2]=FALSE\nWAIT SEC 0.2\n"
    "$OUT[1]=($TIMER[1]>$TIMER[2]+290) AND ($TIMER[1]<$TIMER[2]+320)",
    "in a loop": "$TIMER[1]=0\n$TIMER_STOP[1]=FALSE\nN=0\nWHILE $TIMER[1]<450\nN=N+1\nWAIT SEC 0.1\nENDWHILE\n"
    "$OUT[1]=(N==5)",
}
WATCHES = {
    "begun and read": "ClkReset ck;\nClkStart ck;\nWaitTime 0.5;\nt:=ClkRead(ck);\nIF t>0.49 AND t<0.52 SetDO do1,1;",
    "stopped and begun again": "ClkReset ck;\nClkStart ck;\nWaitTime 0.2;\nClkStop ck;\nWaitTime 0.5;\nClkStart ck;\n"
    "WaitTime 0.1;\nClkStop ck;\nt:=ClkRead(ck);\nIF t>0.29 AND t<0.33 SetDO do1,1;",
}


@pytest.mark.parametrize("steps", TIMERS.values(), ids=TIMERS)
def test_a_timer_of_krl(steps: str) -> None:
    journey = there_and_back({"job.src": KRL % steps}, "krl", "val3", "kuka_kr6r900sixx")
    assert not journey.losses
    assert "clock()" in journey.text
    assert journey.switched_on(journey.run("job")) == {1}


@pytest.mark.parametrize("steps", WATCHES.values(), ids=WATCHES)
def test_a_stop_watch_of_rapid(steps: str) -> None:
    journey = there_and_back({"Job.mod": RAPID % steps}, "rapid", "val3", "kuka_kr6r900sixx")
    assert not journey.losses
    assert journey.switched_on(journey.run("main")) == {1}


def test_the_time_since_a_timer_began_is_written_as_people_do() -> None:
    steps = "$TIMER[3]=0\n$TIMER_STOP[3]=FALSE\nWAIT SEC 1\nWAIT FOR $TIMER[3]>1500"
    text = there_and_back({"job.src": KRL % steps}, "krl", "val3", "kuka_kr6r900sixx").text
    assert "timer3=clock()\n" in text.replace("\r", "")
    assert "clock()-timer3" in text

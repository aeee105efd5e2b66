"""Jobs that keep the robot where it is, and pulses that a job beside ends."""

from __future__ import annotations

from test_inform_from_others import codes, jobs_of

from rpl.diagnostics import Severity

STAYS = """DEF one()
PTP {A1 0, A2 -90, A3 90, A4 0, A5 60, A6 0}
$VEL.CP = 0.1
LIN {X 450, Y 0, Z 600, A 0, B 120, C 0}
count()
IF $IN[1] THEN
  $OUT[3] = TRUE
ENDIF
TRIGGER WHEN PATH=-20 DELAY=0 DO $OUT[1]=TRUE
LIN {X 450, Y 100, Z 600, A 0, B 120, C 0}
END
DEF count()
$OUT[2] = TRUE
END
"""


def test_calls_and_branches_that_do_not_move_leave_the_robot_where_it_is() -> None:
    """So the place of an action on the next move stays known."""
    _, diagnostics, on = jobs_of("krl", STAYS, "kuka_kr6r900sixx", "ONE")
    assert not diagnostics.of(Severity.LOSS) and on == {1, 2}
    assert "path-event-point" not in codes(diagnostics, Severity.WARNING)
    moving = STAYS.replace("$OUT[2] = TRUE", "LIN_REL {Z 10}")
    _, diagnostics, on = jobs_of("krl", moving, "kuka_kr6r900sixx", "ONE")
    assert not diagnostics.of(Severity.LOSS) and on == {1}
    assert "path-event-point" in codes(diagnostics, Severity.WARNING)


PULSES = """MODULE One
PROC one()
VAR num n;
SetDO do1, 1;
PulseDO \\PLength:=0.3, do1;
WaitTime 0.1;
IF DOutput(do1)=0 SetDO do11, 1;
WaitTime 0.5;
IF DOutput(do1)=1 SetDO do12, 1;
PulseDO \\PLength:=0.3, do2;
WaitTime 0.1;
IF DOutput(do2)=1 SetDO do13, 1;
WaitTime 0.5;
IF DOutput(do2)=0 SetDO do14, 1;
ENDPROC
ENDMODULE
"""


def test_a_pulse_to_low_is_ended_by_a_job_beside() -> None:
    jobs, diagnostics, on = jobs_of("rapid", PULSES, "abb_irb1200_5_90", "ONE")
    assert not diagnostics.of(Severity.LOSS), [item.as_text() for item in diagnostics.of(Severity.LOSS)]
    assert on == {1, 11, 12, 13, 14}
    assert "PSTART JOB:RPL_PULSE SUB1" in jobs["ONE"] and "PULSE OT#(2) T=0.30" in jobs["ONE"]

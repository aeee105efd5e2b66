"""A position variable that is used again for something else: pulses first, then a pose, and the other way round."""

from __future__ import annotations

from inform_helpers import job, outputs, read, run

POINTS = """
///TOOL 0
///POSTYPE ROBOT
///RECTAN
///RCONF 1,0,0,0,0,0
C00001=900.000,0.000,800.000,180.0000,0.0000,0.0000
"""
AGAIN = """
MOVJ C00001 VJ=50.00 PL=0
GETS PX011 $PX000
CNVRT PX012 PX011 BF
GETS PX011 $PX001
CNVRT PX012 PX011 PULSE
GETS PX013 $PX000
GETE D000 P012 (2)
GETE D001 P013 (2)
SUB D000 D001
JUMP *NO IF D000>20
JUMP *NO IF D000<-20
DOUT OT#(1) ON
*NO
"""
AROUND_A_CALL = """
MOVJ C00001 VJ=50.00 PL=0
GETS PX011 $PX001
GETS PX011 $PX000
CALL JOB:COUNT
GETE D000 P011 (1)
GETS PX013 $PX000
GETE D001 P013 (1)
JUMP *NO IF D000<>D001
DOUT OT#(1) ON
*NO
"""
HANDED_ON = """
MOVJ C00001 VJ=50.00 PL=0
GETS PX011 $PX000
CALL JOB:FIRST (P011)
GETS D000 $RV
GETE D001 P011 (1)
JUMP *NO IF D000<>D001
DOUT OT#(1) ON
*NO
"""
FIRST = """
GETARG LPX000 IARG#(1)
GETE LD000 LP000 (1)
RET LD000
"""
PERHAPS = """
MOVJ C00001 VJ=50.00 PL=0
GETS PX011 $PX000
GETS PX012 $PX001
SET P011 P012 IF IN#(1)=ON
MOVJ P011 VJ=50.00 PL=0
"""


def test_each_use_has_its_own_form() -> None:
    assert outputs(run(job(AGAIN, POINTS), robot="motoman_mh24")) == [("OT#(1)", True)]


def test_a_called_job_that_leaves_it_alone_does_not_count() -> None:
    made = run(job(AROUND_A_CALL, POINTS), job("INC B000", name="COUNT"), robot="motoman_mh24")
    assert outputs(made) == [("OT#(1)", True)]


def test_a_conditional_instruction_may_leave_the_old_value() -> None:
    _, diagnostics = read(job(PERHAPS, POINTS))
    assert "inform-pulses-as-pose" in {item.code.name for item in diagnostics}


def test_pulses_are_handed_on_in_brackets() -> None:
    points = POINTS.replace("C00001=900.000,0.000", "C00001=900.000,100.000")
    made = run(job(HANDED_ON, points), job(FIRST, name="FIRST"), robot="motoman_mh24")
    assert outputs(made) == [("OT#(1)", True)]

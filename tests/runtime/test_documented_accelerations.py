"""How strongly robots speed up and slow down, as programs say it, by the documents of each language.

RAPID: Technical reference manual, AccSet. V+: Language Reference Guide, ACCEL and SCALE.ACCEL. URScript:
movel (the same rate for
both). KRL: $ACC.CP. M where no manual at hand says it: INFORM ACC= and DEC= are independent; TP ACC is for both.
"""

from __future__ import annotations

import numpy as np
import pytest
from helpers import ABB, moves, run

from rpl.controllerfiles import controller_named
from rpl.emulator.planner import PlannedMove
from rpl.runtime.trace import RunResult

WAY, SPEED, FULL = 400.0, 200.0, 5000.0  # mm, mm/s, mm/s2: what the emulator takes where a controller says nothing
A, B = "[[300,-200,500],[0,0,1,0]", "[[300,200,500],[0,0,1,0]"
NONE = "[9E9,9E9,9E9,9E9,9E9,9E9]"

PROGRAMS = {
    "vplus": """.PROGRAM main()
  SET a = TRANS(300,-200,500,0,180,0)
  SET b = TRANS(300,200,500,0,180,0)
  MOVE a
  BREAK
  SPEED 200 MMPS ALWAYS
  {setting}
  MOVES b
.END
""",
    "rapid": f"""MODULE main
PROC main()
  ConfL\\Off;
  ConfJ\\Off;
  MoveJ {A},[0,0,0,0],{NONE}],v1000,fine,tool0;
  {{setting}}
  WaitTime 0.5;
  MoveL {B},[0,0,0,0],{NONE}],v200,fine,tool0;
ENDPROC
ENDMODULE
""",
    "inform": """/JOB
//NAME MAIN
//POS
///NPOS 0,0,0,2,0,0
///TOOL 0
///POSTYPE ROBOT
///RECTAN
///RCONF 0,0,0,0,0,0,0,0
P000=300.000,-200.000,500.000,180.0000,0.0000,0.0000
P001=300.000,200.000,500.000,180.0000,0.0000,0.0000
//INST
///DATE 2020/01/01 00:00
///ATTR SC,RW
///GROUP1 RB1
NOP
MOVJ P000 VJ=50.00 PL=0
MOVL P001 V=200.0 PL=0 {setting}
END
""",
    "urscript": """def main():
  movej(p[0.3,-0.2,0.5,0,3.141592653589793,0])
  movel(p[0.3,0.2,0.5,0,3.141592653589793,0], {setting} v=0.2)
end
""",
    "krl": """DEF MAIN( )
DECL E6POS P
$TOOL={{X 0,Y 0,Z 0,A 0,B 0,C 0}}
$BASE=$NULLFRAME
PTP {{X 300,Y -200,Z 500,A 0,B 180,C 0}}
$VEL.CP=0.2
{setting}
LIN {{X 300,Y 200,Z 500,A 0,B 180,C 0}}
END
""",
    "rpl": """MOVE TO {{x: 300, y: -200, z: 500, a: 0, b: 180, c: 0}}
$path_acceleration = 5000
{setting}
MOVE LINEAR TO {{x: 300, y: 200, z: 500, a: 0, b: 180, c: 0}} SPEED 200 mm/s
""",
}


def ramps(dialect: str, setting: str, up: float, down: float) -> None:
    """The last move of the program speeds up and slows down with these rates (mm/s2)."""
    leg = last(run(dialect, PROGRAMS[dialect].format(setting=setting), robot=ABB, controller="plain"))
    assert leg.duration_s == pytest.approx(WAY / SPEED + SPEED / (2 * up) + SPEED / (2 * down), abs=1e-4)
    speeds = leg.law.speed_at(np.linspace(0.0, leg.duration_s, 2001)) * WAY
    assert speeds.max() == pytest.approx(SPEED, rel=1e-6)
    step = leg.duration_s / 2000
    assert np.diff(speeds).max() / step == pytest.approx(up, rel=1e-3)
    assert -np.diff(speeds).min() / step == pytest.approx(down, rel=1e-3)


def last(result: RunResult) -> PlannedMove:
    assert result.status == "finished", result.fault
    legs = moves(result)[-1].legs
    assert len(legs) == 1
    return legs[0].plan


@pytest.mark.parametrize(
    ("dialect", "setting", "up", "down"),
    [
        ("vplus", "DISABLE SCALE.ACCEL", 100, 100),
        ("vplus", "DISABLE SCALE.ACCEL\n  ACCEL 50, 80", 50, 80),
        ("vplus", "DISABLE SCALE.ACCEL\n  ACCEL (2) 50, 80", 50, 80),
        ("vplus", "DISABLE SCALE.ACCEL\n  ACCEL 50", 50, 100),
        ("vplus", "DISABLE SCALE.ACCEL\n  ACCEL , 20", 100, 20),
        ("vplus", "DISABLE SCALE.ACCEL\n  ACCEL 400, 30", 100, 30),  # the nearest extreme value is used
        # Scaled, as at the start: the program speed (200 of 1000 mm/s) times what ACCEL says. The speed that the
        # operator sets is none of the program.
        ("vplus", "", 20, 20),
        ("vplus", "ACCEL 50, 80", 10, 16),
        ("vplus", "SPEED 20 ALWAYS", 20, 20),
        ("vplus", "DISABLE SCALE.ACCEL\n  ENABLE SCALE.ACCEL[1]", 20, 20),
        ("vplus", "DISABLE CP, SCALE.ACCEL", 100, 100),
        ("rpl", "$scale_acceleration = TRUE\n$path_speed = 500", 80, 80),  # of the 250 mm/s at the start
        ("inform", "", 100, 100),
        ("inform", "ACC=50 DEC=80", 50, 80),
        ("inform", "ACC=50", 50, 100),
        ("inform", "DEC=20", 100, 20),
        ("rapid", "AccSet 50,100;", 50, 50),
        ("rapid", "AccSet 5,100;", 20, 20),  # less than 20 percent gives 20
        ("krl", "$ACC.CP=2.5", 50, 50),
        ("urscript", "a=2.5,", 50, 50),
        ("rpl", "$acceleration_percent = 50", 50, 50),
        ("rpl", "$deceleration_percent = 20", 100, 20),
    ],
)
def test_ramps_follow_the_percentages(dialect: str, setting: str, up: float, down: float) -> None:
    ramps(dialect, setting, FULL * up / 100.0, FULL * down / 100.0)


@pytest.mark.parametrize(("ramp", "fine", "wide"), [(100, 100, 1), (100, 50, 2), (50, 40, 5), (5, 100, 10)])
def test_a_fine_point_ramp_smooths_the_stop_only(ramp: int, fine: int, wide: float) -> None:
    """AccSet: before a stop the deceleration changes at the rate `ramp` times `fine`; less than 10 gives 10."""
    model = controller_named("rapid")
    setting = f"AccSet 100,{ramp}\\FinePointRamp:={fine};"
    leg = last(run("rapid", PROGRAMS["rapid"].format(setting=setting), robot=ABB))
    width = model.path_smoothing_s * 100 / max(ramp, 10)
    stop = model.path_smoothing_s * wide
    assert model.path_acceleration_mm_s2 is not None
    steep = SPEED / model.path_acceleration_mm_s2
    assert leg.duration_s == pytest.approx(WAY / SPEED + steep + 0.5 * (width + stop), abs=1e-4)


def test_a_corner_is_not_a_fine_point() -> None:
    body = f"""MODULE main
PROC main()
  ConfL\\Off;
  ConfJ\\Off;
  MoveJ {A},[0,0,0,0],{NONE}],v1000,fine,tool0;
  AccSet 100,100\\FinePointRamp:=%d;
  MoveL [[300,0,550],[0,0,1,0],[0,0,0,0],{NONE}],v200,z50,tool0;
  MoveL [[300,200,500],[0,0,1,0],[0,0,0,0],{NONE}],v200,fine,tool0;
ENDPROC
ENDMODULE
"""
    whole, smooth = (run("rapid", body % fine, robot=ABB) for fine in (100, 20))
    first = [sum(leg.duration_s for leg in moves(result)[-2].legs[:1]) for result in (whole, smooth)]
    both = [sum(leg.duration_s for event in moves(result)[-2:] for leg in event.legs) for result in (whole, smooth)]
    assert first[0] == pytest.approx(first[1], abs=1e-9)
    assert both[1] - both[0] == pytest.approx(0.5 * controller_named("rapid").path_smoothing_s * 4, abs=1e-3)


def test_tp_acc_lengthens_both_ramps() -> None:
    """M: ACC is for speeding up and slowing down; the ramps of a controller of constant times get longer by it."""
    text = """/PROG  MAIN
/MN
   1:  J P[1] 50% FINE ;
   2:  L P[2] 200mm/sec FINE {setting} ;
/POS
P[1]{{
   GP1:
    UF : 0, UT : 1,        CONFIG : 'N U T, 0, 0, 0',
    X = 300.0 mm, Y = -200.0 mm, Z = 200.0 mm,
    W = 180.0 deg, P = 0.0 deg, R = 0.0 deg
}};
P[2]{{
   GP1:
    UF : 0, UT : 1,        CONFIG : 'N U T, 0, 0, 0',
    X = 300.0 mm, Y = 200.0 mm, Z = 200.0 mm,
    W = 180.0 deg, P = 0.0 deg, R = 0.0 deg
}};
/END
"""
    ramp = controller_named("tp").path_ramp_s
    for setting, share in (("", 1.0), ("ACC50", 0.5), ("ACC80", 0.8)):
        leg = last(run("tp", text.format(setting=setting), robot="fanuc_lrmate200id"))
        assert leg.duration_s == pytest.approx(WAY / SPEED + ramp / share, abs=2e-3)

"""Every way in which a language gives a speed, as the top speed that the emulated robot comes to, or as a time.

Sources: RAPID Technical reference manual (MoveL \\V \\T, VelSet, SpeedRefresh); KUKA Expert Programming ($VEL.CP,
$VEL_AXIS, $OV_PRO); URScript manual (movej, movel: v in rad/s and m/s, t); V+ Language Reference Guide (SPEED: percent,
MMPS, IPS, MONITOR; DURATION: the least time). M: TP's units and OVERRIDE, INFORM's V and VJ, as the pendants show them.
"""

from __future__ import annotations

import numpy as np
import pytest
from helpers import ABB, KUKA, moves, run

from rpl.emulator.model import load_robot
from rpl.emulator.planner import PlannedMove
from rpl.runtime.trace import RunResult

NONE = "[9E9,9E9,9E9,9E9,9E9,9E9]"
TP_POINTS = "".join(
    f"P[{number}]{{\n GP1:\n UF : 0, UT : 1, CONFIG : 'N U T, 0, 0, 0',\n X = 400.0 mm, Y = {y} mm, Z = 100.0 mm,\n"
    " W = 180.0 deg, P = 0.0 deg, R = 0.0 deg\n};\n"
    for number, y in enumerate((-200.0, 200.0), 1)
)
LINES = {
    "rapid": (
        ABB,
        f"""MODULE main
PROC main()
ConfL\\Off;
ConfJ\\Off;
MoveJ [[300,-200,500],[0,0,1,0],[0,0,0,0],{NONE}],v1000,fine,tool0;
{{before}}
MoveL [[300,200,500],[0,0,1,0],[0,0,0,0],{NONE}],v200{{at}},fine,tool0;
ENDPROC
ENDMODULE
""",
    ),
    "krl": (
        KUKA,
        """DEF MAIN( )
$TOOL=$NULLFRAME
$BASE=$NULLFRAME
PTP {{X 450,Y -200,Z 400,A 0,B 180,C 0}}
$VEL.CP=0.2
{before}
LIN {{X 450,Y 200,Z 400,A 0,B 180,C 0}}
END
""",
    ),
    "tp": (
        "fanuc_lrmate200id",
        "/PROG  MAIN\n/MN\n 1:  J P[1] 100% FINE ;\n 2:  {before} ;\n 3:  L P[2] {at} FINE ;\n/POS\n"
        + TP_POINTS.replace("{", "{{").replace("}", "}}")
        + "/END\n",
    ),
    "urscript": (
        ABB,
        "def main():\n  movej(p[0.3,-0.2,0.5,0,3.141592653589793,0])\n"
        "  movel(p[0.3,0.2,0.5,0,3.141592653589793,0], {at})\nend\n",
    ),
    "vplus": (
        ABB,
        ".PROGRAM main()\n  SET a = TRANS(300,-200,500,0,180,0)\n  SET b = TRANS(300,200,500,0,180,0)\n"
        "  MOVE a\n  BREAK\n  {before}\n  MOVES b\n.END\n",
    ),
    "inform": (
        ABB,
        "/JOB\n//NAME MAIN\n//POS\n///NPOS 0,0,0,2,0,0\n///TOOL 0\n///POSTYPE ROBOT\n///RECTAN\n"
        "///RCONF 0,0,0,0,0,0,0,0\nP000=300.000,-200.000,500.000,180.0000,0.0000,0.0000\n"
        "P001=300.000,200.000,500.000,180.0000,0.0000,0.0000\n//INST\n///DATE 2020/01/01 00:00\n///ATTR SC,RW\n"
        "///GROUP1 RB1\nNOP\nMOVJ P000 VJ=50.00 PL=0\n{before}\nMOVL P001 {at} PL=0\nEND\n",
    ),
}


def last(result: RunResult) -> PlannedMove:
    assert result.status == "finished", result.fault
    (leg,) = moves(result)[-1].legs
    return leg.plan


def top(plan: PlannedMove) -> float:
    """The highest speed along the way, mm/s."""
    return float(plan.law.speed_at(np.linspace(0.0, plan.duration_s, 2001)).max()) * plan.length_mm


@pytest.mark.parametrize(
    ("dialect", "before", "at", "speed"),
    [
        ("rapid", "", "", 200.0),
        ("rapid", "", "\\V:=150", 150.0),
        ("rapid", "VelSet 50,5000;", "", 100.0),
        ("rapid", "VelSet 100,120;", "", 120.0),
        ("rapid", "VelSet 50,120;", "", 100.0),
        ("rapid", "SpeedRefresh 50;", "", 100.0),
        ("krl", "", "", 200.0),
        ("krl", "$VEL.CP=0.05", "", 50.0),
        ("krl", "$OV_PRO=50", "", 100.0),
        ("tp", "R[1]=1", "200mm/sec", 200.0),
        ("tp", "R[1]=1", "600cm/min", 100.0),
        ("tp", "R[1]=1", "120inch/min", 50.8),
        ("tp", "R[1]=150", "R[1]mm/sec", 150.0),
        ("tp", "OVERRIDE=50%", "200mm/sec", 100.0),
        ("urscript", "", "v=0.2", 200.0),
        ("vplus", "SPEED 200 MMPS ALWAYS", "", 200.0),
        ("vplus", "SPEED 200 MMPS", "", 200.0),
        ("vplus", "SPEED 4 IPS ALWAYS", "", 101.6),
        ("vplus", "SPEED 20 ALWAYS", "", 200.0),
        ("vplus", "SPEED 20 ALWAYS\nSPEED 50 MONITOR", "", 100.0),
        ("inform", "SET B000 0", "V=200.0", 200.0),
        ("inform", "SPEED V=150.0", "", 150.0),
    ],
)
def test_speeds_of_the_tool(dialect: str, before: str, at: str, speed: float) -> None:
    robot, text = LINES[dialect]
    plan = last(run(dialect, text.format(before=before, at=at), robot=robot, controller="plain"))
    assert plan.length_mm == pytest.approx(400.0, abs=0.1)
    assert top(plan) == pytest.approx(speed, rel=1e-3)


@pytest.mark.parametrize(
    ("dialect", "before", "at", "seconds"),
    [
        ("rapid", "", "\\T:=4", 4.0),
        ("tp", "R[1]=1", "4sec", 4.0),
        ("tp", "R[1]=1", "2000msec", 2.0),
        ("urscript", "", "t=4", 4.0),
        ("vplus", "DURATION 4", "", 4.0),
        ("vplus", "SPEED 200 MMPS\nDURATION 1", "", 2.2),  # no shorter than the speed allows: 400/200 + 200/1000
    ],
)
def test_times_of_moves(dialect: str, before: str, at: str, seconds: float) -> None:
    robot, text = LINES[dialect]
    plan = last(run(dialect, text.format(before=before, at=at), robot=robot, controller="plain"))
    assert plan.duration_s == pytest.approx(seconds, rel=2e-3)


AXES = {
    "krl": (KUKA, "DEF MAIN( )\nPTP {{A1 0,A2 -90,A3 90,A4 0,A5 0,A6 0}}\n{how}\nPTP {{A1 80,A2 -80}}\nEND\n"),
    "urscript": (
        "ur5e",
        "def main():\n  movej([0,-1.57,1.57,0,0,0])\n  movej([1.5,-1.4,1.57,0,0,0], {how}, a=20)\nend\n",
    ),
    "vplus": (
        "adept_viper_s650",
        ".PROGRAM main()\n  MOVE #PPOINT(0,-90,180,0,0,0)\n  BREAK\n  {how}\n  MOVE #PPOINT(80,-80,180,0,0,0)\n.END\n",
    ),
}


@pytest.mark.parametrize(
    ("dialect", "how", "share"),
    [
        ("krl", "BAS(#VEL_PTP,50)", 0.5),
        ("krl", "FOR N=1 TO 6\n$VEL_AXIS[N]=30\nENDFOR", 0.3),
        ("krl", "BAS(#VEL_PTP,50)\n$OV_PRO=50", 0.25),
        ("vplus", "SPEED 50 ALWAYS", 0.5),
        ("vplus", "SPEED 50 ALWAYS\nSPEED 50 MONITOR", 0.25),
    ],
)
def test_shares_of_axis_speeds(dialect: str, how: str, share: float) -> None:
    """The axis that takes longest runs at its share, the others with it."""
    robot, text = AXES[dialect]
    text = text.format(how=how).replace("DEF MAIN( )\n", "DEF MAIN( )\nDECL INT N\n")
    plan = last(run(dialect, text, robot=robot, controller="plain"))
    rates = plan.law.speed_at(np.linspace(0.0, plan.duration_s, 2001)).max() * abs(plan.end_joints - plan.start_joints)
    assert float(np.max(rates / load_robot(robot).speeds)) == pytest.approx(share, rel=1e-3)


def test_the_leading_axis_of_a_joint_move_in_rad_s() -> None:
    robot, text = AXES["urscript"]
    plan = last(run("urscript", text.format(how="v=0.5"), robot=robot, controller="plain"))
    rates = plan.law.speed_at(np.linspace(0.0, plan.duration_s, 2001)).max() * abs(plan.end_joints - plan.start_joints)
    assert float(rates.max()) == pytest.approx(np.rad2deg(0.5), rel=1e-3)

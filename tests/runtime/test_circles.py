"""Circular moves as each language documents them: how the tool turns, angles, points that fix no circle."""

from typing import Any

import numpy as np
import pytest
from helpers import ABB, KUKA, krl, rapid, run

from rpl.emulator.rotations import matrix_to_rotation_vector, rotation_angle
from rpl.runtime.trace import Event, RunResult

INIT = """BAS(#INITMOV,0)
$TOOL=$NULLFRAME
$BASE=$NULLFRAME
$VEL.CP=0.2
PTP {A1 0,A2 -90,A3 90,A4 0,A5 45,A6 0}
LIN {X 500,Y 0,Z 400,A 0,B 135,C 0}
"""
# A quarter of a circle of 60 mm about (500, 60), seen from above against the clock, and its continuation to the half.
VIA, END, HALF = ("{X 542.426,Y 17.574,Z 400,%s}", "{X 560,Y 60,Z 400,%s}", "{X 500,Y 120,Z 400,%s}")
PLAIN, TURNED = "A 0,B 135,C 0", "A 30,B 135,C 0"


def last_move(result: RunResult) -> Event:
    assert result.status == "finished", result.fault
    return [event for event in result.trace if event.kind == "move" and event.legs][-1]


def poses(event: Event, count: int = 9) -> Any:
    plan = event.legs[0].plan
    return plan.geometry.tcp(np.linspace(0.0, 1.0, count))


def turned(first: Any, second: Any) -> Any:
    """The rotation vector (deg) from one pose to another, in the axes of the base."""
    return np.rad2deg(matrix_to_rotation_vector(second[:3, :3] @ first[:3, :3].T))


def circle(circ_type: str, ori_type: str, turn: str = PLAIN, more: str = "") -> Event:
    settings = f"$CIRC_TYPE=#{circ_type}\n$ORI_TYPE=#{ori_type}\n"
    return last_move(krl(INIT + settings + f"CIRC {VIA % PLAIN},{END % turn}{more}", robot=KUKA))


@pytest.mark.parametrize(
    ("circ_type", "ori_type", "half", "whole"),
    [
        ("BASE", "VAR", 15.0, 30.0),  # evenly to the programmed orientation
        ("PATH", "VAR", 15.0, 30.0),  # relative to the tangent that is even, too, about the circle's axis
        ("BASE", "CONSTANT", 0.0, 0.0),  # stays in space
        ("PATH", "CONSTANT", 45.0, 90.0),  # stays to the tangent, so turns with the circle
    ],
)
def test_krl_orientation_along_an_arc(circ_type: str, ori_type: str, half: float, whole: float) -> None:
    """KSS expert programming, orientation control of circular motion: $ORI_TYPE and $CIRC_TYPE."""
    found = poses(circle(circ_type, ori_type, TURNED))
    assert turned(found[0], found[4]) == pytest.approx([0.0, 0.0, half], abs=5e-3)
    assert turned(found[0], found[8]) == pytest.approx([0.0, 0.0, whole], abs=5e-3)
    assert np.linalg.norm(found[:, :2, 3] - [500, 60], axis=1) == pytest.approx(np.full(9, 60.0), abs=1e-3)


def test_krl_orientation_by_the_wrist_joints() -> None:
    """$ORI_TYPE=#JOINT: the wrist axes move evenly to the programmed orientation, the point stays on the circle."""
    event = circle("BASE", "JOINT", TURNED)
    geometry = event.legs[0].plan.geometry
    joints, found = geometry.joints(np.linspace(0, 1, 9)), poses(event)
    steps = np.diff(joints[:, 3:], axis=0)
    assert steps == pytest.approx(np.repeat(steps[:1], 8, axis=0), abs=1e-3)
    assert turned(found[0], found[8]) == pytest.approx([0.0, 0.0, 30.0], abs=1e-3)
    assert np.linalg.norm(found[:, :2, 3] - [500, 60], axis=1) == pytest.approx(np.full(9, 60.0), abs=1e-3)


def test_krl_starts_with_orientation_in_space() -> None:
    """BAS(#INITMOV,0) sets $CIRC_TYPE=#BASE and $ORI_TYPE=#VAR (expert programming, table 5)."""
    found = poses(last_move(krl(INIT + f"CIRC {VIA % TURNED},{END % PLAIN}", robot=KUKA)))
    assert turned(found[0], found[4]) == pytest.approx([0.0, 0.0, 0.0], abs=1e-3)  # of the auxiliary point none counts


@pytest.mark.parametrize(
    ("angle", "end"),
    [
        (45, (542.426, 17.574)),
        (180, (500, 120)),
        (-90, (440, 60)),
        (360, (500, 0)),
        (450, (560, 60)),
        (-450, (440, 60)),
    ],
)
def test_krl_angle_of_an_arc(angle: float, end: tuple[float, float]) -> None:
    """CA: the whole angle; its sign keeps or turns round the direction of the three points, it may exceed 360."""
    event = circle("BASE", "VAR", TURNED, f",CA {angle}")
    found = poses(event, 181)
    assert found[-1, :2, 3] == pytest.approx(end, abs=1e-2)
    assert event.legs[0].plan.length_mm == pytest.approx(np.deg2rad(abs(angle)) * 60.0, abs=2e-2)
    assert turned(found[0], found[-1]) == pytest.approx([0.0, 0.0, 30.0], abs=1e-3)  # the programmed one at its end
    side = np.sign(found[1, 0, 3] - 500.0)
    assert side == np.sign(angle)


RAPID = """MoveAbsJ [[0,0,0,0,45,0],[9E9,9E9,9E9,9E9,9E9,9E9]],v200,fine,tool0;
MoveL [[300,0,500],[0,0,1,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]],v200,fine,tool0;
%s
MoveC [[342.426,17.574,500],[0,0,1,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]],
  [[360,60,500],[0,0.258819,0.965926,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]],v200,fine,tool0;"""


@pytest.mark.parametrize("mode", ["", "CirPathMode\\PathFrame;", "CirPathMode\\ObjectFrame;"])
def test_rapid_orientation_along_an_arc(mode: str) -> None:
    """RAPID reference, CirPathMode: start and end as programmed in each mode; with \\PathFrame, the one in force at the
    start, the turning is counted from the path."""
    found = poses(last_move(rapid(RAPID % mode, robot=ABB)))
    assert rotation_angle(found[0, :3, :3].T @ found[8, :3, :3]) == pytest.approx(np.deg2rad(30.0), abs=1e-4)
    assert np.linalg.norm(found[:, :2, 3] - [300, 60], axis=1) == pytest.approx(np.full(9, 60.0), abs=1e-3)


UR = """def program():
  movej([0,-1.57,1.57,-1.57,-1.57,0])
  movel(p[-0.45,-0.13,0.4,0,3.14159265,0], v=0.2)
  movec(p[-0.407574,-0.112426,0.4,0,0,0], p[-0.39,-0.07,0.4,0,3.14159265,0], v=0.2, mode=%d)
end
"""


@pytest.mark.parametrize(("mode", "whole"), [(0, 0.0), (1, 90.0)])
def test_urscript_modes_of_an_arc(mode: int, whole: float) -> None:
    """Script manual, movec: mode 0 interpolates to the orientation of the target, mode 1 keeps it to the tangent; the
    orientation of the point on the way is not used."""
    found = poses(last_move(run("urscript", UR % mode, robot="ur5e")))
    assert turned(found[0], found[8]) == pytest.approx([0.0, 0.0, whole], abs=1e-2)


TP = """/PROG  MAIN
/MN
   1:J P[1] 50% FINE ;
   2:L P[2] 200mm/sec FINE ;
   3:C P[3]
    :  P[4] 200mm/sec FINE ;
/POS
"""


def point(number: int, x: float, y: float, r: float = 0.0) -> str:
    return (
        f"P[{number}]{{\n   GP1:\n\tUF : 0, UT : 1,\t\tCONFIG : 'N U T, 0, 0, 0',\n\tX = {x:.3f} mm,\tY = {y:.3f} mm,"
        f"\tZ = 300.000 mm,\n\tW = 180.000 deg,\tP = 0.000 deg,\tR = {r:.3f} deg\n}};\n"
    )


TP_POINTS = [(500, 10), (500, 0), (542.426, 17.574), (560, 60)]
LINE = [(500, 10), (500, 0), (520, 20), (540, 40)]


def tp(points: list[tuple[float, float]]) -> str:
    places = [point(n + 1, x, y, 30.0 if n == 3 else 77.0 if n == 2 else 0.0) for n, (x, y) in enumerate(points)]
    return TP + "".join(places) + "/END\n"


def test_tp_arc_turns_evenly_to_its_end() -> None:
    """M: as documented for linear moves, the orientation changes evenly; that of the point on the way is not used."""
    found = poses(last_move(run("tp", tp(TP_POINTS), robot="fanuc_lrmate200id")))
    assert abs(turned(found[0], found[4])[2]) == pytest.approx(15.0, abs=1e-2)
    assert abs(turned(found[0], found[8])[2]) == pytest.approx(30.0, abs=1e-2)


def job(points: list[tuple[float, float]]) -> str:
    places = [f"C{n:05d}={x:.3f},{y:.3f},300.000,180.0000,0.0000,0.0000\n" for n, (x, y) in enumerate(points)]
    lines = ["MOVJ C00000 VJ=20.00 PL=0", *(f"MOVC C{n:05d} V=200.0 PL=0" for n in (1, 2, 3))]
    head = "/JOB\n//NAME WAY\n//POS\n///NPOS 4,0,0,0,0,0\n///TOOL 0\n///POSTYPE ROBOT\n///RECTAN\n"
    middle = "//INST\n///DATE 2024/01/01 00:00\n///ATTR SC,RW\n///GROUP1 RB1\nNOP\n"
    return head + "///RCONF 0,0,0,0,0,0,0,0\n" + "".join(places) + middle + "\n".join(lines) + "\nEND\n"


def test_inform_three_points_make_an_arc() -> None:
    """INFORM: the way to the first MOVC point is straight, the arc goes through the three."""
    event = last_move(run("inform", job(TP_POINTS), robot="motoman_gp7"))
    assert event.data["motion"] == "circular"
    assert event.legs[0].plan.length_mm == pytest.approx(np.pi / 2 * 60.0, abs=1e-2)


@pytest.mark.parametrize(
    ("language", "text", "robot", "line"),
    [
        ("krl", f"DEF PROG( )\n{INIT}CIRC {{X 520,Y 20,Z 400}},{{X 540,Y 40,Z 400}}\nEND", KUKA, 8),
        ("krl", f"DEF PROG( )\n{INIT}CIRC {VIA % PLAIN},{{X 500,Y 0,Z 400,A 0,B 135,C 0}}\nEND", KUKA, 8),
        (
            "rapid",
            f"MODULE prog\nPROC main()\n{RAPID % ''}\nENDPROC\nENDMODULE".replace("342.426,17.574", "330,30"),
            ABB,
            6,
        ),
        ("urscript", (UR % 0).replace("-0.407574,-0.112426", "-0.42,-0.1"), "ur5e", 4),
        ("tp", tp(LINE), "fanuc_lrmate200id", 5),
        ("inform", job(LINE), "motoman_gp7", 21),
    ],
)  # fmt: skip
def test_points_that_fix_no_circle_are_refused_at_their_line(language: str, text: str, robot: str, line: int) -> None:
    """Each controller stops there with an error of its own (on a line, or with two points in one place)."""
    result = run(language, text, robot=robot)
    assert result.fault is not None and result.fault.code == "degenerate-circle"
    assert result.fault.origin.line == line

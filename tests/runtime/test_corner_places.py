"""Where corners leave and meet the path, in millimetres, in the measures of each language; the speed never jumps.

Sources: KUKA Expert Programming KSS 5.2, 3.5.2 (C_DIS: so many mm before the point, at most half of the block; C_ORI:
so many degrees of the turn are left; C_VEL: where braking for a stop would have reached that part of the speed). (M):
CR of FANUC counts along both moves and takes at most half of the shorter one; CR of INFORM and its levels PL (12.5 mm
for PL=1, 25 mm for PL=2, as delivered) likewise. V+ Language Guide, continuous path: no distances are published; (M)
the corner begins where braking for a stop would begin and ends where the speed is reached again.
"""

from __future__ import annotations

from itertools import pairwise

import numpy as np
import pytest
from helpers import KUKA, moves, run

from rpl.runtime.trace import RunResult

Way = tuple[float, float]


def corner_of(result: RunResult) -> Way:
    """How far before and behind the corner point the path of the last two moves is left and met, mm."""
    assert result.fault is None, result.fault
    one, two = moves(result)[-2:]
    corner = next(leg.plan for leg in one.legs if leg.plan.kind == "corner")
    before = [leg.plan for leg in one.legs if leg.plan.kind != "corner"][-1]
    end = before.geometry.tcp(np.array([1.0]))[0, :3, 3]
    behind = two.legs[0].plan.geometry.tcp(np.array([0.0]))[0, :3, 3]
    assert end == pytest.approx(behind, abs=1e-6)
    return (
        float(np.linalg.norm(corner.start_pose[:3, 3] - end)),
        float(np.linalg.norm(corner.end_pose[:3, 3] - end)),
    )


def check_speed(result: RunResult) -> None:
    """Where the pieces of the last two moves meet, the tool is as fast behind as before."""
    legs = [leg for event in moves(result)[-2:] for leg in event.legs if leg.duration_s > 1e-5]
    for one, two in pairwise(legs):
        speeds = []
        for leg, at in ((one, one.offset_s + one.duration_s), (two, two.offset_s)):
            step = -1e-6 if leg is one else 1e-6
            ways = leg.plan.tcp_at(np.array([at, at + step]))[:, :3, 3]
            speeds.append((ways[1] - ways[0]) / step)
        assert speeds[0] == pytest.approx(speeds[1], abs=0.5)


def krl(setting: str, word: str, turn: float = 0.0) -> RunResult:
    lines = (
        "DEF PROG( )", "BAS(#INITMOV,0)", "$TOOL=$NULLFRAME", "$BASE=$NULLFRAME", "$VEL.CP=0.1", "$ACC.CP=1.0", setting,
        "PTP {A1 0,A2 -90,A3 100,A4 0,A5 60,A6 0}",
        "LIN {X 500,Y -100,Z 400,A 180,B 0,C 180}",
        f"LIN {{X 500,Y 0,Z 400,A {180 - turn},B 0,C 180}} {word}",
        f"LIN {{X 600,Y 0,Z 400,A {180 - turn},B 0,C 180}}",
        "END",
    )  # fmt: skip
    return run("krl", "\n".join(lines), KUKA, entry="prog")


KRL_CASES: list[tuple[str, str, float, float]] = [
    ("$APO.CDIS=20", "C_DIS", 0.0, 20.0),
    ("$APO.CDIS=500", "C_DIS", 0.0, 50.0),  # half of the block
    ("$APO.CORI=5", "C_ORI", 20.0, 25.0),  # 5 of 20 degrees over 100 mm
    ("$APO.CORI=15", "C_ORI", 20.0, 50.0),
    ("$APO.CVEL=50", "C_VEL", 0.0, 1.25),  # (50 mm/s)^2 / (2 * 1000 mm/s2)
    ("$APO.CVEL=100", "C_VEL", 0.0, 5.0),
]


@pytest.mark.parametrize(("setting", "word", "turn", "size"), KRL_CASES)
def test_krl(setting: str, word: str, turn: float, size: float) -> None:
    result = krl(setting, word, turn)
    assert corner_of(result) == pytest.approx((size, size), abs=0.01)
    check_speed(result)


def tp(size: str, way: float) -> RunResult:
    lines = ("UFRAME_NUM=0", "UTOOL_NUM=1", "J P[1] 30% FINE", f"L P[2] 100mm/sec {size}", "L P[3] 100mm/sec FINE")
    data = "".join(
        f"P[{number}]{{\n   GP1:\n\tUF : 0, UT : 1,\t\tCONFIG : 'N U T, 0, 0, 0',\n"
        f"\tX = {x:9.3f}  mm,\tY = {y:9.3f}  mm,\tZ =   800.000  mm,\n"
        "\tW =   180.000 deg,\tP =     0.000 deg,\tR =   135.000 deg\n};\n"
        for number, (x, y) in enumerate(((1300.0 - way, 0.0), (1300.0, 0.0), (1300.0, 200.0)), 1)
    )
    numbered = "".join(f"{number:4d}:{line} ;\n" for number, line in enumerate(lines, 1))
    return run("tp", f"/PROG  P\n/ATTR\n/MN\n{numbered}/POS\n{data}/END\n", "fanuc_m20id25")


@pytest.mark.parametrize(
    ("size", "way", "expected"), [("CR20", 100.0, 20.0), ("CR50", 60.0, 30.0), ("CD20", 100.0, 20.0)]
)
def test_tp(size: str, way: float, expected: float) -> None:
    result = tp(size, way)
    assert corner_of(result) == pytest.approx((expected, expected), abs=0.01)
    check_speed(result)


def test_urscript() -> None:
    text = (
        "def p():\n  movej([0,-1.57,1.57,-1.57,-1.57,0])\n  movel(p[0.4,-0.2,0.3,0,3.14159,0], v=0.1)\n"
        "  movel(p[0.4,-0.1,0.3,0,3.14159,0], v=0.1, r=0.03)\n  movel(p[0.5,-0.1,0.3,0,3.14159,0], v=0.1)\nend\n"
    )
    result = run("urscript", text, "ur5e")
    assert corner_of(result) == pytest.approx((30.0, 30.0), abs=0.01)
    check_speed(result)


def inform(size: str) -> RunResult:
    places = ((500.0, -100.0), (500.0, 0.0), (600.0, 0.0))
    data = "".join(f"C0000{n}={x:.3f},{y:.3f},400.000,180.0000,0.0000,0.0000\n" for n, (x, y) in enumerate(places))
    text = (
        "/JOB\n//NAME P\n//POS\n///NPOS 3,0,0,0,0,0\n///TOOL 0\n///POSTYPE ROBOT\n///RECTAN\n"
        f"///RCONF 0,0,0,0,0,0,0,0\n{data}//INST\n///DATE 2024/01/01 00:00\n///ATTR SC,RW\n///GROUP1 RB1\nNOP\n"
        f"MOVJ C00000 VJ=20.00\nMOVL C00001 V=100.0 {size}\nMOVL C00002 V=100.0 PL=0\nEND\n"
    )
    return run("inform", text, "motoman_gp7")


@pytest.mark.parametrize(
    ("size", "expected"), [("PL=1", 12.5), ("PL=2", 25.0), ("PL=8", 50.0), ("CR=20.0", 20.0), ("CR=80.0", 50.0)]
)
def test_inform(size: str, expected: float) -> None:
    result = inform(size)
    assert corner_of(result) == pytest.approx((expected, expected), abs=0.01)
    check_speed(result)


@pytest.mark.parametrize(("speed", "percent"), [(100.0, 100.0), (200.0, 100.0), (200.0, 50.0)])
def test_vplus(speed: float, percent: float) -> None:
    text = (
        f".PROGRAM p()\nDISABLE SCALE.ACCEL\nACCEL {percent:g},{percent:g}\nSPEED {speed:g} MMPS ALWAYS\n"
        "MOVE TRANS(350,-100,300,0,180,0)\nBREAK\nMOVES TRANS(350,0,300,0,180,0)\nMOVES TRANS(450,0,300,0,180,0)\n"
        "BREAK\n.END\n"
    )
    result = run("vplus", text, "adept_viper_s650")
    braking = speed * speed / (2.0 * 5000.0 * percent / 100.0)
    assert corner_of(result) == pytest.approx((braking, braking), abs=0.01)
    check_speed(result)

"""A stop near or in a corner: the robot brakes along the path as programmed, and what is left is driven as it was."""

import numpy as np
import pytest
from helpers import ABB, KUKA, krl, moves, rapid, time_of, tool_at

from rpl.runtime.trace import Leg, RunResult

INIT = (
    "BAS(#INITMOV,0)\n$TOOL=$NULLFRAME\n$BASE=$NULLFRAME\n$APO.CDIS={corner}\n$VEL.CP=0.4\n$ACC.CP=1.0\n"
    "PTP {{A1 0,A2 -90,A3 90,A4 0,A5 45,A6 0}}\nINTERRUPT DECL 10 WHEN $IN[1] DO HIT( )\nINTERRUPT ON 10\n"
    "LIN {{X 550,Y 0,Z 400,A 0,B 135,C 0}}\nLIN_REL {{Y 200}} C_DIS\nLIN_REL {{Z 200}}\n$OUT[1]=TRUE"
)
HIT = "DEF HIT( )\n{brake}\n$OUT[3]=TRUE\n{more}WAIT SEC 1\nEND"


def drive(at: float | None, corner: float, brake: str = "BRAKE", more: str = "") -> RunResult:
    """Two straight moves with a corner; at a time the robot is stopped for a second. $ACC.CP is 1 m/s2."""
    cell = None if at is None else f"[[input]]\ntime={at}\nsignal='$IN[1]'\nvalue=true\n"
    result = krl(INIT.format(corner=corner), more=HIT.format(brake=brake, more=more), robot=KUKA, cell=cell)
    assert result.status == "finished", result.fault
    return result


def corner_of(result: RunResult) -> Leg:
    return next(leg for event in moves(result) for leg in event.legs if leg.plan.kind == "corner")


def way_and_speeds(result: RunResult, begin: float, end: float) -> tuple[float, np.ndarray, float]:
    """Millimetres from `begin` to `end`, speeds between and the time step."""
    times = np.linspace(begin, end, 301)
    points = np.array([tool_at(result, float(t)) for t in times])
    steps = np.linalg.norm(np.diff(points, axis=0), axis=1)
    step = float(times[1] - times[0])
    return float(steps.sum()), steps / step, step


@pytest.mark.parametrize(
    ("corner", "offset"),
    [(60.0, -0.25), (60.0, -0.1), (60.0, -0.02), (60.0, 0.02), (60.0, 0.15), (60.0, 0.3), (15.0, -0.02), (15.0, 0.05)],
    ids=["before", "into", "into late", "in it", "in the middle", "out of it", "through it", "far out of it"],
)  # fmt: skip
def test_the_robot_brakes_along_its_path_with_the_programmed_acceleration(corner: float, offset: float) -> None:
    """KSS, Expert Programming, BRAKE: the robot is stopped on its path by a ramp; nothing stops at once."""
    free = drive(None, corner)
    at = corner_of(free).start_s + offset
    result = drive(at, corner)
    stood = time_of(result, "$OUT[3]")
    way, speeds, step = way_and_speeds(result, at, stood)
    assert way == pytest.approx(speeds[0] ** 2 / 2000.0, rel=0.02)
    # 1 m/s2 all the way, but for where the corner ends and the speed along the curve is taken over from its fraction
    assert np.diff(speeds) / step == pytest.approx(-1000.0, abs=30.0)
    # The path is the one that is driven without a stop.
    undisturbed = np.array([tool_at(free, float(t)) for t in np.linspace(at, at + 0.6, 1501)])
    for t in np.linspace(at, stood, 12):
        assert np.linalg.norm(undisturbed - tool_at(result, float(t)), axis=1).min() < 0.2


@pytest.mark.parametrize("offset", [-0.25, -0.1, 0.02, 0.15, 0.3])
def test_what_is_left_of_a_corner_is_driven_when_the_robot_goes_on(offset: float) -> None:
    free = drive(None, 60.0)
    result = drive(corner_of(free).start_s + offset, 60.0)
    stood = time_of(result, "$OUT[3]")
    assert tool_at(result, stood + 0.99) == pytest.approx(tool_at(result, stood), abs=1e-6)
    undisturbed = np.array([tool_at(free, float(t)) for t in np.linspace(free.time_s - 1.6, free.time_s, 2001)])
    after = [tool_at(result, float(t)) for t in np.linspace(stood + 1.0, result.time_s, 60)]
    assert max(np.linalg.norm(undisturbed - place, axis=1).min() for place in after) < 0.2
    assert result.joints == pytest.approx(free.joints, abs=1e-6)
    assert [event.stops for event in moves(result)] == [event.stops for event in moves(free)]
    assert result.time_s > free.time_s + 1.0
    assert way_and_speeds(result, stood + 1.0, result.time_s)[1].max() < 401.0


def test_a_hard_stop_is_shorter() -> None:
    free = drive(None, 60.0)
    at = corner_of(free).start_s + 0.02
    soft, hard = (drive(at, 60.0, word) for word in ("BRAKE", "BRAKE F"))
    ways = [way_and_speeds(result, at, time_of(result, "$OUT[3]"))[0] for result in (soft, hard)]
    assert 0.3 < ways[1] / ways[0] < 0.7


def test_the_robot_drives_back_into_the_corner_that_it_was_moved_away_from() -> None:
    """Moved away in a trap routine, the robot comes back to where it left the corner and drives its rest."""
    data = (
        "PERS tooldata tPen:=[TRUE,[[0,0,100],[1,0,0,0]],[0.5,[0,0,50],[1,0,0,0],0,0,0]];\n"
        "CONST robtarget p0:=[[350,0,300],[0,0,1,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]];\nVAR intnum i;"
    )
    body = (
        "ConfJ\\Off; ConfL\\Off;\nCONNECT i WITH hit;\nISignalDI\\Single,di1,1,i;\nMoveJ p0,v500,fine,tPen;\n"
        "MoveL Offs(p0,0,100,0),v100,z50,tPen;\nMoveL Offs(p0,0,100,100),v100,fine,tPen;\nSetDO do1,1;"
    )
    trap = (
        "TRAP hit VAR robtarget here; StopMove; StorePath; here:=CRobT(\\Tool:=tPen\\WObj:=wobj0); SetDO do3,1; "
        "MoveL Offs(here,-40,0,0),v100,fine,tPen; RestoPath; StartMove; SetDO do2,1; ENDTRAP"
    )
    free = rapid(body, data, trap, robot=ABB)
    at = corner_of(free).start_s + 0.2
    cell = f"[[input]]\ntime={at}\nsignal='di1'\nvalue=true\n"
    result = rapid(body, data, trap, robot=ABB, cell=cell)
    assert result.status == "finished", result.fault
    stood, back = time_of(result, "do3"), time_of(result, "do2")
    times = np.linspace(back, result.time_s, 400)
    far = [float(np.linalg.norm(tool_at(result, float(t)) - tool_at(result, stood))) for t in times]
    assert far[0] == pytest.approx(40.0, abs=0.01) and min(far) < 0.3
    undisturbed = np.array([tool_at(free, float(t)) for t in np.linspace(at, free.time_s, 2001)])
    rejoined = int(np.argmin(far))
    assert max(np.linalg.norm(undisturbed - tool_at(result, float(t)), axis=1).min() for t in times[rejoined:]) < 0.5
    assert result.joints == pytest.approx(free.joints, abs=1e-5)

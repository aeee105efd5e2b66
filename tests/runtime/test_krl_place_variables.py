"""KRL's places of the present motion in numbers: $POS_/$AXIS_ INT, RET, FOR, BACK and $DIST_NEXT, read beside it.

EP: KUKA Expert Programming KSS 5.2, 7 and its table of position variables; KSS01437 is the message that asks for
`LIN $POS_RET` before the end of an interrupt's routine.
"""

import pytest
from helpers import KUKA, krl, moves, time_of, tool_at

from rpl.runtime.trace import RunResult

INIT = (
    "BAS(#INITMOV,0)\n$TOOL=$NULLFRAME\n$BASE=$NULLFRAME\n$APO.CDIS=30\n$VEL.CP=0.2\n"
    "PTP {A1 0,A2 -90,A3 90,A4 0,A5 45,A6 0}\nLIN {X 550,Y 0,Z 400,A 0,B 135,C 0}\n"
)
WATCH = "INTERRUPT DECL 10 WHEN $IN[1] DO HIT( )\nINTERRUPT ON 10\nPART( )\nINTERRUPT OFF 10\n"
LINE = "LIN_REL {Y 200}\n"
BEGIN_S = moves(krl(INIT + LINE, robot=KUKA))[2].legs[0].start_s


def told(values: str) -> str:
    """A message with up to three numbers."""
    places = " ".join(f"%{n + 1}" for n in range(values.count(",") + 1))
    return f'MsgNotify("{places}","",{values})\n'


def hit(routine: str, after_s: float = 0.5, path: str = LINE, data: str = "") -> RunResult:
    """The path with an interrupt so many seconds behind the start of its first motion."""
    more = f"DEF PART( )\n{path}WAIT SEC 0\n$OUT[4]=TRUE\nEND\nDEF HIT( )\n{data}\n{routine}\nEND"
    cell = f"[[input]]\ntime={BEGIN_S + after_s}\nsignal='$IN[1]'\nvalue=true\n"
    result = krl(INIT + WATCH, more=more, robot=KUKA, cell=cell)
    assert result.status == "finished", result.fault
    return result


def numbers(result: RunResult, message: int = 0) -> list[float]:
    return [float(word) for word in result.messages[message].split()]


def test_pos_ret_is_where_the_robot_left_its_path() -> None:
    """Behind BRAKE it is where the robot stands, and stays that while the routine moves it away; pos_int is not."""
    routine = (
        "BRAKE\nY=$POS_RET.Y\nZ=$POS_ACT.Y\n" + told("Y,Z,$POS_INT.Y") + "LIN_REL {Z 40}\nWAIT SEC 0\n"
        "Y=$POS_RET.Y\nZ=$POS_RET.Z\n" + told("Y,Z,$POS_ACT.Z") + "LIN $POS_RET\nWAIT SEC 0\n$OUT[2]=TRUE\n"
    )
    result = hit(routine, data="DECL REAL Y,Z")
    left, stands, came = numbers(result)
    assert left == pytest.approx(stands, abs=0.01) and left > came + 5.0
    assert came == pytest.approx(tool_at(result, BEGIN_S + 0.5)[1], abs=0.01)
    assert numbers(result, 1) == pytest.approx([left, 400.0, 440.0], abs=0.01)
    assert tool_at(result, time_of(result, "$OUT[2]")) == pytest.approx([550.0, left, 400.0], abs=0.01)
    assert tool_at(result, time_of(result, "$OUT[4]")) == pytest.approx([550.0, 200.0, 400.0], abs=0.05)


def test_axis_ret_holds_the_joints_of_that_place() -> None:
    routine = "BRAKE\nR=$AXIS_RET\nPTP {A1 -20}\n" + told("R.A1,$AXIS_RET.A1,$AXIS_ACT.A1") + "PTP $AXIS_RET\n"
    result = hit(routine, data="DECL E6AXIS R")
    at_once, later, away = numbers(result)
    assert later == pytest.approx(at_once, abs=1e-3) and away == pytest.approx(-20.0, abs=1e-3)
    braked = next(event for event in moves(result) if event.data["motion"] == "joint" and event.t > BEGIN_S)
    assert braked.legs[0].plan.start_joints[0] == pytest.approx(at_once, abs=1e-3)


def test_beside_the_motion_pos_ret_is_where_the_robot_is() -> None:
    """M: on its path a robot has left nothing."""
    result = hit("Y=$POS_RET.Y\n" + told("Y,$POS_ACT.Y"), data="DECL REAL Y")
    assert numbers(result)[0] == pytest.approx(numbers(result)[1], abs=0.01)


@pytest.mark.parametrize(
    ("after_s", "path", "back", "ends"),
    [
        (0.5, LINE, (0.0, 400.0), (200.0, 400.0)),
        # the program pointer is further ahead, and the corner has taken the end of the first motion
        (0.3, "LIN_REL {Y 100} C_DIS\nLIN_REL {Z 100} C_DIS\nLIN_REL {Y 50}\n", (0.0, 400.0), (100.0, 400.0)),
        (0.75, "LIN_REL {Y 100} C_DIS\nLIN_REL {Z 100} C_DIS\nLIN_REL {Y 50}\n", (100.0, 400.0), (100.0, 500.0)),
    ],
)
def test_pos_back_and_pos_for_are_the_ends_of_the_present_motion(
    after_s: float, path: str, back: tuple[float, float], ends: tuple[float, float]
) -> None:
    """EP 7: start and target of the block that is driven, not of those that the advance run has seen."""
    data = "DECL REAL Y,Z"
    result = hit("Y=$POS_BACK.Y\nZ=$POS_BACK.Z\n" + told("Y,Z"), after_s, path, data)
    assert numbers(result) == pytest.approx(back, abs=0.01)
    result = hit("BRAKE\nY=$POS_FOR.Y\nZ=$POS_FOR.Z\n" + told("Y,Z"), after_s, path, data)
    assert numbers(result) == pytest.approx(ends, abs=0.01)


def test_in_a_spline_block_they_are_the_points_before_and_behind() -> None:
    points = [(560, 40, 400), (550, 80, 410), (530, 110, 400)]
    lines = "".join(f"SPL {{X {x},Y {y},Z {z},A 0,B 135,C 0}}\n" for x, y, z in points)
    path = f"SPLINE\n{lines}ENDSPLINE\n"
    for after_s, before, behind in ((0.1, 0.0, 40.0), (0.35, 40.0, 80.0), (0.55, 80.0, 110.0)):
        routine = "Y=$POS_BACK.Y\nZ=$POS_FOR.Y\n" + told("Y,Z")
        assert numbers(hit(routine, after_s, path, "DECL REAL Y,Z")) == pytest.approx([before, behind], abs=0.01)


def test_axis_for_and_axis_back_are_joints() -> None:
    path = "PTP {A1 30}\n"
    result = hit("Y=$AXIS_BACK.A1\nZ=$AXIS_FOR.A1\n" + told("Y,Z"), 0.1, path, "DECL REAL Y,Z")
    assert numbers(result) == pytest.approx([0.0, 30.0], abs=1e-3)


def test_dist_next_is_what_is_left_to_the_next_point() -> None:
    result = hit("Y=$DIST_NEXT\n" + told("Y,$POS_ACT.Y"), 0.5, LINE, "DECL REAL Y")
    left, here = numbers(result)
    assert left == pytest.approx(200.0 - here, abs=0.01) and left > 50.0


def test_resume_without_brake_lets_the_motion_end_first() -> None:
    """EP, table of automatic stops of the advance run: RESUME without BRAKE is one of them."""
    result = hit("RESUME")
    last = moves(result)[-1]
    assert last.data["xyz_mm"] == pytest.approx([550.0, 200.0, 400.0], abs=1e-3) and last.stops
    assert "interrupted" not in last.data and "$OUT[4]" not in {name for _, name, _ in result.outputs}


def test_a_trigger_from_the_start_of_a_motion_of_its_own() -> None:
    """ONSTART: the distance counts from the start point."""
    result = krl(INIT + f"TRIGGER WHEN PATH=30 ONSTART DELAY=0 DO $OUT[1]=TRUE\n{LINE}", robot=KUKA)
    assert tool_at(result, time_of(result, "$OUT[1]")) == pytest.approx([550.0, 30.0, 400.0], abs=0.01)

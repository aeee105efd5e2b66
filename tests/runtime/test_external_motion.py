"""Joint moves on frames that turn along, accelerations of external axes, and what a run tells about them afterwards."""

import numpy as np
import pytest

from rpl.cell import Cell, parse_cell
from rpl.diagnostics import Diagnostics
from rpl.emulator.model import load_robot
from rpl.emulator.rotations import FloatArray, pose_matrix
from rpl.project import read_sources
from rpl.runtime.remarks import report_remarks
from rpl.runtime.trace import Event, RunResult
from rpl.simulation import run_program
from rpl.source import source_from_text

ARM = "kuka_kr10r1420"
AXIS = 'direction = "z", limits = [-180, 180], speed = 90, acceleration = 300'
TABLE = f"""
[[mechanism]]
name = "EASYS"
kind = "rotary"
root = [700, 0, 400, 0, 0, 0]
axes = [{{ number = 1, {AXIS} }}]
"""
CELL = parse_cell(TABLE)
HEAD = """DEF a( )
INT I
$TOOL={X 0.0,Y 0.0,Z 100.0,A 0.0,B 0.0,C 0.0}
$BASE=$NULLFRAME
$ADVANCE=3
$APO.CPTP=50
$APO.CDIS=20
PTP {A1 0,A2 -90,A3 90,A4 0,A5 90,A6 0,E1 0}
$BASE=EK(MACHINE_DEF[2].ROOT,#EASYS,{X 0.0,Y 0.0,Z 50.0,A 0.0,B 0.0,C 0.0})
"""
DOWN = "A 180,B 0,C 180"


def run(body: str, cell: Cell = CELL) -> RunResult:
    read = read_sources([source_from_text("a.src", f"{HEAD}{body}\nEND\n")], "krl", Diagnostics())
    result = run_program(read.program, ARM, cell)
    assert result.status == "finished", result.fault
    return result


def moves(result: RunResult) -> list[Event]:
    return [event for event in result.trace if event.kind == "move"]


def on_the_plate(joints: FloatArray, turned_deg: float) -> list[float]:
    """The tool in the base on the table, from joints and angle alone."""
    tool = load_robot(ARM).forward(joints) @ pose_matrix([0, 0, 100])
    angle, x, y = np.deg2rad(turned_deg), tool[0, 3] - 700.0, tool[1, 3]
    return [np.cos(angle) * x + np.sin(angle) * y, np.cos(angle) * y - np.sin(angle) * x, tool[2, 3] - 450.0]


SLOW = "FOR I=1 TO 6\n$ACC_AXIS[I]=30\n$VEL_AXIS[I]=40\nENDFOR\n"


@pytest.mark.parametrize("before", ["", SLOW], ids=["full", "slow"])
@pytest.mark.parametrize("turned", [0, 40, -120])
def test_a_joint_move_without_flags_ends_on_its_place_of_the_turned_table(before: str, turned: int) -> None:
    last = moves(run(f"{before}PTP {{X 60,Y 0,Z 100,{DOWN},E1 0}}\nPTP {{X -60,Y 30,Z 100,{DOWN},E1 {turned}}}"))[-1]
    plan = last.legs[-1].plan
    assert plan.external_end[0] == pytest.approx(turned)
    assert on_the_plate(plan.end_joints, turned) == pytest.approx([-60.0, 30.0, 100.0], abs=1e-5)


CORNERS = f"""PTP {{X 60,Y 0,Z 100,{DOWN},E1 0}}
PTP {{X 0,Y 60,Z 150,{DOWN},E1 90}} C_PTP
PTP {{X -60,Y 0,Z 100,{DOWN},E1 -30}} C_PTP
LIN {{X -60,Y 20,Z 100,{DOWN},E1 -30}} C_DIS
PTP {{X 60,Y 0,Z 100,{DOWN},E1 60}} C_PTP C_DIS
LIN {{X 60,Y 40,Z 100,{DOWN},E1 0}} C_DIS
PTP {{X 60,Y 0,Z 200,{DOWN},E1 90}}"""


@pytest.mark.parametrize("before", ["", SLOW], ids=["full", "slow"])
def test_approximated_moves_on_the_table_are_continuous_and_within_their_limits(before: str) -> None:
    model, last = load_robot(ARM), None
    for event in moves(run(before + CORNERS)):
        for leg in event.legs:
            times = np.linspace(leg.offset_s, leg.offset_s + leg.duration_s, 200)
            joints, turned = leg.plan.joints_at(times), leg.plan.external_at(times)[:, 0]
            if last is not None:
                assert joints[0] == pytest.approx(last[0], abs=1e-4)
                assert turned[0] == pytest.approx(last[1], abs=1e-6)
            last = joints[-1], turned[-1]
            if leg.duration_s > 1e-6:
                rates = np.abs(np.diff(joints, axis=0)) / np.diff(times)[:, None] / model.speeds
                assert rates.max() <= 1.01
                assert (np.abs(np.diff(turned)) / np.diff(times)).max() <= 90.5
    assert last is not None
    assert on_the_plate(last[0], last[1]) == pytest.approx([60.0, 0.0, 200.0], abs=1e-5)


def test_an_external_axis_ramps_by_its_own_acceleration_and_the_programmed_share() -> None:
    turn = f"PTP {{X 60,Y 0,Z 100,{DOWN},E1 0}}\n$ACC_EXTAX[1]=%s\nPTP {{X 60,Y 0,Z 100,{DOWN},E1 60}}"
    full, slow = (moves(run(turn % share))[-1].data["duration"] for share in (100, 10))
    # 60 degrees at 30 degrees/s2: half of it to speed up, half to brake, with a top speed below that of the axis
    assert slow >= 2.0 * np.sqrt(60.0 / 30.0)
    assert full < slow - 1.0


def told(result: RunResult, cell: Cell) -> list[str]:
    diagnostics = Diagnostics()
    report_remarks(result, load_robot(ARM).among(cell.mechanisms, "cell").mechanisms, diagnostics)
    return [item.code.name for item in diagnostics]


def test_an_axis_without_data_is_told_once() -> None:
    body = (
        f"LIN {{X 60,Y 0,Z 100,{DOWN},E1 0}}\nLIN {{X 60,Y 0,Z 100,{DOWN},E1 30}}\nLIN {{X 60,Y 0,Z 100,{DOWN},E1 0}}"
    )
    bare = parse_cell(TABLE.replace(", speed = 90, acceleration = 300", ""))
    assert told(run(body, bare), bare) == ["external-axis-assumed"]
    assert told(run(body), CELL) == []


def test_a_corner_between_two_frames_is_told() -> None:
    body = f"""LIN {{X 60,Y 0,Z 100,{DOWN},E1 0}}
LIN {{X 60,Y 60,Z 100,{DOWN},E1 30}} C_DIS
$BASE=$NULLFRAME
LIN {{X 650,Y 0,Z 600,{DOWN},E1 0}}"""
    assert told(run(body), CELL) == ["corner-in-joints"]
    same = body.replace("$BASE=$NULLFRAME\n", "").replace("X 650,Y 0,Z 600", "X 0,Y 60,Z 200")
    assert told(run(same), CELL) == []

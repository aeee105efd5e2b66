"""Frames around the robot by their arithmetic in mm: its root, roots of external kinematics, parts that it holds."""

import numpy as np
import pytest

from rpl.cell import parse_cell
from rpl.diagnostics import Diagnostics
from rpl.emulator.model import load_robot
from rpl.emulator.rotations import FloatArray, pose_matrix, zyx_to_matrix
from rpl.project import read_sources
from rpl.runtime.trace import Event, RunResult
from rpl.simulation import run_program
from rpl.source import source_from_text

ARM = "kuka_kr10r1420"
TABLE = """
[[mechanism]]
name = "EASYS"
kind = "rotary"
root = [700, 0, 400, 0, 0, 0]
axes = [{ number = 1, speed = 90 }]
"""
HEAD = """DEF a( )
$TOOL={X 0.0,Y 0.0,Z 100.0,A 0.0,B 0.0,C 0.0}
$BASE=$NULLFRAME
PTP {A1 0,A2 -90,A3 90,A4 0,A5 90,A6 0,E1 0}
"""


def run(body: str, cell: str = TABLE) -> RunResult:
    read = read_sources([source_from_text("a.src", f"{HEAD}{body}\nEND\n")], "krl", Diagnostics())
    return run_program(read.program, ARM, parse_cell(cell))


def moves(result: RunResult) -> list[Event]:
    assert result.status == "finished", result.fault
    return [event for event in result.trace if event.kind == "move"]


def flange(event: Event) -> FloatArray:
    return load_robot(ARM).forward(np.array(event.data["joints"]))


def test_the_robots_root_is_taken_off_the_places_of_the_world() -> None:
    body = "$ROBROOT={X 100,Y 50,Z 300,A 0,B 0,C 0}\nLIN {X 750,Y 50,Z 900,A 180,B 0,C 180,E1 0}"
    tool = flange(moves(run(body))[-1]) @ pose_matrix([0, 0, 100])
    assert tool[:3, 3] == pytest.approx([650.0, 0.0, 600.0], abs=1e-3)


def test_a_turned_root_turns_the_places() -> None:
    body = "$ROBROOT={X 0,Y 0,Z 0,A 90,B 0,C 0}\nLIN {X 0,Y 650,Z 600,A 270,B 0,C 180,E1 0}"
    tool = flange(moves(run(body))[-1]) @ pose_matrix([0, 0, 100])
    assert tool[:3, 3] == pytest.approx([650.0, 0.0, 600.0], abs=1e-3)


@pytest.mark.parametrize("turned", [0, 30])
def test_a_root_that_the_program_says_goes_before_that_of_the_file(turned: int) -> None:
    body = f"""$BASE=EK({{X 650.0,Y 40.0,Z 420.0,A 0.0,B 0.0,C 0.0}},#EASYS,{{X 0.0,Y 0.0,Z 50.0,A 0.0,B 0.0,C 0.0}})
LIN {{X 60,Y 0,Z 100,A 180,B 0,C 180,E1 {turned}}}"""
    tool = flange(moves(run(body))[-1]) @ pose_matrix([0, 0, 100])
    angle = np.deg2rad(turned)
    wanted = [650.0 + 60.0 * np.cos(angle), 40.0 + 60.0 * np.sin(angle), 570.0]
    assert tool[:3, 3] == pytest.approx(wanted, abs=1e-3)


def test_roots_that_are_read_from_the_machine_data_are_those_of_the_file() -> None:
    for root in ("EX_AX_DATA[1].ROOT", "MACHINE_DEF[2].ROOT"):
        body = f"""$BASE=EK({root},#EASYS,{{X 0.0,Y 0.0,Z 50.0,A 0.0,B 0.0,C 0.0}})
LIN {{X 60,Y 0,Z 100,A 180,B 0,C 180,E1 0}}"""
        tool = flange(moves(run(body))[-1]) @ pose_matrix([0, 0, 100])
        assert tool[:3, 3] == pytest.approx([760.0, 0.0, 550.0], abs=1e-3)


def test_a_part_in_the_gripper_is_led_under_a_tool_fixed_in_the_room() -> None:
    body = """$IPO_MODE=#TCP
$BASE={X 620.0,Y 30.0,Z 620.0,A 0.0,B 0.0,C 0.0}
$TOOL={X 10.0,Y 20.0,Z 80.0,A 90.0,B 0.0,C 0.0}
PTP {X 0,Y 0,Z 0,A 90,B 0,C 180}
LIN {X 40,Y 20,Z 0,A 90,B 0,C 180}"""
    last = moves(run(body))[-1]
    part = pose_matrix([10.0, 20.0, 80.0], zyx_to_matrix([90.0, 0.0, 0.0]))
    plan = last.legs[0].plan
    places = []
    for time in np.linspace(0.0, plan.duration_s, 11):
        held = load_robot(ARM).forward(plan.joints_at(time)) @ part
        places.append((np.linalg.inv(held) @ [620.0, 30.0, 620.0, 1.0])[:3])
    assert places[0] == pytest.approx([0.0, 0.0, 0.0], abs=1e-3)
    assert places[-1] == pytest.approx([40.0, 20.0, 0.0], abs=1e-3)
    for x, y, z in places:
        assert (y, z) == pytest.approx((0.5 * x, 0.0), abs=1e-3)


def test_the_root_of_the_robots_own_track_is_data_of_the_machine() -> None:
    body = "$OUT[1]=$ERSYSROOT.X>100"
    refused = run(body)
    assert refused.status == "fault"
    assert refused.fault is not None and "ERSYSROOT" in refused.fault.message
    given = '"$ERSYSROOT" = { x = 120.0, y = 0.0, z = 0.0, a = 0.0, b = 0.0, c = 0.0 }\n'
    assert run(body, f"[variables]\n{given}{TABLE}").status == "finished"

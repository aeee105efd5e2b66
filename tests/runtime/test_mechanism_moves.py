"""Programs with mechanisms around the robot: frames on tables, robots on tracks, tools fixed in the room."""

import numpy as np
import pytest
from helpers import ABB
from helpers import rapid as run_rapid

from rpl.emulator.model import load_robot
from rpl.emulator.rotations import FloatArray, invert_pose, pose_matrix
from rpl.errors import UsageError
from rpl.runtime.trace import Event, RunResult

TABLE = """
[[mechanism]]
name = "STN1"
kind = "rotary"
root = [300, 0, 200, 0, 0, 0]
axes = [{ number = 1, direction = "z", limits = [-180, 180], speed = 90 }]
"""
RAIL = """
[[mechanism]]
name = "rail"
kind = "track"
root = [0, -500, 0, 0, 0, 0]
axes = [{ number = 2, direction = "y", speed = 1000 }]
"""
DOWN = "[0,0,1,0]"
DATA = f"""
TASK PERS tooldata pin:=[TRUE,[[0,0,100],[1,0,0,0]],[1,[0,0,1],[1,0,0,0],0,0,0]];
TASK PERS wobjdata plate:=[FALSE,FALSE,"STN1",[[0,0,0],[1,0,0,0]],[[0,0,50],[1,0,0,0]]];
CONST robtarget a:=[[60,0,100],{DOWN},[0,0,0,0],[0,9E9,9E9,9E9,9E9,9E9]];
CONST robtarget b:=[[60,0,100],{DOWN},[0,0,0,0],[90,9E9,9E9,9E9,9E9,9E9]];
VAR robtarget here;
"""
SHOW = "TPWrite ValToStr([Round(here.trans.x\\Dec:=3),Round(here.trans.y\\Dec:=3),Round(here.trans.z\\Dec:=3)]);"
MODEL = load_robot(ABB)


def rapid(body: str, data: str, **options: str) -> RunResult:
    """Whatever posture reaches the places: it is not what these tests are about."""
    return run_rapid(f"ConfJ\\Off;\nConfL\\Off;\n{body}", data, **options)


def moves(result: RunResult) -> list[Event]:
    assert result.status == "finished", result.fault
    return [event for event in result.trace if event.kind == "move"]


def tool_at(event: Event) -> FloatArray:
    """The tool in the robot's base at the end of a move, as the trace shows it."""
    return np.array(event.data["xyz_mm"])


def test_a_work_object_on_a_table_is_followed() -> None:
    done = moves(
        rapid("MoveJ a,v100,fine,pin\\WObj:=plate;\nMoveL b,v100,fine,pin\\WObj:=plate;", DATA, robot=ABB, cell=TABLE)
    )
    # the table stands at 300, 0, 200; the work object 50 above it; 60 along x, and after a quarter turn along y
    assert tool_at(done[0]) == pytest.approx([360, 0, 350], abs=1e-3)
    assert tool_at(done[1]) == pytest.approx([300, 60, 350], abs=1e-3)
    plan = done[1].legs[0].plan
    times = np.linspace(0, plan.duration_s, 21)
    tools = MODEL.forward(plan.joints_at(times)) @ pose_matrix([0, 0, 100])
    turned = np.deg2rad(plan.external_at(times)[:, 0])
    assert tools[:, 0, 3] == pytest.approx(300 + 60 * np.cos(turned), abs=1e-5)
    assert tools[:, 1, 3] == pytest.approx(60 * np.sin(turned), abs=1e-5)
    assert (
        1.0 + 0.3 <= plan.duration_s < 1.6
    )  # the table governs: 90 deg at 90 deg/s, 0.3 s to get there, and the filter


def test_where_the_robot_is_counts_in_the_work_object_where_it_then_is() -> None:
    body = f"""MoveJ a,v100,fine,pin\\WObj:=plate;
MoveL b,v100,fine,pin\\WObj:=plate;
here:=CRobT(\\Tool:=pin\\WObj:=plate);
{SHOW}
here:=CRobT(\\Tool:=pin\\WObj:=wobj0);
{SHOW}
TPWrite ValToStr(here.extax.eax_a);"""
    assert rapid(body, DATA, robot=ABB, cell=TABLE).messages == ("[60,0,100]", "[300,60,350]", "90")


def test_a_frame_on_a_mechanism_that_nobody_has_placed_is_a_fault() -> None:
    result = rapid("MoveJ a,v100,fine,pin\\WObj:=plate;", DATA, robot=ABB)
    assert result.fault is not None
    assert result.fault.code == "no-mechanism"
    assert "no mechanism is called 'STN1'" in result.fault.message


def test_a_robot_on_a_track_goes_to_places_in_the_room() -> None:
    data = f"""
CONST robtarget a:=[[400,0,300],{DOWN},[0,0,0,0],[9E9,500,9E9,9E9,9E9,9E9]];
CONST robtarget b:=[[400,200,300],{DOWN},[0,0,0,0],[9E9,700,9E9,9E9,9E9,9E9]];
CONST robtarget c:=[[400,200,300],{DOWN},[0,0,0,0],[9E9,600,9E9,9E9,9E9,9E9]];
"""
    result = rapid(
        "MoveJ a,v100,fine,tool0;\nMoveL b,v100,fine,tool0;\nMoveL c,v100,fine,tool0;", data, robot=ABB, cell=RAIL
    )
    done = moves(result)
    # the carriage stands at y = -500 + E2: in the base of the robot the tool stays at 400, 0, 300, then goes by 100
    assert tool_at(done[0]) == pytest.approx([400, 0, 300], abs=1e-3)
    assert tool_at(done[1]) == pytest.approx([400, 0, 300], abs=1e-3)
    assert tool_at(done[2]) == pytest.approx([400, 100, 300], abs=1e-3)
    assert done[0].data["joints"] == pytest.approx(done[1].data["joints"], abs=1e-5)
    assert done[1].legs[0].plan.length_mm == pytest.approx(200.0)


HELD = """
TASK PERS tooldata gluegun:=[FALSE,[[350,0,250],[1,0,0,0]],[1,[0,0,1],[1,0,0,0],0,0,0]];
TASK PERS wobjdata part:=[TRUE,TRUE,"",[[0,0,80],[1,0,0,0]],[[0,0,0],[1,0,0,0]]];
CONST robtarget a:=[[10,0,20],[0,0,1,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
CONST robtarget b:=[[-30,40,20],[0,-0.25881905,0.96592583,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
VAR robtarget here;
"""


def test_a_tool_fixed_in_the_room_goes_straight_over_the_held_part_while_that_turns() -> None:
    body = "MoveJ a,v100,fine,gluegun\\WObj:=part;\nMoveL b,v100,fine,gluegun\\WObj:=part;"
    done = moves(
        rapid(
            body + f"\nhere:=CRobT(\\Tool:=gluegun\\WObj:=part);\n{SHOW}",
            HELD,
            robot=ABB,
        )
    )
    plan = done[1].legs[0].plan
    times = np.linspace(0, plan.duration_s, 31)
    flanges = MODEL.forward(plan.joints_at(times))
    fixed = pose_matrix([350, 0, 250])
    on_part = invert_pose(flanges @ pose_matrix([0, 0, 80])) @ fixed
    share = (10 - on_part[:, 0, 3]) / 40
    assert on_part[:, 1, 3] == pytest.approx(40 * share, abs=1e-4)
    assert on_part[:, 2, 3] == pytest.approx(np.full(31, 20.0), abs=1e-4)
    assert plan.length_mm == pytest.approx(np.hypot(40, 40), abs=1e-4)


def test_external_axes_stop_with_the_robot_and_their_limits_hold() -> None:
    far = DATA.replace("[90,9E9", "[200,9E9")
    result = rapid(
        "MoveJ a,v100,fine,pin\\WObj:=plate;\nMoveL b,v100,fine,pin\\WObj:=plate;", far, robot=ABB, cell=TABLE
    )
    assert result.fault is not None
    assert "external axis 1 would be at 200.000, outside -180..180" in result.fault.message


def test_external_axes_stand_where_the_cell_says() -> None:
    body = "here:=CRobT(\\Tool:=pin\\WObj:=plate);\nTPWrite ValToStr(here.extax.eax_a);"
    assert rapid(body, DATA, robot=ABB, cell="external = [45]\n" + TABLE).messages == ("45",)
    with pytest.raises(UsageError, match="external: must be a list of 1 to 6 values"):
        rapid(body, DATA, robot=ABB, cell="external = []\n" + TABLE)

"""Torques and following errors of whole runs: the load at each move, the largest values with their lines."""

import json
from pathlib import Path

import numpy as np
import pytest

from rpl.cli.main import run as rpl
from rpl.emulator.inertias import LAG_S, Body
from rpl.emulator.model import load_robot
from rpl.report.dynamics import RunDynamics, run_dynamics
from rpl.report.sampling import driven_moves
from rpl.runtime.trace import RunResult
from tests.runtime.helpers import ABB, KUKA, rapid, run

SWING = """def swing():
  {load}
  movej([0, -1.5, -1.5, -1.5, 1.5, 0], a=2.0, v=1.5)
  movej([1.0, -0.5, -0.5, -1.5, 1.5, 1.0], a=2.0, v=1.5)
end
"""
STRETCHED = """def stretched():
  movej([0, 0, 0, 0, 0, 0], a=0.2, v=0.2)
  sleep(1.0)
end
"""
LINE = """def line():
  movej([0.2, -1.3, -1.9, -1.5, 1.57, 0], a=2.0, v=1.5)
  movel(pose_add(get_actual_tcp_pose(), p[0, 0.3, 0, 0, 0, 0]), a=2.0, v=0.2)
end
"""
JOINTS = "[{},0,0,0,30,0],[9E9,9E9,9E9,9E9,9E9,9E9]"


def masses(result: RunResult) -> list[list[float]]:
    assert result.status == "finished", result.fault
    return [[load.mass for load in event.payloads] for event in driven_moves(result)]


def test_loads_of_tool_and_part_by_a_language_that_has_both() -> None:
    result = rapid(
        f"""MoveAbsJ [{JOINTS.format(0)}],v100,fine,grip;
        GripLoad part;
        MoveAbsJ [{JOINTS.format(10)}],v100,fine,grip;
        MoveAbsJ [{JOINTS.format(0)}],v100,fine,grip\\TLoad:=part;
        MoveAbsJ [{JOINTS.format(10)}],v100,fine,grip;""",
        """PERS tooldata grip:=[TRUE,[[0,0,100],[1,0,0,0]],[2,[0,0,50],[1,0,0,0],0,0,0]];
        PERS loaddata part:=[5,[10,0,20],[1,0,0,0],0.1,0.2,0.3];""",
        robot=ABB,
    )
    assert masses(result) == [[2.0], [2.0, 5.0], [5.0], [2.0, 5.0]]
    moves = driven_moves(result)
    tool, part = moves[1].payloads
    assert (tool.frame.position.z, part.frame.position.x, part.frame.position.z) == (50.0, 10.0, 120.0)
    assert part.inertias == (0.1, 0.2, 0.3)
    assert moves[2].payloads[0].frame.position.z == 20.0  # the load of one move is all of it, in the wrist


def test_the_load_set_by_a_language_that_has_one() -> None:
    result = run("urscript", SWING.format(load="set_payload(3.5, [0, 0.01, 0.05])"), robot="ur5e")
    assert masses(result) == [[3.5], [3.5]]
    place = driven_moves(result)[0].payloads[0].frame.position
    assert (place.x, place.y, place.z) == pytest.approx((0.0, 10.0, 50.0))


def test_inertias_of_a_load_that_is_told_as_a_target() -> None:
    """URScript manual, set_target_payload: mass, centre, and Ixx Iyy Izz Ixy Ixz Iyz about the centre."""
    text = SWING.format(load="set_target_payload(2.0, [0, 0, 0.1], [0.03, 0.02, 0.01, 0, 0, 0])")
    (load,) = driven_moves(run("urscript", text, robot="ur5e"))[0].payloads
    assert (load.mass, load.inertias, load.frame.position.z) == (2.0, (0.03, 0.02, 0.01), 100.0)


KRL_LOADS = """DEF PROG( )
LOAD_DATA[2]={M 4.0,CM {X 10.0,Y 0.0,Z 60.0,A 90.0,B 0.0,C 0.0},J {X 0.1,Y 0.2,Z 0.3}}
$ACT_TOOL=2
PTP {A1 0,A2 -90,A3 90,A4 0,A5 45,A6 0}
$LOAD={M 3.0,CM {X 0.0,Y 0.0,Z 100.0,A 0.0,B 0.0,C 0.0},J {X 0.0,Y 0.0,Z 0.0}}
PTP {A1 10}
$LOAD.M=0
$ACT_TOOL=5
PTP {A1 0}
END
"""


def test_the_load_kept_in_variables_of_the_language() -> None:
    """The load in force, else that of the tool's number; the frame of the centre turns the inertias."""
    result = run("krl", KRL_LOADS, robot=KUKA)
    assert masses(result) == [[4.0], [3.0], []]
    (load,) = driven_moves(result)[0].payloads
    assert load.inertias == (0.1, 0.2, 0.3)
    assert (load.frame.position.x, load.frame.position.z) == (10.0, 60.0)
    assert load.frame.rotation.zyx[0] == pytest.approx(90.0)


def layers(result: RunResult, robot: str = "ur5e", payload: Body | None = None) -> RunDynamics:
    assert result.status == "finished", result.fault
    return run_dynamics(result, load_robot(robot), payload)


def point(mass: float, z: float = 50.0) -> Body:
    return Body(mass, np.array([0.0, 10.0, z]), np.zeros((3, 3)))


def test_a_given_load_stands_for_that_of_the_program() -> None:
    said = layers(run("urscript", SWING.format(load="set_payload(3.5, [0, 0.01, 0.05])"), robot="ur5e"))
    plain = run("urscript", SWING.format(load="sleep(0)"), robot="ur5e")
    given, empty = layers(plain, payload=point(3.5)), layers(plain)
    for one, other in zip(said.joints, given.joints, strict=True):
        assert one.torque.value == pytest.approx(other.torque.value, abs=1e-6)
    assert abs(given.joints[1].torque.value) > abs(empty.joints[1].torque.value) + 5.0
    assert (said.payload_kg, given.payload_kg, empty.payload_kg) == (3.5, 3.5, 0.0)
    assert any("--payload" in warning for warning in empty.warnings)
    assert not given.warnings


def test_a_stretched_arm_at_rest_is_held_by_its_lever() -> None:
    """Slowly into the level posture, then still: the weights at their distances from the shoulder, half a percent for
    what braking adds."""
    found = layers(run("urscript", STRETCHED, robot="ur5e"))
    lever = 8.058 * 0.2125 + 2.846 * (0.425 + 0.3922 - 0.15) + (1.37 + 1.3 + 0.365) * (0.425 + 0.3922)
    assert found.torques[-1, 2] == pytest.approx(-9.81 * lever, rel=1e-6)
    shoulder = found.joints[1]
    assert abs(shoulder.torque.value) == pytest.approx(9.81 * lever, rel=0.05)
    assert shoulder.limit == 150.0
    assert shoulder.share == pytest.approx(abs(shoulder.torque.value) / 150.0)
    assert 0.0 < shoulder.rms < abs(shoulder.torque.value)


def test_a_torque_beyond_its_limit_is_warned_of_with_its_line() -> None:
    found = layers(run("urscript", STRETCHED, robot="ur5e"), payload=point(20.0))
    assert [warning for warning in found.warnings if "J2 would need" in warning and "p0.urscript:2" in warning]
    assert found.joints[1].share is not None
    assert found.joints[1].share > 1.0


def test_a_line_at_constant_speed_is_followed_by_speed_times_lag() -> None:
    """All joints are late by the same time, so the tool is where it was T ago: v T behind, and on its path."""
    result = run("urscript", LINE, robot="ur5e")
    following = layers(result).following
    assert following.assumed
    assert following.lag_s == (LAG_S,) * 6
    begun = driven_moves(result)[1].legs[0].start_s + 0.3
    on_the_line = following.rows[following.rows[:, 0] > begun]
    assert on_the_line[:, 1].max() == pytest.approx(200.0 * LAG_S, rel=0.01)
    assert on_the_line[:, 2].max() < 0.05
    assert following.off.value <= following.behind.value


def test_without_inertias_torques_are_refused_and_following_is_not() -> None:
    result = rapid(f"MoveAbsJ [{JOINTS.format(20)}],v100,fine,tool0;", robot=ABB)
    found = layers(result, ABB)
    assert found.joints == ()
    assert found.warnings == ("abb_irb120_3_58: no inertias in the robot file: torques are not known",)
    assert found.following.behind.value > 0.0


def test_the_command_prints_a_table_and_json(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    program = tmp_path / "swing.script"
    program.write_text(SWING.format(load="sleep(0)"))
    common = ["run", str(program), "--robot", "ur5e", "--dynamics", "--payload", "3.5,0,10,50"]
    assert rpl(common) == 0
    out = capsys.readouterr().out
    assert [line.split()[0] for line in out.splitlines() if line.startswith("J")] == [f"J{n}" for n in range(1, 7)]
    assert "swing.script:4 at " in out
    assert "mm off its path" in out
    assert rpl([*common, "--json"]) == 0
    found = json.loads(capsys.readouterr().out)["dynamics"]
    assert {"joints", "following", "payload_kg", "warnings"} == set(found)
    assert len(found["joints"]) == 6
    assert {"name", "unit", "torque", "rms", "limit", "share", "speed", "speed_limit"} == set(found["joints"][0])
    assert found["payload_kg"] == 3.5
    assert found["joints"][1]["torque"]["line"] in (3, 4)
    assert {"value", "time_s", "file", "line"} == set(found["following"]["behind_mm"])


def test_without_the_option_the_json_is_as_ever(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    program = tmp_path / "swing.script"
    program.write_text(SWING.format(load="sleep(0)"))
    assert rpl(["run", str(program), "--robot", "ur5e", "--json"]) == 0
    assert "dynamics" not in json.loads(capsys.readouterr().out)


def test_the_page_has_torques_and_errors(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("rpl.report.page.drawing_library", lambda: "")
    program, page = tmp_path / "swing.script", tmp_path / "swing.html"
    program.write_text(SWING.format(load="sleep(0)"))
    assert rpl(["run", str(program), "--robot", "ur5e", "--dynamics", "--plot", str(page)]) == 0
    text = page.read_text("utf-8")
    data = json.loads(text.split('id="run">', 1)[1].split("</script>", 1)[0])
    names = [(layer["name"], layer["unit"]) for layer in data["layers"]]
    assert names == [
        *((f"Joint torque J{n}", "% of limit") for n in range(1, 7)),
        ("Behind the command", "mm"),
        ("Off the path", "mm"),
    ]
    assert all(len(layer["t"]) == len(layer["values"]) > 100 for layer in data["layers"])


MISUSED = [
    (["--dynamics"], "--robot"),
    (["--payload", "3"], "--dynamics"),
    (["--dynamics", "--robot", KUKA, "--payload", "3,4"], "mass,x,y,z"),
    (["--dynamics", "--robot", KUKA, "--payload", "-3"], "mass"),
    (["--dynamics", "--robot", KUKA, "--payload", "heavy"], "not a number"),
]


@pytest.mark.parametrize(("options", "said"), MISUSED)
def test_wrong_calls_are_answered_before_the_run(
    options: list[str], said: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    program = tmp_path / "swing.script"
    program.write_text(SWING.format(load="sleep(0)"))
    assert rpl(["run", str(program), *options]) == 2
    assert said in capsys.readouterr().err

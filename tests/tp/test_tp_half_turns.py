"""Targets of an ABB arm on FANUC arms: the same posture, its axis 6 counted from half a turn.

The targets and what two virtual controllers reached them with: the boundary probe of LeroyDu56/CrossArm. The
tool straight down in front of the arm is axis 6 at 0 on the one and at exactly 180, which is turn 1, on the other.
"""

from __future__ import annotations

import json
import re
from pathlib import Path

import numpy as np
import pytest

from postprocessors.tp.positions import Points, Position
from postprocessors.tp.posture import choose_postures
from rpl.cli.main import run
from rpl.emulator.model import load_robot
from rpl.emulator.rotations import matrix_to_quaternion, matrix_to_zyx, zyx_to_matrix
from rpl.source import Origin, source_from_text

# Name, place, turn of the tool about z, and the turn of axis 6.
TARGETS = [
    ("pAhead", (1300.0, 0.0, 900.0), 0.0, 1),
    ("pHigh", (1100.0, 0.0, 1000.0), 0.0, 1),
    ("pTurned", (1300.0, 0.0, 900.0), 0.1, 1),
    ("pTurnedBack", (1300.0, 0.0, 900.0), -0.1, 0),
    ("pAside", (1126.333, 650.0, 900.0), 30.0, 1),
    ("pSide45", (1300.0, -300.0, 900.0), 45.0, 1),
]
UNUSED = "[9E9,9E9,9E9,9E9,9E9,9E9]"


@pytest.mark.parametrize("robot", ["fanuc_r2000ic190s", "fanuc_r1000ia80f"])
def test_the_turn_that_controllers_reached(robot: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    lines = ["MODULE M"]
    for name, (x, y, z), turned, _ in TARGETS:
        w, i, j, k = matrix_to_quaternion(zyx_to_matrix([turned, 0.0, 0.0]) @ zyx_to_matrix([0.0, 180.0, 0.0]))
        sixth = 0 if turned <= 0.0 else -1
        conf = f"[{0 if y >= 0.0 else -1},0,{sixth},0]"
        lines.append(f"CONST robtarget {name}:=[[{x},{y},{z}],[{w:.9f},{i:.9f},{j:.9f},{k:.9f}],{conf},{UNUSED}];")
    moves = [f"MoveJ {name},v1000,fine,tool0;" for name, *_ in TARGETS]
    (tmp_path / "M.mod").write_text("\n".join([*lines, "PROC main()", *moves, "ENDPROC", "ENDMODULE", ""]))
    call = ["translate", str(tmp_path / "M.mod"), "--to", "tp", "--robot", "abb_irb6700_140_285", "--to-robot", robot]
    assert run([*call, "--json"]) == 0
    text = json.loads(capsys.readouterr().out)["files"][0]["text"]
    found = dict(re.findall(r'P\[\d+:"(\w+)"\]\{.*?CONFIG : \'([^\']*)\'', text, re.DOTALL))
    assert found == {name: f"N U T, 0, 0, {turn}" for name, _, _, turn in TARGETS}


def test_axes_of_the_same_posture() -> None:
    """(j1, j2, -(j2+j3), -j4, -j5, 180-j6), measured on RobotStudio and ROBOGUIDE."""
    abb, fanuc = load_robot("abb_irb6700_140_285"), load_robot("fanuc_r2000ic190s")
    postures = [[10.0, 20.0, 30.0, 200.0, 50.0, -60.0], [0.0] * 6, [-5.0, 7.0, -9.0, -30.0, -20.0, 190.0]]
    for joints in postures:
        one, two, three, four, five, six = joints
        wanted = [one, two, -(two + three), -four, -five, 180.0 - six]
        assert abb.same_posture(np.array(joints), fanuc) == pytest.approx(wanted)
        assert fanuc.same_posture(np.array(wanted), abb) == pytest.approx(joints)
    assert abb.same_posture(np.zeros(6), load_robot("ur5e")) == pytest.approx(load_robot("ur5e").home)


class _Bare:
    """Frames of a program that has neither a user frame nor a tool."""

    def pose(self, word: str, number: str) -> tuple[float, ...]:
        return (0.0,) * 6

    def only(self, word: str) -> str:
        return "0"


@pytest.mark.parametrize(("turn", "wrong"), [(0, True), (1, False), (2, True)])
def test_flags_that_no_joints_have_are_an_error(turn: int, wrong: bool) -> None:
    """J6 at 180 degrees exactly is turn 1, and the axis ends before turn 2 begins."""
    robot = load_robot("fanuc_lrmate200id")
    flange = robot.forward(np.array([0.0, 20.0, -20.0, 0.0, -50.0, 180.0]))
    values = tuple(float(one) for one in (*flange[:3, 3], *matrix_to_zyx(flange)))
    flags = {"flip": 0, "down": 0, "back": 0, "t1": 0, "t4": 0, "t6": turn}
    points = Points({1: Position("pose", values).with_flags(flags)})
    here = Origin(source_from_text("a.src", "PTP P1\n"), 0, 6)
    points.used(1, "0", "0", True, here)
    found = choose_postures(points, _Bare(), robot)  # type: ignore[arg-type]
    assert [(reached.number, reached.origin) for reached, _ in found] == ([(1, here)] if wrong else [])
    assert all("cannot be reached" in reason for _, reason in found)

"""The interactive screen without a browser: time and lines, the arm by hand, frames on surfaces, taught points."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from rpl.cell.layout import Layout, RobotPlace
from rpl.cell.shapes import Sphere
from rpl.diagnostics import Diagnostics
from rpl.emulator.model import load_robot
from rpl.errors import UsageError
from rpl.project import read_program
from rpl.simulation import run_program
from rpl.view.scene import scene_of
from rpl.view.screen import Loaded, Screen
from rpl.workcell.record import CellRun, RobotRun
from tests.runtime.helpers import ABB, KUKA
from tests.view.cells import LAYOUT, at, cell_run

KRL = """&ACCESS RVP
DEF prog( )
DECL E6POS XPICK
DECL AXIS XHOME
XHOME={A1 0.0,A2 -90.0,A3 90.0,A4 0.0,A5 45.0,A6 0.0}
XPICK={X 100.0,Y 20.0,Z 30.0,A 0.0,B 180.0,C 0.0}
$BASE={X 400.0,Y 0.0,Z 200.0,A 0.0,B 0.0,C 0.0}
PTP XHOME
LIN XPICK
WAIT SEC 0.5
PTP XHOME
END
"""
RAPID = """MODULE prog
  CONST robtarget pPick:=[[400,100,300],[0,0,1,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
  PROC main()
    MoveJ pPick,v500,fine,tool0;
  ENDPROC
ENDMODULE
"""
RPL = """VAR pick: POSE = {x: 400, y: 0, z: 300, a: 0, b: 180, c: 0}
MOVE TO pick
"""


def loaded(path: Path, robot: str) -> Loaded:
    diagnostics = Diagnostics()
    read = read_program([str(path)], None, diagnostics)
    assert not diagnostics.has_errors, [item.as_text() for item in diagnostics]
    model = load_robot(robot)
    result = run_program(read.program, model)
    place = RobotPlace(arm=robot)
    run = CellRun(Layout((place,)), (RobotRun(place, model, read.program, result),), time_s=result.time_s)
    return Loaded(scene_of(run), (read,))


def on_file(folder: Path, name: str, text: str, robot: str = KUKA) -> Screen:
    path = folder / name
    path.write_text(text)
    return Screen(loaded(path, robot), lambda: loaded(path, robot), Path.write_bytes)


@pytest.fixture
def screen() -> Screen:
    return Screen(Loaded(scene_of(cell_run()), ()))


# ---- time


def test_playing_goes_to_the_end_and_from_there_to_the_start(screen: Screen) -> None:
    screen.speed = 2.0
    screen.play()
    assert screen.tick(0.5)
    assert screen.time_s == pytest.approx(1.0)
    screen.tick(1e6)
    assert (screen.time_s, screen.playing) == (screen.scene.run.time_s, False)
    assert not screen.tick(1.0)
    screen.play()
    assert screen.time_s == 0.0


def test_stepping_passes_every_line_once(screen: Screen) -> None:
    wanted = [one.line for one in screen.scene.tracks[0].lines]
    found = [screen.lines()[0].line]
    while (line := screen.step(1)) is not None and screen.step_at < len(wanted) - 1:
        found.append(line.line)
    assert line is not None
    assert [*found, line.line][: len(wanted)] == wanted
    back = screen.step(-1)
    assert back is not None
    assert back.line == wanted[-2]


def test_a_single_line_is_played_from_its_start_to_the_next(screen: Screen) -> None:
    screen.run_line("p0.src", 7)
    begin = screen.time_s
    assert screen.playing
    screen.tick(100.0)
    assert not screen.playing
    line = screen.scene.tracks[0].line_at(begin)
    assert line is not None and line.line == 7
    assert begin < screen.time_s < screen.scene.run.time_s
    with pytest.raises(UsageError, match="does not come to"):
        screen.run_line("p0.src", 99)


# ---- by hand


def test_the_arm_follows_the_tool_that_is_dragged(screen: Screen) -> None:
    screen.go(1.5)
    wanted = screen.tool_pose() @ at(40.0, -30.0, -60.0)
    assert screen.drag(wanted) == []
    assert screen.tool_pose() == pytest.approx(wanted, abs=1e-6)
    held = [pose for body, pose in zip(screen.scene.bodies, screen.poses(), strict=True) if body.name == "plug"]
    assert held[0] is not None
    assert held[0][:3, 3] == pytest.approx(wanted[:3, 3], abs=1e-6)  # the part goes with the jaws
    screen.go(1.5)
    assert screen.joints()[0] == pytest.approx(screen.scene.joints_at(1.5)[0])


def test_out_of_reach_and_beyond_limits_is_said_and_the_arm_stays(screen: Screen) -> None:
    before = screen.here()
    assert screen.drag(at(5000.0, 0.0, 0.0)) == ["out of reach"]
    bent = screen.model.forward([0.0, -90.0, 90.0, 0.0, 130.0, 0.0])  # A5 goes to 120 only
    (word,) = screen.drag(LAYOUT.robots[0].base @ bent @ screen.tool())
    assert word.startswith("beyond the limits: J")
    assert screen.here() == pytest.approx(before)


def test_limits_and_singularities_near_by_are_said(screen: Screen) -> None:
    screen.go(1.0)
    assert screen.move_joint(0, 500.0) == ["J1 is 0.0 deg from its limit"]
    screen.go(1.0)
    assert any("wrist singularity" in word for word in screen.move_joint(4, 0.5))


# ---- frames


def test_a_frame_lies_on_the_true_surface_of_a_round_part() -> None:
    from dataclasses import replace

    ball = replace(LAYOUT.parts[0], shape=Sphere(60.0))
    run = replace(cell_run(), layout=replace(LAYOUT, parts=(ball,)))
    screen = Screen(Loaded(scene_of(run), ()))
    body = [one.kind for one in screen.scene.bodies].index("part")
    centre = np.array([500.0, 0.0, 30.0])
    way = np.array([0.31, -0.22, -1.0])
    frame = screen.frame_on(body, centre - 300.0 * way, way, "top")
    out = frame[:3, 3] - centre
    assert np.linalg.norm(out) == pytest.approx(30.0, abs=1e-9)  # facets lie up to 0.3 mm inside
    assert frame[:3, 2] == pytest.approx(out / 30.0, abs=1e-9)
    assert frame[:3, :3] @ frame[:3, :3].T == pytest.approx(np.eye(3), abs=1e-12)
    assert np.linalg.det(frame[:3, :3]) == pytest.approx(1.0)
    assert screen.frames["top"] is frame
    with pytest.raises(UsageError, match="passes by"):
        screen.frame_on(body, centre + 100.0, np.array([0.0, 0.0, 1.0]))


def test_the_tool_goes_onto_a_frame(screen: Screen) -> None:
    table = next(n for n, one in enumerate(screen.scene.bodies) if one.name == "table")
    screen.frame_on(table, np.array([550.0, 100.0, 900.0]), np.array([0.0, 0.0, -1.0]), "spot")
    screen.go_to_frame("spot")
    assert screen.tool_pose()[:3, 3] == pytest.approx([550.0, 100.0, 0.0], abs=1e-6)
    assert screen.tool_pose()[:3, 2] == pytest.approx([0.0, 0.0, -1.0], abs=1e-9)
    with pytest.raises(UsageError, match="no frame"):
        screen.go_to_frame("nowhere")


# ---- points in programs


@pytest.mark.parametrize(
    ("name", "text", "robot", "point"),
    [("prog.src", KRL, KUKA, "XPICK"), ("prog.mod", RAPID, ABB, "pPick"), ("prog.rpl", RPL, KUKA, "pick")],
)
def test_a_taught_point_changes_one_line_and_the_run_goes_there(
    tmp_path: Path, name: str, text: str, robot: str, point: str
) -> None:
    screen = on_file(tmp_path, name, text, robot)
    lines = [
        one for one in screen.scene.tracks[0].lines if text.splitlines()[one.line - 1].lower().count(point.lower())
    ]
    screen.run_line(name, lines[-1].line)
    screen.tick(1e6)
    moved = screen.tool_pose() @ at(12.5, -7.25, -20.0)
    assert screen.drag(moved) == []
    screen.teach(point)
    made = screen.save(point)
    after = (tmp_path / name).read_text()
    changed = [n for n, (a, b) in enumerate(zip(text.splitlines(), after.splitlines(), strict=True), 1) if a != b]
    assert changed == [made.line]
    assert point in made.text
    screen.run_line(name, lines[-1].line)
    screen.tick(1e6)
    assert screen.tool_pose() == pytest.approx(moved, abs=2e-3)


@pytest.mark.parametrize(
    ("name", "text", "robot"), [("prog.src", KRL, KUKA), ("prog.mod", RAPID, ABB), ("prog.rpl", RPL, KUKA)]
)
def test_a_new_point_is_a_new_line_like_that_of_another_one(tmp_path: Path, name: str, text: str, robot: str) -> None:
    screen = on_file(tmp_path, name, text.replace("DECL E6POS XPICK\n", "DECL E6POS XPICK,XNEW\n"), robot)
    before = (tmp_path / name).read_text().splitlines()
    screen.go(screen.scene.run.time_s)
    screen.teach("xNew")
    made = screen.save("xNew")
    after = (tmp_path / name).read_text().splitlines()
    assert after[: made.line - 1] + after[made.line :] == before
    assert "xNew" in after[made.line - 1]
    assert "xNew" in screen.as_rpl("xNew")


def test_what_cannot_be_taught_is_said(screen: Screen) -> None:
    with pytest.raises(UsageError, match="no name"):
        screen.teach("1 x")
    with pytest.raises(UsageError, match="has been taught"):
        screen.save("x")


# ---- lines that are typed


def test_typed_statements_run_from_where_the_arm_is(screen: Screen) -> None:
    screen.go(1.5)
    start = screen.tool_pose()
    assert screen.enter('MOVE LINEAR BY {z: -50} IN TOOL SPEED 100 mm/s\nMESSAGE "there"') == ["there"]
    assert screen.tool_pose() == pytest.approx(start, abs=1e-3)  # it has not set out yet
    while screen.tick(0.05):
        pass
    assert screen.tool_pose() == pytest.approx(start @ at(0.0, 0.0, -50.0), abs=1e-3)
    screen.teach("up")
    screen.go(0.0)
    assert screen.enter("MOVE TO up") == []
    while screen.tick(0.05):
        pass
    assert screen.tool_pose() == pytest.approx(start @ at(0.0, 0.0, -50.0), abs=1e-2)


def test_typed_mistakes_and_faults_are_said(screen: Screen) -> None:
    assert screen.enter("MOVE MOVE")
    before = screen.here()
    (word,) = screen.enter("MOVE TO {x: 9000, y: 0, z: 0, a: 0, b: 0, c: 0}")
    assert "reach" in word
    assert screen.here() == pytest.approx(before)

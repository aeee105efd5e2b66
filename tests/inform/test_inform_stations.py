"""SMOVL and SMOVC: paths on a station that turns, its axes in pulses, read, run, written and translated."""

import numpy as np
import pytest

from rpl.cell import parse_cell
from rpl.diagnostics import Diagnostics, Severity
from rpl.emulator.model import load_robot
from rpl.emulator.rotations import FloatArray, pose_matrix
from rpl.passes.legalise.facts.motion.pulsecounts import report_stations
from rpl.project import ReadProgram, read_sources
from rpl.proof.prove import prove_programs
from rpl.simulation import run_program
from rpl.source import source_from_bytes, source_from_text
from rpl.translation import Translation, translate_program

ARM = "motoman_gp25"
STATION = """
[[mechanism]]
name = "ST1"
also = ["GP2"]
kind = "rotary"
root = [800, 0, 100, 0, 0, 0]
axes = [{ number = 1, speed = 90, pulses = 800 }]
"""
TOOL = "[variables]\nTL1 = { x = 0, y = 0, z = 100, a = 0, b = 0, c = 0 }\n"
CELL = parse_cell(TOOL + STATION)
JOB = """/JOB
//NAME SEAM
//POS
///NPOS 3,0,3,0,0,0
///TOOL 1
///POSTYPE PULSE
///PULSE
EC00000=0
EC00001=36000
EC00002=72000
///POSTYPE BASE
///RECTAN
///RCONF 1,0,0,0,0,0,0,0
C00000=900.000,0.000,200.000,180.0000,0.0000,0.0000
C00001=900.000,0.000,200.000,180.0000,0.0000,0.0000
C00002=900.000,0.000,200.000,180.0000,0.0000,0.0000
//INST
///DATE 2024/05/06 08:00
///ATTR SC,RW
///GROUP1 RB1
///GROUP2 ST1
NOP
MOVJ C00000 VJ=40.00 PL=0  +MOVJ EC00000
{body}
DOUT OT#(1) ON
END
"""
LINE = "SMOVL C00002 V=50.0 PL=0  +MOVJ EC00002"
ARC = "SMOVC C00000 V=50.0  +MOVJ EC00000\nSMOVC C00001 V=50.0  +MOVJ EC00001\nSMOVC C00002 V=50.0 PL=0  +MOVJ EC00002"


def job(body: str) -> ReadProgram:
    return read_sources([source_from_text("seam.jbi", JOB.replace("{body}", body))], "inform", Diagnostics())


def on_the_plate(body: str, place: int) -> FloatArray:
    """Places (k, 3) of the tool on the plate along a move, from the joints and the station's angle alone."""
    result = run_program(job(body).program, ARM, CELL)
    assert result.status == "finished", result.fault
    plan = [event for event in result.trace if event.kind == "move"][place].legs[0].plan
    times = np.linspace(0.0, plan.duration_s, 21)
    tools = load_robot(ARM).forward(plan.joints_at(times)) @ pose_matrix([0, 0, 100])
    turned = np.deg2rad(plan.external_at(times)[:, 0])
    assert turned[-1] == pytest.approx(np.pi / 2)
    x, y = tools[:, 0, 3] - 800.0, tools[:, 1, 3]
    return np.stack(
        [np.cos(turned) * x + np.sin(turned) * y, np.cos(turned) * y - np.sin(turned) * x, tools[:, 2, 3]], axis=1
    )


def test_smovl_is_straight_on_the_plate() -> None:
    points = on_the_plate(LINE, 1)
    share = (100.0 - points[:, 0]) / 100.0
    assert points[:, 1] == pytest.approx(-100.0 * share, abs=1e-4)
    assert points[:, 2] == pytest.approx(np.full(21, 200.0), abs=1e-4)
    assert share[-1] == pytest.approx(1.0, abs=1e-6)


def test_smovc_is_round_on_the_plate() -> None:
    points = on_the_plate(ARC, 2)
    assert np.hypot(points[:, 0], points[:, 1]) == pytest.approx(np.full(21, 100.0), abs=1e-4)
    assert points[-1] == pytest.approx([0.0, -100.0, 200.0], abs=1e-4)


def test_the_speed_is_that_on_the_plate() -> None:
    result = run_program(job(LINE).program, ARM, CELL)
    plan = [event for event in result.trace if event.kind == "move"][1].legs[0].plan
    assert plan.length_mm == pytest.approx(np.hypot(100.0, 100.0), abs=1e-6)
    assert plan.duration_s == pytest.approx(np.hypot(100.0, 100.0) / 50.0, abs=0.5)


def test_a_plain_movl_stays_on_its_line_in_the_room() -> None:
    result = run_program(job(LINE.removeprefix("S")).program, ARM, CELL)
    plan = [event for event in result.trace if event.kind == "move"][1].legs[0].plan
    assert plan.length_mm == pytest.approx(0.0, abs=1e-6)
    assert plan.external_end[0] == pytest.approx(90.0)


def test_the_speed_behind_the_plus_is_that_of_the_station() -> None:
    slow = run_program(job("MOVL C00002 V=50.0 PL=0  +MOVJ EC00002 VJ=10.00").program, ARM, CELL)
    plan = [event for event in slow.trace if event.kind == "move"][1].legs[0].plan
    assert plan.duration_s >= 90.0 / 9.0  # a tenth of 90 deg/s


def test_a_station_that_nobody_has_placed_is_a_fault() -> None:
    result = run_program(job(LINE).program, ARM, parse_cell(TOOL))
    assert result.fault is not None
    assert result.fault.code == "no-mechanism"
    assert "'ST1'" in result.fault.message


def test_pulses_that_nobody_knows_are_told() -> None:
    read, told = job(LINE), Diagnostics()
    report_stations(read.program, load_robot(ARM), told)
    assert [item.code.name for item in told] == ["station-pulses"]
    report_stations(read.program, load_robot(ARM).among(CELL.mechanisms, "cell"), quiet := Diagnostics())
    assert not list(quiet)


def test_without_a_station_beside_it_the_path_is_taken_in_the_room() -> None:
    diagnostics = Diagnostics()
    text = JOB.replace("{body}", "SMOVL C00002 V=50.0 PL=0")
    read_sources([source_from_text("seam.jbi", text)], "inform", diagnostics)
    assert "inform-coordinated" in [item.code.name for item in diagnostics]


def written(body: str, target: str, robot: str = ARM) -> tuple[Translation, Diagnostics, str]:
    diagnostics = Diagnostics()
    given = dict(CELL.variables)
    done = translate_program(job(body), target, robot, None, diagnostics, given=given, mechanisms=CELL.mechanisms)
    return done, diagnostics, "\n".join(file.data.decode("latin-1") for file in done.files)


@pytest.mark.parametrize("body", [LINE, ARC], ids=["line", "arc"])
@pytest.mark.parametrize("target", ["inform", "tp", "rpl"])
def test_the_station_comes_through(body: str, target: str) -> None:
    done, diagnostics, text = written(body, target)
    assert not [item.message for item in diagnostics if item.severity in (Severity.LOSS, Severity.ERROR)]
    back = read_sources([source_from_bytes(file.path, file.data) for file in done.files], target, Diagnostics())
    to_entry = done.renamed.get("SEAM", "SEAM")
    result = prove_programs(job(body).program, back.program, ARM, ARM, CELL, entry="SEAM", to_entry=to_entry)
    assert result.agrees, result.as_text()
    if target == "tp":
        assert "DEFAULT_GROUP\t= 1,1,*,*,*" in text
        assert "COORD" in text and "J1=    90.000 deg" in text
        assert "tp-leader" in [item.code.name for item in diagnostics]


@pytest.mark.parametrize("target", ["rapid", "krl", "urscript", "vplus"])
def test_others_name_the_loss(target: str) -> None:
    _, diagnostics, _ = written(LINE, target)
    assert "coordinated-move-lost" in [item.code.name for item in diagnostics.of(Severity.LOSS)]


KRL = """DEF seam( )
PTP {A1 0,A2 -90,A3 90,A4 0,A5 90,A6 0,E1 0}
LIN {X 650,Y 0,Z 600,A 180,B 0,C 180,E1 30}
LIN {X 650,Y 100,Z 600,A 180,B 0,C 180}
LIN {X 650,Y 0,Z 600,A 180,B 0,C 180,E1 0}
$OUT[1]=TRUE
END
"""


def test_external_axes_of_others_become_pulses_of_a_station() -> None:
    read, diagnostics = read_sources([source_from_text("seam.src", KRL)], "krl", Diagnostics()), Diagnostics()
    arm = "kuka_kr10r1420"
    done = translate_program(read, "inform", arm, None, diagnostics, mechanisms=CELL.mechanisms)
    text = done.files[0].data.decode("ascii")
    assert "=24000" in text and "=0" in text  # 30 degrees of 800 pulses
    assert text.count("+MOVJ EC") == 4
    assert "///GROUP2 ST1" in text
    back = read_sources([source_from_bytes(file.path, file.data) for file in done.files], "inform", Diagnostics())
    result = prove_programs(read.program, back.program, arm, arm, CELL, entry="seam", to_entry="SEAM")
    assert result.agrees, result.as_text()


def test_a_track_becomes_base_axes() -> None:
    rail = parse_cell(
        '[[mechanism]]\nname = "rail"\nkind = "track"\naxes = [{ number = 1, direction = "y", pulses = 200 }]\n'
    )
    read = read_sources([source_from_text("seam.src", KRL)], "krl", Diagnostics())
    done = translate_program(read, "inform", "kuka_kr10r1420", None, Diagnostics(), mechanisms=rail.mechanisms)
    text = done.files[0].data.decode("ascii")
    assert "///GROUP1 RB1,BS1" in text and "GROUP2" not in text
    assert text.count(" BC0000") == 4 and "+MOVJ" not in text
    back = read_sources([source_from_bytes(file.path, file.data) for file in done.files], "inform", Diagnostics())
    result = prove_programs(
        read.program, back.program, "kuka_kr10r1420", "kuka_kr10r1420", rail, entry="seam", to_entry="SEAM"
    )
    assert result.agrees, result.as_text()


def test_unknown_pulses_of_a_station_are_not_guessed() -> None:
    read, diagnostics = read_sources([source_from_text("seam.src", KRL)], "krl", Diagnostics()), Diagnostics()
    translate_program(read, "inform", ARM, None, diagnostics)
    assert any("pulses, which are not known here" in item.message for item in diagnostics.of(Severity.LOSS))

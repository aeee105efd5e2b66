"""COORD: a path straight in the moving frame of the leader, which a cell file describes under the name GP2."""

import numpy as np
import pytest

from rpl.cell import parse_cell
from rpl.diagnostics import Diagnostics
from rpl.emulator.model import load_robot
from rpl.emulator.rotations import pose_matrix
from rpl.project import ReadProgram, read_sources
from rpl.proof.prove import prove_programs
from rpl.simulation import run_program
from rpl.source import source_from_bytes, source_from_text
from rpl.translation import translate_program

ARM = "fanuc_m20ia"
TABLE = """
[[mechanism]]
name = "GP2"
also = ["ST1"]
kind = "rotary"
root = [800, 0, 100, 0, 0, 0]
axes = [{ number = 1, speed = 90 }]
"""
TOOL = """
[variables]
"UTOOL[1]" = { x = 0, y = 0, z = 100, a = 0, b = 0, c = 0 }
"""
LISTING = """/PROG  COORDT
/ATTR
/MN
   1:  UFRAME_NUM=0 ;
   2:  UTOOL_NUM=1 ;
   3:J P[1] 50% FINE    ;
   4:L P[2] 100mm/sec FINE    ;
   5:L P[3] 100mm/sec FINE COORD    ;
   6:  DO[1]=ON ;
/POS
P[1]{
   GP1:
    UF : 0, UT : 1,
    J1=     0.000 deg,    J2=     0.000 deg,    J3=     0.000 deg,
    J4=     0.000 deg,    J5=   -90.000 deg,    J6=     0.000 deg
   GP2:
    UF : 0, UT : 1,
    J1=     0.000 deg
};
P[2]{
   GP1:
    UF : 0, UT : 1,  CONFIG : 'N U T, 0, 0, 0',
    X =   900.000  mm,  Y =     0.000  mm,  Z =   200.000  mm,
    W =   180.000 deg,  P =     0.000 deg,  R =     0.000 deg
   GP2:
    UF : 0, UT : 1,
    J1=     0.000 deg
};
P[3]{
   GP1:
    UF : 0, UT : 1,  CONFIG : 'N U T, 0, 0, 0',
    X =   800.000  mm,  Y =   100.000  mm,  Z =   200.000  mm,
    W =   180.000 deg,  P =     0.000 deg,  R =    90.000 deg
   GP2:
    UF : 0, UT : 1,
    J1=    90.000 deg
};
/END
"""


def listing() -> ReadProgram:
    return read_sources([source_from_text("coordt.ls", LISTING)], "tp", Diagnostics())


def test_the_tool_stays_on_its_point_of_the_turning_leader() -> None:
    result = run_program(listing().program, ARM, parse_cell(TOOL + TABLE))
    assert result.status == "finished", result.fault
    plan = [event for event in result.trace if event.kind == "move"][2].legs[0].plan
    times = np.linspace(0.0, plan.duration_s, 21)
    tools = load_robot(ARM).forward(plan.joints_at(times)) @ pose_matrix([0, 0, 100])
    turned = np.deg2rad(plan.external_at(times)[:, 0])
    # P[2] and P[3] are the same point of the table: 100 mm from its axis; in between the tool goes round with it
    assert tools[:, 0, 3] == pytest.approx(800 + 100 * np.cos(turned), abs=1e-4)
    assert tools[:, 1, 3] == pytest.approx(100 * np.sin(turned), abs=1e-4)
    assert plan.length_mm == pytest.approx(0.0, abs=1e-6)
    assert turned[-1] == pytest.approx(np.pi / 2)


def test_without_the_word_the_way_is_straight_in_the_room() -> None:
    plain = read_sources([source_from_text("coordt.ls", LISTING.replace(" COORD", ""))], "tp", Diagnostics())
    result = run_program(plain.program, ARM, parse_cell(TOOL + TABLE))
    plan = [event for event in result.trace if event.kind == "move"][2].legs[0].plan
    assert plan.length_mm == pytest.approx(np.hypot(100, 100), abs=1e-6)


def test_a_leader_that_nobody_has_placed_is_a_fault() -> None:
    result = run_program(listing().program, ARM, parse_cell(TOOL))
    assert result.fault is not None
    assert result.fault.code == "no-mechanism"


@pytest.mark.parametrize(
    ("target", "word"),
    [("tp", "FINE COORD"), ("rpl", '$coordinated = "GP2"'), ("inform", "SMOVL C00002 V=100.0 PL=0  +MOVJ")],
)
def test_the_word_comes_through(target: str, word: str) -> None:
    read, diagnostics = listing(), Diagnostics()
    cell = parse_cell(TOOL + TABLE)
    written = translate_program(read, target, ARM, None, diagnostics, given=cell.variables)
    assert word in "\n".join(file.data.decode("latin-1") for file in written.files)
    assert not [item for item in diagnostics if item.severity.word in ("loss", "error")]
    back = read_sources([source_from_bytes(file.path, file.data) for file in written.files], target, Diagnostics())
    to_entry = written.renamed.get("COORDT", "COORDT")
    result = prove_programs(read.program, back.program, ARM, ARM, cell, entry="COORDT", to_entry=to_entry)
    assert result.agrees, result.as_text()


@pytest.mark.parametrize("target", ["rapid", "krl", "urscript", "vplus"])
def test_other_targets_name_the_loss(target: str) -> None:
    diagnostics = Diagnostics()
    translate_program(listing(), target, ARM, None, diagnostics)
    assert "coordinated-move-lost" in [item.code.name for item in diagnostics if item.severity.word == "loss"]


SECOND = """   GP2:
    UF : 0, UT : 1,  CONFIG : 'N U T, 0, 0, 0',
    X =   500.000  mm,  Y =     0.000  mm,  Z =   200.000  mm,
    W =   180.000 deg,  P =     0.000 deg,  R =    90.000 deg
};
/END
"""


def test_places_of_a_second_arm_are_not_dropped() -> None:
    at = LISTING.rindex("   GP2:")
    diagnostics = Diagnostics()
    text = LISTING[:at] + SECOND
    read = read_sources([source_from_text("coordt.ls", text)], "tp", diagnostics)
    told = [item for item in diagnostics if item.code.name == "tp-second-arm"]
    assert [item.origin.line for item in told] == [text[: text.index("L P[3]")].count("\n") + 1]
    result = run_program(read.program, ARM, parse_cell(TOOL + TABLE))
    assert result.status == "fault"
    assert len([event for event in result.trace if event.kind == "move"]) == 2


def remote() -> ReadProgram:
    """The fixed tool stands at the user frame; the part is in the gripper."""
    text = (
        LISTING.replace("UFRAME_NUM=0", "UFRAME_NUM=1").replace("UF : 0", "UF : 1").replace("FINE COORD", "FINE RTCP")
    )
    return read_sources([source_from_text("coordt.ls", text)], "tp", Diagnostics())


FIXED = TOOL + '"UFRAME[1]" = { x = 30, y = -20, z = 40, a = 0, b = 0, c = 0 }\n'


def test_rtcp_is_straight_in_the_part_that_the_robot_holds() -> None:
    result = run_program(remote().program, ARM, parse_cell(FIXED + TABLE))
    assert result.status == "finished", result.fault
    plan = [event for event in result.trace if event.kind == "move"][2].legs[0].plan
    flanges = load_robot(ARM).forward(plan.joints_at(np.linspace(0.0, plan.duration_s, 31)))
    fixed = np.array([30.0, -20.0, 40.0, 1.0])
    on_part = (np.linalg.inv(flanges) @ fixed)[:, :3]  # where the room's tool is on the part
    way = on_part[-1] - on_part[0]
    off = np.cross(on_part - on_part[0], way) / np.linalg.norm(way)
    assert np.linalg.norm(off, axis=1).max() < 1e-4
    assert plan.length_mm == pytest.approx(np.linalg.norm(way), abs=1e-4)
    # it ends where the position says: the tool's own place in the user frame
    tool = flanges[-1] @ pose_matrix([0, 0, 100])
    assert tool[:3, 3] == pytest.approx([830.0, 80.0, 240.0], abs=1e-4)


@pytest.mark.parametrize(("target", "word"), [("tp", "FINE RTCP"), ("rpl", "$remote_tool = TRUE")])
def test_rtcp_comes_through(target: str, word: str) -> None:
    read, cell = remote(), parse_cell(FIXED + TABLE)
    written = translate_program(read, target, ARM, None, Diagnostics(), given=cell.variables)
    assert word in "\n".join(file.data.decode("latin-1") for file in written.files)
    back = read_sources([source_from_bytes(file.path, file.data) for file in written.files], target, Diagnostics())
    result = prove_programs(read.program, back.program, ARM, ARM, cell, entry="COORDT", to_entry="COORDT")
    assert result.agrees, result.as_text()


@pytest.mark.parametrize("target", ["rapid", "krl", "inform", "urscript", "vplus"])
def test_rtcp_is_named_where_it_is_lost(target: str) -> None:
    diagnostics = Diagnostics()
    translate_program(remote(), target, ARM, None, diagnostics)
    assert "remote-tool-lost" in [item.code.name for item in diagnostics if item.severity.word == "loss"]

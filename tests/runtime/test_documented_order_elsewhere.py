"""When and where things happen in FANUC TP, URScript, V+, INFORM and RPL, each by a program of that language.

UG: V+ Language User's Guide (forward processing, breaking continuous path, reactions). S5: URScript manual 5.2. FANUC,
INFORM: what is marked M in the dialects' rules is no manual's word and is held here to the number of the rules.
"""

from __future__ import annotations

import numpy as np
import pytest
from helpers import moves, run, time_of, tool_at

from rpl.emulator.model import load_robot
from rpl.runtime.trace import Leg, RunResult

NEAR = 0.05  # mm


def done(dialect: str, text: str, robot: str, cell: str | None = None, entry: str | None = None) -> RunResult:
    options = {"entry": entry} if entry is not None else {}
    result = run(dialect, text, robot, cell, **options)
    assert result.status == "finished", result.fault
    return result


def corner_of(result: RunResult) -> Leg:
    return next(leg for event in moves(result) for leg in event.legs if leg.plan.kind == "corner")


def speed_at(result: RunResult, when: float) -> float:
    return float(np.linalg.norm(tool_at(result, when + 0.001) - tool_at(result, when - 0.001)) / 0.002)


# ---- FANUC TP

LRMATE = "fanuc_lrmate200id"


def position(number: int, x: float, y: float, z: float) -> str:
    return (
        f"P[{number}]{{\n   GP1:\n\tUF : 0, UT : 1,\t\tCONFIG : 'N U T, 0, 0, 0',\n"
        f"\tX = {x:.3f}  mm,\tY = {y:.3f}  mm,\tZ = {z:.3f}  mm,\n"
        f"\tW = 180.000 deg,\tP = 0.000 deg,\tR = 0.000 deg\n}};\n"
    )


def tp(*lines: str, cell: str | None = None) -> RunResult:
    """From (400, 0, 200) on; P[2] lies 100 mm away in y, P[3] another 100 mm in z."""
    points = position(1, 400, 0, 200) + position(2, 400, 100, 200) + position(3, 400, 100, 300)
    steps = ["J P[1] 20% FINE", *lines]
    numbered = "\n".join(f"{n:4d}:{'' if line[1] == ' ' else '  '}{line} ;" for n, line in enumerate(steps, 1))
    text = f'/PROG  MAIN\n/ATTR\nCOMMENT\t\t= "test";\n/MN\n{numbered}\n/POS\n{points}/END\n'
    return done("tp", text, LRMATE, cell, "MAIN")


def tp_place(result: RunResult, name: str = "DO[1]") -> np.ndarray:
    return tool_at(result, time_of(result, name)) - tool_at(result, moves(result)[0].t)


@pytest.mark.parametrize(
    ("line", "y"),
    [
        ("L P[2] 100mm/sec FINE DB  10.0mm,DO[1]=ON", 90.0),  # so many mm before the point
        ("L P[2] 100mm/sec FINE DB  60.0mm,DO[1]=ON", 40.0),
        ("L P[2] 100mm/sec FINE", 100.0),  # behind FINE when the robot is there
    ],
)
def test_tp_places(line: str, y: float) -> None:
    result = tp(line, "DO[1]=ON")
    assert tp_place(result) == pytest.approx([0.0, y, 0.0], abs=NEAR)


@pytest.mark.parametrize(("word", "seconds"), [("TB    .20sec", -0.2), ("TB    .50sec", -0.5), ("TA    .20sec", 0.2)])
def test_tp_times_count_from_the_arrival(word: str, seconds: float) -> None:
    result = tp(f"L P[2] 100mm/sec FINE {word},DO[1]=ON", "WAIT    .50(sec)")
    assert time_of(result, "DO[1]") == pytest.approx(moves(result)[1].t + seconds, abs=1e-6)


def test_tp_logic_behind_a_continuous_move_runs_where_the_corner_begins() -> None:
    """M: the program goes on where the next move takes over."""
    result = tp("L P[2] 100mm/sec CNT100", "DO[1]=ON", "L P[3] 100mm/sec FINE")
    assert time_of(result, "DO[1]") == pytest.approx(corner_of(result).start_s, abs=0.002)


def test_tp_skip_takes_the_place_and_goes_on_with_the_next_line() -> None:
    """The label is for a motion that ends without the condition."""
    lines = ("SKIP CONDITION DI[1]=ON", "L P[2] 50mm/sec FINE Skip,LBL[1],PR[5]=LPOS", "R[1]=PR[5,2]", "DO[1]=ON",
             "LBL[1]", "DO[2]=ON")  # fmt: skip
    began = moves(tp("L P[2] 50mm/sec FINE"))[0].t
    hit = tp(*lines, cell=f"[[input]]\ntime={began + 1.0}\nsignal='DI[1]'\nvalue=true\n")
    there = tp_place(hit)[1]
    assert [name for _, name, _ in hit.outputs] == ["DO[1]", "DO[2]"]
    assert there == pytest.approx(tool_at(hit, began + 1.0)[1], abs=10.0) and 30.0 < there < 60.0
    assert [name for _, name, _ in tp(*lines).outputs] == ["DO[2]"]


# ---- V+

VIPER = "adept_viper_s650"
V_START = "SET a = TRANS(400,0,300,0,180,0)\nSET b = a:TRANS(0,100,0)\nSET c = b:TRANS(0,0,-100)\nMOVE a\nBREAK\n"


def vplus(steps: str, more: str = "", cell: str | None = None) -> RunResult:
    return done("vplus", f".PROGRAM test()\n{V_START}{steps}\n.END\n{more}", VIPER, cell, "test")


def test_vplus_a_step_behind_a_move_acts_when_that_move_begins() -> None:
    """UG, motion control: MOVE starts the motion and the program goes on; the next one waits until that is done."""
    result = vplus(
        "SPEED 100 MMPS ALWAYS\nNULL ALWAYS\nCPOFF ALWAYS\nMOVES b\nSIGNAL 1\nMOVES c\nSIGNAL 2\nBREAK\nSIGNAL 3"
    )
    first, second = moves(result)[1:3]
    assert time_of(result, "1") == pytest.approx(first.legs[0].start_s, abs=1e-6)
    assert time_of(result, "2") == pytest.approx(second.legs[0].start_s, abs=1e-6)
    assert time_of(result, "3") == pytest.approx(second.t, abs=1e-6)


@pytest.mark.parametrize("step", ["BREAK", "TOOL NULL", "BASE NULL", "OPENI", "CLOSEI"])
def test_vplus_what_breaks_the_continuous_path(step: str) -> None:
    """UG, breaking continuous-path operation."""
    through = vplus("SPEED 100 MMPS ALWAYS\nMOVES b\nMOVES c")
    assert [leg for event in moves(through) for leg in event.legs if leg.plan.kind == "corner"]
    broken = vplus(f"SPEED 100 MMPS ALWAYS\nMOVES b\n{step}\nMOVES c")
    assert not [leg for event in moves(broken) for leg in event.legs if leg.plan.kind == "corner"]


def test_vplus_a_reaction_stops_the_motion_and_drops_its_rest() -> None:
    """UG, REACTI: the present motion is stopped at once and not resumed; the routine runs, then the next step."""
    steps = "REACTI 1001, hit\nSPEED 50 MMPS ALWAYS\nMOVES b\nBREAK\nSIGNAL 2\nMOVES c\nBREAK\nSIGNAL 3"
    began = moves(vplus("SPEED 50 MMPS ALWAYS\nMOVES b"))[0].t
    cell = f"[[input]]\ntime={began + 1.0}\nsignal='1001'\nvalue=true\n"
    result = vplus(steps, ".PROGRAM hit()\nSIGNAL 1\n.END\n", cell)
    stopped = moves(result)[1]
    assert stopped.data["interrupted"] and 0.0 < tool_at(result, stopped.t)[1] < 99.0
    assert [name for _, name, _ in result.outputs] == ["1", "2", "3"]
    assert tool_at(result, time_of(result, "3"))[1] == pytest.approx(100.0, abs=NEAR)


# ---- URScript

UR_START = "  movej([0, -1.57, 1.57, -1.57, -1.57, 0], a=3, v=1)\n  p0 = get_target_tcp_pose()\n"


def urscript(*lines: str) -> RunResult:
    body = "".join(f"  {line}\n" for line in lines)
    return done("urscript", f"def prog():\n{UR_START}{body}end\n", "ur5e")


BEFORE, BEHIND = "p1 = pose_add(p0, p[0,0.1,0,0,0,0])", "p2 = pose_add(p1, p[0,0,0.1,0,0,0])"


def test_urscript_a_move_without_a_blend_is_over_before_the_next_line() -> None:
    """S5, movel: blend radius 0."""
    result = urscript(BEFORE, "movel(p1, a=1, v=0.1)", "set_standard_digital_out(0, True)", "sleep(0.1)")
    assert time_of(result, "digital_out[0]") == pytest.approx(moves(result)[1].t, abs=1e-6)


def test_urscript_the_next_lines_run_where_the_blend_begins() -> None:
    """S5, movel: the blend begins r before the point; a wait there ends it."""
    lines = (BEFORE, BEHIND, "movel(p1, a=1, v=0.1, r=0.02)", "set_standard_digital_out(0, True)")
    result = urscript(*lines, "movel(p2, a=1, v=0.1)")
    switched = tool_at(result, time_of(result, "digital_out[0]")) - tool_at(result, moves(result)[0].t)
    assert switched == pytest.approx([0.0, 80.0, 0.0], abs=0.3)
    assert speed_at(result, time_of(result, "digital_out[0]") - 0.01) > 50.0
    waits = urscript(*lines, "sleep(2)", "movel(p2, a=1, v=0.1)")
    assert all(event.stops for event in moves(waits))


# ---- INFORM

JOB = (
    "/JOB\n//NAME TEST\n//POS\n///NPOS 0,0,0,3,0,0\n///TOOL 0\n///POSTYPE BASE\n///RECTAN\n///RCONF 1,0,0,0,0,0\n"
    "P00001=450.000,0.000,200.000,180.0000,0.0000,0.0000\nP00002=450.000,100.000,200.000,180.0000,0.0000,0.0000\n"
    "P00003=450.000,100.000,300.000,180.0000,0.0000,0.0000\n//INST\n///DATE 2024/01/01 00:00\n///ATTR SC,RW\n"
    "///GROUP1 RB1\nNOP\nMOVJ P001 VJ=20.00 PL=0\n{}\nEND\n"
)


def inform(*lines: str) -> RunResult:
    return done("inform", JOB.format("\n".join(lines)), "motoman_gp7", None, "TEST")


@pytest.mark.parametrize(
    ("lines", "y"),
    [
        (("MOVL P002 V=100.0 PL=0", "DOUT OT#(1) ON"), 100.0),  # behind an exact point when the robot is there
        (("MOVL P002 V=100.0 PL=0 NWAIT", "DOUT OT#(1) ON", "TIMER T=0.10"), 0.0),  # NWAIT: with the motion
    ],
)
def test_inform_logic_and_nwait(lines: tuple[str, ...], y: float) -> None:
    result = inform(*lines)
    place = tool_at(result, time_of(result, "OT#(1)")) - tool_at(result, moves(result)[0].t)
    assert place == pytest.approx([0.0, y, 0.0], abs=NEAR)


# ---- RPL


@pytest.mark.parametrize(
    ("clause", "y"),
    [("AT end DISTANCE -30 mm", 70.0), ("AT START DISTANCE 25 mm", 25.0), ("AT END", 100.0), ("AT START", 0.0)],
)
def test_rpl_triggers(clause: str, y: float) -> None:
    """docs/rpl.md, path events."""
    pose = "{{x: 350, y: {}, z: 400, a: 0, b: 150, c: 0}}"
    text = (
        "MODULE m\nPROCEDURE main()\nMOVE TO {j1: 0, j2: 0, j3: 0, j4: 0, j5: 30, j6: 0}\n"
        f"MOVE LINEAR TO {pose.format(0)} SPEED 200 mm/s\n"
        f"TRIGGER {clause} DO SET do[1] TO ON\n"
        f"MOVE LINEAR TO {pose.format(100)} SPEED 100 mm/s\nEND PROCEDURE\nEND MODULE\n"
    )
    result = done("rpl", text, "abb_irb120_3_58")
    place = tool_at(result, result.outputs[0][0]) - tool_at(result, moves(result)[1].t)
    assert place == pytest.approx([0.0, y, 0.0], abs=NEAR)


def test_the_arms_of_these_tests_are_there() -> None:
    assert [load_robot(name).axes for name in (LRMATE, VIPER, "ur5e", "motoman_gp7")] == [6, 6, 6, 6]

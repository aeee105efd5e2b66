"""Percents, times, accelerations and corners that no controller takes: told when read, and a fault of the run.

Sources: FANUC operator's manual (motion instructions: J 1 to 100 %, CNT 0 to 100; OVERRIDE 1 to 100 %), Yaskawa INFORM
manual (VJ 0.01 to 100 %), ABB RAPID Reference Manual (AccSet), V+ Language Reference Guide (ACCEL). M, tested here as
what the emulator does: RAPID \\T:=0, TP moves in 0 s, numbers of TP frames, KRL percentages beyond 100.
"""

from __future__ import annotations

import pytest
from helpers import ABB, KUKA, run
from test_wrong_input import P0, krl_text, module, told

VALUE, HELD, LEAST, UNIT = (
    "motion-value-out-of-range",
    "motion-value-held",
    "motion-value-least",
    "unit-does-not-fit",
)
OURS = (VALUE, HELD, LEAST, UNIT)
ROBOTS = {
    "tp": "fanuc_lrmate200id",
    "krl": KUKA,
    "rapid": ABB,
    "urscript": "ur5e",
    "vplus": "adept_viper_s650",
    "inform": "motoman_gp7",
    "rpl": KUKA,
}


def tp(*lines: str) -> str:
    places = "".join(
        f"P[{number}]{{\n   GP1:\n\tUF : 0, UT : 1,\t\tCONFIG : 'N U T, 0, 0, 0',\n\tX = {x}.000  mm,\tY = {y}.000  mm,"
        "\tZ = 300.000  mm,\n\tW = 180.000 deg,\tP = 0.000 deg,\tR = 135.000 deg\n};\n"
        for number, (x, y) in enumerate(((400, 0), (460, 0), (460, 200)), 1)
    )
    numbered = "".join(f"{number:4d}:{line} ;\n" for number, line in enumerate(lines, 1))
    return f"/PROG  P\n/ATTR\n/MN\n{numbered}/POS\n{places}/END\n"


def inform(*lines: str) -> str:
    head = (
        "/JOB\n//NAME T\n//POS\n///NPOS 2,0,0,0,0,0\n///TOOL 0\n///POSTYPE BASE\n///RECTAN\n///RCONF 1,0,0,0,0,0\n"
        "C00000=300.000,0.000,350.000,180.0000,0.0000,0.0000\nC00001=300.000,60.000,350.000,180.0000,0.0000,0.0000\n"
        "//INST\n///DATE 2024/05/06 09:00\n///ATTR SC,RW\n///GROUP1 RB1\nNOP\n"
    )
    return head + "\n".join((*lines, "END\n"))


def program(dialect: str, *lines: str) -> str:
    """The lines behind a first move, in a program of that language."""
    match dialect:
        case "tp":
            return tp(*lines)
        case "inform":
            return inform(*lines)
        case "krl":
            return krl_text(*lines)
        case "rapid":
            return module(*lines, data=(NEGATIVE_ZONE,))
        case "urscript":
            return "\n".join(("def prog():", "  movej([0,-1.57,1.57,-1.57,-1.57,0])", *lines, "end\n"))
        case "vplus":
            return "\n".join((".PROGRAM p()", "MOVE #PPOINT(0,-90,180,0,60,0)", *lines, ".END\n"))
    home = "MOVE TO {j1: 0, j2: -90, j3: 90, j4: 0, j5: 60, j6: 0}"
    return "\n".join(("PROCEDURE main()", home, *lines, "END PROCEDURE\n"))


NEGATIVE_ZONE = "CONST zonedata zn:=[FALSE,-5,0,0,0,0,0];"
PTP = "PTP {A1 5,A2 -90,A3 90,A4 0,A5 45,A6 0}"
UR = "movej([0,-1.57,1.5,-1.57,-1.57,0]"
VP = "MOVE #PPOINT(0,-80,180,0,60,0)"
GO = "MOVE TO {j1: 10, j2: -90, j3: 90, j4: 0, j5: 60, j6: 0}"

# Language, lines, what is told with its line, line of the fault (0: it runs to its end).
CASES: list[tuple[str, tuple[str, ...], list[tuple[str, int]], int]] = [
    ("tp", ("J P[1] 150% FINE",), [(VALUE, 4)], 4),
    ("tp", ("R[1]=150", "J P[1] R[1]% FINE"), [], 5),
    ("tp", ("J P[1] 100% CNT100",), [], 0),
    ("tp", ("J P[1] 30% FINE", "L P[2] 100mm/sec CNT150", "L P[3] 100mm/sec FINE"), [(VALUE, 5)], 5),
    ("tp", ("J P[1] 30% FINE", "L P[2] 0.0sec FINE"), [(VALUE, 5)], 5),
    ("tp", ("J P[1] 30% FINE", "L P[2] 100mm/sec FINE ACC0"), [(HELD, 5)], 0),
    ("tp", ("OVERRIDE=0%", "J P[1] 30% FINE"), [(VALUE, 4)], 4),
    ("tp", ("OVERRIDE=101%", "J P[1] 30% FINE"), [(VALUE, 4)], 4),
    ("tp", ("OVERRIDE=1%", "J P[1] 30% FINE"), [], 0),
    ("tp", ("UTOOL_NUM=99", "J P[1] 30% FINE"), [(VALUE, 4)], 4),
    ("tp", ("UFRAME_NUM=10", "J P[1] 30% FINE"), [(VALUE, 4)], 4),
    ("krl", ("$APO.CDIS=-5", PTP), [(VALUE, 5)], 5),
    ("krl", ("$APO.CVEL=150", PTP), [(VALUE, 5)], 5),
    ("krl", ("$APO.CPTP=-1", PTP), [(VALUE, 5)], 5),
    ("krl", ("$APO.CDIS=5", "$APO.CPTP=100", PTP), [], 0),
    ("krl", ("$VEL_AXIS[1]=150", PTP), [(VALUE, 5)], 5),
    ("krl", ("$ACC_AXIS[1]=0", PTP), [(VALUE, 5)], 5),
    ("krl", ("$ACC.CP=-1", PTP), [(VALUE, 5)], 5),
    ("krl", ("$OV_PRO=150", PTP), [(VALUE, 5)], 5),
    ("krl", ("$OV_PRO=0", PTP), [(LEAST, 5)], 0),
    ("rapid", ("MoveL p1,v100\\T:=0,fine,tPen;",), [(VALUE, 8)], 8),
    ("rapid", ("MoveL p1,v100\\T:=2,fine,tPen;",), [], 0),
    ("rapid", ("MoveL p1,v100,z10\\Z:=-5,tPen;", "MoveL p0,v100,fine,tPen;"), [(VALUE, 8)], 8),
    ("rapid", ("MoveL p1,v100,zn,tPen;", "MoveL p0,v100,fine,tPen;"), [(VALUE, 8)], 8),
    ("rapid", ("VelSet 0,800;", "MoveL p1,v100,fine,tPen;"), [(VALUE, 8)], 8),
    ("rapid", ("AccSet 0,100;", "MoveL p1,v100,fine,tPen;"), [(HELD, 8)], 0),
    ("urscript", (f"{UR},t=-1)",), [(VALUE, 3)], 3),
    ("urscript", (f"{UR},t=0)",), [], 0),
    ("urscript", (f"{UR},a=0)",), [(VALUE, 3)], 3),
    ("urscript", (f"{UR},r=-0.1)",), [(VALUE, 3)], 3),
    ("urscript", ("slow=0", f"{UR},a=slow)"), [], 4),
    ("vplus", ("ACCEL 0,0", VP), [(HELD, 3), (HELD, 3)], 0),
    ("vplus", ("SPEED 0 MONITOR", VP), [(VALUE, 3)], 3),
    ("inform", ("MOVJ C00000 VJ=150.00",), [(VALUE, 16)], 16),
    ("inform", ("MOVJ C00000 VJ=100.00",), [], 0),
    ("inform", ("MOVJ C00000 VJ=10.00 ACC=0",), [(HELD, 16)], 0),
    ("rpl", (f"{GO} JOINT SPEED 150 %",), [(VALUE, 3)], 3),
    ("rpl", (f"{GO} JOINT SPEED 100 %",), [], 0),
    ("rpl", (f"{GO} BLEND PERCENT 150 %", GO), [(VALUE, 3)], 3),
    ("rpl", ("MOVE LINEAR BY {z: -80} IN TOOL BLEND -5 mm", GO), [(VALUE, 3)], 3),
    ("rpl", ("MOVE LINEAR BY {z: -80} IN TOOL DURATION -1 s",), [(VALUE, 3)], 3),
    ("rpl", ("MOVE LINEAR BY {z: -80} IN TOOL SPEED 50 mm/s PATH ACCELERATION 0 m/s2",), [(VALUE, 3)], 3),
    ("rpl", ("$override = 0", GO), [(VALUE, 3)], 3),
    ("rpl", (f"{GO} ACCELERATION 0 %",), [(HELD, 3)], 0),
]


@pytest.mark.parametrize(("dialect", "lines", "expected", "line"), CASES)
def test_what_is_told_is_what_the_run_does(
    dialect: str, lines: tuple[str, ...], expected: list[tuple[str, int]], line: int
) -> None:
    text = program(dialect, *lines)
    assert [(name, at) for name, at, _ in told(dialect, text) if name in OURS] == expected
    result = run(dialect, text, ROBOTS[dialect], **({"entry": "p"} if dialect == "krl" else {}))
    if line == 0:
        assert result.status == "finished", result.fault
    else:
        assert result.status == "fault" and result.fault is not None
        assert (result.fault.code, result.fault.origin.line) == ("bad-value", line), result.fault


@pytest.mark.parametrize(
    ("clause", "expected"),
    [
        ("SPEED 150 %", [UNIT]),
        ("JOINT SPEED 50 mm/s", [UNIT]),
        ("BLEND 20 %", [UNIT]),
        ("DURATION 5 mm", [UNIT]),
        ("SPEED 0.1 m/s", []),
        ("BLEND 1 cm", []),
    ],
)
def test_a_unit_of_another_quantity_is_an_error(clause: str, expected: list[str]) -> None:
    assert [name for name, _, _ in told("rpl", program("rpl", f"{GO} {clause}")) if name in OURS] == expected


@pytest.mark.parametrize(("level", "expected"), [(0, []), (8, []), (9, [17]), (12, [17])])
def test_inform_a_positioning_level_that_there_is_not(level: int, expected: list[int]) -> None:
    text = inform("MOVJ C00000 VJ=10.00", f"MOVL C00001 V=50 PL={level}")
    assert [line for name, line, _ in told("inform", text) if name == "unreadable-statement"] == expected


def test_a_variable_with_the_name_of_a_quantity_is_free() -> None:
    text = (
        "VAR override: INT = 1\nVAR blend_distance: REAL = 0.0\nPROCEDURE main()\noverride = 0\nblend_distance = -5.0\n"
    )
    assert [name for name, _, _ in told("rpl", text + "END PROCEDURE\n") if name in OURS] == []
    assert run("rpl", text + "END PROCEDURE\n").status == "finished"


def test_a_load_without_mass_says_what_the_emulator_does() -> None:
    bad = "PERS tooldata tNo:=[TRUE,[[0,0,100],[1,0,0,0]],[-1,[0,0,50],[1,0,0,0],0,0,0]];"
    text = module("MoveL p1,v100,fine,tNo;", data=(bad, P0.replace("p0:", "p9:")))
    (message,) = [words for name, _, words in told("rapid", text) if name == "load-without-mass"]
    assert "here it drives as without a load" in message
    assert run("rapid", text, ABB).status == "finished"

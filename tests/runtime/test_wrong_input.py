"""Wrong input: what `rpl check` tells of constants, with the line, and the fault where the run works a value out.

Sources: ABB RAPID Reference Manual (NOrient: limits of a quaternion; zonedata, motion principles 2.3: half the
distance), KUKA Expert Programming KSS 5.2 (3.5.2: half of the block), URScript manual (movej: overlapping blends).
"""

from __future__ import annotations

from typing import Any

import pytest
from helpers import ABB, KUKA, run
from hypothesis import given
from hypothesis import strategies as st

from rpl.diagnostics import Diagnostics
from rpl.project import read_sources
from rpl.source import source_from_text

TOOL = "PERS tooldata tPen:=[TRUE,[[0,0,100],[1,0,0,0]],[0.5,[0,0,50],[1,0,0,0],0,0,0]];"
P0 = "CONST robtarget p0:=[[350,0,300],[0,0,1,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]];"
P1 = "CONST robtarget p1:=[[350,60,300],[0,0,1,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]];"
START = "ConfJ\\Off; ConfL\\Off; MoveJ p0,v200,fine,tPen;"


def told(dialect: str, text: str) -> list[tuple[str, int, str]]:
    """Code, line and text of what is reported when the text is read."""
    suffix = {"krl": ".src", "rapid": ".mod"}.get(dialect, f".{dialect}")
    diagnostics = Diagnostics()
    read_sources([source_from_text(f"p{suffix}", text)], dialect, diagnostics)
    return [(item.code.name, item.origin.line, item.as_text()) for item in diagnostics]


def module(*lines: str, data: tuple[str, ...] = ()) -> str:
    """A RAPID module: the data from line 5 on, the statements behind it."""
    return "\n".join(["MODULE m", TOOL, P0, P1, *data, "PROC main()", START, *lines, "ENDPROC", "ENDMODULE"])


def rapid_told(*lines: str, data: tuple[str, ...] = ()) -> list[tuple[str, int]]:
    return [(name, line) for name, line, _ in told("rapid", module(*lines, data=data))]


RAPID_CASES: list[tuple[tuple[str, ...], tuple[str, ...], list[tuple[str, int]]]] = [
    (("CONST speeddata vNo:=[0,500,5000,1000];",), ("MoveL p1,vNo,fine,tPen;",), [("speed-not-positive", 8)]),
    ((), ("MoveL p1,v100\\V:=-5,fine,tPen;",), [("speed-not-positive", 7)]),
    ((), ("MoveL p1,vNo2,fine,tPen;",), []),
    (
        (P0.replace("p0:", "pBad:").replace("[0,0,1,0]", "[0,0,0.8,0]"),),
        ("MoveL pBad,v100,fine,tPen;",),
        [("orientation-unusable", 5)],
    ),
    (
        (P0.replace("p0:", "pNear:").replace("[0,0,1,0]", "[0.70717,0,0,0.70717]"),),  # the example of NOrient
        ("MoveL p1,v100,fine,tPen;",),
        [("orientation-not-normalised", 5)],
    ),
    ((TOOL.replace("tPen", "tNone").replace("[1,0,0,0]]", "[0,0,0,0]]", 1),), (), [("orientation-unusable", 5)]),
    ((TOOL.replace("tPen", "tNew").replace("[0.5,", "[-1,"),), (), [("load-without-mass", 5)]),
    (("PERS loaddata lNone:=[0,[0,0,1],[1,0,0,0],0,0,0];",), (), [("load-without-mass", 5)]),
    (("PERS loaddata lPart:=[0.001,[0,0,0.001],[1,0,0,0],0,0,0];",), (), []),  # as load0
    ((), ("MoveC p1,Offs(p1,0,60,0),v100,fine,tPen;",), [("circle-of-points-in-line", 7)]),
    ((), ("MoveC p1,Offs(p0,60,60,0),v100,fine,tPen;",), []),
    ((), ("MoveL p1,v100,z50,tPen;", "MoveL Offs(p1,0,0,30),v100,fine,tPen;"), [("corner-larger-than-move", 7)]),
    ((), ("MoveL p1,v100,z10,tPen;", "MoveL Offs(p1,0,0,30),v100,fine,tPen;"), []),
]


@pytest.mark.parametrize(("data", "lines", "expected"), RAPID_CASES)
def test_rapid_is_told_when_read(
    data: tuple[str, ...], lines: tuple[str, ...], expected: list[tuple[str, int]]
) -> None:
    known = ("CONST speeddata vNo2:=[0.5,500,5000,1000];",) if "vNo2" in "".join(lines) else ()
    assert rapid_told(*lines, data=data + known) == expected


def test_how_much_a_corner_shrinks_is_told() -> None:
    lines = ("MoveL p1,v100,z50,tPen;", "MoveL Offs(p1,0,0,30),v100,fine,tPen;")
    ((_, _, text),) = told("rapid", module(*lines))
    assert "50 mm" in text and "30 mm" in text and "15 mm" in text


def krl_text(*lines: str) -> str:
    return "\n".join(["DEF P( )", "BAS(#INITMOV,0)", "$TOOL=$NULLFRAME", "$BASE=$NULLFRAME", *lines, "END"])


KRL_CASES: list[tuple[tuple[str, ...], list[tuple[str, int]]]] = [
    (("$VEL.CP=0",), [("speed-not-positive", 5)]),
    (("$VEL.CP=-0.1",), [("speed-not-positive", 5)]),
    (("$VEL.CP=0.1",), []),
    (
        ("LIN {X 500,Y 0,Z 400,A 0,B 135,C 0}", "CIRC {X 500,Y 50,Z 400},{X 500,Y 90,Z 400,A 0,B 135,C 0}"),
        [("circle-of-points-in-line", 6)],
    ),
    (("LIN {X 500,Y 0,Z 400,A 0,B 135,C 0}", "CIRC {X 520,Y 50,Z 400},{X 500,Y 90,Z 400,A 0,B 135,C 0}"), []),
    (("LIN {X 500,Y 0,Z 400,A 0,B 135,C 0}", "CIRC {X 500,Y 50},{X 500,Y 90,Z 400,A 0,B 135,C 0}"), []),
    (
        (
            "LIN {X 500,Y 0,Z 400,A 0,B 135,C 0}",
            "CIRC {X 500,Y 50,Z 400,A 0,B 135,C 0},{X 500,Y 90,Z 400,A 0,B 135,C 0}",
        ),
        [("circle-of-points-in-line", 6)],
    ),
]


@pytest.mark.parametrize(("lines", "expected"), KRL_CASES)
def test_krl_is_told_when_read(lines: tuple[str, ...], expected: list[tuple[str, int]]) -> None:
    assert [(name, line) for name, line, _ in told("krl", krl_text(*lines))] == expected


def test_krl_a_move_before_any_tool_is_set() -> None:
    text = "DEF P( )\n$VEL.CP=0.1\nLIN {X 500,Y 0,Z 400,A 0,B 135,C 0}\nEND"
    assert [(name, line) for name, line, _ in told("krl", text)] == [("tool-not-set", 3)]


@pytest.mark.parametrize(
    ("line", "expected"), [("SPEED 0", 1), ("SPEED 0 MMPS", 1), ("SPEED 50", 0), ("SPEED 20 MMPS", 0)]
)
def test_vplus_a_speed_of_nothing_is_told_once(line: str, expected: int) -> None:
    found = told("vplus", f".PROGRAM p()\n{line}\nMOVES TRANS(400,0,300,0,180,0)\n.END\n")
    assert [(name, line) for name, line, _ in found if name == "speed-not-positive"] == expected * [
        ("speed-not-positive", 2)
    ]


def test_vplus_a_location_that_was_never_set_is_a_fault() -> None:
    text = ".PROGRAM p()\nMOVE #PPOINT(0,-90,180,0,60,0)\nMOVES nowhere\n.END\n"
    result = run("vplus", text, "adept_viper_s650")
    assert result.status == "fault" and result.fault is not None
    assert (result.fault.code, result.fault.origin.line) == ("no-value", 3)
    assert "nowhere" in result.fault.message


def test_tp_corners_of_a_size_larger_than_half_of_a_move_are_told() -> None:
    """M: half of the shorter move. CNT has no size of its own."""
    places = "".join(
        f"P[{number}]{{\n   GP1:\n\tUF : 0, UT : 1,\t\tCONFIG : 'N U T, 0, 0, 0',\n\tX = {x}.000  mm,\tY = {y}.000  mm,"
        "\tZ = 300.000  mm,\n\tW = 180.000 deg,\tP = 0.000 deg,\tR = 135.000 deg\n};\n"
        for number, (x, y) in enumerate(((400, 0), (460, 0), (460, 200)), 1)
    )
    for size, expected in (("CR50", [("corner-larger-than-move", 5)]), ("CR30", []), ("CNT100", [])):
        lines = ("J P[1] 30% FINE", f"L P[2] 100mm/sec {size}", "L P[3] 100mm/sec FINE")
        numbered = "".join(f"{number:4d}:{line} ;\n" for number, line in enumerate(lines, 1))
        text = f"/PROG  P\n/ATTR\n/MN\n{numbered}/POS\n{places}/END\n"
        assert [(name, line) for name, line, _ in told("tp", text)] == expected


def test_urscript_overlapping_blends_are_told() -> None:
    text = (
        "def prog():\n  movel(p[0.4,0,0.3,0,3.14,0], r=0)\n  movel(p[0.4,0.06,0.3,0,3.14,0], r=0.05)\n"
        "  movel(p[0.4,0.06,0.36,0,3.14,0], r=0.05)\n  movel(p[0.4,0.2,0.36,0,3.14,0])\nend\n"
    )
    assert ("urscript-overlapping-blends", 4) in [(name, line) for name, line, _ in told("urscript", text)]


# ---- in the run

RUNS: list[tuple[str, str, str, str, int]] = [
    ("krl", KUKA, krl_text("", "V=0.0", "$VEL.CP=V", "PTP {A1 0,A2 -90,A3 90,A4 0,A5 45,A6 0}",
                           "LIN {X 550,Y 0,Z 400,A 0,B 135,C 0}").replace("DEF P( )", "DEF P( )\nREAL V"),
     "bad-speed", 10),
    ("rapid", ABB, module("v:=-3;", "MoveL p1,v100\\V:=v,fine,tPen;", data=("VAR num v;",)), "bad-speed", 9),
    ("rapid", ABB, module("t:=p1;", "t.rot.q3:=0.8;", "MoveL t,v100,fine,tPen;", data=("VAR robtarget t;",)),
     "bad-rotation", 10),
    ("rapid", ABB, module("t:=p1;", "MoveC t,Offs(t,0,50,0),v100,fine,tPen;", data=("VAR robtarget t;",)),
     "degenerate-circle", 9),
]  # fmt: skip


@pytest.mark.parametrize(("dialect", "robot", "text", "fault", "line"), RUNS)
def test_what_is_worked_out_is_a_fault_of_the_run(dialect: str, robot: str, text: str, fault: str, line: int) -> None:
    options: dict[str, Any] = {"entry": "p"} if dialect == "krl" else {}
    result = run(dialect, text, robot, **options)
    assert result.status == "fault" and result.fault is not None
    assert (result.fault.code, result.fault.origin.line) == (fault, line), result.fault


@given(st.floats(-2.0, 2.0), st.floats(-2.0, 2.0))
def test_an_orientation_is_told_exactly_when_it_misses_one_by_more_than_a_tenth(one: float, other: float) -> None:
    squares = one * one + other * other
    if abs(abs(squares - 1.0) - 0.1) < 1e-9:
        return
    data = P0.replace("p0:", "pAny:").replace("[0,0,1,0]", f"[{one:.9f},0,{other:.9f},0]")
    codes = [name for name, _ in rapid_told(data=(data,))]
    assert ("orientation-unusable" in codes) == (abs(squares - 1.0) > 0.1)


@pytest.mark.parametrize(
    ("dialect", "text", "line"),
    [
        ("krl", "DEF p()\nREAL x\nx=1E999\nEND\n", 3),
        ("rapid", "MODULE p\nPROC main()\nVAR num x;\nx:=1E999;\nENDPROC\nENDMODULE\n", 4),
        ("urscript", "def p():\n  x = 1e999\n  y = -1e999\nend\n", 2),
        ("vplus", ".PROGRAM p()\n x = 1E999\n.END\n", 2),
        ("rpl", "x = 1e999\n", 1),
        (
            "inform",
            "/JOB\n//NAME P\n//POS\n//INST\n///DATE 2020/01/01 00:00\n///ATTR SC,RW\nNOP\nSET R000 1e999\nEND\n",
            8,
        ),
    ],
)
def test_numbers_that_no_machine_holds_are_not_infinity(dialect: str, text: str, line: int) -> None:
    assert ("unreadable-statement", line) in [(name, at) for name, at, _ in told(dialect, text)]


@pytest.mark.parametrize("behind", ["SET R000 12.5x", "SET R000 5 7", "ADD B000 1 2", "TIMER T=1e3", "INC B000 B001"])
def test_operands_that_mean_nothing_are_not_passed_over(behind: str) -> None:
    """An instruction with more operands than it has is not read as if they were not there."""
    text = f"/JOB\n//NAME P\n//POS\n//INST\n///DATE 2020/01/01 00:00\n///ATTR SC,RW\nNOP\n{behind}\nEND\n"
    assert ("unreadable-statement", 8) in [(name, at) for name, at, _ in told("inform", text)]


@pytest.mark.parametrize("speed", ["1E-300", "-1E-300", "0.0000001"])
def test_speeds_at_which_a_move_never_ends_are_told_and_are_faults(speed: str) -> None:
    data = f"CONST speeddata vNo:=[{speed},500,5000,1000];"
    assert ("speed-not-positive", 8) in rapid_told("MoveL p1,vNo,fine,tPen;", data=(data,))
    result = run("rapid", module("v:=" + speed + ";", "MoveL p1,v100\\V:=v,fine,tPen;", data=("VAR num v;",)), ABB)
    assert result.fault is not None and (result.fault.code, result.fault.origin.line) == ("bad-speed", 9)

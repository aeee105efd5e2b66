"""Taught places of languages whose places say no posture (V+, URScript): they stay taught, with the posture in which
the source's controller comes to them; and ways along the tool from such a place stay ways from it.
"""

import re

import pytest

from rpl.proof.verdict import DIFFERENT
from tests.there_and_back import Journey, there_and_back

VIPER, UR = "adept_viper_s850", "ur10e"
LOCATIONS = """.LOCATIONS
belt 450 -350 100 0 0 0
pick 10 0 70 0 180 90
#start 0 -90 180 0 90 0
.END
"""


def vplus(body: str, target: str) -> Journey:
    lines = "\n".join(f"        {line}" for line in body.splitlines())
    files = {"main.v2": f".PROGRAM main()\n{lines}\n.END\n{LOCATIONS}"}
    return there_and_back(files, "vplus", target, VIPER)


def urscript(body: str, target: str) -> Journey:
    frames = "global table = p[0.4, -0.3, 0.1, 0, 0, 0]\nglobal rack = p[0.35, 0.3, 0.1, 0, 0, 0]\n"
    places = f"{frames}global pick = p[0.02, 0, 0.06, 2.2214, 2.2214, 0]\n"
    start = "global start = [0, -1.57, -1.57, -1.57, 1.57, 1.57]\n"
    lines = "\n".join(f"  {line}" for line in f"{places}{start}{body}".splitlines())
    return there_and_back({"main.script": f"def main():\n{lines}\nend\n"}, "urscript", target, UR)


def named(trip: Journey) -> set[str]:
    return {one.code.name for one in trip.found}


PICKING = """MOVE #start
BREAK
APPRO belt:pick, 80
BREAK
MOVES belt:pick
BREAK
SIGNAL 1
DEPARTS 80
MOVE #start"""


@pytest.mark.parametrize(
    ("target", "lines"),
    [
        (
            "rapid",
            (
                r"MoveJ RelTool\(pick,0,0,-80\),.*\\WObj:=belt;",
                r"MoveL pick,.*\\WObj:=belt;",
                r"MoveL RelTool\(pick,0,0,-80\),.*\\WObj:=belt;",
                r"robtarget pick:=\[\[10,0,70\],\[[^\]]*\],\[-1,0,0,0\]",
            ),
        ),
        ("krl", (r"PTP pick:shift_zm80", r"LIN pick", r"\$BASE=BASE_DATA\[1\]", r"E6POS pick=")),
        ("tp", (r"J P\[2:pick\] .*Tool_Offset", r"L P\[2:pick\] .*FINE *;", r"L P\[2:pick\] .*Tool_Offset")),
        (
            "urscript",
            (r"movej\(pose_trans\(pose_trans\(belt, pick\), p\[0, 0, -0.08", r"movel\(pose_trans\(belt, pick\)"),
        ),
    ],
)
def test_a_place_and_the_way_from_it_are_written_by_its_name(target: str, lines: tuple[str, ...]) -> None:
    trip = vplus(PICKING, target)
    for line in lines:
        assert re.search(line, trip.text.replace("\r", ""), re.MULTILINE), line
    assert "taught-value-written" not in named(trip)
    assert trip.prove().verdict != DIFFERENT


# The wrist turns on beyond half a turn: only a posture that is told with the place brings FANUC's arm there alike.
ON_AND_ON = """movej(start, a=1.4, v=1)
movej(pose_trans(table, pick), a=1.4, v=1)
movel(pose_trans(table, p[0.02, 0, 0.12, 2.2214, 2.2214, 0]), a=1.2, v=0.2)
movej(pose_trans(rack, pick), a=1.4, v=1)
set_standard_digital_out(1, True)"""


@pytest.mark.parametrize("target", ["rapid", "krl", "tp", "inform", "vplus"])
def test_the_arm_comes_there_as_on_the_source(target: str) -> None:
    trip = urscript(ON_AND_ON, target)
    assert trip.prove().verdict != DIFFERENT
    assert ("taught-value-written" in named(trip)) is (target in ("tp", "inform"))  # one place, two postures


def test_where_a_routine_begins_is_known_from_its_calls() -> None:
    body = """def go():
  movej(pose_trans(table, pick), a=1.4, v=1)
end
movej(start, a=1.4, v=1)
go()
set_standard_digital_out(1, True)"""
    assert "posture-as-from-known" not in named(urscript(body, "tp"))
    # Called from two places, the arm may come from either.
    twice = f"{body}\nmovej([0, -1, -2, -1.57, 1.57, 1.57], a=1.4, v=1)\ngo()"
    assert "posture-as-from-known" in named(urscript(twice, "tp"))


def test_a_place_that_is_worked_out_is_told() -> None:
    body = """movej(start, a=1.4, v=1)
n = 0
while n < 2:
  place = pose_add(p[0, 0, n*0.05, 0, 0, 0], pick)
  movej(pose_trans(table, place), a=1.4, v=1)
  n = n + 1
end"""
    trip = urscript(body, "tp")
    assert "posture-as-taught" in named(trip)
    assert trip.prove().verdict != DIFFERENT


@pytest.mark.parametrize(
    ("between", "goes_on"),
    [
        ("SIGNAL 2", True),
        ("WAIT SIG(-1001)", True),
        ("CALL close()", True),
        ("IF SIG(1002) THEN\n    SIGNAL 3\nEND", True),
        ("CALL away()", False),  # it moves the robot
        ("IF SIG(1002) THEN\n    MOVES #start\nEND", False),
    ],
)
def test_a_way_along_the_tool_goes_on_from_the_place_before(between: str, goes_on: bool) -> None:
    files = {
        "main.v2": f""".PROGRAM main()
        MOVE #start
        BREAK
        MOVES belt:pick
        BREAK
        {between}
        DEPARTS 80
        BREAK
.END
.PROGRAM close()
        SIGNAL 4
.END
.PROGRAM away()
        MOVES #start
        BREAK
.END
{LOCATIONS}"""
    }
    trip = there_and_back(files, "vplus", "rapid", VIPER)
    assert ("MoveL RelTool(pick,0,0,-80)" in trip.text) is goes_on
    assert ("CRobT(" in trip.text) is not goes_on
    assert trip.prove().verdict != DIFFERENT


def test_a_place_that_changes_behind_the_move_is_kept() -> None:
    body = """SET spot = pick
MOVE #start
BREAK
MOVES belt:spot
BREAK
SET spot = SHIFT(pick BY 0,50,0)
DEPARTS 80
BREAK"""
    trip = vplus(body, "rapid")
    assert "RelTool(spot" not in trip.text
    assert trip.prove().verdict != DIFFERENT

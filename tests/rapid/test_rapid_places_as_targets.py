"""Languages where a place and a frame are one type: in RAPID the places that moves go to are robtargets, and the frame
that a place is composed with is the work object of the move. A pose that is something else as well stays a pose."""

from __future__ import annotations

import re

import pytest

from tests.there_and_back import Journey, there_and_back

LOCATIONS = """.LOCATIONS
#start 0 -90 180 0 60 0
place 300 100 160 0 180 0
table 30 -100 20 0 0 0
.END
"""
PLACE, TABLE = "CONST robtarget place:=[[300,100,160],", 'PERS wobjdata table:=[FALSE,TRUE,"",[[30,-100,20],'
PERS_PLACE, POSES = "PERS robtarget place:=", ("PERS pose place:=", "PERS pose table:=")


def vplus(steps: str, more: str = "") -> Journey:
    text = f".PROGRAM main()\n MOVE #start\n{steps}\n BREAK\n SIGNAL 1\n.END\n{more}{LOCATIONS}"
    return there_and_back({"main.v2": text}, "vplus", "rapid", "adept_viper_s650")


def proved(journey: Journey) -> None:
    assert not journey.losses
    result = journey.prove()
    assert result.verdict in ("equal", "alike"), result.as_text()
    assert result.level in ("geometry", "time"), result.as_text()


def targets(text: str) -> list[str]:
    """Where linear moves go, with their work objects."""
    found = re.findall(r"MoveL (.*),v\w+,\w+,\w+(\\WObj:=\w+)?;", text)
    return [place + frame for place, frame in found]


@pytest.mark.parametrize(
    ("steps", "head", "goals"),
    [
        (" MOVES place", [PLACE], ["place"]),
        (" MOVES table:place", [PLACE, TABLE], [r"place\WObj:=table"]),
        (" MOVES place\n MOVES table:place", [PLACE, TABLE], ["place", r"place\WObj:=table"]),
        (" MOVES SHIFT(place BY 0,0,50)", [PLACE], ["Offs(place,0,0,50)"]),
        (" APPROS place, 30", [PLACE], ["RelTool(place,0,0,-30)"]),
        (" MOVES place:TRANS(0,0,-30)", [PLACE], ["RelTool(place,0,0,-30)"]),
        (" h = 30\n MOVES table:place:TRANS(0,5,-h)", [PLACE, TABLE], [r"RelTool(place,0,5,-h)\WObj:=table"]),
        (" APPROS table:place, 30", [PLACE, TABLE], [r"RelTool(place,0,0,-30)\WObj:=table"]),
        (
            " MOVES place\n SET place = SHIFT(place BY 0,0,20)\n MOVES table:place",
            [PERS_PLACE, TABLE],
            ["place", r"place\WObj:=table"],
        ),
    ],
)
def test_places_are_targets(steps: str, head: list[str], goals: list[str]) -> None:
    journey = vplus(steps)
    assert all(line in journey.text for line in head) and "PoseMult" not in journey.text, journey.text
    assert targets(journey.text) == goals
    proved(journey)


@pytest.mark.parametrize(
    ("steps", "more"),
    [
        (" MOVES table:place\n SET table = SHIFT(table BY 0,0,20)\n MOVES table:place", ""),  # the frame is assigned
        (
            " CALL go(place, 20)\n CALL go(table:place, 30)",  # the parameter is a product once
            ".PROGRAM go(p, h)\n APPROS p, h\n MOVES p\n BREAK\n DEPARTS h\n.END\n",
        ),
    ],
)
def test_poses_that_are_something_else_stay_poses(steps: str, more: str) -> None:
    journey = vplus(steps, more)
    assert all(line in journey.text for line in POSES) and "wobjdata" not in journey.text, journey.text
    proved(journey)


@pytest.mark.parametrize(
    "steps",
    [
        " MOVES table:place\n IF DISTANCE(place,table) > 10 THEN\n SIGNAL 5\n END",  # poses of a function
        " MOVES table:place\n SET other = INVERSE(place)\n MOVES table:place",
        " MOVES table:place\n MOVES table:place:TRANS(0,0,-30,0,0,90)",  # it turns the tool
    ],
)
def test_such_poses_are_in_the_frame_that_they_are_seen_from(steps: str) -> None:
    journey = vplus(steps, "")
    assert POSES[0] in journey.text and "PoseMult(table" not in journey.text, journey.text
    assert all(r"\WObj:=table" in one for one in targets(journey.text)[-1:]), journey.text
    proved(journey)


PALLET = """DEF main()
DECL INT Row
DECL FRAME Spot
$TOOL=Gripper
$BASE=Pallet
$VEL.CP=0.25
PTP {A1 0,A2 -90,A3 90,A4 0,A5 60,A6 0}
FOR Row=1 TO 3
Spot=Down
Spot.Y=Row*60
LIN Spot:{X 0,Y 0,Z -50,A 0,B 0,C 0}
LIN Spot
ENDFOR
END
"""
PALLET_DATA = """DEFDAT main
DECL FRAME Gripper={X 0,Y 0,Z 120,A 0,B 0,C 0}
DECL FRAME Pallet={X 400,Y -240,Z 40,A 0,B 0,C 0}
DECL FRAME Down={X 0,Y 0,Z 60,A 180,B 0,C 180}
ENDDAT
"""


def test_a_frame_whose_components_are_computed_is_a_place() -> None:
    files = {"main.src": PALLET, "main.dat": PALLET_DATA}
    journey = there_and_back(files, "krl", "rapid", "kuka_kr6r900sixx")
    assert "CONST robtarget Down:=[[0,0,60]," in journey.text and "VAR robtarget Spot;" in journey.text
    assert "Spot.trans.y:=Row*60;" in journey.text and "PoseMult" not in journey.text
    assert targets(journey.text) == [r"RelTool(Spot,0,0,-50)\WObj:=Pallet", r"Spot\WObj:=Pallet"]
    proved(journey)


SCRIPT = """def main():
  global start = [0, -1.5708, -1.5708, -1.5708, 1.5708, 0]
  global table = p[-0.3,-0.5,0.1,0,0,0]
  global place = p[0.1,0.1,0.1,0,3.14159,0]
  movej(start)
  movel(pose_trans(table, place), v=0.25)
{lines}
  set_digital_out(1, True)
end
"""


@pytest.mark.parametrize(
    ("lines", "present", "absent"),
    [
        ("", [r"MoveL place,v250,fine,tool0\WObj:=table;", "CONST robtarget place:="], "pose "),
        (
            "  place[2] = place[2] + 0.05\n  movel(pose_trans(table, place), v=0.25)",
            ["VAR robtarget place;", "place.trans.z:=place.trans.z+50;", "wobjdata table:="],
            "CONST robtarget",
        ),
        (
            "  table[2] = 0.15\n  movel(pose_trans(table, place), v=0.25)",
            ["VAR pose table;", "VAR pose place:="],
            "wobj",
        ),
        (
            "  if pose_dist(place, table) > 0.1:\n    set_digital_out(2, True)\n  end",
            ["VAR pose place:=", r"\WObj:=table;", "table.uframe"],
            "PoseMult(table",
        ),
    ],
)
def test_poses_of_urscript(lines: str, present: list[str], absent: str) -> None:
    journey = there_and_back({"main.script": SCRIPT.format(lines=lines)}, "urscript", "rapid", "ur10e")
    assert all(one in journey.text for one in present) and absent not in journey.text, journey.text
    proved(journey)

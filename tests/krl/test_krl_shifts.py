"""Shifted places in KRL: a constant shift is a frame of the data list, a computed one is said by components. What comes
out of `:` has no posture, and no external axes where a frame stands behind: such places keep the function."""

from __future__ import annotations

import pytest

from tests.there_and_back import Journey, there_and_back

NONE = "9E9,9E9,9E9,9E9,9E9"


def rapid(lines: str, axis: str = "9E9", first: str = "0,-20,20,0,60,0", more: str = "") -> Journey:
    """The lines between a move to `first` and a signal; `axis`: the place on an external axis of `p`."""
    text = f"""MODULE m
  CONST robtarget p:=[[800,300,900],[0,0,1,0],[0,0,0,0],[{axis},{NONE}]];
  CONST jointtarget start:=[[{first}],[{"9E9" if axis == "9E9" else "0"},{NONE}]];
  CONST num rise:=50;
  PERS num way:=10;
  VAR num n:=2;
  VAR robtarget q;
  PROC main()
    MoveAbsJ start,v500,fine,tool0;
    {lines}
    SetDO do1,1;
  ENDPROC
{more}
ENDMODULE
"""
    return there_and_back({"m.mod": text}, "rapid", "krl", "abb_irb2400")


def proved(journey: Journey) -> None:
    assert not journey.losses
    result = journey.prove()
    assert result.verdict in ("equal", "alike"), result.as_text()
    assert result.level in ("geometry", "time"), result.as_text()


def linear(place: str) -> str:
    return f"MoveL {place},v500,fine,tool0;"


FRAMES = [
    ("Offs(p,0,0,50)", "LIN shift_z50:p", "shift_z50={X 0.0,Y 0.0,Z 50.0,A 0.0,B 0.0,C 0.0}"),
    ("Offs(p,0,0,rise)", "LIN shift_z50:p", "shift_z50={X 0.0,Y 0.0,Z 50.0,"),
    ("Offs(p,-20,0,2.5)", "LIN shift_xm20_z2p5:p", "shift_xm20_z2p5={X -20.0,Y 0.0,Z 2.5,"),
    ("RelTool(p,0,0,-50)", "LIN p:shift_zm50", "shift_zm50={X 0.0,Y 0.0,Z -50.0,"),
]


@pytest.mark.parametrize(("place", "move", "data"), FRAMES)
def test_a_constant_shift_is_a_frame(place: str, move: str, data: str) -> None:
    journey = rapid(linear(place))
    assert move in journey.text and data in journey.text and "rpl_" not in journey.text, journey.text
    proved(journey)


def test_equal_shifts_share_a_frame() -> None:
    journey = rapid(linear("Offs(p,0,0,50)") + linear("RelTool(p,0,0,50)") + linear("Offs(p,0,0,rise)"))
    assert journey.text.count("FRAME shift_z50=") == 1, journey.text
    proved(journey)


FUNCTIONS = [
    ("MoveL Offs(p,0,0,way),v500,fine,tool0;", "LIN rpl_offset(p,0,0,way)"),  # `way` may change
    ("MoveL RelTool(p,0,0,-50\\Rz:=10),v500,fine,tool0;", "LIN rpl_tool_offset(p,"),  # it turns
    ("MoveJ RelTool(p,0,0,-50),v500,fine,tool0;", "PTP rpl_tool_offset(p,"),  # a product names no posture
]


@pytest.mark.parametrize(("lines", "move"), FUNCTIONS)
def test_what_a_frame_cannot_say_is_a_function(lines: str, move: str) -> None:
    journey = rapid(lines)
    assert move in journey.text and "shift_" not in journey.text, journey.text
    proved(journey)


def test_a_joint_move_goes_to_a_place_with_other_components() -> None:
    journey = rapid("MoveJ Offs(p,0,0,-50),v500,fine,tool0;")
    lines = [line.strip() for line in journey.text.splitlines()]
    at = lines.index("p_moved=p")
    assert lines[at + 1 : at + 3] == ["p_moved.Z=p.Z-50", "PTP p_moved"] and "rpl_" not in journey.text, journey.text
    proved(journey)


@pytest.mark.parametrize("place", ["p", "Offs(p,0,0,-50)", "RelTool(p,0,0,-50)"])
def test_a_joint_move_to_a_shifted_place_changes_to_the_posture_of_the_place(place: str) -> None:
    """The arm stands with its wrist turned over and comes as the place says."""
    proved(rapid(f"MoveJ {place},v500,fine,tool0;", first="0,-20,20,180,-60,180"))


@pytest.mark.parametrize(
    ("place", "move"), [("Offs(p,0,0,-50)", "LIN shift_zm50:p"), ("RelTool(p,0,0,-50)", "LIN rpl_tool_offset(p,")]
)
def test_external_axes_of_a_shifted_place_come_along(place: str, move: str) -> None:
    journey = rapid(linear(place), axis="150")
    assert move in journey.text, journey.text
    proved(journey)


ASSIGNED = [
    ("q:=Offs(p,n*10,0,-way);", ["q=p", "q.X=p.X+n*10", "q.Z=p.Z-way"]),
    ("q:=Offs(p,0,20,0);", ["q=p", "q.Y=p.Y+20"]),
    ("q:=Offs(p,0,0,-20);", ["q=p", "q.Z=p.Z-20"]),
    ("q:=p;\n    q:=Offs(q,0,20,0);", ["q=rpl_offset(q,0,20,0)"]),  # the place itself
    ("q:=p;\n    q:=Offs(p,q.trans.x-780,0,0);", ["q=rpl_offset(p,q.X-780,0,0)"]),  # looks at what it sets
]


@pytest.mark.parametrize(("lines", "expected"), ASSIGNED)
def test_a_computed_shift_is_said_by_components(lines: str, expected: list[str]) -> None:
    journey = rapid(lines + linear("q"))
    written = [line for line in journey.text.splitlines() if line.startswith(("q=rpl", "q=p", "q."))]
    assert written[-len(expected) :] == expected, journey.text
    proved(journey)


def test_components_do_not_change_what_another_name_of_the_place_still_gives() -> None:
    more = """  PROC shifted(INOUT robtarget a,INOUT robtarget b)
    a:=Offs(p,b.trans.x,b.trans.x,b.trans.y);
  ENDPROC"""
    journey = rapid(f"q:=Offs(p,-790,-280,-890);\n    shifted q,q;\n    {linear('q')}", more=more)
    assert "a=rpl_offset(p,b.X,b.X,b.Y)" in journey.text, journey.text
    proved(journey)


def test_poses_of_vplus_have_nothing_that_a_product_lacks() -> None:
    text = """.PROGRAM main()
 MOVE #start
 MOVES SHIFT(place BY 0,0,50)
 APPROS place, 30
 APPROS table:place, 30
 MOVES table:place
 BREAK
 SIGNAL 1
.END
.LOCATIONS
#start 0 -90 180 0 60 0
place 300 100 160 0 180 0
table 30 -100 20 0 0 0
.END
"""
    journey = there_and_back({"main.v2": text}, "vplus", "krl", "adept_viper_s650")
    for move in ("LIN shift_z50:place", "LIN place:shift_zm30", "$BASE=BASE_DATA[1]\r\nLIN place:shift_zm30"):
        assert f"{move} C_VEL" in journey.text, journey.text
    assert "rpl_" not in journey.text
    proved(journey)

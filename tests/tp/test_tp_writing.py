"""Statements as TP lines, one table for each family."""

from __future__ import annotations

import pytest
from tp_writing_helpers import lines, listing, numbered, write

ASSIGNMENTS = [
    ("R[1] = 5.0", "R[1]=5"),
    ("R[1] = -2.5", "R[1]=(-2.5)"),
    ("R[1] = R[2] + R[3] - 2.5", "R[1]=R[2]+R[3]-2.5"),
    ("R[1] = R[2] * R[3] / 4.0", "R[1]=R[2]*R[3]/4"),
    ("R[1] = R[2] + R[3] * 4.0", "R[1]=(R[2]+R[3]*4)"),
    ("R[1] = (R[2] + R[3]) * 4.0", "R[1]=((R[2]+R[3])*4)"),
    ("R[1] = R[2] - (R[3] - 4.0)", "R[1]=(R[2]-(R[3]-4))"),
    ("R[1] = R[2] + -R[3]", "R[1]=(R[2]+(-1)*R[3])"),
    ("R[1] = -R[3]", "R[1]=(-1)*R[3]"),
    ("R[1] = R[2] + R[3] + R[4] + R[5] + R[6] + R[7] + R[8]", "R[1]=(R[2]+R[3]+R[4]+R[5]+R[6]+R[7]+R[8])"),
    ("R[1] = sin(R[2])", "R[1]=SIN[R[2]]"),
    ("R[1] = atan2(R[2], R[3])", "R[1]=ATAN2[R[2],R[3]]"),
    ("R[1] = log(R[2])", "R[1]=LN[R[2]]"),
    ("R[to_int(R[2])] = 1.0", "R[R[2]]=1"),
    ("PR[to_int(R[2])].z = 1.0", "PR[R[2],3]=1"),
    ("R[1] = PR[3].x", "R[1]=PR[3,1]"),
    ("PR[3].x = R[1]", "PR[3,1]=R[1]"),
    ("PR[3].c = 180.0", "PR[3,4]=180"),
    ("PR[3].a = -90.0", "PR[3,6]=(-90)"),
    ("PR[3] = PR[4]", "PR[3]=PR[4]"),
    ("PR[3] = P1", "PR[3]=P[1]"),
    ("PR[3] = {x: 1, y: 2, z: 3, a: 0, b: 0, c: 0}", "PR[3]=P[3]"),
    ("PR[3] = offset(PR[3], 0, 0, -R[2])", "PR[3,3]=(PR[3,3]+((-1)*R[2]))"),
    ("PR[3] = offset(PR[3], 0, -5, 0)", "PR[3,2]=PR[3,2]-5"),
    ("F[1] = TRUE", "F[1]=(ON)"),
    ("F[1] = R[1] > 3.0 AND NOT di[2]", "F[1]=(R[1]>3 AND !DI[2])"),
    ("F[1] = R[1] > 3.0 AND di[1] OR F[2]", "F[1]=((R[1]>3 AND DI[1]) OR F[2])"),
    ("SET do[1] TO ON", "DO[1]=ON"),
    ("SET do[1] TO di[3] OR F[1]", "DO[1]=(DI[3] OR F[1])"),
    ("SET do[1] TO di[3]", "DO[1]=(DI[3])"),
    ("SET ao[1] TO 2.5", "AO[1]=2.5"),
    ("SET go[2] TO to_int(R[1])", "GO[2]=R[1]"),
    ("R[1] = to_real(gi[3])", "R[1]=GI[3]"),
    ("R[1] = to_int(R[2])", "R[1]=TRUNC[R[2]]"),
    ("R[1] = to_nearest(R[2])", "R[1]=ROUND[R[2]]"),
    ("PULSE do[6] TO ON FOR 0.2 s", "DO[6]=PULSE,0.2sec"),
    ('SR[1] = "abc" & SR[2]', "SR[1]='abc'+SR[2]"),
    ("SR[1] = SR[1] & value_text(R[2])", "SR[1]=SR[1]+R[2]"),
    ('SR[1] = "abc"', "SR[1]='abc'"),
    ("R[1] = to_real(text_length(SR[1]))", "R[1]=STRLEN SR[1]"),
    ("CLOCK RESET TIMER[2]", "TIMER[2]=RESET"),
    ("CLOCK START TIMER[2]", "TIMER[2]=START"),
    ("R[1] = clock_seconds(TIMER[2])", "R[1]=TIMER[2]"),
    ("$timer[3] = 0", "TIMER[3]=RESET"),
    ("$timer_stopped[3] = TRUE", "TIMER[3]=STOP"),
    ("$override = 50", "OVERRIDE=50%"),
    ("$override = R[1]", "OVERRIDE=R[1]"),  # a register has no unit: counted, 127 of 127 public lines
]


@pytest.mark.parametrize(("given", "wanted"), ASSIGNMENTS)
def test_an_assignment(given: str, wanted: str) -> None:
    assert lines(given) == [wanted]


def test_the_comment_of_a_position_register_has_no_comma() -> None:
    """`PR[15:slot2,2]` would name component 2 of the register."""
    found = lines("PR[3] = PR[15]\nR[5] = 1.0", {("PR", 15): "slot2,2", ("R", 5): "a,1"})
    assert found == ["PR[3]=PR[15:slot2_2]", "R[5:a,1]=1"]


FLOW = [
    ("IF R[1] = 5.0 THEN GOTO l7\nLABEL l7", ["IF R[1]=5,JMP LBL[7]", "LBL[7]"]),
    ("IF di[1] AND NOT di[2] THEN GOTO l7\nLABEL l7", ["IF DI[1]=ON AND DI[2]=OFF,JMP LBL[7]", "LBL[7]"]),
    ("IF di[1] AND (F[2] OR R[1] < 2.0) THEN other()", ["IF (DI[1] AND (F[2] OR R[1]<2)),CALL OTHER"]),
    ("IF di[1] THEN R[1] = 1.0", ["IF (DI[1]) THEN", "R[1]=1", "ENDIF"]),
    (
        "IF R[1] <> 2.0 THEN\nother()\nELSE\nhelper(3.0)\nEND IF",
        ["IF (R[1]<>2) THEN", "CALL OTHER", "ELSE", "CALL HELPER(3)", "ENDIF"],
    ),
    ("GOTO done\nLABEL l1\nLABEL done", ["JMP LBL[2]", "LBL[1]", "LBL[2:done]"]),
    ("SWITCH R[1]\nCASE 1.0\nother()\nCASE 2.0\nhelper(R[2])\nEND SWITCH",
     ["SELECT R[1]=1,CALL OTHER", "=2,CALL HELPER(R[2])"]),
    ("SWITCH R[1]\nCASE 1.0\nGOTO l5\nDEFAULT\nother()\nEND SWITCH\nLABEL l5",
     ["SELECT R[1]=1,JMP LBL[5]", "ELSE,CALL OTHER", "LBL[5]"]),
    ("SWITCH R[1]\nCASE 1.0, 2.0\nR[2] = 1.0\nR[3] = 1.0\nDEFAULT\nR[2] = 2.0\nEND SWITCH",
     ["SELECT R[1]=1,JMP LBL[2]", "=2,JMP LBL[2]", "ELSE,JMP LBL[3]", "LBL[2]", "R[2]=1", "R[3]=1", "JMP LBL[1]",
      "LBL[3]", "R[2]=2", "LBL[1:end select]"]),
    ("RETURN", ["END"]),
    ("HALT", ["PAUSE"]),
    ("HALT EXIT", ["ABORT"]),
    ("WAIT 0.5 s", ["WAIT   0.50(sec)"]),
    ("WAIT R[3] s", ["WAIT R[3]"]),
    ("WAIT UNTIL di[1] AND NOT di[2]", ["WAIT DI[1]=ON AND DI[2]=OFF"]),
    ("WAIT UNTIL R[1] > 3.0 OR di[1] AND di[2]", ["WAIT (R[1]>3 OR (DI[1] AND DI[2]))"]),
    ("WAIT UNTIL di[1] TIMEOUT 5 s FLAG F[7]",
     ["$WAITTMOUT=500", "F[7]=(ON)", "WAIT DI[1]=ON TIMEOUT,LBL[1]", "F[7]=(OFF)", "LBL[1]"]),
    ('MESSAGE "hello operator"', ["MESSAGE[hello operator]"]),
    ("START TASK other()", ["RUN OTHER"]),
]  # fmt: skip


@pytest.mark.parametrize(("given", "wanted"), FLOW)
def test_flow(given: str, wanted: list[str]) -> None:
    assert lines(given) == wanted


MOVES = [
    ("MOVE TO P2 JOINT SPEED 50 %", "J P[2] 50% FINE"),
    ("MOVE TO P1 JOINT SPEED R[2] BLEND PERCENT 30", "J P[1] R[2]% CNT30"),
    ("MOVE LINEAR TO PR[3] SPEED 0.25 m/s BLEND 5 mm", "L PR[3] 250mm/sec CR5"),
    ("MOVE LINEAR TO P1 SPEED 0.5 mm/s", "L P[1] 3cm/min FINE"),
    ("MOVE LINEAR TO P1 SPEED 30 inch/min", "L P[1] 30inch/min FINE"),
    ("MOVE LINEAR TO P1 SPEED R[5] mm/s BLEND PERCENT R[6]", "L P[1] R[5]mm/sec CNT R[6]"),
    ("MOVE LINEAR TO PR[3] : PR[4] SPEED 100 mm/s", "L PR[3] 100mm/sec FINE Tool_Offset,PR[4]"),
    ("MOVE LINEAR TO element_sum(P1, PR[4]) SPEED 100 mm/s", "L P[1] 100mm/sec FINE Offset,PR[4]"),
    ("MOVE LINEAR BY {z: 100} SPEED 100 mm/s", "L P[3] 100mm/sec FINE INC"),
    ("MOVE TO P2 JOINT SPEED 20 % ACCELERATION 80 %", "J P[2] 20% FINE ACC80"),
    ("MOVE TO P2 DURATION 2.5 s", "J P[2] 2.5sec FINE"),
    (
        "MOVE LINEAR TO P1 SPEED 100 mm/s TRIGGER AT end DELAY -0.20 s DO other()",
        "L P[1] 100mm/sec FINE TB 0.2sec,CALL OTHER",
    ),
    (
        "MOVE LINEAR TO P1 SPEED 100 mm/s TRIGGER AT end DELAY 0.20 s DO SET do[3] TO ON",
        "L P[1] 100mm/sec FINE TA 0.2sec,DO[3]=ON",
    ),
    (
        "MOVE LINEAR TO P1 SPEED 100 mm/s TRIGGER AT end DISTANCE -20 mm DO SET do[3] TO ON",
        "L P[1] 100mm/sec FINE DB 20.0mm,DO[3]=ON",
    ),
]


@pytest.mark.parametrize(("given", "wanted"), MOVES)
def test_a_move(given: str, wanted: str) -> None:
    assert lines(given) == [wanted]


def test_a_circle_goes_over_two_lines_under_one_number() -> None:
    text, codes = listing("MOVE CIRCULAR VIA P1 TO PR[3] SPEED 100 mm/s")
    assert not codes
    assert "   1:C P[1]    \r\n    :  PR[3] 100mm/sec FINE     ;\r\n" in text


def test_names_of_registers_are_comments() -> None:
    names = {("R", 1): "number of boxes on the pallet", ("PR", 3): "spot:[x]", ("digital_out", 1): "grip"}
    assert lines("SET do[1] TO ON", names) == ["DO[1:grip]=ON"]
    assert lines("R[1] = PR[3].x", names) == ["R[1:number of boxes]=PR[3,1:spotx]"]


def test_constant_tools_and_frames_are_numbers() -> None:
    found = lines(
        "$tool = {x: 0, y: 0, z: 120, a: 0, b: 0, c: 0}\n$base = $null_frame\nMOVE TO P2 JOINT SPEED 50 %\n"
        "$tool = {x: 0, y: 0, z: 120, a: 0, b: 0, c: 0}",
        entry="p",
    )
    assert found == ["UTOOL_NUM=1", "UFRAME_NUM=0", "J P[2] 50% FINE", "UTOOL_NUM=1"]


def test_a_program_that_is_started_selects_world_and_flange_before_it_moves() -> None:
    found = lines("R[1] = 1.0\nMOVE TO P2 JOINT SPEED 50 %", entry="p")
    assert found == ["UFRAME_NUM=0", "UTOOL_NUM=1", "R[1]=1", "J P[2] 50% FINE"]
    found = lines("$base = PR[4]\n$tool = PR[5]\nMOVE TO P2 JOINT SPEED 50 %", entry="p")
    assert "UFRAME_NUM=0" not in found


def test_a_frame_in_a_register_is_handed_over_where_it_is_selected() -> None:
    assert lines("$base = PR[8]") == ["UFRAME[1]=PR[8]", "UFRAME_NUM=1"]


def test_a_move_with_its_own_frame_selects_it_once() -> None:
    move = "MOVE LINEAR TO P1 SPEED 100 mm/s FRAME {x: 5, y: 0, z: 0, a: 0, b: 0, c: 0}"
    found = lines(f"{move}\n{move}\nother()\n{move}\nm()\n{move}")
    go = "L P[1] 100mm/sec FINE"
    assert found == ["UFRAME_NUM=1", go, go, "CALL OTHER", go, "CALL M", "UFRAME_NUM=1", go]  # m moves, other does not


def test_points_say_the_frame_and_tool_of_their_moves() -> None:
    text, _ = listing(
        "$tool = {x: 0, y: 0, z: 120, a: 0, b: 0, c: 0}\n$base = $null_frame\nMOVE TO P2 JOINT SPEED 50 %\n"
        "$base = PR[4]\nMOVE LINEAR TO P1 SPEED 50 mm/s\n$base = PR[5]\nMOVE LINEAR TO P1 SPEED 50 mm/s"
    )
    positions = text.split("/POS")[1].replace("\r\n", "\n")
    assert (
        "P[2]{\n   GP1:\n\tUF : 0, UT : 1,\n\tJ1=     0.000 deg,\tJ2=    10.000 deg,\tJ3=   -20.500 deg,\n" in positions
    )
    assert "P[1]{\n   GP1:\n\tUF : F, UT : F,\t\tCONFIG : 'N U T, 0, 0, 0',\n\tX =   400.000  mm," in positions


def test_an_untaught_point_has_stars() -> None:
    text, _ = write(
        "ENTRY p\nMODULE cell\nPROCEDURE p()\nVAR P5: POSE\nMOVE TO P5 JOINT SPEED 5 %\nEND PROCEDURE\nEND MODULE\n"
    )
    assert "X = ********  mm,\tY = ********  mm," in text["P.LS"]


UNSAYABLE = [
    "R[1] = sqrt(R[2] + 1.0)",
    "R[201] = 1.0",
    "R[0] = 1.0",
    "PR[3] = PR[4] : PR[5]",
    "SET do[1] TO R[1] > 2.0 XOR di[1]",
    'MESSAGE "part " & number_text(1.5, 2)',
    'SR[1] = "it\'s"',
    "FOR R1 = 1 TO 10 STEP 2\nother()\nEND FOR",
    "WHILE di[1]\nother()\nEND WHILE",
    "MOVE LINEAR BY {z: 100, a: 10} SPEED 100 mm/s",
    "PULSE do[6] TO OFF FOR 0.2 s",
    "MOVE LINEAR TO P1 SPEED 100 mm/s TRIGGER AT start DISTANCE 5 mm DO other()",
    "MOVE LINEAR TO P1 SPEED 100 mm/s TRIGGER AT end DISTANCE 5 mm DO other()",
    "MOVE LINEAR TO P1 SPEED 100 mm/s TRIGGER AT end DISTANCE -5 mm DELAY 0.2 s DO other()",
]


@pytest.mark.parametrize("given", UNSAYABLE)
def test_what_cannot_be_said_stops_the_program_there(given: str) -> None:
    text, codes = listing("VAR R1: REAL\n" + given if given.startswith("FOR") else given)
    assert "tp-guarded-stop" in codes
    found = numbered(text)
    if "TRIGGER" in given:  # the move itself goes on behind the stop
        assert found.pop() == "L P[1] 100mm/sec FINE"
    assert found[-1] == "PAUSE"
    assert found[-2].startswith("!")


def test_remarks_are_ascii_and_short() -> None:
    found = lines("-- Größe 5 µm: this remark is far too long for the little screen of the pendant\nR[1] = 1.0")
    assert found[-1] == "R[1]=1"
    assert " ".join(line.removeprefix("!") for line in found[:-1]).startswith("Grosse 5 um: this remark is far")
    assert all(len(line) <= 33 for line in found[:-1])


def test_the_frame_of_a_listing() -> None:
    text, _ = listing("R[1] = 1.0")
    assert text.startswith("/PROG  P\r\n/ATTR\r\n")
    for part in ("LINE_COUNT\t= 1;", "DEFAULT_GROUP\t= *,*,*,*,*;", "/APPL\r\n/MN\r\n", "/POS\r\n", "/END\r\n"):
        assert part in text
    assert text == listing("R[1] = 1.0")[0]


def test_rounded_values_are_reported() -> None:
    _, codes = listing("MOVE TO P2 JOINT SPEED 33.3 %\nMOVE LINEAR TO P1 SPEED 33.33 mm/s BLEND 2.5 mm")
    assert codes == ["tp-rounded"] * 3


def test_a_joint_moves_corner_distance_becomes_cnt() -> None:
    text, codes = listing("MOVE TO P2 JOINT SPEED 50 % BLEND 20 mm")
    assert numbered(text) == ["J P[2] 50% CNT5"]
    assert codes == ["tp-joint-corner"]


def test_an_action_counted_from_the_start_is_counted_from_the_end() -> None:
    there = "MOVE LINEAR TO P1 SPEED 100 mm/s"
    line = "MOVE LINEAR TO {x: 400, y: 30, z: 340, a: 180, b: 0, c: 180} SPEED 100 mm/s"
    found = lines(f"{there}\n{line} TRIGGER AT start DISTANCE 5 mm DO SET do[3] TO ON")
    assert found[1] == "L P[3] 100mm/sec FINE DB 45.0mm,DO[3]=ON"
    via, goal = "x: 410, y: 10, z: 300, a: 180, b: 0, c: 180", "x: 400, y: 20, z: 300, a: 180, b: 0, c: 180"
    half = f"MOVE CIRCULAR VIA {{{via}}} TO {{{goal}}}"
    text, codes = listing(f"{there}\n{half} SPEED 100 mm/s TRIGGER AT start DO SET do[3] TO ON")
    assert not codes
    assert "P[4] 100mm/sec FINE DB 31.4mm,DO[3]=ON" in text


def test_a_way_along_the_tool_goes_from_the_point_before() -> None:
    found = lines("MOVE LINEAR TO P1 SPEED 100 mm/s BLEND 5 mm\nMOVE LINEAR BY {z: -80} IN TOOL SPEED 100 mm/s")
    assert found[1:] == ["PR[100]=P[3]", "L P[1] 100mm/sec FINE Tool_Offset,PR[100]"]
    found = lines("MOVE LINEAR BY {z: -80} IN TOOL SPEED 100 mm/s", entry="p")  # it begins with a standing robot
    assert found[-3:] == ["PR[99]=LPOS", "PR[100]=P[3]", "L PR[99] 100mm/sec FINE Tool_Offset,PR[100]"]


def test_a_way_along_the_tool_in_a_position_register() -> None:
    found = lines("MOVE LINEAR TO P1 SPEED 100 mm/s\nMOVE LINEAR BY PR[7] IN TOOL SPEED 100 mm/s")
    assert found[1:] == ["L P[1] 100mm/sec FINE Tool_Offset,PR[7]"]
    found = lines("MOVE LINEAR TO PR[3] : P1 SPEED 100 mm/s")  # a taught point seen from a computed frame
    assert found == ["PR[100]=P[1]", "L PR[3] 100mm/sec FINE Tool_Offset,PR[100]"]
    codes = listing("MOVE LINEAR BY inverse(PR[7]) IN TOOL SPEED 100 mm/s")[1]
    assert "tp-guarded-stop" in codes


def test_a_way_along_the_tool_from_a_place_that_is_not_known() -> None:
    """The robot may stand already, or it comes to rest first; a corner that is lost by that is said."""
    away = "MOVE LINEAR BY {z: -80} IN TOOL SPEED 100 mm/s"
    text, codes = listing(f"MOVE LINEAR TO P1 SPEED 100 mm/s FINE\nLABEL here\n{away}\nIF di[1] THEN GOTO here")
    assert codes == ["tp-stop-before"]
    assert numbered(text)[2:5] == ["L P[3] 100mm/sec FINE INC", "PR[99]=LPOS", "PR[100]=P[4]"]
    assert listing(f"MOVE LINEAR TO P1 SPEED 100 mm/s BLEND 5 mm\nLABEL here\n{away}")[1] == ["tp-corner-stopped"]

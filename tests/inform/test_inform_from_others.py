"""Programs of other languages written as jobs: each sets an output per expectation and still meets it as jobs."""

from __future__ import annotations

import pytest

from rpl.diagnostics import Diagnostics, Severity
from rpl.project import read_sources
from rpl.proof.prove import prove_programs
from rpl.simulation import run_program
from rpl.source import source_from_bytes, source_from_text
from rpl.translation import translate_program

SUFFIXES = {"krl": "src", "rapid": "mod", "rpl": "rpl", "urscript": "script", "vplus": "v2", "tp": "ls"}
ROBOT = "motoman_gp7"


def jobs_of(
    language: str, text: str, robot: str | None = ROBOT, entry: str | None = None
) -> tuple[dict[str, list[str]], Diagnostics, set[int]]:
    """Lines of each job behind NOP, what was reported, and the outputs that are on at the end of its run; it means the
    same as the program it was written from when nothing was lost."""
    diagnostics = Diagnostics()
    read = read_sources([source_from_text(f"one.{SUFFIXES[language]}", text)], language, diagnostics)
    assert not diagnostics.has_errors, [item.as_text() for item in diagnostics]
    translation = translate_program(read, "inform", robot, None, diagnostics)
    again = Diagnostics()
    jobs = [file for file in translation.files if file.path.endswith(".JBI")]
    back = read_sources([source_from_bytes(file.path, file.data) for file in translation.files], "inform", again)
    assert not again.has_errors, [item.as_text() for item in again]
    if not diagnostics.of(Severity.LOSS):
        result = prove_programs(read.program, back.program, robot, robot, None)
        assert result.agrees, result.as_text()
    run = run_program(back.program, robot, None, entry, controller="plain")
    state: dict[int, bool] = {}
    for _, name, value in run.outputs:
        state[int(str(name).partition("(")[2].rstrip(")"))] = bool(value)
    lines = {}
    for file in jobs:
        text = file.data.decode("ascii")
        lines[file.path[:-4]] = text.split("NOP\r\n")[1].removesuffix("\r\nEND\r\n").split("\r\n")
    return lines, diagnostics, {number for number, on in state.items() if on}


def codes(diagnostics: Diagnostics, severity: Severity) -> set[str]:
    return {item.code.name for item in diagnostics.of(severity)}


def test_a_long_message_is_shown_in_lines() -> None:
    text = """def show():
  step = 7
  textmsg("no answer of the machine in step ", step)
  popup("this is a message that is longer than a line", title="x", error=False)
end
"""
    jobs, diagnostics, _ = jobs_of("urscript", text)
    shown = [line for line in jobs["SHOW"] if line.startswith("MSG")]
    assert shown == [
        'MSG "no answer of the machine in step"',
        "MSG S000",
        'MSG "this is a message that is longer"',
        'MSG "than a line"',
    ]
    assert "message-split" in codes(diagnostics, Severity.WARNING)


@pytest.mark.parametrize(
    ("language", "text", "expected"),
    [
        pytest.param(
            "krl",
            """DEF one()
DECL INT n, m
n = 300
m = 5000
$OUT[1] = ((n B_AND 260) == 260)
$OUT[2] = ((n B_OR 65536) == 65836)
$OUT[3] = ((n B_EXOR m) == 4772)
$OUT[4] = ((-2 B_AND 7) == 6)
END
""",
            {1, 2, 3, 4},
            id="bits",
        ),
        pytest.param(
            "rapid",
            """MODULE one
PROC main()
IF TRUE SetDO do1,1;
IF FALSE SetDO do2,1;
IF FALSE THEN
SetDO do3,1;
ELSE
SetDO do4,1;
ENDIF
ENDPROC
ENDMODULE
""",
            {1, 4},
            id="conditions that are always the same",
        ),
        pytest.param(
            "krl",
            """DEF one()
DECL INT t
$TIMER[3] = 0
$TIMER_STOP[3] = FALSE
WAIT SEC 0.5
$OUT[1] = ($TIMER[3] > 450)
$TIMER_STOP[3] = TRUE
WAIT SEC 0.5
t = $TIMER[3]
$OUT[2] = (t < 600)
$TIMER[3] = -200
$TIMER_STOP[3] = FALSE
WAIT FOR $TIMER_FLAG[3]
$OUT[3] = TRUE
WAIT FOR $IN[5] OR ($TIMER[3] > 1000)
$OUT[4] = TRUE
END
""",
            {1, 2, 3, 4},
            id="timers",
        ),
        pytest.param(
            "rapid",
            """MODULE one
VAR clock clAll;
PROC main()
ClkReset clAll;
ClkStart clAll;
WaitTime 0.3;
ClkStop clAll;
WaitTime 0.3;
IF ClkRead(clAll) > 0.25 AND ClkRead(clAll) < 0.35 SetDO do1,1;
IF ClkRead(clAll) > 10 RETURN;
SetDO do2,1;
ENDPROC
ENDMODULE
""",
            {1, 2},
            id="stop watches",
        ),
        pytest.param(
            "rpl",
            """MODULE one
PROCEDURE main()
VAR t: STRING
VAR x: REAL
VAR n: INT
VAR good: BOOL
t = "Pallet-12"
SET do[1] TO text_find(t, 1, "let") = 4 AND text_find(t, 5, "let") = 0 AND text_find(t, 1, "12") = 8
SET do[2] TO text_upper(t) = "PALLET-12" AND text_lower(t) = "pallet-12"
SET do[3] TO text_find_any(t, 1, "0123456789") = 8 AND text_find_any(t, 1, "xyz") = 10
SET do[4] TO text_match(t, 1, "all") = 2 AND text_match(t, 1, "ALL") = 10 AND text_member(t, 3, "klm")
SET do[5] TO text_map("abc", "cb", "xy") = "ayx" AND text_equal(t, "PALLET-12", TRUE)
SET do[6] TO number_text(12.345, 1) = "12.3" AND number_text(-0.996, 2) = "-1.00" AND number_text(-0.001, 2) = "0.00"
SET do[7] TO number_text(5.0625, 3) = "5.063" AND number_text(1.05, 2) = "1.05" AND number_text(-7, 0) = "-7"
good = parse_number("  -12.5e1 ", x)
SET do[8] TO good AND x = -125
good = parse_number("12a", x)
SET do[9] TO NOT good AND x = -125
good = parse_number("1 2", x)
SET do[10] TO NOT good
good = parse_number("42", n)
SET do[11] TO good AND n = 42
good = parse_number(".", x)
SET do[12] TO NOT good
END PROCEDURE
END MODULE
""",
            set(range(1, 13)),
            id="texts",
        ),
        pytest.param(
            "krl",
            """DEF one()
DECL CHAR t[8]
t[] = "ABCDEF"
$OUT[1] = (t[4] == "D")
t[4] = "x"
$OUT[2] = (StrComp(t[], "ABCxEF", #CASE_SENS))
t[1] = "y"
t[6] = "z"
$OUT[3] = (StrComp(t[], "yBCxEz", #CASE_SENS))
END
""",
            {1, 2, 3},
            id="characters of a text",
        ),
    ],
)
def test_expectations_are_met(language: str, text: str, expected: set[int]) -> None:
    _, diagnostics, on = jobs_of(language, text)
    assert not diagnostics.of(Severity.LOSS), [item.as_text() for item in diagnostics.of(Severity.LOSS)]
    assert on == expected


def test_a_task_counts_stop_watches_as_long_as_the_program_runs() -> None:
    text = "DEF one()\n$TIMER[1] = 0\n$TIMER_STOP[1] = FALSE\nWAIT SEC 0.5\n$OUT[1] = ($TIMER[1] > 450)\nEND\n"
    jobs, diagnostics, _ = jobs_of("krl", text)
    (run,) = [line.split()[1] for line in jobs["RPL_WATCH"] if line.startswith("WHILEEXP")]
    runs = run.removesuffix("=1")
    start = jobs["ONE"].index("PSTART JOB:RPL_WATCH SUB1")
    assert jobs["ONE"][start - 1] == f"SET {runs} 1" and jobs["ONE"][-1] == f"SET {runs} 0"
    _, wait, *count, end = jobs["RPL_WATCH"]
    assert (wait, count[1].split()[0], end) == ("TIMER T=0.01", "INC", "ENDWHILE")
    assert "stop-watch-counted" in codes(diagnostics, Severity.WARNING)


def test_a_small_corner_of_a_joint_move_is_no_stop() -> None:
    text = """MODULE one
PROC main()
MoveAbsJ [[0,0,0,0,-60,0],[9E9,9E9,9E9,9E9,9E9,9E9]],v500,fine,tool0;
MoveAbsJ [[20,0,0,0,-60,0],[9E9,9E9,9E9,9E9,9E9,9E9]],v500,z10,tool0;
MoveAbsJ [[40,0,0,0,-60,0],[9E9,9E9,9E9,9E9,9E9,9E9]],v500,z50,tool0;
MoveAbsJ [[0,0,0,0,-60,0],[9E9,9E9,9E9,9E9,9E9,9E9]],v500,fine,tool0;
ENDPROC
ENDMODULE
"""
    jobs, diagnostics, _ = jobs_of("rapid", text)
    assert [line.split()[-1] for line in jobs["MAIN"]] == ["PL=0", "PL=1", "PL=3", "PL=0"]
    assert "inform-joint-corner" in codes(diagnostics, Severity.WARNING)


JOINTS = """DEF one()
DECL E6AXIS AX
DECL REAL W
W = 5
PTP {A1 10, A2 0, A3 0, A4 0, A5 -60, A6 0}
AX = $AXIS_ACT
$OUT[1] = (ABS(AX.A1 - 10) < 0.01) AND (ABS(AX.A5 + 60) < 0.01)
PTP_REL {A1 W, A2 3}
AX = $AXIS_ACT
$OUT[2] = (ABS(AX.A1 - 15) < 0.01) AND (ABS(AX.A2 - 3) < 0.01)
AX.A1 = 20.25
PTP AX
$OUT[3] = (ABS($AXIS_ACT.A1 - 20.25) < 0.01)
END
"""


def test_angles_of_joints_are_counted_in_pulses() -> None:
    jobs, diagnostics, on = jobs_of("krl", JOINTS, "motoman_ma2010")
    assert not diagnostics.of(Severity.LOSS), [item.as_text() for item in diagnostics.of(Severity.LOSS)]
    assert on == {1, 2, 3}
    assert any(line.startswith("GETE") for line in jobs["ONE"])


def test_without_pulses_per_degree_the_angles_are_refused_by_name() -> None:
    _, diagnostics, _ = jobs_of("krl", JOINTS)
    assert codes(diagnostics, Severity.LOSS) == {"inform-joint-angle"}


def test_joints_of_an_arm_whose_controller_counts_no_pulses_have_a_neutral_scale() -> None:
    """Variables are pulses by it, which is reported once; taught points stay poses, which any controller can go to."""
    jobs, diagnostics, on = jobs_of("krl", JOINTS, "kuka_kr6r900sixx")
    assert not diagnostics.of(Severity.LOSS) and on == {1, 2, 3}
    assert [item.code.name for item in diagnostics.of(Severity.WARNING)].count("pulses-assumed") == 1
    assert "///PULSE" not in jobs["ONE"] and any("10000.0" in line for line in jobs["ONE"])


def test_programs_that_calculate_with_no_joints_need_no_scale() -> None:
    text = "DEF one()\nPTP {A1 0, A2 -90, A3 90, A4 0, A5 30, A6 0}\n$OUT[1] = TRUE\nEND\n"
    _, diagnostics, on = jobs_of("krl", text, "kuka_kr6r900sixx")
    assert not diagnostics.of(Severity.WARNING) and on == {1}


RELATIVE = """DEF one()
DECL E6AXIS AX
PTP {A1 0, A2 -90, A3 90, A4 0, A5 30, A6 0}
LIN {X 450, Y 0, Z 600, A 0, B 90, C 0}
LIN_REL {Z 10}
AX = $AXIS_ACT
PTP_REL {A1 8}
$OUT[1] = (ABS($AXIS_ACT.A1 - AX.A1 - 8) < 0.01)
AX = {A1 0, A2 -90, A3 90, A4 0, A5 30, A6 0}
AX.A5 = AX.A5 + 20
PTP AX
$OUT[2] = (ABS($AXIS_ACT.A5 - 50) < 0.01)
END
"""


def test_relative_joint_moves_from_a_place_that_is_not_known() -> None:
    _, diagnostics, on = jobs_of("krl", RELATIVE, "kuka_kr6r900sixx")
    assert not diagnostics.of(Severity.LOSS), [item.as_text() for item in diagnostics.of(Severity.LOSS)]
    assert on == {1, 2}


ARC_IN_COMPUTED_FRAME = """DEF one()
DECL FRAME F
F = {X 0, Y 0, Z 0, A 0, B 0, C 0}
F.X = F.X + 400 * 1.0
$BASE = F
PTP {A1 0, A2 -90, A3 90, A4 0, A5 60, A6 0}
LIN {X 60, Y -80, Z 200, A 0, B 180, C 0}
CIRC {X 100, Y -120, Z 200, A 0, B 180, C 0}, {X 140, Y -80, Z 200, A 0, B 180, C 0}
$OUT[1] = (ABS($POS_ACT.X - 140) < 0.05) AND (ABS($POS_ACT.Y + 80) < 0.05)
END
"""


def test_an_arc_whose_points_are_all_computed_starts_where_the_robot_is() -> None:
    jobs, diagnostics, on = jobs_of("krl", ARC_IN_COMPUTED_FRAME, "kuka_kr6r900sixx")
    assert not diagnostics.of(Severity.LOSS) and on == {1}
    points = [line.split()[1] for line in jobs["ONE"] if line.startswith("MOVC")]
    assert len(points) == len(set(points)) == 3


PATH = """DEF one()
PTP {A1 0, A2 -90, A3 90, A4 0, A5 30, A6 0}
LIN {X 450, Y 0, Z 600, A 0, B 90, C 0}
TRIGGER WHEN PATH=-20 DELAY=0 DO $OUT[1]=TRUE
TRIGGER WHEN PATH=-50 DELAY=0 DO $OUT[2]=TRUE
LIN {X 450, Y 100, Z 600, A 0, B 90, C 0}
TRIGGER WHEN PATH=-10 DELAY=0 DO $OUT[3]=TRUE
CIRC {X 450, Y 150, Z 550, A 0, B 90, C 0}, {X 450, Y 100, Z 500, A 0, B 90, C 0}
END
"""


def test_actions_on_a_path_stand_behind_points_that_the_move_is_cut_at() -> None:
    jobs, diagnostics, on = jobs_of("krl", PATH, "kuka_kr6r900sixx")
    assert not diagnostics.of(Severity.LOSS), [item.as_text() for item in diagnostics.of(Severity.LOSS)]
    assert on == {1, 2, 3}
    words = [line.split()[0] + ("" if "DOUT" not in line else line.split()[1]) for line in jobs["ONE"]]
    assert words == [
        *("MOVJ", "MOVL", "MOVL", "DOUTOT#(2)", "MOVL", "DOUTOT#(1)"),
        *("MOVC", "MOVC", "MOVC", "DOUTOT#(3)", "MOVC", "MOVC"),
    ]
    assert "inform-path-event" in codes(diagnostics, Severity.WARNING)


def test_an_action_whose_place_is_not_known_is_refused_by_name() -> None:
    text = PATH.replace("PATH=-20", "PATH=-200")
    _, diagnostics, _ = jobs_of("krl", text, "kuka_kr6r900sixx")
    assert codes(diagnostics, Severity.LOSS) == {"inform-path-event-lost"}


MANY = """DEF one()
DECL INT n,k
n=0
k=0
IF (($IN[1] OR $IN[2]) AND ($IN[3] OR $IN[4]) AND ($IN[5] OR $IN[6])) OR (n==0) THEN
$OUT[1]=TRUE
ENDIF
WHILE (n<10) AND ((k==0) OR (k==1) OR (k==2) OR (k==3) OR (k==4) OR (k==5) OR (k==6) OR (k==7) OR (k==8) OR (k==9))
n=n+1
IF n>4 THEN
k=20
ENDIF
ENDWHILE
$OUT[2]=n==5
IF OTHERS THEN
$OUT[3]=TRUE
ENDIF
k=5
$OUT[4]=NOT ((k==1) OR (k==2) OR (k==3) OR (k==4) OR (k==15) OR (k==6) OR (k==7) OR (k==8) OR (k==9) OR (k==10))
WAIT FOR (($IN[1] OR $IN[2]) AND ($IN[3] OR $IN[4]) AND ($IN[5] OR $IN[6])) OR (n==5)
$OUT[5]=TRUE
END
"""


OTHERS = " AND ".join(f"(n<>{number})" for number in range(20) if number != 5)


def test_conditions_of_many_comparisons_are_found_out_in_parts() -> None:
    """Also those that only spelling them out without brackets makes long; no line is longer than a controller's."""
    jobs, diagnostics, on = jobs_of("krl", MANY.replace("OTHERS", OTHERS), "kuka_kr6r900sixx")
    assert not diagnostics.of(Severity.LOSS), [item.as_text() for item in diagnostics.of(Severity.LOSS)]
    assert on == {1, 2, 3, 4, 5}
    assert max(len(line) for line in jobs["ONE"]) <= 128


COMPUTED = """DEF one()
DECL FRAME F
DECL REAL way
way = 30
PTP {A1 0, A2 -90, A3 90, A4 0, A5 60, A6 0}
$VEL.CP = 0.1
LIN {X 450, Y 0, Z 600, A 0, B 90, C 0}
F = $POS_ACT
F.Y = F.Y + 80
TRIGGER WHEN DISTANCE=1 DELAY=-400 DO $OUT[6]=TRUE
TRIGGER WHEN PATH=-20 DELAY=0 DO $OUT[1]=TRUE
LIN F C_DIS
F.X = F.X - 60
TRIGGER WHEN PATH=-15 DELAY=-100 DO $OUT[3]=TRUE
LIN F
F.Y = F.Y - 70
F.C = F.C + 20
TRIGGER WHEN PATH=-25 DELAY=0 DO count()
LIN F
F.Y = F.Y + 70
TRIGGER WHEN PATH=-way DELAY=0 DO $OUT[2]=TRUE
LIN F
F.Z = F.Z + 1
TRIGGER WHEN PATH=-5 DELAY=0 DO $OUT[5]=TRUE
LIN F
END
DEF count()
$OUT[4]=TRUE
END
"""


def test_actions_on_a_path_with_a_computed_end_stand_behind_computed_points() -> None:
    """Also where its turning tool, a corner before it, a computed distance or a move that is too short is meant."""
    _, diagnostics, on = jobs_of("krl", COMPUTED, "kuka_kr6r900sixx", "ONE")
    assert not diagnostics.of(Severity.LOSS), [item.as_text() for item in diagnostics.of(Severity.LOSS)]
    assert on == {1, 2, 3, 4, 5, 6}
    assert "path-event-point" in codes(diagnostics, Severity.WARNING)


def test_where_the_robot_is_with_a_tool_of_its_data() -> None:
    text = """MODULE one
PERS tooldata tPen:=[TRUE,[[0,0,100],[1,0,0,0]],[0.5,[0,0,50],[1,0,0,0],0,0,0]];
PERS tooldata tLong:=[TRUE,[[0,0,150],[1,0,0,0]],[0.5,[0,0,50],[1,0,0,0],0,0,0]];
PERS wobjdata wBoard:=[FALSE,TRUE,"",[[350,0,100],[0.70710678,0,0,0.70710678]],[[0,0,0],[1,0,0,0]]];
CONST jointtarget jStart:=[[0,0,0,0,90,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
PROC main()
VAR robtarget now;
VAR robtarget other;
MoveAbsJ jStart,v1000,fine,tPen;
now:=CRobT(\\Tool:=tPen\\WObj:=wobj0);
other:=CRobT(\\Tool:=tLong\\WObj:=wobj0);
IF Abs(now.trans.z-other.trans.z-50) < 0.01 SetDO do1,1;
other:=CRobT(\\Tool:=tPen\\WObj:=wBoard);
IF Abs(now.trans.z-other.trans.z-100) < 0.01 AND Abs(350-other.trans.y-now.trans.x) < 0.01 SetDO do2,1;
ENDPROC
ENDMODULE
"""
    _, diagnostics, on = jobs_of("rapid", text, "abb_irb120_3_58")
    assert not diagnostics.of(Severity.LOSS), [item.as_text() for item in diagnostics.of(Severity.LOSS)]
    assert on == {1, 2}


def test_interrupts_that_come_while_the_program_waits_are_looked_for_there() -> None:
    text = """DEF one()
INTERRUPT DECL 5 WHEN $IN[1]==TRUE DO seen()
INTERRUPT ON 5
WAIT SEC 1
INTERRUPT OFF 5
END
DEF seen()
WAIT SEC 1
END
"""
    _, diagnostics, _ = jobs_of("krl", text, entry="ONE")
    assert not codes(diagnostics, Severity.LOSS)
    assert "interrupt-served" in codes(diagnostics, Severity.WARNING)


TIMED = """DEF one()
DECL FRAME F
PTP {A1 0, A2 -90, A3 90, A4 0, A5 60, A6 0}
F = $POS_ACT
F.X = F.X - 30
$VEL.CP = 0.1
LIN F
F.Y = F.Y + 60
TRIGGER WHEN DISTANCE=0 DELAY=100 DO $OUT[1]=TRUE
TRIGGER WHEN DISTANCE=0 DELAY=250 DO $OUT[3]=TRUE
LIN F
$OUT[2] = $OUT[1] AND $OUT[3]
END
"""


def test_an_action_some_time_behind_the_start_of_a_computed_move_follows_a_timer() -> None:
    """The lines behind NWAIT are done on the way, those behind CWAIT at its end."""
    diagnostics = Diagnostics()
    read = read_sources([source_from_text("one.src", TIMED)], "krl", diagnostics)
    robot = "kuka_kr6r900sixx"
    translation = translate_program(read, "inform", robot, None, diagnostics)
    assert not diagnostics.of(Severity.LOSS), [item.as_text() for item in diagnostics.of(Severity.LOSS)]
    sources = [source_from_bytes(file.path, file.data) for file in translation.files]
    lines = sources[0].text.splitlines()
    at = next(n for n, line in enumerate(lines) if line.endswith("NWAIT"))
    assert lines[at + 1 : at + 6] == ["TIMER T=0.10", "DOUT OT#(1) ON", "TIMER T=0.15", "DOUT OT#(3) ON", "CWAIT"]
    first = [round(time, 2) for time, *_ in run_program(read.program, robot, controller="plain").outputs]
    back = read_sources(sources, "inform", diagnostics)
    second = [round(time, 2) for time, *_ in run_program(back.program, robot, controller="plain").outputs]
    assert first[1] - first[0] == pytest.approx(second[1] - second[0])
    assert first[2] - first[0] == pytest.approx(second[2] - second[0], abs=0.02)


def test_what_stands_behind_a_move_waits_for_its_end() -> None:
    text = PATH.replace("TRIGGER WHEN PATH=-20", "TRIGGER WHEN DISTANCE=0").replace("END\n", "$OUT[4] = TRUE\nEND\n")
    _, diagnostics, on = jobs_of("krl", text, "kuka_kr6r900sixx")
    assert on == {1, 2, 3, 4} and not diagnostics.of(Severity.LOSS)


def test_a_straight_way_between_two_arcs_stays_straight() -> None:
    text = """DEF one()
PTP {A1 0, A2 -90, A3 90, A4 0, A5 30, A6 0}
LIN {X 450, Y 0, Z 600, A 0, B 90, C 0}
CIRC {X 450, Y 50, Z 550, A 0, B 90, C 0}, {X 450, Y 0, Z 500, A 0, B 90, C 0}
LIN {X 450, Y -50, Z 500, A 0, B 90, C 0}
CIRC {X 450, Y -75, Z 525, A 0, B 90, C 0}, {X 450, Y -50, Z 550, A 0, B 90, C 0}
END
"""
    jobs, _, _ = jobs_of("krl", text, "kuka_kr6r900sixx")
    words = [line.split()[0] for line in jobs["ONE"]]
    assert words == ["MOVJ", *("MOVC",) * 3, "MOVL", *("MOVC",) * 3]

"""TP motion statements by what they mean, beside the same in RPL, and by what the robot does."""

import pytest
from tp_reading_helpers import POINTS, body, cartesian, listing, outputs, read, reports, run

J, L = "MOVE TO P1 ", "MOVE LINEAR TO P2 "
CASES = [
    ("J P[1] 100% FINE", J + "JOINT SPEED 100 FINE"),
    ("J P[1] R[1]% CNT R[2]", J + "JOINT SPEED R1 BLEND PERCENT R2"),
    ("J P[1] 2.0sec FINE ACC80", J + "DURATION 2.0 ACCELERATION 80 FINE"),
    ("J P[1] 500msec FINE", J + "DURATION 500 ms FINE"),
    ("J P[1] max_speed FINE", J + "JOINT SPEED 100 FINE"),
    ("L P[2] 100mm/sec FINE", L + "SPEED 100 FINE"),
    ("L P[2] R[1]mm/sec FINE", L + "SPEED R1 FINE"),
    ("L P[2] 240cm/min FINE", L + "SPEED 240 cm/min FINE"),
    ("L P[2] 100inch/min FINE", L + "SPEED 100 inch/min FINE"),
    ("L P[2] 90deg/sec FINE", L + "REORIENT 90 FINE"),
    ("L P[2] max_speed FINE", L + "SPEED 2000.0 FINE"),
    ("L P[2] 100mm/sec CR10", L + "SPEED 100 BLEND 10"),
    ("L P[2] 100mm/sec CD5", L + "SPEED 100 BLEND 5"),
    ("L P[2] 100mm/sec CNT0", L + "SPEED 100 BLEND PERCENT 0"),
    ("L P[2] 500mm/sec CNT100", L + "SPEED 500 BLEND PERCENT 100 PATH BLEND 33.627"),
    # half the acceleration: a ramp twice as long, and a corner twice as large
    ("L P[2] 500mm/sec CNT100 ACC50", L + "SPEED 500 ACCELERATION 50 BLEND PERCENT 100 PATH BLEND 67.253"),
    ("L P[2] 100mm/sec FINE ACC R[3]", L + "SPEED 100 ACCELERATION R3 FINE"),
    ("L P[2] 100mm/sec FINE Wjnt", L + "SPEED 100 FINE ORIENTATION wrist"),
    ("L PR[1] 100mm/sec FINE INC", "MOVE LINEAR BY PR1 SPEED 100 FINE"),
    ("C P[2]\n: P[3] 100mm/sec FINE", "MOVE CIRCULAR VIA P2 TO P3 SPEED 100 FINE"),
    (
        "L P[2] 100mm/sec FINE Offset,PR[1]",
        "MOVE LINEAR TO element_sum(P2, PR1) SPEED 100 FINE",
    ),
    (
        "L P[2] 100mm/sec FINE Tool_Offset,PR[1:up]",
        "MOVE LINEAR TO displaced_in_tool(P2, pose_of(PR1)) SPEED 100 FINE",
    ),
    (
        "C P[2] Offset,PR[1]\n: P[3] 100mm/sec FINE Offset,PR[1]",
        "MOVE CIRCULAR VIA element_sum(P2, PR1) TO element_sum(P3, PR1) SPEED 100 FINE",
    ),
    (
        "L P[2] 100mm/sec CNT0 TB    .20sec,DO[1]=ON",
        L + "SPEED 100 BLEND PERCENT 0 TRIGGER AT end DELAY (-0.2) DO SET do[1] TO ON",
    ),
    ("L P[2] 100mm/sec FINE TA .5sec,CALL MAIN", L + "SPEED 100 FINE TRIGGER AT end DELAY 0.5 DO MAIN()"),
    (
        "L P[2] 100mm/sec FINE DB  10.0mm,DO[1]=ON ACC50",
        L + "SPEED 100 ACCELERATION 50 FINE TRIGGER AT end DISTANCE (-10.0) DO SET do[1] TO ON",
    ),
]


@pytest.mark.parametrize(("line", "meaning"), CASES, ids=[case[0] for case in CASES])
def test_a_move_means(line: str, meaning: str) -> None:
    assert body(line) == [meaning]


VENDOR = [
    ("PTH", "tuning"),
    ("BREAK", "tuning"),
    ("EV50%", "tuning"),
    ("Ind.EV 50%", "tuning"),
    ("Arc Start[1]", "unknown"),
    ("VOFFSET,VR[1]", "unknown"),
]


@pytest.mark.parametrize(("option", "effect"), VENDOR)
def test_an_option_of_this_controller_alone_stands_before_its_move(option: str, effect: str) -> None:
    lines = body(f"L P[2] 100mm/sec FINE {option}")
    assert lines == [f'VENDOR tp "{option}" EFFECT {effect}', L + "SPEED 100 FINE"]


def test_skip_jumps_without_the_condition() -> None:
    lines = body("SKIP CONDITION DI[5]=ON\nL P[2] 100mm/sec FINE Skip,LBL[1],PR[1]=LPOS\nLBL[1]")
    assert lines[1:5] == [
        L + "SPEED 100 FINE SEARCH di[5] INTO PR1 HIT skip_hit STOPPING stop",
        "IF NOT skip_hit THEN",
        "GOTO LBL1",
        "END IF",
    ]


def test_points_by_number_are_a_branch_for_each() -> None:
    lines = body("J P[R[1]] 50% FINE")
    assert lines[0] == "SWITCH to_int(R1)"
    assert lines[1:3] == ["CASE 1", J + "JOINT SPEED 50 FINE"]
    assert lines.count("END SWITCH") == 1


def test_a_points_are_arcs() -> None:
    """M: the first point on a line, then two for each arc."""
    lines = body("A P[2] 100mm/sec FINE\nA P[3] 100mm/sec CNT0\nA P[4] 100mm/sec FINE")
    assert lines == [L + "SPEED 100 FINE", "MOVE CIRCULAR VIA P3 TO P4 SPEED 100 FINE"]


def test_a_lonely_a_point_is_reported() -> None:
    _, diagnostics = read(listing("A P[2] 100mm/sec FINE\nA P[3] 100mm/sec FINE"))
    assert reports(diagnostics) == ["tp-arc-points"]


def test_s_points_are_a_spline() -> None:
    lines = body("S P[2] 100mm/sec CNT100\nS P[3] 100mm/sec FINE")
    assert lines[0].startswith("SPLINE") and lines[-1] == "END SPLINE"


def test_point_logic_is_a_program_at_a_time_of_its_move() -> None:
    program, diagnostics = read(
        listing("J P[1] 100% CNT0 TB    .10sec,P-SPS\nDO[1]=OFF\nLBL[1]\n------\nDO[2]=ON\nLBL[1]")
    )
    assert not diagnostics.has_errors
    main, nested = program.modules[-1].routines
    assert (len(main.body), len(nested.body)) == (3, 2)


# ---- what the robot does


def test_moves_reach_their_points() -> None:
    result = run(listing("J P[1] 50% FINE\nL P[2] 200mm/sec FINE"))
    assert result.status == "finished" and result.moves == 2
    place = [event.as_json()["xyz_mm"] for event in result.trace if event.kind == "move"]
    assert place[-1] == pytest.approx([400, 100, 200], abs=1e-3)


def where(lines: str, *more: str, cell: str = "", points: str = POINTS) -> list[float]:
    """Where the tool stands at the end, in the robot's base."""
    result = run(listing(lines, points), *more, cell=cell)
    assert result.status == "finished", result.fault
    return next(e.as_json()["xyz_mm"] for e in reversed(result.trace) if e.kind == "move")  # type: ignore[return-value]


def test_an_offset_is_in_the_user_frame_and_a_tool_offset_in_the_tool() -> None:
    cell = "[variables]\nPR1 = { x = 10.0, y = 0.0, z = 30.0, a = 0.0, b = 0.0, c = 0.0 }"
    assert where("J P[1] 50% FINE\nL P[2] 200mm/sec FINE Offset,PR[1]", cell=cell) == pytest.approx([410, 100, 230])
    assert where("J P[1] 50% FINE\nL P[2] 200mm/sec FINE Tool_Offset,PR[1]", cell=cell) == pytest.approx(
        [410, 100, 170]
    )


def test_a_user_frame_moves_the_points_and_changes_at_once() -> None:
    cell = '[variables]\n"UFRAME[1]" = { x = 0.0, y = 20.0, z = 5.0, a = 0.0, b = 0.0, c = 0.0 }'
    points = POINTS + cartesian(5, 400, 0, 200, frame="1")
    assert where("UFRAME_NUM=1\nJ P[5] 50% FINE", cell=cell, points=points) == pytest.approx([400, 20, 205])
    lines = "UFRAME_NUM=1\nPR[1]=UFRAME[1]\nPR[1,1]=30\nUFRAME[1]=PR[1]\nJ P[5] 50% FINE"
    assert where(lines, cell=cell, points=points) == pytest.approx([430, 20, 205])
    assert where(lines.replace("UFRAME[1]=PR[1]", "UFRAME[2]=PR[1]"), cell=cell, points=points) == pytest.approx(
        [400, 20, 205]
    )


def test_a_tool_is_taken_off_the_flange() -> None:
    cell = '[variables]\n"UTOOL[1]" = { x = 0.0, y = 0.0, z = 50.0, a = 0.0, b = 0.0, c = 0.0 }'
    result = run(listing("UTOOL_NUM=1\nJ P[1] 50% FINE\nPR[1]=LPOS\nIF PR[1,3]<240,DO[1]=ON"), cell=cell)
    assert outputs(result) == [("DO[1]", True)]


def test_incremental_moves_add_up() -> None:
    lines = "J P[2] 50% FINE\nL PR[1] 100mm/sec FINE INC\nL PR[1] 100mm/sec FINE INC"
    cell = "[variables]\nPR1 = { x = 0.0, y = -25.0, z = 0.0, a = 0.0, b = 0.0, c = 0.0 }"
    assert where(lines, cell=cell) == pytest.approx([400, 50, 200], abs=1e-3)


UNTAUGHT = "P[9]{\n GP1:\n UF : F, UT : F, CONFIG : 'N D B, 0, 0, 0',\n X = ******** mm, Y = ******** mm, Z = ******** mm,\n W = ******** deg, P = ******** deg, R = ******** deg\n};\n"  # noqa: E501


@pytest.mark.parametrize(
    ("lines", "warned"),
    [
        ("L P[9] 100mm/sec FINE", True),  # stars in the listing
        ("L P[8] 100mm/sec FINE", True),  # not in the listing
        ("L PR[1] 100mm/sec FINE", False),  # never set
        ("PR[1,1]=400\nL PR[1] 100mm/sec FINE", False),  # set in part
    ],
)
def test_a_move_to_a_position_without_value_is_a_fault(lines: str, warned: bool) -> None:
    text = listing(f"J P[1] 50% FINE\n{lines}\nDO[1]=ON", POINTS + UNTAUGHT)
    assert bool(reports(read(text)[1])) == warned
    result = run(text)
    assert result.status == "fault" and not result.outputs
    assert result.fault is not None and result.fault.as_json()["code"] == "no-value"


def test_logic_behind_fine_waits_for_the_robot() -> None:
    result = run(listing("J P[1] 50% FINE\nL P[2] 100mm/sec FINE\nDO[1]=ON"))
    arrived = [event.as_json()["t"] for event in result.trace if event.kind == "move"][-1]
    assert result.outputs[0][0] == pytest.approx(arrived)


def test_skip_stops_at_the_signal_and_goes_on() -> None:
    lines = (
        "J P[2] 50% FINE\nSKIP CONDITION DI[1]=ON\nL P[3] 50mm/sec FINE Skip,LBL[1],PR[1]=LPOS\n"
        "DO[1]=ON\nIF PR[1,2]>(-90),DO[2]=ON\nEND\nLBL[1]\nDO[3]=ON"
    )
    met = run(listing(lines), cell='[[input]]\ntime = 2.0\nsignal = "DI[1]"\nvalue = true')
    assert outputs(met) == [("DO[1]", True), ("DO[2]", True)]
    assert outputs(run(listing(lines))) == [("DO[3]", True)]


CHOSEN_SKIP = (
    "J P[2] 50% FINE\nIF DI[9]=ON,JMP LBL[5]\nSKIP CONDITION DI[1]=ON\nJMP LBL[6]\nLBL[5]\nSKIP CONDITION DI[2]=ON\n"
    "LBL[6]\nL P[3] 50mm/sec FINE Skip,LBL[1]\nDO[1]=ON\nEND\nLBL[1]\nDO[3]=ON"
)


@pytest.mark.parametrize(("chosen", "signal", "met"), [(0, 1, 1), (0, 2, 3), (1, 1, 3), (1, 2, 1)])
def test_the_skip_condition_that_was_executed_last_holds(chosen: int, signal: int, met: int) -> None:
    inputs = [(0.0, "DI[9]", chosen), (2.0, f"DI[{signal}]", 1)]
    cell = "\n".join(
        f'[[input]]\ntime = {time}\nsignal = "{name}"\nvalue = {"true" if value else "false"}'
        for time, name, value in inputs
    )
    assert outputs(run(listing(CHOSEN_SKIP), cell=cell)) == [(f"DO[{met}]", True)]


def test_a_condition_that_is_set_below_holds_in_the_next_pass() -> None:
    lines = (
        "SKIP CONDITION DI[1]=ON\nLBL[3]\nJ P[2] 50% FINE\nL P[3] 200mm/sec FINE Skip,LBL[1]\nDO[1]=ON\nEND\n"
        "LBL[1]\nSKIP CONDITION DI[2]=ON\nJMP LBL[3]"
    )
    cell = '[[input]]\ntime = 5.0\nsignal = "DI[2]"\nvalue = true'
    assert outputs(run(listing(lines), cell=cell)) == [("DO[1]", True)]


def test_one_condition_that_can_be_in_force_needs_no_choice() -> None:
    lines = "SKIP CONDITION DI[1]=ON\nL P[3] 50mm/sec FINE Skip,LBL[1]\nLBL[1]\nSKIP CONDITION DI[2]=ON\n"
    made = body(lines + "L P[2] 50mm/sec FINE Skip,LBL[2]\nLBL[2]")
    assert [line.split("SEARCH ")[1].split(" HIT")[0] for line in made if "SEARCH" in line] == ["di[1]", "di[2]"]
    assert not [line for line in made if "condition" in line]


def test_the_offset_condition_that_was_executed_last_holds() -> None:
    lines = (
        "PR[1]=LPOS-LPOS\nPR[2]=PR[1]\nPR[1,3]=10\nPR[2,3]=20\nOFFSET CONDITION PR[1]\n"
        "IF DI[9]=ON,JMP LBL[5]\nOFFSET CONDITION PR[2]\nLBL[5]\nL P[2] 100mm/sec FINE\nPR[3]=LPOS\n"
        "L P[2] 100mm/sec FINE Offset\nPR[4]=LPOS\nR[1]=PR[4,3]-PR[3,3]\nIF R[1]>15,DO[2]=ON\nIF R[1]<15,DO[1]=ON"
    )
    assert outputs(run(listing("J P[2] 50% FINE\n" + lines))) == [("DO[2]", True)]
    chosen = '[[input]]\ntime = 0.0\nsignal = "DI[9]"\nvalue = true'
    assert outputs(run(listing("J P[2] 50% FINE\n" + lines), cell=chosen)) == [("DO[1]", True)]


def test_a_frame_that_is_certainly_another_is_reported() -> None:
    found = read(listing("UFRAME_NUM=1\nL P[2] 100mm/sec FINE"))[1]
    assert reports(found) == ["tp-other-frame"]
    assert not reports(read(listing("UFRAME_NUM=0\nUTOOL_NUM=1\nL P[2] 100mm/sec FINE"))[1])
    assert not reports(read(listing("UFRAME_NUM=1\nCALL MAIN\nL P[2] 100mm/sec FINE"))[1])
    both = "IF (DI[1]) THEN\nUFRAME_NUM=1\nELSE\nUFRAME_NUM=0\nENDIF\nL P[2] 100mm/sec FINE"
    assert not reports(read(listing(both))[1])


def test_a_time_before_a_corner_counts_before_the_corner_is_known() -> None:
    """The next move is read where the corner begins; an action 0.1 s before its middle comes earlier than that."""
    lines = "J P[1] 100% FINE\nL P[2] 100mm/sec CNT50 TB    .10sec,DO[1]=ON\nL P[1] 100mm/sec FINE"
    result = run(listing(lines))
    corner = next(leg for event in result.trace for leg in event.legs if leg.plan.kind == "corner")
    assert result.outputs[0][1:] == ("DO[1]", True)
    assert result.outputs[0][0] == pytest.approx(corner.start_s + 0.5 * corner.duration_s - 0.1, abs=0.004)


def test_what_the_brackets_say_of_signals_and_whole_banks_is_kept() -> None:
    program, found = read(listing("R[R[1:at]]=0\nR[9:count]=1\nDO[3:lamp]=ON\nWAIT RI[1:part]=ON\nDO[3]=OFF"))
    said = [
        remark.text for module in program.modules for given in module.declarations for remark in given.origin.comments
    ]
    assert said == ["R[1] at", "R[9] count", "DO[3] lamp", "RI[1] part"] and not reports(found)

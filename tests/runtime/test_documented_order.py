"""When and where things happen, by the controllers' manuals: each rule names its source, each number is theirs.

EP: KUKA Expert Programming KSS 5.2. RG: ABB RAPID Reference Manual, BaseWare OS 3.1 (data types and instructions). RO:
the same, overview. The places are measured on the path that the run shows.
"""

import numpy as np
import pytest
from helpers import ABB, KUKA, krl, moves, rapid, time_of, tool_at

from rpl.runtime.trace import Leg, RunResult

INIT = (
    "BAS(#INITMOV,0)\n$TOOL=$NULLFRAME\n$BASE=$NULLFRAME\n$APO.CDIS=30\n$APO.CPTP=50\n$VEL.CP=0.2\n"
    "PTP {A1 0,A2 -90,A3 90,A4 0,A5 45,A6 0}\nLIN {X 550,Y 0,Z 400,A 0,B 135,C 0}\n"
)
NEAR = 0.05  # mm


def run_krl(body: str, more: str = "", cell: str | None = None) -> RunResult:
    result = krl(INIT + body, more=more, robot=KUKA, cell=cell)
    assert result.status == "finished", result.fault
    return result


def corners(result: RunResult) -> list[Leg]:
    return [leg for event in moves(result) for leg in event.legs if leg.plan.kind == "corner"]


def middle_s(corner: Leg) -> float:
    return corner.start_s + float(corner.plan.law.time_of(0.5))


def driven(result: RunResult, begin: float, end: float) -> float:
    """Millimetres of the tool centre point between two times."""
    points = np.array([tool_at(result, float(t)) for t in np.linspace(begin, end, 801)])
    return float(np.linalg.norm(np.diff(points, axis=0), axis=1).sum())


def place(result: RunResult, name: str = "$OUT[1]") -> np.ndarray:
    """The tool, from where the first of the moves begins, when the output is switched on."""
    return tool_at(result, time_of(result, name)) - np.array([550.0, 0.0, 400.0])


# ---- KRL: switching actions (EP 8.1, 8.2)

DO = "DO $OUT[1]=TRUE\n"
EXACT = "LIN_REL {Y 100}\n"
CORNERED = "LIN_REL {Y 100} C_DIS\nLIN_REL {Z 100}\n"


@pytest.mark.parametrize(
    ("when", "y"),
    [
        ("DISTANCE=0 DELAY=0", 0.0),  # the start point (table 17)
        ("DISTANCE=1 DELAY=0", 100.0),  # the end point (table 17)
        ("PATH=-20 DELAY=0", 80.0),  # mm from the end point, negative before it (table 18)
        ("PATH=-250 DELAY=0", 0.0),  # shifted back as far as the start point (8.2)
        ("PATH=40 DELAY=0", 100.0),  # shifted on as far as the next exact positioning point (8.2)
        ("DISTANCE=0 DELAY=-300", 0.0),  # only in so far as it still remains in the block (figure 45)
        ("DISTANCE=1 DELAY=300", 100.0),
        ("DISTANCE=1 DELAY=-60000", 0.0),
        ("PATH=-10 DELAY=60000", 100.0),  # at most to the next exact positioning point (8.2)
    ],
)
def test_krl_places_between_exact_points(when: str, y: float) -> None:
    result = run_krl(f"TRIGGER WHEN {when} {DO}{EXACT}")
    assert place(result) == pytest.approx([0.0, y, 0.0], abs=NEAR)


def test_krl_delays_are_milliseconds_of_the_move() -> None:
    """EP 8.1, the example: 20 ms after the start, 25 ms before the end."""
    body = f"TRIGGER WHEN DISTANCE=0 DELAY=20 {DO}TRIGGER WHEN DISTANCE=1 DELAY=-25 DO $OUT[2]=TRUE\n{EXACT}"
    result = run_krl(body)
    move = moves(result)[2]
    assert time_of(result, "$OUT[1]") == pytest.approx(move.legs[0].start_s + 0.02, abs=1e-6)
    assert time_of(result, "$OUT[2]") == pytest.approx(move.t - 0.025, abs=1e-6)


def test_krl_distance_1_is_the_middle_of_the_corner_and_distance_0_the_end_of_the_one_before() -> None:
    """EP 8.1, table 17 and figures 46 to 48."""
    body = (
        f"TRIGGER WHEN DISTANCE=1 DELAY=0 {DO}LIN_REL {{Y 100}} C_DIS\n"
        "TRIGGER WHEN DISTANCE=0 DELAY=0 DO $OUT[2]=TRUE\nLIN_REL {Z 100}\n"
    )
    result = run_krl(body)
    (corner,) = corners(result)
    assert time_of(result, "$OUT[1]") == pytest.approx(middle_s(corner), abs=1e-4)
    assert place(result, "$OUT[2]") == pytest.approx([0.0, 100.0, 30.0], abs=NEAR)


@pytest.mark.parametrize(("delay", "at"), [(-60000, "begin"), (60000, "end")])
def test_krl_delays_at_an_approximated_end_stay_in_the_corner(delay: int, at: str) -> None:
    """EP 8.1, figure 46: DISTANCE=1 may be shifted from 1a to 1b."""
    result = run_krl(f"TRIGGER WHEN DISTANCE=1 DELAY={delay} {DO}{CORNERED}")
    (corner,) = corners(result)
    expected = corner.start_s if at == "begin" else corner.start_s + corner.duration_s
    assert time_of(result, "$OUT[1]") == pytest.approx(expected, abs=1e-4)


@pytest.mark.parametrize("path", [-60, -10, 15, 60])
def test_krl_path_counts_along_the_path_from_the_place_nearest_to_an_approximated_point(path: int) -> None:
    """EP 8.2, table 18 and figure 49: also beyond the point, up to the next exact one."""
    result = run_krl(f"TRIGGER WHEN PATH={path} DELAY=0 {DO}{CORNERED}")
    (corner,) = corners(result)
    switched, middle = time_of(result, "$OUT[1]"), middle_s(corner)
    assert (switched > middle) == (path > 0)
    assert driven(result, min(switched, middle), max(switched, middle)) == pytest.approx(abs(path), abs=NEAR)


def test_krl_path_goes_on_through_further_approximated_points() -> None:
    """EP 8.2: past all subsequent approximate positioning points, as far as the next exact positioning point."""
    chain = "LIN_REL {Y 100} C_DIS\nLIN_REL {Z 100} C_DIS\nLIN_REL {Y 100}\n"
    for path in (150, 100_000):
        result = run_krl(f"TRIGGER WHEN PATH={path} DELAY=0 {DO}{chain}LIN_REL {{Z 50}}\n")
        first, _ = corners(result)
        if path == 150:
            assert driven(result, middle_s(first), time_of(result, "$OUT[1]")) == pytest.approx(150.0, abs=NEAR)
        else:
            assert place(result) == pytest.approx([0.0, 200.0, 100.0], abs=NEAR)


def test_krl_path_reaches_back_into_the_corner_at_the_start() -> None:
    """EP 8.2, approximation not possible: a path of 100 mm; PATH=-120 is 20 mm before the point nearest to the corner,
    PATH=-70 is 30 mm behind it; after an exact point the first happens at once and the second 30 mm from it."""
    events = f"TRIGGER WHEN PATH=-120 DELAY=0 {DO}TRIGGER WHEN PATH=-70 DELAY=0 DO $OUT[2]=TRUE\n"
    free = run_krl("LIN_REL {Y 100} C_DIS\nLIN_REL {Z 100}\n")
    (corner,) = corners(free)
    behind = driven(free, middle_s(corner), free.time_s)  # what the middle of the corner leaves of 100 mm
    result = run_krl(f"LIN_REL {{Y 100}} C_DIS\n{events}LIN_REL {{Z {200.0 - behind}}}\n")
    (corner,) = corners(result)
    early, late = time_of(result, "$OUT[1]"), time_of(result, "$OUT[2]")
    assert driven(result, early, middle_s(corner)) == pytest.approx(20.0, abs=NEAR)
    assert driven(result, middle_s(corner), late) == pytest.approx(30.0, abs=NEAR)
    exact = run_krl(f"LIN_REL {{Y 100}}\n{events}LIN_REL {{Z 100}}\n")
    assert place(exact) == pytest.approx([0.0, 100.0, 0.0], abs=NEAR)
    assert place(exact, "$OUT[2]") == pytest.approx([0.0, 100.0, 30.0], abs=NEAR)


def test_krl_path_is_refused_for_a_joint_motion() -> None:
    """EP 8.2: refused by the interpreter when the motion is executed."""
    body = "TRIGGER WHEN PATH=-20 DELAY=0 DO $OUT[1]=TRUE\nPTP_REL {A1 10}\n"
    result = krl(INIT + body, robot=KUKA)
    assert result.status == "fault" and result.fault is not None
    assert result.fault.origin.text.strip() == "PTP_REL {A1 10}"


def test_krl_what_is_left_of_a_path_happens_where_it_turns_into_a_joint_motion() -> None:
    """EP 8.2, PTP-CP approximate positioning: triggered at the start point of the approximate positioning range."""
    result = run_krl(f"TRIGGER WHEN PATH=-5 DELAY=0 {DO}LIN_REL {{Y 100}} C_DIS\nPTP_REL {{A1 -30}}\n")
    (corner,) = corners(result)
    assert time_of(result, "$OUT[1]") == pytest.approx(corner.start_s, abs=1e-4)


def test_krl_a_path_met_from_a_joint_motion_has_its_actions_behind_the_corner() -> None:
    """EP 8.2, PTP-CP approximate positioning: at the earliest at the end of the approximate positioning range."""
    body = f"PTP_REL {{A1 -20}} C_PTP C_DIS\nTRIGGER WHEN PATH=-500 DELAY=0 {DO}LIN_REL {{Z 100}}\n"
    result = run_krl(body)
    (corner,) = corners(result)
    assert time_of(result, "$OUT[1]") == pytest.approx(corner.start_s + corner.duration_s, abs=1e-4)


# ---- KRL: advance run (EP 3.4, table 6; 5.3, 5.4)

STOPPING = [
    "WAIT SEC 0",
    "WAIT FOR TRUE",
    "PULSE($OUT[7],TRUE,0.5)",
    "$OUT[8]=TRUE",
    "IF $IN[3] THEN\nENDIF",
    "POSA=$POS_ACT",
    "AXA=$AXIS_ACT",
    "$ANOUT[1]=0.5",
    "RA=$ANIN[1]",
]
PASSING = ["I=1", "$FLAG[2]=TRUE", "$OUT_C[8]=TRUE", "CONTINUE\n$OUT[8]=TRUE", "RA=3.5", "$TIMER[3]=0", ";comment"]


@pytest.mark.parametrize("statement", [*STOPPING, *PASSING])
def test_krl_what_stops_the_advance_run_prevents_the_corner(statement: str) -> None:
    """EP 3.4, table 6; EP 3.5: after an approximation instruction it makes approximate positioning impossible."""
    data = "DECL POS POSA\nDECL AXIS AXA\nREAL RA\nINT I\n"
    result = krl(INIT + f"LIN_REL {{Y 100}} C_DIS\n{statement}\nLIN_REL {{Z 100}}", data, robot=KUKA)
    assert result.status == "finished", result.fault
    assert bool(corners(result)) == (statement in PASSING)


def test_krl_continue_is_for_the_next_line_only() -> None:
    """EP 3.4: limited to the next program line, even if this line is empty."""
    for gap, passes in (("", True), ("\n", False), ("I=1\n", False), (";why\n", True)):
        body = f"LIN_REL {{Y 100}} C_DIS\nCONTINUE\n{gap}$OUT[8]=TRUE\nLIN_REL {{Z 100}}"
        result = krl(INIT + body, "INT I", robot=KUKA)
        assert bool(corners(result)) == passes, gap


def test_krl_out_c_switches_in_the_middle_of_the_corner_and_else_at_the_point() -> None:
    """EP 5.3: at the centre of the approximate positioning range, like TRIGGER WHEN DISTANCE=1; exact: at the point."""
    blended = run_krl("LIN_REL {Y 100} C_DIS\n$OUT_C[1]=TRUE\nLIN_REL {Z 100}\n")
    (corner,) = corners(blended)
    assert time_of(blended, "$OUT[1]") == pytest.approx(middle_s(corner), abs=1e-4)
    exact = run_krl("LIN_REL {Y 100}\n$OUT_C[1]=TRUE\nLIN_REL {Z 100}\n")
    assert place(exact) == pytest.approx([0.0, 100.0, 0.0], abs=NEAR)


def test_krl_a_pulse_comes_after_the_motion_or_on_the_path() -> None:
    """EP 5.4: PULSE stops the advance run; in a TRIGGER statement it runs beside the motion."""
    behind = run_krl("LIN_REL {Y 100} C_DIS\nPULSE($OUT[1],TRUE,0.7)\nLIN_REL {Z 100}\n")
    assert place(behind) == pytest.approx([0.0, 100.0, 0.0], abs=NEAR)
    on_path = run_krl("TRIGGER WHEN DISTANCE=0 DELAY=50 DO PULSE($OUT[1],TRUE,0.7)\nLIN_REL {Y 100}\nWAIT SEC 2\n")
    begin = moves(on_path)[2].legs[0].start_s
    assert [(round(t - begin, 6), value) for t, _, value in on_path.outputs] == [(0.05, True), (0.75, False)]


@pytest.mark.parametrize(("seconds", "lasts"), [(0.7, 0.7), (0.24, 0.2), (0.26, 0.3), (0.1, 0.1)])
def test_krl_a_pulse_lasts_tenths_of_a_second(seconds: float, lasts: float) -> None:
    """EP 5.4: the increment is 0.1 s; the controller rounds to the nearest tenth."""
    result = krl(f"PULSE($OUT[1],TRUE,{seconds})\nWAIT SEC 2")
    assert [(round(t, 6), value) for t, _, value in result.outputs] == [(0.0, True), (lasts, False)]


# ---- KRL: interrupts (EP 7)


def hit(routine: str, at: float, search: str = "LIN_REL {Y 200}\nWAIT SEC 0\n") -> RunResult:
    body = "INTERRUPT DECL 10 WHEN $IN[1] DO HIT( )\nINTERRUPT ON 10\nSEARCH( )\nINTERRUPT OFF 10\n"
    return run_krl(
        body,
        f"DEF SEARCH( )\n{search}$OUT[4]=TRUE\nEND\nDEF HIT( )\n{routine}\nEND",
        f"[[input]]\ntime={at}\nsignal='$IN[1]'\nvalue=true\n",
    )


def test_krl_an_interrupt_runs_beside_the_motion_and_brake_waits_for_standstill() -> None:
    """EP 7.3: the interrupt program only continues once the robot has come to a standstill; the motion is resumed."""
    begin = moves(run_krl("LIN_REL {Y 200}\n"))[2].legs[0].start_s
    beside = hit("$OUT[1]=TRUE\nWAIT SEC 0.1\n$OUT[2]=TRUE", begin + 0.5)
    assert time_of(beside, "$OUT[1]") == pytest.approx(begin + 0.5)
    assert place(beside, "$OUT[2]")[1] > place(beside)[1] + 15.0  # 0.1 s at 200 mm/s
    braked = hit("BRAKE\n$OUT[1]=TRUE\nWAIT SEC 1\n$OUT[2]=TRUE", begin + 0.5)
    assert time_of(braked, "$OUT[1]") > begin + 0.5 + 0.05
    assert place(braked, "$OUT[2]") == pytest.approx(place(braked), abs=1e-6)
    assert place(braked, "$OUT[4]") == pytest.approx([0.0, 200.0, 0.0], abs=NEAR)


def test_krl_pos_int_is_where_the_interrupt_came_and_pos_act_where_the_robot_stands() -> None:
    """EP 7, table 16."""
    begin = moves(run_krl("LIN_REL {Y 200}\n"))[2].legs[0].start_s
    result = hit(
        'DECL POS P_INT,P_RET\nBRAKE\nP_INT=$POS_INT\nP_RET=$POS_ACT\nMsgNotify("%1 %2","",P_INT.Y,P_RET.Y)',
        begin + 0.5,
    )
    came, left = (float(word) for word in result.messages[0].split())
    assert came == pytest.approx(tool_at(result, begin + 0.5)[1], abs=0.01)
    assert left > came + 1.0


def test_krl_resume_cancels_the_search_and_the_routine() -> None:
    """EP 7.4: all running interrupt programs and subprograms up to the level of the declaration are cancelled."""
    begin = moves(run_krl("LIN_REL {Y 200}\n"))[2].legs[0].start_s
    result = hit("BRAKE\nRESUME", begin + 0.5)
    assert "$OUT[4]" not in {name for _, name, _ in result.outputs}
    assert 50.0 < moves(result)[-1].data["xyz_mm"][1] < 150.0


# ---- RAPID: logic behind moves (RO 3.1 to 3.3)

DATA = """
PERS tooldata tPen:=[TRUE,[[0,0,100],[1,0,0,0]],[0.5,[0,0,50],[1,0,0,0],0,0,0]];
CONST robtarget p0:=[[350,0,300],[0,0,1,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
VAR robtarget found;
VAR triggdata gun;
"""
TO_P0 = "ConfJ\\Off; ConfL\\Off;\nMoveJ p0,v500,fine,tPen;\n"
Y100 = "Offs(p0,0,100,0)"
Z100 = "Offs(p0,0,100,100)"


def run_rapid(body: str, cell: str | None = None) -> RunResult:
    result = rapid(TO_P0 + body, DATA, robot=ABB, cell=cell)
    assert result.status == "finished", result.fault
    return result


def spot(result: RunResult, name: str = "do1") -> np.ndarray:
    return tool_at(result, time_of(result, name)) - np.array([350.0, 0.0, 300.0])


def test_rapid_logic_behind_a_stop_point_waits_for_standstill() -> None:
    """RO 3.1, figure 26."""
    result = run_rapid(f"MoveL {Y100},v100,fine,tPen;\nSetDO do1,1;\nMoveL {Z100},v100,fine,tPen;")
    assert spot(result) == pytest.approx([0.0, 100.0, 0.0], abs=NEAR)


@pytest.mark.parametrize(("zone", "largest"), [("z1", 1.0), ("z10", 15.0), ("z20", 30.0), ("z30", 45.0)])
def test_rapid_logic_behind_a_fly_by_point_runs_a_tenth_of_a_second_before_the_largest_zone(
    zone: str, largest: float
) -> None:
    """RO 3.2, figures 27 and 28: DT before the largest zone (position, orientation, external axes) is the planning of
    approx. 0.1 s and the servo's lag, which is 0 here; 100 mm/s: 10 mm."""
    result = run_rapid(f"MoveL {Y100},v100,{zone},tPen;\nSetDO do1,1;\nMoveL {Z100},v100,fine,tPen;")
    assert spot(result) == pytest.approx([0.0, 100.0 - largest - 10.0, 0.0], abs=0.5)


def test_rapid_conc_runs_the_logic_with_the_movement() -> None:
    """RO 3.3, figure 29."""
    result = run_rapid(f"MoveL \\Conc,{Y100},v100,fine,tPen;\nSetDO do1,1;\nMoveL {Z100},v100,fine,tPen;")
    assert spot(result) == pytest.approx([0.0, 0.0, 0.0], abs=NEAR)


def test_rapid_waittime_inpos_waits_for_standstill_first() -> None:
    """RG WaitTime: the robot must have come to a standstill before the waiting time starts to be counted."""
    result = run_rapid(f"MoveL {Y100},v100,z10,tPen;\nWaitTime \\InPos,0.5;\nSetDO do1,1;")
    assert time_of(result, "do1") == pytest.approx(moves(result)[1].t + 0.5, abs=1e-6)


# ---- RAPID: position events (RG TriggIO, TriggEquip, TriggL, MoveLDO)


@pytest.mark.parametrize(
    ("event", "y"),
    [
        ("TriggIO gun,10\\DOp:=do1,1;", 90.0),  # 10 mm before the end point
        ("TriggIO gun,1\\Start\\DOp:=do1,1;", 1.0),  # 1 mm after the start point
        ("TriggIO gun,0\\DOp:=do1,1;", 100.0),
        ("TriggIO gun,150\\DOp:=do1,1;", 0.0),  # not within the length: when the start point is passed
        ("TriggIO gun,150\\Start\\DOp:=do1,1;", 100.0),  # or the end point
        ("TriggEquip gun,50,0.1\\DOp:=do1,1;", 40.0),  # 0.1 s of 100 mm/s before 50 mm before the end
        ("TriggEquip gun,50,-0.1\\DOp:=do1,1;", 60.0),  # negative: after that
        ("TriggIO gun,50\\DOp:=do1,1\\DODelay:=0.2;", 70.0),  # 0.2 s after the place is reached
    ],
)
def test_rapid_events_at_a_distance(event: str, y: float) -> None:
    result = run_rapid(f"{event}\nTriggL {Y100},v100,gun,fine,tPen;\nWaitTime 1;")
    assert spot(result) == pytest.approx([0.0, y, 0.0], abs=NEAR)


def test_rapid_an_event_at_a_time_before_a_stop_point() -> None:
    """RG TriggIO, limitations: at most the braking time; a longer one comes when braking is started."""
    near = run_rapid(f"TriggIO gun,0.01\\Time\\DOp:=do1,1;\nTriggL {Y100},v100,gun,fine,tPen;")
    assert time_of(near, "do1") == pytest.approx(moves(near)[1].t - 0.01, abs=1e-6)
    far = run_rapid(f"TriggIO gun,0.5\\Time\\DOp:=do1,1;\nTriggL {Y100},v100,gun,fine,tPen;")
    end, switched = moves(far)[1].t, time_of(far, "do1")
    assert switched > end - 0.5 + 0.01
    around = [driven(far, t, t + 0.004) / 0.004 for t in (switched - 0.02, switched, end - 0.02)]
    assert around[0] == pytest.approx(100.0, rel=0.01) and around[1] == pytest.approx(100.0, rel=0.03)
    assert around[2] < 95.0


@pytest.mark.parametrize(
    "text",
    [
        f"MoveLDO {Y100},v100,z20,tPen,do1,1;\nMoveL {Z100},v100,fine,tPen;",  # RG MoveLDO, figure 6
        f"TriggIO gun,0\\DOp:=do1,1;\nTriggL {Y100},v100,gun,z20,tPen;\nMoveL {Z100},v100,fine,tPen;",  # figure 30
        f"TriggIO gun,0\\Start\\DOp:=do1,1;\nMoveL {Y100},v100,z20,tPen;\nTriggL {Z100},v100,gun,fine,tPen;",  # TriggL
    ],
    ids=["MoveLDO", "distance 0", "distance 0 from the start"],
)
def test_rapid_a_fly_by_point_is_passed_in_the_middle_of_its_corner(text: str) -> None:
    result = run_rapid(text)
    (corner,) = corners(result)
    assert time_of(result, "do1") == pytest.approx(middle_s(corner), abs=1e-4)


def test_rapid_a_pulse_lasts_two_tenths_and_the_program_goes_on_at_once() -> None:
    """RG PulseDO: 0.2 s without \\PLength; the next instruction is executed directly after the pulse starts."""
    result = rapid("PulseDO do1;\nSetDO do2,1;\nPulseDO\\PLength:=1.0004,do3;\nWaitTime 2;")
    seen = [(round(t, 6), name, value) for t, name, value in result.outputs]
    assert seen == [
        (0.0, "do1", True),
        (0.0, "do2", True),
        (0.0, "do3", True),
        (0.2, "do1", False),
        (1.0, "do3", False),
    ]


# ---- RAPID: searches and stops (RG SearchL, StopMove)


def test_rapid_a_search_takes_the_place_at_the_edge_and_stops_a_little_behind() -> None:
    """RG SearchL: the position when the signal changes; the robot moves a small distance on and not back."""
    began = moves(run_rapid(f"MoveL {Y100},v50,fine,tPen;"))[0].t
    cell = f"[[input]]\ntime={began + 1.0}\nsignal='di1'\nvalue=true\n"
    for switch in ("\\Stop", "\\PStop"):
        text = f"SearchL{switch},di1,found,{Y100},v50,tPen;\nTPWrite NumToStr(found.trans.y,3);"
        result = run_rapid(text, cell)
        edge = tool_at(result, began + 1.0)[1]
        assert float(result.messages[0]) == pytest.approx(edge, abs=0.002)
        assert edge < moves(result)[-1].data["xyz_mm"][1] < edge + 16.0
    flying = run_rapid(f"SearchL di1,found,{Y100},v50,tPen;\nTPWrite NumToStr(found.trans.y,3);", cell)
    assert moves(flying)[-1].data["xyz_mm"][1] == pytest.approx(100.0, abs=0.01)


def test_rapid_a_search_behind_a_fly_by_point_starts_on_the_real_path() -> None:
    """RG SearchL, limitations: the search starts at a point along the real robot path, not at the programmed one."""
    text = f"MoveL {Y100},v100,z20,tPen;\nSearchL\\Stop,di1,found,{Z100},v100,tPen;\nTPWrite NumToStr(found.trans.y,3);"
    free = rapid(TO_P0 + f"MoveL {Y100},v100,z20,tPen;\nMoveL {Z100},v100,fine,tPen;", DATA, robot=ABB)
    (corner,) = corners(free)
    edge = middle_s(corner) + 0.25 * corner.duration_s
    result = run_rapid(text, f"[[input]]\ntime={edge}\nsignal='di1'\nvalue=true\n")
    found, there = float(result.messages[0]), tool_at(result, edge)
    assert found == pytest.approx(there[1], abs=0.002) and found < 100.0 - 1e-3
    assert there[2] > 300.5


def test_rapid_stopmove_and_startmove() -> None:
    """RG StopMove: the movement stops temporarily and goes on with StartMove; the end is reached as without it."""
    body = "CONNECT i WITH hit;\nISignalDI\\Single,di1,1,i;\n" + TO_P0 + f"MoveL {Y100},v100,fine,tPen;\nSetDO do2,1;"
    trap = "TRAP hit StopMove; SetDO do1,1; WaitTime 2; StartMove; ENDTRAP"
    began = moves(run_rapid(""))[0].t
    cell = f"[[input]]\ntime={began + 0.5}\nsignal='di1'\nvalue=true\n"
    result = rapid(body, DATA + "VAR intnum i;", trap, robot=ABB, cell=cell)
    assert result.status == "finished", result.fault
    assert 30.0 < spot(result)[1] < 60.0
    assert tool_at(result, time_of(result, "do1") + 1.9) == pytest.approx(tool_at(result, time_of(result, "do1")))
    assert spot(result, "do2") == pytest.approx([0.0, 100.0, 0.0], abs=NEAR)


def test_krl_advance_is_five_at_most() -> None:
    """EP 3.4: a maximum of 5 advance run steps is possible."""
    steps = "\n".join("LIN_REL {Y 10}" for _ in range(8))
    declared = "INTERRUPT DECL 10 WHEN $FLAG[1] DO HIT( )\nINTERRUPT ON 10\n"
    passed = {}
    for advance in (5, 9):
        body = f"$ADVANCE={advance}\nWAIT SEC 0\n{declared}{steps}\n$FLAG[1]=TRUE\nWAIT SEC 0\n"
        result = run_krl(body, 'DEF HIT( )\nMsgNotify("here")\nEND')
        when = next(event.t for event in result.trace if event.kind == "message")
        passed[advance] = sum(event.t <= when + 1e-9 for event in moves(result)[2:])
    assert passed == {5: 2, 9: 2}  # the third is driven, five are ahead of it

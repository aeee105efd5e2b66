"""Motion: program pointer ahead of the robot, triggers, stops, searches, faults, and poses in their frames."""

from typing import Any

import pytest
from helpers import ABB, KUKA, krl, on, rapid, run

from rpl.runtime.trace import Event, RunResult

INIT = "BAS(#INITMOV,0)\n$TOOL=$NULLFRAME\n$BASE=$NULLFRAME\n$APO.CDIS=30\n$VEL.CP=0.5\n"
START = "PTP {A1 0,A2 -90,A3 90,A4 0,A5 45,A6 0}\n"
P1 = "LIN {X 550,Y 0,Z 400,A 0,B 135,C 0}"


def moves(result: RunResult) -> list[Event]:
    return [event for event in result.trace if event.kind == "move"]


def time_of(result: RunResult, name: str) -> float:
    return next(t for t, signal, value in result.outputs if signal == name and value)


def ends(result: RunResult) -> list[float]:
    return [event.t for event in moves(result)]


def test_an_output_in_krl_waits_for_the_robot_and_continue_does_not() -> None:
    stopped, ahead = (
        krl(INIT + START + P1 + f"\n{word}$OUT[1]=TRUE\nLIN_REL {{X 50}}", robot=KUKA) for word in ("", "CONTINUE\n")
    )
    assert time_of(stopped, "$OUT[1]") == pytest.approx(ends(stopped)[1])
    assert time_of(ahead, "$OUT[1]") == 0.0 or time_of(ahead, "$OUT[1]") < ends(ahead)[0] + 1e-9
    assert stopped.joints == pytest.approx(ahead.joints)


def test_a_corner_is_cut_and_the_end_is_reached() -> None:
    exact, cut = (
        krl(INIT + START + P1 + f"\nLIN_REL {{Y 100}} {word}\nLIN_REL {{Z 100}}", robot=KUKA) for word in ("", "C_DIS")
    )
    assert cut.time_s < exact.time_s
    assert cut.joints == pytest.approx(exact.joints, abs=1e-6)
    assert [event.stops for event in moves(cut)] == [True, True, False, True]
    assert [event.stops for event in moves(exact)] == [True] * 4


def test_a_joint_blend_into_a_path_move_is_measured_by_the_path_distance() -> None:
    # EP: between PTP and LIN the second measure counts, C_DIS when none is said.
    result = krl(INIT + START + P1 + "\nPTP_REL {A1 20} C_PTP\nLIN_REL {Z 100}", robot=KUKA)
    corner = next(leg for leg in moves(result)[2].legs if leg.plan.kind == "corner")
    turn = moves(result)[2].legs[0].plan
    assert turn.end_pose[2, 3] == pytest.approx(400.0)
    assert corner.plan.end_pose[2, 3] == pytest.approx(430.0, abs=0.01)  # $APO.CDIS=30


def test_an_advance_stop_between_two_moves_prevents_the_corner() -> None:
    result = krl(INIT + START + P1 + "\nLIN_REL {Y 100} C_DIS\n$OUT[1]=TRUE\nLIN_REL {Z 100}", robot=KUKA)
    assert all(event.stops for event in moves(result))


def test_the_pointer_is_as_far_ahead_as_advance_says() -> None:
    # $FLAG does not stop the advance run; an interrupt on it tells when the program pointer was there.
    steps = "\n".join(f"LIN_REL {{Y 20}}\n$FLAG[{n}]=TRUE" for n in range(1, 6))
    declared = "".join(f"INTERRUPT DECL {n} WHEN $FLAG[{n}] DO HIT({n})\nINTERRUPT ON {n}\n" for n in range(1, 6))
    more = 'DEF HIT(K:IN)\nINT K\nMsgNotify("%1","",K)\nEND'
    seen = {}
    for advance in (0, 1, 3):
        body = INIT + START + f"$ADVANCE={advance}\n" + P1 + "\nWAIT SEC 0\n" + declared + steps + "\nWAIT SEC 0"
        result = krl(body, more=more, robot=KUKA)
        assert result.messages == ("1", "2", "3", "4", "5"), result.fault
        arrivals = ends(result)[2:]
        said = [event.t for event in result.trace if event.kind == "message"]
        seen[advance] = [sum(arrival <= t + 1e-9 for arrival in arrivals) for t in said]
    assert seen[0] == [1, 2, 3, 4, 5]  # moves finished when the pointer passed behind move 1, 2, ...
    assert seen[1] == [0, 0, 1, 2, 3]
    assert seen[3] == [0, 0, 0, 0, 1]


@pytest.mark.parametrize(
    ("trigger", "where"),
    [
        ("TRIGGER WHEN DISTANCE=0 DELAY=0 DO $OUT[1]=TRUE", 0.0),
        ("TRIGGER WHEN DISTANCE=1 DELAY=0 DO $OUT[1]=TRUE", 100.0),
        ("TRIGGER WHEN PATH=-40 DELAY=0 DO $OUT[1]=TRUE", 60.0),
        ("TRIGGER WHEN PATH=30 ONSTART DELAY=0 DO $OUT[1]=TRUE", 30.0),
    ],
)
def test_krl_triggers_fire_at_their_place(trigger: str, where: float) -> None:
    result = krl(INIT + START + P1 + f"\n{trigger}\nLIN_REL {{Y 100}}", robot=KUKA)
    move = moves(result)[2]
    leg = move.legs[0]
    driven = time_of(result, "$OUT[1]") - leg.start_s
    assert 100.0 * float(leg.plan.law.at(driven)) == pytest.approx(where, abs=0.01)


def test_a_trigger_with_a_delay_and_one_that_calls() -> None:
    body = INIT + START + P1 + "\nTRIGGER WHEN DISTANCE=1 DELAY=-200 DO $OUT[1]=TRUE\n"
    result = krl(body + "TRIGGER WHEN DISTANCE=0 DELAY=0 DO HIT(5) PRIO=-1\nLIN_REL {Y 100}\nWAIT SEC 1",
                 more='DEF HIT(K:IN)\nINT K\nMsgNotify("%1","",K)\nEND', robot=KUKA)  # fmt: skip
    assert time_of(result, "$OUT[1]") == pytest.approx(ends(result)[2] - 0.2)
    assert result.messages == ("5",)


def test_a_move_that_stands_braked_when_the_run_ends_is_shown() -> None:
    """Both ends show how far the robot came: the brake that nothing releases, and the move that was cut off."""
    body = (
        "$BASE=$NULLFRAME\n$TOOL=$NULLFRAME\n$VEL.CP=0.1\nPTP {A1 0,A2 -90,A3 90,A4 0,A5 90,A6 0}\n"
        "GLOBAL INTERRUPT DECL 3 WHEN $IN[1] DO HIT( )\nINTERRUPT ON 3\nLIN_REL {Y 200}\n$OUT[1]=TRUE"
    )
    handler = "GLOBAL DEF HIT( )\nBRAKE\nWAIT FOR $IN[2]\nEND"
    result = krl(body, more=handler, robot=KUKA, cell='[[input]]\ntime = 2.5\nsignal = "$IN[1]"\nvalue = true\n')
    assert result.status == "deadlock"
    last = moves(result)[-1]
    assert last.data["interrupted"] and 0.0 < last.data["xyz_mm"][1] < 200.0


def test_brake_and_resume_leave_the_interrupted_routine() -> None:
    body = (
        INIT + START + "INTERRUPT DECL 10 WHEN $IN[1] DO HIT( )\nINTERRUPT ON 10\nSEARCH( )\nINTERRUPT OFF 10\n"
        '$OUT[2]=TRUE\nMsgNotify("back")'
    )
    more = "DEF SEARCH( )\n" + P1 + "\nLIN_REL {Y 200}\nWAIT SEC 0\n$OUT[1]=TRUE\nEND\nDEF HIT( )\nBRAKE\nRESUME\nEND"
    cell = "[[input]]\ntime=2.2\nsignal='$IN[1]'\nvalue=true\n"
    result = krl(body, more=more, robot=KUKA, cell=cell)
    assert result.status == "finished", result.fault
    assert on(result) == {"$OUT[2]": True} and result.messages == ("back",)
    last = moves(result)[-1]
    assert last.data["interrupted"] and 0.0 < last.data["xyz_mm"][1] < 200.0
    untouched = krl(body, more=more, robot=KUKA)
    assert on(untouched) == {"$OUT[1]": True, "$OUT[2]": True}


def test_a_braked_motion_goes_on_after_an_interrupt_without_resume() -> None:
    body = (
        INIT
        + START
        + "INTERRUPT DECL 10 WHEN $IN[1] DO HIT( )\nINTERRUPT ON 10\n"
        + P1
        + "\nLIN_REL {Y 200}\nWAIT SEC 0"
    )
    more = "DEF HIT( )\nBRAKE\nWAIT SEC 2\nEND"
    cell = "[[input]]\ntime=2.2\nsignal='$IN[1]'\nvalue=true\n"
    braked, free = krl(body, more=more, robot=KUKA, cell=cell), krl(body, robot=KUKA, more=more)
    assert braked.status == "finished", braked.fault
    assert braked.joints == pytest.approx(free.joints, abs=1e-6)
    assert braked.time_s > free.time_s + 1.9


@pytest.mark.parametrize(
    ("body", "code"),
    [
        ("PTP {X 5000,Y 0,Z 400,A 0,B 90,C 0,S 2,T 2}", "configuration"),
        ("LIN {X 2000,Y 0,Z 400,A 0,B 135,C 0}", "unreachable"),
        ("PTP {A1 400}", "joint-limit"),
    ],
)
def test_what_the_controller_refuses_is_a_fault_with_its_line(body: str, code: str) -> None:
    result = krl(INIT + START + P1 + "\n" + body + "\n$OUT[1]=TRUE", robot=KUKA)
    assert result.status == "fault" and result.fault is not None
    assert result.fault.code in (code, "unreachable") and result.fault.origin.text.strip() == body
    assert result.outputs == () and result.time_s == pytest.approx(ends(result)[1])  # what came before was driven


# ---- RAPID

DATA = """
PERS tooldata tPen:=[TRUE,[[0,0,100],[1,0,0,0]],[0.5,[0,0,50],[1,0,0,0],0,0,0]];
CONST jointtarget jStart:=[[0,0,0,0,30,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
CONST robtarget p0:=[[350,0,300],[0,0,1,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
VAR robtarget found;
VAR triggdata gun;
VAR num n:=0;
"""
TO_P0 = "ConfJ\\Off; ConfL\\Off;\nMoveAbsJ jStart,v1000,fine,tPen;\nMoveJ p0,v500,fine,tPen;\n"


def test_after_a_stop_point_the_program_goes_on_when_the_robot_stands() -> None:
    result = rapid(TO_P0 + "MoveL Offs(p0,0,100,0),v100,fine,tPen;\nSetDO do1,1;", DATA, robot=ABB)
    assert time_of(result, "do1") == pytest.approx(ends(result)[2])


def test_after_a_fly_by_point_the_program_goes_on_before_the_corner() -> None:
    text = TO_P0 + "MoveL Offs(p0,0,100,0),v100,z20,tPen;\nSetDO do1,1;\nMoveL Offs(p0,50,100,0),v100,fine,tPen;"
    result = rapid(text, DATA, robot=ABB)
    first = moves(result)[2]
    corner = next(leg for leg in first.legs if leg.plan.kind == "corner")
    # z20 has an orientation zone of 30 mm, which is the largest one: 10 mm, 0.1 s before the corner path of 20 mm.
    assert time_of(result, "do1") == pytest.approx(corner.start_s - 0.2, abs=0.02)
    assert not first.stops and moves(result)[3].stops


def test_a_fly_by_point_without_a_next_move_becomes_a_stop() -> None:
    text = TO_P0 + "MoveL Offs(p0,0,100,0),v100,z20,tPen;\nWaitTime 3;\nMoveL Offs(p0,50,100,0),v100,fine,tPen;"
    result = rapid(text, DATA, robot=ABB)
    assert all(event.stops for event in moves(result))
    assert moves(result)[2].data["xyz_mm"] == pytest.approx([350, 100, 300], abs=0.01)


def test_an_output_in_the_middle_of_the_corner_and_stored_triggers() -> None:
    text = TO_P0 + "MoveLDO Offs(p0,0,100,0),v100,z20,tPen,do1,1;\nMoveL Offs(p0,50,100,0),v100,fine,tPen;"
    result = rapid(text, DATA, robot=ABB)
    corner = next(leg for leg in moves(result)[2].legs if leg.plan.kind == "corner")
    middle = time_of(result, "do1") - corner.start_s
    assert float(corner.plan.law.at(middle)) == pytest.approx(0.5, abs=1e-6)
    stored = rapid(TO_P0 + "TriggIO gun,30\\DOp:=do1,1;\nTriggL Offs(p0,0,100,0),v100,gun,fine,tPen;", DATA, robot=ABB)
    leg = moves(stored)[2].legs[0]
    assert 100.0 * float(leg.plan.law.at(time_of(stored, "do1") - leg.start_s)) == pytest.approx(70.0, abs=0.01)


SEARCH = TO_P0 + "SearchL\\Stop,di1,found,Offs(p0,0,100,0),v20,tPen;\nTPWrite NumToStr(found.trans.y,0);\nSetDO do1,1;"


def test_a_search_finds_misses_and_is_told_when_the_signal_is_there_already() -> None:
    started = ends(rapid(SEARCH, DATA, robot=ABB))[1]

    def cell(after: float) -> str:
        return f"[[input]]\ntime={started + after}\nsignal='di1'\nvalue=true\n"

    found = rapid(SEARCH, DATA, robot=ABB, cell=cell(2.0))
    assert found.status == "finished" and 35 < float(found.messages[0]) < 41, found.fault
    missed = rapid(SEARCH, DATA, robot=ABB)
    assert missed.fault is not None and "ERR_WHLSEARCH" in missed.fault.message
    early = rapid(SEARCH, DATA, robot=ABB, cell=cell(-0.5))
    assert early.fault is not None and "ERR_SIGSUPSEARCH" in early.fault.message


def test_stop_store_and_start_of_a_path_in_a_trap() -> None:
    data = DATA + "VAR intnum i;"
    body = (
        "CONNECT i WITH hit;\nISignalDI\\Single,di1,1,i;\n"
        + TO_P0
        + "MoveL Offs(p0,0,100,0),v50,fine,tPen;\nSetDO do1,1;"
    )
    trap = (
        "TRAP hit VAR robtarget here; StopMove; StorePath; here:=CRobT(\\Tool:=tPen\\WObj:=wobj0); "
        "MoveL Offs(here,0,0,30),v100,fine,tPen; SetDO do2,1; MoveL here,v100,fine,tPen; RestoPath; StartMove; ENDTRAP"
    )
    free = rapid(body, data, trap, robot=ABB)
    result = rapid(body, data, trap, robot=ABB, cell=f"[[input]]\ntime={ends(free)[1] + 1}\nsignal='di1'\nvalue=true\n")
    assert result.status == "finished", result.fault
    assert [name for _, name, _ in result.outputs] == ["do2", "do1"]
    assert result.joints == pytest.approx(free.joints, abs=1e-5)


def test_a_search_without_success_moves_aside_and_is_done_again() -> None:
    """The manual's handler of a search: the path is stored, the robot moves away, and the search is tried again."""
    data = DATA + "VAR num tries;"
    more = (
        "FUNC num Height() VAR robtarget hit;\nSearchL\\SStop,di1,hit,Offs(p0,0,0,-40),v50,tPen;\nRETURN hit.trans.z;\n"
        "ERROR IF ERRNO=ERR_WHLSEARCH AND tries=0 THEN tries:=1; StorePath; MoveL p0,v50,fine,tPen; RestoPath; "
        "SetDO do2,1; RETRY; ENDIF RETURN 0; ENDFUNC"
    )
    body = TO_P0 + "IF Height()<p0.trans.z-5 SetDO do1,1;\nMoveL p0,v50,fine,tPen;\nSetDO do3,1;"
    cell = "[[reaction]]\nwhen='do2'\nafter=0.4\nsignal='di1'\nvalue=true\n"
    result = rapid(body, data, more, robot=ABB, cell=cell)
    assert result.status == "finished", result.fault
    assert [name for _, name, _ in result.outputs] == ["do2", "do1", "do3"]
    assert result.outputs[2][0] - result.outputs[1][0] > 0.2


def test_a_stationary_tool_moves_the_part() -> None:
    data = DATA + (
        "PERS tooldata tFix:=[FALSE,[[400,100,300],[0,0,1,0]],[0.5,[0,0,50],[1,0,0,0],0,0,0]];\n"
        'PERS wobjdata wPart:=[TRUE,TRUE,"",[[0,0,50],[1,0,0,0]],[[0,0,0],[1,0,0,0]]];\n'
    )
    text = "ConfJ\\Off; ConfL\\Off;\nMoveAbsJ jStart,v1000,fine,tPen;\n" + (
        "MoveJ [[10,20,30],[1,0,0,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]],v200,fine,tFix\\WObj:=wPart;\n"
        "found:=CRobT(\\Tool:=tFix\\WObj:=wPart);\nTPWrite NumToStr(found.trans.x,2)+NumToStr(found.trans.z,2);\n"
        "found:=CRobT(\\Tool:=tool0\\WObj:=wobj0);\nTPWrite NumToStr(found.trans.z,1);"
    )
    result = rapid(text, data, robot=ABB)
    assert result.messages[0] == "10.0030.00", result.fault
    assert result.messages[1] == "380.0"  # the flange looks down: 300 + 30 in the part + 50 to the flange


def test_kinematic_functions_are_inverse_of_each_other() -> None:
    text = TO_P0 + (
        "j:=CalcJointT(p0,tPen);\nk:=CJointT();\nTPWrite ValToStr(Round(j.robax.rax_5)=Round(k.robax.rax_5));\n"
        "found:=CalcRobT(CJointT(),tPen);\nTPWrite NumToStr(found.trans.x,1)+ValToStr(found.robconf.cf1);"
    )
    data = DATA + "VAR jointtarget j;\nVAR jointtarget k;"
    result = rapid(text, data, robot=ABB)
    assert result.messages == ("TRUE", "350.00"), result.fault


def test_without_a_robot_the_logic_runs_and_moves_take_no_time() -> None:
    result = krl(INIT + START + P1 + "\n$OUT[1]=TRUE\nLIN_REL {Y 100}\nWAIT SEC 1")
    assert result.status == "finished" and result.moves == 3 and result.time_s == pytest.approx(1.0)
    shown: list[Any] = [event.data for event in moves(result)]
    assert shown[0]["joints"] == [0, -90, 90, 0, 45, 0] and shown[2]["xyz_mm"] == [550, 100, 400]


def test_events_come_in_the_shape_of_the_design() -> None:
    result = krl(INIT + START + P1 + "\n$OUT[1]=TRUE\nPAUSE( )", more="DEF PAUSE( )\nWAIT SEC 0.5\nEND", robot=KUKA)
    lines = list(result.trace_lines())
    assert all({"t", "task", "kind", "file", "line"} <= line.keys() for line in lines)
    assert [line["kind"] for line in lines] == ["move", "move", "output", "call", "wait", "end"]
    move = lines[1]
    assert {"motion", "joints", "xyz_mm", "quat_wxyz", "duration"} <= move.keys()
    assert move["line"] == 9 and len(move["joints"]) == 6
    document = result.as_json()
    assert set(document) == {"status", "time_s", "moves", "statements", "messages", "outputs", "fault"}


def test_a_background_task_runs_beside_the_motion() -> None:
    from dataclasses import replace

    from helpers import read

    from rpl import ir
    from rpl.simulation import run_program

    program = read(
        "krl", "DEF P0( )\nWAIT FOR $FLAG[1]\n$OUT[1]=TRUE\nEND", "DEF P1( )\nWAIT SEC 2\n$FLAG[1]=TRUE\nEND"
    )
    both = replace(program, tasks=(ir.Task("rob", "p0"), ir.Task("sps", "p1", "background", cyclic=True)))
    result = run_program(both)
    assert result.status == "finished" and result.outputs[0][0] == pytest.approx(2.0)
    assert run("krl", "DEF P0( )\nWAIT FOR $FLAG[1]\nEND").status == "deadlock"


def test_in_rpl_a_move_with_a_blend_lets_the_program_go_on_where_the_corner_begins() -> None:
    text = (
        "MODULE m\nPROCEDURE main()\nMOVE TO {j1: 0, j2: 0, j3: 0, j4: 0, j5: 30, j6: 0}\n"
        "MOVE LINEAR TO {x: 350, y: 0, z: 400, a: 0, b: 150, c: 0} SPEED 200 mm/s\n"
        "MOVE LINEAR TO {x: 350, y: 100, z: 400, a: 0, b: 150, c: 0} SPEED 200 mm/s BLEND 20 mm\n"
        "SET do[1] TO ON\n"
        "MOVE LINEAR TO {x: 350, y: 100, z: 300, a: 0, b: 150, c: 0} SPEED 200 mm/s\n"
        "END PROCEDURE\nEND MODULE\n"
    )
    result = run("rpl", text, robot=ABB)
    assert result.status == "finished", result.fault
    corner = next(leg for leg in moves(result)[2].legs if leg.plan.kind == "corner")
    assert result.outputs[0][0] == pytest.approx(corner.start_s, abs=1e-6)
    speed = [float(leg.plan.law.speed_at(leg.duration_s)) for leg in moves(result)[2].legs]
    assert speed[-2] > 0.0  # it did not stop there


def test_a_corner_whose_computed_size_is_zero_is_a_stop() -> None:
    text = (
        "MODULE m\nVAR size: REAL = 0.0\nPROCEDURE main()\nMOVE TO {j1: 0, j2: 0, j3: 0, j4: 0, j5: 30, j6: 0}\n"
        "MOVE LINEAR TO {x: 350, y: 0, z: 400, a: 0, b: 150, c: 0} SPEED 200 mm/s\n"
        "MOVE LINEAR TO {x: 350, y: 100, z: 400, a: 0, b: 150, c: 0} SPEED 200 mm/s BLEND size mm\n"
        "MOVE LINEAR TO {x: 350, y: 100, z: 300, a: 0, b: 150, c: 0} SPEED 200 mm/s\n"
        "END PROCEDURE\nEND MODULE\n"
    )
    rounded, stopping = run("rpl", text, robot=ABB), run("rpl", text.replace(" BLEND size mm", ""), robot=ABB)
    assert rounded.status == "finished", rounded.fault
    (leg,) = moves(rounded)[2].legs
    assert float(leg.plan.law.speed_at(leg.duration_s)) == pytest.approx(0.0, abs=1e-6)
    assert ends(rounded) == pytest.approx(ends(stopping))

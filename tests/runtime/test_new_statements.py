"""Statements and clauses that only some languages have, run from RPL: tasks, critical sections, settings
for one move, error routines, masks, one-shot interrupts, postures, speed of the leading axis, searches that tell."""

import math

import pytest
from helpers import on, run

from rpl.passes import rigid
from rpl.runtime.faults import ProgramError
from rpl.runtime.functions import geometry

VIPER, COBRA, UR = "adept_viper_s650", "adept_cobra_s600", "ur5e"


def rpl(body: str, more: str = "", data: str = "", robot: str | None = None, cell: str | None = None):
    text = f"MODULE m\n{data}\nPROCEDURE main()\n{body}\nEND PROCEDURE\n{more}\nEND MODULE\n"
    return run("rpl", text, robot, cell, entry="main")


def test_a_routine_becomes_a_task_and_is_waited_for() -> None:
    result = rpl(
        "START TASK feeder(3)\nJOIN TASK feeder\nSET do[1] TO n = 3",
        "PROCEDURE feeder(count: INT)\nWAIT 0.5 s\nn = count\nEND PROCEDURE",
        "VAR n: INT = 0",
    )
    assert on(result) == {"do[1]": True}
    assert result.time_s == pytest.approx(0.5)


def test_a_task_that_was_stopped_does_nothing_more() -> None:
    result = rpl(
        "START TASK blink\nWAIT 0.25 s\nSTOP TASK blink\nWAIT 1 s\nSET do[2] TO n = 3",
        "PROCEDURE blink()\nLOOP\nn = n + 1\nWAIT 0.1 s\nEND LOOP\nEND PROCEDURE",
        "VAR n: INT = 0",
    )
    assert on(result) == {"do[2]": True}


def test_a_paused_task_goes_on_when_it_is_resumed() -> None:
    result = rpl(
        "START TASK late\nPAUSE TASK late\nWAIT 2 s\nSET do[1] TO ON\nRESUME TASK late\nJOIN TASK late",
        "PROCEDURE late()\nWAIT 0.5 s\nSET do[2] TO ON\nEND PROCEDURE",
    )
    assert [name for _, name, _ in result.outputs] == ["do[1]", "do[2]"]


@pytest.mark.parametrize(
    ("body", "at"),
    [
        # a wait for a moment ends when it would have, but what follows comes after the pause
        ("WAIT 0.25 s\nPAUSE TASK late\nWAIT 2 s\nRESUME TASK late\nJOIN TASK late", 2.25),
        ("WAIT 0.25 s\nPAUSE TASK late\nWAIT 0.1 s\nRESUME TASK late\nJOIN TASK late", 0.5),
        ("WAIT 0.25 s\nPAUSE TASK late\nPAUSE TASK late\nWAIT 2 s\nRESUME TASK late\nJOIN TASK late", 2.25),
        ("RESUME TASK late\nJOIN TASK late", 0.5),  # one that is not paused just goes on
        ("WAIT 0.25 s\nPAUSE TASK late\nSTOP TASK late\nRESUME TASK late\nWAIT 2 s", None),
        ("WAIT 0.25 s\nPAUSE TASK late\nWAIT 2 s", None),
        ("JOIN TASK late\nPAUSE TASK late\nRESUME TASK late", 0.5),
    ],
)
def test_when_a_paused_task_goes_on(body: str, at: float | None) -> None:
    late = "PROCEDURE late()\nWAIT 0.5 s\nSET do[2] TO ON\nEND PROCEDURE"
    result = rpl(f"START TASK late\n{body}\nSET do[1] TO ON", late)
    times = {name: t for t, name, _ in result.outputs}
    assert times.get("do[2]") == (None if at is None else pytest.approx(at))
    assert "do[1]" in times


def test_tasks_that_are_chosen_while_running_are_paused_each() -> None:
    """One task pauses another and lets it go on; a third one is not held up."""
    result = rpl(
        "START TASK slow\nSTART TASK guard\nSTART TASK free\nJOIN TASK slow\nJOIN TASK free\nSET do[1] TO ON",
        "PROCEDURE slow()\nWAIT 1 s\nSET do[2] TO ON\nEND PROCEDURE\n"
        "PROCEDURE free()\nWAIT 1 s\nSET do[3] TO ON\nEND PROCEDURE\n"
        "PROCEDURE guard()\nWAIT 0.5 s\nPAUSE TASK slow\nWAIT 1 s\nRESUME TASK slow\nEND PROCEDURE",
    )
    assert [(round(t, 3), name) for t, name, _ in result.outputs] == [(1.0, "do[3]"), (1.5, "do[2]"), (1.5, "do[1]")]


def test_nothing_else_runs_in_a_critical_section() -> None:
    result = rpl(
        "START TASK other\nENTER CRITICAL\nWAIT 1 s\nSET do[1] TO ON\nLEAVE CRITICAL\nJOIN TASK other",
        "PROCEDURE other()\nSET do[2] TO ON\nEND PROCEDURE",
    )
    assert [(round(t, 3), name) for t, name, _ in result.outputs] == [(1.0, "do[1]"), (1.0, "do[2]")]


def test_a_started_task_may_take_a_robot_that_stands() -> None:
    result = rpl(
        "START TASK mover\nJOIN TASK mover\nMOVE TO {j1: 0, j2: -90, j3: 90, j4: 0, j5: 0, j6: 0}",
        "PROCEDURE mover()\nMOVE TO {j1: 10, j2: -90, j3: 90, j4: 0, j5: 0, j6: 0}\nEND PROCEDURE",
        robot=UR,
    )
    assert result.status == "finished", result.fault
    assert result.moves == 2
    assert [event.task for event in result.trace if event.kind == "move"] == ["mover", "main"]


def test_a_setting_for_the_next_move_lasts_one_move() -> None:
    there, back = "{j1: 140, j2: 0, j3: 0, j4: 0, j5: 0, j6: 0}", "{j1: 0, j2: 0, j3: 0, j4: 0, j5: 0, j6: 0}"
    result = rpl(f"MOVE TO {back}\nFOR NEXT MOVE $speed_percent = 20\nMOVE TO {there}\nMOVE TO {back}", robot=VIPER)
    slow, fast = [event.data["duration"] for event in result.trace if event.kind == "move"][1:]
    assert slow > 2.5 * fast


def test_the_error_routine_of_a_task_decides_how_to_go_on() -> None:
    routine = "PROCEDURE recover()\nSET do[9] TO ON\nzero = 2\n{way}\nEND PROCEDURE"
    body = "TRAP ERRORS WITH recover\nx = 10 div zero\nSET do[1] TO x = 5"
    data = "VAR zero: INT = 0\nVAR x: INT = 0"
    for way, expected in (("RETRY", True), ("RETURN", True), ("TRY NEXT", False)):
        result = rpl(body, routine.format(way=way), data)
        assert result.status == "finished", result.fault
        assert on(result).get("do[1]", False) is expected, way
        assert on(result)["do[9]"] is True
    assert rpl("x = 10 div zero", data=data).status == "fault"
    assert rpl("TRAP ERRORS WITH recover\nTRAP ERRORS OFF\nx = 10 div zero", routine.format(way="RETRY"), data).fault


def test_an_error_inside_the_error_routine_ends_the_run() -> None:
    result = rpl("TRAP ERRORS WITH bad\nRAISE 5", "PROCEDURE bad()\nRAISE 6\nEND PROCEDURE")
    assert result.status == "fault"


MASKED = """
DECLARE INTERRUPT 20 EVERYWHERE NAMED 1 WHEN di[1] DO hit()
INTERRUPT ON 1
INTERRUPT MASK {mask}
WAIT 1 s
SET do[1] TO ON
INTERRUPT MASK
WAIT 1 s
"""
INPUT = "[[input]]\nsignal = 'di[1]'\nvalue = true\ntime = 0.5\n"


@pytest.mark.parametrize(("mask", "first"), [(20, "do[1]"), (10, "do[1]"), (21, "do[2]")])
def test_a_mask_makes_interrupts_wait(mask: int, first: str) -> None:
    """V+ LOCK: a reaction runs only when it is more urgent than the program's priority."""
    result = rpl(MASKED.format(mask=mask), "TRAP hit()\nSET do[2] TO ON\nEND TRAP", cell=INPUT)
    assert {name for _, name, _ in result.outputs} == {"do[1]", "do[2]"}
    assert result.outputs[0][1] == first


def test_a_one_shot_interrupt_comes_once() -> None:
    cell = "".join(f"[[input]]\nsignal='di[1]'\nvalue={v}\ntime={t}\n" for v, t in
                   (("true", 0.1), ("false", 0.2), ("true", 0.3)))  # fmt: skip
    body = "DECLARE INTERRUPT 5 EVERYWHERE{once} WHEN di[1] DO hit()\nINTERRUPT ON 5\nWAIT 1 s\nSET do[1] TO n = {n}"
    for once, n in ((" ONCE", 1), ("", 2)):
        more = "TRAP hit()\nn = n + 1\nEND TRAP"
        assert on(rpl(body.format(once=once, n=n), more, "VAR n: INT = 0", cell=cell)) == {"do[1]": True}


def test_an_interrupt_that_brakes_drops_the_rest_of_the_move() -> None:
    body = """MOVE TO {j1: 0, j2: -90, j3: 90, j4: 0, j5: 0, j6: 0}
DECLARE INTERRUPT 5 EVERYWHERE BRAKING WHEN di[1] DO hit()
INTERRUPT ON 5
MOVE TO {j1: 100, j2: -90, j3: 90, j4: 0, j5: 0, j6: 0} JOINT SPEED 10
WAIT FOR MOTION
here = current_joints()
SET do[1] TO here.j1 > 1 AND here.j1 < 99"""
    data = "VAR here: JOINTS"
    cell = "[[input]]\nsignal = 'di[1]'\nvalue = true\ntime = 3.0\n"
    result = rpl(body, "TRAP hit()\nSET do[2] TO ON\nEND TRAP", data, UR, cell)
    assert result.status == "finished", result.fault
    assert on(result) == {"do[1]": True, "do[2]": True}


def test_a_counter_that_keeps_its_last_value() -> None:
    body = "FOR i = 1 TO 3 KEEPS LAST\nn = n + 1\nEND FOR\nSET do[1] TO i = 3 AND n = 3\n"
    body += "FOR i = 5 TO 4 KEEPS LAST\nn = 0\nEND FOR\nSET do[2] TO i = 5 AND n = 3"
    assert on(rpl(body, data="VAR i: INT\nVAR n: INT = 0")) == {"do[1]": True, "do[2]": True}


SEARCH = """MOVE TO {j1: 0, j2: -90, j3: 90, j4: 0, j5: 0, j6: 0}
MOVE TO {j1: 60, j2: -90, j3: 90, j4: 0, j5: 0, j6: 0} SEARCH di[1] HIT seen STOPPING stop
here = current_joints()
SET do[1] TO seen
SET do[2] TO here.j1 < 59"""


@pytest.mark.parametrize(("moment", "seen"), [(0.9, True), (50.0, False), (0.0, True)])
def test_a_search_tells_whether_it_found(moment: float, seen: bool) -> None:
    """FANUC Skip,LBL: the move ends where the condition became true; nothing fails when it did not."""
    cell = f"[[input]]\nsignal = 'di[1]'\nvalue = true\ntime = {moment}\n"
    result = rpl(SEARCH, data="VAR seen: BOOL\nVAR here: JOINTS", robot=UR, cell=cell)
    assert result.status == "finished", result.fault
    shown = on(result)
    assert shown.get("do[1]", False) is seen


def test_speed_of_the_leading_axis() -> None:
    """URScript movej: v and a of the axis with the longest way; trapezoidal, so t = way/v + v/a."""
    start = "{j1: 0, j2: -90, j3: 90, j4: 0, j5: 0, j6: 0}"
    goal = "{j1: 90, j2: -60, j3: 90, j4: 0, j5: 0, j6: 0}"
    text = f"MOVE TO {start}\nMOVE TO {goal} AXIS SPEED 1.05 rad/s AXIS ACCELERATION 1.4 rad/s2"
    result = rpl(text, robot=UR)
    took = [event.data["duration"] for event in result.trace if event.kind == "move"][1]
    assert took == pytest.approx(math.radians(90) / 1.05 + 1.05 / 1.4, abs=1e-3)


def test_an_arm_goes_into_the_posture_that_is_asked_for() -> None:
    body = """MOVE TO {{x: 400, y: 100, z: 200, a: 0, b: 0, c: 180}}
FOR NEXT MOVE $posture_shoulder = #{side}
MOVE TO {{x: 400, y: 100, z: 200, a: 0, b: 0, c: 180}}
here = current_joints()
SET do[1] TO here.j2 > 0
SET do[2] TO here.j2 < 0"""
    for side, output in (("front", "do[1]"), ("back", "do[2]")):
        result = rpl(body.format(side=side), data="VAR here: JOINTS", robot=COBRA)
        assert result.status == "finished", result.fault
        assert on(result) == {output: True}


def test_a_value_of_one_controller_comes_from_the_cell() -> None:
    body = 'SET do[1] TO VENDOR(urscript, "get_weight()", REAL) > 2'
    cell = "[[vendor]]\nmatch = 'get_weight'\nvalue = 2.5\n"
    assert on(rpl(body, cell=cell)) == {"do[1]": True}
    fault = rpl(body).fault
    assert fault is not None and fault.code == "vendor" and "get_weight" in fault.message


@pytest.mark.parametrize(
    ("expression", "value"),
    [
        ("to_minus_bit(2 > 1)", -1),
        ("to_floor(-1.5)", -2),
        ("sign(-3)", -1),
        ("fraction(-1.25)", -0.25),
        ("log10(1000)", 3),
        ("element_sum(p, q).x", 11),
        ("element_difference(p, q).a", 20),
        ("displaced(p, q).y", 1 + 2),
        ("displaced_in_tool(p, q).x", 1),
        ("zyz_yaw(pose_zyz(1, 2, 3, 10, 20, 30))", 10),
        ("zyz_roll(pose_zyz(1, 2, 3, 10, 20, 30))", 30),
        ("zyz_yaw(pose_zyz(1, 2, 3, 10, 180, 30))", 0),
        ("rotation_vector_z(pose_from_rotation_vector(0, 0, 0, 0, 0, 90).rot)", 90),
        ("interpolate_pose(p, q, 2).x", 1 + 2 * 9),
        ("rotation_angle(q, r)", 90),
    ],
)
def test_functions(expression: str, value: float) -> None:
    data = """VAR p: POSE = {x: 1, y: 2, z: 3, a: 30, b: 0, c: 0}
VAR q: POSE = {x: 10, y: 0, z: 0, a: 10, b: 0, c: 0}
VAR r: POSE = {x: 0, y: 0, z: 0, a: 100, b: 0, c: 0}
VAR x: REAL"""
    if expression.startswith("displaced("):
        expression, value = "displaced(p, {x: 0, y: 1, z: 0, a: 0, b: 0, c: 0}).y", 3
    if expression.startswith("displaced_in_tool"):
        expression, value = "displaced_in_tool(p, {x: 0, y: 0, z: 5, a: 0, b: 0, c: 0}).z", 8
    result = rpl(f"x = {expression}\nSET do[1] TO abs(x - ({value})) < 0.000001", data=data)
    assert on(result) == {"do[1]": True}, result.fault


def test_the_published_golden_rotation() -> None:
    """One rotation in every notation, computed independently: Rz(30)·Ry(20)·Rx(10)."""
    turn = rigid.rotation_of_zyx(30, 20, 10)
    vector = [math.radians(part) for part in geometry.rotation_vector(turn)]
    assert vector == pytest.approx([0.077525, 0.384852, 0.486479], abs=1e-6)
    assert geometry.zyz_angles(turn) == pytest.approx([2.7268, 22.2687, 25.5056], abs=1e-4)
    assert geometry.rotation_of_zyz(10, 20, 30).quaternion == pytest.approx(
        [0.925417, 0.030154, 0.171010, 0.336824], abs=1e-6
    )
    again = geometry.rotation_of_vector(*geometry.rotation_vector(turn))
    assert again.quaternion == pytest.approx(turn.quaternion, abs=1e-12)


def test_sums_need_poses() -> None:
    with pytest.raises(ProgramError):
        geometry.PURE["element_sum"](1.0, 2.0)

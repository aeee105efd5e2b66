"""Tasks that wait for each other. What RAPID's instructions do is the MultiMove manual's, 3HAC021272-001, 6.7.2:
a task at a point waits until all tasks have reached the instruction with the same syncident variable."""

from __future__ import annotations

import pytest

from rpl.cell import parse_cell
from rpl.diagnostics import Diagnostics
from rpl.project import read_sources
from rpl.runtime.trace import RunResult
from rpl.simulation import run_program
from rpl.source import source_from_text

ARM = "abb_irb1600_6_12"
DECLARED = """PERS tasks both{2}:=[["T_ROB1"],["T_ROB2"]];
PERS tasks three{3}:=[["T_ROB1"],["T_ROB2"],["T_ROB3"]];
VAR syncident here;
VAR syncident there;
VAR syncident points{9};
CONST jointtarget start:=[[0,0,0,0,30,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
"""
HOME = "MoveAbsJ start,v1000,fine,tool0;\n"


def run(*texts: str, more: str = "", begin: str = HOME) -> RunResult:
    """A task of its own for each text, each with a robot; `more`: an endless task beside them."""
    sources = [
        source_from_text(
            f"RAPID/TASK{number}/PROGMOD/m{number}.mod",
            f"MODULE m{number}\n{DECLARED}PROC main()\n{begin}{text}\nENDPROC\nENDMODULE\n",
        )
        for number, text in enumerate(texts, 1)
    ]
    if more:
        path = "RAPID/TASK9/PROGMOD/beside.mod"
        sources.append(source_from_text(path, f"MODULE beside\nPROC main()\n{more}\nENDPROC\nENDMODULE\n"))
    diagnostics = Diagnostics()
    read = read_sources(sources, "rapid", diagnostics)
    assert not diagnostics.has_errors, [item.as_text() for item in diagnostics]
    return run_program(read.program, ARM, parse_cell(""), further=(ARM,) * (len(texts) - 1), max_time_s=60.0)


@pytest.mark.parametrize("first, second", [(0.5, 2.0), (2.0, 0.5), (1.0, 1.0)])
def test_both_go_on_when_the_last_one_has_come(first: float, second: float) -> None:
    result = run(
        f"WaitTime {first};\nWaitSyncTask here,both;\nSetDO do1,1;",
        f"WaitTime {second};\nWaitSyncTask here,both;\nSetDO do2,1;",
    )
    assert result.status == "finished", result.fault
    assert sorted(name for _, name, _ in result.outputs) == ["do1", "do2"]
    begun = max(event.t for event in result.trace if event.kind == "move")
    assert [time for time, _, _ in result.outputs] == pytest.approx([begun + max(first, second)] * 2, abs=1e-6)


def test_the_points_come_in_their_order_and_elements_are_points_of_their_own() -> None:
    result = run(
        "FOR i FROM 1 TO 3 DO\nWaitSyncTask points{i},both;\nSetGO go1,i;\nENDFOR",
        "FOR i FROM 1 TO 3 DO\nWaitTime 1;\nWaitSyncTask points{i},both;\nENDFOR",
    )
    assert result.status == "finished", result.fault
    begun = result.outputs[0][0] - 1.0
    assert [(round(time - begun, 6), value) for time, _, value in result.outputs] == [(1.0, 1), (2.0, 2), (3.0, 3)]


def test_three_tasks_meet() -> None:
    texts = [f"WaitTime {seconds};\nWaitSyncTask here,three;\nSetDO do{number},1;" for number, seconds in
             enumerate((0.3, 0.9, 0.6), 1)]  # fmt: skip
    result = run(*texts)
    assert result.status == "finished", result.fault
    assert len({time for time, _, _ in result.outputs}) == 1
    assert len(result.outputs) == 3


def test_a_time_out_raises_the_error_and_the_task_may_come_again() -> None:
    """Reference manual: ERR_WAITSYNCTASK; RETRY waits anew."""
    result = run(
        "WaitSyncTask here,both\\TimeOut:=1;\nSetDO do1,1;\nERROR\n"
        "IF ERRNO=ERR_WAITSYNCTASK THEN\nSetDO do3,1;\nRETRY;\nENDIF",
        "WaitTime 1.5;\nWaitSyncTask here,both;\nSetDO do2,1;",
    )
    assert result.status == "finished", result.fault
    assert [name for _, name, _ in result.outputs] in (["do3", "do1", "do2"], ["do3", "do2", "do1"])
    assert result.outputs[1][0] - result.outputs[0][0] == pytest.approx(0.5, abs=1e-6)


def test_a_time_out_that_nobody_handles_ends_the_run_with_its_name() -> None:
    result = run("WaitSyncTask here,both\\TimeOut:=1;", "WaitTime 5;\nWaitSyncTask here,both;")
    assert result.status == "fault"
    assert result.fault is not None
    assert "ERR_WAITSYNCTASK" in f"{result.fault.code} {result.fault.message}"
    assert result.fault.origin.line == 10


@pytest.mark.parametrize("second", ["WaitSyncTask there,both;", "WaitSyncTask points{2},both;", "WaitTime 1;"])
@pytest.mark.parametrize("more", ["", "WHILE TRUE DO\nWaitTime 1;\nENDWHILE"])
def test_tasks_that_never_meet_are_told(second: str, more: str) -> None:
    result = run("WaitSyncTask here,both;", second, more="" if second[4] == "S" else more)
    assert result.status == "deadlock"
    assert result.fault is not None
    assert "TASK2" in result.fault.message
    assert "here" in result.fault.message
    assert result.fault.origin.line == 10


@pytest.mark.parametrize(
    "first, second, code, told",
    [
        ("WaitSyncTask here,both;", "WaitSyncTask here,three;", "unknown-task", "there is no task T_ROB3"),
        ("WaitSyncTask here,one;", "WaitTime 1;", "unknown-data", "one"),
    ],
)
def test_lists_that_do_not_fit_are_faults(first: str, second: str, code: str, told: str) -> None:
    result = run(first, second)
    assert result.fault is not None
    assert (result.status, result.fault.code) == ("fault", code)
    assert told in result.fault.message


def test_a_list_without_the_task_itself_or_with_others_is_a_fault() -> None:
    result = run("WaitSyncTask here,both;", "WaitSyncTask here,both;", "WaitSyncTask here,both;")
    assert result.fault is not None
    assert result.fault.code == "task-lists"
    result = run("WaitSyncTask here,both;", "WaitSyncTask here,three;", "WaitTime 1;")
    assert result.fault is not None
    assert (result.fault.code, result.status) == ("task-lists", "fault")
    assert "with different tasks" in result.fault.message


def test_the_last_move_may_be_flown_by_and_in_position_waits_for_the_robot() -> None:
    move = "MoveAbsJ [[20,0,0,0,30,0],[9E9,9E9,9E9,9E9,9E9,9E9]],v200,z50,tool0;\n"
    early, late = (
        run(f"{move}WaitSyncTask{how}here,both;\nSetDO do1,1;", "WaitSyncTask here,both;").outputs[0][0]
        for how in (" ", "\\InPos,")
    )
    assert late - early > 0.1  # the program goes on that long before the corner would begin


# ---- moves together


def line(x: float, y: float, z: float) -> str:
    return f"[[{x},{y},{z}],[0,0,1,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]]"


def going(first: str, second: str) -> RunResult:
    """Both at a place, then together, then apart."""
    at = f"MoveJ {line(700, 0, 500)},v1000,fine,tool0;\n"
    return run(
        *(f"SyncMoveOn here,both;\n{text}SyncMoveOff there;\nSetDO do{n},1;" for n, text in ((1, first), (2, second))),
        begin=at,
    )


def spans(result: RunResult, task: str) -> list[tuple[float, float]]:
    """Start and end of the moves of a task behind the first one."""
    moves = [event for event in result.trace if event.kind == "move" and event.task == task]
    return [(event.legs[0].start_s, event.t) for event in moves[1:]]


def test_the_slowest_robot_says_how_long_a_move_together_takes() -> None:
    """MultiMove manual 6.7.4: 1000 mm at v100 beside 500 mm at v500 takes both 10 s, the second at 50 mm/s; here a
    fifth of the ways: 2 s, and what speeding up and braking adds."""
    result = going(
        f"MoveL {line(700, 200, 500)}\\ID:=10,v100,fine,tool0;\n",
        f"WaitTime 1;\nMoveL {line(700, 100, 500)}\\ID:=10,v500,fine,tool0;\n",
    )
    assert result.status == "finished", result.fault
    first, second = spans(result, "TASK1"), spans(result, "TASK2")
    assert first == second  # to the last bit
    ((begin, end),) = first
    assert end - begin == pytest.approx(2.0, abs=0.15)
    arrived = [event.t for event in result.trace if event.kind == "move"][:2]
    assert begin == pytest.approx(max(arrived) + 1.0, abs=0.05)
    (leg,) = [e.legs for e in result.trace if e.kind == "move" and e.task == "TASK2"][1]
    speeds = [abs(leg.plan.tcp_at(t + 0.01)[1, 3] - leg.plan.tcp_at(t)[1, 3]) / 0.01 for t in (0.9, 1.0, 1.1)]
    assert speeds == pytest.approx([50.0] * 3, rel=0.05)
    assert {time for time, _, _ in result.outputs} == {end}


def test_each_pair_of_moves_has_its_own_slowest() -> None:
    result = going(
        f"MoveL {line(700, 100, 500)}\\ID:=1,v50,fine,tool0;\nMoveL {line(700, 0, 500)}\\ID:=2,v1000,fine,tool0;\n",
        f"MoveL {line(700, 0, 600)}\\ID:=1,v1000,fine,tool0;\nMoveL {line(700, 0, 500)}\\ID:=2,v30,fine,tool0;\n",
    )
    assert result.status == "finished", result.fault
    both = spans(result, "TASK1")
    assert both == spans(result, "TASK2")
    assert [end - begin for begin, end in both] == pytest.approx([2.0, 100.0 / 30.0], abs=0.15)


def test_corners_between_moves_together_end_at_rest_and_are_told() -> None:
    text = f"MoveL {line(700, 50, 500)}\\ID:=1,v100,z10,tool0;\nMoveL {line(700, 50, 550)}\\ID:=2,v100,fine,tool0;\n"
    result = going(text, text)
    assert result.status == "finished", result.fault
    assert spans(result, "TASK1") == spans(result, "TASK2")
    assert [e.data["code"] for e in result.trace if e.kind == "warning"] == ["corner-together"] * 2


MOVE = f"MoveL {line(700, 50, 500)}\\ID:=1,v100,fine,tool0;\n"


@pytest.mark.parametrize(
    "first, second, told",
    [
        (MOVE.replace("\\ID:=1", ""), MOVE, "TASK1 goes together with other robots: its move needs an identity"),
        (MOVE, MOVE.replace("=1,", "=2,"), "move 2"),
        (MOVE, "", "TASK1 has a move 1 for which TASK2 has none before they go apart"),
        (MOVE, MOVE + "WaitTime 1;\n" + MOVE.replace("=1,", "=2,"), "TASK2 has a move 2 for which TASK1 has none"),
        ("SyncMoveOff there;\n" + MOVE, "SyncMoveOff there;\n" + MOVE, "but the robots do not go together here"),
        ("SyncMoveOn there,both;\n", "SyncMoveOn there,both;\n", "goes together with other tasks already"),
        ("StopMove;\n", MOVE, "a stop of robots that go together is not driven"),
    ],
)
def test_moves_that_do_not_fit_together_are_faults(first: str, second: str, told: str) -> None:
    result = going(first, second)
    assert result.status == "fault"
    assert result.fault is not None
    assert result.fault.code == "synchronisation"
    assert told in result.fault.message


def test_a_move_that_waits_for_another_robot_for_ever_is_told() -> None:
    result = going(MOVE, "WaitDI di1,1;\n" + MOVE)
    assert result.status == "deadlock"
    assert result.fault is not None
    assert "move 1 together with TASK2" in result.fault.message

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

"""Moves with and without a speed of their own in one program, and tasks that have a name besides their routine."""

from __future__ import annotations

import pytest

from rpl import registry
from rpl.diagnostics import Diagnostics
from rpl.project import read_sources
from rpl.runtime.trace import RunResult
from rpl.simulation import run_program
from rpl.source import source_from_bytes, source_from_text
from rpl.translation import translate_program

ROBOT = "kuka_kr6r900sixx"
SPEEDS = """PROCEDURE main()
    $path_speed = 200 mm/s
    MOVE TO joints {j1: 0, j2: -90, j3: 90, j4: 0, j5: 30, j6: 0}
    MOVE LINEAR BY {z: -100} SPEED 20 mm/s
    MOVE LINEAR BY {z: 100}
    MOVE LINEAR BY {z: -100}
END PROCEDURE
"""
TASKS = """ENTRY main
TASK pulse ENTRY beat BACKGROUND
GLOBAL VAR beats: INT = 0
GLOBAL VAR running: BOOL = FALSE
PROCEDURE beat()
    WHILE running
        beats = beats + 1
        WAIT 0.2 s
    END WHILE
END PROCEDURE
PROCEDURE main()
    WAIT 0.1 s
    running = TRUE
    START TASK pulse
    WAIT 1.1 s
    running = FALSE
    WAIT 1 s
    SET do[1] TO beats > 4 AND beats < 8
END PROCEDURE
"""
TARGETS = [name for name in registry.target_names() if name != "rpl"]


def translated(text: str, target: str) -> tuple[RunResult, RunResult]:
    source = read_sources([source_from_text("main.rpl", text)], "rpl", Diagnostics())
    translation = translate_program(source, target, ROBOT, None, Diagnostics())
    back = read_sources([source_from_bytes(f.path, f.data) for f in translation.files], target, Diagnostics())
    own = run_program(source.program, ROBOT, None, "main")
    theirs = run_program(back.program, ROBOT, None, translation.renamed.get("main", "main"))
    assert own.status == theirs.status == "finished", theirs.fault
    return own, theirs


@pytest.mark.parametrize("target", TARGETS)
def test_a_speed_holds_for_its_own_move(target: str) -> None:
    own, theirs = translated(SPEEDS, target)
    times = [[e.data["duration"] for e in run.trace if e.kind == "move"][1:] for run in (own, theirs)]
    assert times[1] == pytest.approx(times[0], rel=0.3)


@pytest.mark.parametrize("target", ["inform", "tp", "urscript", "vplus"])
def test_a_task_is_started_by_the_name_of_its_routine(target: str) -> None:
    own, theirs = translated(TASKS, target)
    assert len(own.outputs) == len(theirs.outputs) == 1

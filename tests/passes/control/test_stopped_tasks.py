"""Tasks that are ended from outside, for targets that cannot do that: the task leaves at its next wait."""

from __future__ import annotations

import pytest

from rpl.diagnostics import Diagnostics, Severity
from rpl.project import read_sources
from rpl.simulation import run_program
from rpl.source import source_from_bytes, source_from_text
from rpl.translation import translate_program

PROGRAM = """GLOBAL VAR beats: INT = 0
GLOBAL VAR late: BOOL
PROCEDURE main()
    VAR kept: INT
    START TASK beat
    WAIT 1.05 s
    STOP TASK beat
    kept = beats
    WAIT 0.5 s
    SET do[1] TO kept = beats AND beats > 7 AND beats < 13
    START TASK beat
    WAIT 0.5 s
    SET do[2] TO beats > kept
    STOP TASK beat
END PROCEDURE
PROCEDURE beat()
    LOOP
        beats = beats + 1
        {body}
    END LOOP
END PROCEDURE
"""
TARGETS = ["inform"]


def translated(body: str, target: str) -> tuple[set[str], set[int], str]:
    diagnostics = Diagnostics()
    text = "ENTRY main\n" + PROGRAM.replace("{body}", body)
    read = read_sources([source_from_text("one.rpl", text)], "rpl", diagnostics)
    assert not diagnostics.has_errors, [item.as_text() for item in diagnostics]
    translation = translate_program(read, target, None, None, diagnostics)
    files = [file for file in translation.files if not file.path.endswith(".csv")]
    back = read_sources([source_from_bytes(file.path, file.data) for file in files], target, Diagnostics())
    run = run_program(back.program, None, None, "MAIN", 20.0)
    on = {int(str(name).partition("(")[2].rstrip(")")) for _, name, value in run.outputs if value}
    return {item.code.name for item in diagnostics.of(Severity.LOSS)}, on, run.status


@pytest.mark.parametrize("target", TARGETS)
@pytest.mark.parametrize("body", ["WAIT 0.1 s", "WAIT UNTIL di[9] TIMEOUT 0.1 s FLAG late"])
def test_a_task_leaves_at_its_next_wait(body: str, target: str) -> None:
    assert translated(body, target) == (set(), {1, 2}, "finished")


def test_a_task_that_moves_the_robot_cannot_leave_by_itself() -> None:
    diagnostics = Diagnostics()
    text = "ENTRY main\n" + PROGRAM.replace("{body}", "MOVE LINEAR BY {z: 1}\n        WAIT 1 s")
    read = read_sources([source_from_text("one.rpl", text)], "rpl", diagnostics)
    translate_program(read, "inform", None, None, diagnostics)
    assert "task-control-lost" in {item.code.name for item in diagnostics.of(Severity.LOSS)}

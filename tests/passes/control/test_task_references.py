"""Arguments of V+ tasks, which are references: numbers and calculations are values; variables are refused."""

from __future__ import annotations

import pytest

from rpl.diagnostics import Diagnostics, Severity
from rpl.project import read_sources
from rpl.proof.wiring import with_signal_names
from rpl.simulation import run_program
from rpl.source import source_from_bytes, source_from_text
from rpl.translation import translate_program
from tests.refusing import refused

ROBOT = "adept_viper_s650"
PROGRAM = """.PROGRAM main()
        AUTO REAL most
        beats = 0
        total = 0
        most = 3
        EXECUTE 2 beat(3)
        WAIT beats == 3
        SIGNAL 1, 2
        EXECUTE 3 adder({count})
        WAIT total == 10
        SIGNAL 3
.END
.PROGRAM beat(count)
        AUTO REAL i
        FOR i = 1 TO count
            WAIT.EVENT , 0.2
            beats = beats+1
        END
.END
.PROGRAM adder(count)
        AUTO REAL i
        FOR i = 1 TO count
            WAIT.EVENT , 0.1
            total = total+i
        END
.END
"""
SHARED = """.PROGRAM main()
        beats = 0
        EXECUTE 2 beat(3, beats)
        WAIT beats == 3
.END
.PROGRAM beat(count, b)
        AUTO REAL i
        FOR i = 1 TO count
            WAIT.EVENT , 0.2
            b = b+1
        END
.END
"""
TARGETS = ["krl", "rapid", "tp", "inform", "urscript"]


@pytest.mark.parametrize("target", TARGETS)
@pytest.mark.parametrize("count", ["4", "(most+1)"])
def test_the_task_sees_what_it_is_given(count: str, target: str) -> None:
    diagnostics = Diagnostics()
    text = PROGRAM.replace("{count}", count)
    read = read_sources([source_from_text("main.v2", text)], "vplus", diagnostics)
    assert not diagnostics.has_errors, [item.as_text() for item in diagnostics]
    translation = translate_program(read, target, ROBOT, None, diagnostics)
    assert not diagnostics.of(Severity.LOSS)
    files = [source_from_bytes(f.path, f.data) for f in translation.files if not f.path.endswith(".csv")]
    back = with_signal_names(read_sources(files, target, Diagnostics()).program, translation.program)
    run = run_program(back, ROBOT, None, translation.renamed.get("main", "main"), 20.0)
    assert (run.status, len(run.outputs)) == ("finished", 3)


@pytest.mark.parametrize("target", TARGETS)
def test_a_variable_that_both_use_is_refused_at_the_start(target: str) -> None:
    assert ("task-argument-shared", 3) in refused(SHARED, "vplus", target, ROBOT)


def test_a_variable_is_refused() -> None:
    assert ("task-argument-shared", 9) in refused(PROGRAM.replace("{count}", "most"), "vplus", "krl", ROBOT)

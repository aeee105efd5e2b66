"""A routine for all errors (V+ REACTE) that holds for a part of the program only, in RAPID with its error handlers."""

from __future__ import annotations

import pytest

from rpl.diagnostics import Diagnostics, Severity
from rpl.project import ReadProgram, read_sources
from rpl.simulation import run_program
from rpl.source import source_from_bytes, source_from_text
from rpl.translation import translate_program

PROGRAM = """.PROGRAM main()
 errs = 0
 SIGNAL 1
 REACTE trap
 CALL root(-1)
 t = SQRT(-4)
 REACTE
 IF errs == 2 THEN
 SIGNAL 2
 END
 {behind}
 SIGNAL 3
.END
.PROGRAM root(n)
 t = SQRT(n)
.END
.PROGRAM trap()
 errs = errs+1
 RETURNE
.END
"""
AGAIN = PROGRAM.replace("RETURNE", "REACTE trap\n RETURNE")
BACKGROUND = ".PROGRAM side()\n CALL root(4)\n.END\n"


def read(text: str) -> ReadProgram:
    return read_sources([source_from_text("p.v2", text)], "vplus", Diagnostics())


@pytest.mark.parametrize("text", [PROGRAM, AGAIN], ids=["set once", "set again by itself"])
@pytest.mark.parametrize(("behind", "on"), [("", 3), ("CALL root(-9)", 2)])
def test_it_holds_between_its_two_statements(text: str, behind: str, on: int) -> None:
    own = read(text.format(behind=behind))
    diagnostics = Diagnostics()
    written = translate_program(own, "rapid", None, None, diagnostics)
    assert not [item.as_text() for item in diagnostics.of(Severity.LOSS)]
    back = read_sources([source_from_bytes(f.path, f.data) for f in written.files], "rapid", Diagnostics())
    runs = [
        run_program(own.program, entry="main"),
        run_program(back.program, entry=written.renamed.get("main", "main")),
    ]
    assert [len(run.outputs) for run in runs] == [on, on]
    assert [run.status for run in runs] == ["finished" if on == 3 else "fault"] * 2


def test_a_routine_that_another_task_calls_too_is_refused_by_name() -> None:
    text = PROGRAM.format(behind="EXECUTE 1 side()") + BACKGROUND
    diagnostics = Diagnostics()
    translate_program(read(text), "rapid", None, None, diagnostics)
    assert "error-routine-lost" in [item.code.name for item in diagnostics.of(Severity.LOSS)]

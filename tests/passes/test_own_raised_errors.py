"""A routine for all errors catches those that the program raises itself, also where the controller has such a routine
for its own errors only; that it is then not called for these is said."""

from __future__ import annotations

from rpl.cell import Cell
from rpl.diagnostics import Diagnostics
from rpl.project import read_sources
from rpl.simulation import run_program
from rpl.source import source_from_bytes, source_from_text
from rpl.translation import translate_program

_ROBOT = "kuka_kr6r900sixx"
_TEXT = """ENTRY main
MODULE m
    VAR te: INT = 0
    PROCEDURE main()
        MOVE TO {j1: 0, j2: -90, j3: 90, j4: 0, j5: 90, j6: 0}
        TRAP ERRORS WITH rec
        RAISE 60
        te = te + 10
        TRAP ERRORS OFF
        IF te = 11 THEN MESSAGE "met"
    END PROCEDURE
    PROCEDURE rec()
        te = te + 1
        TRY NEXT
    END PROCEDURE
END MODULE
"""


def test_a_raised_error_comes_to_the_routine() -> None:
    diagnostics = Diagnostics()
    read = read_sources([source_from_text("m.rpl", _TEXT)], "rpl", diagnostics)
    written = translate_program(read, "vplus", _ROBOT, None, diagnostics)
    back = read_sources([source_from_bytes(f.path, f.data) for f in written.files], "vplus", Diagnostics())
    result = run_program(back.program, _ROBOT, Cell(), written.renamed.get("main", "main"), 20.0)
    assert [event.data.get("text") for event in result.trace if event.kind == "message"] == ["met"]
    assert [item.code.name for item in diagnostics if item.code.name.startswith("error-routine")] == [
        "error-routine-no-motion"
    ]

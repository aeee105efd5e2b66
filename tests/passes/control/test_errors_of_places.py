"""A place out of reach where a routine for all errors holds, and the text of an error's number, in other languages."""

from __future__ import annotations

import pytest

from rpl.diagnostics import Diagnostics, Severity
from rpl.project import read_sources
from rpl.simulation import run_program
from rpl.source import source_from_bytes, source_from_text
from rpl.translation import translate_program

PROGRAM = """.PROGRAM main()
        AUTO n
        MOVE #start
        errs = 0
        REACTE trap
        MOVE TRANS(FAR,0,300,0,180,180)
        SIGNAL 1
        REACTE
        BREAK
        IF (errs == WANTED) AND ($said == "TEXT") THEN
            SIGNAL 2
        END
.END
.PROGRAM trap()
        errs = errs+1
        $said = $ERROR(ERROR(-1))
        RETURNE
.END
.LOCATIONS
#start 0 -90 180 0 90 0
.END
.STRINGS
$said ""
.END
"""
TARGETS = ["krl", "rapid", "tp", "urscript", "inform"]


@pytest.mark.parametrize("target", TARGETS)
@pytest.mark.parametrize(("x", "errors", "text"), [("1500", 1, "unreachable"), ("400", 0, "")])
def test_the_routine_is_called_for_a_place_out_of_reach(target: str, x: str, errors: int, text: str) -> None:
    program = PROGRAM.replace("FAR", x).replace("WANTED", str(errors)).replace("TEXT", text)
    own = read_sources([source_from_text("p.v2", program)], "vplus", Diagnostics())
    diagnostics = Diagnostics()
    written = translate_program(own, target, "adept_viper_s650", None, diagnostics)
    assert {item.code.name for item in diagnostics.of(Severity.LOSS)} <= {"error-routine-no-motion", "tp-text-case"}
    assert ("unreachable-move-raised" in [item.code.name for item in diagnostics]) == bool(errors)
    back = read_sources([source_from_bytes(f.path, f.data) for f in written.files], target, Diagnostics())
    runs = [
        run_program(own.program, "adept_viper_s650", entry="main"),
        run_program(back.program, "adept_viper_s650", entry=written.renamed.get("main", "main")),
    ]
    assert [run.status for run in runs] == ["finished", "finished"]
    assert [len(run.outputs) for run in runs] == [2, 2]

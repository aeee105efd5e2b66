"""Numbers of errors that a program keeps or shows are the source's, whatever the target calls the error."""

from __future__ import annotations

import pytest

from rpl.diagnostics import Diagnostics
from rpl.project import read_sources
from rpl.runtime.trace import RunResult
from rpl.simulation import run_program
from rpl.source import source_from_bytes, source_from_text
from rpl.translation import translate_program

ARM = "abb_irb1200_5_90"
# name -> statements of the handler, what is asked behind it, and what RAPID says
CASES = {
    "kept": ("last = $error_number", "last = 1001", "last:=1001;"),
    "counted with": ("last = $error_number - 1000", "last = 1", "last:=1001-1000;"),
    "shown": ('said = "E" & number_text($error_number, 0)', 'said = "E1001"', 'said:="E"+NumToStr(1001,0);'),
    "in an element": ("row[2] = $error_number", "row[2] = 1001", "row{2}:=1001;"),
    "given to a routine": ("keep($error_number)", "kept = 1001", "keep 1001;"),
    "asked for": ("IF $error_number = 1001 THEN last = 1", "last = 1", "IF ERRNO=ERR_WAIT_MAXTIME THEN"),
    "larger than": ("IF $error_number > 1000 THEN last = 1", "last = 1", "IF 1001>1000 THEN"),
    "named": ("last = $error_number", "last = timeout", "last:=ERRNO;"),
    "named later": ("last = $error_number", "last = timeout AND last > 1000", "last:=1001;"),
}
PROGRAM = """VAR last: INT = 0
VAR kept: INT = 0
VAR said: STRING[20]
VAR row: ARRAY[3] OF INT
work()
IF {asked} THEN SET do[1] TO ON

PROCEDURE work()
    WAIT UNTIL di[4] TIMEOUT 0.1 s ERROR timeout
ON ERROR {codes}
    {steps}
END PROCEDURE

PROCEDURE keep(n: INT)
    kept = n
END PROCEDURE
"""


def translated(text: str, target: str) -> tuple[str, RunResult]:
    """The files that are written, and how they run."""
    source = read_sources([source_from_text("main.rpl", text)], "rpl", Diagnostics())
    translation = translate_program(source, target, ARM, None, Diagnostics())
    again = Diagnostics()
    back = read_sources([source_from_bytes(f.path, f.data) for f in translation.files], target, again)
    assert not again.has_errors
    said = "\n".join(f.data.decode("latin-1") for f in translation.files)
    return said, run_program(back.program, ARM, None, translation.renamed.get("main", "main"))


@pytest.mark.parametrize("target", ["rapid", "urscript"])
@pytest.mark.parametrize("case", CASES)
def test_a_number_is_the_sources(case: str, target: str) -> None:
    steps, asked, written = CASES[case]
    said, result = translated(PROGRAM.format(steps=steps, asked=asked, codes="timeout"), target)
    assert result.status == "finished" and len(result.outputs) == 1
    assert target != "rapid" or written in said


@pytest.mark.parametrize("codes", ["", "timeout, division_by_zero", "1001", "1003, 1001"])
def test_handlers_for_several_errors(codes: str) -> None:
    said, result = translated(
        PROGRAM.format(steps="last = $error_number", asked="last > 1000 AND last < 1003", codes=codes), "rapid"
    )
    assert result.status == "finished" and len(result.outputs) == 1
    assert ("rpl_error_number()" in said) == (codes != "1001")
    assert "ERROR (1001)" not in said

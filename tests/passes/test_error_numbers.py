"""Numbers of errors in a program stand for their names, which the target numbers otherwise."""

from __future__ import annotations

import pytest

from rpl.diagnostics import Diagnostics
from rpl.project import read_sources
from rpl.runtime.trace import RunResult
from rpl.simulation import run_program
from rpl.source import source_from_bytes, source_from_text
from rpl.translation import translate_program

ARM = "abb_irb1200_5_90"
PROGRAM = """VAR last: INT = 0
work()
IF last = 1 THEN SET do[1] TO ON

PROCEDURE work()
    {wait}
ON ERROR {codes}
    {steps}
END PROCEDURE
"""
WAIT = "WAIT UNTIL di[4] TIMEOUT 0.1 s ERROR timeout"


def translated(text: str, target: str) -> tuple[str, RunResult]:
    """The files that are written, and how they run."""
    source = read_sources([source_from_text("main.rpl", text)], "rpl", Diagnostics())
    translation = translate_program(source, target, ARM, None, Diagnostics())
    again = Diagnostics()
    back = read_sources([source_from_bytes(f.path, f.data) for f in translation.files], target, again)
    assert not again.has_errors
    said = "\n".join(f.data.decode("latin-1") for f in translation.files)
    return said, run_program(back.program, ARM, None, translation.renamed.get("main", "main"))


@pytest.mark.parametrize(
    ("wait", "codes", "steps", "written"),
    [
        (WAIT, "timeout", "IF $error_number = 1001 THEN last = 1", "IF ERRNO=ERR_WAIT_MAXTIME THEN"),
        (WAIT, "1001", "last = 1", "ERROR (ERR_WAIT_MAXTIME)"),
        ("RAISE 1001", "timeout", "last = 1", "RAISE ERR_WAIT_MAXTIME"),
    ],
)
def test_a_number_stands_for_the_errors_name(wait: str, codes: str, steps: str, written: str) -> None:
    said, result = translated(PROGRAM.format(wait=wait, codes=codes, steps=steps), "rapid")
    assert result.status == "finished" and len(result.outputs) == 1
    assert written in said

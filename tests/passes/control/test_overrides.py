"""The operator's override in languages whose programs cannot set it."""

from __future__ import annotations

import pytest

from rpl.diagnostics import Diagnostics, Severity
from rpl.project import read_sources
from rpl.source import source_from_text
from rpl.translation import translate_program

PROGRAM = """/PROG  MAIN
/MN
{lines}
   9:  DO[1]=ON ;
/POS
/END
"""
# Lines, target, whether it is refused.
CASES = [
    ("OVERRIDE=100%", "urscript", False),
    ("OVERRIDE=100%", "inform", False),
    ("R[1]=1\nOVERRIDE=100%\nOVERRIDE=100%", "inform", False),
    ("OVERRIDE=30%", "inform", False),
    ("OVERRIDE=30%\nOVERRIDE=100%", "inform", False),
    ("R[1]=50\nOVERRIDE=R[1]", "urscript", True),  # what the run decides
    ("OVERRIDE=100%", "krl", False),
    ("OVERRIDE=100%", "tp", False),
]


@pytest.mark.parametrize(("lines", "target", "refused"), CASES)
def test_only_what_the_run_decides_is_refused(lines: str, target: str, refused: bool) -> None:
    text = PROGRAM.format(lines="\n".join(f"{at:4}:  {line} ;" for at, line in enumerate(lines.splitlines(), 1)))
    diagnostics = Diagnostics()
    read = read_sources([source_from_text("MAIN.LS", text)], "tp", diagnostics)
    translate_program(read, target, "fanuc_lrmate200id", None, diagnostics)
    assert bool(diagnostics.of(Severity.LOSS)) == refused

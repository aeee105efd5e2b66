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
# Lines, target, whether it is refused, whether it is left out with a warning.
CASES = [
    ("OVERRIDE=100%", "urscript", False, True),
    ("OVERRIDE=100%", "inform", False, True),
    ("R[1]=1\nOVERRIDE=100%\nOVERRIDE=100%", "inform", False, True),
    ("OVERRIDE=30%", "inform", False, False),
    ("OVERRIDE=30%\nOVERRIDE=100%", "inform", False, False),
    ("R[1]=50\nOVERRIDE=R[1]", "urscript", True, False),  # what the run decides
    ("OVERRIDE=100%", "krl", False, False),
    ("OVERRIDE=100%", "tp", False, False),
]


@pytest.mark.parametrize(("lines", "target", "refused", "left_out"), CASES)
def test_only_the_full_override_is_left_out(lines: str, target: str, refused: bool, left_out: bool) -> None:
    text = PROGRAM.format(lines="\n".join(f"{at:4}:  {line} ;" for at, line in enumerate(lines.splitlines(), 1)))
    diagnostics = Diagnostics()
    read = read_sources([source_from_text("MAIN.LS", text)], "tp", diagnostics)
    translate_program(read, target, "fanuc_lrmate200id", None, diagnostics)
    assert bool(diagnostics.of(Severity.LOSS)) == refused
    assert ("override-by-operator" in {one.code.name for one in diagnostics.of(Severity.WARNING)}) == left_out

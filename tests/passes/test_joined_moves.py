"""Moves that are joined by a switch (V+ CPON) in a language whose moves say so themselves."""

from __future__ import annotations

import pytest

from rpl.diagnostics import Diagnostics, Severity
from rpl.project import read_sources
from rpl.source import source_from_text
from rpl.translation import translate_program

PROGRAM = """.PROGRAM main()
 {first}
 MOVE #PPOINT(0,-45,180,0,45,0)
 MOVE #PPOINT(10,-45,180,0,45,0)
 BREAK
.END
"""


@pytest.mark.parametrize(
    ("first", "refused"),
    [("CPON ALWAYS", False), ("FINE 50 ALWAYS", False), ("ACCEL 80, 80", False), ("CPOFF ALWAYS", True)],
)
def test_a_switch_that_says_the_usual_is_no_loss(first: str, refused: bool) -> None:
    diagnostics = Diagnostics()
    read = read_sources([source_from_text("p.v2", PROGRAM.format(first=first))], "vplus", diagnostics)
    files = translate_program(read, "rapid", "adept_viper_s650", None, diagnostics).files
    assert bool(diagnostics.of(Severity.LOSS)) == refused
    text = "".join(file.data.decode() for file in files)
    assert refused or text.count("MoveAbsJ") == 2

"""Outputs that only pulses switch on are pulsed to high where a target cannot pulse to the opposite."""

from __future__ import annotations

import pytest

from rpl.diagnostics import Diagnostics, Severity
from rpl.project import read_sources
from rpl.source import source_from_text
from rpl.translation import translate_program

PROGRAM = """MODULE Main
  PROC main()
    Reset doReset;
    PulseDO\\PLength:=0.3,doReset;
    WaitTime 1;
    IF doReset=1 Stop;
%s
  ENDPROC
ENDMODULE
"""


@pytest.mark.parametrize("target", ["tp", "inform"])
@pytest.mark.parametrize(
    ("more", "high"),
    [
        ("", True),
        ("    SetDO doReset,0;", True),
        ("    SetDO doOther,1;", True),
        ("    SetDO doReset,1;", False),
        ("    InvertDO doReset;", False),
        ("    SetDO\\SDelay:=1,doReset,1;", False),
    ],
)
def test_pulses(target: str, more: str, high: bool) -> None:
    diagnostics = Diagnostics()
    read = read_sources([source_from_text("Main.mod", PROGRAM % more)], "rapid", diagnostics)
    done = translate_program(read, target, "abb_irb1200_5_90", None, diagnostics)
    named = {item.code.name for item in diagnostics.of(Severity.WARNING)}
    assert ("pulse-to-high" in named) is high
    assert not high or not any("pulse" in file.path.lower() for file in done.files)


def test_a_target_that_pulses_to_the_opposite_does() -> None:
    diagnostics = Diagnostics()
    read = read_sources([source_from_text("Main.mod", PROGRAM % "")], "rapid", diagnostics)
    done = translate_program(read, "rapid", "abb_irb1200_5_90", None, diagnostics)
    assert any(b"PulseDO\\PLength:=0.3,doReset;" in file.data for file in done.files)

"""Angles of single axes, set or looked at: on another arm they mean another posture, and that is told."""

from __future__ import annotations

import pytest

from rpl.diagnostics import Diagnostics, Severity
from rpl.project import read_sources
from rpl.source import source_from_text
from rpl.translation import translate_program

ABB, KUKA = "abb_irb1200_5_90", "kuka_kr6r900sixx"
TEXT = """MODULE Job
  CONST jointtarget home:=[[0,0,0,0,60,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
  VAR jointtarget j;
  PROC main()
    j:=home;
    j.robax.rax_1:=15;
    IF j.robax.rax_5>50 SetDO do1,1;
    j.extax.eax_a:=0;
    MoveAbsJ home,v500,fine,tool0;
  ENDPROC
ENDMODULE
"""


@pytest.mark.parametrize(("arm", "lines"), [(KUKA, [6, 7]), (None, []), (ABB, [])])
@pytest.mark.parametrize("target", ["krl", "rapid", "vplus"])
def test_a_single_axis_is_told_for_another_arm(target: str, arm: str | None, lines: list[int]) -> None:
    diagnostics = Diagnostics()
    read = read_sources([source_from_text("job.mod", TEXT)], "rapid", diagnostics)
    translate_program(read, target, ABB, arm, diagnostics)
    found = [item for item in diagnostics.of(Severity.LOSS) if item.code.name == "joints-not-converted"]
    assert [item.origin.line for item in found] == lines

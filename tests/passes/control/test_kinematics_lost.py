"""Kinematic functions that a target has in no form are refused by name; those that it has are not."""

from __future__ import annotations

import pytest

from rpl.diagnostics import Diagnostics
from rpl.project import read_sources
from rpl.source import source_from_text
from rpl.translation import translate_program

URSCRIPT = """def main():
  home = [0, -1.5, 1.5, -1.5, -1.5, 0]
  q = get_inverse_kin(p[0.3, 0.2, 0.3, 3.14, 0, 0], home)
  q[5] = 0
  movej(q)
  if get_inverse_kin_has_solution(p[0.3, 0.2, 0.3, 3.14, 0, 0], home):
    set_standard_digital_out(0, True)
  end
end
"""
RAPID = """MODULE k
  CONST jointtarget jHome:=[[0,0,0,0,60,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
  PROC main()
    VAR jointtarget j;
    VAR robtarget p;
    p:=CalcRobT(jHome,tool0);
    j:=CalcJointT(p,tool0);
    MoveAbsJ j,v1000,fine,tool0;
  ENDPROC
ENDMODULE
"""


@pytest.mark.parametrize(
    ("text", "dialect", "target", "count"),
    [
        (URSCRIPT, "urscript", "rapid", 2),
        (URSCRIPT, "urscript", "tp", 2),
        (URSCRIPT, "urscript", "vplus", 1),
        (URSCRIPT, "urscript", "krl", 0),
        (RAPID, "rapid", "vplus", 1),
        (RAPID, "rapid", "urscript", 0),
        (RAPID, "rapid", "krl", 0),
    ],
)
def test_refused_by_name(text: str, dialect: str, target: str, count: int) -> None:
    diagnostics = Diagnostics()
    name = "main.script" if dialect == "urscript" else "k.mod"
    read = read_sources([source_from_text(name, text)], dialect, diagnostics)
    # an arm that is not known has no formulas that the program could bring along
    translate_program(read, target, None if dialect == "urscript" else "abb_irb1200_5_90", None, diagnostics)
    losses = [item.code.name for item in diagnostics if item.severity.name == "LOSS"]
    assert losses.count("kinematics-lost") == count, losses

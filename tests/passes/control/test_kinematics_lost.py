"""Kinematic functions that a target has in no form are refused at their places; those that it has are not."""

from __future__ import annotations

import pytest

from tests.refusing import refused

URSCRIPT = """def main():
  home = [0, -1.5, 1.5, -1.5, -1.5, 0]
  q = get_inverse_kin(get_actual_tcp_pose(), home)
  q[5] = 0
  movej(q)
  if get_inverse_kin_has_solution(get_actual_tcp_pose(), home):
    set_standard_digital_out(0, True)
  end
end
"""
RAPID = """MODULE k
  CONST jointtarget jHome:=[[0,0,0,0,60,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
  PROC main()
    VAR jointtarget j;
    VAR robtarget p;
    p:=CRobT();
    j:=CalcJointT(p,tool0);
    j.robax.rax_6:=0;
    MoveAbsJ j,v1000,fine,tool0;
  ENDPROC
ENDMODULE
"""
LOST = "kinematics-lost"


@pytest.mark.parametrize(
    ("text", "source", "target", "lines"),
    [
        (URSCRIPT, "urscript", "rapid", [3, 6]),
        (URSCRIPT, "urscript", "tp", [3, 6]),
        (URSCRIPT, "urscript", "vplus", [3]),
        (URSCRIPT, "urscript", "krl", []),
        (RAPID, "rapid", "vplus", [7]),
        (RAPID, "rapid", "urscript", []),
        (RAPID, "rapid", "krl", []),
    ],
)
@pytest.mark.parametrize("arm", ["ur5e", "abb_irb1200_5_90"])
def test_refused_at_its_place(text: str, source: str, target: str, lines: list[int], arm: str) -> None:
    told = [line for code, line in refused(text, source, target, arm) if code == LOST]
    assert told == lines

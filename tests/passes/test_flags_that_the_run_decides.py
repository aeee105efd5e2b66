"""Flags of the arm configuration that only the run knows: reading one is refused; a known one is a number."""

from __future__ import annotations

import pytest

from tests.refusing import refused

KRL = """DEF MAIN()
DECL POS NOW
NOW = $POS_ACT
$OUT[1] = (NOW.S == 2)
NOW = {X 1,Y 2,Z 3,A 0,B 0,C 0,S 6,T 35}
END
"""
RAPID = """MODULE m
  PROC main()
    VAR robtarget p;
    p:=Offs(CRobT(\\Tool:=tool0\\WObj:=wobj0),0,0,10);
    IF p.robconf.cf4=0 Stop;
  ENDPROC
ENDMODULE
"""
KUKA, ABB = "kuka_kr6r900sixx", "abb_irb1200_5_90"


@pytest.mark.parametrize(
    ("text", "source", "target", "arm", "line"),
    [
        (KRL, "krl", "rapid", KUKA, 4),
        (KRL, "krl", "tp", KUKA, 4),
        (RAPID, "rapid", "krl", ABB, 5),
        (RAPID, "rapid", "vplus", ABB, 5),
    ],
)
def test_refused_at_its_place(text: str, source: str, target: str, arm: str, line: int) -> None:
    assert refused(text, source, target, arm) == [("configuration-field", line)]


def test_a_flag_that_every_value_has_is_a_number() -> None:
    assert refused(KRL.replace("$POS_ACT", "{X 9,Y 2,Z 3,A 0,B 0,C 0,S 6,T 3}"), "krl", "rapid", KUKA) == []

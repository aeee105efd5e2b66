"""Components of positions count whole micrometres: what is a whole number of millimetres for sure needs no rounding."""

from __future__ import annotations

import pytest

from tests.there_and_back import there_and_back

MODULE = """MODULE m
  CONST robtarget corner:=[[400,300,500],[0,0,1,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
  PERS num pitch:=140;
  VAR num n:=2;
  PROC main()
    VAR robtarget place;
    {first}
    n:=n+1;
    place:=corner;
    place.trans.x:=n*pitch;
    MoveL place,v500,fine,tool0;
  ENDPROC
ENDMODULE
"""


@pytest.mark.parametrize(
    ("first", "rounds"), [("pitch:=20;", False), ("pitch:=20.5;", True), ("pitch:=20; pitch:=pitch/3;", True)]
)
def test_only_what_may_have_a_fraction_is_rounded(first: str, rounds: bool) -> None:
    journey = there_and_back({"m.mod": MODULE.format(first=first)}, "rapid", "inform", "motoman_gp12")
    assert ("ADD R099 0.5" in journey.text) is rounds, journey.text
    assert "SETE P" in journey.text

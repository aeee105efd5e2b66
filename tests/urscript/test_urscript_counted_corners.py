"""Corners beside places that loops count keep their size where even the nearest of these is far enough away."""

from __future__ import annotations

import pytest
from there_and_back import there_and_back

PALLET = """MODULE m
  CONST robtarget pBelt:=[[400,-300,300],[0,1,0,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
  CONST robtarget pCorner:=[[300,200,300],[0,1,0,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
  CONST num nPitch:=60;
  PROC main()
    FOR row FROM 1 TO 2 DO
      FOR column FROM 1 TO 3 DO
        MoveL pBelt,v200,z50,tool0;
        put column,row;
      ENDFOR
    ENDFOR
  ENDPROC
  PROC put(num column,num row)
    VAR robtarget pPlace;
    pPlace:=Offs(pCorner,(column-1)*nPitch,(row-1)*nPitch,0);
    MoveL pPlace,v200,z50,tool0;
    WaitTime 0.1;
    MoveL Offs(pPlace,0,0,200),v200,fine,tool0;
  ENDPROC
ENDMODULE
"""


def written(text: str) -> str:
    journey = there_and_back({"m.mod": text}, "rapid", "urscript", "abb_irb1600_6_12")
    assert not journey.losses
    return journey.text


def test_a_corner_far_from_all_counted_places_keeps_its_size() -> None:
    text = written(PALLET)
    assert "rpl_min" not in text and text.count("r=0.05") == 2


@pytest.mark.parametrize(
    "change",
    [
        ("[[300,200,300]", "[[400,-250,300]"),  # 50 mm away where the count begins
        ("TO 3 DO", "TO nColumns DO"),  # how far it counts the run decides
        ("put column,row;", "put column,row;\n        put -8,-8;"),  # another call goes near the belt
        ("MoveL pPlace,", "pPlace:=Offs(pPlace,0,-500,0);\n    MoveL pPlace,"),  # a place of two assignments
    ],
)
def test_a_corner_that_may_be_too_near_is_worked_out(change: tuple[str, str]) -> None:
    text = PALLET.replace(*change).replace(
        "  PROC main()\n", "  VAR num nColumns:=3;\n  PROC main()\n    nColumns:=nColumns+1;\n"
    )
    assert "rpl_min" in written(text)

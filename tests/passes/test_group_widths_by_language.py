"""Groups of signals whose width only their own controller knows: as wide as their language has them where the program
works with their numbers, eight bits where it only names small ones; where groups have a size, in parts of that size.
"""

from __future__ import annotations

import pytest

from rpl.cell import Cell, Input
from tests.there_and_back import Journey, there_and_back

_LISTING = """/PROG  GROUPS
/ATTR
DEFAULT_GROUP = 1,*,*,*,*;
/MN
   1:  WAIT GI[1]=5 ;
   2:  R[1]=GI[3]-500 ;
   3:  WAIT GI[2]>400 ;
   4:  IF GI[2]<>455,JMP LBL[1] ;
   5:  IF (GI[2]=455),DO[101]=(ON) ;
   6:  DO[102]=(R[1]=(-45)) ;
   7:  R[2]=R[1]+1045 ;
   8:  GO[2]=R[2] ;
   9:  DO[103]=(GO[2]=1000) ;
  10:  GO[1]=7 ;
  11:  LBL[1] ;
/POS
/END
"""
_MODULE = """MODULE Main
    PROC main()
        VAR num height;
        height := giHeight;
        IF height = 455 SetDO do101, 1;
        TEST giCode
        CASE 7:
            SetDO do102, 1;
        DEFAULT:
            SetDO do102, 0;
        ENDTEST
        FOR i FROM 1 TO 3 DO
            SetGO goStep, i * 200;
            height := height + goStep;
        ENDFOR
        IF height = 1655 SetDO do103, 1;
    ENDPROC
ENDMODULE
"""
_CELL = Cell(inputs=(Input(1.0, "GI[1]", 5), Input(0.0, "GI[3]", 455), Input(2.0, "GI[2]", 455)))
_TARGETS = ["krl", "rapid", "tp", "urscript", "vplus", "inform"]


def _written(target: str) -> Journey:
    return there_and_back({"GROUPS.LS": _LISTING}, "tp", target, "fanuc_lrmate200id")


def _holds(journey: Journey, entry: str, cell: Cell) -> None:
    result = journey.run(entry, cell)
    assert result.fault is None
    assert {101, 102, 103} <= journey.switched_on(result)
    assert not journey.losses
    assert "group-too-narrow" not in [item.code.name for item in journey.found]


@pytest.mark.parametrize("target", _TARGETS)
def test_numbers_beyond_eight_bits_come_through(target: str) -> None:
    _holds(_written(target), "GROUPS", _CELL)


@pytest.mark.parametrize("target", _TARGETS)
def test_groups_of_names_only(target: str) -> None:
    cell = Cell(inputs=(Input(0.0, "giHeight", 455), Input(0.0, "giCode", 7)))
    _holds(there_and_back({"Main.mod": _MODULE}, "rapid", target, "abb_irb1200_5_90"), "main", cell)


def test_a_group_of_codes_keeps_eight_bits() -> None:
    text = _written("krl").text
    assert "SIGNAL gi1 $IN[1] TO $IN[8]" in text
    assert "SIGNAL go1 $OUT[17] TO $OUT[24]" in text


def test_sixteen_signals_are_two_bytes() -> None:
    text = _written("inform").text
    assert "DIN B099 IG#(" in text
    assert " IN#(" not in text


_LIMITED = """/PROG  LIMITED
/ATTR
DEFAULT_GROUP = 1,*,*,*,*;
/MN
   1:  $WAITTMOUT=150 ;
   2:  WAIT GI[1]>400 TIMEOUT,LBL[1] ;
   3:  DO[1]=ON ;
   4:  LBL[1] ;
   5:  TIMER[1]=RESET ;
   6:  TIMER[1]=START ;
   7:  WAIT GI[1]>600 TIMEOUT,LBL[2] ;
   8:  DO[2]=ON ;
   9:  LBL[2] ;
  10:  TIMER[1]=STOP ;
  11:  R[1]=TIMER[1] ;
  12:  DO[3]=(R[1]>1.4 AND R[1]<1.6) ;
/POS
/END
"""


@pytest.mark.parametrize("target", _TARGETS)
def test_a_limit_on_a_wait_for_a_computed_condition(target: str) -> None:
    journey = there_and_back({"LIMITED.LS": _LIMITED}, "tp", target, "fanuc_lrmate200id")
    result = journey.run("LIMITED", Cell(inputs=(Input(0.5, "GI[1]", 455),)))
    assert journey.switched_on(result) == {1, 3}
    assert not journey.losses

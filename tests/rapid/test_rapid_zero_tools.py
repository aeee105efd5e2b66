"""Tools and work objects that are still zero: declared ones are taught later and keep their names, tool0 is none."""

from __future__ import annotations

from there_and_back import there_and_back

MODULE = """MODULE z
  PERS tooldata tGrip:=[TRUE,[[0,0,0],[1,0,0,0]],[1,[0,0,1],[1,0,0,0],0,0,0]];
  PERS wobjdata wTable:=[FALSE,TRUE,"",[[0,0,0],[1,0,0,0]],[[0,0,0],[1,0,0,0]]];
  CONST robtarget p1:=[[700,0,700],[0,0,1,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
  PROC main()
    MoveL p1,v500,fine,tGrip\\WObj:=wTable;
    MoveL p1,v500,fine,tool0;
  ENDPROC
ENDMODULE
"""


def test_declared_ones_keep_their_names_in_krl() -> None:
    text = there_and_back({"z.mod": MODULE}, "rapid", "krl").text
    for line in ("DECL FDAT FP1={TOOL_NO 1,BASE_NO 1,", 'TOOL_NAME[1,]="tGrip"', 'BASE_NAME[1,]="wTable"'):
        assert line in text
    assert text.index("FDAT_ACT=FP1") < text.index("$TOOL=$NULLFRAME")


def test_declared_ones_are_set_by_name_in_urscript() -> None:
    text = there_and_back({"z.mod": MODULE}, "rapid", "urscript").text
    assert "set_tcp(tGrip.frame)" in text and "wTable.user_frame" in text

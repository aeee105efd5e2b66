"""Where the robot stands, seen with another tool or frame than the one in force, which is selected for the reading."""

from __future__ import annotations

from tp_translating_helpers import same_in_tp

SEEN = """MODULE m
  PERS tooldata tPen:=[TRUE,[[0,0,100],[1,0,0,0]],[1,[0,0,1],[1,0,0,0],0,0,0]];
  TASK PERS wobjdata wTable:=[FALSE,TRUE,"",[[300,0,0],[1,0,0,0]],[[0,0,0],[1,0,0,0]]];
  CONST robtarget pA:=[[50,0,300],[0,0,1,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
  VAR robtarget pNow;
  VAR num k:=0;
  PROC main()
    ConfL\\Off;
    MoveAbsJ [[0,0,0,0,60,0],[9E9,9E9,9E9,9E9,9E9,9E9]],v500,fine,tPen;
    MoveL pA,v200,fine,tPen\\WObj:=wTable;
    pNow:=CRobT(\\Tool:=tPen\\WObj:=wTable);
    IF Abs(pNow.trans.x-50)<0.1 SetDO do1,1;
    again:
    pNow:=CRobT(\\Tool:=tPen\\WObj:=wobj0);
    IF Abs(pNow.trans.x-350)<0.1 SetDO do2,1;
    look;
    k:=k+1;
    IF k<2 GOTO again;
    wTable.uframe.trans.x:=320;
    pNow:=CRobT(\\Tool:=tool0\\WObj:=wTable);
    IF Abs(pNow.trans.x-30)<0.1 AND Abs(pNow.trans.z-400)<0.1 SetDO do4,1;
    MoveL pA,v200,fine,tPen\\WObj:=wTable;
    pNow:=CRobT(\\Tool:=tPen\\WObj:=wobj0);
    IF Abs(pNow.trans.x-370)<0.1 SetDO do5,1;
  ENDPROC
  PROC look()
    pNow:=CRobT(\\Tool:=tPen\\WObj:=wTable);
    IF Abs(pNow.trans.x-50)<0.1 SetDO do3,1;
  ENDPROC
ENDMODULE
"""


def test_the_number_in_force_is_selected_again_behind_the_reading() -> None:
    files, _ = same_in_tp("rapid", SEEN)
    main = [line.partition(":")[2].removesuffix(" ;").strip() for line in files["MAIN.LS"].splitlines()]
    looks = [at for at, line in enumerate(main) if line.endswith(":pNow]=LPOS")]
    assert [main[looks[0] - 1], main[looks[0] + 1]] == ["UFRAME_NUM=2", "UFRAME_NUM=1"]  # tool in force
    assert "UFRAME_NUM=0" in main[looks[-1] - 4 : looks[-1]] and main[looks[-1] + 1] == "UFRAME_NUM=1"
    look = files["LOOK.LS"]  # what is in force there depends on the caller
    assert "R[200:UFRAME in use]=$MNUFRAMENUM[1] ;" in look and "UFRAME_NUM=R[200:UFRAME in use] ;" in look


VPLUS_LOOPS = """.PROGRAM main()
TOOL TRANS(0,0,50)
MOVE #PPOINT(0,-90,180,0,45,0)
BREAK
FOR i = 1 TO 2
  HERE a
END
GOTO 10
10 HERE b
SIGNAL (DX(b) == DX(a))
MOVES SHIFT(a BY 0,10,0)
BREAK
.END
"""


def test_labels_and_loops_keep_what_nothing_selects_there() -> None:
    files, _ = same_in_tp("vplus", VPLUS_LOOPS)
    assert "MNUFRAMENUM" not in files["MAIN.LS"] and "UF : 0, UT : 1" in files["MAIN.LS"]

"""Programs of other languages in TP: messages, texts, routines that call themselves."""

from __future__ import annotations

import pytest
from tp_translating_helpers import same_in_tp

MESSAGES = """MODULE m
  PERS num count:=0;
  PROC main()
    VAR string part:="lid";
    count:=7;
    TPWrite "count: "+NumToStr(count,0)+" pieces";
    TPWrite "half "\\Num:=count/2;
    TPWrite part+" of "+ValToStr(count)+"mm is longer than the line of a screen";
    show 3;
  ENDPROC
  PROC show(num v)
    TPWrite "v"+NumToStr(v,1);
    TPWrite NumToStr(v,0);
  ENDPROC
ENDMODULE
"""


def test_messages_name_the_registers_of_their_values() -> None:
    files, codes = same_in_tp("rapid", MESSAGES)
    main = files["MAIN.LS"]
    assert "MESSAGE[count: R1 pieces]" in main and "MESSAGE[SR1 of R1 mm is]" in main
    assert "R[2:shown]=R[1:count]/2 ;" in main and "MESSAGE[half R2]" in main
    assert "MESSAGE[v R3]" in files["SHOW.LS"]
    assert set(codes) == {"message-values-named", "message-split"}


TEXTS = """MODULE m
  PROC main()
    VAR string line:="part-7 blue";
    VAR num at;
    VAR bool ok;
    VAR num v;
    VAR string n;
    at:=StrMatch(line,1,"7");
    IF at=6 Set do1;
    IF StrMatch(line,7,"7")=12 Set do2;
    IF StrFind(line,1,"0123456789")=6 Set do3;
    IF StrMemb(line,6,STR_DIGIT) Set do4;
    IF StrMap(line,STR_LOWER,STR_UPPER)="PART-7 BLUE" Set do5;
    IF NumToStr(3.14159,2)="3.14" Set do6;
    IF NumToStr(-0.05,1)="-0.1" Set do7;
    IF NumToStr(7,0)+"x"="7x" Set do8;
    IF StrPart(line,1,4)="part" Set do9;
    IF StrLen(line)=11 Set do10;
    ok:=StrToVal("12.5",v);
    IF ok AND v=12.5 Set do11;
    n:=ValToStr(ok)+ValToStr(4);
    IF n="TRUE4" Set do12;
    IF NumToStr(2.5,3)="2.500" Set do13;
    IF NumToStr(1200,1)="1200.0" Set do14;
    ok:=StrToVal("many",v);
    IF NOT ok Set do15;
  ENDPROC
ENDMODULE
"""


def test_functions_of_texts() -> None:
    files, codes = same_in_tp("rapid", TEXTS)
    main = files["MAIN.LS"]
    assert "=SUBSTR SR[1:line],1,4" in main and "=STRLEN SR[1:line]" in main
    assert "CALL RPL_TEXT_FIND_ANY(SR[1:line],1,'0123456789')" in main
    assert set(codes) == {"tp-text-case"}


HANDED_ON = """MODULE m
  PROC main()
    first "part";
  ENDPROC
  PROC first(string name)
    second name,3;
  ENDPROC
  PROC second(string name,num much)
    IF name="part" AND much=3 Set do1;
  ENDPROC
ENDMODULE
"""


def test_texts_as_arguments_that_are_handed_on() -> None:
    files, _ = same_in_tp("rapid", HANDED_ON)
    assert "CALL SECOND(AR[1],3)" in files["FIRST.LS"]


KRL_PATH = """DEF p()
BAS(#INITMOV,0)
$VEL.CP=0.2
PTP {X 500,Y 0,Z 420,A 0,B 90,C 0,S 6,T 18}
LIN {X 500,Y 0,Z 380,A 0,B 90,C 0}
TRIGGER WHEN PATH=10.0 ONSTART DELAY=0 DO $OUT[1]=TRUE
TRIGGER WHEN PATH=-15.0 DELAY=0 DO $OUT[1]=FALSE
LIN {X 500,Y 100,Z 380,A 0,B 90,C 0}
TRIGGER WHEN DISTANCE=0 DELAY=20 DO $OUT[2]=TRUE
TRIGGER WHEN PATH=-20 DELAY=0 DO mark() PRIO=5
LIN {X 500,Y 0,Z 380,A 0,B 90,C 0}
END
DEF mark()
$OUT[3]=TRUE
END
"""


def test_actions_on_the_path_stand_at_the_move() -> None:
    files, _ = same_in_tp("krl", KRL_PATH)
    text = files["P.LS"]
    assert "DB 90.0mm,DO[1]=ON DB 15.0mm,DO[1]=OFF TA 0.02sec,DO[2]=ON" in text
    assert "DB 20.0mm,CALL MARK" in text


RAPID_PATH = """MODULE m
  VAR triggdata tdOpen;
  VAR triggdata tdShut;
  PROC main()
    TriggIO tdOpen,10\\Start\\DOp:=doGun,1;
    TriggEquip tdShut,5,0\\DOp:=doGun,0;
    MoveJ [[400,0,400],[0,1,0,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]],v200,fine,tool0;
    TriggL [[400,100,400],[0,1,0,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]],v100,tdOpen\\T2:=tdShut,fine,tool0;
    TriggL [[400,0,400],[0,1,0,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]],v100,tdOpen,fine,tool0;
  ENDPROC
ENDMODULE
"""


def test_stored_actions_on_the_path() -> None:
    files, _ = same_in_tp("rapid", RAPID_PATH)
    assert "DB 90.0mm,DO[1:doGun]=ON DB 5.0mm,DO[1:doGun]=OFF" in files["MAIN.LS"]


MATRIX = """def p():
  matrix = [[1, 2, 3], [4, 5, 6]]
  i = 1
  matrix[1, 2] = 60
  if matrix[i, 2] + matrix[0, i] == 62:
    set_standard_digital_out(0, True)
  end
end
"""


def test_arrays_of_two_dimensions() -> None:
    files, _ = same_in_tp("urscript", MATRIX)
    assert ":matrix2,3]=60" in files["P.LS"]


SEARCH = """MODULE m
  VAR robtarget pFound;
  CONST robtarget pHigh:=[[400,0,400],[0,1,0,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
  CONST robtarget pLow:=[[400,0,200],[0,1,0,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
  PROC main()
    MoveJ pHigh,v200,fine,tool0;
    Set doGo;
    SearchL\\Stop,diPart,pFound,pLow,v50,tool0;
    Set doFound;
    MoveL Offs(pFound,0,0,50),v100,fine,tool0;
    Set doDone;
  ERROR
    IF ERRNO=ERR_WHLSEARCH THEN
      Set doNone;
      TRYNEXT;
    ENDIF
  ENDPROC
ENDMODULE
"""
TOUCH = """[[reaction]]
when = "doGo"
becomes = true
signal = "diPart"
value = true
after = 1.0
"""


@pytest.mark.parametrize("cell", [TOUCH, ""], ids=["found", "not found"])
def test_searches_and_their_errors(cell: str) -> None:
    files, _ = same_in_tp("rapid", SEARCH, cell)
    assert " Skip,LBL[1],PR[1:pFound]=LPOS" in files["MAIN.LS"]


SEEN = """MODULE m
  PERS tooldata tPen:=[TRUE,[[0,0,100],[1,0,0,0]],[1,[0,0,1],[1,0,0,0],0,0,0]];
  PERS wobjdata wTable:=[FALSE,TRUE,"",[[100,0,0],[1,0,0,0]],[[0,0,0],[1,0,0,0]]];
  VAR robtarget pNow;
  PROC main()
    MoveJ [[300,0,400],[0,1,0,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]],v200,fine,tPen\\WObj:=wTable;
    pNow:=CRobT(\\Tool:=tPen\\WObj:=wTable);
    IF Abs(pNow.trans.x-300)<0.1 Set do1;
    pNow:=CRobT(\\Tool:=tool0\\WObj:=wobj0);
    IF Abs(pNow.trans.x-400)<0.1 AND Abs(pNow.trans.z-500)<0.1 Set do2;
    MoveL [[300,50,400],[0,1,0,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]],v200,fine,tPen\\WObj:=wTable;
  ENDPROC
ENDMODULE
"""


def test_where_the_robot_stands_seen_with_another_tool() -> None:
    files, _ = same_in_tp("rapid", SEEN)
    text = " ".join(files["MAIN.LS"].split())
    assert text.count("=LPOS") >= 2


ROUNDED = """MODULE m
  PROC main()
    VAR num x:=2.345;
    IF Round(x\\Dec:=2)=2.35 Set do1;
    IF Round(x)=2 Set do2;
    IF Trunc(x\\Dec:=1)=2.3 Set do3;
    IF Trunc(-x)=-2 Set do4;
  ENDPROC
ENDMODULE
"""


def test_rounding_to_decimals() -> None:
    files, _ = same_in_tp("rapid", ROUNDED)
    assert "=ROUND[" in files["MAIN.LS"] and "CALL RPL_ROUND(" in files["MAIN.LS"]


NUMBERS_IN_TEXTS = """.PROGRAM main()
  IF (VAL("128") == 128) AND (VAL("-2.5E1") == -25) THEN
    SIGNAL 1
  END
.END
"""


def test_numbers_in_constant_texts() -> None:
    files, _ = same_in_tp("vplus", NUMBERS_IN_TEXTS)
    assert "128=128" in files["MAIN.LS"]


LATE_BINDING = """MODULE m
  VAR string s:="";
  VAR string u:="ab";
  PROC main()
    IF s="" Set do1;
    s:="12";
    IF s="12" OR s="" Set do2;
    %"Work"+s% 5;
    s:="x";
    %u+"X"% s;
    IF s="y" Set do5;
    %"abx"% s;
  ENDPROC
  PROC Work12(num n)
    IF n=5 Set do3;
  ENDPROC
  PROC abx(INOUT string n)
    n:="y";
    Set do4;
  ENDPROC
ENDMODULE
"""


def test_routines_by_name_that_take_more_than_argument_registers_are_chosen_by_comparison() -> None:
    files, codes = same_in_tp("rapid", LATE_BINDING)
    main = files["MAIN.LS"]
    assert "IF (SR[4:called]='Work12') THEN" in main and "CALL SR[" not in main
    assert main.count("CALL ABX") == 2
    assert codes.count("tp-text-case") == 1  # only the comparison with a letter


BY_VALUE = """MODULE m
  PROC main()
    FOR i FROM 1 TO 2 DO
      %"Work"+ValToStr(i)% i;
    ENDFOR
  ENDPROC
  PROC Work1(num n)
    IF n=1 Set do1;
  ENDPROC
  PROC Work2(num n)
    IF n=2 Set do2;
  ENDPROC
ENDMODULE
"""


def test_routines_by_name_with_argument_registers() -> None:
    files, _ = same_in_tp("rapid", BY_VALUE)
    assert "CALL SR[" in files["MAIN.LS"]

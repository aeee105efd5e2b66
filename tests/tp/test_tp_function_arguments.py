"""Functions of numbers take registers: constants are evaluated, components of places are copied before."""

from tp_translating_helpers import same_in_tp

PROGRAM = """MODULE M
  PERS tooldata tGrip:=[TRUE,[[0,0,100],[1,0,0,0]],[1,[0,0,50],[1,0,0,0],0,0,0]];
  VAR robtarget pNow:=[[400,0,300],[0,0,1,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
  VAR num nLeft:=-2.5;
  PROC main()
    VAR num a;
    VAR num b;
    pNow.trans.x:=pNow.trans.x+9;
    a:=Sqrt(9);
    b:=Abs(pNow.trans.x);
    SetDO do1,Round(nLeft)=-3;
    SetDO do2,a=3;
    SetDO do3,Sin(Abs(pNow.trans.y)+30)>0.49;
    SetDO do4,b=409;
  ENDPROC
ENDMODULE
"""


def test_constants_are_evaluated_and_components_are_copied() -> None:
    files, _ = same_in_tp("rapid", PROGRAM)
    text = next(text for name, text in files.items() if "ABS[" in text)
    lines = [line.partition(":")[2].strip(" ;\r") for line in text.splitlines()]
    functions = [line.partition("]=")[2] for line in lines if any(f"{one}[" in line for one in ("ABS", "SIN", "SQRT"))]
    assert functions
    assert all(one.partition("[")[2].startswith("R[") for one in functions)
    assert not any("SQRT" in one for one in functions)

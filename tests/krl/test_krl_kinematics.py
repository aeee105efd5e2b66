"""INVERSE and FORWARD: read, run, and written for the kinematic functions of other languages."""

from __future__ import annotations

from pathlib import Path

import pytest

from rpl.diagnostics import Diagnostics
from rpl.project import read_sources
from rpl.simulation import run_program
from rpl.source import source_from_text
from rpl.translation import translate_program

ROBOT = "kuka_kr6r900sixx"
KRL = """DEF KIN( )
DECL E6AXIS Q,THERE
DECL E6POS P
DECL INT ERR
PTP {A1 0,A2 -90,A3 90,A4 0,A5 60,A6 0}
$BASE={X 100.0,Y 0.0,Z 50.0,A 0.0,B 0.0,C 0.0}
$TOOL={X 0.0,Y 0.0,Z 80.0,A 0.0,B 0.0,C 0.0}
THERE=$AXIS_ACT
ERR=7
P=FORWARD(THERE,ERR)
$OUT[1]=(ERR==0) AND (ABS(P.X-$POS_ACT.X)<0.01) AND (ABS(P.Z-$POS_ACT.Z)<0.01)
P.X=P.X+20.0
ERR=7
Q=INVERSE(P,THERE,ERR)
$OUT[2]=(ERR==0) AND (ABS(Q.A2+90.0)>0.1)
PTP Q
$OUT[3]=ABS($POS_ACT.X-P.X)<0.01
P.X=9000.0
Q=INVERSE(P,THERE,ERR)
$OUT[4]=ERR<>0
END
"""
RAPID = """MODULE k
  PERS tooldata tPen:=[TRUE,[[0,0,100],[1,0,0,0]],[0.8,[0,0,50],[1,0,0,0],0,0,0]];
  PERS wobjdata wTable:=[FALSE,TRUE,"",[[350,0,150],[1,0,0,0]],[[0,0,0],[1,0,0,0]]];
  CONST jointtarget jHome:=[[0,0,0,0,60,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
  PROC main()
    VAR robtarget p;
    VAR jointtarget j;
    MoveAbsJ jHome,v1000,fine,tool0;
    p:=CalcRobT(jHome,tPen\\WObj:=wTable);
    j:=CalcJointT(Offs(p,0,10,0),tPen\\WObj:=wTable);
    IF Abs(j.robax.rax_1)>0.1 AND Abs(j.robax.rax_5-60)<10 SetDO do1,1;
    MoveAbsJ j,v1000,fine,tool0;
    IF Abs(CRobT(\\Tool:=tPen\\WObj:=wTable).trans.y-p.trans.y-10)<0.01 SetDO do2,1;
  ENDPROC
ENDMODULE
"""


def outputs(files: list[tuple[str, str]], dialect: str, robot: str) -> set[str]:
    diagnostics = Diagnostics()
    read = read_sources([source_from_text(name, text) for name, text in files], dialect, diagnostics)
    assert not diagnostics.has_errors
    run = run_program(read.program, robot)
    assert run.status == "finished", run.fault
    return {name for _, name, value in run.outputs if value}


def test_the_error_says_whether_there_is_an_answer() -> None:
    assert outputs([("kin.src", KRL)], "krl", ROBOT) == {f"$OUT[{n}]" for n in range(1, 5)}


def translated(text: str, name: str, dialect: str, target: str, robot: str) -> tuple[list[tuple[str, str]], list[str]]:
    diagnostics = Diagnostics()
    read = read_sources([source_from_text(name, text)], dialect, diagnostics)
    done = translate_program(read, target, robot, None, diagnostics)
    losses = [item.code.name for item in diagnostics if item.severity.name == "LOSS"]
    return [(Path(one.path).name, one.data.decode("latin-1")) for one in done.files], losses


def test_written_for_another_controller() -> None:
    files, losses = translated(KRL, "kin.src", "krl", "urscript", ROBOT)
    assert not losses
    assert outputs(files, "urscript", ROBOT) == {f"digital_out[{n}]" for n in range(4)}


@pytest.mark.parametrize("start", ["INVERSE(p,start,error)", "FORWARD(q,error)"])
def test_other_functions_become_those(start: str) -> None:
    files, losses = translated(RAPID, "k.mod", "rapid", "krl", "abb_irb1200_5_90")
    assert not losses
    assert any(f"={start}\nIF error<>0 THEN\n  HALT" in text.replace("\r", "") for _, text in files)
    assert outputs(files, "krl", "abb_irb1200_5_90") == {"$OUT[1]", "$OUT[2]"}


def test_one_joint_now() -> None:
    text = "ENTRY main\nPROCEDURE main()\n  SET do[1] TO $actual_joint[3] > 80\nEND PROCEDURE\n"
    files, losses = translated(text, "t.rpl", "rpl", "krl", ROBOT)
    assert not losses
    assert any("$AXIS_ACT.A3" in one for _, one in files)

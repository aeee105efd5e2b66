"""Program displacement: PDispSet, PDispOff, PDispOn lie between work object and targets of the task's moves.

Reference manual, instructions PDispSet and PDispOn, functions CRobT, CalcRobT and CalcJointT: places are read and given
in the outermost coordinate system, which is the displaced one; MoveAbsJ does not care; several PDispOn add up.
"""

import pytest
from rapid_helpers import read, statement, written

from rpl import ir, registry
from rpl.diagnostics import Diagnostics, Severity
from rpl.project import read_sources
from rpl.proof.recording import record_of
from rpl.proof.wiring import with_signal_names
from rpl.simulation import run_program
from rpl.source import source_from_bytes, source_from_text
from rpl.translation import translate_program

ROBOT = "abb_irb1200_5_90"
COUNT = 7
OFF = ir.System("null_frame")
HERE = ir.System("displacement")
CHECKS = """MODULE PD
  CONST robtarget p1:=[[400,0,400],[0,0,1,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
  CONST robtarget p2:=[[400,100,400],[0,0,1,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
  CONST jointtarget jHome:=[[0,0,0,0,30,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
  CONST pose shift:=[[50,20,-30],[1,0,0,0]];
  PERS tooldata tGrip:=[TRUE,[[0,0,120],[1,0,0,0]],[1.5,[0,0,60],[1,0,0,0],0,0,0]];
  PERS wobjdata wTray:=[FALSE,TRUE,"",[[50,-50,0],[1,0,0,0]],[[0,0,0],[1,0,0,0]]];
  VAR pose turned;

  PROC main()
    VAR robtarget here;
    VAR jointtarget jt;
    VAR pos p;
    ConfL\\Off;
    ConfJ\\Off;
    MoveAbsJ jHome,v500,fine,tGrip;
    MoveJ p1,v500,fine,tGrip;
    ! 1 moved
    PDispSet shift;
    MoveL p1,v300,fine,tGrip;
    PDispOff;
    here:=CRobT(\\Tool:=tGrip\\WObj:=wobj0);
    IF NearPos(here.trans,[450,20,370]) SetDO do1,1;
    ! 2 read in the displaced frame
    PDispSet shift;
    here:=CRobT(\\Tool:=tGrip\\WObj:=wobj0);
    p:=CPos(\\Tool:=tGrip\\WObj:=wobj0);
    IF NearPos(here.trans,[400,0,400]) AND NearPos(p,[400,0,400]) SetDO do2,1;
    ! 3 turned, in a work object, in a routine
    turned:=[[100,0,0],OrientZYX(30,0,0)];
    PDispSet turned;
    Work;
    PDispOff;
    here:=CRobT(\\Tool:=tGrip\\WObj:=wTray);
    IF NearPos(here.trans,[100+400*Cos(30)-50*Sin(30),400*Sin(30)+50*Cos(30),350]) SetDO do3,1;
    MoveJ p1,v500,fine,tGrip;
    ! 4 to where the robot stands
    MoveL Offs(p1,30,40,-50),v300,fine,tGrip;
    PDispOn p1,tGrip;
    MoveL p2,v300,fine,tGrip;
    PDispOff;
    here:=CRobT(\\Tool:=tGrip\\WObj:=wobj0);
    IF NearPos(here.trans,[430,140,350]) SetDO do4,1;
    ! 5 they add up
    PDispOn\\ExeP:=Offs(p1,0,0,-20),p1,tGrip;
    PDispOn\\ExeP:=Offs(p1,0,10,-20),p1,tGrip;
    MoveL p1,v300,fine,tGrip;
    PDispOff;
    here:=CRobT(\\Tool:=tGrip\\WObj:=wobj0);
    IF NearPos(here.trans,[400,10,360]) SetDO do5,1;
    ! 6 with the rotation
    PDispOn\\Rot\\ExeP:=RelTool(p1,0,0,50\\Rz:=-20),p1,tGrip;
    MoveL p2,v300,fine,tGrip;
    PDispOff;
    here:=CRobT(\\Tool:=tGrip\\WObj:=wobj0);
    IF Abs(here.trans.z-350)<0.5 AND Abs(here.trans.x-400)>5 SetDO do6,1;
    ! 7 joint moves do not care
    PDispSet shift;
    MoveAbsJ jHome,v500,fine,tGrip;
    PDispOff;
    jt:=CJointT();
    IF Abs(jt.robax.rax_5-30)<0.1 AND Abs(jt.robax.rax_1)<0.1 SetDO do7,1;
  ENDPROC

  PROC Work()
    MoveJ Offs(p1,0,50,0),v300,z10,tGrip\\WObj:=wTray;
    MoveL Offs(p1,0,50,-50),v300,fine,tGrip\\WObj:=wTray;
  ENDPROC

  FUNC bool Near(num x,num y)
    RETURN Abs(x-y)<0.5;
  ENDFUNC

  FUNC bool NearPos(pos x,pos y)
    RETURN Near(x.x,y.x) AND Near(x.y,y.y) AND Near(x.z,y.z);
  ENDFUNC
ENDMODULE
"""


@pytest.mark.parametrize(
    ("text", "value"),
    [
        ("PDispSet shift;", ir.Name("shift")),
        ("PDispOff;", OFF),
        ("PDispSet C_PROGDISP.pdisp;", HERE),
    ],
)
def test_what_is_set(text: str, value: ir.Expression) -> None:
    assert statement(text) == ir.Assign(HERE, value)


@pytest.mark.parametrize(
    "text",
    [
        "PDispSet shift;",
        "PDispOff;",
        "PDispOn p1,tGrip;",
        "PDispOn\\Rot,p1,tGrip\\WObj:=wTray;",
        "PDispOn\\ExeP:=p2,p1,tool0;",
        "PDispOn\\Rot\\ExeP:=p2,p1,tool0;",
        "PDispSet PoseMult(C_PROGDISP.pdisp,shift);",
    ],
)
def test_written_as_it_was(text: str) -> None:
    data = CHECKS[: CHECKS.index("  PROC main")]
    result, _ = read(f"{data}PROC main()\n{text}\nENDPROC\nENDMODULE")
    again, diagnostics = written(result.program)
    assert text in again and not diagnostics.has_errors


@pytest.mark.parametrize("option", ["EOffsSet", "EOffsOn"])
def test_offsets_of_external_axes_are_not_known(option: str) -> None:
    found = statement(f"{option} [100,9E9,9E9,9E9,9E9,9E9];")
    assert isinstance(found, ir.Vendor) and found.effect == "unknown"


@pytest.mark.parametrize("target", ["", *registry.target_names()])
def test_every_language_goes_there(target: str) -> None:
    diagnostics = Diagnostics()
    found = read_sources([source_from_text("pd.mod", CHECKS)], "rapid", diagnostics)
    program, entry = found.program, "main"
    if target:
        done = translate_program(found, target, ROBOT, None, diagnostics)
        assert not diagnostics.of(Severity.LOSS)
        files = [source_from_bytes(one.path, one.data) for one in done.files]
        program = with_signal_names(read_sources(files, target, diagnostics).program, done.program)
        entry = done.renamed.get(entry, entry)
    assert not diagnostics.has_errors
    result = run_program(program, ROBOT, None, entry, 60.0)
    assert result.status == "finished", result.fault
    outputs = [each for kinds in record_of(result, program).tasks.values() for each in kinds if each.kind == "output"]
    names = {name for each in outputs for name in each.names if name.startswith("digital_out:")}
    assert names == {f"digital_out:{number}" for number in range(1, COUNT + 1)}

"""Single words and options of the reference manual: each holds in a run, or is kept as the controller's own."""

import pytest
from rapid_helpers import module

from rpl import ir, registry
from rpl.cell import parse_cell
from rpl.diagnostics import Diagnostics, Severity
from rpl.project import read_sources
from rpl.simulation import run_program
from rpl.source import source_from_bytes, source_from_text
from rpl.translation import translate_program

POINT = "CONST robtarget p1:=[[450,0,400],[0,0,1,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]];"
TOOL = "PERS tooldata tGrip:=[TRUE,[[0,0,120],[1,0,0,0]],[1,[0,0,60],[1,0,0,0],0,0,0]];"
ARM = "abb_irb1200_5_90"
# What is done, the expectation, what is declared.
WORDS = {
    "ByteToStr": (
        "",
        'ByteToStr(122)="122" AND ByteToStr(b\\Hex)="7A" AND ByteToStr(b\\Okt)="172" AND ByteToStr(b\\Bin)="01111010"',
        "VAR byte b:=122;",
    ),
    "StrFormat": ('s:=StrFormat("{1} of {2}!"\\Arg1:="a"\\Arg2:=s);', 's="a of b!"', 'VAR string s:="b";'),
    "GetTime": ("", "GetTime(\\Month)>=1 AND GetTime(\\Month)<=12 AND GetTime(\\Hour)<24 AND GetTime(\\Sec)<60", ""),
    "DefDFrame": (
        "a:=DefDFrame(p1,Offs(p1,50,0,0),Offs(p1,0,50,0),p1,Offs(p1,0,50,0),Offs(p1,-50,0,0));",
        "Abs(EulerZYX(\\Z,a.rot)-90)<0.01 AND Distance(PoseVect(a,p1.trans+[10,0,0]),p1.trans+[0,10,0])<0.01",
        "VAR pose a;",
    ),
    "ORobT": (
        "PDispSet [[10,0,0],[1,0,0,0]];\nq:=ORobT(p1);\nr:=ORobT(p1\\InPDisp);\nPDispOff;",
        "Abs(q.trans.x-460)<0.01 AND Abs(r.trans.x-450)<0.01",
        "VAR robtarget q;VAR robtarget r;",
    ),
    "CSpeedOverride": ("SpeedRefresh 40;\nn:=CSpeedOverride();\nSpeedRefresh 100;", "n=40", "VAR num n;"),
    "MaxRobSpeed": ("", "MaxRobSpeed()=vmax.v_tcp", ""),
    "CallByVar": ('CallByVar "Job",2;', "n=22", "VAR num n;"),
    "WaitTestAndSet": ("WaitTestAndSet free;", "free", "PERS bool free:=FALSE;"),
    "UIMsgWrite": ('UIMsgWrite "busy"\\MsgLine2:="now"\\Icon:=iconInfo;\nUIMsgWriteAbort;', "TRUE", ""),
    "UIDnumEntry": ('n:=UIDnumEntry(\\Message:="n"\\MinValue:=1);', "n=5", "VAR dnum n;"),
    "WaitDI \\Visualize": ('WaitDI di20,1\\Visualize\\Header:="part"\\Message:="wait"\\Icon:=iconInfo;', "TRUE", ""),
    "MoveLGO \\Value": (
        "MoveJ p1,v500,fine,tGrip;\nMoveLGO Offs(p1,0,30,0),v300,fine,tGrip,go1\\Value:=6;",
        "GOutput(go1)=6",
        "",
    ),
    "SearchL \\HighLevel, there already": (
        "MoveJ p1,v500,fine,tGrip;\nSearchL\\Stop,di20\\HighLevel,q,Offs(p1,0,50,0),v50,tGrip;",
        "Abs(q.trans.y)<0.1",
        "VAR robtarget q;",
    ),
    "SearchL \\LowLevel, not yet": (
        "MoveJ p1,v500,fine,tGrip;\nSearchL\\Stop,di20\\LowLevel,q,Offs(p1,0,500,0),v20,tGrip;",
        "q.trans.y>1 AND q.trans.y<400",
        "VAR robtarget q;",
    ),
    "records of events": (
        't{1}.used:=TRUE;\nt{1}.signalname:="do31";\nt{1}.equiplag:=0.1;',
        "t{1}.used",
        "VAR triggios t{2};",
    ),
    "ResetRetryCount": ("ResetRetryCount;\nHollowWristReset;", "TRUE", ""),
    "Open, Close": ('Open "HOME:"\\File:="LOG.TXT",f\\Write;\nWrite f,"x";\nClose f;', "TRUE", "VAR iodev f;"),
}
CELL = """
[[input]]
time = 0.0
signal = "di20"
value = true
[[input]]
time = 9.0
signal = "di20"
value = false
[[answer]]
answer = 5
"""


def program_of(word: str) -> str:
    done, expectation, declared = WORDS[word]
    called = "PROC Job2()\nn:=22;\nENDPROC" if "Job" in done else ""
    return f"""MODULE m
{POINT}
{TOOL}
{declared}
PROC main()
{done}
IF {expectation} SetDO do1,1;
ENDPROC
{called}
ENDMODULE
"""


def holds(program: ir.Program) -> bool:
    run = run_program(program, ARM, parse_cell(CELL, "cell.toml"))
    assert run.status == "finished", run.fault
    return True in [value for _, name, value in run.outputs if name == "do1"]


@pytest.mark.parametrize("word", WORDS)
def test_a_word_of_the_manual_holds_in_a_run_and_written_again(word: str) -> None:
    diagnostics = Diagnostics()
    read = read_sources([source_from_text("m.mod", program_of(word))], "rapid", diagnostics)
    assert not diagnostics.has_errors, [item.as_text() for item in diagnostics]
    assert holds(read.program)
    written = translate_program(read, "rapid", ARM, None, diagnostics)
    assert not diagnostics.of(Severity.LOSS), [item.as_text() for item in diagnostics]
    sources = [source_from_bytes(file.path, file.data) for file in written.files]
    again = read_sources(sources, "rapid", diagnostics)
    assert holds(again.program), written.files[0].data.decode("latin-1")


@pytest.mark.parametrize(
    "text",
    [
        "STClose gun1,1000,5;",
        "SetupCyclicBool flag1,di1=1;",
        "MotionProcessModeSet ACCURACY_MODE;",
        "TriggLIOs p1,v100\\TriggData1:=t,fine,tGrip;",
        "CapL p1,v100,c1,w1,z10,tGrip;",
    ],
)
def test_what_only_this_controller_has_is_kept_word_for_word(text: str) -> None:
    (only,) = module(f"MODULE m\nPROC main()\n{text}\nENDPROC\nENDMODULE\n").routines[0].body
    assert isinstance(only, ir.Vendor)
    assert only.text == text
    assert only.effect == "unknown"


@pytest.mark.parametrize("name", ["GetNextMechUnit", "TaskIsActive", "StrFind", "RemainingRetries", "CalcRotAxisFrame"])
def test_installed_functions_are_declared(name: str) -> None:
    prelude = registry.dialect("rapid").prelude()
    assert prelude is not None
    assert name.lower() in {routine.name.lower() for routine in prelude.routines}

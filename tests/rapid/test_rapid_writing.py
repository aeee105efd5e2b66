"""Writing: what is read is written so that it means the same when read again; what cannot be said is guarded."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from rapid_helpers import normal, read_back, without_remarks, written

from rpl import ir
from rpl.diagnostics import Severity

SAMPLES = sorted((Path(__file__).parents[2] / "samples" / "rapid").glob("*/*.[ms][oy][ds]"))

EVERYTHING = r"""%%%
  VERSION:1
  LANGUAGE:ENGLISH
%%%
MODULE Everything(SYSMODULE,NOVIEW)
  RECORD box
    num w;
    pos corners{4};
  ENDRECORD
  LOCAL RECORD inner
    box one;
  ENDRECORD
  ALIAS num level;
  LOCAL VAR box b1:=[3,[[0,0,0],[1,0,0],[1,1,0],[0,1,0]]];
  PERS num kept;
  TASK PERS tooldata tGrip:=[TRUE,[[0,0,120],[1,0,0,0]],[1.2,[0,0,60],[1,0,0,0],0,0,0]];
  PERS wobjdata wCell:=[FALSE,TRUE,"",[[400,0,0],[1,0,0,0]],[[0,0,0],[1,0,0,0]]];
  CONST num g{2,3}:=[[1,2,-3],[4.50,5E2,.5]];
  CONST robtarget p:=[[1.500,-2,3],[0,0,1,0],[-1,0,-3,0],[9E+09,9E9,9E9,9E9,9E9,9E9]];
  VAR speeddata sOwn:=[120,500,5000,1000];
  VAR zonedata zOwn:=[FALSE,12,18,18,1.8,18,1.8];
  VAR intnum i1;
  VAR clock c1;
  VAR socketdev s1;
  VAR triggdata t1;
  VAR triggdata t2;
  VAR bool ok;
  VAR string s;
  VAR num n;
  VAR robtarget now;
  VAR jointtarget j;
  VAR pose pe;

  PROC main()
    VAR num a{2}:=[1,2];
    n:=-n*2+a{1} DIV 2-(3-n)/4 MOD 5;
    ok:=NOT (n=1 AND ok) OR (NOT ok XOR n<>2);
    ok:=NOT ok AND n>1;
    ok:=(NOT ok) AND n<=-1;
    s:="a""b\\c\0A"+NumToStr(n,2)+ValToStr(ok);
    b1.corners{2}.x:=g{2,3};
    now.trans:=p.trans+[1,2,3]*2;
    now.robconf.cf1:=0;
    now.extax.eax_b:=9E9;
    j.robax.rax_3:=j.robax.rax_3+1;
    tGrip.tload.mass:=2;
    wCell.uframe.rot:=OrientZYX(10,20,30);
    sOwn.v_tcp:=100;
    pe:=PoseMult(PoseInv(pe),[[1,2,3],[1,0,0,0]]);
    pe.trans:=PoseVect(pe,pe.trans);
    now:=RelTool(Offs(p,1,2,3),0,0,4\Rz:=90);
    now:=CalcRobT(CJointT(),tGrip\WObj:=wCell);
    j:=CalcJointT(p,tGrip);
    now:=CRobT(\WObj:=wCell);
    now:=CRobT(\Tool:=tGrip\WObj:=wCell);
    pe:=DefFrame(p,now,p\Origin:=1);
    pe:=DefFrame([[1,2,3],[1,0,0,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]],now,p);
    n:=Round(Distance(p.trans,now.trans)\Dec:=2)+VectMagn(p.trans)+Pow(2,n)+EulerZYX(\Y,pe.rot);
    n:=StrFind(s,1,STR_DIGIT)+StrMatch(s,1,"x")+StrLen(StrMap(StrPart(s,1,2),STR_LOWER,STR_UPPER));
    ok:=StrToVal(s,n) AND StrMemb(s,1,"ab") AND StrOrder(s,"b",STR_UPPER);
    n:=GetTime(\Hour)+ClkRead(c1)+ERRNO;
    MoveAbsJ [[0,0,0,0,30,0],[9E9,9E9,9E9,9E9,9E9,9E9]]\NoEOffs,v1000,fine,tGrip;
    MoveAbsJ j,sOwn,zOwn,tGrip;
    MoveJ\Conc,p\ID:=10,v100\V:=50,z10\Z:=3\Inpos:=inpos50,tGrip\WObj:=wCell\TLoad:=load0;
    MoveL Offs(p,0,0,10),v100\T:=4,z10,tGrip\WObj:=wCell;
    MoveC p,now,v100,z10,tGrip;
    MoveLDO p,v100,z10,tGrip,do1,1;
    MoveJGO p,v100,z10,tGrip,go1,5;
    MoveLSync p,v100,z10,tGrip,"other";
    MoveExtJ j,v100,z10;
    SearchL\PStop,di5\Flanks,now,Offs(p,0,0,-100),v50,tGrip\WObj:=wCell;
    SearchC di5,now,p,now,v50,tGrip;
    TriggIO t1,10\Start\DOp:=doGun,1;
    TriggIO t1,n\Time\GOp:=go1,n;
    TriggIO t1,0\DOp:=doGun,0\DODelay:=0.1;
    TriggEquip t2,10,0.2\AOp:=ao1,n*2;
    TriggInt t2,5,i1;
    TriggL p,v100,t1\T2:=t2,z10,tGrip;
    ConfJ\Off;
    ConfL\On;
    SingArea\Wrist;
    AccSet 50,60;
    AccSet 50,60\FinePointRamp:=70;
    VelSet 50,800;
    GripLoad load0;
    IF di1=1 AND (gi1=3 OR lamp=0) THEN
      Set lamp;
    ELSEIF n=3 THEN
    ELSE
      SetDO do1,n;
      SetDO do1,di1;
      SetDO\SDelay:=0.2,do2,1;
      SetGO go1,3;
      SetAO ao1,n/2;
      InvertDO do1;
      PulseDO do1;
      PulseDO\High\PLength:=1,do1;
    ENDIF
    FOR i FROM 1 TO 10 STEP 2 DO
      FOR k FROM n TO 1 DO
        Incr n;
        Add n,i*k;
        Decr n;
        Clear n;
      ENDFOR
    ENDFOR
    WHILE n<3 AND NOT ok DO
      n:=n+1;
    ENDWHILE
    TEST s
    CASE "a","%":
      GOTO lab;
    CASE "!;":
    DEFAULT:
      TPWrite "a"\Num:=n;
      TPErase;
      TPReadFK n,"?","Yes","No",stEmpty,stEmpty,stEmpty\MaxTime:=3;
      TPReadNum n,"how many";
      UIMsgBox\Header:="h","m"\MsgLine2:="l";
      ErrWrite "head","text";
      ErrWrite\I,"head","text"\RL2:=s;
    ENDTEST
  lab:
    CONNECT i1 WITH trap1;
    ISignalDI\Single,di3,0,i1;
    ISignalDO do1,edge,i1;
    ITimer\Single,2,i1;
    IPers kept,i1;
    ISleep i1;
    IWatch i1;
    IDelete i1;
    IDisable;
    IEnable;
    WaitDI di3,1\MaxTime:=10;
    WaitDO do1,0;
    WaitUntil\InPos,di3=1 AND n=3\MaxTime:=2\TimeFlag:=ok;
    WaitAI ai1,\GT,5;
    WaitTime\InPos,0.5;
    WaitTime n;
    WaitRob\InPos;
    ClkReset c1;
    ClkStart c1;
    ClkStop c1;
    %"proc"+NumToStr(n,0)% n\opt:=3;
    sub n,a\scale:=3;
    sub n,a\on;
    IF TRUE RETURN;
    SocketSend s1\Str:="x;y";
    StopMove\Quick;
    StorePath;
    RestoPath;
    ClearPath;
    StartMove;
    Stop;
    ExitCycle;
    EXIT;
  ERROR (ERR_WAIT_MAXTIME,12)
    RETRY;
  ERROR
    IF ERRNO=5 TRYNEXT;
    RAISE n;
    RAISE;
  UNDO
    Reset do1;
  BACKWARD
    n:=0;
  ENDPROC

  LOCAL FUNC bool isIn(num a{*,*},INOUT pos q\switch On | switch Off\num x,VAR signaldo sg,PERS tooldata t)
    IF Present(x) RETURN a{1,1}=x;
    Set sg;
    WaitDO sg,1;
    MoveL p,v100,fine,t;
    isIn2 a\x?x;
    RETURN TRUE;
  ENDFUNC

  PROC sub(INOUT num x,num a{*}\num scale\switch on)
  ENDPROC

  TRAP trap1
    n:=INTNO;
  ENDTRAP
ENDMODULE
"""


def test_everything_that_is_read_is_written_and_means_the_same() -> None:
    program = normal(EVERYTHING)
    text, diagnostics = written(program)
    assert not diagnostics.of(Severity.LOSS), [item.as_text() for item in diagnostics]
    assert without_remarks(read_back(program)) == without_remarks(program), text


@pytest.mark.parametrize("path", SAMPLES, ids=lambda path: path.stem)
def test_samples_mean_the_same_when_written_anew(path: Path) -> None:
    program = normal(path.read_text("utf-8"))
    assert without_remarks(read_back(program)) == without_remarks(program)


def test_writing_is_stable() -> None:
    once, _ = written(normal(EVERYTHING))
    twice, _ = written(normal(once))
    assert once == twice


def test_remarks_travel() -> None:
    text = """! file
MODULE m ! head
  ! data
  VAR num n; ! count

  ! the routine
  PROC main() ! start
    ! before
    n:=1; ! behind
    IF n=1 THEN ! choice
      ! inside
    ENDIF
    ! last
  ENDPROC
ENDMODULE
"""
    lines = [line.strip() for line in written(normal(text))[0].splitlines() if line.strip()]
    for remark in ("! file", "! data", "! the routine", "! before", "! inside", "! last"):
        assert remark in lines
    for line in (
        "MODULE m ! head",
        "VAR num n; ! count",
        "PROC main() ! start",
        "n:=1; ! behind",
        "IF n=1 THEN ! choice",
    ):
        assert line in lines


def program_of(*body: ir.Statement, declarations: tuple[ir.Declaration, ...] = ()) -> ir.Program:
    routine = ir.Routine("main", body=body)
    return ir.Program((ir.Module("m", "rapid", declarations, (routine,)),))


@pytest.mark.parametrize(
    ("statement", "code"),
    [
        (ir.Opaque("what is this"), "unread-instruction"),
        (ir.Vendor("krl", "ARCON()", "unknown"), "other-controllers-instruction"),
        (ir.Loop((ir.Assign(ir.Name("n"), ir.IntLiteral(1)),)), "not-written"),
        (ir.Move("linear", ir.Name("p"), relative="tool"), "not-written"),
        (ir.Assign(ir.Signal("digital_out", ir.IntLiteral(5)), ir.BoolLiteral(True)), "not-written"),
        (ir.If(((ir.EnumLiteral("red"), (ir.Halt(),)),)), "not-written"),
        (ir.ResumeLevel(), "not-written"),
    ],
)
def test_what_cannot_be_said_is_guarded(statement: ir.Statement, code: str) -> None:
    text, diagnostics = written(program_of(statement))
    assert [item.code.name for item in diagnostics] == [code]
    lines = [line.strip() for line in text.splitlines()]
    assert "Stop;" in lines
    assert any(line.startswith("! not carried over") for line in lines)


@pytest.mark.parametrize(
    ("expression", "text"),
    [
        (ir.RealLiteral(0.1), "0.1"),
        (ir.RealLiteral(1e-12), "1E-12"),
        (ir.RealLiteral(-0.0), "0"),
        (ir.RealLiteral(9e9, "9E9"), "9E9"),
        (ir.RealLiteral(9e9), "9E9"),
        (ir.RealLiteral(100.0, "1E2"), "1E2"),
        (ir.RealLiteral(2.0, "2.0E0x"), "2"),
        (ir.IntLiteral(31, "'H1F'"), "31"),
        (ir.Binary("*", ir.Binary("+", ir.Name("a"), ir.Name("b")), ir.Name("c")), "(a+b)*c"),
        (ir.Binary("+", ir.Name("a"), ir.Binary("*", ir.Name("b"), ir.Name("c"))), "a+b*c"),
        (ir.Binary("-", ir.Name("a"), ir.Binary("-", ir.Name("b"), ir.Name("c"))), "a-(b-c)"),
        (ir.Unary("not", ir.Binary("cand", ir.Name("a"), ir.Name("b"))), "NOT (a AND b)"),
        (ir.Binary("cand", ir.Unary("not", ir.Name("a")), ir.Name("b")), "(NOT a) AND b"),
        (ir.Quantity(ir.RealLiteral(0.5), "m/s"), "500"),
        (ir.TextLiteral('say "x" \\ \n'), '"say ""x"" \\\\ \\0A"'),
        (ir.Signal("digital_in", name="part"), "part=1"),
        (ir.Unary("not", ir.Signal("digital_out", name="lamp")), "DOutput(lamp)=0"),
        (ir.Convert("bit", ir.Signal("digital_out", name="doLamp")), "doLamp"),
        (ir.Aggregate(tuple((None, ir.RealLiteral(v)) for v in (1.0, 2.5))), "[1,2.5]"),
    ],
)
def test_expressions(expression: ir.Expression, text: str) -> None:
    whole, diagnostics = written(program_of(ir.Assign(ir.Name("x"), expression)))
    assert not diagnostics.items
    assert f"x:={text};" in whole


def test_texts_are_cut_to_what_the_controller_takes() -> None:
    text, diagnostics = written(program_of(ir.Message("write", ir.TextLiteral("x" * 100))))
    assert [item.code.name for item in diagnostics] == ["text-cut"]
    assert f'TPWrite "{"x" * 80}";' in text


def test_named_speeds_and_zones_of_their_values() -> None:
    numbers = (("path", 500.0), ("rotation", 500.0), ("linear_external", 5000.0), ("rotary_external", 1000.0))
    speed = ir.Aggregate(tuple((name, ir.RealLiteral(value)) for name, value in numbers), "speed")
    move = ir.Move("linear", ir.Name("p"), speed=ir.Speed(speed), blend=ir.BlendStop())
    text, _ = written(program_of(move))
    assert "MoveL p,v500,fine,tool0;" in text
    slower = replace(speed, entries=(("path", ir.RealLiteral(480.0)), *speed.entries[1:]))
    text, _ = written(program_of(replace(move, speed=ir.Speed(slower))))
    assert "MoveL p,[480,500,5000,1000],fine,tool0;" in text


# ---- generated programs

_names = st.sampled_from(("a", "b", "c"))
_numbers = st.one_of(
    st.integers(0, 9999).map(str),
    st.decimals(0, 9999, places=3, allow_nan=False).map(str),
)
_atoms = st.one_of(_names, _numbers, st.sampled_from(("g{1,2}", "p.trans.x", "Abs(a)", "Round(b\\Dec:=1)")))


@st.composite
def _arithmetic(draw: st.DrawFn, depth: int = 3) -> str:
    if depth == 0 or draw(st.booleans()):
        return draw(_atoms)
    left, right = draw(_arithmetic(depth - 1)), draw(_arithmetic(depth - 1))
    if draw(st.booleans()):
        left = f"({left})"
    if draw(st.booleans()):
        right = f"({right})"
    sign = draw(st.sampled_from(("+", "-", "*", "/", " DIV ", " MOD ")))
    minus = draw(st.sampled_from(("", "", "-")))
    return f"{minus}{left}{sign}{right}" if minus == "" else f"(-{left}{sign}{right})"


@st.composite
def _logic(draw: st.DrawFn, depth: int = 2) -> str:
    if depth == 0 or draw(st.booleans()):
        relation = draw(st.sampled_from(("=", "<>", "<", ">", "<=", ">=")))
        return draw(
            st.one_of(
                st.sampled_from(("ok", "TRUE", "di1=1", "doX=0", "(NOT ok)")),
                st.tuples(_arithmetic(1), _arithmetic(1)).map(relation.join),
            )
        )
    left, right = draw(_logic(depth - 1)), draw(_logic(depth - 1))
    word = draw(st.sampled_from((" AND ", " OR ", " XOR ")))
    front = draw(st.sampled_from(("", "", "NOT ")))
    return f"({front}{left}{word}{right})"


@st.composite
def _statements(draw: st.DrawFn, depth: int = 2) -> str:
    lines = []
    for _ in range(draw(st.integers(0, 3))):
        kind = draw(st.integers(0, 7 if depth else 4))
        if kind == 0:
            lines.append(f"{draw(_names)}:={draw(_arithmetic())};")
        elif kind == 1:
            lines.append(f"MoveL Offs(p,{draw(_arithmetic(1))},0,{draw(_atoms)}),v100,z10,tool0;")
        elif kind == 2:
            lines.append(f"SetDO doX,{draw(st.sampled_from(('0', '1', 'a', 'di1')))};")
        elif kind == 3:
            lines.append(f"WaitTime {draw(_numbers)};")
        elif kind == 4:
            lines.append(f"ok:={draw(_logic())};")
        else:
            inner = draw(_statements(depth - 1))
            lines.append(
                (
                    f"IF {draw(_logic())} THEN\n{inner}ELSE\n{inner}ENDIF",
                    f"FOR i FROM {draw(_arithmetic(1))} TO {draw(_atoms)} DO\n{inner}ENDFOR",
                    f"TEST {draw(_arithmetic(1))}\nCASE {draw(_numbers)},-1:\n{inner}DEFAULT:\n{inner}ENDTEST",
                )[kind - 5]
            )
    return "".join(f"{line}\n" for line in lines)


@settings(max_examples=150, deadline=None)
@given(_statements())
def test_generated_programs_mean_the_same_when_written_anew(body: str) -> None:
    data = "VAR num a;\nVAR num b;\nVAR num c;\nVAR bool ok;\nVAR num g{2,2};\nVAR robtarget p;\n"
    program = normal(f"MODULE m\n{data}PROC main()\n{body}ENDPROC\nENDMODULE\n")
    assert without_remarks(read_back(program)) == without_remarks(program)


def test_the_end_of_a_routine_behind_a_condition_is_one_line() -> None:
    body = (ir.If(((ir.BoolLiteral(True), (ir.Return(),)),)), ir.Halt("stop"))
    assert "IF TRUE RETURN;" in written(program_of(*body))[0]

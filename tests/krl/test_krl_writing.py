"""KRL as a target: same-language round trips, bracketing, numbers, guarded stops."""

from __future__ import annotations

import math

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from krl_helpers import read, round_trip, written

from rpl import ir
from rpl.diagnostics import Severity
from rpl.registry import dialect
from rpl.source import source_from_bytes

CORE = """&ACCESS RVP
&REL 2
; before the routine
DEF P(A:IN,B[]:OUT,C)
INT A
CHAR B[]
REAL C
DECL INT I,J
DECL BOOL F
DECL E6POS Q
DECL E6AXIS HOME
;FOLD INI;%{PE}
BAS(#INITMOV,0)
;ENDFOLD
I=4+5*3-B_NOT A/2
F=(I>3) AND NOT $IN[4]
C=I/2.0 ;behind
$VEL.CP=0.25
$VEL={CP 0.5,ORI1 100.0,ORI2 100.0}
$APO.CDIS=10
$VEL_AXIS[1]=50
$ORI_TYPE=#CONSTANT
$CIRC_TYPE=LDAT_ACT.CIRC_TYP
$TIMER[1]=0
$TIMER_STOP[1]=FALSE
$BASE=BASE_DATA[1]:{X 10.0,Y 0.0,Z 0.0,A 0.0,B 0.0,C 0.0}
HOME={A1 0.0,A2 -90.0,A3 90.0,A4 0.0,A5 0.0,A6 0.0}
HOME.A1=10
Q.X=1.5
Q.S=2
PTP HOME
PTP {A1 10} C_PTP C_DIS
LIN Q C_DIS C_ORI
LIN_REL {Z -10.0} C_VEL #TOOL
PTP_REL {A3 5.0}
PTP_REL {X 5.0} #BASE
CIRC Q,{X 5.0},CA 180
SLIN Q WITH $VEL=SVEL_CP(0.1, ,LDAT_ACT),$TOOL=STOOL2(FDAT_ACT) C_DIS
SPTP Q WITH $VEL_AXIS[1]=SVEL_JOINT(50.0),$APO=SAPO_PTP(PDAT_ACT)
SPLINE
  SPL Q
  TRIGGER WHEN PATH=1.5 DELAY=0 DO $OUT[2]=TRUE
  SLIN Q
ENDSPLINE
TRIGGER WHEN DISTANCE=0 DELAY=20 DO $OUT[1]=TRUE
TRIGGER WHEN PATH=-20 ONSTART DELAY=-10 DO GLUE(TRUE) PRIO=-1
TRIGGER WHEN PATH=5 DELAY=0 DO PULSE($OUT[7],TRUE,0.2)
$OUT_C[5]=FALSE
IF A==1 THEN
  EXIT
ELSE
  IF A==2 THEN
    RETURN
  ENDIF
ENDIF
SWITCH B[1]
  CASE "a","b"
    I=1
  DEFAULT
    I=2
ENDSWITCH
FOR I=10 TO 1 STEP -3
  J=J+I
ENDFOR
REPEAT
  J=J-1
UNTIL J<0
LOOP
  GOTO NEXT
ENDLOOP
NEXT:
INTERRUPT DECL 4 WHEN $IN[3] DO STOPPED(I)
INTERRUPT DECL 5 WHEN $IN[6] DO BRAKE F
INTERRUPT ON 4
INTERRUPT OFF
WAIT SEC 0.5
WAIT FOR $IN[1] OR ($TIMER[1]>2000)
CONTINUE
PULSE($OUT[3],TRUE,0.5)
B[]="text; with a sign"
STRCLEAR(B[])
SWRITE(B[],STATE,I,"%d",J)
F=StrComp(B[],"x",#NOT_CASE_SENS)
IF VARSTATE("C")==#INITIALIZED THEN
  BRAKE F
ENDIF
MsgNotify("part %1","cell",I)
MsgDialog(J,"again?","cell",,,,"yes","no")
GRIPPER_STEP(1,,I)
HALT
END

GLOBAL DEFFCT REAL TWICE(X:IN)
REAL X
RETURN 2*X
ENDFCT
"""
DATA = """DEFDAT P PUBLIC
EXT BAS(BAS_COMMAND:IN,REAL:IN)
; a remark
STRUC PART INT ID,REAL SIZE[3],CHAR LABEL[8]
ENUM COLOUR RED,GREEN
SIGNAL GRIP $OUT[3]
SIGNAL CODE $IN[9] TO $IN[16]
DECL PART ONE={ID 1,LABEL[] "abc"}
DECL GLOBAL CONST INT LIMIT='B1011'
DECL REAL TINY=1.0E-9,ZERO=0.0,MANY=123456.789
DECL CHAR NAMES[3,16]
NAMES[1,]="one"
ONE.SIZE[2]=-1.5
DECL COLOUR PAINT=#GREEN
DECL E6POS XP1={X 1.5,Y -2.0,Z 0.0,A 0.0,B 90.0,C 0.0,S 'B010',T 35,E1 0.0}
ENDDAT
"""


def test_the_core_survives_the_round_trip() -> None:
    first, second, _ = round_trip({"P.src": CORE, "P.dat": DATA})
    assert first == second


def test_what_was_written_is_written_alike_again() -> None:
    _, _, text = round_trip({"P.src": CORE, "P.dat": DATA})
    program, _ = read({"P.src": CORE, "P.dat": DATA})
    out, _ = written(program)
    again = dialect("krl").read([source_from_bytes(f.path, f.data) for f in out], _).program
    second, _ = written(again)
    assert [file.data for file in out] == [file.data for file in second]
    assert ";FOLD INI;%{PE}" in text and "; before the routine" in text and "C=I/2.0 ;behind" in text


BRACKETS = [
    ("X=A+(B*C)", "X=A+B*C"),
    ("X=(A>5) AND (B<3)", "X=(A>5) AND (B<3)"),
    ("X=A AND B OR C", "X=(A AND B) OR C"),
    ("X=NOT (A AND B)", "X=NOT (A AND B)"),
    ("X=A-(B-C)", "X=A-(B-C)"),
    ("X=A*-B", "X=A*(-B)"),
    ("X=(A:B):C", "X=A:B:C"),
    ("X=A:(B:C)", "X=A:(B:C)"),
    ("X=(A+1)>B", "X=A+1>B"),
    ("X=A<=(-3)", "X=A<=-3"),
    ("X=A/B*C", "X=(A/B)*C"),
    ("X=(A>5)==(B<3)", "X=(A>5)==(B<3)"),
]


@pytest.mark.parametrize(("text", "wanted"), BRACKETS)
def test_brackets_stand_where_a_reader_could_doubt(text: str, wanted: str) -> None:
    _, _, out = round_trip(f"DEF P()\nDECL REAL A,B,C\n{text}\nEND\n")
    assert wanted in out


_TYPES = {"N": ir.IntType(), "M": ir.IntType(), "R": ir.RealType()}
DIVISIONS = [
    (ir.IntLiteral(7), ir.IntLiteral(2), "/", "7.0/2"),
    (ir.Name("N"), ir.IntLiteral(2), "/", "N/2.0"),
    (ir.Name("N"), ir.Name("M"), "/", "(1.0*N)/M"),
    (ir.Name("N"), ir.Name("R"), "/", "N/R"),
    (ir.Name("N"), ir.Name("M"), "div", "N/M"),
]


@pytest.mark.parametrize(("left", "right", "op", "wanted"), DIVISIONS)
def test_division_goes_by_its_operands(left: ir.Expression, right: ir.Expression, op: str, wanted: str) -> None:
    declared = tuple(ir.Variable(name, type) for name, type in _TYPES.items())
    assign = ir.Assign(ir.Name("R"), ir.Binary(op, left, right))
    routine = ir.Routine("P", declarations=declared, body=(assign,), scope="global")
    (file,), _ = written(ir.Program((ir.Module("P", "krl", routines=(routine,)),)))
    assert f"R={wanted}\r\n" in file.data.decode()


@given(st.floats(allow_nan=False, allow_infinity=False))
def test_numbers_read_back(value: float) -> None:
    from rpl.postprocessors.krl.expressions import literal

    text = literal(ir.RealLiteral(abs(value)))
    assert float(text) == pytest.approx(abs(value), rel=1e-15)
    assert value == 0 or float(text) != 0
    assert not text.startswith("-") and ("." in text or "e" in text.lower())
    assert math.copysign(1, float(literal(ir.RealLiteral(-0.0)))) == 1


UNSAYABLE = [
    (ir.NextPass(), "NextPass"),
    (ir.Raise(), "Raise"),
    (ir.Vendor("rapid", "SocketSend s1;", "unknown"), "rapid"),
    (ir.Assign(ir.Name("A"), ir.Binary("**", ir.IntLiteral(2), ir.IntLiteral(3))), "**"),
    (ir.Opaque("gibberish ("), "gibberish"),
]


@pytest.mark.parametrize(("statement", "word"), UNSAYABLE)
def test_what_krl_cannot_say_stops_the_program(statement: ir.Statement, word: str) -> None:
    routine = ir.Routine("P", body=(statement, ir.Halt()), scope="global")
    program = ir.Program((ir.Module("P", "krl", routines=(routine,)),))
    (file,), diagnostics = written(program)
    lines = file.data.decode().split("\r\n")
    assert lines[1].startswith(";") and lines[2:5] == ["HALT", "HALT", "END"]
    (loss,) = list(diagnostics)
    assert loss.severity == Severity.LOSS and word in loss.message


def test_an_array_is_initialised_element_by_element() -> None:
    rows = tuple((None, ir.Aggregate(((None, ir.IntLiteral(n)), (None, ir.IntLiteral(n + 1))))) for n in (1, 3))
    grid = ir.ArrayType(ir.IntType(), (ir.IntLiteral(2), ir.IntLiteral(2)))
    module = ir.Module("D", "krl", (ir.Variable("GRID", grid, ir.Aggregate(rows)),))
    (file,), diagnostics = written(ir.Program((module,)))
    assert not list(diagnostics)
    lines = file.data.decode().split("\r\n")
    assert lines[1:6] == ["DECL INT GRID[2,2]", "GRID[1,1]=1", "GRID[1,2]=2", "GRID[2,1]=3", "GRID[2,2]=4"]


def test_the_first_routine_is_named_like_the_file() -> None:
    routine = ir.Routine("main", body=(), scope="task")
    program = ir.Program((ir.Module("MainModule", "krl", routines=(routine,)),))
    (file,), _ = written(program)
    assert file.path == "MainModule.src"
    assert file.data.decode().split("\r\n")[:4] == ["DEF MainModule( )", "END", "", "GLOBAL DEF main( )"]


# ---- generated programs

_NAMES = st.sampled_from(["A", "B", "C", "N1", "N2"])
_LEAVES = st.one_of(
    st.integers(0, 99).map(str),
    st.floats(0, 99).map(lambda x: f"{x:.3f}"),
    _NAMES,
    st.just("$TIMER[1]"),
    st.just("F(1,,A)"),
)


def _arithmetic(inner: st.SearchStrategy[str]) -> st.SearchStrategy[str]:
    return st.one_of(
        st.tuples(inner, st.sampled_from("+-*/"), inner).map(lambda p: f"({p[0]}){p[1]}({p[2]})"),
        st.tuples(inner, st.sampled_from("+-*/"), inner).map(lambda p: f"{p[0]}{p[1]}{p[2]}"),
        inner.map(lambda x: f"-({x})"),
        inner.map(lambda x: f"ABS({x})"),
    )


NUMBERS = st.recursive(_LEAVES, _arithmetic, max_leaves=6)
RELATIONS = st.tuples(NUMBERS, st.sampled_from(["==", "<>", "<", ">", "<=", ">="]), NUMBERS).map(
    "({0[0]}){0[1]}({0[2]})".format
)
CONDITIONS = st.recursive(
    st.one_of(RELATIONS, st.sampled_from(["$IN[3]", "TRUE", "FLAG1"])),
    lambda inner: st.one_of(
        st.tuples(inner, st.sampled_from(["AND", "OR", "EXOR"]), inner).map("({0[0]}) {0[1]} ({0[2]})".format),
        inner.map("NOT ({})".format),
    ),
    max_leaves=4,
)
SIMPLE = st.one_of(
    st.tuples(_NAMES, NUMBERS).map("{0[0]}={0[1]}".format),
    CONDITIONS.map("WAIT FOR {}".format),
    CONDITIONS.map("$OUT[4]={}".format),
    NUMBERS.map("$VEL.CP={}".format),
    st.sampled_from(["PTP XP1 C_PTP", "LIN XP2 C_DIS", "CIRC XP1,XP2,CA 90", "LIN_REL {Z 5} #TOOL", "WAIT SEC 0.1"]),
    st.sampled_from(["HALT", "CONTINUE", "INTERRUPT ON 3", "SUB1(A,,B)", ";only a remark", "PULSE($OUT[1],TRUE,0.3)"]),
)


def _block(inner: st.SearchStrategy[str]) -> st.SearchStrategy[str]:
    many = st.lists(inner, max_size=3).map("\n".join)
    return st.one_of(
        st.tuples(CONDITIONS, many, many).map("IF {0[0]} THEN\n{0[1]}\nELSE\n{0[2]}\nENDIF".format),
        st.tuples(CONDITIONS, many).map("WHILE {0[0]}\n{0[1]}\nENDWHILE".format),
        st.tuples(many, CONDITIONS).map("REPEAT\n{0[0]}\nUNTIL {0[1]}".format),
        st.tuples(NUMBERS, many).map("FOR N1=1 TO {0[0]} STEP 2\n{0[1]}\nENDFOR".format),
        st.tuples(many, many).map("SWITCH N1\nCASE 1,2\n{0[0]}\nDEFAULT\n{0[1]}\nENDSWITCH".format),
        many.map("LOOP\n{}\nEXIT\nENDLOOP".format),
    )


PROGRAMS = st.lists(st.recursive(SIMPLE, _block, max_leaves=8), max_size=6).map("\n".join)
_HEAD = "DEF P()\nDECL REAL A,B,C\nDECL INT N1,N2\nDECL BOOL FLAG1\n"


@given(PROGRAMS)
@settings(max_examples=60, deadline=None, suppress_health_check=[HealthCheck.too_slow])
def test_generated_programs_survive_the_round_trip(text: str) -> None:
    first, second, _ = round_trip(f"{_HEAD}{text}\nEND\n")
    assert first == second

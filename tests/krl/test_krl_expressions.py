"""KRL expressions: documented precedence, literals, aggregates, system variables.

Expectations follow the expert programming manual (KSS 5.2, chapters on operators and aggregates).
"""

from __future__ import annotations

import pytest
from krl_helpers import body, expression, shown, statement

from rpl import ir
from rpl.diagnostics import Diagnostics
from rpl.project import read_sources
from rpl.simulation import run_program
from rpl.source import source_from_text

PRECEDENCE = [
    ("4+5*3-B_NOT B/2", "((4 + (5 * 3)) - ((bnot B) quo 2))"),
    ("7 B_EXOR 3 B_OR 4 B_EXOR 3 B_AND 5", "((7 bxor 3) bor (4 bxor (3 band 5)))"),
    ("TRUE==(5>=B) AND NOT F", "(True = ((5 >= B) and (not F)))"),
    ("-3+A*2>B", "(((- 3) + (A * 2)) > B)"),
    ("(A>5) AND (B<3)", "((A > 5) and (B < 3))"),
    ("A OR B AND C EXOR D", "(A or ((B and C) xor D))"),
    ("A*-B", "(A * (- B))"),
    ("NOT A==B", "((not A) = B)"),
    ("A-B-C", "((A - B) - C)"),
    ("A/B*C", "((A quo B) * C)"),
    ("T[1]:T[2]:P", "((T[1] : T[2]) : P)"),
    ("P:{X -25,Y 0}", "(P : {X (- 25),Y 0})"),
    ("B_NOT 10", "(bnot 10)"),
]


@pytest.mark.parametrize(("text", "wanted"), PRECEDENCE)
def test_documented_precedence(text: str, wanted: str) -> None:
    assert shown(expression(text)) == wanted


LOOSE = [
    ("A>5 AND B<3", "((A > 5) and (B < 3))"),
    ("N==3 OR M==4 AND K==5", "((N = 3) or ((M = 4) and (K = 5)))"),
    ("$MODE_OP==#T1 OR F", "(($MODE_OP = T1) or F)"),
    ("N==M AND F", "((N = M) and F)"),
]


@pytest.mark.parametrize(("text", "wanted"), LOOSE)
def test_c_like_reading_where_the_documented_one_has_no_sense(text: str, wanted: str) -> None:
    found, diagnostics = body(f"X={text}", "DECL INT N,M,K,A,B\nDECL BOOL F")
    (assign,) = found
    assert isinstance(assign, ir.Assign)
    assert shown(assign.value) == wanted
    assert [item.code.name for item in diagnostics] == ["krl-comparison-precedence"]


def test_bools_keep_the_documented_reading() -> None:
    assert shown(expression("F==G AND H", "DECL BOOL F,G,H")) == "(F = (G and H))"


LITERALS = [
    ("'B1011'", 11),
    ("'H5A'", 90),
    ("'HFFFFFFFF'", -1),
    ("'b0'", 0),
    ("1E-08", 1e-8),
    (".5", 0.5),
    ("5.", 5.0),
    ("0007", 7),
]


@pytest.mark.parametrize(("text", "value"), LITERALS)
def test_literals(text: str, value: float) -> None:
    found = expression(text)
    assert isinstance(found, ir.IntLiteral | ir.RealLiteral)
    assert found.value == value
    assert isinstance(found, ir.RealLiteral) == isinstance(value, float)


VALUES = [
    ("$VEL.CP", "<@path_speed m/s>"),
    ("$TIMER[3]", "round_half_away(<@timer ms>)"),
    ("$TIMER[3]/1000", "(round_half_away(<@timer ms>) quo 1000)"),
    ("$ROB_TIMER==5", "(round_half_away(<@time ms>) = 5)"),
    ("$TIMER[3]>N", "(round_half_away(<@timer ms>) > N)"),
    ("$IN[7]", "digital_in:7"),
    ("$IN[1025]", "True"),
    ("$IN[1026]", "False"),
    ("$ANIN[2]", "analog_in:2"),
    ("$POS_ACT", "@actual_pose"),
    ("$AXIS_ACT.A3", "@actual_joints.A3"),
    ("$BASE.X", "@base.X"),
    ("$SOMETHING_ELSE[2].Y", "$SOMETHING_ELSE[2].Y"),
    ("ATAN2(Y,X)", "atan2(Y,X)"),
    ("INV_POS($BASE):P", "(inverse(@base) : P)"),
    ("StrLen(S[])", "text_length(S)"),
    ('StrComp(S[],"ab",#NOT_CASE_SENS)', "text_equal(S,'ab',True)"),
    ("StrFind(1,S[],T[],#CASE_SENS)", "text_find(S,1,T)"),
    ('VARSTATE("N")==#INITIALIZED', "(not is_uninitialised(N))"),
    ("$IPO_MODE==#TCP", "(@interpolation = tool)"),
    ("ROW[2,]", "ROW[2]"),
    ("F(1,,P2)", "F(1,,P2)"),
    ("{FRAME: X 1.0,Y XP1.Y}", "{X 1.0,Y XP1.Y}"),
    ('{MT: VALID FALSE,TYP #NOTIFY,MODUL[] "a;b"}', "{VALID False,TYP NOTIFY,MODUL 'a;b'}"),
]


@pytest.mark.parametrize(("text", "wanted"), VALUES)
def test_values(text: str, wanted: str) -> None:
    assert shown(expression(text)) == wanted


ASSIGNMENTS = [
    ("$VEL.CP=0.5", [("@path_speed", "<0.5 m/s>")]),
    ("$ACC.CP=2", [("@path_acceleration", "<2 m/s2>")]),
    ("$APO.CDIS=10", [("@blend_distance", "10")]),
    ("$VEL_AXIS[1]=50", [("@joint_speed", "50")]),
    ("$TIMER[1]=-500", [("@timer", "<(- 500) ms>")]),
    ("$VEL={CP 0.3,ORI1 100}", [("@path_speed", "<0.3 m/s>"), ("@swivel_speed", "100")]),
    ("$ORI_TYPE=#JOINT", [("@orientation_mode", "wrist")]),
    ("$OUT[3]=TRUE", [("digital_out:3", "True")]),
    ('S[]="abc"', [("S", "'abc'")]),
    ("A.B[2].C=1", [("A.B[2].C", "1")]),
]


@pytest.mark.parametrize(("text", "wanted"), ASSIGNMENTS)
def test_assignments(text: str, wanted: list[tuple[str, str]]) -> None:
    found, diagnostics = body(text)
    assert not list(diagnostics)
    pairs = [(shown(a.target), shown(a.value)) for a in found if isinstance(a, ir.Assign)]
    assert pairs == wanted


def test_a_mode_from_a_variable_is_decided_member_by_member() -> None:
    found = statement("$CIRC_TYPE=LDAT_ACT.CIRC_TYP")
    assert isinstance(found, ir.Switch)
    assert [shown(case.values[0]) for case in found.cases] == ["BASE", "PATH"]


def test_timers_are_compared_with_written_numbers_as_they_are_read() -> None:
    """0.9996 s are 1000 ms, whatever the question."""
    program = """DEF T( )
BAS(#INITMOV,0)
$TIMER[6]=0
$TIMER_STOP[6]=FALSE
WAIT SEC 0.9996
$TIMER_STOP[6]=TRUE
$OUT[1]=($TIMER[6]/1000>=1) AND ($TIMER[6]>=1000) AND NOT ($TIMER[6]<1000)
END
"""
    read = read_sources([source_from_text("t.src", program)], "krl", Diagnostics())
    result = run_program(read.program, "kuka_kr6r900sixx", None, "T", 10.0)
    assert [(name, value) for _, name, value in result.outputs] == [("$OUT[1]", True)]

"""Operators, precedence, numbers and texts: kernel reference, sections on expressions and lexical elements."""

import pytest
from rapid_helpers import expression

from rpl import ir

A, B, C, P, Q = (ir.Name(name) for name in "abcpq")
ONE, TWO = ir.IntLiteral(1), ir.IntLiteral(2)


def binary(op: str, left: ir.Expression, right: ir.Expression) -> ir.Binary:
    return ir.Binary(op, left, right)


@pytest.mark.parametrize(
    ("text", "meaning"),
    [
        ("a+b*c", binary("+", A, binary("*", B, C))),
        ("a-b-c", binary("-", binary("-", A, B), C)),
        ("a DIV b MOD c", binary("mod", binary("div", A, B), C)),
        ("a/b", binary("/", A, B)),
        ("-a*b", ir.Unary("-", binary("*", A, B))),
        ("-a+b", binary("+", ir.Unary("-", A), B)),
        ("a*-1", binary("*", A, ir.Unary("-", ONE))),
        ("(a+b)*c", binary("*", binary("+", A, B), C)),
        ("a=b AND p", binary("cand", binary("=", A, B), P)),
        ("p OR q AND p", binary("cor", P, binary("cand", Q, P))),
        ("p XOR q OR p", binary("cor", binary("xor", P, Q), P)),
        ("NOT p AND q", ir.Unary("not", binary("cand", P, Q))),
        ("NOT p OR q", binary("cor", ir.Unary("not", P), Q)),
        ("p OR NOT p AND q", binary("cor", P, ir.Unary("not", binary("cand", P, Q)))),
        ("(NOT p) AND q", binary("cand", ir.Unary("not", P), Q)),
        ("p AND NOT q", binary("cand", P, ir.Unary("not", Q))),
        ("a+1<b*2", binary("<", binary("+", A, ONE), binary("*", B, TWO))),
        ("not P and Q", ir.Unary("not", binary("cand", ir.Name("P"), ir.Name("Q")))),
    ],
)
def test_precedence(text: str, meaning: ir.Expression) -> None:
    assert expression(text) == meaning


@pytest.mark.parametrize(
    ("text", "value"),
    [
        ("3", ir.IntLiteral(3)),
        ("3.5", ir.RealLiteral(3.5)),
        (".5", ir.RealLiteral(0.5)),
        ("3E2", ir.RealLiteral(300.0)),
        ("1.5e-3", ir.RealLiteral(0.0015)),
        ("9E+09", ir.RealLiteral(9e9)),
        ("12e3", ir.RealLiteral(12000.0)),
        ("0xFF", ir.IntLiteral(255)),
        ("0b0101", ir.IntLiteral(5)),
        ("0o17", ir.IntLiteral(15)),
        ('"a""b"', ir.TextLiteral('a"b')),
        ('""""', ir.TextLiteral('"')),
        (r'"a\\b\0Ac"', ir.TextLiteral("a\\b\nc")),
        ('"!no remark;"', ir.TextLiteral("!no remark;")),
        ("TRUE", ir.BoolLiteral(True)),
    ],
)
def test_literals(text: str, value: ir.Expression) -> None:
    assert expression(text) == value


DI = ir.Signal("digital_in", name="di1")


@pytest.mark.parametrize(
    ("text", "meaning"),
    [
        ("di1=1", DI),
        ("di1=high", DI),
        ("1=di1", DI),
        ("di1=0", ir.Unary("not", DI)),
        ("di1<>1", ir.Unary("not", DI)),
        ("DInput(di1)=1", DI),
        ("TestDI(di1)", DI),
        ("di1+di2", binary("+", ir.Convert("bit", DI), ir.Convert("bit", ir.Signal("digital_in", name="di2")))),
        ("partThere=1", ir.Signal("digital_in", name="partThere")),
        ("doClamp=1", ir.Signal("digital_out", name="doClamp")),
        ("GInput(giType)=7", binary("=", ir.Signal("group_in", name="giType"), ir.IntLiteral(7))),
        ("AOutput(aoFlow)", ir.Signal("analog_out", name="aoFlow")),
        ("a=1", binary("=", A, ONE)),
        ("unknown", ir.Name("unknown")),
    ],
)
def test_signals_are_names_that_nothing_declares(text: str, meaning: ir.Expression) -> None:
    assert expression(text) == meaning


T = ir.Name("t")


@pytest.mark.parametrize(
    ("text", "meaning"),
    [
        ("Offs(t,1,2,a)", ir.Builtin("offset", (T, ONE, TWO, A))),
        ("RelTool(t,1,2,a)", ir.Builtin("tool_offset", (T, ONE, TWO, A))),
        ("RelTool(t,1,2,a\\Ry:=b)", ir.Builtin("tool_offset", (T, ONE, TWO, A, ir.IntLiteral(0), B))),
        ("CRobT()", ir.Builtin("current_target", ())),
        ("CRobT(\\Tool:=t\\WObj:=c)", ir.Builtin("current_target", (T, C))),
        ("CRobT(\\WObj:=c)", ir.Builtin("current_target", (ir.Builtin("current_tool", ()), C))),
        ("CalcJointT(t, a, \\WObj:=c)", ir.Builtin("target_to_joints", (T, A, C))),
        ("CalcRobT(t,a)", ir.Builtin("joints_to_target", (T, A, ir.Name("wobj0")))),
        ("EulerZYX(\\Z,t.rot)", ir.Builtin("euler_z", (ir.Field(T, "rot"),))),
        ("Round(a\\Dec:=2)", ir.Builtin("round", (A, TWO))),
        ("Present(p)", ir.Present("p")),
        ("StrToVal(t,a)", ir.Builtin("parse_value", (T, A))),
        ("ERRNO", ir.System("error_number")),
        ("BitAnd(a,b)", ir.Binary("band", A, B)),
        ("GetTime(\\WDay)", ir.Call("GetTime", (ir.Argument(None, "WDay"),))),
        ("own(a\\x:=b\\on\\y?c)", ir.Call("own", (
            ir.Argument(A), ir.Argument(B, "x"), ir.Argument(None, "on"), ir.Argument(C, "y", "c")))),
        ("t.trans.x", ir.Field(ir.Field(T, "trans"), "x")),
        ("t{a,2}.robconf.cf1", ir.Field(ir.Field(ir.Index(T, (A, TWO)), "robconf"), "cf1")),
        ("[1,[TRUE,-2]]", ir.Aggregate((
            (None, ONE), (None, ir.Aggregate(((None, ir.BoolLiteral(True)), (None, ir.Unary("-", TWO)))))))),
    ],
)  # fmt: skip
def test_functions_and_values(text: str, meaning: ir.Expression) -> None:
    assert expression(text, "VAR num a;VAR num b;VAR num c;VAR robtarget t;") == meaning

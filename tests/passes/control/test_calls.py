"""Functions, operators and texts that a target lacks, by running them in terms of what it has."""

from __future__ import annotations

import math
from typing import Any

import pytest

from rpl import ir
from rpl.library import routines
from rpl.passes.legalise.control.loops import fit_loops
from rpl.passes.legalise.statements.calls import rewrite_calls
from rpl.passes.legalise.statements.logic import decide_logic

from .common import PLAIN, RICH, count, legalised, read, same_run
from .machine import run

_RAPID = """MODULE m
  VAR num n:=3;
  VAR num list{4}:=[1,2,3,4];
  PROC show(num a) TPWrite NumToStr(a,3); ENDPROC
  FUNC string word(num a) IF a>2 RETURN "many"; RETURN "few"; ENDFUNC
  FUNC num count(string t) n:=n+1; RETURN StrLen(t); ENDFUNC
  FUNC num noisy(num a) show a; RETURN a; ENDFUNC
  PROC main()
    VAR num x:=2.5;
    VAR num y:=-7;
    VAR string s:="abc";
    VAR string t;
    VAR bool b;
%s
    show n;
  ENDPROC
ENDMODULE
"""


def without(capabilities: object) -> Any:
    """Is the node something that the target does not have?"""

    def test(node: object) -> bool:
        match node:
            case ir.Builtin(function=name):
                return name not in capabilities.functions and name not in capabilities.procedures
            case ir.Binary(op=op) | ir.Unary(op=op):
                return op not in capabilities.operators and op not in ("-", "+", "cand", "cor")
            case ir.Do(procedure=name):
                return name not in capabilities.procedures
            case ir.Convert(how=how):
                return how not in capabilities.conversions
        return False

    return test


@pytest.mark.parametrize(
    "body",
    [
        "show Round(x); show Round(-x); show Round(2.345\\Dec:=2); show Round(1/3\\Dec:=3);",
        "show Trunc(x); show Trunc(-x); show Trunc(2.999); show Trunc(-2.345\\Dec:=2); show Trunc(7);",
        "show 7 DIV 2; show y DIV 2; show y MOD 3; show 7 MOD 3; show n*3 MOD 2; show 1/2; show n/2;",
        "show Min(x,y); show Max(x,y); show Min(1,2); show Max(1,2);",
        "show ASin(0.5); show ACos(0.5); show ATan(-1); show ATan(x); show Tan(x);",
        "show Exp(1); show Exp(-3.5); show Exp(20); show Exp(0);",
        "show Pow(x,2); show Pow(2,10); show Pow(x,0.5); show Pow(2,-3); show Pow(-2,3); show Pow(x+1,3);",
        "Incr n; Decr x; Clear y; Add n,4; show n; show x; show y;",
        "show Dim(list,1);",
        'TPWrite "n is "+NumToStr(n,0)+" of "+NumToStr(x,2)+" 100%";',
        't:=s+"def"; TPWrite t; t:=t+"g"; TPWrite t; t:="x"+t; TPWrite t;',
        "t:=s+NumToStr(x,1); TPWrite t; t:=t+NumToStr(n,0); TPWrite t;",
        'TPWrite word(1)+"/"+word(3); t:=word(n); TPWrite t; IF word(1)="few" show 1;',
        'show StrLen(s+"x"); show count(s+s)+count(s); TPWrite StrPart(s+"def",2,3);',
        'IF s+"d"="abcd" show 1; WHILE StrLen(s+t)<6 DO t:=t+"1"; ENDWHILE TPWrite t;',
        'IF FALSE THEN show 1; ELSEIF StrPart(s,1,1)="a" THEN show 2; ELSE show 3; ENDIF',
        'show StrFind(s,1,"cb"); show StrMatch(s,1,"bc"); show StrMatch(s,1,"x"); b:=StrMemb(s,2,"bx"); IF b show 1;',
        "TPWrite StrMap(s,STR_LOWER,STR_UPPER);",
        'TPWrite StrMap(s,"ab","xy");',
        "show noisy(1)+count(s+s)+noisy(2);",
        'TEST s+"d" CASE "abcd": show 1; ENDTEST',
        'FOR i FROM 1 TO StrLen(s+"d") DO show i; ENDFOR',
        'RETURN; ERROR TPWrite "e"+s; RETURN;',
        "b:=n=3; IF b show 1; IF b XOR TRUE show 2;",
    ],
)
def test_a_target_with_few_functions(body: str) -> None:
    after = same_run(read("rapid", _RAPID % body), PLAIN, rewrite_calls, decide_logic)
    assert count(after, without(PLAIN)) == 0
    assert not any(
        isinstance(routine.returns, ir.StringType) for module in after.modules for routine in module.routines
    )


_KRL = """DEF main()
DECL INT i, j, offset
DECL REAL x
DECL BOOL b
DECL CHAR s[20], t[20], c
DECL STATE_T state
i = 13
j = -6
x = 2.5
b = TRUE
s[] = "abc"
%s
show(i)
END
DEF show(a:IN)
REAL a
$ANOUT[1] = a
END
DEFFCT INT act(a:IN)
INT a
show(a)
RETURN a
ENDFCT
"""


@pytest.mark.parametrize(
    "body",
    [
        "show(i B_AND 7)\nshow(j B_AND 7)\nshow(j B_OR 3)\nshow(i B_EXOR j)\nshow(B_NOT i)\nshow(j B_AND -3)",
        'b = StrAdd(s[],"def")\nIF b THEN\nMsgNotify(s[])\nENDIF',
        'StrAdd(s[],"def")\nMsgNotify(s[])\nStrCopy(t[],s[])\nMsgNotify(t[])\nStrClear(t[])\nMsgNotify(t[])',
        'offset=0\nSWRITE(t[],state,offset,"%d and %.2f %s 100%%",i,x,s[])\nMsgNotify(t[])\nshow(offset*0)',
        'MsgNotify("i %1 is","me",s[])',
        'IF StrComp(s[],"ABC",#NOT_CASE_SENS) THEN\nshow(1)\nENDIF',
        'IF StrComp(s[],"ABC",#CASE_SENS) THEN\nshow(2)\nENDIF',
        'show(StrFind(1,s[],"bc",#CASE_SENS))\nshow(StrFind(1,s[],"x",#CASE_SENS))',
        "act(i)\nshow(act(2)+act(3))",
        "show(x*i)\ni=x\nshow(i)\nshow(7/2)\nshow(j/4)",
        "b = b EXOR TRUE\nIF NOT b THEN\nshow(1)\nENDIF",
    ],
)
def test_a_target_with_operators_on_texts(body: str) -> None:
    after = same_run(read("krl", _KRL % body), RICH, rewrite_calls, fit_loops)
    assert count(after, without(RICH)) == 0


def _helper_program(call: str) -> ir.Program:
    text = "\n".join(routines("numbers").values())
    from rpl import registry
    from rpl.diagnostics import Diagnostics
    from rpl.passes.typing import normalise
    from rpl.source import source_from_text

    source = source_from_text(
        "a.rpl", f"MODULE m\n{text}\nPROCEDURE main()\nMESSAGE {call}\nEND PROCEDURE\nEND MODULE\n"
    )
    return normalise(registry.dialect("rpl").read([source], Diagnostics()).program, Diagnostics())


@pytest.mark.parametrize(
    "helper, function, arguments",
    [
        ("rpl_exp", math.exp, [(x / 7,) for x in range(-70, 71, 13)]),
        ("rpl_log", math.log, [(x,) for x in (1e-6, 0.1, 0.75, 1.0, 1.5, 2.0, 10.0, 12345.6)]),
        ("rpl_power", math.pow, [(2.0, 0.5), (2.5, -2.0), (-3.0, 3.0), (9.0, 1.5), (0.0, 0.5), (1.1, 20.0)]),
        ("rpl_trunc", math.trunc, [(x / 4,) for x in range(-9, 10)]),
        ("rpl_floor", math.floor, [(x / 4,) for x in range(-9, 10)]),
        ("rpl_ceil", math.ceil, [(x / 4,) for x in range(-9, 10)]),
        ("rpl_mod", math.fmod, [(7.0, 3.0), (-7.0, 3.0), (7.0, -3.0), (6.0, 3.0)]),
        ("rpl_band", lambda a, b: a & b, [(a, b) for a in (-9, -1, 0, 6, 255) for b in (-128, -3, 0, 5, 1023)]),
        ("rpl_bor", lambda a, b: a | b, [(a, b) for a in (-9, -1, 0, 6, 255) for b in (-128, -3, 0, 5, 1023)]),
        ("rpl_bxor", lambda a, b: a ^ b, [(a, b) for a in (-9, -1, 0, 6, 255) for b in (-128, -3, 0, 5, 1023)]),
        ("rpl_shift_left", lambda a, n: a << n, [(5, 0), (5, 3), (-5, 2)]),
        ("rpl_shift_right", lambda a, n: a >> n, [(40, 0), (40, 3), (-5, 1), (-8, 2), (7, 9)]),
    ],
)
def test_helpers_give_what_their_functions_give(helper: str, function: Any, arguments: list[tuple[Any, ...]]) -> None:
    for given in arguments:
        trace = run(_helper_program(f"{helper}({', '.join(map(str, given))})"))
        assert trace[0][1] == pytest.approx(function(*given), rel=1e-12, abs=1e-12)


def test_a_helper_is_made_once_under_a_free_name() -> None:
    text = _RAPID % "show Min(x,y); show Min(n,y);"
    text = text.replace("PROC main", "FUNC num rpl_min(num a) RETURN a; ENDFUNC PROC main")
    after, _ = legalised(read("rapid", text), PLAIN, rewrite_calls)
    (support,) = [module for module in after.modules if module.name == "rpl_support"]
    assert [routine.name for routine in support.routines] == ["rpl_min2"]


def test_what_nothing_can_rewrite_stays() -> None:
    program = read("rapid", _RAPID % "TPWrite CTime();")
    after, _ = legalised(program, PLAIN, rewrite_calls)
    assert count(after, without(PLAIN)) == 1

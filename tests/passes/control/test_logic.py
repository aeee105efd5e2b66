"""`and` and `or` keep what they evaluate, whichever rule the target has."""

from __future__ import annotations

import pytest

from rpl import ir
from rpl.passes.legalise.control.loops import fit_loops
from rpl.passes.legalise.statements.logic import decide_logic
from rpl.passes.legalise.statements.switches import unroll_switches

from .common import PLAIN, RICH, count, read, same_run

_RAPID = """MODULE m
  VAR num n:=0;
  VAR num list{3}:=[1,2,3];
  FUNC bool yes(num a) TPWrite "yes "+NumToStr(a,0); n:=n+1; RETURN TRUE; ENDFUNC
  FUNC bool no(num a) TPWrite "no "+NumToStr(a,0); n:=n+1; RETURN FALSE; ENDFUNC
  FUNC num twice(num a) RETURN 2*a; ENDFUNC
  PROC show(num a) TPWrite NumToStr(a,0); ENDPROC
  PROC main()
    VAR num i:=4;
    VAR bool b;
    VAR bool t:=TRUE;
%s
    show n;
  ENDPROC
ENDMODULE
"""


@pytest.mark.parametrize(
    "body, temporaries",
    [
        ("IF i>0 AND n<5 show 1;", 0),
        ("IF i<3 AND list{i}>0 show 1;", 0),
        ("IF i>3 OR list{i}>0 show 1;", 1),
        ("IF yes(1) AND no(2) show 1;", 0),
        ("IF yes(1) AND no(2) THEN show 1; ELSE show 2; ENDIF", 1),
        ("IF no(1) AND yes(2) THEN show 1; ELSEIF yes(3) OR yes(4) THEN show 2; ELSE show 3; ENDIF", 2),
        ("IF no(1) THEN show 1; ELSEIF no(2) OR yes(4) THEN show 2; ELSEIF yes(5) THEN show 4; ELSE show 3; ENDIF", 1),
        ("b:=no(1) AND (yes(2) OR yes(3)); IF b show 1;", 2),
        ("b:=(no(1) OR yes(2)) AND (yes(3) OR yes(4)); IF b show 1;", 3),
        ("WHILE n<3 AND yes(n) DO show n; ENDWHILE", 1),
        ("WHILE i<>0 AND (100/i)>0 DO i:=i-1; show i; ENDWHILE", 1),
        ("TEST twice(2) CASE 4: IF t AND yes(1) show 2; ENDTEST", 0),
    ],
)
def test_both_sides_are_evaluated(body: str, temporaries: int) -> None:
    after = same_run(read("rapid", _RAPID % body), PLAIN, decide_logic)
    assert not count(after, lambda node: isinstance(node, ir.Binary) and node.op in ("cand", "cor"))
    main = after.modules[0].routines[-1]
    assert len(main.declarations) == 3 + temporaries


_KRL = """DEF main()
DECL INT n
DECL BOOL t, f
t = TRUE
f = FALSE
n = 0
%s
show(n)
END
DEF show(a:IN)
INT a
$ANOUT[1] = a
END
DEFFCT BOOL yes(a:IN, n:OUT)
INT a, n
show(a)
n = n + 1
RETURN TRUE
ENDFCT
DEFFCT BOOL big(a:IN)
INT a
RETURN a > 5
ENDFCT
"""


@pytest.mark.parametrize(
    "body, temporaries",
    [
        ("IF f AND yes(1,n) THEN\nshow(7)\nENDIF", 2),
        ("IF t OR yes(1,n) THEN\nshow(7)\nENDIF", 2),
        ("IF f AND big(1) THEN\nshow(7)\nENDIF", 0),
        ("IF yes(1,n) AND yes(2,n) THEN\nshow(7)\nENDIF", 2),
        ("IF (n>0) AND yes(2,n) THEN\nshow(7)\nENDIF", 2),
        ("WHILE (n<3) AND yes(2,n)\nshow(n)\nENDWHILE", 2),
        ("REPEAT\nshow(n)\nUNTIL (n>3) OR (yes(2,n) AND f)", 2),
    ],
)
def test_an_early_end_leaves_no_effect_out(body: str, temporaries: int) -> None:
    after = same_run(read("krl", _KRL % body), RICH, decide_logic, fit_loops)
    routine = after.modules[0].routines[0]
    made = [d for d in routine.declarations if isinstance(d, ir.Variable) and d.name not in ("n", "t", "f", "done")]
    assert len(made) == temporaries


@pytest.mark.parametrize(
    "body",
    [
        "TEST i CASE 1: show 1; CASE 4,5: show 2; DEFAULT: show 3; ENDTEST",
        "TEST i+1 CASE 1: show 1; CASE 4: show 2; ENDTEST",
        'TEST NumToStr(i,0) CASE "4": show 1; DEFAULT: show 3; ENDTEST',
        "TEST t CASE TRUE: show 1; ENDTEST",
        "TEST i CASE twice(2): show 1; CASE n: show 2; ENDTEST",
        "TEST yes(1) CASE no(1): show 1; CASE yes(2): show 2; CASE yes(3): show 3; DEFAULT: show 4; ENDTEST",
        "TEST yes(1) CASE no(1), yes(2), yes(3): show 3; DEFAULT: show 4; ENDTEST",
        "TEST yes(1) DEFAULT: show 4; ENDTEST",
    ],
)
def test_switches_as_chains(body: str) -> None:
    after = same_run(read("rapid", _RAPID % body), PLAIN, unroll_switches, decide_logic)
    assert not count(after, ir.Switch)


def test_a_choice_by_whole_numbers_stays_one() -> None:
    after = same_run(
        read("krl", _KRL % "SWITCH n+1\nCASE 1\nshow(1)\nDEFAULT\nshow(9)\nENDSWITCH"), PLAIN, unroll_switches
    )
    assert count(after, ir.Switch) == 1

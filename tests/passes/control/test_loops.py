"""Loops keep their passes and the value of their counter under each target's rules."""

from __future__ import annotations

import pytest

from rpl import ir
from rpl.passes.legalise.control.loops import fit_loops

from .common import PLAIN, RICH, count, read, same_run

_RAPID = """MODULE m
  CONST num limit:=4;
  VAR num n:=3;
  FUNC num next() n:=n+1; TPWrite "next"; RETURN n; ENDFUNC
  PROC show(num a) TPWrite NumToStr(a,1); ENDPROC
  PROC main()
    VAR num a:=2;
    VAR bool go:=TRUE;
%s
    show n;
  ENDPROC
ENDMODULE
"""


@pytest.mark.parametrize(
    "body, counts",
    [
        ("FOR i FROM 1 TO 3 DO show i; ENDFOR", 1),
        ("FOR i FROM 3 TO 1 DO show i; ENDFOR", 1),
        ("FOR i FROM 1 TO 0 DO show i; ENDFOR", 1),
        ("FOR i FROM 1 TO limit DO show i; ENDFOR", 1),
        ("FOR i FROM 5 TO 1 STEP 1 DO show i; ENDFOR", 0),
        ("FOR i FROM 1 TO 5 STEP 2 DO show i; ENDFOR", 1),
        ("FOR i FROM 1 TO n DO show i; n:=7; ENDFOR", 0),
        ("FOR i FROM 1 TO a-4 DO show i; ENDFOR", 0),
        ("FOR i FROM next() TO next() DO show i; n:=n+1; ENDFOR", 0),
        ("FOR i FROM 1 TO 5 STEP a DO show i; ENDFOR", 0),
        ("FOR i FROM 5 TO 1 STEP -a DO show i; ENDFOR", 0),
        ("FOR i FROM 0.5 TO 2.5 DO show i; ENDFOR", 0),
        ("FOR i FROM 0 TO 1 STEP 0.5 DO show i; ENDFOR", 0),
        ("FOR i FROM 1 TO 2 DO FOR j FROM 1 TO i DO show i*10+j; ENDFOR ENDFOR", 1),
        ("FOR i FROM 1 TO 2 DO FOR i FROM 1 TO 2 DO show i; ENDFOR show i; ENDFOR", 2),
        ("FOR i FROM 1 TO 2 DO show i; ENDFOR FOR i FROM 4 TO 5 DO show i; ENDFOR", 2),
        ("FOR a FROM 1 TO 2 DO show a; ENDFOR show a;", 1),
        ("WHILE a>0 DO show a; a:=a-1; ENDWHILE", 0),
    ],
)
def test_counters_of_their_own_become_variables(body: str, counts: int) -> None:
    after = same_run(read("rapid", _RAPID % body), PLAIN, fit_loops)
    assert count(after, ir.For) == counts
    assert not count(after, lambda node: isinstance(node, ir.For) and (node.scoped or node.at_least_once))


_KRL = """DEF main()
DECL INT i, j, k, n
DECL BOOL b
n = 3
k = 0
%s
show(n)
END
DEF show(a:IN)
INT a
IF a > 0 THEN
MsgNotify("positive")
ELSE
MsgNotify("not")
ENDIF
$ANOUT[1] = a
END
DEF change(a:OUT)
INT a
a = a + 1
END
"""


@pytest.mark.parametrize(
    "body, counts",
    [
        ("FOR i=1 TO 3\nshow(i)\nENDFOR", 1),
        ("FOR i=1 TO 3\nshow(i)\nENDFOR\nshow(i)", 0),
        ("FOR i=1 TO 0\nshow(i)\nENDFOR\nshow(1)", 0),
        ("FOR i=6 TO 1 STEP -2\nshow(i)\nENDFOR\nshow(i)", 0),
        ("FOR i=6 TO 1 STEP -2\nshow(i)\nENDFOR", 1),
        ("FOR i=1 TO n\nshow(i)\nENDFOR", 1),
        ("n=0\nFOR i=1 TO n\nshow(i)\nENDFOR", 1),
        ("FOR i=1 TO n\nshow(i)\nn=1\nENDFOR", 1),
        ("FOR i=1 TO n\nshow(i)\ni=i+1\nENDFOR", 0),
        ("FOR i=1 TO n\nshow(i)\nchange(i)\nENDFOR", 0),
        ("FOR i=1 TO n\nIF i==2 THEN\nEXIT\nENDIF\nshow(i)\nENDFOR", 1),
        ("FOR i=1 TO n\nIF i==2 THEN\nEXIT\nENDIF\nshow(i)\nENDFOR\nshow(i)", 0),
        ("FOR i=1 TO n\nFOR j=1 TO 2\nshow(10*i+j)\nENDFOR\nENDFOR", 2),
        ("LOOP\nk=k+1\nIF k>2 THEN\nEXIT\nENDIF\nshow(k)\nENDLOOP", 0),
        ("LOOP\nIF k>2 THEN\nEXIT\nENDIF\nshow(k)\nk=k+1\nENDLOOP", 0),
        ("REPEAT\nk=k+1\nshow(k)\nUNTIL k>2", 0),
        ("REPEAT\nk=k+1\nIF k==2 THEN\nEXIT\nENDIF\nshow(k)\nUNTIL k>2\nshow(k)", 0),
        ("LOOP\nREPEAT\nk=k+1\nIF k==5 THEN\nEXIT\nENDIF\nUNTIL k>3\nshow(k)\nIF k>4 THEN\nEXIT\nENDIF\nENDLOOP", 0),
        ("WHILE k<5\nSWITCH k\nCASE 3\nEXIT\nENDSWITCH\nshow(k)\nk=k+1\nENDWHILE", 0),
    ],
)
def test_loops_of_a_target_with_its_own_counters(body: str, counts: int) -> None:
    after = same_run(read("krl", _KRL % body), RICH, fit_loops)
    assert count(after, ir.For) == counts
    assert not count(after, lambda node: isinstance(node, ir.Repeat | ir.Loop | ir.ExitLoop))
    assert not count(after, lambda node: isinstance(node, ir.For) and not node.scoped)


def test_a_loop_that_ends_at_its_top_is_a_while() -> None:
    program = read("krl", _KRL % "LOOP\nIF k>2 THEN\nEXIT\nENDIF\nshow(k)\nk=k+1\nENDLOOP")
    after = same_run(program, RICH, fit_loops)
    assert not count(after, ir.Goto)
    (loop,) = [s for s in after.modules[0].routines[0].body if isinstance(s, ir.While)]
    assert loop.condition == ir.Binary("<=", ir.Name("k"), ir.IntLiteral(2))


def test_a_counter_of_the_loop_alone_is_no_longer_declared() -> None:
    after = same_run(read("krl", _KRL % "FOR i=1 TO 3\nshow(i)\nENDFOR"), RICH, fit_loops)
    names = {d.name for d in after.modules[0].routines[0].declarations if isinstance(d, ir.Variable)}
    assert names == {"j", "k", "n", "b"}

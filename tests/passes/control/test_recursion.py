"""Routines that call themselves where a routine has one set of variables: stacks around the calls."""

from __future__ import annotations

from dataclasses import replace

import pytest

from rpl import ir
from rpl.passes.capabilities import Local, Parameters
from rpl.passes.legalise.control.logic import decide_logic
from rpl.passes.legalise.io.polling import poll_waits
from rpl.passes.legalise.routines.functions import functions_to_procedures
from rpl.passes.legalise.routines.parameters import fit_arguments
from rpl.passes.legalise.storage.locals import variables_of_routines

from .common import PLAIN, legalised, nodes, read, same_run
from .test_routines import ROUTINES, named_again

STACKED = replace(
    PLAIN,
    types=PLAIN.types | {"ArrayType"},
    routines=replace(
        PLAIN.routines, functions=False, recursion=False, locals=PLAIN.routines.locals - {Local.VARIABLES}
    ),
)
NUMBERED = replace(STACKED, routines=replace(STACKED.routines, parameters=Parameters.NUMBERED))
VARIABLES = replace(STACKED, routines=replace(STACKED.routines, parameters=Parameters.NONE))
TARGETS = pytest.mark.parametrize("capabilities", [NUMBERED, VARIABLES], ids=["numbered", "variables"])
PASSES = (
    *(poll_waits, decide_logic, functions_to_procedures, fit_arguments, variables_of_routines),
    named_again,
)

_SHOW = "  PROC show(num v) TPWrite NumToStr(v,0); ENDPROC\n"
PROGRAMS = {
    "factorial": """FUNC num fact(num n)
    IF n<2 RETURN 1;
    RETURN n*fact(n-1);
  ENDFUNC
  PROC main() show fact(5); show fact(1); ENDPROC""",
    "two calls": """FUNC num fib(num n)
    VAR num a; VAR num b;
    IF n<2 RETURN n;
    a:=fib(n-1); b:=fib(n-2);
    RETURN a+b;
  ENDFUNC
  PROC main() show fib(7); ENDPROC""",
    "two calls in one expression": """FUNC num fib(num n)
    IF n<2 RETURN n;
    RETURN fib(n-1)+fib(n-2);
  ENDFUNC
  PROC main() show fib(7); ENDPROC""",
    "through each other": """FUNC num even(num n)
    VAR num mine;
    mine:=n;
    IF n=0 RETURN 0;
    RETURN odd(n-1)+mine;
  ENDFUNC
  FUNC num odd(num n)
    VAR num own;
    own:=n*100;
    IF n=0 RETURN 1;
    RETURN even(n-1)+own;
  ENDFUNC
  PROC main() show even(4); show even(3); ENDPROC""",
    "arguments change places": """FUNC num gcd(num a, num b)
    VAR num kept;
    kept:=a;
    IF b=0 RETURN a;
    IF a<b RETURN gcd(b,a)*1;
    RETURN gcd(b,a-b*Trunc(a/b))+0*kept;
  ENDFUNC
  PROC main() show gcd(84,36); show gcd(36,84); ENDPROC""",
    "results by reference": """PROC walk(num n, INOUT num sum)
    VAR num before;
    before:=sum;
    IF n=0 RETURN;
    sum:=sum+n;
    walk n-1,sum;
    show before; show sum;
  ENDPROC
  PROC main() VAR num s:=10; walk 4,s; show s; ENDPROC""",
    "a result that is kept": """PROC split(num n, INOUT num count)
    VAR num left; VAR num right;
    left:=0; right:=0;
    IF n<=1 THEN count:=1; RETURN; ENDIF
    split n-2,left;
    split n-1,right;
    count:=left+right;
  ENDPROC
  PROC main() VAR num c; split 5,c; show c; ENDPROC""",
    "inside of a loop": """PROC tree(num depth)
    VAR num i;
    show depth;
    IF depth=0 RETURN;
    i:=0;
    WHILE i<2 DO i:=i+1; tree depth-1; show 10*depth+i; ENDWHILE
  ENDPROC
  PROC main() tree 3; ENDPROC""",
    "inside of a counting loop": """PROC tree(num depth)
    show depth;
    IF depth=0 RETURN;
    FOR i FROM 1 TO depth DO tree depth-1; show 10*depth+i; ENDFOR
  ENDPROC
  PROC main() tree 3; ENDPROC""",
    "texts and truths": """FUNC string spell(num n, bool odd)
    VAR string end; VAR bool was;
    end:="b"; IF odd end:="a";
    was:=odd;
    IF n=0 RETURN "x";
    RETURN spell(n-1,NOT odd)+end+named(was);
  ENDFUNC
  FUNC string named(bool b) IF b RETURN "T"; RETURN "F"; ENDFUNC
  PROC main() TPWrite spell(4,TRUE); ENDPROC""",
    "an array": """FUNC num deep(num n)
    VAR num kept{3};
    kept{1}:=n; kept{2}:=n*2; kept{3}:=0;
    IF n=0 RETURN 0;
    kept{3}:=deep(n-1);
    RETURN kept{1}+kept{2}*10+kept{3};
  ENDFUNC
  PROC main() show deep(4); ENDPROC""",
    "jumps": """FUNC num down(num n)
    VAR num k; VAR num sum:=0;
    k:=0;
    again:
    IF k>=n GOTO done;
    k:=k+1;
    sum:=sum+k+down(n-1);
    GOTO again;
    done:
    RETURN sum;
  ENDFUNC
  PROC main() show down(3); ENDPROC""",
}


@TARGETS
@pytest.mark.parametrize("body", PROGRAMS.values(), ids=PROGRAMS.keys())
def test_recursion_keeps_what_is_wanted_behind(body: str, capabilities: object) -> None:
    program = read("rapid", f"MODULE m\n{_SHOW}  {body}\nENDMODULE\n")
    after = same_run(program, capabilities, *PASSES)  # type: ignore[arg-type]
    assert not any(isinstance(one, ir.Vendor) for one in nodes(after))


def test_what_is_not_wanted_behind_is_not_kept() -> None:
    after, context = legalised(
        read("rapid", f"MODULE m\n{_SHOW}  {PROGRAMS['factorial']}\nENDMODULE\n"), NUMBERED, *ROUTINES
    )
    assert [item.code.name for item in context.diagnostics] == ["recursion-limited"]
    names = {one.name for module in after.modules for one in module.declarations if isinstance(one, ir.Variable)}
    assert not any(name.startswith("rpl_stack") for name in names)


def test_a_program_that_goes_too_deep_stops_with_a_message() -> None:
    text = """MODULE m
  FUNC num sum(num n)
    VAR num mine;
    mine:=n*1;
    IF n=0 RETURN 0;
    RETURN sum(n-1)+mine;
  ENDFUNC
  PROC main() TPWrite NumToStr(sum(4),0); TPWrite NumToStr(sum(5),0); TPWrite "lost"; ENDPROC
ENDMODULE
"""
    shallow = replace(NUMBERED, routines=replace(NUMBERED.routines, call_depth=4))
    after, context = legalised(read("rapid", text), shallow, *ROUTINES)
    assert "nest 4 deep" in context.diagnostics.items[0].message
    from .machine import run

    shown = run(named_again(after, context), "main", None)
    assert next(one for one in shown if one[0] == "message")[-1] == "10"
    assert "RECURSION TOO DEEP" in str(shown) and "lost" not in str(shown)

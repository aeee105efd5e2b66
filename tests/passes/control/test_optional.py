"""Parameters that may be left out, and calls by a computed name."""

from __future__ import annotations

import pytest

from rpl import ir
from rpl.passes.legalise.facts.entries import never_called
from rpl.passes.legalise.routines.optional import fit_parameters
from rpl.passes.legalise.statements.errors import check_errors
from rpl.passes.legalise.statements.logic import decide_logic

from .common import PLAIN, RICH, count, legalised, read, same_run

_RAPID = """MODULE m
  RECORD point num x; num y; ENDRECORD
  PROC show(num a) TPWrite NumToStr(a,0); ENDPROC
  PROC p(num a \\num b \\switch fast | switch slow \\INOUT num back)
    show a;
    IF Present(b) show b;
    IF Present(fast) TPWrite "fast";
    IF Present(slow) TPWrite "slow";
    IF Present(back) back:=back+1;
  ENDPROC
  PROC pass(num a \\num b \\switch fast)
    p a\\b?b\\fast?fast;
  ENDPROC
  PROC boxed(\\point where \\string name \\num list{*})
    IF Present(where) show where.x;
    IF Present(name) TPWrite name;
    IF Present(list) show list{1};
  ENDPROC
  FUNC num f(num a \\num b) IF Present(b) RETURN a+b; RETURN a; ENDFUNC
  PROC part1() show 1; ENDPROC
  PROC part2() show 2; ENDPROC
  PROC partly(num a) show a; ENDPROC
  PROC other() show 3; ENDPROC
  PROC main()
    VAR num n:=4;
    VAR num many{2}:=[7,8];
    VAR point at:=[5,6];
    VAR string name;
%s
    show n;
  ENDPROC
ENDMODULE
"""


@pytest.mark.parametrize(
    "body",
    [
        "p 1;",
        "p 1\\b:=2;",
        "p 1\\fast; p 2\\slow;",
        "p 1\\b:=2\\back:=n; p 3\\back:=n;",
        "pass 1; pass 2\\b:=3; pass 4\\fast; pass 5\\b:=6\\fast;",
        'boxed; boxed\\where:=at; boxed\\name:="a"; boxed\\list:=many;',
        "show f(1); show f(1\\b:=2); show f(f(3)\\b:=f(4\\b:=5));",
        "p\\b:=2, 1;",
    ],
)
def test_optional_parameters_become_ordinary_ones(body: str) -> None:
    after = same_run(read("rapid", _RAPID % body), PLAIN, fit_parameters)
    parameters = [p for module in after.modules for routine in module.routines for p in routine.parameters]
    assert not any(p.optional or p.switch or p.choice is not None for p in parameters)
    assert not count(after, ir.Present)
    for module in after.modules:
        for routine in module.routines:
            names = [p.name.lower() for p in routine.parameters]
            assert len(names) == len(set(names))


def test_a_target_with_optional_parameters_keeps_them() -> None:
    program = read("rapid", _RAPID % "pass 1\\fast;")
    assert legalised(program, RICH, fit_parameters)[0] is program


@pytest.mark.parametrize(
    "body, candidates",
    [
        ('%"part1"%;', 0),
        ('%"PART2"%;', 0),
        ('%"part"+NumToStr(n-2,0)%;', 2),
        ('name:="other"; %name%;', 4),
        ('name:="part"; n:=n-2; name:=name+NumToStr(n,0); %name%;', 2),
        ('name:="other"; IF n>2 name:="part2"; %name%;', 4),
        ('%"part"+"ly"% 7;', 1),
        ('%"part"+NumToStr(n,0)%;', 2),
    ],
)
def test_calls_by_name(body: str, candidates: int) -> None:
    program = read("rapid", _RAPID % body)
    if NO_PROCEDURE in body:
        after, _ = legalised(program, PLAIN, fit_parameters, check_errors, decide_logic)
    else:
        after = same_run(program, PLAIN, fit_parameters, check_errors, decide_logic)
    assert not count(after, lambda node: isinstance(node, ir.CallRoutine) and node.dynamic is not None)
    tests = count(after, lambda node: isinstance(node, ir.Builtin) and node.function == "text_equal")
    assert tests == (candidates if candidates < 4 else tests)


NO_PROCEDURE = "NumToStr(n,0)"

_KRL = """DEF main()
show(1,,3)
show(1,2)
show(1,2,3)
END
DEF show(a:IN, b:IN, c:IN)
INT a, b, c
$ANOUT[1] = a
IF VARSTATE("b")==#INITIALIZED THEN
$ANOUT[2] = b
ENDIF
IF VARSTATE("c")==#INITIALIZED THEN
$ANOUT[3] = c
ENDIF
END
"""


def test_arguments_left_out_between_commas() -> None:
    program = read("krl", _KRL)
    after = same_run(program, RICH, fit_parameters)
    assert count(after, ir.Present) == 2
    main, show = after.modules[0].routines
    assert [p.optional for p in show.parameters] == [False, True, True]
    given = [[(a.name, a.value.value) for a in call.arguments] for call in main.body]  # type: ignore[union-attr]
    assert given == [[(None, 1), ("c", 3)], [(None, 1), ("b", 2)], [(None, 1), ("b", 2), ("c", 3)]]
    plain = same_run(program, PLAIN, fit_parameters)
    assert all(all(a.value is not None for a in call.arguments) for call in plain.modules[0].routines[0].body)  # type: ignore[union-attr]


# The routine that a program starts with takes no arguments either, so a call by a computed name may mean it.
_MENU = """MODULE m
  PROC lift()
    Set do1;
  ENDPROC
  PROC start_here()
    VAR string name;
    name:="li";
    %s
  ENDPROC
  %s
ENDMODULE
"""
_CHOOSER = """PROC chooser(string name)
    %name+"ft"%;
  ENDPROC"""


@pytest.mark.parametrize(
    ("body", "more", "entry"),
    [
        ('%name+"ft"%;', "", ""),  # its own call does not count: nobody else calls it
        ("chooser name;", _CHOOSER, "start_here"),  # the chooser may call it now
        ("lift;", "", ""),
    ],
)
def test_a_program_that_may_be_called_by_name_stays_the_first(body: str, more: str, entry: str) -> None:
    program = read("rapid", _MENU % (body, more))
    after, _ = legalised(program, PLAIN, fit_parameters)
    assert after.entry == entry
    assert ("start_here" in never_called(after)) == (not entry)


_HELD = """MODULE m
  VAR string job:="lift";
  VAR num n:=0;
  PROC main()
    %s
    %%job%%;
  ENDPROC
  PROC lift()
    Set do1;
  ENDPROC
  PROC lower()
    Set do2;
  ENDPROC
  PROC other()
    Set do3;
  ENDPROC
ENDMODULE
"""


@pytest.mark.parametrize(
    ("first", "candidates"),
    [
        ('IF n=0 job:="lower";', 2),
        ('job:="lower";', 1),
        ("", 1),
        ('job:="lo"+"wer";', 1),
    ],
)
def test_a_text_that_only_ever_holds_some_names(first: str, candidates: int) -> None:
    after = same_run(read("rapid", _HELD % first), PLAIN, fit_parameters, check_errors, decide_logic)
    assert count(after, lambda node: isinstance(node, ir.Builtin) and node.function == "text_equal") == candidates

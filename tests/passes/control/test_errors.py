"""Error handlers as checked flags: what an operator sees of a program stays the same."""

from __future__ import annotations

import pytest

from rpl import ir
from rpl.diagnostics import Diagnostics
from rpl.passes.legalise.statements.errors import check_errors
from rpl.passes.legalise.statements.logic import decide_logic

from .common import PLAIN, RICH, count, legalised, read, same_run

_RAPID = """MODULE m
  CONST errnum ERR_MINE:=7;
  VAR num n:=0;
  VAR num e:=0;
  VAR num list{2}:=[1,2];
  PROC show(num a) TPWrite NumToStr(a,0); ENDPROC
  PROC fails(num a) n:=n+1; IF n<3 RAISE a; show n; ENDPROC
  FUNC num value(num a) n:=n+1; IF n<3 RAISE ERR_MINE; RETURN a+n; ENDFUNC
  FUNC bool yes(num a) n:=n+1; IF n<3 RAISE ERR_MINE; RETURN a>0; ENDFUNC
  FUNC num noisy(num a) show a; RETURN a; ENDFUNC
  PROC passes(num a) fails a; show 99; ENDPROC
  PROC stays() fails 4; ERROR show ERRNO; RETURN; ENDPROC
  FUNC num safe(num a) RETURN 10/a; ERROR IF ERRNO=ERR_DIVZERO THEN show 0; RETURN -1; ENDIF RAISE; ENDFUNC
  PROC main()
    VAR num x:=0;
    VAR bool b;
%s
    show n;
%s
  ENDPROC
ENDMODULE
"""


@pytest.mark.parametrize(
    "body, handler",
    [
        ("fails 5;", "ERROR show ERRNO; RETRY;"),
        ("fails 5;", "ERROR show ERRNO; TRYNEXT;"),
        ("fails 5;", "ERROR show ERRNO; RETURN;"),
        ("fails 5;", "ERROR show ERRNO; RAISE;"),
        ("fails 5;", "ERROR show ERRNO;"),
        ("fails 5;", ""),
        ("passes 5;", "ERROR show ERRNO; RETRY;"),
        ("passes 5; passes 6; passes 7;", "ERROR show ERRNO; TRYNEXT;"),
        ("stays; show 1; stays;", ""),
        ("RAISE 8; show 1;", "ERROR show ERRNO; TRYNEXT;"),
        ("RAISE ERR_MINE;", "ERROR IF ERRNO=ERR_MINE THEN show 1; TRYNEXT; ENDIF show 2; RAISE;"),
        ("fails 3;", "ERROR IF ERRNO=ERR_MINE THEN show 1; TRYNEXT; ENDIF show 2; RETRY;"),
        ("fails 3;", "ERROR IF ERRNO=ERR_MINE THEN show 1; ELSEIF n<2 THEN RETRY; ENDIF show 2; TRYNEXT;"),
        ("fails 3;", "ERROR TEST ERRNO CASE 3: show 1; RETRY; CASE 4: TRYNEXT; DEFAULT: show 2; ENDTEST RETURN;"),
        ("fails 7;", "ERROR(ERR_MINE) show 1; RETRY;"),
        ("fails 6;", "ERROR(ERR_MINE) show 1; RETRY;"),
        ("x:=value(1); show x;", "ERROR show ERRNO; RETRY;"),
        ("x:=value(1); show x;", "ERROR show ERRNO; TRYNEXT;"),
        ("x:=noisy(1)+value(2)+noisy(3); show x;", "ERROR show ERRNO; RETRY;"),
        ("x:=noisy(1)+value(2)+noisy(3); show x;", "ERROR show ERRNO; TRYNEXT;"),
        ("IF yes(1) THEN show 1; ELSE show 2; ENDIF", "ERROR show ERRNO; RETRY;"),
        ("IF yes(1) THEN show 1; ELSE show 2; ENDIF show 3;", "ERROR show ERRNO; TRYNEXT;"),
        ("IF FALSE THEN show 1; ELSEIF yes(1) THEN show 2; ELSE show 4; ENDIF show 3;", "ERROR show ERRNO; TRYNEXT;"),
        ("IF n=0 AND yes(1) THEN show 1; ELSE show 2; ENDIF show 3;", "ERROR show ERRNO; RETRY;"),
        ("WHILE yes(1) AND n<6 DO show n; ENDWHILE", "ERROR show ERRNO; RETRY;"),
        ("WHILE yes(1) AND n<6 DO show n; ENDWHILE", "ERROR show ERRNO; TRYNEXT;"),
        ("FOR i FROM 1 TO value(1) DO show i; ENDFOR", "ERROR show ERRNO; RETRY;"),
        ("FOR i FROM 1 TO 4 DO fails i; ENDFOR", "ERROR show ERRNO; TRYNEXT;"),
        ("TEST value(1) CASE 4: show 1; DEFAULT: show 2; ENDTEST", "ERROR show ERRNO; RETRY;"),
        ("show value(3);", "ERROR show ERRNO; RETRY;"),
        ("show safe(5); show safe(0);", ""),
        ("x:=1/(n-0); show x;", "ERROR IF ERRNO=ERR_DIVZERO THEN n:=2; RETRY; ENDIF RAISE;"),
        (
            "WaitUntil n=1\\MaxTime:=2; show 1;",
            "ERROR IF ERRNO=ERR_WAIT_MAXTIME THEN show 2; n:=1; RETRY; ENDIF RAISE;",
        ),
        ("WaitUntil n=1\\MaxTime:=2; show 1;", "ERROR show 2; TRYNEXT;"),
        ("WaitUntil n=1\\MaxTime:=2\\TimeFlag:=b; IF b show 1;", "ERROR show 2; TRYNEXT;"),
        ("WaitUntil n=1\\MaxTime:=2; show 1;", ""),
        ("fails 5;", "ERROR IF n<2 THEN GOTO again; ENDIF show 9; RETURN; again: show 3; RETRY;"),
        ("fails 5; fails 6;", "ERROR IF n<2 THEN GOTO again; ENDIF show 9; TRYNEXT; again: show 3; TRYNEXT;"),
        ("x:=list{n+3}+1; show x; show list{2};", "ERROR IF ERRNO=ERR_OUTOFBND THEN show 3; TRYNEXT; ENDIF RAISE;"),
        ("n:=0; list{n}:=7; show list{1};", "ERROR IF ERRNO=ERR_OUTOFBND THEN n:=1; RETRY; ENDIF RAISE;"),
        ("n:=2; list{n}:=7/n; show list{n};", "ERROR IF ERRNO=ERR_OUTOFBND OR ERRNO=ERR_DIVZERO RETURN; RAISE;"),
        ("fails 5;", "ERROR passes 6; RETRY;"),
        ("fails 5;", "ERROR stays; RETRY;"),
    ],
)
def test_programs_with_handlers(body: str, handler: str) -> None:
    after = same_run(read("rapid", _RAPID % (body, handler)), PLAIN, check_errors, decide_logic)
    left = (ir.Raise, ir.Retry, ir.TryNext)
    assert not count(after, lambda node: isinstance(node, left))
    assert not any(routine.handlers or routine.undo for module in after.modules for routine in module.routines)


def test_undo_runs_when_an_error_leaves() -> None:
    text = _RAPID % ("passes 5;", "ERROR show ERRNO; TRYNEXT;")
    text = text.replace("fails a; show 99;", "fails a; show 99; UNDO show 55;")
    same_run(read("rapid", text), PLAIN, check_errors)


def test_a_target_with_handlers_keeps_them() -> None:
    program = read("rapid", _RAPID % ("fails 5;", "ERROR RETRY;"))
    assert legalised(program, RICH, check_errors)[0] is program


def test_a_program_without_errors_stays_as_it_is() -> None:
    program = read("rapid", 'MODULE m PROC main() TPWrite "a"; ENDPROC ENDMODULE')
    assert legalised(program, PLAIN, check_errors)[0] is program


@pytest.mark.parametrize(
    "handler, told",
    [
        ("ERROR RETRY;", True),
        ("ERROR IF ERRNO=ERR_MINE RETRY; RAISE;", False),
        ("ERROR IF ERRNO=ERR_WAIT_MAXTIME RETRY; RAISE;", False),
        ("ERROR IF ERRNO=ERR_PATH RETRY; RAISE;", True),
    ],
)
def test_handlers_for_errors_of_the_controller_are_named(handler: str, told: bool) -> None:
    _, context = legalised(read("rapid", _RAPID % ("fails 5;", handler)), PLAIN, check_errors)
    diagnostics: Diagnostics = context.diagnostics
    assert [item.code.name for item in diagnostics if "main" in item.message] == ["handler-caught-partly"] * told


def test_an_interrupt_keeps_an_error_that_it_finds() -> None:
    text = _RAPID % ("fails 5;", "ERROR RETRY;")
    text = text.replace("  PROC main()", "  TRAP watch IF n>5 RETURN; fails 2; ENDTRAP\n  PROC main()")
    after, _ = legalised(read("rapid", text), PLAIN, check_errors)
    (trap,) = [routine for routine in after.modules[0].routines if routine.name == "watch"]
    kept = ir.Name("kept_error")
    assert trap.body[0] == ir.Assign(kept, ir.Name("error_raised"))
    assert trap.body[-1] == ir.Assign(ir.Name("error_raised"), kept)
    leave = trap.body[2]
    assert isinstance(leave, ir.If)
    assert leave.branches[0][1] == (ir.Assign(ir.Name("error_raised"), kept), ir.Return())


RETRIED = """MODULE m
  VAR bool bad:=TRUE;
  VAR num tries:=0;
  CONST errnum MINE:=7;
  PROC mend()
    bad:=FALSE;
  ENDPROC
  PROC main()
    IF bad RAISE MINE;
    tries:=tries+1;
    TPWrite "once";
  ERROR
    mend;
    RETRY;
  ENDPROC
ENDMODULE
"""


def test_a_variable_of_the_program_does_not_tell_whether_it_is_tried_again() -> None:
    """What the handler calls may change it."""
    from there_and_back import there_and_back

    text = there_and_back({"m.mod": RETRIED}, "rapid", "krl").text
    assert "UNTIL NOT bad" not in text and "MsgNotify" in text

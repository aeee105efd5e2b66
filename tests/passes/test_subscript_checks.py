"""An index outside of its array stops the program, also where a controller would read or write something else.

RAPID and KRL stop at such an index (RAPID: ERR_OUTOFBND; KRL, expert programming 1.3.3: the index is looked at). TP and
INFORM reach the neighbouring register, V+ arrays grow (language user's guide: arrays not declared AUTO).
"""

from __future__ import annotations

import pytest

from tests.there_and_back import there_and_back

UNCHECKED = ("tp", "inform", "vplus")
DATA = """
  CONST num three:=3;
  VAR num t{3}:=[1,2,3];
  VAR num behind:=7;
  VAR num n:=4;
  PERS num tuned:=2;
"""
# What may be outside, and is: nothing behind it happens.
OUTSIDE = {
    "a global": "t{n}:=9;",
    "read": "behind:=t{n};",
    "zero": "n:=0; t{n}:=9;",
    "a sum": "t{n+three}:=9;",
    "a loop that goes too far": "FOR k FROM 1 TO n DO t{k}:=9; ENDFOR",
    "a loop that counts with something else": "FOR k FROM 1 TO 3 DO t{k+1}:=9; ENDFOR",
    "a condition": "IF t{n}=0 behind:=7;",
    "the condition of a loop": "WHILE t{n}>100 DO n:=n-1; ENDWHILE",
    "in a number that was counted": "n:=1; WHILE n<=3 DO n:=n+1; t{n}:=9; ENDWHILE",
    "what a routine has changed": "n:=1; grow; t{n}:=9;",
    "behind a jump": "n:=1; GOTO there; n:=2; there: n:=n+5; t{n}:=9;",
    "of two dimensions": "m{2,n}:=9;",
    "an argument": "set 4;",
    "an element as an index": "t{1}:=9; t{t{1}}:=9;",
    "a number that is written": "t{n-n+5}:=9;",
    "given": "first t,n;",
}
# What is surely inside: no check in the text.
INSIDE = {
    "a loop": "FOR k FROM 1 TO 3 DO t{k}:=9; ENDFOR",
    "a loop to a constant": "FOR k FROM 1 TO three DO t{k}:=9; ENDFOR",
    "a loop down": "FOR k FROM 3 TO 1 STEP -1 DO t{k}:=9; ENDFOR",
    "a loop over the size": "FOR k FROM 1 TO Dim(t,1) DO t{k}:=9; ENDFOR",
    "neighbours": "FOR k FROM 1 TO 2 DO t{k+1}:=t{k}; ENDFOR",
    "a remainder": "FOR k FROM 0 TO 9 DO t{(k MOD 3)+1}:=9; ENDFOR",
    "counted": "i:=0; WHILE i<3 DO i:=i+1; t{i}:=9; ENDWHILE",
    "looked at": "IF n>=1 AND n<=3 t{n}:=9;",
    "looked at otherwise": "IF n<1 OR n>3 THEN behind:=8; ELSE t{n}:=9; ENDIF",
    "chosen": "TEST n CASE 1,2: t{n}:=9; CASE 3: t{n}:=8; ENDTEST",
    "set": "i:=2; t{i}:=9;",
    "given whole": "all t;",
}
ROUTINES = """
  VAR num m{2,3};
  PROC grow() n:=n+3; ENDPROC
  PROC set(num at) t{at}:=9; ENDPROC
  PROC first(INOUT num l{*},num at) l{at}:=9; ENDPROC
"""
_ALL = "  PROC all(INOUT num l{*}) FOR k FROM 1 TO Dim(l,1) DO l{k}:=9; ENDFOR ENDPROC\n"


def _program(body: str) -> dict[str, str]:
    routines = (
        _ALL if "all t" in body else ROUTINES if any(word in body for word in ("grow", "set", "first", "m{")) else ""
    )
    main = f"  PROC main()\n    VAR num i:=1;\n    SetDO do1,1;\n    {body}\n    SetDO do2,1;\n  ENDPROC\n"
    return {"m.mod": f"MODULE m\n{DATA}{routines}{main}ENDMODULE\n"}


@pytest.mark.parametrize("target", UNCHECKED)
@pytest.mark.parametrize("case", OUTSIDE)
def test_an_index_outside_ends_the_program(case: str, target: str) -> None:
    given = there_and_back(_program(OUTSIDE[case]), "rapid", target)
    ended = given.run()
    assert given.switched_on(ended) == {1}, given.text


@pytest.mark.parametrize("target", UNCHECKED)
@pytest.mark.parametrize("case", INSIDE)
def test_an_index_that_is_surely_inside_needs_no_check(case: str, target: str) -> None:
    given = there_and_back(_program(INSIDE[case]), "rapid", target)
    ended = given.run()
    assert "outside" not in given.text
    assert given.switched_on(ended) == {1, 2} and ended.status == "finished"


def test_one_check_is_enough_for_the_same_variable() -> None:
    given = there_and_back(_program("t{n}:=1; t{n}:=t{n}+1; IF t{n}=2 t{n}:=3;"), "rapid", "tp")
    assert given.text.count("is outside") == 1


def test_nothing_is_known_of_globals_beside_an_interrupt() -> None:
    text = _program("CONNECT e WITH seen; ISignalDI di1,1,e; n:=1; t{n}:=9;")
    text["m.mod"] = text["m.mod"].replace("MODULE m\n", "MODULE m\n  VAR intnum e;\n", 1)
    text["m.mod"] = text["m.mod"].replace("  PROC main", "  TRAP seen n:=5; ENDTRAP\n  PROC main")
    assert "is outside" in there_and_back(text, "rapid", "inform").text


@pytest.mark.parametrize("target", ("krl", "rapid", "urscript", "rpl"))
def test_controllers_that_look_themselves_need_nothing(target: str) -> None:
    krl = {"a.src": "DEF a()\nDECL INT t[3]\nDECL INT n\nn=4\n$OUT[1]=TRUE\nt[n]=1\n$OUT[2]=TRUE\nEND\n"}
    given = (
        there_and_back(krl, "krl", target) if target != "krl" else there_and_back(_program("t{n}:=9;"), "rapid", "krl")
    )
    assert "is outside" not in given.text
    ended = given.run("a" if target != "krl" else "main")
    assert given.switched_on(ended) == {1} and ended.status == "fault"


def test_a_program_that_catches_the_error_checks_with_its_handlers() -> None:
    text = "MODULE m\n  VAR num t{3};\n  VAR num n:=4;\n  PROC main()\n    t{n}:=1;\n    SetDO do1,1;\n  ERROR\n"
    text += "    IF ERRNO=ERR_OUTOFBND THEN\n      SetDO do2,1;\n      RETURN;\n    ENDIF\n  ENDPROC\nENDMODULE\n"
    given = there_and_back({"m.mod": text}, "rapid", "tp")
    assert given.switched_on(given.run()) == {2} and "is outside" not in given.text

"""An index with a fraction stops the program, also where a controller would take the element beside it.

RAPID: an index is a num that must be whole (Technical reference manual, ERRNO ERR_NOTINTVAL: not an integer value). KRL
rounds it (expert programming 1.3.2: REAL to INT), TP cuts it (R[2.6] is R[2], M), INFORM keeps it in a whole variable.
"""

from __future__ import annotations

import pytest

from tests.there_and_back import there_and_back

ROUNDING = ("krl", "tp", "urscript", "inform")
DATA = "  VAR num t{4}:=[1,2,3,4];\n  VAR num n:=5;\n  VAR num x:=2.6;\n  VAR num got:=0;\n"
FRACTIONS = {
    "a variable": "t{x}:=9;",
    "read": "got:=t{x};",
    "half of an odd number": "t{n/2}:=9;",
    "counted in halves": "x:=1; WHILE x<=3 DO t{x}:=9; x:=x+0.5; ENDWHILE",
    "a condition": "IF t{x}=0 got:=1;",
    "given": "store x;",
}
WHOLE = {
    "half of an even number": ("n:=4; t{n/2}:=9; IF t{2}<>9 Stop;", True),
    "a fraction made whole": ("t{Round(x)}:=9; IF t{3}<>9 Stop;", False),
    "counted": ("n:=1; WHILE n<=3 DO t{n}:=9; n:=n+1; ENDWHILE", False),
    "counted by a loop": ("FOR k FROM 1 TO 4 DO t{k}:=9; ENDFOR", False),
    "whole division": ("t{n DIV 2}:=9; IF t{2}<>9 Stop;", False),
}


def _program(body: str) -> dict[str, str]:
    store = "  PROC store(num at) t{at}:=9; ENDPROC\n" if "store" in body else ""
    main = f"  PROC main()\n    SetDO do1,1;\n    {body}\n    SetDO do2,1;\n  ENDPROC\n"
    return {"m.mod": f"MODULE m\n{DATA}{store}{main}ENDMODULE\n"}


@pytest.mark.parametrize("target", ROUNDING)
@pytest.mark.parametrize("case", FRACTIONS)
def test_an_index_with_a_fraction_ends_the_program(case: str, target: str) -> None:
    given = there_and_back(_program(FRACTIONS[case]), "rapid", target)
    assert given.switched_on(given.run()) == {1}, given.text


@pytest.mark.parametrize("target", ("vplus", "rpl"))
@pytest.mark.parametrize("case", FRACTIONS)
def test_controllers_that_stop_themselves_need_nothing(case: str, target: str) -> None:
    given = there_and_back(_program(FRACTIONS[case]), "rapid", target)
    ended = given.run()
    assert "raction in index" not in given.text
    assert given.switched_on(ended) == {1} and ended.status == "fault"


@pytest.mark.parametrize("target", ROUNDING)
@pytest.mark.parametrize("case", WHOLE)
def test_a_whole_index_goes_on_and_is_looked_at_where_it_has_to_be(case: str, target: str) -> None:
    body, looked_at = WHOLE[case]
    given = there_and_back(_program(body), "rapid", target)
    ended = given.run()
    assert ("raction in index" in given.text) == looked_at
    assert given.switched_on(ended) == {1, 2} and ended.status == "finished"


def test_an_index_of_v_plus_is_not_rounded_for_rapid() -> None:
    text = ".PROGRAM main()\nAUTO x\nx = 2.6\na[2] = 1\na[3] = 1\nSIGNAL 1\na[x] = 9\nSIGNAL 2\n.END\n"
    given = there_and_back({"m.v2": text}, "vplus", "rapid")
    ended = given.run()
    assert given.switched_on(ended) == {1} and ended.status == "fault"

"""A part of a text that is not in it stops the program, as it does where it comes from.

RAPID, StrPart: a start that is not in the text, or a length that goes beyond its end, is an error. V+ and URScript give
what is there (URScript manual, str_sub: a longer part ends with the text; M: $MID), and a text of KRL is a list of
characters, of which those behind its end would be taken.
"""

import pytest

from tests.there_and_back import there_and_back

PROGRAM = """MODULE m
  VAR string t:="abc";
  VAR string got;
  VAR num n:=3;
  PROC main()
    SetDO do1,1;
    {body}
    SetDO do2,1;
  ENDPROC
ENDMODULE
"""
OUTSIDE = {
    "behind the end": "got:=StrPart(t,n+1,1);",
    "too long": "got:=StrPart(t,n,2);",
    "before the beginning": "n:=0; got:=StrPart(t,n,1);",
    "a negative length": "n:=-1; got:=StrPart(t,2,n);",
    "in a condition": 'IF StrPart(t,n,2)="c" SetDO do3,1;',
    "in the condition of a loop": 'WHILE StrPart(t,n,1)<>"x" DO n:=n+1; ENDWHILE',
    "of what is calculated": 'got:=StrPart(t+"d",n,3);',
}
INSIDE = {
    "a loop over the text": 'FOR i FROM 1 TO StrLen(t) DO got:=StrPart(t,i,1); ENDFOR IF got="c" SetDO do3,1;',
    "a text that is known": 'got:=StrPart("abcdef",2,3); IF got="bcd" SetDO do3,1;',
}


def _program(body: str) -> dict[str, str]:
    return {"m.mod": PROGRAM.replace("{body}", body)}


@pytest.mark.parametrize("target", ["krl", "tp", "inform", "vplus", "urscript", "rapid", "rpl"])
@pytest.mark.parametrize("case", OUTSIDE)
def test_a_part_outside_ends_the_program(case: str, target: str) -> None:
    given = there_and_back(_program(OUTSIDE[case]), "rapid", target)
    assert given.switched_on(given.run()) <= {1}, given.text
    if target in ("vplus", "urscript"):
        assert "is outside" in given.text


@pytest.mark.parametrize("target", ["vplus", "urscript"])
@pytest.mark.parametrize("case", INSIDE)
def test_a_part_that_is_surely_inside_needs_no_check(case: str, target: str) -> None:
    given = there_and_back(_program(INSIDE[case]), "rapid", target)
    assert "is outside" not in given.text and given.switched_on(given.run()) == {1, 2, 3}


def test_what_its_own_language_cuts_needs_none() -> None:
    text = '.PROGRAM main()\n$t = "abc"\nn = 3\n$g = $MID($t,n,2)\nIF $g == "c" THEN\nSIGNAL 1\nEND\n.END\n'
    for target in ("urscript", "krl", "vplus"):
        given = there_and_back({"main.v2": text}, "vplus", target)
        assert given.switched_on(given.run()) == {1} and "outside" not in given.text.replace("text is outside", "", 1)

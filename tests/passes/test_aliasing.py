"""Arguments by reference in targets that pass copies: exact where nobody else sees the variable, else a stop.

RAPID Reference Manual, overview, procedures: an INOUT argument is the caller's own variable, and the routine changes it
at once. KRL, RG 2.2.14.3: OUT parameters are passed by reference. V+: a plain variable is passed by reference.
"""

from __future__ import annotations

import pytest

from tests.there_and_back import there_and_back

COPYING = ("urscript", "tp", "inform")
ROUTINES = """
  VAR num g:=1;
  VAR num h:=1;
  VAR num t{3}:=[1,2,3];
  VAR string who:="";
  PROC bump(INOUT num v) g:=g+10; v:=v+1; ENDPROC
  PROC over(INOUT num v) bump v; ENDPROC
  PROC plain(INOUT num v) h:=h+10; v:=v+1; ENDPROC
  PROC look(INOUT num v) IF v=1 h:=h+g; ENDPROC
  PROC change(INOUT num v) g:=5; h:=v; ENDPROC
  PROC two(INOUT num v,INOUT num w) v:=v+2; w:=w+10; ENDPROC
  PROC both(INOUT num v,INOUT num w) h:=v+w; ENDPROC
  PROC next(INOUT num v) g:=g+1; v:=v+20; ENDPROC
  FUNC num taken(INOUT num v) g:=g+1; v:=v+1; RETURN v; ENDFUNC
  FUNC num own(INOUT num v) v:=v+1; RETURN v*2; ENDFUNC
  FUNC num raised() g:=g+1; RETURN g; ENDFUNC
  PROC add(INOUT num v,num n) v:=v+n; ENDPROC
"""
# What cannot be said by copies.
ALIASED = {
    "by its own name": "bump g; IF g=12 SetDO do1,1;",
    "by a routine that the routine calls": "over g; IF g=12 SetDO do1,1;",
    "read only, and changed by name": "change g; IF h=5 SetDO do1,1;",
    "one variable for two": "two g,g; IF g=13 SetDO do1,1;",
    "one variable of the routine for two": "n:=1; two n,n; IF n=13 SetDO do1,1;",
    "an element that the run chooses": "n:=2; two t{n},t{2}; IF t{2}=14 SetDO do1,1;",
    "a list and one of its elements": "sum t; IF t{1}=3 SetDO do1,1;",
    "of a function": "n:=taken(g); IF g=3 SetDO do1,1;",
    "in a condition": "IF taken(g)=3 SetDO do1,1;",
    "in the condition of a loop": "WHILE taken(g)<9 DO n:=n+1; ENDWHILE SetDO do1,1;",
    "by a computed name": 'who:="bump"; IF h=1 who:="plain"; %who%g; IF g=12 SetDO do1,1;',
    "by a name that is put together": '%"bu"+who%g; IF g=12 SetDO do1,1;',
    "beside a function that changes it": "add g,raised(); IF g=4 SetDO do1,1;",
}
# What can.
APART = {
    "another variable": "plain g; IF g=2 AND h=11 SetDO do1,1;",
    "read by both": "look g; IF h=2 SetDO do1,1;",
    "read by two": "both g,g; IF h=2 SetDO do1,1;",
    "by a computed name": 'who:="plain"; IF h=1 who:="look"; %who%g; IF h=2 SetDO do1,1;',
    "two elements": "two t{1},t{2}; IF t{1}=3 AND t{2}=12 SetDO do1,1;",
    "two elements side by side": "n:=2; two t{n},t{n+1}; IF t{2}=4 AND t{3}=13 SetDO do1,1;",
    "two variables": "two g,h; IF g=3 AND h=11 SetDO do1,1;",
    "an element whose subscript changes": "next t{g}; IF t{1}=21 AND t{2}=2 AND g=2 SetDO do1,1;",
    "a function's": "n:=3; h:=own(n); IF n=4 AND h=8 SetDO do1,1;",
    "a variable of the routine": "n:=1; bump n; IF n=2 AND g=11 SetDO do1,1;",
}


_SUM = "  PROC sum(INOUT num l{*}) l{1}:=l{1}+t{2}; ENDPROC\n"  # where it is called: only then its size is known


def _program(body: str, more: str = "") -> dict[str, str]:
    more += _SUM if "sum" in body else ""
    return {"m.mod": f"MODULE m\n{ROUTINES}{more}  PROC main()\n    VAR num n:=0;\n    {body}\n  ENDPROC\nENDMODULE\n"}


@pytest.mark.parametrize("target", COPYING)
@pytest.mark.parametrize("case", ALIASED)
def test_what_is_seen_under_two_names_stops_the_program(case: str, target: str) -> None:
    given = there_and_back(_program(ALIASED[case]), "rapid", target)
    assert "reference-aliased" in given.losses and (case == "a list and one of its elements" or len(given.losses) == 1)
    ended = given.run()
    assert not given.switched_on(ended) and ended.status != "finished"


@pytest.mark.parametrize("target", COPYING)
@pytest.mark.parametrize("case", APART)
def test_what_is_seen_once_is_passed_without_a_word(case: str, target: str) -> None:
    given = there_and_back(_program(APART[case]), "rapid", target)
    assert not given.losses and "reference" not in " ".join(item.code.name for item in given.found)
    ended = given.run()
    assert given.switched_on(ended) == {1} and ended.status == "finished"


@pytest.mark.parametrize("target", ("krl", "vplus", "rpl"))
@pytest.mark.parametrize("case", ALIASED)
def test_targets_with_references_need_nothing(case: str, target: str) -> None:
    given = there_and_back(_program(ALIASED[case]), "rapid", target)
    assert "reference-aliased" not in given.losses


def test_a_variable_that_an_interrupt_changes_is_not_passed_as_a_copy() -> None:
    more = "  VAR intnum i;\n  TRAP seen g:=g+1; ENDTRAP\n  PROC slow(INOUT num v) WaitTime 1; v:=v+1; ENDPROC\n"
    more += "  PROC still(INOUT num v) WaitTime 1; v:=v+1; ENDPROC\n"
    text = "CONNECT i WITH seen; ISignalDI di1,1,i; slow g; still h;"
    given = there_and_back(_program(text, more), "rapid", "inform")
    found = [item for item in given.found if item.code.name == "reference-aliased"]
    assert ["an interrupt or another task uses g as well" in item.message for item in found] == [True]


def test_krl_and_vplus_are_looked_at_in_the_same_way() -> None:
    krl = {
        "a.src": "DEF a()\ng=1\nbump(g)\nIF g==12 THEN\n$OUT[1]=TRUE\nENDIF\nEND\n"
        "DEF bump(v:OUT)\nDECL INT v\ng=g+10\nv=v+1\nEND\n",
        "a.dat": "DEFDAT a\nDECL INT g=1\nENDDAT\n",
    }
    vplus = {
        "a.v2": ".PROGRAM a()\n GLOBAL g\n g = 1\n CALL bump(g)\n IF g == 12 THEN\n SIGNAL 1\n END\n.END\n"
        ".PROGRAM bump(v)\n GLOBAL g\n g = g+10\n v = v+1\n.END\n"
    }
    for language, files in (("krl", krl), ("vplus", vplus)):
        for target in COPYING:
            given = there_and_back(files, language, target)
            assert given.losses == ["reference-aliased"], (language, target)

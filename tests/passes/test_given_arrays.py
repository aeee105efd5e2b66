"""Arrays given to routines by reference, in targets whose data has numbers: what the routine sets is in the array."""

from __future__ import annotations

import pytest

from rpl.diagnostics import Diagnostics, Severity
from rpl.project import read_sources
from rpl.simulation import run_program
from rpl.source import source_from_bytes, source_from_text
from rpl.translation import translate_program

FILL = ".PROGRAM fill(x[], n, first)\n AUTO REAL i\n FOR i = 1 TO n\n x[i] = first+i\n END\n.END\n"
SUM = ".PROGRAM sum(x[], n, s)\n AUTO REAL i\n s = 0\n FOR i = 1 TO n\n s = s+x[i]\n END\n.END\n"
HAND = ".PROGRAM hand(x[], n)\n CALL fill(x[], n, 10)\n.END\n"
# Statements and what holds behind them.
CASES = {
    "one array": ("CALL fill(a[], 3, 4)\nCALL sum(a[], 3, s)", "s == 18"),
    "two arrays": ("CALL fill(a[], 3, 4)\nCALL fill(b[], 2, 0)\nCALL sum(a[], 3, s)", "(s == 18) AND (b[2] == 2)"),
    "handed on": ("CALL hand(a[], 3)\nCALL sum(a[], 3, s)", "(s == 36) AND (a[3] == 13)"),
}


@pytest.mark.parametrize("target", ["tp", "inform"])
@pytest.mark.parametrize("name", CASES)
def test_the_array_has_what_the_routine_sets(name: str, target: str) -> None:
    statements, holds = CASES[name]
    text = f".PROGRAM main()\n{statements}\nIF {holds} THEN\nSIGNAL 1\nEND\n.END\n{FILL}{SUM}"
    text += HAND if "hand" in statements else ""
    diagnostics = Diagnostics()
    read = read_sources([source_from_text("p.v2", text)], "vplus", diagnostics)
    assert [value for _, _, value in run_program(read.program, entry="main").outputs] == [True]
    done = translate_program(read, target, None, None, diagnostics)
    assert not diagnostics.of(Severity.LOSS)
    back = read_sources([source_from_bytes(f.path, f.data) for f in done.files], target, Diagnostics())
    result = run_program(back.program, entry=done.renamed.get("main", "main"))
    assert [value for _, _, value in result.outputs] == [True]


def test_an_array_of_a_routine_stays_its_own() -> None:
    text = f".PROGRAM main()\nAUTO REAL c[5]\nCALL fill(c[], 3, 4)\nIF c[3] == 7 THEN\nSIGNAL 1\nEND\n.END\n{FILL}"
    read = read_sources([source_from_text("p.v2", text)], "vplus", Diagnostics())
    done = translate_program(read, "inform", None, None, Diagnostics())
    back = read_sources([source_from_bytes(f.path, f.data) for f in done.files], "inform", Diagnostics())
    result = run_program(back.program, entry=done.renamed.get("main", "main"))
    assert [value for _, _, value in result.outputs] == [True]


ROWS = r"""MODULE M
VAR num a{2,3}:=[[1,2,3],[4,5,6]]; VAR num b{3,1}:=[[7],[8],[9]]; VAR num c{4}:=[1,1,1,1];
PROC main()
  VAR num s; VAR num t;
  Sum a,s; Hand b,t;
  IF s=21 AND t=24 AND Count(c)=4 SetDO do1,1;
ENDPROC
PROC Hand(num x{*,*},INOUT num total) Sum x,total; ENDPROC
FUNC num Count(num x{*}) RETURN Dim(x,1); ENDFUNC
PROC Sum(num x{*,*},INOUT num total)
  total:=0;
  FOR i FROM 1 TO Dim(x,1) DO
    FOR k FROM Dim(x,2) TO 1 STEP -1 DO total:=total+x{i,k}; ENDFOR
  ENDFOR
ENDPROC
ENDMODULE
"""


@pytest.mark.parametrize("target", ["krl", "urscript", "vplus"])
def test_the_size_of_a_list_in_lists_comes_with_it(target: str) -> None:
    diagnostics = Diagnostics()
    read = read_sources([source_from_text("m.mod", ROWS)], "rapid", diagnostics)
    assert [value for _, _, value in run_program(read.program).outputs] == [True]
    done = translate_program(read, target, None, None, diagnostics)
    assert not diagnostics.of(Severity.LOSS)
    back = read_sources([source_from_bytes(f.path, f.data) for f in done.files], target, Diagnostics())
    result = run_program(back.program, entry=done.renamed.get("main", "main"))
    assert [value for _, _, value in result.outputs] == [True]

"""Where an interrupt may come: a routine that is called with it on and with it off leaves it as it was."""

from __future__ import annotations

import pytest

from rpl.diagnostics import Diagnostics
from rpl.project import read_sources
from rpl.source import source_from_text
from rpl.translation import translate_program

PROGRAM = """MODULE a
VAR intnum i;
VAR clock ck;
CONST robtarget p:=[[400,-50,300],[0,0,1,0],[-1,0,-1,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
PROC main()
MoveL p,v100,z10,tool0;
{before}
MoveL p,v100,z10,tool0;
CONNECT i WITH hold;
ISignalDI di1,1,i;
{between}
MoveL p,v100,z10,tool0;
IDelete i;
{behind}
MoveL p,v100,z10,tool0;
ENDPROC
PROC begins()
ClkReset ck;
ENDPROC
PROC arms()
CONNECT i WITH hold;
ISignalDI di1,1,i;
ENDPROC
TRAP hold
StopMove;
WaitTime 0.5;
StartMove;
ENDTRAP
ENDMODULE
"""
CASES = {
    "no call": ("", "", "", [12]),
    "called on and off": ("begins;", "begins;", "begins;", [12]),
    "a routine that turns it on": ("arms;", "", "", [8, 12]),
    "on again behind": ("", "begins;", "arms;", [12, 15]),
}


@pytest.mark.parametrize("name", CASES)
def test_moves_that_may_be_stopped(name: str) -> None:
    before, between, behind, lines = CASES[name]
    text = PROGRAM.format(before=before, between=between, behind=behind)
    diagnostics = Diagnostics()
    read = read_sources([source_from_text("a.mod", text)], "rapid", Diagnostics())
    translate_program(read, "vplus", "abb_irb1200_5_90", None, diagnostics)
    told = [item.origin.line for item in diagnostics if item.code.name == "interrupt-stops-corner"]
    assert sorted(told) == lines

"""What one statement became twice in a row is written once; constant questions of system routines are decided."""

from __future__ import annotations

import pytest

from rpl.diagnostics import Diagnostics
from rpl.project import read_sources
from rpl.source import source_from_text
from rpl.translation import translate_program

CASES = {
    "six axes have one number in RAPID": ("BAS(#VEL_PTP,50)", "rapid", ",v2500,fine", 1),
    "no tool": ("BAS(#TOOL,0)", "rapid", "tframe", 0),
    "a number that is kept is no place for another": ("BAS(#TOOL,0)", "rapid", "ACT_TOOL", 0),
    "nothing to ask about a constant": ("BAS(#BASE,0)", "rapid", "IF 0>", 0),
    "what the source says twice": ("x=1\nx=1", "rapid", "x:=1;", 2),
    "what counts": ("x=x+1\nx=x+1", "rapid", "x:=x+1;", 2),
    "outputs are events": ("$OUT[1]=TRUE\n$OUT[1]=TRUE", "rapid", "SetDO do1,1;", 2),
}


@pytest.mark.parametrize("name", CASES)
def test_how_often_it_is_written(name: str) -> None:
    steps, target, line, times = CASES[name]
    text = f"DEF main( )\nDECL INT x\nx=0\n{steps}\nPTP {{A1 0,A2 -90,A3 90,A4 0,A5 0,A6 0}}\n$OUT[2]=x>1\nEND\n"
    read = read_sources([source_from_text("main.src", text)], "krl", Diagnostics())
    files = translate_program(read, target, None, None, Diagnostics()).files
    written = "\n".join(file.data.decode("latin-1") for file in files)
    assert written.count(line) == times, written

"""A loop that looks where the robot is while a move is driven beside it (RAPID \\Conc) does not wait for the move."""

from __future__ import annotations

from rpl.diagnostics import Diagnostics
from rpl.project import read_sources
from rpl.simulation import run_program
from rpl.source import source_from_bytes, source_from_text
from rpl.translation import translate_program

MODULE = """MODULE m
  CONST robtarget a:=[[500,-200,500],[0,0,1,0],[-1,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
  CONST robtarget b:=[[500,200,500],[0,0,1,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
  VAR pos p;
  PROC main()
    MoveJ a,v500,fine,tool0;
    MoveL\\Conc,b,v200,fine,tool0;
    p:=CPos(\\Tool:=tool0\\WObj:=wobj0);
    WHILE p.y<0 DO
      WaitTime 0.05;
      p:=CPos(\\Tool:=tool0\\WObj:=wobj0);
    ENDWHILE
    SetDO do1,1;
    p:=CPos(\\Tool:=tool0\\WObj:=wobj0);
    IF p.y<100 SetDO do2,1;
    MoveL a,v200,fine,tool0;
    SetDO do3,1;
  ENDPROC
ENDMODULE
"""


def test_the_loop_ends_on_the_way() -> None:
    diagnostics = Diagnostics()
    read = read_sources([source_from_text("m.mod", MODULE)], "rapid", diagnostics)
    translation = translate_program(read, "vplus", "abb_irb1200_5_90", None, diagnostics)
    back = read_sources([source_from_bytes(f.path, f.data) for f in translation.files], "vplus", Diagnostics())
    result = run_program(back.program, "abb_irb1200_5_90", None, translation.renamed.get("main", "main"))
    assert result.status == "finished"
    assert len(result.outputs) == 3

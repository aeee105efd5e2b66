"""Data that nothing uses takes no register."""

import pytest

from rpl.diagnostics import Diagnostics
from rpl.project import read_sources
from rpl.source import source_from_text
from rpl.translation import translate_program

PROGRAM = """MODULE demo
  PERS tooldata tGrip:=[TRUE,[[0,0,100],[1,0,0,0]],[1,[0,0,50],[1,0,0,0],0,0,0]];
  VAR num nSpare:=7;
  VAR num nCount:=2;
  PROC main()
    MoveL [[400,0,300],[0,0,1,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]],v200,fine,tGrip;
    nCount:=nCount+1;
    IF nCount=3 SetDO do1,1;
  ENDPROC
ENDMODULE
"""


@pytest.mark.parametrize("target", ["tp", "inform"])
def test_only_what_is_used_gets_a_number(target: str) -> None:
    diagnostics = Diagnostics()
    read = read_sources([source_from_text("demo.mod", PROGRAM)], "rapid", diagnostics)
    written = translate_program(read, target, "abb_irb1200_5_90", None, diagnostics)
    names = set(written.registers.values())
    assert "nCount" in names and names & {"tGrip", "tGrip_frame"}  # a number of the controller's table, or data
    assert not any(name.startswith(("nSpare", "tGrip_load")) for name in names)
    said = [item.as_text() for item in diagnostics if item.code.name == "data-used-nowhere"]
    assert len(said) == 2 and "tGrip_held" in said[0] and "tGrip_load_mass" in said[0] and "nSpare" in said[1]

"""A place that the other arm does not reach costs the moves to it, all else is written; a shift that helps is told."""

from __future__ import annotations

import pytest

from rpl.diagnostics import Diagnostics
from rpl.project import read_sources
from rpl.source import source_from_text
from rpl.translation import translate_program

JOINTS = "[9E9,9E9,9E9,9E9,9E9,9E9]"
RAPID = f"""MODULE M
  CONST robtarget near:=[[500,0,400],[0,0,1,0],[0,0,0,0],{JOINTS}];
  CONST robtarget far:=[[1000,0,400],[0,0,1,0],[0,0,0,0],{JOINTS}];
  PROC main()
    MoveJ near,v500,fine,tool0;
    MoveL far,v500,fine,tool0;
    MoveL Offs(near,0,0,50),v500,fine,tool0;
    MoveL Offs(far,-500,0,0),v500,fine,tool0;
  ENDPROC
ENDMODULE
"""


@pytest.mark.parametrize("target", ["rapid", "krl", "tp", "urscript"])
def test_only_the_move_to_the_place_is_a_stop(target: str) -> None:
    told = Diagnostics()
    read = read_sources([source_from_text("M.mod", RAPID)], "rapid", told)
    found = translate_program(read, target, "abb_irb2400", "abb_irb1200_5_90", told)
    assert not told.has_errors
    assert [(one.code.name, one.origin.line) for one in found.losses] == [("unreachable-on-target-arm", 6)]
    shifts = [one.message for one in told.items if one.code.name == "reach-shift"]
    assert len(shifts) >= 1
    assert "its foot moved by x +" in shifts[0]
    assert "now it misses 1" in shifts[0]

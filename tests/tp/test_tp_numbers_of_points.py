"""Points whose names say a number have it in TP, also behind a letter that some put before a name (inline forms of KRL:
`XP6` is P[6]). The next free number goes to the others."""

import re

from tests.tp.tp_translating_helpers import same_in_tp

RAPID = """MODULE m
  CONST robtarget XP6:=[[400,0,300],[0,1,0,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
  CONST robtarget P3:=[[400,20,300],[0,1,0,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
  CONST robtarget above:=[[400,40,300],[0,1,0,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
  PROC main()
    MoveL above,v200,fine,tool0;
    MoveL XP6,v200,fine,tool0;
    MoveL P3,v200,fine,tool0;
  ENDPROC
ENDMODULE
"""


def test_points_have_the_numbers_of_their_names() -> None:
    files, _ = same_in_tp("rapid", RAPID)
    assert re.findall(r"L P\[(\d+):(\w+)\]", files["MAIN.LS"]) == [("1", "above"), ("6", "XP6"), ("3", "P3")]

"""Settings that are in force are not said again behind what cannot change them."""

import pytest

from rpl.diagnostics import Diagnostics
from rpl.project import read_sources
from rpl.source import source_from_text
from rpl.translation import translate_program

# What turns at a speed of its own is no inline form, which would say its tool itself.
PROGRAM = """MODULE M
  PERS tooldata tGrip:=[TRUE,[[0,0,100],[1,0,0,0]],[1,[0,0,50],[1,0,0,0],0,0,0]];
  CONST robtarget pA:=[[400,0,300],[0,0,1,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
  CONST robtarget pB:=[[400,50,300],[0,0,1,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
  CONST speeddata vTurn:=[200,90,5000,1000];
  VAR num n:=0;
  PROC main()
    MoveL pA,vTurn,fine,tGrip;
    {between}
    MoveL pB,vTurn,fine,tGrip;
  ENDPROC
  PROC count()
    Incr n;
    Set do1;
  ENDPROC
  PROC away()
    count;
    MoveL pA,vTurn,fine,tool0;
  ENDPROC
{other}ENDMODULE
"""
OTHER = """  PROC other()
    count;
    tGrip.tframe.trans.z:=120;
  ENDPROC
"""


@pytest.mark.parametrize(
    ("between", "times"),
    [
        ("Set do1;", 1),
        ("count;", 1),
        ('TPWrite "number "+NumToStr(n,0);', 1),
        ("WHILE n<3 DO\n    count;\n    ENDWHILE", 1),
        ("IF n=1 THEN\n    count;\n    ENDIF", 1),
        ("away;", 2),  # another tool
        ("other;", 2),  # the tool itself is another one now
        ("WHILE n<3 DO\n    other;\n    Incr n;\n    ENDWHILE", 2),
    ],
)
def test_a_tool_is_said_again_where_it_must(between: str, times: int) -> None:
    diagnostics = Diagnostics()
    text = PROGRAM.replace("{between}", between).replace("{other}", OTHER if "other;" in between else "")
    read = read_sources([source_from_text("M.mod", text)], "rapid", diagnostics)
    written = translate_program(read, "krl", "abb_irb1200_5_90", None, diagnostics)
    text = next(file.data.decode() for file in written.files if file.path == "M.src")
    main = text[text.index("DEF M(") :].partition("\r\nEND\r\n")[0]
    assert main.count("$TOOL=tGrip") + main.count("$TOOL=TOOL_DATA[1]") == times, main

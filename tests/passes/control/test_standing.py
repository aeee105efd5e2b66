"""Waits for the robot, for a controller that runs ahead over stop points: only where the source stands."""

import pytest

from rpl.diagnostics import Diagnostics
from rpl.project import read_sources
from rpl.source import source_from_text
from rpl.translation import translate_program

MODULE = """MODULE m
  VAR intnum seen;
  VAR num count:=0;
  VAR num n:=2;
  PROC main()
    CONNECT seen WITH tSeen;
    ISignalDI di1,1,seen;
{body}
    ISleep seen;
  ENDPROC
  PROC stops()
    MoveL [[400,0,500],[0,0,1,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]],v100,fine,tool0;
  ENDPROC
  PROC passes()
    MoveL [[400,0,500],[0,0,1,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]],v100,z10,tool0;
  ENDPROC
  TRAP tSeen
    count:=count+1;
  ENDTRAP
ENDMODULE
"""


@pytest.mark.parametrize(
    ("body", "waits"),
    [
        ("stops;", True),
        ("passes;", False),
        ("passes;\nstops;", True),
        ("stops;\npasses;", False),
        ("FOR i FROM 1 TO 3 DO\npasses;\nENDFOR", False),
        ("FOR i FROM 1 TO 3 DO\nstops;\nENDFOR", True),
        ("stops;\nFOR i FROM 1 TO 3 DO\npasses;\nENDFOR", False),
        ("stops;\nWHILE n>2 DO\npasses;\nENDWHILE", True),
        ("stops;\nIF n>1 THEN\npasses;\nENDIF", True),
        ("stops;\nIF n>1 THEN\npasses;\nELSE\npasses;\nENDIF", False),
    ],
)
def test_interrupt_control_waits_behind_a_stop_point_only(body: str, waits: bool) -> None:
    read = read_sources([source_from_text("m.mod", MODULE.format(body=body))], "rapid", Diagnostics())
    written = translate_program(read, "krl", "abb_irb1200_5_90", None, Diagnostics())
    (text,) = [file.data.decode() for file in written.files if file.path.lower() == "m.src"]
    main = text[: text.index("INTERRUPT OFF")]
    assert main.rstrip().endswith("WAIT SEC 0") is waits, main

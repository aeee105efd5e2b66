"""Joint moves whose tool speed is calculated: the percentage is limited by a function the program brings along."""

from rpl.diagnostics import Diagnostics, Severity
from rpl.project import read_sources
from rpl.source import source_from_text
from rpl.translation import translate_program

PROGRAM = """MODULE Main
  PROC main()
    VAR speeddata vs:=[1000,500,5000,1000];
    vs.v_tcp:=vs.v_tcp*0.5;
    MoveAbsJ [[0,0,0,0,30,0],[9E9,9E9,9E9,9E9,9E9,9E9]],vs,fine,tool0;
  ENDPROC
ENDMODULE
"""


def test_a_calculated_speed_is_limited() -> None:
    diagnostics = Diagnostics()
    read = read_sources([source_from_text("Main.mod", PROGRAM)], "rapid", Diagnostics())
    made = translate_program(read, "krl", "abb_irb1200_5_90", None, diagnostics)
    assert not diagnostics.of(Severity.LOSS)
    assert any("rpl_min(100.0," in file.data.decode("latin-1") for file in made.files)

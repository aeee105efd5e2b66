"""Programs of other languages written as TP listings: read back, both run, both do the same."""

import pytest

from rpl.diagnostics import Diagnostics, Severity
from rpl.project import read_sources
from rpl.proof.prove import prove_programs
from rpl.proof.wiring import with_signal_names
from rpl.simulation import entry_name
from rpl.source import source_from_bytes, source_from_text
from rpl.translation import translate_program

RAPID_SIGNAL_NAMES = """MODULE m
  PROC main()
    Set doGrip;
    Reset doGrip;
    Set doDone;
  ENDPROC
ENDMODULE
"""
RAPID_LATE = """MODULE m
  PROC main()
    WaitDI diNever,1\\MaxTime:=0.5;
    Set doWrong;
  ERROR
    Set doTooLate;
    RETURN;
  ENDPROC
ENDMODULE
"""
RAPID_CHOSEN = """MODULE m
  PROC main()
    VAR string name:="second";
    VAR num much:=2;
    %name% much+1;
  ENDPROC
  PROC first(num n)
    IF n=1 Set doFirst;
  ENDPROC
  PROC second(num n)
    IF n=3 Set doSecond;
  ENDPROC
ENDMODULE
"""
KRL_TOOL = """DEF p()
BAS(#INITMOV,0)
first()
PTP {X 500,Y 0,Z 420,A 0,B 90,C 0,S 6,T 18}
grip(TRUE)
PTP {X 560,Y 0,Z 420,A 0,B 90,C 0,S 6,T 18}
grip(FALSE)
PTP {X 500,Y 0,Z 420,A 0,B 90,C 0,S 6,T 18}
END
DEF first()
$TOOL={X 0,Y 0,Z 120,A 0,B 0,C 0}
$BASE=$NULLFRAME
END
DEF grip(closed:IN)
BOOL closed
$OUT[3]=closed
END
"""
RPL_RETREAT = """MODULE m
PROCEDURE main()
    MOVE TO {j1: 0, j2: 0, j3: 0, j4: 0, j5: -90, j6: 0} JOINT SPEED 50 %
    hold()
    MOVE LINEAR BY {z: -30} IN TOOL SPEED 100 mm/s
    hold()
END PROCEDURE
PROCEDURE hold()
    SET do[1] TO ON
END PROCEDURE
END MODULE
"""
URSCRIPT_NO_POSTURE = """def p():
  rest = [0, -1.5708, -1.5708, -1.5708, 1.5708, 0]
  global place = p[-0.3, -0.35, 0.25, 0, 3.14159, 0]
  def above(height):
    place[2] = place[2] + height
    return place
  end
  movej(rest)
  movej(above(0.1))
  movel(above(-0.05))
  set_standard_digital_out(0, True)
end
"""
CASES = {
    "names of signals": ("rapid", RAPID_SIGNAL_NAMES, "fanuc_lrmate200id"),
    "a wait that raises an error": ("rapid", RAPID_LATE, "fanuc_lrmate200id"),
    "arguments of a routine that is chosen at run time": ("rapid", RAPID_CHOSEN, "fanuc_lrmate200id"),
    "a tool that called routines leave alone": ("krl", KRL_TOOL, "kuka_kr6r900sixx"),
    "a way along the tool behind a call": ("rpl", RPL_RETREAT, "fanuc_lrmate200id"),
    "poses without a posture": ("urscript", URSCRIPT_NO_POSTURE, "ur5e"),
}


@pytest.mark.parametrize("name", CASES)
def test_the_listings_do_the_same(name: str) -> None:
    language, text, robot = CASES[name]
    diagnostics = Diagnostics()
    read = read_sources([source_from_text(f"p.{language}", text)], language, diagnostics)
    written = translate_program(read, "tp", robot, None, diagnostics)
    assert not [one.as_text() for one in diagnostics if one.severity >= Severity.ERROR or one in written.losses]
    files = [source_from_bytes(file.path, file.data) for file in written.files]
    back = with_signal_names(read_sources(files, "tp", Diagnostics()).program, written.program)
    entry = entry_name(read.program)
    proof = prove_programs(read.program, back, robot, entry=entry, to_entry=written.renamed.get(entry or "", entry))
    assert proof.agrees, proof.as_text()

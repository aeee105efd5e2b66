"""The least time of a move (V+ DURATION) in languages that have no such setting."""

from __future__ import annotations

import pytest

from rpl.diagnostics import Diagnostics
from rpl.project import read_sources
from rpl.simulation import run_program
from rpl.source import source_from_bytes, source_from_text
from rpl.translation import translate_program

PROGRAM = """.PROGRAM main()
 MOVES a
 BREAK
 TIMER 1 = 0
 {setting}
 MOVES b
 BREAK
 t = TIMER(1)
 IF (t > 1.98) AND (t < 2.6) THEN
 SIGNAL 1
 END
 TIMER 1 = 0
 MOVES a
 BREAK
 IF TIMER(1) < 1 THEN
 SIGNAL 2
 END
.END
.LOCATIONS
a 330 50 260 0 180 0
b 330 150 260 0 180 0
.END
"""
ARM = "adept_viper_s650"


@pytest.mark.parametrize("target", ["krl", "rapid", "tp", "inform", "urscript"])
@pytest.mark.parametrize(
    "setting", ["DURATION 2", "DURATION time", "SPEED 200 MMPS\nDURATION 2", "SPEED 50 MMPS\nDURATION 1"]
)
def test_a_move_takes_its_time(setting: str, target: str) -> None:
    text = PROGRAM.format(setting=setting).replace(".PROGRAM main()\n", ".PROGRAM main()\n time = 2\n")
    source = read_sources([source_from_text("main.v2", text)], "vplus", Diagnostics())
    found = Diagnostics()
    translation = translate_program(source, target, ARM, None, found)
    back = read_sources([source_from_bytes(f.path, f.data) for f in translation.files], target, Diagnostics())
    runs = [
        run_program(source.program, ARM, None, "main"),
        run_program(back.program, ARM, None, translation.renamed.get("main", "main")),
    ]
    assert [run.status for run in runs] == ["finished"] * 2
    assert [len(run.outputs) for run in runs] == [2, 2]
    assert ("move-time-by-speed" in [item.code.name for item in found]) == (
        target in ("krl", "inform") or "MMPS" in setting
    )


TIMED = """MODULE t
  PERS tooldata tGrip:=[TRUE,[[0,0,100],[1,0,0,0]],[1,[0,0,1],[1,0,0,0],0,0,0]];
  CONST robtarget p:=[[500,150,400],[0,0,1,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
  CONST robtarget q:=[[500,-50,400],[0,0,1,0],[-1,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
  CONST jointtarget j0:=[[0,0,0,0,60,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
  CONST jointtarget j1:=[[40,10,5,0,70,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
  VAR clock c;
  PROC check(num n)
    ClkStop c;
    IF ClkRead(c)>2.9 AND ClkRead(c)<3.5 THEN
      IF n=1 SetDO do1,1;
      IF n=2 SetDO do2,1;
      IF n=3 SetDO do3,1;
    ENDIF
    ClkReset c;
    ClkStart c;
  ENDPROC
  PROC main()
    VAR jointtarget j;
    MoveAbsJ j0,v1000,fine,tGrip;
    ClkReset c;
    ClkStart c;
    MoveAbsJ j1,v1000\\T:=3,fine,tGrip;
    check 1;
    j:=CJointT();
    j.robax.rax_1:=j.robax.rax_1-55;
    ClkReset c;
    ClkStart c;
    MoveAbsJ j,v1000\\T:=3,fine,tGrip;
    check 2;
    MoveJ p,v1000,fine,tGrip;
    ClkReset c;
    ClkStart c;
    MoveL q,v1000\\T:=3,fine,tGrip;
    check 3;
  ENDPROC
ENDMODULE
"""


@pytest.mark.parametrize("target", ["krl", "vplus", "tp", "inform", "urscript"])
def test_the_time_of_one_move(target: str) -> None:
    """Between constant joints, to joints that the run works out, and between constant places."""
    source = read_sources([source_from_text("t.mod", TIMED)], "rapid", Diagnostics())
    found = Diagnostics()
    translation = translate_program(source, target, "abb_irb1200_5_90", None, found)
    back = read_sources([source_from_bytes(f.path, f.data) for f in translation.files], target, Diagnostics())
    own = run_program(source.program, "abb_irb1200_5_90", None, "main")
    theirs = run_program(back.program, "abb_irb1200_5_90", None, translation.renamed.get("main", "main"))
    assert [run.status for run in (own, theirs)] == ["finished"] * 2
    assert [len(run.outputs) for run in (own, theirs)] == [3, 3]
    assert "approximated-move-time" not in [item.code.name for item in found]


@pytest.mark.parametrize("target", ["krl", "inform"])
def test_a_timed_move_to_where_the_arm_is_has_a_speed(target: str) -> None:
    program = "def prog():\n  q = get_actual_joint_positions()\n  servoj(q)\n  set_standard_digital_out(0, True)\nend\n"
    diagnostics = Diagnostics()
    read = read_sources([source_from_text("p.script", program)], "urscript", diagnostics)
    translation = translate_program(read, target, "ur5e", None, diagnostics)
    files = [source_from_bytes(one.path, one.data) for one in translation.files]
    result = run_program(read_sources(files, target, Diagnostics()).program, "ur5e")
    assert result.fault is None and result.outputs

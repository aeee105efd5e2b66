"""The least time of a move (V+ DURATION) in languages that have no such setting."""

from __future__ import annotations

import pytest

from rpl import ir
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
        run_program(source.program, ARM, None, "main", controller="plain"),
        run_program(back.program, ARM, None, translation.renamed.get("main", "main"), controller="plain"),
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
    own = run_program(source.program, "abb_irb1200_5_90", None, "main", controller="plain")
    theirs = run_program(
        back.program, "abb_irb1200_5_90", None, translation.renamed.get("main", "main"), controller="plain"
    )
    assert [run.status for run in (own, theirs)] == ["finished"] * 2
    assert [len(run.outputs) for run in (own, theirs)] == [3, 3]
    assert "approximated-move-time" not in [item.code.name for item in found]


RAPID_MOVES = """MODULE t
  CONST robtarget a:=[[500,0,500],[0,0,1,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
  CONST robtarget b:=[[500,200,500],[0,0,1,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
  CONST robtarget c:=[[500,200,400],[0,0,1,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
  CONST jointtarget j1:=[[0,0,0,0,60,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
  CONST jointtarget j2:=[[40,10,0,0,60,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
  PROC note()
    SetDO do1,1;
  ENDPROC
  PROC main()
    VAR robtarget here;
    MoveAbsJ j1,v500,fine,tool0;
    MoveAbsJ j2,v500\\T:=3,fine,tool0;
    note;
    MoveJ a,v500\\T:=2.5,fine,tool0;
    note;
    MoveL b,v500\\T:=4,fine,tool0;
    MoveL Offs(b,0,0,-100),v500\\T:=0.7,fine,tool0;
    MoveC Offs(b,0,-50,-50),b,v500\\T:=3,fine,tool0;
    here:=CRobT();
    MoveL Offs(here,0,30,0),v500\\T:=2,fine,tool0;
    MoveL b,v500\\T:=2,fine,tool0;
    MoveL RelTool(b,0,0,0\\Rz:=60),v500\\T:=3,fine,tool0;
    MoveJ c,v500\\T:=3,fine,tool0;
  ENDPROC
ENDMODULE
"""
SCRIPT_MOVES = """def main():
  set_tcp(p[0,0,0.1,0,0,0])
  movej([0.2,-1.4,1.6,-1.8,-1.57,0.3], a=1.4, v=1.05)
  movej([0.9,-1.2,1.6,-1.9,-1.57,0.3], t=2)
  p1 = get_actual_tcp_pose()
  movel(pose_add(p1, p[0,0,-0.1,0,0,0]), t=3)
  movel(p1, a=1.2, v=0.25, t=2.5)
  q = get_actual_joint_positions()
  q[0] = q[0] + 0.5
  movej(q, t=1.5)
  movej(p1, t=2)
  i = 0
  while i < 3:
    movel(p[-0.4,-0.2-i*0.05,0.4,0,3.14159,0], t=2)
    i = i + 1
  end
end
"""
PLUS_MOVES = """.PROGRAM main()
 SPEED 100 ALWAYS
 MOVE a
 BREAK
 DURATION 3
 MOVES c
 BREAK
 SET d = SHIFT(c BY 0,-40,20)
 DURATION 1.5
 MOVES d
 BREAK
 DURATION 2 ALWAYS
 APPROS c, 30
 BREAK
 MOVE #PPOINT(10,-60,120,0,60,0)
 BREAK
 MOVE #PPOINT(30,-60,120,0,60,0)
 BREAK
 DRIVE 1, -40, 100
 BREAK
.END
.LOCATIONS
a 330 50 260 0 180 0
c 300 150 200 0 180 30
.END
"""


def driven(program: ir.Program, arm: str, entry: str) -> list[float]:
    """Seconds of each move that goes anywhere, but for the first one."""
    result = run_program(program, arm, None, entry, controller="plain")
    assert result.status == "finished", result.fault
    times = [float(str(event.data["duration"])) for event in result.trace if event.kind == "move"]
    return [time for time in times if time > 0.1][1:]


@pytest.mark.parametrize(
    ("language", "text", "arm", "targets"),
    [
        ("rapid", RAPID_MOVES, "abb_irb1200_5_90", "krl inform tp urscript vplus"),
        ("urscript", SCRIPT_MOVES, "ur5e", "krl inform tp rapid vplus"),
        ("vplus", PLUS_MOVES, ARM, "krl inform tp rapid urscript"),
    ],
)
def test_every_move_takes_its_time(language: str, text: str, arm: str, targets: str) -> None:
    """Also those to a place that is worked out, along an arc, behind calls and where the tool only turns."""
    diagnostics = Diagnostics()
    source = read_sources([source_from_text("main", text)], language, diagnostics)
    wanted = driven(source.program, arm, "main")
    for target in targets.split():
        found = Diagnostics()
        translation = translate_program(source, target, arm, None, found)
        files = [source_from_bytes(one.path, one.data) for one in translation.files]
        back = read_sources(files, target, Diagnostics()).program
        times = driven(back, arm, translation.renamed.get("main", "main"))
        assert times == pytest.approx(wanted, rel=0.03, abs=0.02), target
        assert "approximated-move-time" not in [item.code.name for item in found], target


def test_a_time_that_the_way_does_not_keep_is_not_made_shorter() -> None:
    """The way takes longer at the speed in force; and where nobody knows that, the least time as a time is named."""
    text = """.PROGRAM main()
 SPEED 10 ALWAYS
 MOVE #PPOINT(0,-60,120,0,60,0)
 BREAK
 DURATION 0.5 ALWAYS
 MOVE #PPOINT(60,-60,120,0,60,0)
 BREAK
 HERE there
 SET there = SHIFT(there BY -60,0,0)
 MOVES there
.END
"""
    source = read_sources([source_from_text("main.v2", text)], "vplus", Diagnostics())
    wanted = driven(source.program, ARM, "main")
    assert wanted[0] > 1.0
    for target in ("tp", "urscript"):
        found = Diagnostics()
        translation = translate_program(source, target, ARM, None, found)
        files = [source_from_bytes(one.path, one.data) for one in translation.files]
        back = read_sources(files, target, Diagnostics()).program
        times = driven(back, ARM, translation.renamed.get("main", "main"))
        assert times[0] > 0.9 * wanted[0], target
        assert [item.code.name for item in found].count("least-time-as-time") == 1, target


@pytest.mark.parametrize("target", ["krl", "inform"])
def test_a_timed_move_to_where_the_arm_is_has_a_speed(target: str) -> None:
    program = "def prog():\n  q = get_actual_joint_positions()\n  servoj(q)\n  set_standard_digital_out(0, True)\nend\n"
    diagnostics = Diagnostics()
    read = read_sources([source_from_text("p.script", program)], "urscript", diagnostics)
    translation = translate_program(read, target, "ur5e", None, diagnostics)
    files = [source_from_bytes(one.path, one.data) for one in translation.files]
    result = run_program(read_sources(files, target, Diagnostics()).program, "ur5e", controller="plain")
    assert result.fault is None and result.outputs

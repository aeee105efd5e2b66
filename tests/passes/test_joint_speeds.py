"""Speeds of joint moves between controllers that say them in percent and those that say millimetres a second: each move
takes as long as before. ABB's MoveJ and MoveAbsJ take the speed of the tool (Technical reference, speeddata: v_tcp);
KUKA, FANUC and Yaskawa take percent of the axes' largest speeds.
"""

from __future__ import annotations

import pytest

from rpl.diagnostics import Diagnostics
from rpl.project import ReadProgram, read_sources
from rpl.proof.prove import prove_programs
from rpl.source import source_from_bytes, source_from_text
from rpl.translation import translate_program

JOINTS = "[9E9,9E9,9E9,9E9,9E9,9E9]"
RAPID = f"""MODULE J
  CONST jointtarget home:=[[0,-20,20,0,60,0],{JOINTS}];
  CONST robtarget p1:=[[800,300,900],[0,0,1,0],[0,0,0,0],{JOINTS}];
  CONST robtarget p2:=[[800,-300,900],[0,0,1,0],[-1,0,-1,0],{JOINTS}];
  CONST speeddata mine:=[700,500,5000,1000];
  PROC main()
    MoveAbsJ home,vmax,fine,tool0;
    MoveJ p1,v500,fine,tool0;
    MoveL Offs(p1,0,0,-100),v200,fine,tool0;
    MoveJ p2,mine,fine,tool0;
    MoveL Offs(p2,0,0,-100),v200,fine,tool0;
    MoveAbsJ home,v1000,fine,tool0;
  ENDPROC
ENDMODULE
"""
TP = """/PROG  J
/MN
   1:J P[1] 100% FINE    ;
   2:J P[2] 8% FINE    ;
/POS
P[1]{
   GP1:
	UF : 0, UT : 1,
	J1=   30.000 deg,	J2=    10.000 deg,	J3=   -20.000 deg,
	J4=    0.000 deg,	J5=   -40.000 deg,	J6=     0.000 deg
};
P[2]{
   GP1:
	UF : 0, UT : 1,
	J1=   -30.000 deg,	J2=    0.000 deg,	J3=   -10.000 deg,
	J4=    0.000 deg,	J5=   -70.000 deg,	J6=     50.000 deg
};
/END
"""


_LANGUAGES = {"J.mod": "rapid", "J.ls": "tp"}


def translated(text: str, path: str, target: str, robot: str | None) -> tuple[ReadProgram, ReadProgram, list[str]]:
    """The program, what is read of its translation, and the codes of the reports."""
    told = Diagnostics()
    read = read_sources([source_from_text(path, text)], _LANGUAGES[path], told)
    files = translate_program(read, target, robot, None, told).files
    back = read_sources([source_from_bytes(one.path, one.data) for one in files], target, Diagnostics())
    return read, back, [one.code.name for one in told.items]


def speeds_differ(here: ReadProgram, there: ReadProgram, robot: str) -> list[tuple[int, float]]:
    """Line of the source and percent, of each joint move whose speed is another one."""
    found = prove_programs(here.program, there.program, robot, robot)
    return [(one.a.place.line, one.amount) for one in found.deviations if one.kind == "joint-speed"]


@pytest.mark.parametrize("target", ["tp", "krl", "inform"])
def test_a_joint_move_is_as_fast_in_percent(target: str) -> None:
    here, there, codes = translated(RAPID, "J.mod", target, "abb_irb2400")
    # The first move begins where the robot happens to stand, and goes as fast as it can in both.
    assert all(percent < 4.0 for _, percent in speeds_differ(here, there, "abb_irb2400"))
    assert codes.count("measured-joint-speed") == 3


def test_a_joint_move_is_as_fast_in_millimetres_a_second() -> None:
    here, there, codes = translated(TP, "J.ls", "rapid", "fanuc_m20ia")
    assert all(percent < 4.0 for line, percent in speeds_differ(here, there, "fanuc_m20ia") if line == 4)
    assert "measured-joint-speed" in codes


def test_where_a_move_begins_nowhere_its_speed_is_the_usual_one_and_that_is_said() -> None:
    alone = RAPID.replace("MoveAbsJ home,vmax,fine,tool0;", "MoveAbsJ home,v500,fine,tool0;")
    *_, codes = translated(alone, "J.mod", "tp", "abb_irb2400")
    assert "usual-joint-speed" in codes


def test_without_an_arm_the_rule_of_thumb_stays_and_is_said() -> None:
    *_, codes = translated(RAPID, "J.mod", "tp", None)
    assert "approximated-tool-speed" in codes

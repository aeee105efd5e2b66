"""The joints of a constant place are worked out for targets that cannot calculate them."""

import pytest

from rpl.diagnostics import Diagnostics, Severity
from rpl.project import read_sources
from rpl.proof.prove import prove_programs
from rpl.simulation import entry_name
from rpl.source import source_from_bytes, source_from_text
from rpl.translation import translate_program

ARM = "abb_irb1200_5_90"
RAPID = """MODULE k
  PERS tooldata tGrip:=[TRUE,[[0,0,100],[1,0,0,0]],[1,[0,0,1],[1,0,0,0],0,0,0]];
  CONST robtarget p:=[[500,150,400],[0,0,1,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
  CONST jointtarget home:=[[0,0,0,0,60,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
  PROC main()
    VAR jointtarget j;
    VAR robtarget q;
    MoveAbsJ home,v1000,fine,tGrip;
    q:=CRobT(\\Tool:=tGrip\\WObj:=wobj0);
    j:=CalcJointT(PLACE,tGrip);
    MoveAbsJ j,v1000,fine,tGrip;
  ENDPROC
ENDMODULE
"""


def translated(place: str, target: str) -> tuple[bool, list[str]]:
    read = read_sources([source_from_text("k.mod", RAPID.replace("PLACE", place))], "rapid", Diagnostics())
    diagnostics = Diagnostics()
    written = translate_program(read, target, ARM, None, diagnostics)
    back = read_sources([source_from_bytes(f.path, f.data) for f in written.files], target, Diagnostics())
    result = prove_programs(read.program, back.program, ARM, entry="main", to_entry=entry_name(back.program))
    return result.agrees, [item.code.name for item in diagnostics.of(Severity.LOSS)]


@pytest.mark.parametrize("target", ["vplus", "tp", "inform", "krl", "urscript"])
def test_joints_of_a_constant_place(target: str) -> None:
    assert translated("p", target) == (True, [])


def test_joints_of_a_place_that_is_known_in_a_run_are_refused_by_name() -> None:
    assert translated("q", "vplus")[1] == ["kinematics-lost"]

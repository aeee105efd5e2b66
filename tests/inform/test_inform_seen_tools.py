"""Where the robot is, seen with the tool that the source has set: a job sees it with the tool of its own moves."""

from __future__ import annotations

import re

import pytest
from there_and_back import there_and_back

from rpl.diagnostics import Diagnostics, Severity
from rpl.project import read_sources
from rpl.simulation import run_program
from rpl.source import source_from_bytes, source_from_text
from rpl.translation import translate_program

HOME = "[0, -1.5708, 1.5708, -1.5708, -1.5708, 0]"
HEAD = f"def job():\n  set_tcp(p[0, 0, 0.1, 0, 0, 0])\n  movej({HOME})\n"
LONGER = "set_tcp(p[0, 0, 0.15, 0, 0, 0])\n"
FORMS = [
    f"one = get_actual_tcp_pose()\n{LONGER}other = get_actual_tcp_pose()\nway = point_dist(one, other) - 0.05",
    f"{LONGER}place = get_forward_kin({HOME})\nway = point_dist(place, get_actual_tcp_pose())",
    f"one = get_actual_tcp_pose()\n{LONGER}place = get_forward_kin({HOME})\nway = point_dist(place, one) - 0.05",
    f"{LONGER}there = pose_trans(get_actual_tcp_pose(), p[0, 0, -0.05, 0, 0, 0])\nmovel(there)\n"
    "way = point_dist(get_actual_tcp_pose(), there)",
]


@pytest.mark.parametrize("body", FORMS)
def test_the_tool_of_the_moment(body: str) -> None:
    lines = [*body.splitlines(), "if norm(way) < 0.0005:", "  set_standard_digital_out(0, True)", "end"]
    text = HEAD + "".join(f"  {line}\n" for line in lines) + "end\n"
    source = read_sources([source_from_text("job.script", text)], "urscript", Diagnostics())
    assert run_program(source.program, "ur5e").outputs
    diagnostics = Diagnostics()
    translation = translate_program(source, "inform", "ur5e", None, diagnostics)
    assert not diagnostics.of(Severity.LOSS)
    back = read_sources([source_from_bytes(f.path, f.data) for f in translation.files], "inform", Diagnostics())
    result = run_program(back.program, "ur5e", None, "JOB")
    assert result.status == "finished" and result.outputs


SEVERAL = """MODULE main
PERS tooldata short:=[TRUE,[[0,0,50],[1,0,0,0]],[1,[0,0,1],[1,0,0,0],0,0,0]];
PERS tooldata long:=[TRUE,[[0,0,150],[1,0,0,0]],[1,[0,0,1],[1,0,0,0],0,0,0]];
VAR robtarget here;
PROC main()
  MoveAbsJ [[0,0,0,0,90,0],[9E9,9E9,9E9,9E9,9E9,9E9]],v500,fine,short;
  here:=CRobT(\\Tool:=short);
  MoveJ Offs(here,0,0,-60),v500,fine,short;
  here:=CRobT(\\Tool:=long);
  MoveL Offs(here,0,20,0),v200,fine,long;
  here:=CRobT(\\Tool:=SEEN);
  TPWrite ""\\Num:=Round(here.trans.z);
ENDPROC
ENDMODULE
"""


@pytest.mark.parametrize("seen", ["short", "long", "tool0"])
def test_the_place_with_a_tool_beside_those_of_the_moves(seen: str) -> None:
    """$PX001 has the tool of the last move, so the place is asked for in pulses where moves have several tools."""
    robot = "abb_irb1200_5_90"
    source = read_sources([source_from_text("main.mod", SEVERAL.replace("SEEN", seen))], "rapid", Diagnostics())
    expected = [event.data["text"] for event in run_program(source.program, robot).trace if event.kind == "message"]
    diagnostics = Diagnostics()
    translation = translate_program(source, "inform", robot, None, diagnostics)
    assert not diagnostics.of(Severity.LOSS)
    back = read_sources([source_from_bytes(f.path, f.data) for f in translation.files], "inform", Diagnostics())
    result = run_program(back.program, robot, None, "MAIN")
    assert [event.data["text"] for event in result.trace if event.kind == "message"] == expected != []


AT_JOINTS = """MODULE main
CONST jointtarget home:=[[0,0,0,0,90,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
PERS tooldata long:=[TRUE,[[0,30,150],[1,0,0,0]],[2,[0,0,50],[1,0,0,0],0,0,0]];
VAR robtarget there;
PROC main()
  MoveAbsJ home,v500,fine,tool0;
  there:=CalcRobT(home,long);
  MoveL Offs(there,0,0,-50),v500,fine,tool0;
ENDPROC
ENDMODULE
"""


def test_the_place_at_joints_with_a_tool_beside_that_of_the_moves() -> None:
    """CNVRT makes a place of pulses with the tool that it names; of a pose that stands for the joints it does not. The
    place comes with this tool, and a move to it is driven with the tool of the move."""
    journey = there_and_back({"main.mod": AT_JOINTS}, "rapid", "inform", "abb_irb1600_6_12")
    result = journey.prove()
    assert (result.verdict, result.max_path_mm < 0.01) == ("alike", True), result.as_text()
    assert re.search(r"CNVRT (P\d+) P\d+ BF TL#\(1\)\r\nMULMAT \1 ", journey.text)

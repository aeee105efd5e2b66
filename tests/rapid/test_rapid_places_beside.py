"""A task beside the one that moves asks where the robot is, with the name of that task, tool and work object."""

from __future__ import annotations

import pytest

from rpl import ir
from rpl.diagnostics import Diagnostics, Severity
from rpl.ir.walk import walk
from rpl.project import read_sources
from rpl.simulation import run_program
from rpl.source import source_from_bytes, source_from_text
from rpl.translation import translate_program

SCRIPT = """def main():
  set_tcp(p[0, 0, 0.1, 0, 0, 0])
  global watching = True
  global highest = 0.0
  global turned = 0.0
  thread look():
    while watching:
      here = get_actual_tcp_pose()
      if here[2] > highest:
        highest = here[2]
      end
      q = get_actual_joint_positions()
      if q[0] > turned:
        turned = q[0]
      end
      sync()
    end
  end
  movej([0, -1.5708, -1.5708, -1.5708, 1.5708, 0])
  start = get_actual_tcp_pose()
  eye = run look()
  movel(pose_add(start, p[0, 0, 0.05, 0, 0, 0]))
  movel(start)
  movej([0.2, -1.5708, -1.5708, -1.5708, 1.5708, 0])
  movej([0, -1.5708, -1.5708, -1.5708, 1.5708, 0])
  watching = False
  join eye
  set_standard_digital_out(0, highest - start[2] > 0.045 and highest - start[2] < 0.0501)
  set_standard_digital_out(1, turned > 0.19)
end
"""


def test_a_thread_that_watches_the_tool() -> None:
    diagnostics = Diagnostics()
    read = read_sources([source_from_text("main.script", SCRIPT)], "urscript", diagnostics)
    written = translate_program(read, "rapid", "ur5e", None, diagnostics)
    assert not diagnostics.of(Severity.LOSS)
    (task,) = [file.data.decode() for file in written.files if file.path.startswith("TASK2/") and b"CRobT" in file.data]
    assert 'CRobT(\\TaskName:="T_ROB1"\\Tool:=tCurrent\\WObj:=wobj0)' in task
    assert 'CJointT(\\TaskName:="T_ROB1")' in task
    assert "PERS tooldata tCurrent:=" in task
    back = read_sources([source_from_bytes(f.path, f.data) for f in written.files], "rapid", diagnostics)
    assert not diagnostics.has_errors
    result = run_program(back.program, "ur5e", None, "main")
    assert result.fault is None
    assert [state for _, _, state in result.outputs] == [True, True]


@pytest.mark.parametrize(
    ("text", "function"),
    [
        ('p:=CRobT(\\TaskName:="T_ROB1"\\Tool:=tool0\\WObj:=wobj0);', "current_target"),
        ("j:=CJointT(\\TaskRef:=T_ROB1Id);", "current_joints"),
    ],
)
def test_the_only_robot_by_its_task(text: str, function: str) -> None:
    source = f"MODULE m\n  VAR robtarget p;\n  VAR jointtarget j;\n  PROC main()\n    {text}\n  ENDPROC\nENDMODULE\n"
    diagnostics = Diagnostics()
    read = read_sources([source_from_text("m.mod", source)], "rapid", diagnostics)
    assert not diagnostics.has_errors
    nodes = [node for module in read.program.modules for node in walk(module)]
    assert any(isinstance(node, ir.Builtin) and node.function == function for node in nodes)

"""Ways in a task that the program ends when another task sets a truth value: no target's program can end a task that
moves the robot in a place of its own choice."""

import pytest

from rpl.cell.cellfile import parse_cell
from rpl.diagnostics import Diagnostics, Severity
from rpl.project import read_sources
from rpl.simulation import run_program
from rpl.source import source_from_text
from rpl.translation import translate_program

SCRIPT = """def main():
  global stop_asked = False
  thread guard():
    while not get_standard_digital_in(0):
      sync()
    end
    stop_asked = True
  end
  thread way():
    movel(pose_trans(get_target_tcp_pose(), p[0, 0, -0.05, 0, 0, 0]), v=0.01)
  end
  movej([0.0, -1.5708, -1.5708, -1.5708, 1.5708, 0.0])
  first = get_actual_tcp_pose()
  look = run guard()
  go = run way()
  while not stop_asked:
    sync()
  end
  kill go
  stopl(1.0)
  way_done = point_dist(get_actual_tcp_pose(), first)
  set_standard_digital_out(0, way_done > 0.005 and way_done < 0.045)
end
"""

CELL = '[[input]]\ntime = 3.0\nsignal = "di1"\nvalue = true\n'


@pytest.mark.parametrize("target", ["rapid", "tp"])
def test_a_way_that_the_program_ends_is_refused_at_its_start(target: str) -> None:
    diagnostics = Diagnostics()
    read = read_sources([source_from_text("main.script", SCRIPT)], "urscript", diagnostics)
    assert [each[2] for each in run_program(read.program, "ur5e", parse_cell(CELL)).outputs] == [True]
    translate_program(read, target, "ur5e", None, diagnostics)
    losses = {item.code.name: item.origin.line for item in diagnostics.of(Severity.LOSS)}
    assert losses["moving-task-kept"] == 15

"""Ways that end when another task sets a truth value: an interrupt on the value where the target has one, else a
search for its flag."""

import pytest

from rpl.cell.cellfile import parse_cell
from rpl.diagnostics import Diagnostics, Severity
from rpl.project import read_sources
from rpl.simulation import run_program
from rpl.source import source_from_bytes, source_from_text
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

WRITTEN = {
    "rapid": ("IPers stop_asked,rpl_interrupt_10;", "PERS bool stop_asked"),
    "tp": ("SKIP CONDITION F[1:stop_asked]=ON",),  # M: a skip condition takes a flag
}
CELL = '[[input]]\ntime = 3.0\nsignal = "di1"\nvalue = true\n'


@pytest.mark.parametrize("target", sorted(WRITTEN))
def test_the_way_ends_when_the_value_changes(target: str) -> None:
    diagnostics = Diagnostics()
    read = read_sources([source_from_text("main.script", SCRIPT)], "urscript", diagnostics)
    cell = parse_cell(CELL)
    assert [each[2] for each in run_program(read.program, "ur5e", cell).outputs] == [True]
    written = translate_program(read, target, "ur5e", None, diagnostics)
    assert not diagnostics.of(Severity.LOSS), [item.as_text() for item in diagnostics.of(Severity.LOSS)]
    sources = [source_from_bytes(f.path, f.data) for f in written.files]
    text = "".join(source.text for source in sources)
    assert all(part in text for part in WRITTEN[target])
    back = read_sources(sources, target, diagnostics).program
    result = run_program(back, "ur5e", cell, written.renamed.get("main", "main"))
    assert (result.status, [each[2] for each in result.outputs]) == ("finished", [True])

"""stopl behind a move that has ended says nothing."""

from __future__ import annotations

import pytest

from rpl.cell.cellfile import parse_cell
from rpl.diagnostics import Diagnostics, Severity
from rpl.project import read_sources
from rpl.simulation import run_program
from rpl.source import source_from_bytes, source_from_text
from rpl.translation import translate_program

SCRIPT = """def main():
  movej([0.0, -1.5708, -1.5708, -1.5708, 1.5708, 0.0])
  first = get_actual_tcp_pose()
  speedl([0, 0, 0.05, 0, 0, 0], a=0.5, t=1.0)
  stopl(1.0)
  second = get_actual_tcp_pose()
  set_standard_digital_out(0, second[2] - first[2] > 0.02)
  movel(pose_trans(second, p[0, 0, -0.05, 0, 0, 0]), v=0.1)
  stopl(1.0)
  third = get_actual_tcp_pose()
  set_standard_digital_out(1, norm(second[2] - third[2]) > 0.049)
end
"""


@pytest.mark.parametrize("target", ["krl", "rapid", "tp", "vplus"])
def test_it_is_left_out(target: str) -> None:
    diagnostics = Diagnostics()
    read = read_sources([source_from_text("main.script", SCRIPT)], "urscript", diagnostics)
    written = translate_program(read, target, "ur5e", None, diagnostics)
    assert not diagnostics.of(Severity.LOSS), [item.as_text() for item in diagnostics.of(Severity.LOSS)]
    sources = [source_from_bytes(f.path, f.data) for f in written.files]
    cell = parse_cell('[[input]]\ntime = 4.0\nsignal = "di1"\nvalue = true\n')
    back = read_sources(sources, target, diagnostics).program
    result = run_program(back, "ur5e", cell, written.renamed.get("main", "main"))
    assert result.status == "finished"
    assert [each[2] for each in result.outputs] == [True, True]

"""Data and routines of other languages that have the name of something every RAPID system has declared."""

from __future__ import annotations

import pytest

from dialects.rapid import prelude, types
from dialects.rapid.functions import FUNCTIONS
from dialects.rapid.instructions import INSTRUCTIONS
from postprocessors.rapid.predefined import PREDEFINED
from postprocessors.rapid.tables import RESERVED
from rpl.diagnostics import Diagnostics, Severity
from rpl.project import read_sources
from rpl.simulation import run_program
from rpl.source import source_from_bytes, source_from_text
from rpl.translation import translate_program

SCRIPT = """def main():
  fine = 3
  v100 = 4
  tool0 = 5
  abs = 0.5
  def reset(low, stop=2):
    return low * stop
  end
  sum = reset(fine) + reset(v100, stop=1) + tool0
  movej([0, -1.5708, 1.5708, -1.5708, -1.5708, 0], v=0.5)
  movej([0.2, -1.5708, 1.5708, -1.5708, -1.5708, 0], t=2)
  pos = get_actual_tcp_pose()
  set_standard_digital_out(0, sum == 15)
  set_standard_digital_out(1, norm(0 - abs) == 0.5)
  set_standard_digital_out(2, pos[2] > 0.1)
end
"""


def test_the_program_runs_beside_the_names_of_the_system() -> None:
    diagnostics = Diagnostics()
    read = read_sources([source_from_text("main.script", SCRIPT)], "urscript", diagnostics)
    written = translate_program(read, "rapid", "ur5e", None, diagnostics)
    assert not diagnostics.of(Severity.LOSS)
    text = "".join(file.data.decode() for file in written.files)
    assert written.renamed["fine"] == "fine_2"
    assert "fine_2:=3;" in text
    assert ",fine,tool0;" in text
    back = read_sources([source_from_bytes(f.path, f.data) for f in written.files], "rapid", diagnostics)
    assert not diagnostics.has_errors
    result = run_program(back.program, "ur5e", None, written.renamed.get("main", "main"))
    assert result.fault is None
    assert [state for _, _, state in result.outputs] == [True, True, True]


@pytest.mark.parametrize("names", [prelude.PREDEFINED_NAMES, FUNCTIONS, INSTRUCTIONS, types.TYPES])
def test_the_writer_knows_what_the_reader_has_declared(names: frozenset[str]) -> None:
    assert {name.lower() for name in names} <= PREDEFINED | RESERVED

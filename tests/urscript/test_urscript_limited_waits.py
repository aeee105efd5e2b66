"""A thread moves the robot while the program waits for a signal, and no longer than a time."""

from __future__ import annotations

import pytest

from rpl.cell import Cell
from rpl.cell.cellfile import Reaction
from rpl.diagnostics import Diagnostics, Severity
from rpl.project import read_sources
from rpl.proof.wiring import in_words_of, with_signal_names
from rpl.simulation import run_program
from rpl.source import source_from_bytes, source_from_text
from rpl.translation import translate_program

UNTIL = """  def wait_input(n, limit):
    local waited = 0.0
    while not get_standard_digital_in(n):
      if waited >= limit:
        return False
      end
      waited = waited + get_steptime()
      sync()
    end
    return True
  end
"""
FOR_A_TIME = """  def wait_input(n, limit):
    waited = 0.0
    while waited < limit:
      if get_standard_digital_in(n) == True:
        return True
      end
      sync()
      waited = waited + 0.002
    end
    return False
  end
"""
PROGRAM = """def main():
  start = p[-0.1, -0.4, 0.3, 0, 3.14159, 0]
{function}
  thread feed():
    movel(pose_trans(start, p[0, 0, 0.06, 0, 0, 0]), a=0.5, v=0.02)
  end
  movej([-1.5708, -1.5708, -1.5708, -1.5708, 1.5708, 0])
  movej(start, a=1.4, v=1.05)
  set_standard_digital_out(7, True)
  feeding = run feed()
  reached = wait_input(0, {limit})
  kill feeding
  stopl(2.0)
  gone = point_dist(start, get_actual_tcp_pose())
  set_standard_digital_out(0, reached == {reached} and gone > {least} and gone < {most})
end
"""
# When the signal comes behind the start of the search; the limit, whether it came, and how far the robot went (m).
CASES = [(1.5, 5.0, "True", 0.025, 0.035), (4.0, 5.0, "True", 0.0599, 0.0601), (None, 4.0, "False", 0.0599, 0.0601)]


@pytest.mark.parametrize(
    ("case", "function", "target"),
    [
        *((CASES[0], UNTIL, target) for target in ("krl", "rapid", "tp", "vplus", "inform", "urscript")),
        (CASES[0], FOR_A_TIME, "rapid"),
        (CASES[1], UNTIL, "krl"),
        (CASES[2], FOR_A_TIME, "tp"),
    ],
)
def test_a_search_by_a_thread(case: tuple[float | None, float, str, float, float], function: str, target: str) -> None:
    comes, limit, reached, least, most = case
    text = PROGRAM.format(function=function, limit=limit, reached=reached, least=least, most=most)
    diagnostics = Diagnostics()
    source = read_sources([source_from_text("main.script", text)], "urscript", diagnostics)
    comes_so = Reaction("digital_out[7]", True, comes or 0.0, "digital_in[0]", True)
    cell = Cell(reactions=(comes_so,) if comes is not None else ())
    written = translate_program(source, target, "ur5e", None, diagnostics)
    back = read_sources([source_from_bytes(f.path, f.data) for f in written.files], target, Diagnostics())
    named = with_signal_names(back.program, written.program)
    entry = named.entry or written.renamed.get("main", "main")
    result = run_program(named, "ur5e", in_words_of(cell, source.program, named), entry)
    said = {item.code.name for item in diagnostics if item.severity >= Severity.WARNING}
    assert not diagnostics.of(Severity.LOSS)
    assert [value for _, _, value in result.outputs if value] == [True, True], f"{result.status} {said}"
    assert target in ("vplus", "urscript") or "moving-task-limit" in said

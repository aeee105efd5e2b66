"""Numbers of a location that several steps in a row want are taken out of it once."""

from __future__ import annotations

import pytest

from rpl.diagnostics import Diagnostics
from rpl.project import read_sources
from rpl.simulation import run_program
from rpl.source import source_from_bytes, source_from_text
from rpl.translation import translate_program

CASES = {
    "several steps": ("a = q[0]\n  b = q[1]\n  c = q[2]", 1),
    "one step": ("a = q[0]+q[1]*2\n  b = 1", 1),
    "changed between": ("a = q[0]\n  q = [1, 2, 3, 4, 5, 6]\n  b = q[1]\n  c = q[0]", 2),
    "in a branch": ("a = q[0]\n  if a > 0:\n    b = q[1]\n  end\n  c = q[2]", 3),
    "in a loop": ("a = 0\n  while a < 3:\n    a = a+1+q[0]\n    q = [0.5, 2, 3, 4, 5, 6]\n  end\n  b = q[1]", 2),
}


@pytest.mark.parametrize("name", CASES)
def test_how_often_it_is_taken_apart(name: str) -> None:
    steps, times = CASES[name]
    text = f"""def main():
  global q = [0.1, 0.2, 0.3, 0.4, 0.5, 0.6]
  b = 0
  c = 0
  movej(q)
  {steps}
  set_standard_digital_out(1, a > 0)
  set_standard_digital_out(2, b > 0.1)
  set_standard_digital_out(3, c > 0.25)
  movej(q)
end
"""
    own = read_sources([source_from_text("main.script", text)], "urscript", Diagnostics())
    files = translate_program(own, "vplus", None, None, Diagnostics()).files
    written = "\n".join(file.data.decode("ascii") for file in files)
    assert written.count("DECOMPOSE") == times, written
    back = read_sources([source_from_bytes(f.path, f.data) for f in files], "vplus", Diagnostics())
    shown = [[value for _, _, value in run_program(one.program).outputs] for one in (own, back)]
    assert shown[0] == shown[1] and shown[0]

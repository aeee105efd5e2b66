"""The time since the program began, in languages that only have timers."""

from __future__ import annotations

import pytest

from rpl.diagnostics import Diagnostics, Severity
from rpl.project import read_sources
from rpl.simulation import run_program
from rpl.source import source_from_bytes, source_from_text
from rpl.translation import translate_program

PROGRAM = """
def prog():
  t = time()
  sleep(1.5)
  passed = time().sec - t.sec + (time().nanosec - t.nanosec) / 1000000000
  if norm(passed - 1.5) < 0.05:
    set_standard_digital_out(0, True)
  end
end
"""


@pytest.mark.parametrize("target", ["krl", "rapid", "tp", "vplus", "inform", "urscript", "rpl"])
def test_a_time_is_measured(target: str) -> None:
    diagnostics = Diagnostics()
    read = read_sources([source_from_text("p.script", PROGRAM)], "urscript", diagnostics)
    translation = translate_program(read, target, "ur5e", None, diagnostics)
    assert not list(diagnostics.of(Severity.LOSS))
    files = [source_from_bytes(one.path, one.data) for one in translation.files]
    result = run_program(read_sources(files, target, Diagnostics()).program, "ur5e")
    assert result.fault is None and [state for _, _, state in result.outputs] == [True]

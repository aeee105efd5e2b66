"""Threads that count time by short waits and are ended from outside: they count right where tasks end by themselves."""

from __future__ import annotations

import pytest

from rpl.diagnostics import Diagnostics, Severity
from rpl.project import read_sources
from rpl.proof.wiring import with_signal_names
from rpl.simulation import run_program
from rpl.source import source_from_bytes, source_from_text
from rpl.translation import translate_program

PROGRAM = """def cell():
  global clock = 0.0
  thread stopwatch():
    while True:
      sleep(0.05)
      clock = clock + 0.05
    end
  end
  watch = run stopwatch()
  sleep(4.0)
  kill watch
  set_standard_digital_out(0, clock > 3.85 and clock < 4.1)
  kept = clock
  sleep(1.0)
  set_standard_digital_out(1, clock == kept)
end
"""


@pytest.mark.parametrize("target", ["krl", "rapid", "tp", "urscript", "vplus", "inform", "rpl"])
def test_a_stopwatch(target: str) -> None:
    read = read_sources([source_from_text("cell.script", PROGRAM)], "urscript", Diagnostics())
    diagnostics = Diagnostics()
    written = translate_program(read, target, "ur5e", None, diagnostics)
    assert not [item.as_text() for item in diagnostics.of(Severity.LOSS)]
    back = read_sources([source_from_bytes(one.path, one.data) for one in written.files], target, Diagnostics())
    named = with_signal_names(back.program, written.program)
    result = run_program(named, "ur5e", entry=written.renamed.get("cell", "cell"))
    assert result.status == "finished", result.fault
    assert [bool(value) for _, _, value in result.outputs][-2:] == [True, True]

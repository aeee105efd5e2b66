"""Waits whose condition the target computes in statements of its own are computed again and again, not once."""

from __future__ import annotations

import pytest

from rpl.diagnostics import Diagnostics, Severity
from rpl.project import read_sources
from rpl.simulation import run_program
from rpl.source import source_from_bytes, source_from_text
from rpl.translation import translate_program

ARM = "ur5e"
PROGRAM = """def watch():
  global above = p[0.45, -0.13, 0.40, 2.22144, -2.22144, 0.0]
  global low = p[0.45, -0.13, 0.30, 2.22144, -2.22144, 0.0]
  global seen_at = 0.0
  thread guard():
    while get_actual_tcp_pose()[2] > 0.36:
      sync()
    end
    seen_at = get_actual_tcp_pose()[2]
  end
  movej([0.0, -1.5708, -1.5708, -1.5708, 1.5708, 0.0])
  movel(above)
  beside = run guard()
  movel(low, v=0.05)
  join beside
  if seen_at > 0.35 and seen_at < 0.362:
    set_standard_digital_out(0, True)
  end
end
"""


@pytest.mark.parametrize("target", ["krl", "vplus"])
def test_a_thread_sees_the_robot_pass(target: str) -> None:
    read = read_sources([source_from_text("watch.script", PROGRAM)], "urscript", Diagnostics())
    diagnostics = Diagnostics()
    written = translate_program(read, target, ARM, None, diagnostics)
    assert not [item.as_text() for item in diagnostics.of(Severity.LOSS)]
    assert "polled-wait" in {item.code.name for item in diagnostics.of(Severity.WARNING)}
    back = read_sources([source_from_bytes(f.path, f.data) for f in written.files], target, Diagnostics())
    result = run_program(back.program, ARM, None, written.renamed.get("watch", "watch"), 40.0)
    assert result.status == "finished"
    assert [value for _, _, value in result.outputs] == [True]

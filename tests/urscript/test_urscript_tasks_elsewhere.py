"""Scripts with threads and the offset of the tool, run in the other languages."""

from __future__ import annotations

import pytest

from rpl.diagnostics import Diagnostics, Severity
from rpl.project import ReadProgram, read_sources
from rpl.runtime.trace import RunResult
from rpl.simulation import entry_name, run_program
from rpl.source import source_from_bytes, source_from_text
from rpl.translation import translate_program
from tests.analog_wiring import WIRED
from tests.refusing import refused

ARM = "ur5e"
OTHERS = ("krl", "rapid", "tp", "vplus", "inform", "rpl", "urscript")
TOOL = """def main():
  set_tcp(p[0, 0, 0.2, 0, 0, 0])
  local offset = get_tcp_offset()
  if offset[2] > 0.199 and offset[2] < 0.201:
    set_standard_digital_out(0, True)
  end
  global gap = pose_trans(p[0, 0, 0.1, 0, 0, 0], get_tcp_offset())
  set_standard_digital_out(1, gap[2] > 0.299)
  set_tcp(p[0, 0, 0.25, 0, 0, 0])
  gap = get_tcp_offset()
  set_standard_digital_out(2, gap[2] > 0.249)
end
"""
# The thread counts while the robot moves for about a second; the flag that ends it must not come early.
WATCHED = """def main():
  global running = True
  global turns = 0
  thread watch():
    while running:
      turns = turns + 1
      sleep(0.1)
    end
  end
  movej([0, -1.5708, 1.5708, -1.5708, -1.5708, 0])
  here = get_actual_tcp_pose()
  h = run watch()
  movel(pose_trans(p[0, 0, 0.1, 0, 0, 0], here), a=1.2, v=0.1)
  running = False
  join h
  set_standard_digital_out(0, turns > 7 and turns < 16)
end
"""


def translated(text: str, target: str) -> tuple[RunResult, list[str], str]:
    """The run of what was written, the losses that were named, and the text."""
    diagnostics = Diagnostics()
    read = read_sources([source_from_text("main.script", text)], "urscript", diagnostics)
    written = translate_program(read, target, ARM, None, diagnostics, analog=WIRED)
    back: ReadProgram = read_sources([source_from_bytes(f.path, f.data) for f in written.files], target, Diagnostics())
    entry = written.renamed.get("main", "main") if target != "rpl" else entry_name(back.program)
    losses = [item.code.name for item in diagnostics.of(Severity.LOSS)]
    return run_program(back.program, ARM, None, entry), losses, "".join(f.data.decode() for f in written.files)


@pytest.mark.parametrize("target", OTHERS)
def test_the_offset_of_the_tool_is_read(target: str) -> None:
    result, losses, _ = translated(TOOL, target)
    assert (result.status, losses) == ("finished", [])
    assert [each[2] for each in result.outputs] == [True, True, True]


@pytest.mark.parametrize("target", ["krl", "vplus"])
def test_a_flag_that_a_thread_looks_at_is_set_when_the_robot_stands(target: str) -> None:
    result, losses, text = translated(WATCHED, target)
    assert (result.status, losses) == ("finished", [])
    assert [each[2] for each in result.outputs] == [True], text


# One assignment of what the program looks at is never divided; two of them are, and so is one that both assign.
COUNTED = """def main():
  global seen = 0
  global last = 0
  thread conveyor():
    while True:
      enter_critical
      {section}
      exit_critical
      sleep(0.2)
    end
  end
  local c = run conveyor()
  {started}
  sleep(1.1)
  kill c
  local counted = seen
  sleep(0.5)
  set_standard_digital_out(0, seen >= 5 and seen <= 7 and counted == seen and last < 9)
end
"""


@pytest.mark.parametrize("target", [one for one in OTHERS if one not in ("rpl", "urscript")])
def test_a_critical_section_with_one_access_is_left_out(target: str) -> None:
    result, losses, _ = translated(COUNTED.format(section="seen = seen + 1", started="sleep(0.1)"), target)
    assert (result.status, losses) == ("finished", [])
    assert [each[2] for each in result.outputs] == [True]


@pytest.mark.parametrize("target", ["krl", "rapid", "tp", "vplus"])
def test_a_critical_section_that_others_may_divide_is_refused(target: str) -> None:
    for section, started in (
        ("seen = seen + 1\n      last = seen", "sleep(0.1)"),
        ("seen = seen + 1", "seen = seen + 0"),
    ):
        text = COUNTED.format(section=section, started=started)
        told = refused(text, "urscript", target, ARM)
        line, end = (text[: text.index(f"{word}_critical")].count("\n") + 1 for word in ("enter", "exit"))
        assert [at for name, at in told if name == "critical-section-lost"] == [line]
        assert end not in [at for _, at in told]

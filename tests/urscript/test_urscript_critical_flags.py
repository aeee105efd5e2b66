"""Critical sections of threads in languages without them: flags that keep the sections apart."""

from __future__ import annotations

import pytest
from test_urscript_tasks_elsewhere import OTHERS, translated

# The sections read and assign, so they must not overlap; the last thread is ended while it wants to go into one.
PUMPS = """def main():
  global tank = 0
  global most = 0
  thread fill():
    n = 0
    while n < 6:
      enter_critical
      local seen = tank
      tank = seen + 2
      exit_critical
      sleep(0.05)
      n = n + 1
    end
  end
  thread draw():
    n = 0
    while n < 4:
      enter_critical
      tank = tank - 1
      exit_critical
      sleep(0.07)
      n = n + 1
    end
  end
  thread note():
    while True:
      enter_critical
      if tank > most:
        most = tank
      end
      exit_critical
      sleep(0.02)
    end
  end
  a = run fill()
  b = run draw()
  c = run note()
  join a
  join b
  sleep(0.1)
  kill c
  enter_critical
  tank = tank + 100
  exit_critical
  sleep(0.2)
  set_standard_digital_out(0, tank == 108)
  set_standard_digital_out(1, most == 8)
end
"""


@pytest.mark.parametrize("target", [one for one in OTHERS if one not in ("rpl", "urscript")])
def test_sections_of_several_threads(target: str) -> None:
    result, losses, text = translated(PUMPS, target)
    assert (result.status, losses) == ("finished", []), text
    assert [each[2] for each in result.outputs] == [True, True]
    assert "fill_inside" in text or target == "inform"  # it has no names


@pytest.mark.parametrize(
    ("old", "new"),
    [
        ("  sleep(0.1)\n  kill c", "  tank = tank + 0\n  kill c"),  # another task assigns it outside of a section
        ("      tank = tank - 1\n", "      if tank > 90:\n        return\n      end\n      tank = tank - 1\n"),
    ],
)
def test_what_flags_cannot_keep_apart_is_named(old: str, new: str) -> None:
    assert old in PUMPS
    _, losses, _ = translated(PUMPS.replace(old, new), "vplus")
    assert "critical-section-lost" in losses

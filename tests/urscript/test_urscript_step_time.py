"""A time counted in cycles of the controller: what the cycles of another one last is what is counted there."""

from __future__ import annotations

import pytest
from test_urscript_tasks_elsewhere import OTHERS, translated

PATIENCE = """def main():
  clock = 0.0
  global answered = False
  thread answer():
    sleep(0.8)
    answered = True
  end
  h = run answer()
  while not answered and clock < 5.0:
    clock = clock + get_steptime()
    sync()
  end
  set_standard_digital_out(0, clock > 0.5 and clock < 2.0)
end
"""


@pytest.mark.parametrize("target", [one for one in OTHERS if one != "krl"])
def test_time_is_counted_in_cycles(target: str) -> None:
    result, losses, text = translated(PATIENCE, target)
    assert (result.status, losses) == ("finished", []), text
    assert [each[2] for each in result.outputs] == [True], text


@pytest.mark.parametrize(("target", "shown"), [("urscript", "get_steptime()"), ("tp", "+0.01 "), ("vplus", "0.002")])
def test_what_a_cycle_is_written_as(target: str, shown: str) -> None:
    _, _, text = translated(PATIENCE, target)
    assert shown in text

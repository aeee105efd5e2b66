"""A thread moves the robot while the program waits for a signal, and no longer than a time: the end of the time would
not end the motion of a routine, so the start of the thread is refused."""

from __future__ import annotations

import pytest

from tests.refusing import refused

PROGRAM = """def main():
  start = p[-0.1, -0.4, 0.3, 0, 3.14159, 0]
  def wait_input(n, limit):
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
  thread feed():
    movel(pose_trans(start, p[0, 0, 0.06, 0, 0, 0]), a=0.5, v=0.02)
  end
  movel(start, a=1.2, v=0.25)
  feeding = run feed()
  reached = wait_input(0, 4.0)
  kill feeding
  stopl(2.0)
  set_standard_digital_out(0, reached)
end
"""


@pytest.mark.parametrize("target", ["krl", "rapid", "tp", "inform"])
def test_the_start_is_refused(target: str) -> None:
    told = refused(PROGRAM, "urscript", target, "ur5e")
    assert told[0] == ("moving-task-kept", 1 + PROGRAM.splitlines().index("  feeding = run feed()"))

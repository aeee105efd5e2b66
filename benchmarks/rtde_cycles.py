"""How many cycles of RTDE are missed: 500 Hz for a minute, while a program moves the robot.

    python -m benchmarks.rtde_cycles [SECONDS]

A cycle is missed when its values come more than one and a half cycles behind those before. The virtual controller runs
in a process of its own, as for any client; the aim is 2 % on two cores.
"""

from __future__ import annotations

import socket
import sys
import tempfile
import time
from itertools import pairwise
from pathlib import Path

from rpl.controllers.ur.exchange import Exchange
from tests.controllers.serving import served

RATE_HZ = 500.0
MISSED = 1.5  # cycles
PROGRAM = """def moving():
  while True:
    movej([0.4, -1.57, -1.57, -1.57, 1.57, 0], a=1.4, v=1.05)
    movej([-0.4, -1.57, -1.57, -1.57, 1.57, 0], a=1.4, v=1.05)
  end
end
"""


def measured(seconds: float) -> tuple[int, float, float]:
    """How many packages came, the share of missed cycles, and the longest gap (s)."""
    with (
        tempfile.TemporaryDirectory() as name,
        served("ur", Path(name), "--robot", "ur5e") as here,
        socket.create_connection((here.host, here.ports["secondary"])) as stream,
        Exchange(here.profile(Path(name))) as exchange,
    ):
        stream.sendall(PROGRAM.encode())
        recipe = exchange.wanted(("timestamp", "actual_q", "actual_TCP_pose", "runtime_state"), RATE_HZ)
        exchange.start()
        until = time.monotonic() + 60.0
        while exchange.next(recipe)["runtime_state"] != 2:
            assert time.monotonic() < until, "the program does not run"
        came, end = [time.monotonic()], time.monotonic() + seconds
        while came[-1] < end:
            exchange.next(recipe)
            came.append(time.monotonic())
    gaps = [after - before for before, after in pairwise(came)]
    missed = sum(gap > MISSED / RATE_HZ for gap in gaps)
    return len(gaps), missed / (seconds * RATE_HZ), max(gaps)


def main() -> None:
    seconds = float(sys.argv[1]) if len(sys.argv) > 1 else 60.0
    count, share, longest = measured(seconds)
    print(f"{count} packages in {seconds:g} s, missed {100.0 * share:.2f} %, longest gap {1000.0 * longest:.1f} ms")


if __name__ == "__main__":
    main()

"""One hour of robot motion: how long it takes to run, and to sample every 12 ms; and what the samples occupy.

python benchmarks/motion_sampling.py [--hours 1] [--step 0.012]

The program drives joint moves, lines, arcs and rounded corners with a turning tool, over and over. Times are seconds of
the processor, so that other work on the machine does not count.
"""

from __future__ import annotations

import argparse
import sys
import tempfile
import time
import tracemalloc
from pathlib import Path

import numpy as np

from rpl.diagnostics import Diagnostics
from rpl.emulator.model import load_robot
from rpl.project import read_program
from rpl.report.sampling import driven_moves, moments, sample_run
from rpl.runtime.limits import DEFAULTS
from rpl.simulation import run_program

ROBOT = "kuka_kr6r900sixx"
# One round of the program, moves of all kinds.
ROUND = """\
  PTP {A1 0,A2 -90,A3 90,A4 0,A5 60,A6 0}
  PTP {A1 30,A2 -80,A3 100,A4 20,A5 50,A6 40} C_PTP
  PTP {A1 -20,A2 -85,A3 95,A4 -10,A5 65,A6 -30}
  PTP {A1 0,A2 -90,A3 110,A4 0,A5 60,A6 0}
  LIN {X 500,Y 0,Z 550,A 180,B 10,C 180}
  LIN {X 500,Y 150,Z 550,A 170,B 15,C 180} C_DIS
  LIN {X 450,Y 150,Z 450,A 160,B 20,C 170} C_DIS
  LIN {X 450,Y -150,Z 450,A 180,B 10,C 180}
  CIRC {X 520,Y 0,Z 470},{X 450,Y 150,Z 500,A 180,B 10,C 180}
  LIN {X 500,Y 0,Z 550,A 150,B 10,C 180}
"""


def program(rounds: int) -> str:
    head = ["DEF hour()", "INT i", "BAS(#INITMOV,0)", "$VEL.CP=0.12", "$APO.CDIS=15", f"FOR i=1 TO {rounds}"]
    return "\n".join([*head, ROUND.rstrip(), "ENDFOR", "END", ""])


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--hours", type=float, default=1.0)
    parser.add_argument("--step", type=float, default=0.012)
    options = parser.parse_args()
    model = load_robot(ROBOT)
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "hour.src"
        path.write_text(program(100_000))
        read = read_program([path], None, Diagnostics()).program
    started = time.process_time()
    result = run_program(read, model, max_time_s=3600.0 * options.hours, max_statements=sys.maxsize, limits=DEFAULTS)
    ran = time.process_time() - started
    moves = driven_moves(result)
    print(f"run:             {ran:7.2f} s for {result.time_s:.0f} s of motion, {len(moves)} moves ({result.status})")
    started = time.process_time()
    count = 0
    for event in moves:
        for leg in event.legs:
            times = moments(leg.start_s, leg.duration_s, options.step) - leg.start_s + leg.offset_s
            count += len(leg.plan.joints_at(np.clip(times, leg.offset_s, leg.offset_s + leg.duration_s)))
    took = time.process_time() - started
    print(f"joints:          {took:7.2f} s for {count} samples, {1e6 * took / count:.1f} µs each")
    started = time.process_time()
    samples = sample_run(result, model, options.step)
    took = time.process_time() - started
    print(f"whole samples:   {took:7.2f} s for {len(samples)}: joints, speeds, accelerations, tool")
    tracemalloc.start()
    samples = sample_run(result, model, options.step)
    kept, peak = tracemalloc.get_traced_memory()
    print(
        f"their memory:    {kept / 1e6:7.1f} MB, {kept / len(samples):.0f} bytes a sample; at most {peak / 1e6:.1f} MB"
    )


if __name__ == "__main__":
    main()

"""One hour of robot motion: how long it takes to run, and to sample every 12 ms; and what the samples occupy.

python benchmarks/motion_sampling.py [--hours 1] [--step 0.012]

The program drives joint moves, lines, arcs and rounded corners with a turning tool, over and over: once as a cycle that
repeats, as production programs do, and once with every round at another place, so that no move is like another one.
Times are seconds of the processor, so that other work on the machine does not count.
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
from rpl.emulator.model import RobotModel, load_robot
from rpl.project import read_program
from rpl.report.sampling import driven_moves, moments, sample_run
from rpl.runtime.limits import DEFAULTS
from rpl.runtime.trace import RunResult
from rpl.simulation import run_program

ROBOT = "kuka_kr6r900sixx"
# One round of the program, moves of all kinds; {a} degrees and {y} mm shift it.
ROUND = """\
  PTP {A1 0+{a},A2 -90,A3 90,A4 0,A5 60,A6 0}
  PTP {A1 30,A2 -80+{a},A3 100,A4 20,A5 50,A6 40} C_PTP
  PTP {A1 -20,A2 -85,A3 95+{a},A4 -10,A5 65,A6 -30}
  PTP {A1 0,A2 -90,A3 110,A4 0,A5 60,A6 0+{a}}
  LIN {X 500,Y 0+{y},Z 550,A 180,B 10,C 180}
  LIN {X 500,Y 150+{y},Z 550,A 170,B 15,C 180} C_DIS
  LIN {X 450,Y 150+{y},Z 450,A 160,B 20,C 170} C_DIS
  LIN {X 450,Y -150+{y},Z 450,A 180,B 10,C 180}
  CIRC {X 520,Y 0+{y},Z 470},{X 450,Y 150+{y},Z 500,A 180,B 10,C 180}
  LIN {X 500,Y 0+{y},Z 550,A 150,B 10,C 180}
"""


def program(rounds: int, shifts: bool) -> str:
    """The rounds one after the other, all alike or each one shifted a little."""
    body = ROUND.replace("+{a}", "+i*0.001" if shifts else "").replace("+{y}", "+i*0.01" if shifts else "")
    head = ["DEF hour()", "INT i", "BAS(#INITMOV,0)", "$VEL.CP=0.12", "$APO.CDIS=15", f"FOR i=1 TO {rounds}"]
    return "\n".join([*head, body.rstrip(), "ENDFOR", "END", ""])


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--hours", type=float, default=1.0)
    parser.add_argument("--step", type=float, default=0.012)
    options = parser.parse_args()
    model = load_robot(ROBOT)
    run(program(3, shifts=False), model, 1.0)  # what is imported at the first run is measured by start_time.py
    for title, shifts in (("a cycle that repeats", False), ("every round elsewhere", True)):
        print(title)
        result = run(program(100_000, shifts), model, 3600.0 * options.hours)
        sample(result, model, options.step)


def run(text: str, model: RobotModel, seconds: float) -> RunResult:
    """The program run for that long."""
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "hour.src"
        path.write_text(text)
        read = read_program([path], None, Diagnostics()).program
    started = time.process_time()
    result = run_program(read, model, max_time_s=seconds, max_statements=sys.maxsize, limits=DEFAULTS)
    took = time.process_time() - started
    if seconds > 1.0:
        moves = len(driven_moves(result))
        print(f"  run:             {took:7.2f} s for {result.time_s:.0f} s of motion, {moves} moves ({result.status})")
    return result


def sample(result: RunResult, model: RobotModel, step_s: float) -> None:
    """The run at even moments, and what that takes."""
    started = time.process_time()
    count = 0
    for event in driven_moves(result):
        for leg in event.legs:
            times = moments(leg.start_s, leg.duration_s, step_s) - leg.start_s + leg.offset_s
            count += len(leg.plan.joints_at(np.clip(times, leg.offset_s, leg.offset_s + leg.duration_s)))
    took = time.process_time() - started
    print(f"  joints:          {took:7.2f} s for {count} samples, {1e6 * took / count:.1f} µs each")
    started = time.process_time()
    samples = sample_run(result, model, step_s)
    took = time.process_time() - started
    print(f"  whole samples:   {took:7.2f} s for {len(samples)}: joints, speeds, accelerations, tool")
    tracemalloc.start()
    samples = sample_run(result, model, step_s)
    kept, peak = tracemalloc.get_traced_memory()
    tracemalloc.stop()
    each = kept / len(samples)
    print(f"  their memory:    {kept / 1e6:7.1f} MB, {each:.0f} bytes a sample; at most {peak / 1e6:.1f} MB")


if __name__ == "__main__":
    main()

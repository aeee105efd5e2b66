"""How long inverse and forward kinematics take a pose: every branch, in batches and one at a time.

python benchmarks/inverse_kinematics.py [ROBOT...] [--poses 1000]

Each figure is the best of many repetitions, which is the cost of the arithmetic on a machine that has nothing else to
do. The table is the one of docs/performance.md.
"""

from __future__ import annotations

import argparse
import time
from collections.abc import Callable

import numpy as np

from rpl.emulator.model import RobotModel, load_robot

ROBOTS = (
    "kuka_kr6r900sixx",
    "abb_irb120_3_58",
    "fanuc_m20ia",
    "motoman_gp7",
    "staubli_tx90",
    "ur5e",
    "adept_cobra_s600",
)
REPETITIONS = 60


def best_us(call: Callable[[], object]) -> float:
    """Microseconds of the fastest call."""
    times = []
    for _ in range(REPETITIONS):
        started = time.perf_counter()
        call()
        times.append(time.perf_counter() - started)
    return 1e6 * min(times)


def row(model: RobotModel, poses: int) -> str:
    joints = np.random.default_rng(0).uniform(model.limits[:, 0], model.limits[:, 1], (poses, model.axes))
    flanges = model.forward(joints)
    found = model.inverse_batch(flanges, joints)
    missed = np.abs(model.forward(np.nan_to_num(found.joints)) - flanges[:, None]).max(axis=(2, 3))[found.valid].max()
    batch = best_us(lambda: model.inverse_batch(flanges, joints)) / poses
    single = best_us(lambda: model.inverse_batch(flanges[:1], joints[:1]))
    forward = best_us(lambda: model.forward(joints)) / poses
    branches = found.valid.shape[1]
    return f"| `{model.name}` | {branches} | {batch:.2f} | {single:.0f} | {forward:.2f} | {missed:.0e} |"


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("robots", nargs="*", default=ROBOTS)
    parser.add_argument("--poses", type=int, default=1000)
    options = parser.parse_args()
    inverse = f"inverse, µs a pose of {options.poses} | inverse, µs alone"
    print(f"| arm | branches | {inverse} | forward, µs a pose | missed, mm |")
    print("|---|---|---|---|---|---|")
    for name in options.robots:
        print(row(load_robot(name), options.poses))


if __name__ == "__main__":
    main()

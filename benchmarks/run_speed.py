"""How fast programs run on the emulated robot: simulated seconds per second, for samples or any program.

python benchmarks/run_speed.py [PATH...] [--robot R]
"""

from __future__ import annotations

import argparse
import time
import tomllib
from pathlib import Path

from rpl.diagnostics import Diagnostics
from rpl.emulator.model import load_robot
from rpl.project import read_program
from rpl.simulation import run_program

ROOT = Path(__file__).parents[1]


def samples() -> list[tuple[Path, str | None]]:
    """Every sample with the robot that it expects."""
    found = []
    for expected in sorted((ROOT / "samples").glob("*/*/expected.toml")):
        found.append((expected.parent, tomllib.loads(expected.read_text("utf-8")).get("robot")))
    return found


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("paths", nargs="*", type=Path)
    parser.add_argument("--robot")
    options = parser.parse_args()
    cases = [(path, options.robot) for path in options.paths] or samples()
    for path, robot in cases:
        program = read_program([path], None, Diagnostics()).program
        model = load_robot(robot) if robot else None
        started = time.perf_counter()
        result = run_program(program, model)
        took = time.perf_counter() - started
        print(f"{result.time_s:9.2f} s simulated in {took:6.2f} s ({result.time_s / took:7.1f} times)  {path}")


if __name__ == "__main__":
    main()

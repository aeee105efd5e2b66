"""How long the command line takes to start: the best of several runs of each command.

python benchmarks/start_time.py [--runs 5]
"""

from __future__ import annotations

import argparse
import subprocess
import sys
import tempfile
import time
from pathlib import Path

from generate import GENERATORS


def best(arguments: list[str], runs: int) -> float:
    times = []
    for _ in range(runs):
        started = time.perf_counter()
        subprocess.run([sys.executable, "-m", "rpl.cli.main", *arguments], capture_output=True, check=False)
        times.append(time.perf_counter() - started)
    return min(times)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--runs", type=int, default=5)
    runs = parser.parse_args().runs
    with tempfile.TemporaryDirectory() as folder:
        commands = [["--version"], ["--help"], ["dialects"], ["robots"]]
        for name, (generate, path) in GENERATORS.items():
            file = Path(folder) / name / path
            file.parent.mkdir()
            file.write_text(generate(20))
            commands.append(["check", str(file)])
        for arguments in commands:
            print(f"{best(arguments, runs):6.3f} s  rpl {' '.join(Path(word).name for word in arguments)}")


if __name__ == "__main__":
    main()

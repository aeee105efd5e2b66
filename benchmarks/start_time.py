"""How long the command line takes to start: the best of several runs of each command, in seconds of the processor.

    python benchmarks/start_time.py [--runs 5]

With byte code, as an installed package has it: without, each start compiles all modules anew (0.1 s more).
"""

from __future__ import annotations

import argparse
import os
import resource
import subprocess
import sys
import tempfile
from pathlib import Path

from generate import GENERATORS


def best(arguments: list[str], runs: int, byte_code: Path) -> float:
    """The first run writes the byte code."""
    wanted = {"PYTHONDONTWRITEBYTECODE": "", "PYTHONPYCACHEPREFIX": str(byte_code)}
    times = []
    for _ in range(runs + 1):
        before = resource.getrusage(resource.RUSAGE_CHILDREN)
        words = [sys.executable, "-m", "rpl.cli.main", *arguments]
        subprocess.run(words, capture_output=True, check=False, env={**os.environ, **wanted})
        after = resource.getrusage(resource.RUSAGE_CHILDREN)
        times.append(after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime)
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
            seconds = best(arguments, runs, Path(folder) / "code")
            print(f"{seconds:6.3f} s  rpl {' '.join(Path(word).name for word in arguments)}")


if __name__ == "__main__":
    main()

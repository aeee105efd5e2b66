"""A translation has the same bytes each time, in whatever order sets of words come out."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import pytest

SELFCHECK = Path(__file__).parents[1] / "selfcheck"


@pytest.mark.parametrize(
    ("file", "target", "robot"), [("rapid_more_frames/Frames.mod", "krl", "abb_irb1200_5_90")]
)  # a target that moves use in several frames
def test_the_order_of_sets_does_not_show(file: str, target: str, robot: str, tmp_path: Path) -> None:
    written = []
    for seed in ("1", "2"):
        out = tmp_path / seed
        command = [sys.executable, "-m", "rpl.cli.main", "translate", str(SELFCHECK / file), "--to", target]
        command += ["--robot", robot, "-o", str(out)]
        subprocess.run(command, env={**os.environ, "PYTHONHASHSEED": seed}, check=False, capture_output=True)
        written.append({path.name: path.read_bytes() for path in sorted(out.iterdir())})
    assert written[0] and written[0] == written[1]

"""Runs a script of a client in its environment, against a virtual controller that listens."""

from __future__ import annotations

import json
import subprocess
from pathlib import Path
from typing import Any

_ENDED_S = 240.0


def run_client(python: Path, script: str, *words: str | int) -> dict[str, Any]:
    """What the script prints at last, as JSON. Raises AssertionError with what it said when it fails."""
    command = [str(python), "-c", script, *map(str, words)]
    done = subprocess.run(command, capture_output=True, text=True, timeout=_ENDED_S, check=False)
    assert done.returncode == 0, done.stderr[-3000:]
    found = json.loads(done.stdout.strip().splitlines()[-1])
    assert isinstance(found, dict)
    return found

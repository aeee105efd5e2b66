"""Other people's clients against our virtual controllers, unchanged, each in an environment of its own below
`.venv/clients`: their packages want versions of others that ours do not."""

from __future__ import annotations

import os
import subprocess
import sys
import time
from collections.abc import Callable, Sequence
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
_INSTALLED_S, _WAITED_S = 900.0, 900.0
ClientEnvironment = Callable[[str, Sequence[str]], Path]


@pytest.fixture(scope="session")
def client_environment() -> ClientEnvironment:
    """`client_environment(name, packages)`: the Python of an environment that has these packages (with their versions);
    built once. The test is skipped, with the reason, when they cannot be installed."""
    return _environment


def _environment(name: str, packages: Sequence[str]) -> Path:
    folder = ROOT / ".venv" / "clients" / name
    python = folder / ("Scripts" if os.name == "nt" else "bin") / "python"
    stamp, wanted = folder / "packages.txt", "\n".join(packages)
    if stamp.is_file() and stamp.read_text(encoding="utf-8") == wanted:
        return python
    folder.mkdir(parents=True, exist_ok=True)
    lock = folder.with_name(f"{name}.lock")
    _take(lock)
    try:
        if not stamp.is_file() or stamp.read_text(encoding="utf-8") != wanted:
            _build(folder, python, packages)
            stamp.write_text(wanted, encoding="utf-8")
    finally:
        lock.rmdir()
    return python


def _take(lock: Path) -> None:
    """One worker builds; the others wait."""
    until = time.monotonic() + _WAITED_S
    while True:
        try:
            lock.mkdir()
        except FileExistsError:
            if time.monotonic() > until:
                pytest.skip(f"somebody else builds this environment, or was ended while building: remove {lock}")
            time.sleep(0.2)
        else:
            return


def _build(folder: Path, python: Path, packages: Sequence[str]) -> None:
    quiet = ["--quiet", "--disable-pip-version-check", "--no-input"]
    commands = ([sys.executable, "-m", "venv", str(folder)], [str(python), "-m", "pip", "install", *quiet, *packages])
    for command in commands:
        try:
            done = subprocess.run(command, capture_output=True, text=True, timeout=_INSTALLED_S, check=False)
        except subprocess.TimeoutExpired:
            pytest.skip(f"{', '.join(packages)} cannot be installed in {_INSTALLED_S:.0f} s")
        if done.returncode != 0:
            last = (done.stderr.strip().splitlines() or ["no reason is said"])[-1]
            pytest.skip(f"{', '.join(packages)} cannot be installed here: {last}")

"""A virtual controller in a process of its own, as people start it: `rpl serve` with free ports of this machine."""

from __future__ import annotations

import json
import subprocess
import sys
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from rpl.controllers.profile import Profile
from rpl.controllers.vendors import vendor

READY_S = 120.0
ENDED_S = 60.0


@dataclass(frozen=True)
class Served:
    """A controller that listens. `transcript`: the file in which it keeps what it is told."""

    maker: str
    host: str
    ports: Mapping[str, int]
    transcript: Path
    process: subprocess.Popen[str]

    def profile(self, folder: Path, patience_s: float = 10.0, **more: Any) -> Profile:
        """Its profile; journals and backups are below `folder`."""
        made = vendor(self.maker)
        return Profile(
            "here",
            self.maker,
            made.rules,
            made.ports,
            made.path,
            host=self.host,
            ports=self.ports,
            patience_s=patience_s,
            state_folder=folder / ".rpl",
            **more,
        )

    def told(self) -> list[dict[str, Any]]:
        """What it was told so far."""
        return [json.loads(line) for line in self.transcript.read_text(encoding="utf-8").splitlines()]

    def kinds(self) -> set[str]:
        return {one["kind"] for one in self.told()}

    def stop(self) -> str:
        """Switch it off as a process manager does; its last words."""
        self.process.terminate()
        _, said = self.process.communicate(timeout=ENDED_S)
        return said


@contextmanager
def served(maker: str, folder: Path, *words: str | Path) -> Iterator[Served]:
    """`rpl serve MAKER` with further words of the command, until the block ends."""
    transcript = folder / "transcript.jsonl"
    command = [sys.executable, "-m", "rpl.cli.main", "serve", maker, *map(str, words)]
    command += ["--any-port", "--host", "127.0.0.1", "--transcript", str(transcript)]
    process = subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
    try:
        assert process.stdout is not None
        line = process.stdout.readline()
        if not line:
            raise AssertionError(f"rpl serve did not begin: {process.communicate(timeout=READY_S)[1]}")
        ready = json.loads(line)
        yield Served(maker, ready["host"], ready["ports"], transcript, process)
    finally:
        if process.poll() is None:
            process.kill()
            said = process.communicate(timeout=ENDED_S)[1]
            assert "Traceback" not in said, said

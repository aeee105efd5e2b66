"""What is to be done with every project of an archive."""

from __future__ import annotations

import json
from dataclasses import asdict, dataclass, field
from hashlib import sha256
from pathlib import Path

from rpl import __version__
from rpl.runtime.limits import DEFAULTS, Limits

CHECK, RUN, TRANSLATE = "check", "run", "translate"


@dataclass(frozen=True, slots=True)
class Asked:
    """`kind`: check, run or translate. `target`: the language to write. `robot`: the arm that the programs were written
    for (None: the one that a backup names), `to_robot`: the one that will run the result. `limits`: of each run."""

    kind: str
    target: str = ""
    dialect: str | None = None
    robot: str | None = None
    to_robot: str | None = None
    prove: bool = False
    limits: Limits = field(default=DEFAULTS)

    def key(self) -> str:
        """The same for questions that have the same answer: options, our version, and what robot files say."""
        robots = [sha256(_bytes(name)).hexdigest() for name in (self.robot, self.to_robot) if name is not None]
        whole = json.dumps([__version__, asdict(self), robots], sort_keys=True)
        return sha256(whole.encode("utf-8")).hexdigest()


def _bytes(robot: str) -> bytes:
    """A robot file of the user's; one of ours is known by its name."""
    return Path(robot).read_bytes() if robot.endswith(".toml") else robot.encode("utf-8")

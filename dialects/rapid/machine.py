"""The arm that a backup is of: its type as the configuration of motion (SYSPAR/MOC.cfg) names it.

Seen in backups of RobotWare 6: `ROBOT: -name "ROB_1" -use_robot_type "ROB1_6700_LeanID_2.65_220"`.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence

from rpl.registry import Aside
from rpl.source import Source

_TYPE = re.compile(r'-use_robot_type\s+"([^"\n]+)"')


def arms(sources: Sequence[Source]) -> Iterator[tuple[str, str]]:
    """The types of the arms, with the file that names each."""
    for source in sources:
        if source.text.lstrip("\ufeff \t\r\n").upper().startswith("MOC:CFG"):
            yield from ((found[1], source.path) for found in _TYPE.finditer(source.text))


def is_backup(names: frozenset[str]) -> bool:
    """A backup has the folders BACKINFO, HOME, RAPID and SYSPAR."""
    return "backinfo/" in names or {"rapid/", "syspar/"} <= names


def aside(source: Source) -> Aside | None:
    """What a backup says of itself."""
    return Aside("what a backup says of itself") if "/backinfo/" in f"/{source.path.lower()}" else None

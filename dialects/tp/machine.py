"""The arm that a backup is of, as a dump of the system variables names it.

M: `$SCR_GRP[1].$ROBOT_MODEL` is the name of the arm of a group, which clients of the controller ask for by that name;
laid out in a dump as its other fields are.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence

from rpl.source import Source

_MODEL = re.compile(r"\$SCR_GRP\[\d+\]\.\$ROBOT_MODEL\b[^\n=]*=\s*'([^'\n]+)'")


def arms(sources: Sequence[Source]) -> Iterator[tuple[str, str]]:
    """The names of the arms, with the file that says each."""
    for source in sources:
        if source.path.lower().endswith(".va"):
            yield from ((found[1].strip(), source.path) for found in _MODEL.finditer(source.text) if found[1].strip())


def is_backup(names: frozenset[str]) -> bool:
    """A backup has listings or programs beside what else the controller keeps: dumps and files of its variables."""
    endings = {name.rpartition(".")[2] for name in names if "/" not in name}
    return bool(endings & {"ls", "tp"}) and bool(endings & {"va", "sv", "vr", "dg"})

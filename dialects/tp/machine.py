"""The arm that a backup is of, as a dump of the system variables names it.

M: `$SCR_GRP[1].$ROBOT_MODEL` is the name of the arm of a group, which clients of the controller ask for by that name;
laid out in a dump as its other fields are.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence

from rpl.registry import Aside
from rpl.source import Source

_BINARY = {
    "sv": "system variables in binary form",
    "vr": "variables of a program in binary form",
    "io": "the configuration of signals in binary form",
    "pc": "a compiled program of the language KAREL, which is not read",
}
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


def aside(source: Source) -> Aside | None:
    """Binary files of a backup: a program is read as the listing beside it, variables as their dump."""
    stem, _, ending = source.path.rpartition(".")
    if "\x00" not in source.text:
        return None
    if ending.lower() == "tp":
        advice = f"save it as text on the controller ({stem.rpartition('/')[2]}.LS), or fetch that from MD: by FTP"
        return Aside("a program in the controller's own binary form", f"{stem}.LS", advice=advice)
    return Aside(_BINARY[ending.lower()]) if ending.lower() in _BINARY else None

"""What stands beside the jobs in a backup of the controller, and which arm it names.

Seen in a public backup of a YRC1000 (lukelalondePZ/Komatsu-Press-Demo): SYSTEM.SYS begins with `/SYSTEM` and has below
`//ROBOT NAME` a line for each arm, `R1 : 1-06VXH25-A0*(GP25)  0011_1111`. M: a name in brackets is that of the model.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence

from rpl.registry import Aside
from rpl.source import Source

from . import DUMP_HEAD

_SYSTEM = re.compile(r"\ufeff?\s*/SYSTEM\b")
_NAMES = re.compile(r"^//ROBOT NAME[ \t\r]*\n((?:(?!//).*(?:\n|\Z))*)", re.MULTILINE)
_ARM = re.compile(r"^R\d+[ \t]*:[ \t]*([^\s(]+)(?:\(([^)\n]+)\))?", re.MULTILINE)
_KEPT = re.compile(r"\ufeff?\s*/{1,2}[A-Z]")
_SUFFIXES = (".cnd", ".prm", ".dat", ".sys")


def arms(sources: Sequence[Source]) -> Iterator[tuple[str, str]]:
    """The names of the arms, with the file that says each. Positioners and tracks (`S1`, `B1`) are none."""
    for source in sources:
        if _SYSTEM.match(source.text[:200]):
            for names in _NAMES.finditer(source.text):
                yield from ((arm[2] or arm[1], source.path) for arm in _ARM.finditer(names[1]))


def aside(source: Source) -> Aside | None:
    """Settings and records of the controller; the files of its values are read with the jobs."""
    head = source.text[:200]
    if not source.path.lower().endswith(_SUFFIXES) or not _KEPT.match(head) or DUMP_HEAD.match(head):
        return None
    return Aside("settings or records of the controller, as a backup holds them beside jobs")


def is_backup(names: frozenset[str]) -> bool:
    """A folder of jobs with what its controller keeps beside them (TOOL.CND, UFRAME.CND, VAR.DAT, ALL.PRM)."""
    endings = {name.rpartition(".")[2] for name in names if "/" not in name}
    return "jbi" in endings and bool(endings & {"cnd", "prm", "dat", "sys"})

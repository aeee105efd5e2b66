"""What a backup of the controller looks like: jobs beside the files of tools, frames and variables."""

from __future__ import annotations


def is_backup(names: frozenset[str]) -> bool:
    """A folder of jobs with what its controller keeps beside them (TOOL.CND, UFRAME.CND, VAR.DAT, ALL.PRM)."""
    endings = {name.rpartition(".")[2] for name in names if "/" not in name}
    return "jbi" in endings and bool(endings & {"cnd", "prm", "dat", "sys"})

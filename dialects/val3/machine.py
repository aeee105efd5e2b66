"""What an application of the controller looks like."""

from __future__ import annotations


def is_backup(names: frozenset[str]) -> bool:
    """An application is a folder with its project file; a backup is a folder of applications, `usrapp`."""
    return any(name.endswith(".pjx") and "/" not in name for name in names)

"""The files of one version of a program: of a folder or an archive by their names in it."""

from __future__ import annotations

from pathlib import Path, PurePosixPath

from rpl import archives
from rpl.errors import UsageError
from rpl.source import LARGEST_FILE, read_bytes

NOTHING_THERE = "/dev/null"  # what Git gives for a file that a version has not


def files_of(path: str) -> dict[str, bytes]:
    """Name -> bytes. Raises UsageError when the path does not exist or holds names that lead out of it."""
    if path == NOTHING_THERE:
        return {}
    given = Path(path)
    if not given.exists():
        raise UsageError(f"no such file or folder: {path}")
    if given.is_dir():
        found = (one for one in sorted(given.rglob("*")) if one.is_file() and not _hidden(one.relative_to(given)))
        return {one.relative_to(given).as_posix(): read_bytes(one, LARGEST_FILE) for one in found}
    data = read_bytes(given, LARGEST_FILE)
    if not is_archive(path):
        return {given.name: data}
    members = {}
    for member in archives.members(data):
        if member.data is None:
            raise UsageError(f"{path}: {member.name or 'this archive'}: {member.reason}")
        name = PurePosixPath(member.name.replace("\\", "/"))
        if name.is_absolute() or ".." in name.parts:
            raise UsageError(f"{path}: {member.name} leads out of the archive")
        members[str(name)] = member.data
    return members


def is_archive(path: str) -> bool:
    """Is it an archive by its name?"""
    return path.lower().endswith(archives.SUFFIXES)


def _hidden(path: Path) -> bool:
    return any(part.startswith(".") for part in path.parts)

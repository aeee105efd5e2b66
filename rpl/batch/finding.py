"""The projects of an archive: a backup (folder or archive) is one, and so is a program file with what belongs to it.

What a backup looks like is said by the languages (`rpl.registry.Dialect.is_backup`); names decide here, because an
archive of a plant is large, and the content decides when the project is read.
"""

from __future__ import annotations

import os
from collections.abc import Iterator
from dataclasses import dataclass
from hashlib import sha256
from pathlib import Path

from rpl import archives, registry
from rpl.errors import UsageError

_PIECE = 2**20


@dataclass(frozen=True, slots=True)
class Project:
    """name: its path from the folder of the archive, with `/`. paths: what is read. root: the folder of the archive.
    beside: files that are read because a path needs them."""

    name: str
    paths: tuple[str, ...]
    root: str
    beside: tuple[str, ...] = ()

    def digest(self) -> str:
        """Of the names and bytes of all its files."""
        made = sha256()
        for file in self._files():
            made.update(os.path.relpath(file, self.root).encode("utf-8", "surrogateescape") + b"\0")
            made.update(_digest(file))
        return made.hexdigest()

    def inside(self, file: str) -> str:
        """A path in it as seen from the folder of the archive."""
        return Path(file).relative_to(self.root).as_posix() if Path(file).is_relative_to(self.root) else file

    def _files(self) -> Iterator[Path]:
        for path in map(Path, (*self.paths, *self.beside)):
            yield from _below(path) if path.is_dir() else (path,)


def projects(folder: Path, together: bool = False) -> list[Project]:
    """Every project in the folder, in order of their names. together: the program files of one folder are one project.
    Raises UsageError when there is no such folder."""
    root = folder.resolve()
    if not root.is_dir():
        raise UsageError(f"no such folder: {folder}")
    return sorted(_found(root, root, together), key=lambda one: one.name)


def _found(folder: Path, root: Path, together: bool) -> Iterator[Project]:
    files, folders = _listed(folder)
    if _is_backup(files, folders):
        yield _project(root, folder, (folder,))
        return
    for path in folders:
        yield from _found(path, root, together)
    for path in files:
        if path.name.lower().endswith(archives.SUFFIXES):
            yield _project(root, path, (path,))
    programs = _programs(files)
    if programs and together:
        paths = tuple(programs)
        beside = dict.fromkeys(other for belongs in programs.values() for other in belongs)
        yield _project(root, folder, paths, tuple(one for one in beside if one not in programs))
        return
    for path, belongs in programs.items():
        yield _project(root, path, (path,), belongs)


def _project(root: Path, home: Path, paths: tuple[Path, ...], beside: tuple[Path, ...] = ()) -> Project:
    name = home.relative_to(root).as_posix() if home != root else root.name
    return Project(name, tuple(map(str, paths)), str(root), tuple(map(str, beside)))


def _listed(folder: Path) -> tuple[list[Path], list[Path]]:
    """Files and folders in it but hidden ones; nothing of a folder that cannot be looked into. Links to folders are
    not followed."""
    try:
        inside = sorted(path for path in folder.iterdir() if not path.name.startswith("."))
    except OSError:
        return [], []
    folders = [path for path in inside if path.is_dir() and not path.is_symlink()]
    return [path for path in inside if path.is_file()], folders


def _below(folder: Path) -> Iterator[Path]:
    files, folders = _listed(folder)
    yield from files
    for path in folders:
        yield from _below(path)


def _is_backup(files: list[Path], folders: list[Path]) -> bool:
    """By the names in the folder and in the folders in it, in small letters, those of folders with a `/` behind."""
    names = {path.name.lower() for path in files} | {f"{path.name.lower()}/" for path in folders}
    for path in folders:
        inner_files, inner = _listed(path)
        names |= {f"{path.name.lower()}/{one.name.lower()}" for one in inner_files}
        names |= {f"{path.name.lower()}/{one.name.lower()}/" for one in inner}
    return any(registry.dialect(name).is_backup(frozenset(names)) for name in registry.dialect_names())


def _programs(files: list[Path]) -> dict[Path, tuple[Path, ...]]:
    """The program files, each with those that belong to it. A data list is read with its program; alone it is one."""
    languages = [registry.dialect(name) for name in registry.dialect_names()]
    here, taken = set(files), set[Path]()
    found: dict[Path, tuple[Path, ...]] = {}
    for _, path in sorted((_rank(path, languages), path) for path in files if _rank(path, languages) >= 0):
        if path in taken:
            continue
        own = [one for one in languages if path.suffix.lower() in one.extensions]
        others = dict.fromkeys(Path(name) for one in own for name in one.companions(str(path)))
        found[path] = tuple(other for other in others if other in here)
        taken.update(found[path])
    return dict(sorted(found.items()))


def _rank(path: Path, languages: list[registry.Dialect]) -> int:
    """How far back its ending stands among those of its language, the first of which is that of programs; -1: it is
    none of them."""
    suffix = path.suffix.lower()
    return min((one.extensions.index(suffix) for one in languages if suffix in one.extensions), default=-1)


def _digest(file: Path) -> bytes:
    """Of one file; of one that cannot be read, that it cannot."""
    made = sha256()
    try:
        with file.open("rb") as stream:
            while piece := stream.read(_PIECE):
                made.update(piece)
    except OSError as error:
        made.update(f"unreadable: {error.errno}".encode())
    return made.digest()

"""Files of a folder of this machine. Of the controller behind it nothing is known: its state is never said."""

from __future__ import annotations

import errno
import os
from collections.abc import Sequence
from pathlib import Path

from rpl.controllers.link import (
    LARGEST_FILE,
    MOST_FILES,
    GarbledError,
    Identity,
    LostError,
    NotThereError,
    RefusedError,
    RemoteFile,
    State,
)
from rpl.controllers.profile import Profile
from rpl.controllers.rules import safe_name
from rpl.errors import UsageError


class FolderLink:
    """`root`: the folder; links that lead out of it are not followed."""

    can_rename = True

    def __init__(self, root: Path) -> None:
        self.root = root

    def identity(self) -> Identity:
        return Identity(name=str(self.root))

    def state(self) -> State:
        return State()

    def files(self) -> Sequence[RemoteFile]:
        found = []
        for folder, folders, names in os.walk(self.root):
            folders.sort()
            for name in names:
                path = Path(folder) / name
                if path.is_file() and not path.is_symlink():
                    found.append(RemoteFile(path.relative_to(self.root).as_posix(), path.stat().st_size))
            if len(found) > MOST_FILES:
                raise GarbledError(f"{self.root} holds more than {MOST_FILES} files")
        return sorted(found, key=lambda one: one.name)

    def _path(self, name: str) -> Path:
        path = self.root / safe_name(name)
        if not path.resolve().is_relative_to(self.root.resolve()):
            raise GarbledError(f"{name!r} leads out of {self.root}")
        return path

    def fetch(self, name: str) -> bytes:
        path = self._path(name)
        try:
            if path.stat().st_size > LARGEST_FILE:
                raise GarbledError(f"{name} is larger than {LARGEST_FILE // 2**20} MiB")
            return path.read_bytes()
        except FileNotFoundError:
            raise NotThereError(f"{self.root} has no {name}") from None
        except OSError as error:
            raise _told(name, error) from None

    def put(self, name: str, data: bytes) -> None:
        path = self._path(name)
        try:
            path.parent.mkdir(parents=True, exist_ok=True)
            with path.open("wb") as stream:
                stream.write(data)
                stream.flush()
                os.fsync(stream.fileno())
        except OSError as error:
            raise _told(name, error) from None

    def rename(self, old: str, new: str) -> None:
        try:
            self._path(old).replace(self._path(new))
        except FileNotFoundError:
            raise NotThereError(f"{self.root} has no {old}") from None
        except OSError as error:
            raise _told(new, error) from None

    def delete(self, name: str) -> None:
        try:
            self._path(name).unlink()
        except FileNotFoundError:
            raise NotThereError(f"{self.root} has no {name}") from None
        except OSError as error:
            raise _told(name, error) from None

    def lock(self) -> None:
        """Nobody asks for it."""

    def unlock(self) -> None:
        """Nothing was taken."""

    def take_in(self, names: Sequence[str]) -> None:
        """The folder is not the controller: somebody carries it there."""

    def take_out(self, names: Sequence[str]) -> None:
        """As above."""

    def close(self) -> None:
        """Nothing is open."""


def _told(name: str, error: OSError) -> RefusedError | LostError:
    said = f"{name}: {error.strerror or error}"
    return LostError(said) if error.errno in (errno.EIO, errno.ESTALE, errno.ENODEV) else RefusedError(said)


def connect(profile: Profile) -> FolderLink:
    """The folder of the profile. Raises UsageError when there is none."""
    root = Path(profile.folder)
    if not profile.folder or not root.is_dir():
        raise UsageError(f"{profile.name}: there is no folder {profile.folder or '(give its path)'}")
    return FolderLink(root)

"""Things that take a while to make and depend on the package alone (parser tables, preludes), kept between runs.

They live in the user's cache folder under a key of what they were made from. Nothing here may fail: an unreadable or
damaged file is made anew, and without a writable folder nothing is kept.
"""

from __future__ import annotations

import hashlib
import os
import pickle
import sys
import tempfile
from collections.abc import Callable, Iterable
from pathlib import Path
from typing import BinaryIO, TypeVar

Thing = TypeVar("Thing")
_DAMAGED = (
    *(OSError, ValueError, KeyError, EOFError, AttributeError, ImportError, TypeError, IndexError),
    pickle.UnpicklingError,
)


def kept(
    name: str,
    made_from: Iterable[str],
    make: Callable[[], Thing],
    load: Callable[[BinaryIO], Thing] = pickle.load,
    save: Callable[[Thing, BinaryIO], object] = pickle.dump,
) -> Thing:
    """The thing as it was kept, else made anew and kept. `made_from`: texts that decide what it is."""
    digest = hashlib.sha256(repr(sys.version_info[:3]).encode())
    for text in made_from:
        digest.update(text.encode("utf-8"))
    file = _folder() / f"{name}-{digest.hexdigest()[:20]}.kept"
    if file.is_file():
        try:
            with file.open("rb") as stream:
                return load(stream)
        except _DAMAGED:
            file.unlink(missing_ok=True)
    thing = make()
    _store(thing, file, save)
    return thing


def stamps(folders: Iterable[Path]) -> str:
    """Names, sizes and times of the files in these folders: changes whenever one of them is edited."""
    marks = []
    for folder in folders:
        for file in sorted(folder.iterdir()):
            if file.is_file():
                about = file.stat()
                marks.append(f"{file.name} {about.st_size} {about.st_mtime_ns}")
    return "\n".join(marks)


def _store(thing: Thing, file: Path, save: Callable[[Thing, BinaryIO], object]) -> None:
    try:
        file.parent.mkdir(parents=True, exist_ok=True)
        with tempfile.NamedTemporaryFile(dir=file.parent, delete=False) as stream:
            save(thing, stream)  # type: ignore[arg-type]  # a temporary file is a binary stream
        os.replace(stream.name, file)  # noqa: PTH105 (atomic on every system)
    except OSError:
        return


def _folder() -> Path:
    base = os.environ.get("XDG_CACHE_HOME") or os.environ.get("LOCALAPPDATA")
    return (Path(base) if base else Path.home() / ".cache") / "robot-rpl"

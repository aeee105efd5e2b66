"""Files that commands write: whole or not at all, and never over what they did not write themselves.

Each folder keeps a list of what was written there, with its hash (`.rpl-written.json`). A file that is not in it, or
that has changed since, belongs to somebody else.
"""

from __future__ import annotations

import json
import os
import stat
from collections.abc import Mapping, Sequence
from hashlib import sha256
from pathlib import Path

import click

from rpl.errors import UsageError
from rpl.sidefiles import CONTROLLER, DATA, PAGE, TRACE, side_file
from rpl.source import read_bytes, source_from_bytes

MANIFEST = ".rpl-written.json"
BEFORE = ".rpl-before"  # what somebody had changed, before it was written anew
_FORCE = "rpl.force"
# Parameters of commands that name what is read.
_INPUTS = ("paths", "base", "a", "b", "log", "cell", "robot", "robots", "to_robot", "controller", "folder")


def _keep_force(context: click.Context, parameter: click.Parameter, value: bool) -> None:
    context.meta[_FORCE] = value


force_option = click.option(
    "--force",
    is_flag=True,
    expose_value=False,
    callback=_keep_force,
    help="Overwrite files that were not written by rpl, and inputs.",
)


def refuse_others(paths: Sequence[Path]) -> None:
    """Raises UsageError when one of these files is not ours to overwrite (without --force)."""
    context = click.get_current_context(silent=True)
    if context is not None and context.meta.get(_FORCE):
        return
    given = context.params if context is not None else {}
    inputs = _inputs(given)
    kept = {folder: _manifest(folder) for folder in dict.fromkeys(path.parent for path in paths)}
    beside = {folder: _names(folder) for folder in kept}
    for path in paths:
        written = kept[path.parent]
        twin = next((name for name in beside[path.parent].get(path.name.casefold(), ()) if name != path.name), None)
        if twin is not None and not _is_ours(path.with_name(twin), written):
            reason = f"differs from {path.with_name(twin)} in capitals only, and many systems take them for one file"
            raise UsageError(f"{path} {reason}: it is not written (--force does)")
        if not _is_file(path) or path.stat().st_size == 0:
            continue
        data = path.read_bytes()
        ours = written.get(path.name) == _hash(data)
        if any(_holds(one, path, ours and _is_report(path, data)) for one in inputs):
            raise UsageError(f"{path} is an input: it is not overwritten (--force does)")
        if not ours:
            reason = "was not written by rpl, or has changed since"
            raise UsageError(f"{path} {reason}: it is not overwritten (--force does)")


def write_files(files: Mapping[Path, bytes], ours: Sequence[Path | None] = ()) -> None:
    """Write files and the folders above them: all under temporary names first, so that a failure leaves what was there.
    `ours`: files that are written anew on purpose. Raises UsageError when another one is not ours to overwrite, or when
    the system refuses."""
    refuse_others([path for path in files if path not in ours])
    made: list[tuple[Path, Path]] = []
    try:
        for path, data in files.items():
            path.parent.mkdir(parents=True, exist_ok=True)
            if path.exists() and not _is_file(path):  # standard output, or what takes everything
                _give(path, data)
                continue
            part = path.with_name(f".{path.name}.{os.getpid()}.part")
            made.append((part, path))
            part.write_bytes(data)
        while made:
            part, path = made[0]
            part.replace(path)
            made.pop(0)
        for folder in dict.fromkeys(path.parent for path in files):
            _remember(folder, {path.name: data for path, data in files.items() if path.parent == folder})
    except OSError as error:
        raise UsageError(f"cannot write {error.filename or path}: {error.strerror or error}") from None
    finally:
        for part, _ in made:
            part.unlink(missing_ok=True)


def kept_before(paths: Sequence[Path]) -> tuple[Path, ...]:
    """Those of these files that were written here and have been changed by somebody since. A copy of each stays in the
    folder `.rpl-before` beside it, so that they may be written anew. Raises UsageError when that fails."""
    changed = [
        path
        for path in paths
        if _is_file(path) and path.name in (kept := _manifest(path.parent)) and not _is_ours(path, kept)
    ]
    for path in changed:
        copy = path.parent / BEFORE / path.name
        try:
            copy.parent.mkdir(exist_ok=True)
            copy.write_bytes(path.read_bytes())
        except OSError as error:
            raise UsageError(f"cannot write {copy}: {error.strerror or error}") from None
    return tuple(changed)


def _give(path: Path, data: bytes) -> None:
    """Write to what is no file. A pipe that nobody reads is an error and not waited for."""
    taken = os.open(path, os.O_WRONLY | os.O_NONBLOCK)
    os.set_blocking(taken, True)
    with os.fdopen(taken, "wb") as stream:
        stream.write(data)


def stale(folder: Path, written: Sequence[Path]) -> list[Path]:
    """Files that an earlier translation wrote there (or below), unchanged since, and that this one did not write."""
    new = set(written)
    found = []
    for home in sorted({folder, *(path.parent for path in written)}):
        kept = _manifest(home)
        ours = (home / name for name in sorted(kept) if home / name not in new)
        found += [path for path in ours if _is_ours(path, kept) and not _is_report(path, path.read_bytes())]
    return found


def _remember(folder: Path, new: Mapping[str, bytes]) -> None:
    entries = {name: made for name, made in _manifest(folder).items() if (folder / name).is_file()}
    entries |= {name: _hash(data) for name, data in new.items() if _is_file(folder / name)}
    if entries:
        part = folder / f"{MANIFEST}.{os.getpid()}.part"
        part.write_text(json.dumps({"files": dict(sorted(entries.items()))}, indent=1) + "\n", encoding="utf-8")
        part.replace(folder / MANIFEST)


def _manifest(folder: Path) -> dict[str, str]:
    """Names and hashes; nothing where there is no list, or none that can be read."""
    try:
        kept = json.loads(read_bytes(folder / MANIFEST).decode("utf-8"))
    except (OSError, ValueError):
        return {}
    files = kept.get("files") if isinstance(kept, dict) else None
    return {str(name): str(made) for name, made in files.items()} if isinstance(files, dict) else {}


def _inputs(given: Mapping[str, object]) -> list[Path]:
    values = [given.get(name) for name in _INPUTS]
    flat = [one for value in values for one in (value if isinstance(value, tuple | list) else (value,))]
    return [path for one in flat if isinstance(one, str | Path) and (path := Path(one)).exists()]


def _holds(given: Path, path: Path, report: bool) -> bool:
    """Is the file what is given, or in the folder that is given? There a report of ours is no input."""
    whole, one = given.resolve(), path.resolve()
    return whole == one or (not report and whole.is_dir() and whole in one.parents)


def _is_ours(path: Path, written: Mapping[str, str]) -> bool:
    """Was it written by us, and has it not changed since?"""
    return path.name in written and _is_file(path) and _hash(path.read_bytes()) == written[path.name]


def _is_report(path: Path, data: bytes) -> bool:
    """Is it what a run, a proof or a fit leaves, by its content, and not what a translation writes?"""
    return side_file(source_from_bytes(str(path), data)) in (TRACE, PAGE, DATA, CONTROLLER)


def _names(folder: Path) -> dict[str, list[str]]:
    """The names in a folder by what they are where capitals do not count."""
    found: dict[str, list[str]] = {}
    try:
        for path in sorted(folder.iterdir()):
            found.setdefault(path.name.casefold(), []).append(path.name)
    except OSError:
        return {}
    return found


def _is_file(path: Path) -> bool:
    try:
        return stat.S_ISREG(path.stat().st_mode)
    except OSError:
        return False


def _hash(data: bytes) -> str:
    return sha256(data).hexdigest()

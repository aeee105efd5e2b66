"""What a transfer leaves behind on this machine: the backup, the new files, the journal that says how far it came, and
the log of all transfers.

Everything is on the disk before the controller is touched, so that after a crash of this program or of the line
`--resume` and `--roll-back` can finish: the journal's folder alone is enough for both.
"""

from __future__ import annotations

import getpass
import json
import os
import re
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import asdict, dataclass, field, replace
from datetime import UTC, datetime
from hashlib import sha256
from pathlib import Path
from typing import Any, Literal

from rpl.controllers.rules import safe_name
from rpl.errors import RplError, UsageError

# How far a transfer has come. The last three are its ends; all before them can be resumed or rolled back.
Step = Literal["begun", "backed-up", "staged", "replacing", "replaced", "taken-in", "done", "rolled-back", "refused"]
ENDS = ("done", "rolled-back", "refused")
JOURNAL, OLD, NEW, MANIFEST, AUDIT, LOCK = "journal.json", "old", "new", "manifest.json", "audit.jsonl", "lock"


class UnfinishedError(RplError):
    """An earlier transfer to this controller has not been finished."""


def hash_of(data: bytes) -> str:
    """SHA-256, as the manifests hold it."""
    return sha256(data).hexdigest()


@dataclass(frozen=True, slots=True)
class Item:
    """One file of a transfer: hashes of what the controller had (None: nothing) and of what it is to get; `temporary`:
    the name that it is written under first, empty where it is written in its place."""

    name: str
    old: str | None
    new: str
    temporary: str = ""


@dataclass(frozen=True, slots=True)
class Journal:
    """A transfer, as it stands in its folder."""

    folder: Path
    controller: str
    address: str
    identity: Mapping[str, str]
    began: str
    items: tuple[Item, ...]
    step: Step = "begun"
    said: tuple[str, ...] = field(default=())

    @property
    def is_over(self) -> bool:
        return self.step in ENDS

    def at(self, step: Step, *said: str) -> Journal:
        """The journal at a further step, written to the disk before anything else is done."""
        now = replace(self, step=step, said=(*self.said, *said))
        document = {key: value for key, value in asdict(now).items() if key != "folder"}
        write_safely(self.folder / JOURNAL, _json(document))
        return now

    def old(self, item: Item) -> bytes | None:
        """What the controller had; None: no such file."""
        return None if item.old is None else self._kept(OLD, item.name, item.old)

    def new(self, item: Item) -> bytes:
        """What it is to get."""
        return self._kept(NEW, item.name, item.new)

    def _kept(self, folder: str, name: str, wanted: str) -> bytes:
        path = self.folder / folder / safe_name(name)
        try:
            data = path.read_bytes()
        except OSError as error:
            raise UsageError(f"{path}: the transfer cannot be finished without it: {error.strerror}") from None
        if hash_of(data) != wanted:
            raise UsageError(f"{path}: it is not what was kept there any more: the transfer cannot be finished with it")
        return data


def begin(
    state: Path,
    controller: str,
    address: str,
    identity: Mapping[str, str],
    files: Sequence[tuple[Item, bytes | None, bytes]],
) -> Journal:
    """Keep the old and the new files (item, old bytes, new bytes) and begin the journal."""
    now = datetime.now(UTC)
    folder = _new_folder(folder_of(state, controller), now.strftime("%Y%m%d-%H%M%S"))
    for item, old, new in files:
        for where, data in ((OLD, old), (NEW, new)):
            if data is not None:
                write_safely(folder / where / safe_name(item.name), data)
    items = tuple(item for item, _, _ in files)
    manifest = {item.name: {"old": item.old, "new": item.new} for item in items}
    write_safely(folder / MANIFEST, _json(manifest))
    journal = Journal(folder, controller, address, dict(identity), now.isoformat(timespec="seconds"), items)
    return journal.at("begun")


def read_journal(folder: Path) -> Journal:
    """The journal of that folder. Raises UsageError when there is none, or it is no journal."""
    path = folder / JOURNAL if folder.is_dir() else folder
    try:
        found = json.loads(path.read_text("utf-8"))
        items = tuple(Item(**each) for each in found["items"])
        words: dict[str, Any] = {key: found[key] for key in ("controller", "address", "identity", "began", "step")}
        return Journal(path.parent, items=items, said=tuple(found["said"]), **words)
    except OSError as error:
        raise UsageError(f"{path}: {error.strerror}: there is no journal of a transfer") from None
    except (ValueError, KeyError, TypeError) as error:
        raise UsageError(f"{path}: this is no journal of a transfer ({error})") from None


def unfinished(state: Path, controller: str) -> Journal | None:
    """The transfer to this controller that has not come to an end."""
    for path in sorted(folder_of(state, controller).glob(f"*/{JOURNAL}"), reverse=True):
        journal = read_journal(path)
        if not journal.is_over:
            return journal
    return None


def last_done(state: Path, controller: str) -> Journal | None:
    """The last transfer to this controller, if it was done (and not rolled back since)."""
    for path in sorted(folder_of(state, controller).glob(f"*/{JOURNAL}"), reverse=True):
        journal = read_journal(path)
        if journal.step != "refused":
            return journal if journal.step == "done" else None
    return None


def refuse_unfinished(state: Path, controller: str) -> None:
    """Raises UnfinishedError: what an interrupted transfer left is settled first."""
    journal = unfinished(state, controller)
    if journal is not None:
        raise UnfinishedError(
            f"the transfer of {journal.began} to {controller} has not been finished ({journal.step}): "
            f"rpl send --resume {controller} or rpl send --roll-back {controller} ({journal.folder})"
        )


def folder_of(state: Path, controller: str) -> Path:
    """Where the transfers to a controller are kept."""
    return state / (re.sub(r"[^A-Za-z0-9._-]+", "-", controller).strip("-.") or "controller")


def _new_folder(parent: Path, name: str) -> Path:
    for number in range(1, 1000):
        folder = parent / (name if number == 1 else f"{name}-{number}")
        try:
            folder.mkdir(parents=True)
        except FileExistsError:
            continue
        return folder
    raise UsageError(f"{parent}: a thousand transfers within one second")


@contextmanager
def only_one(state: Path, controller: str) -> Iterator[None]:
    """No two transfers to one controller at a time. Raises UnfinishedError while another process is at it."""
    path = folder_of(state, controller) / LOCK
    path.parent.mkdir(parents=True, exist_ok=True)
    _take(path)
    try:
        yield
    finally:
        path.unlink(missing_ok=True)


def _take(path: Path) -> None:
    for _ in range(2):
        try:
            handle = os.open(path, os.O_CREAT | os.O_EXCL | os.O_WRONLY)
        except FileExistsError:
            owner = path.read_text("utf-8").strip()
            if owner.isdigit() and _is_alive(int(owner)):
                raise UnfinishedError(f"process {owner} is sending to this controller ({path})") from None
            path.unlink(missing_ok=True)  # its process was killed
            continue
        with os.fdopen(handle, "w", encoding="utf-8") as stream:
            stream.write(str(os.getpid()))
        return
    raise UnfinishedError(f"another process is sending to this controller ({path})")


def _is_alive(process: int) -> bool:
    try:
        os.kill(process, 0)
    except ProcessLookupError:
        return False
    except PermissionError:
        return True
    return True


def log(state: Path, what: str, controller: str, identity: Mapping[str, str], more: Mapping[str, object]) -> None:
    """A line of the log of all transfers: when, who, what, which controller, and the hashes before and after."""
    line = {
        "when": datetime.now(UTC).isoformat(timespec="seconds"),
        "who": _user(),
        "what": what,
        "controller": controller,
        "identity": dict(identity),
        **more,
    }
    state.mkdir(parents=True, exist_ok=True)
    with (state / AUDIT).open("a", encoding="utf-8") as stream:
        stream.write(json.dumps(line, ensure_ascii=False) + "\n")
        stream.flush()
        os.fsync(stream.fileno())


def _user() -> str:
    """The user's name; systems without a list of users have a number."""
    try:
        return getpass.getuser()
    except (KeyError, OSError):
        return str(os.getuid()) if os.name == "posix" else "unknown"


def write_safely(path: Path, data: bytes) -> None:
    """Write a file so that after a crash, also of the machine, it is there whole or as it was before."""
    path.parent.mkdir(parents=True, exist_ok=True)
    part = path.with_name(f".{path.name}.part")
    with part.open("wb") as stream:
        stream.write(data)
        stream.flush()
        os.fsync(stream.fileno())
    part.replace(path)
    if os.name == "posix":
        handle = os.open(path.parent, os.O_RDONLY)
        try:
            os.fsync(handle)
        finally:
            os.close(handle)


def _json(document: object) -> bytes:
    return (json.dumps(document, indent=1, ensure_ascii=False, default=list) + "\n").encode("utf-8")

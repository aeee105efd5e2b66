"""What every maker's link must endure: each fault comes at each request of a transfer, and then the controller holds
exactly the old or exactly the new file, or the client can tell."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from pathlib import Path

from rpl.controllers.link import Link, LinkError, LostError
from rpl.controllers.profile import Profile
from tests.controllers.hosting import MOTION, hosted

Connect = Callable[[Profile], Link]


@dataclass(frozen=True)
class Files:
    """The file that is replaced: its name, what is there before, what is brought, and its temporary name (empty: the
    controller cannot rename), and where the controller keeps it."""

    maker: str
    name: str
    old: bytes
    new: bytes
    temporary: str = ""
    below: str = ""


def requests_of(files: Files, connect: Connect, folder: Path) -> int:
    """How many requests a whole transfer takes when nothing goes wrong."""
    with hosted(files.maker, {files.name: files.old}) as here:
        assert list(_transfer(files, connect, here.profile(folder))) == []
        return here.cabinet.requests


def endured(files: Files, connect: Connect, folder: Path, fault: str, patience_s: float = 0.3) -> list[LinkError]:
    """The errors that a transfer meets with this fault; afterwards the controller is asked what it holds."""
    with hosted(files.maker, {files.name: files.old}, fault) as here:
        profile = here.profile(folder, patience_s)
        errors = list(_transfer(files, connect, profile))
        assert all(str(error) for error in errors)
        held = here.cabinet.store.kept(files.below + files.name)
        same = profile.rules.same
        known = same(files.name, files.old, held) or same(files.name, files.new, held)
        assert known or any(isinstance(error, ReadBackError) for error in errors), (fault, held)
        assert not here.kinds() & MOTION
        return errors


class ReadBackError(LinkError):
    """What was read back is not what was written."""


def _transfer(files: Files, connect: Connect, profile: Profile) -> Iterator[LinkError]:
    """Look, back up, write, read back; a step that fails ends it, and only what was read back is compared."""
    try:
        link = connect(profile)
    except LinkError as error:
        yield error
        return
    try:
        link.identity()
        link.state()
        names = [one.name for one in link.files()]
        assert files.name in names
        assert profile.rules.same(files.name, files.old, link.fetch(files.name))
        link.put(files.temporary or files.name, files.new)
        _compare(link, profile, files.temporary or files.name, files.new)
        if files.temporary:
            link.rename(files.temporary, files.name)
            _compare(link, profile, files.name, files.new)
    except LinkError as error:
        yield error
        if isinstance(error, LostError):
            return
        yield from _read_back(link, profile, files)
    finally:
        link.close()


def _compare(link: Link, profile: Profile, name: str, data: bytes) -> None:
    if not profile.rules.same(name, data, link.fetch(name)):
        raise ReadBackError(f"{name} is not what was written")


def _read_back(link: Link, profile: Profile, files: Files) -> Iterator[LinkError]:
    try:
        found = link.fetch(files.name)
    except LinkError as error:
        yield error
        return
    if not any(profile.rules.same(files.name, data, found) for data in (files.old, files.new)):
        yield ReadBackError(f"{files.name} is neither old nor new")

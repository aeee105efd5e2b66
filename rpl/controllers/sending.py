"""Bringing programs to a controller: all of them or none, with a backup, and never a motion.

The steps are those of `journal.Step`. Files are written under temporary names and verified, then take their places
(where the controller cannot rename, they are written in place, one by one, each verified); what the controller must
load is loaded; everything is read back. Whatever fails on the way, what the controller had is brought back; where that
fails too, the journal says so, and `finish` takes it up again.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from rpl.controllers import journal as journals
from rpl.controllers.journal import Item, Journal, hash_of
from rpl.controllers.link import (
    GarbledError,
    Link,
    LinkError,
    LostError,
    NotThereError,
    OtherControllerError,
    RefusedError,
)
from rpl.controllers.planning import Plan, in_the_way, temporary_name
from rpl.controllers.profile import Profile
from rpl.errors import RplError
from rpl.showing import counted

Connect = Callable[[Profile], Link]
Told = Callable[[str], None]


class NotSentError(RplError):
    """The transfer did not come to its end: what the controller holds now is said."""


@dataclass(frozen=True, slots=True)
class Outcome:
    """How a transfer ended: `done` or `rolled-back`, where its journal is, and what is to be known besides."""

    journal: Journal
    remarks: tuple[str, ...] = ()


def silent(text: str) -> None:
    """Nobody wants to be told."""


def send(link: Link, connect: Connect, profile: Profile, planned: Plan, tell: Told = silent) -> Outcome:
    """Carry out a plan that nothing speaks against. `connect` makes a new connection when this one is lost. Raises
    NotSentError when the controller holds the old programs again, or when what it holds is unknown (the journal stays
    unfinished then)."""
    state = profile.state_folder
    files = planned.to_write
    with journals.only_one(state, profile.name):
        journals.refuse_unfinished(state, profile.name)
        kept = []
        for number, one in enumerate(files, 1):
            old = None if one.present is None else hash_of(one.present)
            temporary = temporary_name(one.name, number) if link.can_rename else ""
            kept.append((Item(one.name, old, hash_of(one.data), temporary), one.present, one.data))
        journal = journals.begin(state, profile.name, profile.address, planned.identity.said(), kept)
        journal = journal.at("backed-up")
        tell(f"backed up {counted(len(files), 'file')} to {journal.folder}")
        try:
            journal, remarks = _brought(link, profile, planned, journal, tell)
        except LinkError as error:
            raise _undone(link, connect, profile, journal, error, tell) from None
        return _finished(profile, journal, "sent", remarks)


def finish(connect: Connect, profile: Profile, journal: Journal, forwards: bool, tell: Told = silent) -> Outcome:
    """Take up a transfer that was broken off: bring the new programs (`forwards`) or the old ones back; or undo one
    that was done. Raises NotSentError when it fails again, or when somebody has changed since what was sent; nothing is
    lost then, and it can be tried again."""
    with journals.only_one(profile.state_folder, profile.name):
        link = connect(profile)
        try:
            _same_controller(link, journal)
            against = in_the_way(link.state(), (), state_is_known=True)
            if against:
                raise RefusedError("; ".join(against))
            if journal.is_over:
                _untouched(link, profile, journal)
                journal = journal.at("taken-in")
            _settle(link, profile, journal, forwards, tell)
        except LinkError as error:
            stays = "done as it was" if journal.is_over else "unfinished"
            raise NotSentError(f"{error}; the transfer stays {stays} ({journal.folder})") from None
        finally:
            link.close()
        journal = journal.at("done" if forwards else "rolled-back")
        return _finished(profile, journal, "resumed" if forwards else "rolled back", ())


def _finished(profile: Profile, journal: Journal, what: str, remarks: tuple[str, ...]) -> Outcome:
    files = [{"name": item.name, "old": item.old, "new": item.new} for item in journal.items]
    more = {"journal": str(journal.folder), "files": files}
    journals.log(profile.state_folder, what, profile.name, journal.identity, more)
    return Outcome(journal, remarks)


def _brought(
    link: Link, profile: Profile, planned: Plan, journal: Journal, tell: Told
) -> tuple[Journal, tuple[str, ...]]:
    """Forwards, step by step. Raises LinkError; the journal on the disk says how far it came."""
    link.lock()
    try:
        for item in journal.items:
            if item.temporary:
                _write(link, profile, item.temporary, journal.new(item), tell)
        journal = journal.at("staged")
        stopped = in_the_way(link.state(), planned.to_write, state_is_known=planned.state.running is None)
        if stopped:
            raise RefusedError("; ".join(stopped))
        journal = journal.at("replacing")
        for item in journal.items:
            if item.temporary:
                link.rename(item.temporary, item.name)
                tell(f"replaced {item.name}")
            else:
                _write(link, profile, item.name, journal.new(item), tell)
        journal = journal.at("replaced")
        link.take_in([item.name for item in journal.items])
        journal = journal.at("taken-in")
        remarks = _verify(link, profile, journal)
    finally:
        _unlocked(link)
    after = link.state()
    if after.emergency_stop and not planned.state.emergency_stop:
        remarks = (*remarks, "the emergency stop was pressed meanwhile; all files are there and verified")
    return journal.at("done"), remarks


def _unlocked(link: Link) -> None:
    """Give back what was locked; a lost line has given it back by itself."""
    try:
        link.unlock()
    except LostError:
        return


def _write(link: Link, profile: Profile, name: str, data: bytes, tell: Told) -> None:
    link.put(name, data)
    found = link.fetch(name)
    if not profile.rules.same(name, data, found):
        raise GarbledError(f"{name}: what the controller kept is not what was written ({_how(data, found)})")
    tell(f"wrote and verified {name}")


def _verify(link: Link, profile: Profile, journal: Journal) -> tuple[str, ...]:
    """Everything is read back; what the controller writes in its own way is said."""
    remarks = []
    for item in journal.items:
        sent, found = journal.new(item), link.fetch(item.name)
        if not profile.rules.same(item.name, sent, found):
            raise GarbledError(f"{item.name}: what the controller holds is not what was sent ({_how(sent, found)})")
        if sent != found:
            remarks.append(f"{item.name}: the controller writes it anew in its own way; the program is the same")
    return tuple(remarks)


def _how(sent: bytes, found: bytes) -> str:
    if len(sent) != len(found):
        return f"{len(found)} bytes instead of {len(sent)}"
    place = next((place for place, (a, b) in enumerate(zip(sent, found, strict=True)) if a != b), 0)
    line = sent.count(b"\n", 0, place) + 1
    return f"line {line}"


def _undone(
    link: Link, connect: Connect, profile: Profile, journal: Journal, cause: LinkError, tell: Told
) -> NotSentError:
    """Bring back what was there; the error to be raised says what the controller holds now."""
    journal = journals.read_journal(journal.folder)
    tell(f"{cause}: bringing back what was there")
    fresh = link
    try:
        if isinstance(cause, LostError | GarbledError):
            link.close()
            fresh = connect(profile)
            _same_controller(fresh, journal)
        _settle(fresh, profile, journal, False, tell)
    except LinkError as error:
        journal.at(journal.step, f"{cause}; rolling back: {error}")
        return NotSentError(
            f"{cause}. It could not be undone: {error}. What the controller holds is unknown; finish with rpl send "
            f"--resume {profile.name} or rpl send --roll-back {profile.name} (the backup is in {journal.folder})"
        )
    finally:
        if fresh is not link:
            fresh.close()
    journal = journal.at("rolled-back", str(cause))
    _finished(profile, journal, "refused and rolled back", ())
    return NotSentError(f"{cause}. The controller holds what it held before (verified)")


def _same_controller(link: Link, journal: Journal) -> None:
    found = link.identity().said()
    if found.get("serial") != journal.identity.get("serial") or found.get("model") != journal.identity.get("model"):
        raise OtherControllerError(f"another controller answers: {found}, and the transfer was to {journal.identity}")


def _untouched(link: Link, profile: Profile, journal: Journal) -> None:
    """A transfer is undone only while the controller holds what it brought."""
    for item in journal.items:
        if not _holds(link, profile, item.name, journal.new(item)):
            raise RefusedError(
                f"{item.name} has been changed on the controller since it was sent: fetch and compare it"
            )


def _settle(link: Link, profile: Profile, journal: Journal, forwards: bool, tell: Told) -> None:
    """Make the controller hold exactly the new files, or exactly the old ones, whatever it holds of them now: each is
    looked at, written where it differs, and verified."""
    link.lock()
    try:
        changed = False
        loaded = journal.step in ("replaced", "taken-in")
        gone = [] if forwards else [item.name for item in journal.items if item.old is None]
        if gone:
            link.take_out(gone)
        for item in journal.items if forwards else reversed(journal.items):
            wanted = journal.new(item) if forwards else journal.old(item)
            changed |= _settled(link, profile, item, wanted, tell)
        for item in journal.items:
            if item.temporary:
                _removed(link, item.temporary)
        if changed or loaded:
            link.take_in([item.name for item in journal.items if item.name not in gone])
        for item in journal.items:
            wanted = journal.new(item) if forwards else journal.old(item)
            if not _holds(link, profile, item.name, wanted):
                raise GarbledError(f"{item.name}: the controller does not hold what was brought")
    finally:
        _unlocked(link)


def _settled(link: Link, profile: Profile, item: Item, wanted: bytes | None, tell: Told) -> bool:
    """One file as it is to be; TRUE when something had to be done."""
    if _holds(link, profile, item.name, wanted):
        return False
    if wanted is None:
        _removed(link, item.name)
    elif item.temporary:
        _write(link, profile, item.temporary, wanted, tell)
        link.rename(item.temporary, item.name)
    else:
        _write(link, profile, item.name, wanted, tell)
    tell(f"settled {item.name}")
    return True


def _holds(link: Link, profile: Profile, name: str, wanted: bytes | None) -> bool:
    try:
        found = link.fetch(name)
    except NotThereError:
        return wanted is None
    return wanted is not None and profile.rules.same(name, wanted, found)


def _removed(link: Link, name: str) -> None:
    try:
        link.delete(name)
    except NotThereError:
        return

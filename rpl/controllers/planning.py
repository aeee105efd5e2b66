"""What a transfer would do, before it is done: which files are new, changed or the same, what speaks against it."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path, PurePosixPath
from typing import Literal

from rpl.controllers.link import LARGEST_FILE, Identity, Link, NotThereError, State
from rpl.controllers.profile import Profile
from rpl.errors import UsageError
from rpl.showing import counted
from rpl.source import read_bytes, source_from_bytes

# The temporary name of a file while it is written; the digits tell ours from others.
TEMPORARY = "zzrpl"


Kind = Literal["new", "changed", "same"]


@dataclass(frozen=True, slots=True)
class Sent:
    """A file of a transfer: its name there, where it comes from, what is written, what the controller has (None: no
    such file), what that is to it, and what was changed in the bytes on the way."""

    name: str
    path: Path
    data: bytes
    present: bytes | None
    kind: Kind
    remark: str = ""


@dataclass(frozen=True, slots=True)
class Plan:
    """`files` in the order of writing; left_out: files of the folder that are not sent, with the reason; only_there:
    programs of the controller that stay; against: what speaks against the transfer, in whole sentences; errors: what
    our own reader finds wrong in the programs, which may still be good for the controller."""

    identity: Identity
    state: State
    files: tuple[Sent, ...]
    left_out: tuple[str, ...]
    only_there: tuple[str, ...]
    against: tuple[str, ...]
    changes: tuple[str, ...] = ()
    errors: tuple[str, ...] = ()

    @property
    def to_write(self) -> tuple[Sent, ...]:
        return tuple(one for one in self.files if one.kind != "same")

    def as_json(self) -> dict[str, object]:
        return {
            "identity": self.identity.said(),
            "state": self.state.as_json(),
            "files": [
                {"name": one.name, "from": str(one.path), "kind": one.kind, "size": len(one.data), "remark": one.remark}
                for one in self.files
            ],
            "left_out": list(self.left_out),
            "only_there": list(self.only_there),
            "against": list(self.against),
            "changes": list(self.changes),
            "errors": list(self.errors),
        }

    def lines(self) -> Iterator[str]:
        """The same for people."""
        for one in self.files:
            remark = f" ({one.remark})" if one.remark else ""
            yield f"{one.kind:<10} {one.name}, {counted(len(one.data), 'byte')}{remark}"
        yield from (f"left out   {text}" for text in self.left_out)
        yield from (f"stays      {name}: only there" for name in self.only_there)
        yield from self.changes
        yield from (f"look at    {text}" for text in self.errors)


def plan(link: Link, profile: Profile, folder: Path, state_is_known: bool = False) -> Plan:
    """Look at the controller and at the folder; nothing is written. `state_is_known`: the user has looked at the
    controller, and takes it on himself that it is at rest where it does not say. Raises LinkError, UsageError."""
    identity, state = link.identity(), link.state()
    mine, left_out, against = _files_of(folder, profile)
    there = {one.name.lower(): one for one in link.files()}
    sent = []
    for name in profile.rules.in_order(list(mine)):
        path, data, remark = mine[name]
        present = _present(link, name) if name.lower() in there or not there else None
        sent.append(Sent(name, path, data, present, _kind(profile, name, present, data), remark))
    names = frozenset(mine)
    for one in sent:
        against += profile.rules.complaints(one.name, one.data, profile.text_encoding, names, frozenset(there))
    against += profile.wrong_identity(identity)
    against += in_the_way(state, [one for one in sent if one.kind != "same"], state_is_known)
    only_there = sorted(one.name for key, one in there.items() if key not in {name.lower() for name in names})
    changes, errors = tuple(changes_of(sent, profile)), tuple(errors_in(sent))
    return Plan(identity, state, tuple(sent), tuple(left_out), tuple(only_there), tuple(against), changes, errors)


def _kind(profile: Profile, name: str, present: bytes | None, data: bytes) -> Kind:
    """A text that the controller has written anew in its own way (dates, sizes) is the same program still."""
    if present is None:
        return "new"
    return "same" if profile.rules.same(name, data, present) else "changed"


def _present(link: Link, name: str) -> bytes | None:
    try:
        return link.fetch(name)
    except NotThereError:
        return None


def _files_of(folder: Path, profile: Profile) -> tuple[dict[str, tuple[Path, bytes, str]], list[str], list[str]]:
    """Programs of the folder by their names on the controller, what is left out, and what is wrong with names."""
    if not folder.is_dir():
        raise UsageError(f"{folder}: there is no such folder; what is to be sent stands in one")
    found: dict[str, tuple[Path, bytes, str]] = {}
    left_out, against = [], []
    for path in sorted(one for one in folder.rglob("*") if one.is_file()):
        below = path.relative_to(folder)
        if any(part.startswith(".") for part in below.parts):
            continue  # what commands of this package, or git, keep beside programs
        rules = profile.rules
        name = below.name if rules.flat else below.as_posix()
        if rules.is_denied(name):
            left_out.append(f"{below.as_posix()}: safety, system and configuration files are never sent")
            continue
        if not rules.is_program(name):
            left_out.append(f"{below.as_posix()}: no program for this controller")
            continue
        twin = next((other for other in found if other.lower() == name.lower()), None)
        if twin is not None:
            against.append(f"{below}: {found[twin][0].relative_to(folder)} has the same name on the controller")
            continue
        data, remark = _with_line_ends(read_bytes(path, LARGEST_FILE), profile.text_line_ends)
        found[name] = (path, data, remark)
    if not found:
        raise UsageError(f"{folder}: there is no program for this controller ({', '.join(profile.rules.programs)})")
    return found, left_out, against


def _with_line_ends(data: bytes, ends: str) -> tuple[bytes, str]:
    """The bytes as the controller wants lines to end, and a word about it where something was changed."""
    if not ends or b"\x00" in data:
        return data, ""
    bare = data.replace(b"\r\n", b"\n")
    made = bare.replace(b"\n", b"\r\n") if ends == "crlf" else bare
    return made, f"line ends made {ends.upper()}" if made != data else ""


def in_the_way(state: State, files: Sequence[Sent], state_is_known: bool) -> list[str]:
    """Why the controller may not be written to now. What it does not say counts as in the way."""
    found = []
    if state.running:
        found.append(f"the controller runs {state.program or 'a program'}: programs are sent while it stands")
    if state.running is None and not state_is_known:
        found.append("the controller does not say whether it runs: look at it, and give --at-rest if it stands")
    if state.emergency_stop:
        found.append("its emergency stop is pressed")
    busy = {_stem(one): "selected" for one in state.selected or ()} | {_stem(one): "open" for one in state.opened or ()}
    for one in files:
        if _stem(one.name) in busy and one.present is not None:
            found.append(f"{one.name} is {busy[_stem(one.name)]} on the controller: deselect it there")
    return found


def _stem(name: str) -> str:
    return PurePosixPath(name.replace("\\", "/")).stem.lower()


def changes_of(files: Sequence[Sent], profile: Profile) -> Iterator[str]:
    """What the transfer would change, by what the programs say; line by line where no language of ours is read."""
    from rpl.comparing import differences
    from rpl.comparing.shown import Shown, lines
    from rpl.diagnostics import Diagnostics
    from rpl.project import read_program

    if not any(one.kind == "changed" for one in files):
        return
    both = [one for one in files if one.present is not None]
    old = read_program([source_from_bytes(one.name, one.present or b"") for one in both], None, Diagnostics())
    new = read_program([source_from_bytes(one.name, one.data) for one in both], None, Diagnostics())
    if old.files and new.files and old.dialects == new.dialects:
        yield from lines(differences(old, new), Shown(lambda text, what: text, True))
    else:
        yield from _by_line(both, profile)


def errors_in(files: Sequence[Sent]) -> Iterator[str]:
    """What our own reader finds wrong in the programs, the worst first."""
    from rpl.diagnostics import Diagnostics, Severity
    from rpl.grouping import told
    from rpl.project import read_program

    diagnostics = Diagnostics()
    read = read_program([source_from_bytes(one.name, one.data) for one in files], None, diagnostics)
    if read.files:
        yield from told(diagnostics.of(Severity.ERROR))


def _by_line(files: Sequence[Sent], profile: Profile) -> Iterator[str]:
    from difflib import unified_diff

    for one in files:
        before, after = (
            data.decode(profile.text_encoding, "replace").splitlines() for data in (one.present or b"", one.data)
        )
        yield from unified_diff(before, after, f"there: {one.name}", f"here: {one.path}", lineterm="", n=1)


def temporary_name(name: str, number: int) -> str:
    """The name under which a file is written first, in the same folder."""
    path = PurePosixPath(name)
    return str(path.with_name(f"{TEMPORARY}{number}{path.suffix}"))


def is_temporary(name: str) -> bool:
    stem = PurePosixPath(name).stem
    return stem.startswith(TEMPORARY) and stem[len(TEMPORARY) :].isdigit()

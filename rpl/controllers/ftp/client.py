"""Files of a controller by FTP. Names come from NLST, or from MLSD where the server has it: lists for people, which
every maker lays out in his own way, are not read."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from contextlib import ExitStack

from rpl.controllers.ftp.channel import Channel
from rpl.controllers.link import (
    MOST_FILES,
    GarbledError,
    Identity,
    LoginError,
    LostError,
    NotThereError,
    RefusedError,
    RemoteFile,
    State,
)
from rpl.controllers.profile import Profile
from rpl.controllers.rules import safe_name

_DEEPEST = 12


class FtpLink:
    """`folder`: where the programs are, as the server spells it; empty: where a login leads to."""

    can_rename = True

    def __init__(self, channel: Channel, folder: str = "") -> None:
        self.channel = channel
        self.folder = folder
        if folder:
            channel.ask(f"CWD {_one_line(folder)}")
        channel.ask("TYPE I")
        self._extras: frozenset[str] | None = None

    def identity(self) -> Identity:
        return Identity()

    def state(self) -> State:
        return State()

    # ---- lists

    @property
    def extras(self) -> frozenset[str]:
        """Words of what the server can do beyond the oldest standard (RFC 2389)."""
        if self._extras is None:
            try:
                lines = self.channel.ask("FEAT").splitlines()[1:-1]
            except RefusedError:
                lines = []
            self._extras = frozenset(words[0].upper() for line in lines if (words := line.split()))
        return self._extras

    def files(self) -> Sequence[RemoteFile]:
        found = list(self._machine_list("", 0) if "MLST" in self.extras else self._names())
        return sorted(found, key=lambda one: one.name)

    def _names(self) -> Iterator[RemoteFile]:
        """The names of the folder; folders in it cannot be told from files."""
        lines = self.channel.lines("NLST")
        if len(lines) > MOST_FILES:
            raise GarbledError(f"the controller lists more than {MOST_FILES} files")
        before = self.folder.rstrip("/\\") + "/"
        for line in lines:
            name = line.strip().replace("\\", "/").removeprefix(before)
            if name not in ("", ".", ".."):
                yield RemoteFile(safe_name(name))

    def _machine_list(self, below: str, depth: int) -> Iterator[RemoteFile]:
        """Files of a folder and of those in it (RFC 3659)."""
        if depth > _DEEPEST:
            raise GarbledError(f"the controller's folders are more than {_DEEPEST} deep: {below}")
        lines = self.channel.lines(f"MLSD {_one_line(below)}" if below else "MLSD")
        if len(lines) > MOST_FILES:
            raise GarbledError(f"the controller lists more than {MOST_FILES} files")
        for line in lines:
            said, _, name = line.partition(" ")
            facts = dict(fact.lower().partition("=")[::2] for fact in said.split(";") if fact)
            kind = facts.get("type", "file")
            if kind in ("cdir", "pdir") or not name:
                continue
            inside = safe_name(f"{below}/{name}" if below else name)
            if kind == "dir":
                yield from self._machine_list(inside, depth + 1)
            else:
                size = facts.get("size", "")
                yield RemoteFile(inside, int(size) if size.isdigit() else None)

    # ---- files

    def there(self, name: str) -> str:
        """The name as the server wants it."""
        return _one_line(safe_name(name))

    def fetch(self, name: str) -> bytes:
        try:
            return self.channel.read(f"RETR {self.there(name)}")
        except (LoginError, LostError):
            raise
        except RefusedError as error:
            raise self._why(name, error) from None

    def put(self, name: str, data: bytes) -> None:
        self._make_folders(name)
        self.channel.write(f"STOR {self.there(name)}", data)

    def _make_folders(self, name: str) -> None:
        """The folders that a new file stands in; that one is there already is no fault."""
        parts = name.split("/")[:-1]
        for number in range(1, len(parts) + 1):
            try:
                self.channel.ask(f"MKD {self.there('/'.join(parts[:number]))}")
            except RefusedError:
                continue

    def rename(self, old: str, new: str) -> None:
        try:
            self.channel.ask(f"RNFR {self.there(old)}")
        except RefusedError as error:
            raise self._why(old, error) from None
        self.channel.ask(f"RNTO {self.there(new)}")

    def delete(self, name: str) -> None:
        try:
            self.channel.ask(f"DELE {self.there(name)}")
        except RefusedError as error:
            raise self._why(name, error) from None

    def _why(self, name: str, error: RefusedError) -> RefusedError:
        """The number of a refusal does not say whether the file is missing: the list does."""
        listed = {one.name.lower() for one in self.files()}
        return error if name.lower() in listed else NotThereError(f"{error} (it has no {name})")

    # ---- what FTP has no word for

    def lock(self) -> None:
        """FTP has no lock."""

    def unlock(self) -> None:
        """Nothing was taken."""

    def take_in(self, names: Sequence[str]) -> None:
        """Nothing is known of what the controller does with its files."""

    def take_out(self, names: Sequence[str]) -> None:
        """Nor of what it has loaded."""

    def close(self) -> None:
        self.channel.close()


def _one_line(name: str) -> str:
    """A name that cannot become two commands. Raises GarbledError."""
    if any(ord(sign) < 32 or ord(sign) > 255 for sign in name):
        raise GarbledError(f"{name!r} cannot be said to an FTP server")
    return name


def channel_of(profile: Profile, tls: bool) -> Channel:
    """A session, logged in: without a user of the profile as anonymous."""
    channel = Channel(profile.host, profile.port_of("ftp"), profile.patience_s, tls)
    with ExitStack() as failing:
        failing.callback(channel.close)
        if profile.user:
            channel.login(profile.user, profile.password)
        else:
            channel.login("anonymous", profile.given_password or "")
        failing.pop_all()
    return channel


def folder_of(profile: Profile) -> str:
    """The folder of the profile. The '/' between the address and a device (`ftp://HOST/md:`) is no part of its name."""
    bare = profile.folder.removeprefix("/")
    return bare if ":" in bare else profile.folder


def connect(profile: Profile) -> FtpLink:
    """Raises LinkError."""
    channel = channel_of(profile, profile.option("tls", "no").lower() in ("yes", "true", "1"))
    with ExitStack() as failing:
        failing.callback(channel.close)
        link = FtpLink(channel, folder_of(profile))
        failing.pop_all()
    return link

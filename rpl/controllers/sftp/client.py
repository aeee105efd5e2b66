"""Files of a folder behind SFTP (asyncssh), one question at a time, each within the profile's patience.

The server's key is pinned (`rpl.controllers.pins`) before a password is sent. A file takes the place of another in one
step by OpenSSH's `posix-rename@openssh.com`. Whatever the server says is bounded: how long an answer takes, how many
names a list has, how many bytes a file gives. Neither the user's own SSH keys nor his configuration are used.
"""

from __future__ import annotations

import asyncio
import posixpath
from collections.abc import Awaitable, Coroutine, Sequence
from typing import TypeVar, cast

import asyncssh

from rpl.controllers.link import (
    LARGEST_FILE,
    MOST_FILES,
    GarbledError,
    Identity,
    LinkError,
    LoginError,
    LostError,
    NotThereError,
    OtherControllerError,
    RefusedError,
    RemoteFile,
    State,
)
from rpl.controllers.pins import check_key
from rpl.controllers.profile import Profile
from rpl.controllers.rules import safe_name
from rpl.errors import UsageError

T = TypeVar("T")
_PIECE = 2**18  # bytes that are asked for, or brought, within one patience
_DEEPEST = 16  # folders within folders
_LISTING = 6.0  # patiences that a whole list may take
_GARBLED = (asyncssh.SFTPBadMessage, asyncssh.ProtocolError, asyncssh.MACError, asyncssh.CompressionError)
_LOST = (asyncssh.SFTPConnectionLost, asyncssh.SFTPNoConnection, asyncssh.DisconnectError, OSError, EOFError)


class _Pinning(asyncssh.SSHClient):
    """Looks at the server's key before anything is said to it."""

    def __init__(self, profile: Profile, port: int) -> None:
        self.profile = profile
        self.port = port
        self.wrong: LinkError | UsageError | None = None

    def validate_host_public_key(self, host: str, addr: str, port: int, key: asyncssh.SSHKey) -> bool:
        try:
            check_key(self.profile, "ssh", self.port, key.get_fingerprint())
        except (OtherControllerError, UsageError) as error:
            self.wrong = error
        return self.wrong is None


class SftpLink:
    """`connect` opens one. Names are below the profile's folder."""

    can_rename = True

    def __init__(self, profile: Profile, interface: str = "sftp") -> None:
        if not profile.host:
            raise UsageError(f"{profile.name}: which host?")
        if not profile.user:
            raise UsageError(
                f"{profile.name}: which user? Name user in rpl.toml, or in the address: {profile.maker}://USER@HOST"
            )
        self.profile = profile
        self.port = profile.port_of(interface)
        self._gone = ""
        self._connection: asyncssh.SSHClientConnection | None = None
        password = profile.password
        self._runner = asyncio.Runner()
        connected = False
        try:
            self._sftp = self._run(self._opened(password), f"{profile.host}:{self.port}")
            connected = True
        finally:
            if not connected:
                self._abort()
                self._runner.close()

    async def _opened(self, password: str) -> asyncssh.SFTPClient:
        pinning = _Pinning(self.profile, self.port)
        try:
            connection = await self._soon(
                asyncssh.connect(
                    self.profile.host,
                    self.port,
                    username=self.profile.user,
                    password=password,
                    client_factory=lambda: pinning,
                    known_hosts=([], [], []),
                    client_keys=[],
                    agent_path=None,
                    config=[],
                    preferred_auth=["password", "keyboard-interactive"],
                )
            )
        except asyncssh.HostKeyNotVerifiable:
            if pinning.wrong is None:
                raise
            raise pinning.wrong from None
        self._connection = connection
        return await self._soon(connection.start_sftp_client(path_encoding=None))

    # ---- how every question is asked

    async def _soon(self, answer: Awaitable[T], patiences: float = 1.0) -> T:
        return await asyncio.wait_for(answer, self.profile.patience_s * patiences)

    def _run(self, asking: Coroutine[None, None, T], about: str) -> T:
        """Ask, and tell what went wrong in our words. Behind a lost or garbled answer nothing more is asked."""
        if self._gone:
            asking.close()
            raise LostError(f"{about}: {self._gone}")
        try:
            return self._runner.run(asking)
        except TimeoutError:
            raise self._given_up(LostError(f"{about}: no answer within {self.profile.patience_s:g} s")) from None
        except asyncssh.PermissionDenied:
            raise LoginError(f"{about}: {self.profile.user} is not let in with this password") from None
        except asyncssh.HostKeyNotVerifiable as error:
            raise OtherControllerError(f"{about}: its key cannot be trusted: {error.reason}") from None
        except _GARBLED as error:
            raise self._given_up(GarbledError(f"{about}: the answer is none of SFTP: {error.reason}")) from None
        except _LOST as error:
            raise self._given_up(LostError(f"{about}: the connection is lost: {_words(error)}")) from None
        except (asyncssh.SFTPNoSuchFile, asyncssh.SFTPNoSuchPath) as error:
            raise NotThereError(f"{about}: {error.reason or 'there is none'}") from None
        except asyncssh.SFTPError as error:
            raise RefusedError(f"{about}: {error.reason or f'refused with code {error.code}'}") from None
        except asyncssh.Error as error:
            raise self._given_up(LostError(f"{about}: {error.reason}")) from None
        except GarbledError as error:
            raise self._given_up(error) from None

    def _given_up(self, error: LinkError) -> LinkError:
        self._gone = "the connection was given up before"
        self._abort()
        return error

    def _abort(self) -> None:
        if self._connection is not None:
            self._connection.abort()

    def _path(self, name: str) -> bytes:
        return posixpath.join(self.profile.folder, safe_name(name)).encode()

    # ---- what a link can do

    def identity(self) -> Identity:
        return Identity()

    def state(self) -> State:
        return State()

    def files(self) -> Sequence[RemoteFile]:
        return sorted(self._run(self._soon(self._listed(), _LISTING), self.profile.folder), key=lambda one: one.name)

    async def _listed(self) -> list[RemoteFile]:
        """All files below the folder; links are not followed."""
        found: list[RemoteFile] = []
        folders, seen = [("", 0)], 0
        while folders:
            below, depth = folders.pop()
            place = posixpath.join(self.profile.folder, below).encode()
            async for entry in self._sftp.scandir(place):
                seen += 1
                if seen > MOST_FILES:
                    raise GarbledError(f"{self.profile.folder} has more than {MOST_FILES} files, or a list without end")
                name = _decoded(entry.filename)
                if name in (".", ".."):
                    continue
                whole = safe_name(f"{below}/{name}" if below else name)
                if "/" in name:
                    raise GarbledError(f"the controller names a file {name[:200]!r} in {below or 'its folder'}")
                if entry.attrs.type == asyncssh.FILEXFER_TYPE_DIRECTORY:
                    if depth == _DEEPEST:
                        raise GarbledError(f"{whole}: more than {_DEEPEST} folders within each other")
                    folders.append((whole, depth + 1))
                elif entry.attrs.type == asyncssh.FILEXFER_TYPE_REGULAR:
                    found.append(RemoteFile(whole, entry.attrs.size))
        return found

    def fetch(self, name: str) -> bytes:
        return self._run(self._fetched(self._path(name), name), name)

    async def _fetched(self, path: bytes, name: str) -> bytes:
        handle = await self._soon(self._sftp.open(path, "rb", encoding=None))
        said = (await self._soon(handle.stat())).size
        if said is not None and said > LARGEST_FILE:
            raise GarbledError(f"{name}: it says that it has {said} bytes; more than {LARGEST_FILE} are not fetched")
        most = LARGEST_FILE if said is None else said
        data = bytearray()
        while piece := cast("bytes", await self._soon(handle.read(min(_PIECE, most + 1 - len(data)), len(data)))):
            data += piece
            if len(data) > most:
                raise GarbledError(f"{name}: it says that it has {most} bytes, and gives more")
        if said is not None and len(data) < said:
            raise GarbledError(f"{name}: it says that it has {said} bytes, and gives {len(data)}")
        await self._soon(handle.close())
        return bytes(data)

    def put(self, name: str, data: bytes) -> None:
        self._run(self._put(self._path(name), data), name)

    async def _put(self, path: bytes, data: bytes) -> None:
        try:
            handle = await self._soon(self._sftp.open(path, "wb", encoding=None))
        except asyncssh.SFTPNoSuchFile:
            await self._soon(self._sftp.makedirs(posixpath.dirname(path), exist_ok=True))
            handle = await self._soon(self._sftp.open(path, "wb", encoding=None))
        for start in range(0, len(data), _PIECE):
            await self._soon(handle.write(data[start : start + _PIECE], start))
        await self._soon(handle.close())

    def rename(self, old: str, new: str) -> None:
        self._run(self._soon(self._sftp.posix_rename(self._path(old), self._path(new))), f"{old} -> {new}")

    def delete(self, name: str) -> None:
        self._run(self._soon(self._sftp.remove(self._path(name))), name)

    def lock(self) -> None:
        """A file server has no such thing."""

    def unlock(self) -> None:
        """Nothing was taken."""

    def take_in(self, names: Sequence[str]) -> None:
        """A file is there as soon as it is written."""

    def take_out(self, names: Sequence[str]) -> None:
        """Nothing was loaded."""

    def close(self) -> None:
        """Wait for a polite end, but for a second at most: everything was said."""
        if not self._gone and self._connection is not None:
            self._gone = "the connection is closed"
            self._sftp.exit()
            self._connection.close()
            try:
                self._runner.run(asyncio.wait_for(self._connection.wait_closed(), 1.0))
            except (TimeoutError, OSError, asyncssh.Error):
                self._abort()
        self._runner.close()


def _decoded(name: bytes | str) -> str:
    if isinstance(name, str):
        return name
    try:
        return name.decode("utf-8")
    except UnicodeDecodeError:
        raise GarbledError(f"the controller names a file {name[:200]!r}, which is no text") from None


def _words(error: BaseException) -> str:
    said = getattr(error, "reason", "") or getattr(error, "strerror", "") or str(error)
    return str(said) or type(error).__name__


def connect(profile: Profile) -> SftpLink:
    """Raises LinkError."""
    return SftpLink(profile)

"""The file server of a virtual controller: SFTP version 3 with OpenSSH's posix-rename (asyncssh) over its store.

Every message of a client is a request of the transcript, so a connection can be lost at each of them. What was written
when a connection is lost half way stays half written, as on a real file system.
"""

from __future__ import annotations

import asyncio
import posixpath
from collections.abc import AsyncIterator, Awaitable, Callable
from dataclasses import dataclass, field
from typing import TypeVar

import asyncssh

from rpl.controllers.virtual.cabinet import Cabinet
from rpl.controllers.virtual.endpoints import Endpoints, not_had
from rpl.controllers.virtual.faults import DroppedError
from rpl.controllers.virtual.store import NotDoneError, Store
from rpl.controllers.virtual.transcript import Kind

T = TypeVar("T")
_FOLDER, _FILE = 0o40755, 0o100644
_NOISE = b"\x00\x00\x00\x09\xfe\x00\x00\x00\x01noise"


@dataclass
class _Open:
    """A file that a client has open."""

    name: str
    writes: bool
    data: bytearray = field(default_factory=bytearray)
    endless: bool = False


class _Login(asyncssh.SSHServer):
    """Password of the cabinet, whoever the user is."""

    def __init__(self, cabinet: Cabinet, interface: str, open_now: set[asyncssh.SSHServerConnection]) -> None:
        self.cabinet = cabinet
        self.interface = interface
        self.open_now = open_now

    def connection_made(self, conn: asyncssh.SSHServerConnection) -> None:
        self.connection = conn
        self.open_now.add(conn)

    def connection_lost(self, exc: Exception | None) -> None:
        self.open_now.discard(self.connection)

    def begin_auth(self, username: str) -> bool:
        return True

    def password_auth_supported(self) -> bool:
        return True

    async def validate_password(self, username: str, password: str) -> bool:
        try:
            self.cabinet.told(self.interface, "login", username)
            await asyncio.sleep(self.cabinet.faults.delay_s)
            right = self.cabinet.login(username, password)
            self.cabinet.after()
        except DroppedError:
            self.connection.abort()
            return False
        return right


class _Files(asyncssh.SFTPServer):
    """`root`: the folder of a client's view that holds the store's files."""

    def __init__(self, chan: asyncssh.SSHServerChannel[bytes], cabinet: Cabinet, interface: str, root: str) -> None:
        super().__init__(chan)
        self.cabinet = cabinet
        self.interface = interface
        self.root = root
        self.store: Store = cabinet.store
        self.writing: list[_Open] = []
        self.made: set[str] = set()

    # ---- how every request is carried out

    async def _carried_out(self, kind: Kind, text: str, work: Callable[[], T]) -> T:
        faults = self.cabinet.faults
        try:
            self.cabinet.told(self.interface, kind, text)
            await asyncio.sleep(faults.delay_s)
            if faults.comes("garbage"):
                self.channel.write(_NOISE)
                await asyncio.sleep(3600.0)
            if faults.name == "endless" and kind not in ("read", "list") and faults.comes("endless"):
                await asyncio.sleep(3600.0)  # an answer that never ends never comes
            try:
                return work()
            finally:
                self.cabinet.after()
        except DroppedError:
            self.connection.abort()
            raise asyncssh.SFTPConnectionLost("the connection is lost") from None
        except NotDoneError as error:
            raise _said(error) from None

    def _name(self, path: bytes) -> str:
        """The name in the store, empty for the root itself. Raises SFTPNoSuchFile for what is beside it."""
        full = posixpath.normpath(posixpath.join("/", path.decode("utf-8", "replace")))
        root = self.root.rstrip("/")
        if full == root or (not root and full == "/"):
            return ""
        if not full.startswith(f"{root}/"):
            raise asyncssh.SFTPNoSuchFile("No such file or directory")
        return full[len(root) + 1 :]

    def _is_folder(self, name: str) -> bool:
        return not name or name in self.made or any(one.startswith(f"{name}/") for one in self.store.names())

    # ---- questions

    def realpath(self, path: bytes, *compose_paths: bytes, check: int = 1) -> bytes:
        return posixpath.normpath(posixpath.join(self.root.encode(), path, *compose_paths))

    def stat(self, path: bytes) -> Awaitable[asyncssh.SFTPAttrs]:
        return self._carried_out("look", f"stat {path.decode('utf-8', 'replace')}", lambda: self._attributes(path))

    lstat = stat

    def _attributes(self, path: bytes) -> asyncssh.SFTPAttrs:
        if posixpath.normpath(path) in [b"/", *self._above()]:
            return asyncssh.SFTPAttrs(permissions=_FOLDER, size=0)
        return self._of(self._name(path))

    def _above(self) -> list[bytes]:
        """The folders that lead to the root."""
        parts = self.root.strip("/").split("/")
        return [("/" + "/".join(parts[: count + 1])).encode() for count in range(len(parts))]

    def _of(self, name: str) -> asyncssh.SFTPAttrs:
        if self._is_folder(name):
            return asyncssh.SFTPAttrs(permissions=_FOLDER, size=0)
        return asyncssh.SFTPAttrs(permissions=_FILE, size=self.store.size(name))

    def fstat(self, file_obj: object) -> Awaitable[asyncssh.SFTPAttrs]:
        opened = _opened(file_obj)

        def said() -> asyncssh.SFTPAttrs:
            if opened.writes:
                return asyncssh.SFTPAttrs(permissions=_FILE, size=len(opened.data))
            return self._of(opened.name)

        return self._carried_out("look", f"fstat {opened.name}", said)

    def setstat(self, path: bytes, attrs: asyncssh.SFTPAttrs) -> None:
        """Times and rights are not kept."""

    lsetstat = setstat

    def fsetstat(self, file_obj: object, attrs: asyncssh.SFTPAttrs) -> None:
        """Times and rights are not kept."""

    def fsync(self, file_obj: object) -> None:
        """The store is in memory."""

    async def scandir(self, path: bytes) -> AsyncIterator[asyncssh.SFTPName]:
        faults = self.cabinet.faults
        listed = await self._carried_out("list", path.decode("utf-8", "replace"), lambda: self._entries(path))
        for name, attributes in listed:
            yield asyncssh.SFTPName(name.encode(), attrs=attributes)
        number = 0
        if faults.comes("endless"):
            while True:
                number += 1
                yield asyncssh.SFTPName(b"more%d.txt" % number, attrs=asyncssh.SFTPAttrs(permissions=_FILE, size=1))
                if number % 128 == 0:
                    await asyncio.sleep(0)

    def _entries(self, path: bytes) -> list[tuple[str, asyncssh.SFTPAttrs]]:
        full = posixpath.normpath(path)
        above = [b"/", *self._above()]
        if full in above[:-1]:
            return [(posixpath.basename(above[above.index(full) + 1]).decode(), self._of(""))]
        folder = self._name(path)
        if not self._is_folder(folder):
            raise NotDoneError("missing", folder)
        start = f"{folder}/" if folder else ""
        found: dict[str, asyncssh.SFTPAttrs] = {}
        for name in [*self.store.names(), *self.made]:
            if name.startswith("../") and not folder:
                found[name] = asyncssh.SFTPAttrs(permissions=_FILE, size=4)  # a fault: a name that leads elsewhere
            elif name.startswith(start) and name != folder:
                first = name[len(start) :].partition("/")[0]
                found[first] = self._of(start + first)
        dots = asyncssh.SFTPAttrs(permissions=_FOLDER, size=0)
        return [(".", dots), ("..", dots), *found.items()]

    # ---- files

    def open(self, path: bytes, pflags: int, attrs: asyncssh.SFTPAttrs) -> Awaitable[object]:
        writes = bool(pflags & (asyncssh.FXF_WRITE | asyncssh.FXF_APPEND))
        kind: Kind = "write" if writes else "read"
        return self._carried_out(kind, f"open {path.decode('utf-8', 'replace')}", lambda: self._open(path, pflags))

    def _open(self, path: bytes, pflags: int) -> _Open:
        name = self._name(path)
        if self._is_folder(name):
            raise asyncssh.SFTPFailure("Is a directory")
        if not pflags & (asyncssh.FXF_WRITE | asyncssh.FXF_APPEND):
            return _Open(name, False, bytearray(self.store.read(name)))
        there = name in self.store
        if not there and not pflags & asyncssh.FXF_CREAT:
            raise NotDoneError("missing", name)
        if there and pflags & asyncssh.FXF_EXCL:
            raise asyncssh.SFTPFailure("File exists")
        folder = posixpath.dirname(name)
        if not self._is_folder(folder):
            raise NotDoneError("missing", name)
        self.store.may_write(name)
        kept = bytearray(self.store.kept(name)) if there and not pflags & asyncssh.FXF_TRUNC else bytearray()
        opened = _Open(name, True, kept)
        self.writing.append(opened)
        return opened

    async def read(self, file_obj: object, offset: int, size: int) -> bytes:
        opened = _opened(file_obj)

        def piece() -> bytes:
            if self.cabinet.faults.comes("endless"):
                opened.endless = True
            return b"x" * size if opened.endless else bytes(opened.data[offset : offset + size])

        return await self._carried_out("read", f"{opened.name} {offset}+{size}", piece)

    async def write(self, file_obj: object, offset: int, data: bytes) -> int:
        opened = _opened(file_obj)

        def kept() -> int:
            if offset > len(opened.data):
                opened.data.extend(bytes(offset - len(opened.data)))
            opened.data[offset : offset + len(data)] = data
            return len(data)

        return await self._carried_out("write", f"{opened.name} {offset}+{len(data)}", kept)

    async def close(self, file_obj: object) -> None:
        opened = _opened(file_obj)
        if not opened.writes:
            return

        def done() -> None:
            self.writing.remove(opened)
            self.store.write(opened.name, bytes(opened.data))

        await self._carried_out("write", f"close {opened.name}", done)

    async def remove(self, path: bytes) -> None:
        await self._carried_out("delete", path.decode("utf-8", "replace"), lambda: self.store.delete(self._name(path)))

    async def posix_rename(self, oldpath: bytes, newpath: bytes) -> None:
        words = f"rename {oldpath.decode('utf-8', 'replace')} {newpath.decode('utf-8', 'replace')}"
        await self._carried_out("write", words, lambda: self.store.rename(self._name(oldpath), self._name(newpath)))

    async def rename(self, oldpath: bytes, newpath: bytes, flags: int = 0) -> None:
        """Version 3 does not replace what is there."""
        if self._name(newpath) in self.store:
            raise asyncssh.SFTPFailure("File exists")
        await self.posix_rename(oldpath, newpath)

    async def mkdir(self, path: bytes, attrs: asyncssh.SFTPAttrs) -> None:
        def made() -> None:
            if posixpath.normpath(path) in [b"/", *self._above()]:
                raise asyncssh.SFTPFailure("File exists")
            name = self._name(path)
            if self._is_folder(name) or name in self.store:
                raise asyncssh.SFTPFailure("File exists")
            self.made.add(name)

        await self._carried_out("write", f"mkdir {path.decode('utf-8', 'replace')}", made)

    async def rmdir(self, path: bytes) -> None:
        def gone() -> None:
            name = self._name(path)
            if any(one.startswith(f"{name}/") for one in self.store.names()):
                raise asyncssh.SFTPFailure("Directory not empty")
            self.made.discard(name)

        await self._carried_out("delete", f"rmdir {path.decode('utf-8', 'replace')}", gone)

    def exit(self) -> None:
        """The connection is over: what was being written is there as far as it came."""
        self.store.put((opened.name, bytes(opened.data)) for opened in self.writing)
        self.writing.clear()


def _opened(file_obj: object) -> _Open:
    if not isinstance(file_obj, _Open):
        raise asyncssh.SFTPFailure("Invalid handle")
    return file_obj


def _said(error: NotDoneError) -> asyncssh.SFTPError:
    """As a Linux file server says it."""
    match error.why:
        case "missing":
            return asyncssh.SFTPNoSuchFile("No such file or directory")
        case "protected":
            return asyncssh.SFTPPermissionDenied("Permission denied")
        case "full":
            return asyncssh.SFTPFailure("No space left on device")
        case "busy":
            return asyncssh.SFTPFailure(f"Text file busy: {error.said}")
    return asyncssh.SFTPFailure(error.said or error.why)


async def open_sftp(cabinet: Cabinet, endpoints: Endpoints, usual: int, root: str, interface: str = "sftp") -> None:
    """Let clients see the store's files below `root`. Raises UsageError when the port cannot be had."""
    open_now: set[asyncssh.SSHServerConnection] = set()
    key = asyncssh.generate_private_key("ssh-ed25519")
    wanted = endpoints.port(interface, usual)
    try:
        acceptor = await asyncssh.listen(
            endpoints.host,
            wanted,
            server_factory=lambda: _Login(cabinet, interface, open_now),
            server_host_keys=[key],
            sftp_factory=lambda chan: _Files(chan, cabinet, interface, root),
            allow_scp=False,
            encoding=None,
        )
    except OSError as error:
        raise not_had(endpoints.host, interface, wanted, error) from None

    async def close() -> None:
        acceptor.close()
        for connection in tuple(open_now):
            connection.abort()
            await connection.wait_closed()

    endpoints.opened(interface, acceptor.get_port(), close)

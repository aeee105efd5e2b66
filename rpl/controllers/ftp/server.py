"""The FTP server of virtual controllers: pyftpdlib in a thread of its own, over the controller's files.

What a maker's controller does differently is a `Shelf`: which names it lists, what it makes when a file is asked for,
how it refuses. Devices (`MD:`) may stand before a name, with either slash.
"""

from __future__ import annotations

import io
import logging
import posixpath
import re
import stat as modes
import threading
from collections.abc import Callable, Sequence
from os import stat_result
from typing import Protocol, TypeVar

from pyftpdlib.exceptions import AuthenticationFailed
from pyftpdlib.filesystems import AbstractedFS, FilesystemError
from pyftpdlib.handlers import DTPHandler, FTPHandler
from pyftpdlib.ioloop import IOLoop
from pyftpdlib.servers import FTPServer

from rpl.controllers.virtual.cabinet import Cabinet
from rpl.controllers.virtual.endpoints import Endpoints, not_had
from rpl.controllers.virtual.faults import DroppedError
from rpl.controllers.virtual.store import NotDoneError, Store
from rpl.controllers.virtual.transcript import Kind

# How often the thread looks whether it is to end (s).
_LOOK_S = 0.05
_KINDS: dict[str, Kind] = {
    "USER": "login",
    "PASS": "login",
    "NLST": "list",
    "LIST": "list",
    "MLSD": "list",
    "MLST": "list",
    "RETR": "read",
    "STOR": "write",
    "APPE": "write",
    "RNFR": "write",
    "RNTO": "write",
    "MKD": "write",
    "DELE": "delete",
    "RMD": "delete",
    "ABOR": "other",
    "QUIT": "other",
}
_NOISE = bytes((31 * number + 7) % 256 for number in range(512))
Done = TypeVar("Done")


_HUGE = 2**40


def _silent(*said: object) -> None:
    """The transcript keeps what is worth it."""


class Shelf(Protocol):
    """The files as a maker's controller shows them; names have '/' between folders. Each raises NotDoneError."""

    @property
    def folds(self) -> bool:
        """Are capitals no difference in names?"""

    @property
    def renames(self) -> bool:
        """Does the controller rename files?"""

    def names(self) -> Sequence[str]: ...
    def size(self, name: str) -> int: ...
    def read(self, name: str) -> bytes: ...
    def write(self, name: str, data: bytes) -> None: ...
    def delete(self, name: str) -> None: ...
    def rename(self, old: str, new: str) -> None: ...
    def lets_in(self, user: str, password: str) -> bool: ...
    def said(self, error: NotDoneError) -> str:
        """A refusal in the controller's words, which stand behind the number 550."""


_SAID = {
    "missing": "No such file or directory",
    "protected": "Permission denied",
    "full": "No space left on device",
    "busy": "Device or resource busy",
    "syntax": "Syntax error in file",
    "name": "Invalid file name",
    "exists": "File exists",
    "emergency-stop": "Emergency stop",
}


class StoreShelf:
    """The files of the store as they are."""

    folds = False
    renames = True

    def __init__(self, cabinet: Cabinet) -> None:
        self.cabinet = cabinet
        self.store: Store = cabinet.store

    def names(self) -> Sequence[str]:
        return self.store.names()

    def size(self, name: str) -> int:
        return self.store.size(name)

    def read(self, name: str) -> bytes:
        return self.store.read(name)

    def write(self, name: str, data: bytes) -> None:
        self.store.write(name, data)

    def delete(self, name: str) -> None:
        self.store.delete(name)

    def rename(self, old: str, new: str) -> None:
        self.store.rename(old, new)

    def lets_in(self, user: str, password: str) -> bool:
        return self.cabinet.login(user, password)

    def said(self, error: NotDoneError) -> str:
        return f"{_SAID[error.why]}: {error.said}" if error.said else _SAID[error.why]


class _Endless:
    """A producer that gives the same bytes for ever."""

    def __init__(self, data: bytes) -> None:
        self._data = data

    def more(self) -> bytes:
        return self._data


class _File(io.BytesIO):
    """What is transferred; pyftpdlib wants a name of it."""

    def __init__(self, name: str, data: bytes = b"") -> None:
        super().__init__(data)
        self.name = name


class _Files(AbstractedFS):  # type: ignore[misc]  # pyftpdlib has no types
    """Paths inside of the server are '/NAME'."""

    shelf: Shelf
    devices: tuple[str, ...] = ()

    def ftpnorm(self, path: str) -> str:
        clean = path.replace("\\", "/")
        found = re.match(r"/?([A-Za-z]\w*:)/?", clean)
        if found is not None:
            if found[1].upper() not in self.devices:
                return "/:no such device:"
            clean = "/" + clean[found.end() :]
        return posixpath.normpath(posixpath.join(self.cwd, clean)).replace("//", "/")

    def ftp2fs(self, path: str) -> str:
        return self.ftpnorm(path)

    def fs2ftp(self, path: str) -> str:
        return path

    def validpath(self, path: str) -> bool:
        return True

    def realpath(self, path: str) -> str:
        return path

    def chdir(self, path: str) -> None:
        if not self.isdir(path):
            raise FilesystemError("No such directory")
        self.cwd = path

    def _folded(self, name: str) -> str:
        return name.lower() if self.shelf.folds else name

    def listdir(self, path: str) -> list[str]:
        below = path.strip("/") + "/" if path != "/" else ""
        found: dict[str, None] = {}
        for name in self.shelf.names():
            if self._folded(name).startswith(self._folded(below)):
                rest = name[len(below) :]
                found[rest if rest.startswith("..") else rest.split("/")[0]] = None
        return list(found)

    def isdir(self, path: str) -> bool:
        return path == "/" or any(
            self._folded(name).startswith(self._folded(path.strip("/") + "/")) for name in self.shelf.names()
        )

    def isfile(self, path: str) -> bool:
        wanted = self._folded(path.strip("/"))
        return any(self._folded(name) == wanted for name in self.shelf.names())

    def islink(self, path: str) -> bool:
        return False

    def lexists(self, path: str) -> bool:
        return self.isfile(path) or self.isdir(path)

    def getsize(self, path: str) -> int:
        return self._done(lambda: self.shelf.size(path.strip("/")))

    def getmtime(self, path: str) -> float:
        return 0.0

    def stat(self, path: str) -> stat_result:
        if self.isdir(path):
            return stat_result((modes.S_IFDIR | 0o755, 0, 0, 2, 0, 0, 0, 0, 0, 0))
        size = 0 if ".." in path else self.getsize(path)
        return stat_result((modes.S_IFREG | 0o644, 0, 0, 1, 0, 0, size, 0, 0, 0))

    lstat = stat

    def open(self, path: str, mode: str) -> _File:
        name = path.strip("/")
        if "r" in mode and "+" not in mode:
            return _File(name, self._done(lambda: self.shelf.read(name)))
        if "+" in mode or "a" in mode:
            raise FilesystemError("Only whole files are written")
        return _File(name)

    def mkdir(self, path: str) -> None:
        """Folders are there as soon as a file is in them."""

    def rmdir(self, path: str) -> None:
        raise FilesystemError("Not done here")

    def remove(self, path: str) -> None:
        self._done(lambda: self.shelf.delete(path.strip("/")))

    def rename(self, src: str, dst: str) -> None:
        self._done(lambda: self.shelf.rename(src.strip("/"), dst.strip("/")))

    def _done(self, work: Callable[[], Done]) -> Done:
        try:
            return work()
        except NotDoneError as error:
            raise FilesystemError(self.shelf.said(error)) from None


class _Transfer(DTPHandler):  # type: ignore[misc]  # as above
    """A file is written when all of it has come, and what the controller says of it is the answer."""

    def handle_close(self) -> None:
        session = self.cmd_channel
        if self._closed or not self.receive or self.file_obj is None:
            super().handle_close()
            return
        self.transfer_finished = True
        name, data = self.file_obj.name, self.file_obj.getvalue()
        try:
            session.shelf.write(name, data)
            self._resp = ("226 Transfer complete.", _silent)
        except NotDoneError as error:
            self._resp = (f"550 {session.shelf.said(error)}", _silent)
        self.close()


class _Session(FTPHandler):  # type: ignore[misc]  # as above
    """A client's session: each request is told to the cabinet, and faults come with answers."""

    cabinet: Cabinet
    shelf: Shelf
    interface: str
    dtp_handler = _Transfer
    auth_failed_timeout = 0
    use_sendfile = False
    use_gmt_times = True
    encoding = "latin-1"
    timeout = 0
    misbehaves = ""
    asked = False
    announced: int | None = None

    def on_connect(self) -> None:
        self.cabinet.told(self.interface, "connect", str(self.remote_ip), counts=False)

    def pre_process_command(self, line: str, cmd: str, arg: str) -> None:
        """Each request is told to the cabinet before anything else is done about it."""
        shown = f"{cmd} {'******' if cmd == 'PASS' else arg}".rstrip()
        try:
            self.cabinet.told(self.interface, _KINDS.get(cmd, "look"), shown)
        except DroppedError:
            self._cut()
            return
        faults = self.cabinet.faults
        self.misbehaves = next((name for name in ("endless", "garbage") if faults.comes(name)), "")
        self.asked, self.announced = True, None
        super().pre_process_command(line, cmd, arg)

    def respond(self, resp: str, logfun: Callable[..., None] = _silent) -> None:
        """The answer that ends a request is where the line is lost, and where noise comes instead."""
        if self._closed:
            return
        if resp.startswith("1"):
            size = f" ({self.announced} bytes)" if self.announced is not None else ""
            super().respond(f"150 Opening data connection{size}.", logfun)
            return
        if self.asked:
            self.asked = False
            self.cabinet.faults.slow_down()
            try:
                self.cabinet.after()
            except DroppedError:
                self._cut()
                return
            if self.misbehaves == "endless":
                self.push_with_producer(_Endless(f"{resp[:3]}-and so on\r\n".encode() * 50))
                return
            if self.misbehaves == "garbage":
                self.push(_NOISE + b"\r\n")
                return
        super().respond(resp, logfun)

    def ftp_RETR(self, file: str) -> str | None:  # noqa: N802 - the name that the library calls
        """The size is said before the data come."""
        name = file.strip("/")
        try:
            data = self.shelf.read(name)
        except NotDoneError as error:
            self.respond(f"550 {self.shelf.said(error)}")
            return None
        self.announced = _HUGE if self.cabinet.faults.comes("huge", counted=False) else len(data)
        self._give(data, "RETR")
        return file

    def ftp_NLST(self, path: str) -> str | None:  # noqa: N802 - the name that the library calls
        """Names as they are, in order."""
        if not self.fs.isdir(path):
            self.respond("550 No such directory.")
            return None
        self._give("".join(f"{name}\r\n" for name in sorted(self.fs.listdir(path))).encode(self.encoding), "NLST")
        return path

    def _give(self, data: bytes, command: str) -> None:
        if self.misbehaves == "endless":
            self.misbehaves, self.announced = "", None
            self.push_dtp_data(_Endless(b"and so on\r\n" * 500), isproducer=True, cmd=command)
        elif self.misbehaves == "garbage":
            self.misbehaves = ""
            self.push_dtp_data(_NOISE, cmd=command)
        else:
            self.push_dtp_data(data, cmd=command)

    def ftp_RNFR(self, path: str) -> None:  # noqa: N802 - the name that the library calls
        if not self.shelf.renames:
            self.respond('502 Command "RNFR" not implemented.')
            return
        super().ftp_RNFR(path)

    def _cut(self) -> None:
        """The line is gone: nothing more is said."""
        if self.data_channel is not None:
            self.data_channel._resp = None
            self.data_channel.file_obj = None
        self.close()

    def log(self, msg: str, logfun: Callable[..., None] = _silent) -> None:
        """The transcript keeps what is worth it."""


class _Doorkeeper:
    """Who is let in; everybody who is may do everything that the shelf allows."""

    def __init__(self, shelf: Shelf) -> None:
        self.shelf = shelf

    def validate_authentication(self, username: str, password: str, handler: FTPHandler) -> None:
        if not self.shelf.lets_in(username, password):
            raise AuthenticationFailed("Login incorrect")

    def get_home_dir(self, username: str) -> str:
        return "/"

    def get_msg_login(self, username: str) -> str:
        return "Login successful."

    def get_msg_quit(self, username: str) -> str:
        return "Goodbye."

    def has_perm(self, username: str, perm: str, path: str | None = None) -> bool:
        return True

    def get_perms(self, username: str) -> str:
        return "elradfmwMT"

    def impersonate_user(self, username: str, password: str) -> None:
        """The thread's own rights are enough."""

    def terminate_impersonation(self, username: str) -> None:
        """Nothing was changed."""


def serve_files(
    cabinet: Cabinet,
    endpoints: Endpoints,
    shelf: Shelf,
    devices: Sequence[str] = (),
    interface: str = "ftp",
    usual: int = 21,
    banner: str = "FTP server ready.",
) -> None:
    """Open an FTP server over the controller's files. Raises UsageError when the port cannot be had."""
    files = type("Files", (_Files,), {"shelf": shelf, "devices": tuple(device.upper() for device in devices)})
    told = {
        "cabinet": cabinet,
        "shelf": shelf,
        "interface": interface,
        "abstracted_fs": files,
        "authorizer": _Doorkeeper(shelf),
        "banner": banner,
    }
    logging.getLogger("pyftpdlib").setLevel(logging.CRITICAL)
    port = endpoints.port(interface, usual)
    loop = IOLoop()
    try:
        server = FTPServer((endpoints.host, port), type("Session", (_Session,), told), ioloop=loop)
    except OSError as error:
        raise not_had(endpoints.host, interface, port, error) from None
    over = threading.Event()

    def run() -> None:
        while not over.is_set():
            loop.loop(_LOOK_S, blocking=False)
        server.close_all()

    thread = threading.Thread(target=run, name=f"{interface} server", daemon=True)

    def close() -> None:
        over.set()
        thread.join(timeout=5.0)

    endpoints.opened(interface, server.socket.getsockname()[1], close)
    thread.start()

"""One FTP session under strict limits: no answer and no transfer lasts longer, and none is longer, than may be.

The standard `ftplib` speaks the protocol; what it leaves open is closed here. It waits for as long as single bytes keep
coming, and reads an answer of several lines until its end, however far that is.
"""

from __future__ import annotations

import ftplib
import socket
import ssl
import time
from collections.abc import Iterator
from contextlib import contextmanager

from rpl.controllers.link import LARGEST_FILE, GarbledError, LinkError, LoginError, LostError, RefusedError

# An answer has no more lines, a line no more bytes, a listing no more bytes.
_MOST_LINES = 200
_LONGEST_LINE = 4096
_LONGEST_LISTING = 8 * 2**20
# A file may take this many times the patience for one answer.
_TRANSFER = 12.0
_BLOCK = 2**16


class _Session(ftplib.FTP_TLS):
    """ftplib with a deadline: whatever is read or sent has to be over by then. TLS only after `auth`."""

    def __init__(self, patience_s: float) -> None:
        super().__init__(timeout=patience_s, encoding="latin-1", context=ssl.create_default_context())
        self.passiveserver = True
        self.use_epsv_with_ipv4 = False
        self.deadline = time.monotonic() + patience_s
        self._pending = b""

    def left_s(self) -> float:
        left = self.deadline - time.monotonic()
        if left <= 0.0:
            raise TimeoutError("no answer in time")
        return left

    def getline(self) -> str:
        """One line of an answer, read within the deadline."""
        assert self.sock is not None
        while b"\n" not in self._pending:
            if len(self._pending) > _LONGEST_LINE:
                raise GarbledError("a line of the answer has no end")
            self.sock.settimeout(self.left_s())
            more = self.sock.recv(_LONGEST_LINE)
            if not more:
                raise EOFError
            self._pending += more
        line, _, self._pending = self._pending.partition(b"\n")
        return line.rstrip(b"\r").decode("latin-1")

    def getmultiline(self) -> str:
        """A whole answer. Raises GarbledError when its lines have no end."""
        lines = [self.getline()]
        code, more = lines[0][:3], lines[0][3:4] == "-"
        while more:
            if len(lines) > _MOST_LINES:
                raise GarbledError(f"the answer {lines[0][:40]!r} has no end")
            lines.append(self.getline())
            more = lines[-1][:3] != code or lines[-1][3:4] == "-"
        return "\n".join(lines)

    def auth(self) -> str:
        if self._pending:
            raise GarbledError("more was answered than was asked for")
        return super().auth()


class Channel:
    """A session with an FTP server; every call is over within its time and raises nothing but LinkErrors."""

    def __init__(self, host: str, port: int, patience_s: float, tls: bool = False) -> None:
        self.where = f"{host}:{port}"
        self.patience_s = patience_s
        self._tls = tls
        self._session = _Session(patience_s)
        with self._guarded(patience_s):
            self._session.connect(host, port, timeout=patience_s)
            if tls:
                self._session.auth()

    def login(self, user: str, password: str) -> None:
        """Raises LoginError."""
        with self._guarded(self.patience_s, login=True):
            self._session.login(user, password, secure=self._tls)
            if self._tls:
                self._session.prot_p()

    def ask(self, command: str) -> str:
        """The answer to a command that carries no data, without its number."""
        with self._guarded(self.patience_s):
            return self._session.sendcmd(command)[4:]

    def read(self, command: str, longest: int = LARGEST_FILE) -> bytes:
        """The data that a command gives. Raises GarbledError when there are more than may be, LostError when fewer come
        than the server says there are."""
        pieces: list[bytes] = []
        with self._guarded(_TRANSFER * self.patience_s), self._data(command) as (connection, size):
            if size is not None and size > longest:
                raise GarbledError(f"{command[5:]}: {size} bytes are more than any program has ({longest})")
            got = 0
            while True:
                connection.settimeout(min(self.patience_s, self._session.left_s()))
                piece = connection.recv(_BLOCK)
                if not piece:
                    break
                pieces.append(piece)
                got += len(piece)
                if got > longest:
                    raise GarbledError(f"{command[5:]}: the data have no end ({longest} bytes were read)")
            if size is not None and got < size:
                raise LostError(f"{self.where}: {got} of {size} bytes came")
            if size is not None and got > size:
                raise GarbledError(f"{self.where}: {got} bytes came, and {size} were announced")
        return b"".join(pieces)

    def lines(self, command: str) -> list[str]:
        """The lines of a listing."""
        return self.read(command, _LONGEST_LISTING).decode("latin-1").splitlines()

    def write(self, command: str, data: bytes) -> None:
        with self._guarded(_TRANSFER * self.patience_s), self._data(command) as (connection, _):
            view = memoryview(data)
            for start in range(0, len(view), _BLOCK):
                connection.settimeout(min(self.patience_s, self._session.left_s()))
                connection.sendall(view[start : start + _BLOCK])

    def close(self) -> None:
        self._session.close()

    @contextmanager
    def _data(self, command: str) -> Iterator[tuple[socket.socket, int | None]]:
        """The connection of one transfer, and the number of bytes that the server announces; behind it the server's
        word that all has come."""
        connection, size = self._session.ntransfercmd(command)
        try:
            yield connection, size
            if isinstance(connection, ssl.SSLSocket):
                connection.unwrap()
        finally:
            connection.close()
        self._session.deadline = max(self._session.deadline, time.monotonic() + self.patience_s)
        self._session.voidresp()

    @contextmanager
    def _guarded(self, limit_s: float, login: bool = False) -> Iterator[None]:
        """What can go wrong, in the words of links. After a lost line or a garbled answer the session is over."""
        self._session.deadline = time.monotonic() + limit_s
        if self._session.sock is not None:
            self._session.sock.settimeout(self.patience_s)
        try:
            yield
        except LinkError as error:
            if not isinstance(error, RefusedError):
                self.close()
            raise
        except ftplib.error_perm as error:
            refused = LoginError if login or str(error).startswith("530") else RefusedError
            raise refused(f"{self.where}: {_said(error)}") from None
        except ftplib.error_temp as error:
            if str(error)[:3] in ("421", "425", "426"):
                self.close()
                raise LostError(f"{self.where}: {_said(error)}") from None
            raise RefusedError(f"{self.where}: {_said(error)}") from None
        except (ftplib.Error, UnicodeError, ValueError) as error:
            self.close()
            raise GarbledError(f"{self.where}: this is no answer of an FTP server: {_said(error)}") from None
        except ssl.SSLError as error:
            self.close()
            raise LinkError(f"{self.where}: TLS: {error.reason or error}") from None
        except EOFError:
            self.close()
            raise LostError(f"{self.where}: the controller closed the connection") from None
        except OSError as error:
            self.close()
            reason = f"no answer within {limit_s:g} s" if isinstance(error, TimeoutError) else error.strerror or error
            raise LostError(f"{self.where}: {reason}") from None


def _said(error: Exception) -> str:
    """The server's words, fit for one line of ours."""
    text = " ".join("".join(sign if sign.isprintable() else " " for sign in str(error)).split())
    return text[:300]

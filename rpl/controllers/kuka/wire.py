"""One connection to C3 Bridge or KukavarProxy: a question, its answer."""

from __future__ import annotations

import socket
import time

from rpl.controllers.kuka import c3
from rpl.controllers.kuka.c3 import Message, MessageError
from rpl.controllers.link import GarbledError, LostError, NotThereError, RefusedError


class Wire:
    """Every answer is waited for `patience_s` at most, however slowly its bytes come."""

    def __init__(self, host: str, port: int, patience_s: float) -> None:
        self.place = f"{host}:{port}"
        self.patience_s = patience_s
        self.tag = 0
        try:
            self.socket = socket.create_connection((host, port), patience_s)
            self.socket.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
        except OSError as error:
            raise LostError(f"{self.place}: {error.strerror or error}") from None

    def ask(self, kind: int, said: bytes, about: str = "", length: int | None = None) -> bytes:
        """What the answer says; `length`: how long that is, where it is known. Raises RefusedError when the controller
        says no, LostError, GarbledError."""
        self.tag = self.tag % c3.LONGEST + 1
        end = time.monotonic() + self.patience_s
        try:
            self.socket.settimeout(self.patience_s)
            self.socket.sendall(Message(self.tag, kind, said).packed())
            tag, count, answered = c3.HEAD.unpack(self._received(c3.HEAD.size, end))
            if tag != self.tag or answered != kind or count < 1:
                raise GarbledError(f"{self.place} gives an answer that belongs to no question")
            told, code, good = c3.parts_of(self._received(count - 1, end))
        except TimeoutError:
            raise LostError(f"{self.place} did not answer within {self.patience_s:g} s") from None
        except OSError as error:
            raise LostError(f"{self.place}: {error.strerror or error}") from None
        except MessageError as error:
            raise GarbledError(f"{self.place}: {error}") from None
        if not good and code in c3.ERRORS:
            raise RefusedError(f"{about}: {c3.ERRORS[code]} (code {code})")
        if not good or code != c3.SUCCESS or (length is not None and len(told) != length):
            raise GarbledError(f"{self.place} gives an answer that is none to {about or 'what was asked'}")
        return told

    def _received(self, count: int, end: float) -> bytes:
        parts = []
        while count:
            self.socket.settimeout(max(1e-3, end - time.monotonic()))
            part = self.socket.recv(count)
            if not part:
                raise LostError(f"{self.place} has ended the connection")
            if time.monotonic() > end:
                raise TimeoutError
            parts.append(part)
            count -= len(part)
        return b"".join(parts)

    def value(self, name: str) -> str:
        """The value of a variable, as KRL spells it. Raises NotThereError when there is none of that name."""
        try:
            told = self.ask(c3.READ_ASCII, c3.narrow(name.encode("ascii", "replace")), name)
            return c3.Reader(told).narrow().decode("cp1252", "replace")
        except RefusedError as error:
            raise NotThereError(str(error)) from None
        except MessageError as error:
            raise GarbledError(f"{self.place}: {error}") from None

    def close(self) -> None:
        self.socket.close()

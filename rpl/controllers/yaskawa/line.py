"""One question and its answer over UDP, where nothing says that a packet was lost."""

from __future__ import annotations

import socket
import time

from rpl.controllers.link import LostError
from rpl.controllers.yaskawa import hses
from rpl.controllers.yaskawa.hses import Answer, PacketError, Request

# How long an answer is waited for before a question that changes nothing is asked again (s); fs100 waits as long.
ASKED_AGAIN_S = 0.8
_LARGEST_DATAGRAM = 2**16


class Line:
    """A socket to one port of the controller. Answers that belong to no open question (late ones, noise) are passed
    over; what nobody answers in `patience_s` raises LostError."""

    def __init__(self, host: str, port: int, patience_s: float) -> None:
        self.place = f"{host}:{port}"
        self.patience_s = patience_s
        self.number = 0
        self.noise = ""
        try:
            address = socket.getaddrinfo(host, port, type=socket.SOCK_DGRAM)[0]
            self.socket = socket.socket(address[0], socket.SOCK_DGRAM)
            self.socket.connect(address[4])
        except OSError as error:
            raise LostError(f"{self.place}: {error.strerror or error}") from None

    def next_number(self) -> int:
        """The number of a new command."""
        self.number = self.number % 255 + 1
        return self.number

    def ask(self, request: Request, block: int | None = None, again: bool = True) -> Answer:
        """The answer to a packet. `block`: only an answer with this number, whether it is the last or not (None: any).
        `again`: the packet may be sent again, because the controller does the same or nothing when it gets it twice.
        """
        end = time.monotonic() + self.patience_s
        self.noise = ""
        self._send(request)
        while (left := end - time.monotonic()) > 0.0:
            found = self._answer_to(request, block, min(left, ASKED_AGAIN_S if again else left))
            if found is not None:
                return found
            if again:
                self._send(request)
        said = f" ({self.noise})" if self.noise else ""
        raise LostError(f"{self.place} did not answer within {self.patience_s:g} s{said}")

    def tell(self, request: Request) -> None:
        """Send what is not answered."""
        self._send(request)

    def _send(self, request: Request) -> None:
        try:
            self.socket.send(request.packed())
        except OSError as error:
            raise LostError(f"{self.place}: {error.strerror or error}") from None

    def _answer_to(self, request: Request, block: int | None, wait_s: float) -> Answer | None:
        """The answer, if it comes in this time."""
        end = time.monotonic() + wait_s
        while (left := end - time.monotonic()) > 0.0:
            self.socket.settimeout(left)
            try:
                packet = self.socket.recv(_LARGEST_DATAGRAM)
            except TimeoutError:
                return None
            except OSError as error:  # nobody listens at that port
                raise LostError(f"{self.place}: {error.strerror or error}") from None
            try:
                answer = hses.answer_of(packet)
            except PacketError as error:
                self.noise = str(error)
                continue
            ours = answer.number == request.number and answer.service == request.service
            if ours and (block is None or answer.status or answer.block & ~hses.LAST == block):
                return answer
        return None

    def close(self) -> None:
        self.socket.close()

"""A virtual controller of Yaskawa: the High-Speed Ethernet Server in front of the emulator.

Files by one port, the robot by the other. What the packets hold is from the manual as told in `hses`; when which error
comes is what the manual's list of errors says of it, and no more is known.
"""

from __future__ import annotations

import asyncio
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import cast

from rpl.controllers.virtual.cabinet import Cabinet
from rpl.controllers.virtual.endpoints import Endpoints
from rpl.controllers.virtual.faults import DroppedError
from rpl.controllers.virtual.store import NotDoneError, Why
from rpl.controllers.virtual.transcript import Kind
from rpl.controllers.yaskawa import hses
from rpl.controllers.yaskawa.commands import Commands, refused
from rpl.controllers.yaskawa.hses import Answer, PacketError, Request
from rpl.controllers.yaskawa.loader import accepts, kept_as
from rpl.errors import UsageError

Address = tuple[str, int]
Keep = Callable[[Request, Address, bool], Answer | None]

# What the controller says when it does not do what a client of the files asks.
_WORDS: Mapping[Why, int] = {
    "missing": 0xE2B3,
    "protected": 0x4020,
    "full": 0x1020,
    "busy": 0x2010,
    "syntax": 0x5110,
    "name": 0x4190,
    "exists": 0xE28C,
    "emergency-stop": 0x2110,
}
_SERVICES: Mapping[int, Kind] = {hses.LIST: "list", hses.READ: "read", hses.WRITE: "write", hses.DELETE: "delete"}
# Names in any encoding come back as they came.
ENCODING = "latin-1"
_MANY = 60_000  # bytes of an answer that has no end, as far as a datagram goes


class Port(asyncio.DatagramProtocol):
    """One of the ports: requests go through the transcript and the faults, answers come from `answer`."""

    def __init__(self, cabinet: Cabinet, interface: str, answer: Keep) -> None:
        self.cabinet = cabinet
        self.interface = interface
        self.answer = answer
        self.transport: asyncio.DatagramTransport | None = None

    def connection_made(self, transport: asyncio.BaseTransport) -> None:
        self.transport = cast("asyncio.DatagramTransport", transport)

    def datagram_received(self, data: bytes, addr: Address) -> None:
        try:
            request = hses.request_of(data)
        except PacketError as error:
            self.cabinet.transcript.add(self.interface, "other", str(error))
            return
        try:
            packet = self.answered(request, addr)
        except DroppedError:
            return
        if packet is not None:
            asyncio.get_running_loop().call_later(self.cabinet.faults.delay_s, self.send, packet, addr)

    def send(self, packet: bytes, addr: Address) -> None:
        if self.transport is not None and not self.transport.is_closing():
            self.transport.sendto(packet, addr)

    def answered(self, request: Request, addr: Address) -> bytes | None:
        """The packet of the answer, as a fault may have spoilt it."""
        faults = self.cabinet.faults
        garbled, endless = faults.comes("garbage"), faults.comes("endless")
        answer = self.answer(request, addr, endless)
        self.cabinet.after()
        if answer is None:
            return None
        if garbled:
            return bytes(range(7, 200))
        packet = answer.packed()
        if endless and answer.is_last:
            return packet + bytes(_MANY)
        if faults.comes("huge", counted=False) and answer.data:
            return packet[:6] + b"\xff\xff" + packet[8:]
        return packet


@dataclass(slots=True)
class Transfer:
    """A file on its way. `data`: all of it when it goes out, what has come when it comes in. `endless`: its last block
    goes out again and again, as if it were not the last."""

    service: int
    name: str
    data: bytes
    endless: bool = False
    block: int = 0


class Files:
    """The port for files. A client has one transfer at a time; a new request ends the one before."""

    def __init__(self, cabinet: Cabinet) -> None:
        self.cabinet = cabinet
        self.transfers: dict[Address, Transfer] = {}

    def answer(self, request: Request, addr: Address, endless: bool) -> Answer | None:
        name = request.data.rstrip(b"\x00").decode(ENCODING, "replace")
        transfer = self.transfers.get(addr)
        kind: Kind = _SERVICES.get(request.service, "other")
        if request.acknowledges:
            name = transfer.name if transfer is not None else "?"
        text = f"{name} block {request.block & ~hses.LAST}" if request.acknowledges else name
        self.cabinet.told("files", kind, text)
        try:
            if request.acknowledges:
                return self._carried_on(request, addr, endless)
            return self._begun(request, addr, name, endless)
        except NotDoneError as why:
            self.transfers.pop(addr, None)
            return refused(request, word_of(why))

    def _begun(self, request: Request, addr: Address, name: str, endless: bool) -> Answer:
        store = self.cabinet.store
        if request.service in (hses.WRITE, hses.DELETE) and self.cabinet.mode != "remote":
            return refused(request, 0xE2B2)
        if request.service == hses.LIST:
            return self._sent(request, addr, Transfer(hses.LIST, name, self._listed(name), endless), 1)
        if request.service == hses.READ:
            data = store.read(name)
            if not data:
                return refused(request, 0xE29C)
            return self._sent(request, addr, Transfer(hses.READ, name, data, endless), 1)
        if request.service == hses.WRITE:
            self.cabinet.may_write(name)
            self.transfers[addr] = Transfer(hses.WRITE, name, b"")
            return Answer(request.division, request.service, request.number, block=0)
        if request.service == hses.DELETE:
            store.delete(name)
            return Answer(request.division, request.service, request.number)
        return Answer(request.division, request.service, request.number, hses.NO_SUCH_COMMAND)

    def _listed(self, pattern: str) -> bytes:
        """Names with the ending that is asked for, one a line; `*` and nothing mean jobs."""
        wanted = pattern.rpartition(".")[2].upper() if "." in pattern else "JBI"
        names = [
            one for one in self.cabinet.store.names() if one.upper().endswith(f".{wanted}") or one.startswith("..")
        ]
        return "".join(f"{one}\r\n" for one in names).encode(ENCODING, "replace")

    def _carried_on(self, request: Request, addr: Address, endless: bool) -> Answer | None:
        transfer = self.transfers.get(addr)
        if transfer is None or transfer.service != request.service:
            return refused(request, 0xE4A2)
        number = request.block & ~hses.LAST
        transfer.endless |= endless
        if transfer.service == hses.WRITE:
            return self._came(request, addr, transfer, number)
        if request.block & hses.LAST:
            self.transfers.pop(addr)
            return None
        return self._sent(request, addr, transfer, number + 1)

    def _came(self, request: Request, addr: Address, transfer: Transfer, number: int) -> Answer:
        if number != transfer.block + 1:
            self.transfers.pop(addr)
            return refused(request, 0xE4A1)
        if not request.data:
            self.transfers.pop(addr)
            return refused(request, 0xE49D)
        transfer.data += request.data
        transfer.block = number
        if request.block & hses.LAST:
            self.transfers.pop(addr)
            self.cabinet.store.write(transfer.name, transfer.data)
        return Answer(request.division, request.service, request.number, block=request.block)

    def _sent(self, request: Request, addr: Address, transfer: Transfer, number: int) -> Answer:
        """A block that goes out. Behind the last one the same comes again and again, when it is to have no end."""
        count = max(1, -(-len(transfer.data) // hses.BLOCK))
        index = min(number, count) - 1
        self.transfers[addr] = transfer
        block = number | hses.LAST if number >= count and not transfer.endless else number
        part = transfer.data[index * hses.BLOCK : (index + 1) * hses.BLOCK]
        return Answer(request.division, request.service, request.number, data=part, block=block)


def word_of(why: NotDoneError) -> int:
    """The controller's number for it; one that the loader has found is in what it said."""
    return int(why.said, 16) if why.why == "syntax" and why.said else _WORDS[why.why]


def _serve_ftp(cabinet: Cabinet, endpoints: Endpoints) -> None:
    """The controller's FTP server, whose jobs are those of the other port."""
    try:
        from rpl.controllers.yaskawa.ftpserver import serve_jobs
    except ModuleNotFoundError as error:
        if not (error.name or "").startswith("pyftpdlib"):
            raise
        raise UsageError("FTP needs the package pyftpdlib: pip install 'robot-rpl[ftp]'") from None
    serve_jobs(cabinet, endpoints)


async def start(cabinet: Cabinet, endpoints: Endpoints) -> None:
    """Open both ports; FTP beside them when a port is named for it (`--port ftp=2121`)."""
    cabinet.store.fold_names()
    cabinet.store.accepts, cabinet.store.rewrite = accepts, kept_as
    files, commands = Files(cabinet), Commands(cabinet)
    if "ftp" in endpoints.wanted:
        _serve_ftp(cabinet, endpoints)
    await endpoints.datagrams("files", 10041, Port(cabinet, "files", files.answer))
    await endpoints.datagrams("robot", 10040, Port(cabinet, "robot", commands.answer))

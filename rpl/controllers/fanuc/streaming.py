"""Stream Motion (UDP 60015) of a virtual controller: a state every 8 ms, answered with where the robot is to be next.

All numbers are big endian; a packet begins with its kind and the version. Layout after fanuc-ucl 2.0.2, whose client
accepts this server. The robot goes at once to where a packet says; limits of its speed are told, not kept.
"""

from __future__ import annotations

import asyncio
import struct
import time
from typing import cast

from rpl.controllers.fanuc.snpx import position_of
from rpl.controllers.fanuc.values import Values
from rpl.controllers.virtual.endpoints import Endpoints
from rpl.controllers.virtual.faults import DroppedError
from rpl.controllers.virtual.transcript import Kind

CYCLE_S = 0.008
VERSION = 2
_START, _COMMAND, _STOP, _LIMITS, _PLACE, _COMMAND_LONG, _VERSION = range(7)
_AHEAD = struct.Struct(">IBBHHBBHHH")
# M: limits of speed, acceleration and jerk of an axis (deg/s, deg/s2, deg/s3).
_LIMIT = {0: 360.0, 1: 1500.0, 2: 9000.0}
_NAMES: dict[int, tuple[Kind, str]] = {
    _START: ("start", "start"),
    _COMMAND: ("start", "position"),
    _STOP: ("stop", "stop"),
    _LIMITS: ("look", "limits"),
    _PLACE: ("look", "position"),
    _COMMAND_LONG: ("start", "position"),
    _VERSION: ("look", "version"),
}


class Streaming(asyncio.DatagramProtocol):
    """One peer at a time."""

    def __init__(self, values: Values) -> None:
        self.values, self.cabinet = values, values.cabinet
        self.transport: asyncio.DatagramTransport | None = None
        self.peer: tuple[str, int] | None = None
        self.sequence, self.received = 0, False

    def connection_made(self, transport: asyncio.BaseTransport) -> None:
        self.transport = cast("asyncio.DatagramTransport", transport)

    def datagram_received(self, data: bytes, addr: tuple[str, int]) -> None:
        if len(data) < 8:
            return
        kind, version = struct.unpack_from(">II", data)
        if kind not in _NAMES:
            return
        about, text = _NAMES[kind]
        cyclic = kind in (_COMMAND, _COMMAND_LONG)
        try:
            self.cabinet.told("streammotion", about, text, counts=not cyclic and about != "look")
        except DroppedError:
            return
        if kind == _START:
            self.peer, self.sequence, self.received = addr, 0, False
        elif kind == _STOP:
            self.peer = None
        elif kind == _VERSION:
            self._send(struct.pack(">II", _VERSION, min(version or VERSION, VERSION)), addr)
        elif kind == _LIMITS:
            self._limits(data, version, addr)
        elif kind == _PLACE:
            self._send(struct.pack(">II", _PLACE, version) + struct.pack(">I", _moment()) + self._place(), addr)
        else:
            self._go(data, kind)

    def _limits(self, data: bytes, version: int, addr: tuple[str, int]) -> None:
        axis, kind = struct.unpack_from(">II", data, 8)
        value = _LIMIT.get(kind, 0.0)
        head = struct.pack(">IIIIII", _LIMITS, version, axis, kind, 2000, 8)
        self._send(head + struct.pack(">40f", *(value,) * 40), addr)

    def _go(self, data: bytes, kind: int) -> None:
        """Joints as they are wanted in this cycle; places in space are not followed."""
        start = 8 + _AHEAD.size + (2 if kind == _COMMAND else 6)
        wanted = struct.unpack_from(">9f" if kind == _COMMAND else ">9d", data, start)
        _, last, *_, joints, _, _, _, _ = _AHEAD.unpack_from(data, 8)
        self.received = True
        model = self.cabinet.model
        if joints and model is not None and self.peer is not None and not self.cabinet.emergency_stop:
            self.cabinet.stand_at(wanted[: len(model.home)])
        if last:
            self.received = False

    def _place(self) -> bytes:
        found = position_of(self.values.place())
        return struct.pack(">9f", *found.xyzwpr, 0.0, 0.0, 0.0) + struct.pack(">9f", *found.joints)

    def _state(self) -> bytes:
        bits = 0b0101 | self.received << 1 | (self.received << 3) | 8 << 4
        head = struct.pack(">II", _START, VERSION)
        self.sequence += 1
        body = struct.pack(">IBBHHHI", self.sequence, bits & 0xFF, 0, 0, 0, 0, _moment())
        return head + body + self._place() + struct.pack(">9f", *(0.0,) * 9)

    async def run(self) -> None:
        """Tell the state every cycle, on absolute moments, while somebody listens."""
        loop = asyncio.get_running_loop()
        due = loop.time()
        while True:
            if self.peer is not None:
                self._send(self._state(), self.peer)
            due = max(due + CYCLE_S, loop.time())
            await asyncio.sleep(due - loop.time())

    def _send(self, data: bytes, addr: tuple[str, int]) -> None:
        if self.transport is not None:
            self.transport.sendto(data, addr)


def _moment() -> int:
    return int(time.monotonic() * 1000.0) % 2**31


async def start_streaming(endpoints: Endpoints, values: Values) -> None:
    streaming = Streaming(values)
    await endpoints.datagrams("streammotion", 60015, streaming)
    endpoints.beside(streaming.run())

"""Externally guided motion of a virtual controller: what the robot sends by UDP in every cycle, and takes back.

The messages are protocol buffers; the few that are needed are written here by hand. Field numbers are those of ABB's
`egm.proto` as it is part of abb-robot-client 0.4.0 (`EgmRobot`, `EgmSensor` and what they hold).
"""

from __future__ import annotations

import asyncio
import struct
import time
from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING

from rpl.controllers.virtual.store import NotDoneError

if TYPE_CHECKING:
    from rpl.controllers.virtual.cabinet import Cabinet
    from rpl.controllers.virtual.endpoints import Endpoints

USUAL, CYCLE_S = 6510, 0.004
_VARINT, _FIXED64, _BYTES, _FIXED32 = 0, 1, 2, 5
_DATA = 2  # EgmHeader.MessageType.MSGTYPE_DATA

Fields = list[tuple[int, int | float | bytes]]


def varint(value: int) -> bytes:
    """A whole number from 0 on, seven bits a byte, the lowest first."""
    parts = bytearray()
    while value > 0x7F:
        parts.append(value & 0x7F | 0x80)
        value >>= 7
    parts.append(value)
    return bytes(parts)


def message(*fields: tuple[int, int | float | bytes]) -> bytes:
    """Fields by number: whole numbers, doubles, and messages that are part of this one."""
    parts = []
    for number, value in fields:
        if isinstance(value, float):
            parts.append(varint(number << 3 | _FIXED64) + struct.pack("<d", value))
        elif isinstance(value, int):
            parts.append(varint(number << 3 | _VARINT) + varint(value))
        else:
            parts.append(varint(number << 3 | _BYTES) + varint(len(value)) + value)
    return b"".join(parts)


def fields(data: bytes) -> Fields:
    """The fields of a message. Raises ValueError when it is none."""
    return list(_fields(data))


def _fields(data: bytes) -> Iterator[tuple[int, int | float | bytes]]:
    place = 0
    while place < len(data):
        key, place = _read_varint(data, place)
        number, kind = key >> 3, key & 7
        if kind == _VARINT:
            value, place = _read_varint(data, place)
            yield number, value
            continue
        if kind == _BYTES:
            size, place = _read_varint(data, place)
        elif kind in (_FIXED64, _FIXED32):
            size = 8 if kind == _FIXED64 else 4
        else:
            raise ValueError(f"a field of kind {kind}")
        part = data[place : place + size]
        if len(part) < size:
            raise ValueError("the message ends in the middle")
        place += size
        yield number, part if kind == _BYTES else struct.unpack("<d" if kind == _FIXED64 else "<f", part)[0]


def _read_varint(data: bytes, place: int) -> tuple[int, int]:
    value = shift = 0
    while place < len(data) and shift < 64:
        byte = data[place]
        value |= (byte & 0x7F) << shift
        place, shift = place + 1, shift + 7
        if byte < 0x80:
            return value, place
    raise ValueError("a number that does not end")


def _part(of: Fields, number: int) -> Fields:
    """The fields of a message that is part of another; none: empty."""
    return next((fields(value) for key, value in of if key == number and isinstance(value, bytes)), [])


def _doubles(of: Fields, number: int) -> tuple[float, ...]:
    """Repeated doubles, each by itself or packed."""
    found: list[float] = []
    for key, value in of:
        if key == number and isinstance(value, float):
            found.append(value)
        elif key == number and isinstance(value, bytes):
            found += struct.unpack(f"<{len(value) // 8}d", value[: len(value) // 8 * 8])
    return tuple(found)


def wanted_joints(data: bytes) -> tuple[float, ...]:
    """The joints (degrees) that an EgmSensor asks for: planned (2), joints (1), joints (1). Raises ValueError."""
    return _doubles(_part(_part(fields(data), 2), 1), 1)


def robot_message(number: int, time_ms: int, cabinet: Cabinet) -> bytes:
    """An EgmRobot: header (1), feedBack (2), planned (3), motorState (4), mciState (5), mciConvergenceMet (6),
    rapidExecState (8)."""
    from rpl.emulator.rotations import matrix_to_quaternion

    joints = (cabinet.joints or ())[:6]
    standing: list[tuple[int, int | float | bytes]] = [(1, _joints(joints))]
    flange = cabinet.flange
    if flange is not None:
        place = message(*((axis, float(value)) for axis, value in enumerate(flange[:3, 3], 1)))
        turn = message(*((part, float(value)) for part, value in enumerate(matrix_to_quaternion(flange[:3, :3]), 1)))
        standing.append((2, message((1, place), (2, turn))))
    moment = message((1, time_ms // 1000), (2, time_ms % 1000 * 1000))
    whole = message(*standing, (4, moment))
    return message(
        (1, message((1, number), (2, time_ms % 2**32), (3, _DATA))),
        (2, whole),
        (3, whole),
        (4, message((1, 1 if cabinet.motors_on else 2))),
        (5, message((1, 3 if cabinet.motors_on else 2))),
        (6, 1),
        (8, message((1, 2 if cabinet.phase == "running" else 1))),
    )


def _joints(values: Sequence[float]) -> bytes:
    return message(*((1, float(value)) for value in values))


class _Guided(asyncio.DatagramProtocol):
    """What comes back from the computer that guides the robot."""

    def __init__(self, cabinet: Cabinet) -> None:
        self.cabinet = cabinet

    def datagram_received(self, data: bytes, address: object) -> None:
        try:
            joints = wanted_joints(data)
        except ValueError:
            return  # not one of these messages: a robot passes over it
        self.cabinet.told("egm", "start", f"joints {joints}", counts=False)
        if self.cabinet.model is not None and len(joints) == self.cabinet.model.axes:
            try:
                self.cabinet.stand_at(joints)
            except NotDoneError:
                return  # the drives are off

    def error_received(self, error: Exception) -> None:
        """Nobody listens yet."""


async def start(cabinet: Cabinet, endpoints: Endpoints) -> None:
    """Send to the port that is asked for with `--port egm=N`; with `--any-port` and none, nothing is sent."""
    port = endpoints.port("egm", USUAL)
    if port == 0:
        return
    loop = asyncio.get_running_loop()
    transport, _ = await loop.create_datagram_endpoint(lambda: _Guided(cabinet), remote_addr=(endpoints.host, port))
    endpoints.opened("egm", port, transport.close)
    endpoints.beside(_send(cabinet, transport))


async def _send(cabinet: Cabinet, transport: asyncio.DatagramTransport) -> None:
    """On absolute moments."""
    loop = asyncio.get_running_loop()
    due = loop.time()
    number = 0
    while True:
        number += 1
        transport.sendto(robot_message(number, int(time.time() * 1000), cabinet))
        due = max(due + CYCLE_S, loop.time())
        await asyncio.sleep(due - loop.time())

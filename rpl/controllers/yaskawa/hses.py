"""Packets of the High-Speed Ethernet Server (UDP, little endian), both ways.

Source: manual 160766-1CD as moto-hses (MIT, `docs/specs/hses-protocol.md`) and hsinkoyu/fs100 (MIT) give it. A packet
is a head of 32 bytes and up to 479 bytes of data.
"""

from __future__ import annotations

import struct
from collections.abc import Iterator
from dataclasses import dataclass

MOST_DATA = 479
# Data of one block of a file: what fs100 sends, and what is surely taken.
BLOCK = 400
LAST = 0x8000_0000
ROBOT, FILES = 1, 2

# Services of files.
DELETE, WRITE, READ, LIST = 0x09, 0x15, 0x16, 0x32
# Services of commands: one element or all of them, read or written; several of one kind at once.
GET_ALL, SET_ALL, GET_ONE, SET_ONE, GET_MANY, SET_MANY = 0x01, 0x02, 0x0E, 0x10, 0x33, 0x34

# Commands of the robot's port.
ALARM, STATUS, JOB, AXES, POSITION = 0x70, 0x72, 0x73, 0x74, 0x75
SIGNALS, REGISTER, BYTE, INTEGER, DOUBLE, REAL, TEXT, PLACE = 0x78, 0x79, 0x7A, 0x7B, 0x7C, 0x7D, 0x7E, 0x7F
RESET, SERVO, CYCLE, SHOW, START, SELECT, TIME, SYSTEM = 0x82, 0x83, 0x84, 0x85, 0x86, 0x87, 0x88, 0x89
MOVE, MOVE_PULSES = 0x8A, 0x8B
MANY_SIGNALS, MANY_TEXTS = 0x300, 0x306

REFUSED = 0x1F
NO_SUCH_COMMAND, NO_SUCH_ELEMENT, NO_SUCH_INSTANCE = 0x08, 0x09, 0x28

# What the words of an error mean (manual, added status codes).
ERRORS = {
    0x1010: "command error",
    0x1012: "an operand is out of range",
    0x1020: "the disk is full",
    0x2010: "the manipulator is operating",
    0x2020: "on hold by the pendant",
    0x2040: "on external hold",
    0x2050: "on hold by command",
    0x2060: "an alarm or error is there",
    0x2070: "the servos are off",
    0x2080: "wrong mode",
    0x2090: "another function accesses the file",
    0x2100: "command remote is not set",
    0x2110: "this data cannot be accessed",
    0x2120: "this data cannot be loaded",
    0x2130: "it is being edited",
    0x3010: "turn the servos on",
    0x3450: "the servos cannot be turned on",
    0x4010: "not enough memory for jobs",
    0x4012: "not enough memory for positions",
    0x4020: "editing of the job is prohibited",
    0x4030: "a job of this name exists",
    0x4040: "there is no such job",
    0x4060: "set an execution job",
    0x4190: "the name of the job has a character that is not allowed",
    0x5110: "syntax of an instruction",
    0x5120: "wrong position data",
    0x5130: "no NOP or no END",
    0x5170: "wrong format",
    0x5310: "syntax outside instructions",
    0x5390: "wrong data of the job's head",
    0xA000: "undefined command",
    0xA001: "wrong instance",
    0xA002: "wrong attribute",
    0xB001: "the position variable is not defined",
    0xB003: "wrong size of the data",
    0xB004: "the data is out of range",
    0xB005: "the data is not defined",
    0xD8FA: "the transmission is taken by another",
    0xE28C: "the file cannot be overwritten",
    0xE29C: "the file does not exist or is empty",
    0xE2A7: "the file is not in the list",
    0xE2AF: "the file cannot be deleted",
    0xE2B2: "remote is off",
    0xE2B3: "file not found",
    0xE2B4: "the path is too long",
    0xE444: "busy with another command",
    0xE49D: "no data",
    0xE4A1: "wrong number of a block",
    0xFFF6: "busy",
    0xFFFE: "the mode changed, the communication is over",
}
NOT_THERE = frozenset((0x4040, 0xE29C, 0xE2A7, 0xE2B3))

_HEAD = struct.Struct("<4sHHBBBBI8s")
_REQUEST = struct.Struct("<HHBBH")
_ANSWER = struct.Struct("<BBBBHH")
_MARK, _SIZE, _KIND, _FILL = b"YERC", 0x20, 3, b"99999999"


class PacketError(ValueError):
    """No packet of this protocol."""


@dataclass(frozen=True, slots=True)
class Request:
    """A request, or with `acknowledges` the acknowledgement of a block. `division`: ROBOT or FILES."""

    division: int
    service: int
    number: int = 0
    command: int = 0
    instance: int = 0
    attribute: int = 0
    data: bytes = b""
    block: int = 0
    acknowledges: bool = False

    def packed(self) -> bytes:
        head = _HEAD.pack(
            _MARK, _SIZE, len(self.data), _KIND, self.division, self.acknowledges, self.number, self.block, _FILL
        )
        return head + _REQUEST.pack(self.command, self.instance, self.attribute, self.service, 0) + self.data


@dataclass(frozen=True, slots=True)
class Answer:
    """An answer. `status`: 0 when it went well; `added`: the word of the error."""

    division: int
    service: int
    number: int = 0
    status: int = 0
    added: int = 0
    data: bytes = b""
    block: int = LAST

    @property
    def is_last(self) -> bool:
        return bool(self.block & LAST)

    @property
    def meaning(self) -> str:
        """What went wrong, with the controller's own number."""
        if self.status == REFUSED:
            return f"{ERRORS.get(self.added, 'error')} ({self.added:04X})"
        known = {
            NO_SUCH_COMMAND: "no such command",
            NO_SUCH_ELEMENT: "no such element",
            NO_SUCH_INSTANCE: "no such data",
        }
        return f"{known.get(self.status, 'error')} (status {self.status:02X})"

    def packed(self) -> bytes:
        head = _HEAD.pack(_MARK, _SIZE, len(self.data), _KIND, self.division, 1, self.number, self.block, _FILL)
        words = 1 if self.status == REFUSED else 0
        return head + _ANSWER.pack(self.service | 0x80, self.status, words, 0, self.added, 0) + self.data


def _checked(packet: bytes) -> tuple[int, int, int, int, bytes]:
    """division, ack, number, block and data."""
    if len(packet) < _SIZE:
        raise PacketError(f"{len(packet)} bytes are no packet")
    mark, size, count, _, division, ack, number, block, _ = _HEAD.unpack_from(packet)
    if mark != _MARK or size != _SIZE:
        raise PacketError("the packet does not begin as one of this protocol")
    data = packet[_SIZE:]
    if count > MOST_DATA or len(data) != count:
        raise PacketError(f"the packet says that it brings {count} bytes, and brings {len(data)}")
    return division, ack, number, block, data


def request_of(packet: bytes) -> Request:
    """Raises PacketError."""
    division, ack, number, block, data = _checked(packet)
    command, instance, attribute, service, _ = _REQUEST.unpack_from(packet, _HEAD.size)
    return Request(division, service, number, command, instance, attribute, data, block, bool(ack))


def answer_of(packet: bytes) -> Answer:
    """Raises PacketError."""
    division, _, number, block, data = _checked(packet)
    service, status, _, _, added, _ = _ANSWER.unpack_from(packet, _HEAD.size)
    return Answer(division, service & 0x7F, number, status, added, data, block)


def blocks_of(data: bytes, size: int = BLOCK) -> Iterator[tuple[int, bytes]]:
    """The number and the data of each block of a file; the last one is marked."""
    count = max(1, -(-len(data) // size))
    for index in range(count):
        yield (index + 1) | (LAST if index + 1 == count else 0), data[index * size : (index + 1) * size]

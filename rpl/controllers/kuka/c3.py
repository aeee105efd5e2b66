"""Messages of C3 Bridge Interface and KukavarProxy (TCP, numbers big endian, wide texts UTF-16 little endian).

A message is a tag (2 bytes), how much follows (2), its type (1), what it says; an answer ends with an error code (2)
and whether it went well (1). Source: C3 Bridge Interface, Application Protocol Specification 1.5, and its sources.
"""

from __future__ import annotations

import struct
from collections.abc import Sequence
from dataclasses import dataclass

READ_ASCII, WRITE_ASCII, READ, WRITE, READ_MANY, WRITE_MANY = 0, 1, 4, 5, 6, 7
PROGRAM, MOTION, KEYS, PROXY_INFO, PROXY_FEATURES = 10, 11, 12, 13, 14
SET_ATTRIBUTES, LIST, CREATE, DELETE, COPY, MOVE, PROPERTIES, FULL_NAME, KRC_NAME = range(20, 29)
WRITE_FILE, READ_FILE = 29, 30
CONFIRM_ALL = 63

# Command codes of PROGRAM.
PROGRAM_RESET, PROGRAM_START, PROGRAM_STOP, PROGRAM_CANCEL, PROGRAM_SELECT, PROGRAM_RUN = range(1, 7)
# Operations of WRITE_FILE and READ_FILE.
BEGIN, DATA, GET_SIZE, END = 1, 2, 3, 4
# Flags of copying and moving, of listing; types of items and parts of a module.
OVERWRITE = 64
RECURSIVE, EXPAND = 1, 2
ITEM_FILES = 8 | 16 | 32 | 64
ATTRIBUTE_READ_ONLY = 1

GENERAL, SUCCESS, ACCESS, ARGUMENT, MEMORY, UNEXPECTED, NOT_IMPLEMENTED, PROTOCOL, LONG_ANSWER = (
    0,
    1,
    2,
    3,
    4,
    6,
    7,
    9,
    10,
)
ERRORS = {
    GENERAL: "unspecified error",
    ACCESS: "access denied",
    ARGUMENT: "a wrong argument",
    MEMORY: "not enough memory",
    5: "wrong pointer",
    UNEXPECTED: "unexpected failure",
    NOT_IMPLEMENTED: "not implemented",
    8: "the controller's interface is not there",
    PROTOCOL: "the message was not understood",
    LONG_ANSWER: "the answer is too long for one message",
}

HEAD = struct.Struct(">HHB")
_FOOT = struct.Struct(">HB")
LONGEST = 2**16 - 1
# Bytes of a file in one message: what C3 Bridge gives at most.
CHUNK = 64512


class MessageError(ValueError):
    """No message of this protocol."""


@dataclass(frozen=True, slots=True)
class Message:
    """A request, or what an answer says before its end."""

    tag: int
    kind: int
    said: bytes = b""

    def packed(self) -> bytes:
        if len(self.said) > LONGEST - 1:
            raise MessageError(f"{len(self.said)} bytes are too long for one message")
        return HEAD.pack(self.tag, len(self.said) + 1, self.kind) + self.said


def answer(tag: int, kind: int, said: bytes, code: int = SUCCESS) -> bytes:
    """The bytes of an answer."""
    return Message(tag, kind, said + _FOOT.pack(code, code == SUCCESS)).packed()


def parts_of(said: bytes) -> tuple[bytes, int, bool]:
    """What an answer says, its error code, and whether it went well."""
    if len(said) < _FOOT.size:
        raise MessageError(f"an answer of {len(said)} bytes has no end")
    code, good = _FOOT.unpack_from(said, len(said) - _FOOT.size)
    if good > 1:
        raise MessageError("an answer does not say whether it went well")
    return said[: -_FOOT.size], code, bool(good)


def narrow(text: bytes) -> bytes:
    """A text with its length before it."""
    return struct.pack(">H", len(text)) + text


def wide(text: str) -> bytes:
    """A wide text with its length in characters before it."""
    spelled = text.encode("utf-16-le")
    return struct.pack(">H", len(spelled) // 2) + spelled


def number(value: int) -> bytes:
    """A whole number of 32 bits."""
    return struct.pack(">I", value & 0xFFFF_FFFF)


class Reader:
    """Takes a message apart from its beginning. Raises MessageError when it is too short."""

    def __init__(self, said: bytes) -> None:
        self.said = said
        self.place = 0

    def take(self, count: int) -> bytes:
        if self.place + count > len(self.said):
            raise MessageError("the message ends too early")
        part = self.said[self.place : self.place + count]
        self.place += count
        return part

    def byte(self) -> int:
        return self.take(1)[0]

    def short(self) -> int:
        return int.from_bytes(self.take(2), "big")

    def number(self) -> int:
        return int.from_bytes(self.take(4), "big")

    def narrow(self) -> bytes:
        return self.take(self.short())

    def wide(self) -> str:
        return self.take(2 * self.short()).decode("utf-16-le", "replace")

    def texts(self) -> Sequence[str]:
        """A count and as many wide texts."""
        return [self.wide() for _ in range(self.short())]

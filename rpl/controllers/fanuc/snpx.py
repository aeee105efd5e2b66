"""SNPX, the protocol of operator panels (TCP 60008): packets, windows, and a client of its own.

All numbers are little endian. A message is a head of 42 bytes, a body of 14 and as many further bytes as the head
says at offset 4; the kind stands at offset 31: C0 and 80 are requests (short, long), D4 and 94 answers. Bits and
words are in segments, which are named from the panel's side (DO of the robot are its inputs). `SETASG address size
name multiply`, written as a text, lays a window of words over anything that has a name: R[1], PR[1], POS[0],
PRG[1], $MCR.$GENOVERRIDE. Layout after fanuc-ucl 2.0.2, whose client accepts the server of this folder, and public
readers of controllers in use.
"""

from __future__ import annotations

import socket
import struct
import time
from collections.abc import Iterator, Sequence
from contextlib import ExitStack
from dataclasses import dataclass

from rpl.controllers.link import GarbledError, LostError, RefusedError

INIT = bytes(56)
INIT_ACK = bytes([1, 0, 0, 0, 0, 0, 0, 0, 1]) + bytes(47)
READ, WRITE, MAGIC = 0x04, 0x07, 0x4F
SHORT, LONG, ANSWER, LONG_ANSWER, REFUSED = 0xC0, 0x80, 0xD4, 0x94, 0xD1
REGISTERS, OUTPUTS, INPUTS, ANALOG_IN, ANALOG_OUT, COMMAND = 0x08, 0x46, 0x48, 0x0A, 0x0C, 0x38
_HEAD = 42
_SMALLEST = 56
_INLINE = 6
LONGEST = 2048  # bytes of one message
_BOX = 0x0E10


@dataclass(frozen=True, slots=True)
class Request:
    """service READ, WRITE or MAGIC; `index` from 0; `size` in bits, words or characters."""

    sequence: int
    service: int
    segment: int
    index: int
    size: int
    data: bytes = b""


def message_of(request: Request) -> bytes:
    """The request as bytes: data of more than six go behind the body."""
    writing = 0x100 if request.service in (WRITE, MAGIC) else 0x200
    long = len(request.data) > _INLINE
    text = request.data if long else b""
    packet = 8 if request.service == MAGIC else 2
    head = struct.pack("<HHHHIIIIH3sBBBIIBB", packet, request.sequence, len(text), 0, writing, 0, writing, 0, 0,
                       bytes(3), 0, request.sequence & 0xFF, LONG if long else SHORT, 0, _BOX, 1, 1)  # fmt: skip
    what = struct.pack("<BBHH", request.service, request.segment, request.index, request.size)
    if long:
        return head + bytes(6) + b"\x01\x01" + what + text
    return head + what + request.data.ljust(_INLINE, b"\x00") + bytes(2)


def request_of(data: bytes) -> Request:
    """The request in a message. Raises ValueError."""
    sequence, kind = struct.unpack_from("<H", data, 2)[0], data[31]
    if kind == SHORT:
        service, segment, index, size = struct.unpack_from("<BBHH", data, _HEAD)
        return Request(sequence, service, segment, index, size, data[48:54])
    if kind == LONG:
        service, segment, index, size = struct.unpack_from("<BBHH", data, _HEAD + 8)
        return Request(sequence, service, segment, index, size, data[_SMALLEST:])
    raise ValueError(f"no request: kind {kind:#x}")


def answer(sequence: int, data: bytes = b"") -> bytes:
    """An answer that all is well, with what was asked for."""
    long = len(data) > _INLINE
    text = data if long else b""
    head = struct.pack("<HHHHIIIIH3sBBBIIBB", 3, sequence, len(text), 0, 0x100, 0, 0x100, 0, 0, bytes(3), 0,
                       sequence & 0xFF, LONG_ANSWER if long else ANSWER, _BOX, 0x3A30, 1, 1)  # fmt: skip
    status = b"\x01\xff\x04\x00\x00\x7c\x21"
    if long:
        return head + bytes(6) + b"\x01\x01" + status[1:3] + bytes(2) + status[-2:] + text
    return head + bytes(2) + data.ljust(_INLINE, b"\x00") + status[:4] + status[-2:]


def refusal(sequence: int) -> bytes:
    """An answer that says no."""
    data = bytearray(answer(sequence))
    data[31] = REFUSED
    return bytes(data)


def length_of(head: bytes) -> int:
    """How many bytes a message has of which these 42 are the head."""
    return _SMALLEST + int(struct.unpack_from("<H", head, 4)[0])


# ---- what stands in windows

POSITION_WORDS, TEXT_WORDS, TASK_WORDS, NUMBER_WORDS = 50, 40, 18, 2


@dataclass(frozen=True, slots=True)
class Place:
    """Where the robot is: X Y Z (mm) W P R (degrees), its joints, and its posture: 1 for flipped, left, up and front,
    then the turns of joints 4, 5 and 6."""

    xyzwpr: tuple[float, ...]
    joints: tuple[float, ...]
    posture: tuple[int, ...] = (0, 0, 1, 1, 0, 0, 0)


_POSE_VALID, _JOINTS_VALID = 50, 88


def position_bytes(place: Place, pose: bool = True, joints: bool = True) -> bytes:
    """100 bytes: the pose, its configuration, whether it is valid; the joints, whether they are; frame and tool."""
    first = struct.pack("<9f", *place.xyzwpr, 0.0, 0.0, 0.0) + struct.pack("<7h", *place.posture) + bytes([pose] * 2)
    axes = (*place.joints, *(0.0,) * 9)[:9]
    return first + struct.pack("<9f", *axes) + bytes([joints] * 2) + bytes(10)


def has_pose(data: bytes) -> bool:
    return any(data[_POSE_VALID : _POSE_VALID + 2])


def has_joints(data: bytes) -> bool:
    return any(data[_JOINTS_VALID : _JOINTS_VALID + 2])


def position_of(data: bytes) -> Place:
    if len(data) < 2 * POSITION_WORDS:
        raise GarbledError("a position has 100 bytes")
    posture = struct.unpack_from("<7h", data, 36)
    return Place(struct.unpack_from("<6f", data, 0), struct.unpack_from("<9f", data, 52), posture)


def task_bytes(name: str, line: int, state: int, parent: str = "") -> bytes:
    """36 bytes; state 0 ended, 1 paused, 2 running."""
    return struct.pack("<16shH16s", name.encode("latin-1")[:16], line, state, parent.encode("latin-1")[:16])


def text_of(data: bytes) -> str:
    return data.split(b"\x00", 1)[0].decode("latin-1")


class SnpxClient:
    """One connection; reads only, but for the windows that it lays over what it wants to read."""

    def __init__(self, host: str, port: int, patience_s: float) -> None:
        self.where, self.patience_s, self._sequence = f"{host}:{port}", patience_s, 0
        self._next_word = 1
        try:
            self._socket = socket.create_connection((host, port), patience_s)
        except OSError as error:
            raise LostError(f"{self.where}: {error.strerror or error}") from None
        with ExitStack() as failing:
            failing.callback(self._socket.close)
            self._send(INIT)
            if self._message(time.monotonic() + patience_s) != INIT_ACK:
                raise GarbledError(f"{self.where}: this is no panel interface of FANUC")
            self.ask(MAGIC, 1, 0, 0)
            self.command("CLRASG")
            failing.pop_all()

    def ask(self, service: int, segment: int, index: int, size: int, data: bytes = b"") -> bytes:
        """The data of the answer. Raises RefusedError."""
        self._sequence = self._sequence % 255 + 1
        self._send(message_of(Request(self._sequence, service, segment, index, size, data)))
        found = self._message(time.monotonic() + self.patience_s)
        if found[2] != self._sequence:
            raise GarbledError(f"{self.where}: this answers another request")
        if found[31] == REFUSED:
            raise RefusedError(f"{self.where}: refused")
        if found[31] not in (ANSWER, LONG_ANSWER):
            raise GarbledError(f"{self.where}: no answer: kind {found[31]:#x}")
        return found[_SMALLEST:] if found[31] == LONG_ANSWER else found[44:50]

    def command(self, text: str) -> None:
        data = text.encode("latin-1")
        self.ask(WRITE, COMMAND, 0, len(data), data)

    def window(self, name: str, words: int, multiply: str = "1") -> int:
        """Lay a window over what has this name; the word that it begins at."""
        start = self._next_word
        self._next_word += words
        self.command(f"SETASG {start} {words} {name} {multiply}")
        return start

    def words(self, start: int, count: int) -> bytes:
        data = self.ask(READ, REGISTERS, start - 1, count)
        if len(data) < 2 * count:
            raise GarbledError(f"{self.where}: {len(data)} bytes of {2 * count} came")
        return data[: 2 * count]

    def bits(self, segment: int, first: int, count: int) -> list[bool]:
        """Signals from the number `first` on."""
        begin = (first - 1) // 8 * 8
        data = self.ask(READ, segment, begin, (first - 1 + count - begin + 7) // 8 * 8)
        return [
            bool(data[place // 8] >> place % 8 & 1) for place in range(first - 1 - begin, first - 1 - begin + count)
        ]

    def close(self) -> None:
        self._socket.close()

    def _send(self, data: bytes) -> None:
        try:
            self._socket.settimeout(self.patience_s)
            self._socket.sendall(data)
        except OSError as error:
            raise LostError(f"{self.where}: {error.strerror or error}") from None

    def _message(self, deadline: float) -> bytes:
        head = self._exactly(_HEAD, deadline)
        length = length_of(head)
        if length > LONGEST:
            raise GarbledError(f"{self.where}: an answer of {length} bytes")
        return head + self._exactly(length - _HEAD, deadline)

    def _exactly(self, count: int, deadline: float) -> bytes:
        data = b""
        try:
            while len(data) < count:
                left = deadline - time.monotonic()
                if left <= 0.0:
                    raise TimeoutError
                self._socket.settimeout(left)
                piece = self._socket.recv(count - len(data))
                if not piece:
                    raise LostError(f"{self.where}: the controller closed the connection")
                data += piece
        except OSError as error:
            reason = f"no answer within {self.patience_s:g} s" if isinstance(error, TimeoutError) else error
            raise LostError(f"{self.where}: {reason}") from None
        return data


def packed_bits(bits: Sequence[bool]) -> bytes:
    """From the lowest bit of the first byte upwards."""
    return bytes(_bytes_of(bits))


def _bytes_of(bits: Sequence[bool]) -> Iterator[int]:
    for start in range(0, len(bits), 8):
        yield sum(1 << place for place, bit in enumerate(bits[start : start + 8]) if bit)

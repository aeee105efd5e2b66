"""The panel interface (SNPX) of a virtual controller: windows over registers, positions, tasks and system variables."""

from __future__ import annotations

import asyncio
import re
import struct
from dataclasses import dataclass, field
from pathlib import PurePosixPath

from rpl import registry
from rpl.controllers.fanuc import snpx
from rpl.controllers.fanuc.snpx import Request
from rpl.controllers.virtual.cabinet import Cabinet
from rpl.controllers.virtual.store import NotDoneError
from rpl.controllers.virtual.transcript import Kind
from rpl.errors import UsageError

_ASSIGN = re.compile(r"SETASG\s+(\d+)\s+(\d+)\s+(.+?)\s+(-?\d*\.?\d+)\s*$", re.IGNORECASE)
_INDEXED = re.compile(r"(R|SR|PR|POS|PRG)\[\s*(?:G1\s*:)?\s*([A-Z]*)(\d+)\s*\]$", re.IGNORECASE)
_BITS = {snpx.OUTPUTS: "DO", snpx.INPUTS: "DI"}
_GROUPS = {snpx.ANALOG_IN: "GO", snpx.ANALOG_OUT: "GI"}
_WORDS = {"SR": snpx.TEXT_WORDS, "PR": snpx.POSITION_WORDS, "POS": snpx.POSITION_WORDS, "PRG": snpx.TASK_WORDS}
_STATES = {"stopped": 0, "paused": 1, "running": 2}
_MOST_WORDS = 10_000


@dataclass
class Values:
    """What the controller keeps besides its programs: registers, system variables."""

    cabinet: Cabinet
    numbers: dict[int, float] = field(default_factory=dict)
    texts: dict[int, str] = field(default_factory=dict)
    places: dict[int, bytes] = field(default_factory=dict)
    system: dict[str, float] = field(default_factory=lambda: {"$MCR.$GENOVERRIDE": 100.0})

    def number(self, index: int) -> float:
        """R[index]: that of the selected program where it has one."""
        try:
            found = self.cabinet.variable(f"R{index}")
        except (NotDoneError, UsageError):
            found = None
        return float(found) if isinstance(found, int | float) else self.numbers.get(index, 0.0)

    def place(self) -> bytes:
        joints, flange = self.cabinet.joints, self.cabinet.flange
        if joints is None or flange is None:
            return bytes(2 * snpx.POSITION_WORDS)
        from rpl.emulator.rotations import matrix_to_xyz_fixed

        pose = (*map(float, flange[:3, 3]), *map(float, matrix_to_xyz_fixed(flange[:3, :3])))
        return snpx.position_bytes(snpx.Place(pose, joints, self._posture(joints)))

    def _posture(self, joints: tuple[float, ...]) -> tuple[int, ...]:
        """The posture as the pendant shows it. M: joint 5 has no turns."""
        import numpy as np

        notation = registry.dialect(self.cabinet.dialect).notation
        if notation is None or self.cabinet.model is None:
            return (0, 0, 1, 1, 0, 0, 0)
        flags = notation().encode(self.cabinet.model, np.array(joints))
        flip, down, back = (flags.get(name, 0) for name in ("flip", "down", "back"))
        return (flip, 0, 1 - down, 1 - back, flags.get("t4", 0), 0, flags.get("t6", 0))

    def task(self) -> bytes:
        name = PurePosixPath(self.cabinet.program).stem.upper()
        return snpx.task_bytes(name, self.cabinet.line, _STATES[self.cabinet.phase])


@dataclass(frozen=True, slots=True)
class Window:
    """`start` from 1, in words; `name` as SETASG has it."""

    start: int
    words: int
    name: str
    multiply: float


class Panel:
    """One connection: the windows are its own."""

    def __init__(self, values: Values) -> None:
        self.values, self.cabinet = values, values.cabinet
        self.windows: list[Window] = []

    async def serve(self, reader: asyncio.StreamReader, writer: asyncio.StreamWriter) -> None:
        self.cabinet.told("snpx", "connect", "panel", counts=False)
        while True:
            head = await reader.readexactly(42)
            length = snpx.length_of(head)
            if length > snpx.LONGEST:
                return
            data = head + await reader.readexactly(length - 42)
            writer.write(snpx.INIT_ACK if data == snpx.INIT else await self._answered(data))
            await writer.drain()

    async def _answered(self, data: bytes) -> bytes:
        try:
            request = snpx.request_of(data)
        except ValueError:
            return snpx.refusal(struct.unpack_from("<H", data, 2)[0])
        kind, text = _described(request)
        self.cabinet.told("snpx", kind, text, counts=kind != "look")
        if self.cabinet.faults.delay_s:
            await asyncio.sleep(self.cabinet.faults.delay_s)
        try:
            found = snpx.answer(request.sequence, self._done(request))
        except (NotDoneError, ValueError, struct.error):
            found = snpx.refusal(request.sequence)
        if kind != "look":
            self.cabinet.after()
        return found

    def _done(self, request: Request) -> bytes:
        if request.service == snpx.MAGIC:
            return b""
        if request.segment == snpx.COMMAND and request.service == snpx.WRITE:
            for command in request.data[: request.size].decode("latin-1").split("\r"):
                self._command(command.strip())
            return b""
        if request.segment in _BITS:
            return self._bits(request, _BITS[request.segment])
        if request.segment in _GROUPS:
            return self._groups(request, _GROUPS[request.segment])
        if request.segment == snpx.REGISTERS:
            return self._words(request)
        raise NotDoneError("name", f"segment {request.segment:#x}")

    def _command(self, text: str) -> None:
        if text.upper() == "CLRASG":
            self.windows.clear()
        elif found := _ASSIGN.match(text):
            start, words = int(found[1]), int(found[2])
            if not 0 < words <= _MOST_WORDS or not 0 < start <= _MOST_WORDS:
                raise NotDoneError("name", text)
            self.windows.append(Window(start, words, found[3], float(found[4])))
        elif text.upper() == "CLRALM":
            self.cabinet.messages.clear()
        else:
            raise NotDoneError("name", text)

    def _bits(self, request: Request, name: str) -> bytes:
        if request.service == snpx.READ:  # whole bytes are given
            begin, end = request.index // 8 * 8, -(-(request.index + request.size) // 8) * 8
            numbers = range(begin + 1, end + 1)
            return snpx.packed_bits([bool(self.cabinet.signal(f"{name}[{number}]")) for number in numbers])
        numbers = range(request.index + 1, request.index + 1 + request.size)
        for place, number in enumerate(numbers, request.index % 8):
            self.cabinet.set_signal(f"{name}[{number}]", bool(request.data[place // 8] >> place % 8 & 1))
        return b""

    def _groups(self, request: Request, name: str) -> bytes:
        numbers = range(request.index + 1, request.index + 1 + request.size)
        if request.service == snpx.READ:
            found = [self.cabinet.signal(f"{name}[{number}]") for number in numbers]
            return struct.pack(f"<{request.size}h", *(int(one) if isinstance(one, int) else 0 for one in found))
        for number, value in zip(numbers, struct.unpack_from(f"<{request.size}h", request.data), strict=True):
            self.cabinet.set_signal(f"{name}[{number}]", value)
        return b""

    def _words(self, request: Request) -> bytes:
        """Words inside of a window; without any, word n is R[n] as a whole number."""
        first, last = request.index + 1, request.index + request.size
        if request.size > _MOST_WORDS:
            raise NotDoneError("name", "too many words")
        for window in self.windows:
            if window.start <= first and last < window.start + window.words:
                offset = 2 * (first - window.start)
                if request.service == snpx.READ:
                    return self._read(window)[offset : offset + 2 * request.size]
                self._write(window, offset, request.data[: 2 * request.size])
                return b""
        if self.windows:
            raise NotDoneError("missing", f"word {first}")
        if request.service == snpx.READ:
            values = [int(self.values.number(number)) for number in range(first, last + 1)]
            return struct.pack(f"<{len(values)}h", *(max(-(2**15), min(2**15 - 1, value)) for value in values))
        for number, value in enumerate(struct.unpack_from(f"<{request.size}h", request.data), first):
            self.values.numbers[number] = float(value)
        return b""

    def _read(self, window: Window) -> bytes:
        found = _INDEXED.match(window.name)
        if found is None:
            value = self.values.system.get(window.name.upper())
            if value is None:
                raise NotDoneError("missing", window.name)
            return _number(value, window.multiply).ljust(2 * window.words, b"\x00")
        bank, first = found[1].upper(), int(found[3])
        each = _WORDS.get(bank, snpx.NUMBER_WORDS)
        pieces = [self._one(bank, first + place, window.multiply) for place in range(-(-window.words // each))]
        return b"".join(pieces)[: 2 * window.words]

    def _one(self, bank: str, index: int, multiply: float) -> bytes:
        values = self.values
        if bank == "R":
            return _number(values.number(index), multiply)
        if bank == "SR":
            return values.texts.get(index, "").encode("latin-1", "replace")[:80].ljust(80, b"\x00")
        if bank == "PR":
            return values.places.get(index, bytes(2 * snpx.POSITION_WORDS))
        return values.task() if bank == "PRG" else values.place()

    def _write(self, window: Window, offset: int, data: bytes) -> None:
        found = _INDEXED.match(window.name)
        if found is None:
            self.values.system[window.name.upper()] = _value(data, window.multiply)
            return
        bank = found[1].upper()
        index, rest = divmod(offset, 2 * _WORDS.get(bank, snpx.NUMBER_WORDS))
        index += int(found[3])
        if bank == "R" and rest == 0:
            for place in range(0, len(data) - 3, 4):
                self.values.numbers[index + place // 4] = _value(data[place : place + 4], window.multiply)
        elif bank == "SR" and rest == 0:
            self.values.texts[index] = snpx.text_of(data)
        elif bank == "PR":
            kept = bytearray(self.values.places.get(index, bytes(2 * snpx.POSITION_WORDS)))
            kept[rest : rest + len(data)] = data
            self.values.places[index] = bytes(kept[: 2 * snpx.POSITION_WORDS])
        else:
            raise NotDoneError("protected", window.name)


def _number(value: float, multiply: float) -> bytes:
    """A real for the factor 0, else a whole number, multiplied by it."""
    return struct.pack("<f", value) if multiply == 0.0 else struct.pack("<i", round(value * multiply))


def _value(data: bytes, multiply: float) -> float:
    if multiply == 0.0:
        return float(struct.unpack_from("<f", data)[0])
    return float(struct.unpack_from("<i", data)[0] / multiply)


def _described(request: Request) -> tuple[Kind, str]:
    """What a request is about: what is read in cycles is a look."""
    where = f"{request.segment:#04x} {request.index + 1} x {request.size}"
    if request.service == snpx.WRITE and request.segment == snpx.COMMAND:
        return "other", request.data[: request.size].decode("latin-1", "replace")
    if request.service == snpx.WRITE:
        return "set", where
    return "look", where

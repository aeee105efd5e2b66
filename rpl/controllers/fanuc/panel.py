"""The panel interface (SNPX) of a virtual controller: windows over registers, positions, tasks and system variables."""

from __future__ import annotations

import asyncio
import re
import struct
from dataclasses import dataclass

from rpl.controllers.fanuc import snpx
from rpl.controllers.fanuc.snpx import Request
from rpl.controllers.fanuc.values import Values
from rpl.controllers.virtual.store import NotDoneError
from rpl.controllers.virtual.transcript import Kind

_ASSIGN = re.compile(r"SETASG\s+(\d+)\s+(\d+)\s+(.+?)\s+(-?\d*\.?\d+)\s*$", re.IGNORECASE)
_INDEXED = re.compile(r"(R|SR|PR|POS|PRG)\[\s*(?:G1\s*:)?\s*([A-Z]*)(\d+)\s*\]$", re.IGNORECASE)
_BITS = {snpx.OUTPUTS: "DO", snpx.INPUTS: "DI"}
_GROUPS = {snpx.ANALOG_IN: "GO", snpx.ANALOG_OUT: "GI"}
_WORDS = {"SR": snpx.TEXT_WORDS, "PR": snpx.POSITION_WORDS, "POS": snpx.POSITION_WORDS, "PRG": snpx.TASK_WORDS}
_MOST_WORDS = 10_000


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
            self.values.set_number(number, float(value))
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
            return values.text(index).encode("latin-1", "replace")[:80].ljust(80, b"\x00")
        if bank == "PR":
            return values.position(index)
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
                number = _value(data[place : place + 4], window.multiply)
                self.values.set_number(index + place // 4, number)
        elif bank == "SR" and rest == 0:
            self.values.set_text(index, snpx.text_of(data))
        elif bank == "PR":
            kept = bytearray(self.values.position(index))
            kept[rest : rest + len(data)] = data
            self.values.set_position(index, bytes(kept[: 2 * snpx.POSITION_WORDS]))
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

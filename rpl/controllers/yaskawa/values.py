"""Variables and signals of the virtual controller in the bytes of the protocol.

A variable that the selected program does not name has what a client wrote to it, or nothing (0).
"""

from __future__ import annotations

import struct
from collections.abc import Mapping
from dataclasses import dataclass

from rpl.controllers.virtual.cabinet import Cabinet
from rpl.controllers.virtual.store import NotDoneError
from rpl.controllers.yaskawa import hses
from rpl.errors import UsageError
from rpl.passes import rigid
from rpl.runtime.values import JointsValue, PoseValue, TargetValue, Value

MOST = {hses.PLACE: 128}
_USUAL_MOST = 100
_REGISTERS, _WRITABLE_REGISTERS = 1000, 560
_PULSES, _ROBOT = 0, 17
_AXES = 8


class CommandError(Exception):
    """The controller refuses, with this word."""

    def __init__(self, word: int) -> None:
        super().__init__(f"{word:04X}")
        self.word = word


@dataclass(frozen=True, slots=True)
class Layout:
    """letter: of its names in programs; format: of one value."""

    letter: str
    format: str

    @property
    def size(self) -> int:
        return struct.calcsize(self.format)


LAYOUTS: Mapping[int, Layout] = {
    hses.BYTE: Layout("B", "<B"),
    hses.INTEGER: Layout("I", "<h"),
    hses.DOUBLE: Layout("D", "<i"),
    hses.REAL: Layout("R", "<f"),
    hses.TEXT: Layout("S", "16s"),
    hses.PLACE: Layout("P", "<13i"),
}


class Values:
    """What clients read and write by number."""

    def __init__(self, cabinet: Cabinet) -> None:
        self.cabinet = cabinet
        self.kept: dict[tuple[int, int], bytes] = {}

    # ---- variables

    def read(self, command: int, number: int) -> bytes:
        """Raises CommandError."""
        layout = LAYOUTS[command]
        if number >= MOST.get(command, _USUAL_MOST):
            raise CommandError(0xA001)
        name = f"{layout.letter}{number:03d}"
        try:
            value = self.cabinet.variable(name)
        except (NotDoneError, UsageError):
            value = None
        if value is None:
            found = self.kept.get((command, number))
            if found is None and command == hses.PLACE:
                raise CommandError(0xB001)
            return found if found is not None else bytes(layout.size)
        if command == hses.PLACE:
            return struct.pack(layout.format, *self._place(value))
        if command == hses.TEXT:
            return str(value).encode("latin-1", "replace")[:16].ljust(16, b"\x00")
        return struct.pack(layout.format, float(value) if command == hses.REAL else int(value))

    def write(self, command: int, number: int, data: bytes) -> None:
        """Positions that the selected program works with are not written from outside. Raises CommandError."""
        layout = LAYOUTS[command]
        if number >= MOST.get(command, _USUAL_MOST):
            raise CommandError(0xA001)
        if len(data) < layout.size:
            raise CommandError(0xB003)
        part = data[: layout.size]
        found = struct.unpack(layout.format, part)[0]
        value = found.split(b"\x00")[0].decode("latin-1") if command == hses.TEXT else found
        name = f"{layout.letter}{number:03d}"
        try:
            if command == hses.PLACE:
                self.cabinet.variable(name)
                raise CommandError(0x2110)
            self.cabinet.set_variable(name, lambda _: value)
        except (NotDoneError, UsageError):
            self.kept[command, number] = part  # no program names it

    def _place(self, value: Value) -> list[int]:
        """A position: pulses of the axes, or micrometres and ten thousandths of a degree."""
        model = self.cabinet.model
        if isinstance(value, JointsValue) and model is not None and model.pulse_scale is not None:
            joints = [part or 0.0 for part in value.axes.values]
            axes = [round(joint * float(each)) for joint, each in zip(joints, model.pulse_scale, strict=False)]
            return [_PULSES, 0, 0, 0, 0, *axes, *[0] * (_AXES - len(axes))]
        pose = value.pose if isinstance(value, TargetValue) else value
        if not isinstance(pose, PoseValue) or None in pose.trans:
            raise CommandError(0xB001)
        made: rigid.Pose = pose.rigid()
        c, b, a = made.rotation.zyx
        axes = [round(part * 1000.0) for part in (made.position.x, made.position.y, made.position.z)]
        return [_ROBOT, 0, 0, 0, 0, *axes, *(round(angle * 10000.0) for angle in (a, b, c)), 0, 0]

    # ---- signals and registers

    def signals(self, number: int) -> bytes:
        """Eight signals by the number of their byte: inputs and outputs of programs; others are off unless written."""
        base = 0 if 1 <= number <= 512 else 1000 if 1001 <= number <= 1512 else None
        if base is None:
            return self.kept.get((hses.SIGNALS, number), b"\x00")
        word, first = ("IN" if base == 0 else "OT"), 8 * (number - base - 1) + 1
        bits = (bool(self.cabinet.signal(f"{word}#({first + bit})")) << bit for bit in range(8))
        return bytes((sum(bits),))

    def set_signals(self, number: int, data: bytes) -> None:
        """Only the inputs from the network are written. Raises CommandError."""
        if not 2701 <= number <= 2956:
            raise CommandError(0x2110)
        if not data:
            raise CommandError(0xB003)
        self.kept[hses.SIGNALS, number] = data[:1]

    def register(self, number: int) -> bytes:
        if number >= _REGISTERS:
            raise CommandError(0xA001)
        return self.kept.get((hses.REGISTER, number), bytes(2))

    def set_register(self, number: int, data: bytes) -> None:
        if number >= _WRITABLE_REGISTERS:
            raise CommandError(0xA001)
        if len(data) < 2:
            raise CommandError(0xB003)
        self.kept[hses.REGISTER, number] = data[:2]

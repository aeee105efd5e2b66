"""The port of the virtual controller for the robot: state, position, variables, signals, and what starts it."""

from __future__ import annotations

import math
import struct
from collections.abc import Callable, Mapping
from pathlib import PurePosixPath

from rpl.controllers.virtual.cabinet import Cabinet
from rpl.controllers.virtual.store import NotDoneError
from rpl.controllers.virtual.transcript import Kind
from rpl.controllers.yaskawa import hses
from rpl.controllers.yaskawa.hses import Answer, Request
from rpl.controllers.yaskawa.loader import place_in_job
from rpl.controllers.yaskawa.values import LAYOUTS, CommandError, Values

# Names in any encoding come back as they came.
ENCODING = "latin-1"
FIRMWARE, PARAMETERS = "RPL1.00.00A (EN)-00", "1.00"
# Commands for several variables of a kind are those for one of them, so much higher.
MANY = 0x288
_AXES = 8
_ON = 1
_KINDS: Mapping[int, Kind] = {
    hses.SERVO: "servo",
    hses.CYCLE: "set",
    hses.START: "start",
    hses.SELECT: "select",
    hses.MOVE: "start",
    hses.MOVE_PULSES: "start",
}


def refused(request: Request, word: int) -> Answer:
    """The answer that says no."""
    return Answer(request.division, request.service, request.number, hses.REFUSED, word)


class Commands:
    """Answers to the commands."""

    def __init__(self, cabinet: Cabinet) -> None:
        self.cabinet = cabinet
        self.cycle = 2
        self.held = False
        self.values = Values(cabinet)
        self.asked: Mapping[int, Callable[[Request], bytes]] = {
            hses.ALARM: self._alarm,
            hses.STATUS: self._status,
            hses.JOB: self._job,
            hses.AXES: self._axes,
            hses.POSITION: self._position,
            hses.SYSTEM: self._system,
            hses.SERVO: self._servo,
            hses.CYCLE: self._cycle,
            hses.START: self._start,
            hses.SELECT: self._select,
            hses.RESET: self._reset,
            hses.SHOW: self._show,
            hses.SIGNALS: self._signals,
            hses.REGISTER: self._register,
            **dict.fromkeys(LAYOUTS, self._variable),
            **{command + MANY: self._variables for command in LAYOUTS},
        }

    def answer(self, request: Request, addr: tuple[str, int], endless: bool) -> Answer:
        writes = request.service in (hses.SET_ONE, hses.SET_ALL, hses.SET_MANY)
        kind: Kind = "set" if writes else "look"
        if writes and request.command in _KINDS:
            kind = _KINDS[request.command]
            if request.command == hses.SERVO and request.instance != 2:
                kind = "stop"
        text = (
            f"{request.command:03X} {request.instance} {request.attribute} {request.service:02X} {request.data.hex()}"
        )
        self.cabinet.told("robot", kind, text.rstrip())
        command = self.asked.get(request.command)
        if command is None:
            return Answer(request.division, request.service, request.number, hses.NO_SUCH_COMMAND)
        try:
            data = command(request)
        except CommandError as error:
            return refused(request, error.word)
        return Answer(request.division, request.service, request.number, data=data)

    # ---- what is asked

    def _alarm(self, request: Request) -> bytes:
        """The latest message; the number is that of an alarm a program sets."""
        if request.instance > len(self.cabinet.messages):
            return _element(request, [bytes(4), bytes(4), bytes(4), bytes(16), bytes(32)])
        name = self.cabinet.messages[-request.instance].encode(ENCODING, "replace")[:32]
        numbers = [struct.pack("<I", number) for number in (8000, 0, 0)]
        return _element(request, [*numbers, b"2026/01/01 00:00".ljust(16, b"\x00"), name.ljust(32, b"\x00")])

    def _status(self, request: Request) -> bytes:
        cabinet = self.cabinet
        cabinet.advance()
        modes = {"manual": 0x20, "automatic": 0x40, "remote": 0x40 | 0x80}
        first = 1 << (self.cycle - 1) | 0x08 * (cabinet.phase == "running") | modes[cabinet.mode]
        second = 0x08 * self.held | 0x40 * cabinet.motors_on
        return _element(request, [struct.pack("<I", first), struct.pack("<I", second)])

    def _job(self, request: Request) -> bytes:
        if request.instance != 1:
            raise CommandError(0xA001)
        self.cabinet.advance()
        name, line, step = "", 0, 0
        if self.cabinet.program:
            file, at = self.cabinet.place
            name = PurePosixPath(file or self.cabinet.program).stem
            if f"{name}.JBI" in self.cabinet.store:
                line, step = place_in_job(self.cabinet.store.kept(f"{name}.JBI"), at)
        parts = [name.encode(ENCODING, "replace")[:32].ljust(32, b"\x00")]
        return _element(request, parts + [struct.pack("<I", number) for number in (line, step, 10000)])

    def _axes(self, request: Request) -> bytes:
        """What the axes are called, for pulses and for the base."""
        if request.instance not in (1, 101):
            raise CommandError(0xA001)
        joints = self.cabinet.model.axes if self.cabinet.model is not None else 0
        names = ["S", "L", "U", "R", "B", "T"][:joints] if request.instance == 1 else ["X", "Y", "Z", "Rx", "Ry", "Rz"]
        return _element(request, [name.encode().ljust(4, b"\x00") for name in [*names, *[""] * (_AXES - len(names))]])

    def _position(self, request: Request) -> bytes:
        """Pulses of the axes, or the flange in the base: micrometres and ten thousandths of a degree."""
        cabinet = self.cabinet
        cabinet.advance()
        joints, model, flange = cabinet.joints, cabinet.model, cabinet.flange
        if request.instance not in (1, 101):
            raise CommandError(0xA001)
        if joints is None or model is None or flange is None:
            raise CommandError(0xB005)
        if request.instance == 1:
            if model.pulse_scale is None:
                raise CommandError(0xB005)
            axes = [round(float(joint * each)) for joint, each in zip(joints, model.pulse_scale, strict=True)]
            kind = 0
        else:
            x, y, z = (round(float(value) * 1000.0) for value in flange[:3, 3])
            axes = [x, y, z, *(round(angle * 10000.0) for angle in fixed_angles(flange))]
            kind = 16
        numbers = [kind, 0, 0, 0, 0, *axes, *[0] * (_AXES - len(axes))]
        return _element(request, [struct.pack("<i", number) for number in numbers])

    def _system(self, request: Request) -> bytes:
        model = self.cabinet.model.name if self.cabinet.model is not None else ""
        if request.instance not in (11, 101):
            raise CommandError(0xA001)
        what = model if request.instance == 11 else "GENERAL"
        texts = ((FIRMWARE, 24), (what.upper().replace("_", "-"), 16), (PARAMETERS, 8))
        return _element(request, [text.encode()[:size].ljust(size, b"\x00") for text, size in texts])

    # ---- variables and signals

    def _variable(self, request: Request) -> bytes:
        self.cabinet.advance()
        if request.service in (hses.SET_ONE, hses.SET_ALL):
            self.values.write(request.command, request.instance, request.data)
            return b""
        if request.service not in (hses.GET_ONE, hses.GET_ALL):
            raise CommandError(0xA000)
        return self.values.read(request.command, request.instance)

    def _variables(self, request: Request) -> bytes:
        """Several in a row: their number, then their values. One byte values come in even numbers."""
        self.cabinet.advance()
        command = request.command - MANY
        size, count = LAYOUTS[command].size, _number(request)
        if not count or 4 + count * size > hses.MOST_DATA or (size == 1 and count % 2):
            raise CommandError(0xB004)
        numbers = range(request.instance, request.instance + count)
        if request.service == hses.SET_MANY:
            if len(request.data) < 4 + count * size:
                raise CommandError(0xB003)
            for place, number in enumerate(numbers):
                self.values.write(command, number, request.data[4 + place * size :])
            return b""
        if request.service != hses.GET_MANY:
            raise CommandError(0xA000)
        return request.data[:4] + b"".join(self.values.read(command, number) for number in numbers)

    def _signals(self, request: Request) -> bytes:
        if request.service == hses.SET_ONE:
            self.values.set_signals(request.instance, request.data)
            return b""
        self.cabinet.advance()
        return self.values.signals(request.instance)

    def _register(self, request: Request) -> bytes:
        if request.service == hses.SET_ONE:
            self.values.set_register(request.instance, request.data)
            return b""
        return self.values.register(request.instance)

    # ---- what is ordered

    def _may_order(self) -> None:
        if self.cabinet.mode != "remote":
            raise CommandError(0x2100)

    def _servo(self, request: Request) -> bytes:
        self._may_order()
        on = _number(request) == _ON
        if request.instance == 1:
            self.held = on
            if on:
                self.cabinet.pause()
        elif request.instance == 2:
            if on and self.cabinet.emergency_stop:
                raise CommandError(0x3450)
            if not on:
                self.cabinet.pause()
            self.cabinet.motors_on = on
        elif request.instance != 3:
            raise CommandError(0xA001)
        return b""

    def _cycle(self, request: Request) -> bytes:
        self._may_order()
        if _number(request) not in (1, 2, 3):
            raise CommandError(0xB004)
        self.cycle = _number(request)
        return b""

    def _start(self, request: Request) -> bytes:
        self._may_order()
        cabinet = self.cabinet
        if cabinet.phase == "running":
            raise CommandError(0x2010)
        if not cabinet.motors_on:
            raise CommandError(0x2070)
        if self.held:
            raise CommandError(0x2050)
        try:
            cabinet.start()
        except NotDoneError as why:
            raise CommandError(0x3450 if why.why == "emergency-stop" else 0x4060) from None
        return b""

    def _select(self, request: Request) -> bytes:
        self._may_order()
        if request.attribute != 0:
            raise CommandError(0xA002)
        if len(request.data) < 36:
            raise CommandError(0xB003)
        cabinet = self.cabinet
        if cabinet.phase == "running":
            raise CommandError(0x2010)
        name = request.data[:32].split(b"\x00")[0].decode(ENCODING)
        if f"{name}.JBI" not in cabinet.store:
            raise CommandError(0x4040)
        jobs = [
            one for one in cabinet.store.names() if one.upper().endswith((".JBI", "TOOL.CND", "UFRAME.CND", "VAR.DAT"))
        ]
        if cabinet.select(jobs, name):
            raise CommandError(0x4170)
        return b""

    def _reset(self, request: Request) -> bytes:
        return b""

    def _show(self, request: Request) -> bytes:
        self.cabinet.messages.append(request.data.split(b"\x00")[0].decode(ENCODING))
        return b""


def _element(request: Request, elements: list[bytes]) -> bytes:
    """All elements, or the one that is asked for."""
    if request.service == hses.GET_ALL and request.attribute == 0:
        return b"".join(elements)
    if request.service != hses.GET_ONE or not 1 <= request.attribute <= len(elements):
        raise CommandError(0xA002)
    return elements[request.attribute - 1]


def _number(request: Request) -> int:
    if len(request.data) < 4:
        raise CommandError(0xB003)
    return int.from_bytes(request.data[:4], "little")


def fixed_angles(flange: object) -> tuple[float, float, float]:
    """Rx, Ry, Rz in degrees of a pose (4, 4): turns about the fixed x, then y, then z axis."""
    import numpy as np

    r = np.asarray(flange, dtype=np.float64)
    across = math.hypot(r[0, 0], r[1, 0])
    ry = math.degrees(math.atan2(-r[2, 0], across))
    if across < 1e-9:  # the tool looks along z turned by 90 degrees: only the sum of the other two counts
        return 0.0, ry, math.degrees(math.atan2(-r[0, 1], r[1, 1]))
    return math.degrees(math.atan2(r[2, 1], r[2, 2])), ry, math.degrees(math.atan2(r[1, 0], r[0, 0]))

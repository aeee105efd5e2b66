"""Asking RTDE (TCP 30004) for values: names there, packages of values back. Nothing is set by this client."""

from __future__ import annotations

import math
import re
import socket
import struct
import time
from collections.abc import Iterator, Mapping, Sequence
from types import TracebackType
from typing import Self

from rpl.controllers.link import GarbledError, LostError, RefusedError
from rpl.controllers.profile import Profile
from rpl.controllers.showing import Sample, Shown
from rpl.controllers.ur import rtde
from rpl.controllers.ur.rtde import Recipe, Value

# Signals by the pendant's names: group -> first bit, how many.
GROUPS = {"digital": (0, 8), "config": (8, 8), "tool": (16, 2)}
_BITS = {"in": "actual_digital_input_bits", "out": "actual_digital_output_bits"}
_SIGNAL = re.compile(r"(digital|config|tool)_(in|out)\[(\d+)\]")
USUAL = (
    "actual_q",
    "actual_TCP_pose",
    "robot_mode",
    "runtime_state",
    "safety_mode",
    "speed_scaling",
    *(f"digital_out[{number}]" for number in range(8)),
)
_RATES = (125.0, 500.0)  # what CB3 and e-Series give at most (Hz)


class Exchange:
    """A connection that asks. Raises LostError, GarbledError, RefusedError."""

    def __init__(self, profile: Profile) -> None:
        port = profile.port_of("rtde")
        self.place = f"RTDE {profile.host}:{port}"
        self.patience_s = profile.patience_s
        try:
            self._socket = socket.create_connection((profile.host, port), profile.patience_s)
        except OSError as error:
            raise LostError(f"{self.place}: {error.strerror or error}") from None
        self._left = b""
        if self.ask(rtde.PROTOCOL, struct.pack(">H", rtde.VERSION)) != b"\x01":
            self.close()
            raise RefusedError(f"{self.place}: it does not speak version {rtde.VERSION}")
        said = self.ask(rtde.CONTROLLER)
        if len(said) != 16:
            raise GarbledError(f"{self.place}: a version of {len(said)} bytes")
        self.version = struct.unpack(">4I", said)

    def ask(self, kind: int, payload: bytes = b"") -> bytes:
        """The payload of the answer; texts for people that come between are passed by."""
        try:
            self._socket.sendall(rtde.package(kind, payload))
        except OSError as error:
            raise LostError(f"{self.place}: {error.strerror or error}") from None
        due = time.monotonic() + self.patience_s
        while True:
            found, said = self._package(due)
            if found == kind:
                return said
            if found not in (rtde.MESSAGE, rtde.DATA):
                raise GarbledError(f"{self.place}: a package of type {found} is no answer")

    def wanted(self, names: Sequence[str], rate_hz: float) -> Recipe:
        """Begin a recipe of outputs. Raises RefusedError with the names that the controller does not have."""
        said = self.ask(rtde.OUTPUTS, struct.pack(">d", rate_hz) + ",".join(names).encode("ascii"))
        types = said[1:].decode("ascii", "replace").split(",")
        if len(types) != len(names):
            raise GarbledError(f"{self.place}: {len(types)} types for {len(names)} names")
        missing = [name for name, kind in zip(names, types, strict=True) if kind == "NOT_FOUND"]
        if missing:
            raise RefusedError(f"{self.place}: there is no {', '.join(missing)}")
        try:
            return rtde.recipe(said[0], names, types)
        except KeyError as error:
            raise GarbledError(f"{self.place}: {error.args[0]!r} is no type") from None

    def start(self) -> None:
        if self.ask(rtde.START) != b"\x01":
            raise RefusedError(f"{self.place}: it does not begin to give values")

    def next(self, recipe: Recipe) -> dict[str, Value]:
        """The next values."""
        due = time.monotonic() + self.patience_s
        while True:
            kind, said = self._package(due)
            if kind != rtde.DATA:
                continue
            try:
                return recipe.unpacked(said)
            except struct.error:
                raise GarbledError(f"{self.place}: values of {len(said)} bytes for {recipe.packing.size}") from None

    def newest(self, recipe: Recipe) -> dict[str, Value]:
        """The last of the values that have come by now; waits for one if there is none."""
        found = self.next(recipe)
        while len(self._left) >= rtde.HEADER.size and len(self._left) >= rtde.HEADER.unpack_from(self._left)[0]:
            found = self.next(recipe)
        return found

    def _package(self, due: float) -> tuple[int, bytes]:
        head = rtde.HEADER.size
        while True:
            if len(self._left) >= head:
                size, kind = rtde.HEADER.unpack_from(self._left)
                if size < head:
                    raise GarbledError(f"{self.place}: a package of {size} bytes")
                if len(self._left) >= size:
                    said, self._left = self._left[head:size], self._left[size:]
                    if time.monotonic() > due:
                        raise GarbledError(f"{self.place}: packages without end, and no answer among them")
                    return kind, said
            self._receive(due)

    def _receive(self, due: float) -> None:
        try:
            self._socket.settimeout(max(due - time.monotonic(), 0.001))
            piece = self._socket.recv(65536)
        except TimeoutError:
            raise LostError(f"{self.place}: no answer within {self.patience_s:g} s") from None
        except OSError as error:
            raise LostError(f"{self.place}: {error.strerror or error}") from None
        if not piece:
            raise LostError(f"{self.place}: the connection is lost")
        self._left += piece

    def close(self) -> None:
        self._socket.close()

    def __enter__(self) -> Self:
        return self

    def __exit__(self, kind: type[BaseException] | None, error: BaseException | None, at: TracebackType | None) -> None:
        self.close()


def now(profile: Profile, names: Sequence[str]) -> dict[str, Value]:
    """These variables at this moment."""
    with Exchange(profile) as exchange:
        recipe = exchange.wanted(names, _RATES[0])
        exchange.start()
        return exchange.next(recipe)


def watched(profile: Profile, names: Sequence[str], period_s: float) -> Iterator[Sample]:
    """Values by RTDE's names, or signals by the pendant's (`digital_out[3]`, `config_in[0]`), a sample each period."""
    shown = tuple(names) or USUAL
    variables = tuple(dict.fromkeys(_BITS[match[2]] if (match := _SIGNAL.fullmatch(name)) else name for name in shown))
    with Exchange(profile) as exchange:
        fastest = _RATES[exchange.version[0] > 3]
        recipe = exchange.wanted(variables, min(max(1.0 / period_s, 1.0), fastest))
        exchange.start()
        began = due = time.monotonic()
        while True:
            values = exchange.newest(recipe)
            if time.monotonic() >= due:
                due = max(due + period_s, time.monotonic() - period_s)
                yield Sample(time.monotonic() - began, {name: _shown(name, values) for name in shown})


def _shown(name: str, values: Mapping[str, Value]) -> Shown | tuple[float, ...]:
    match = _SIGNAL.fullmatch(name)
    if match is None:
        value = values[name]
        return tuple(float(one) for one in value) if isinstance(value, tuple) else value
    first, count = GROUPS[match[1]]
    number = int(match[3])
    if number >= count:
        raise RefusedError(f"there is no {name}: {match[1]} has {count}")
    bits = values[_BITS[match[2]]]
    return isinstance(bits, int) and bool(bits >> first + number & 1)


def signals_of(values: Mapping[str, Value]) -> dict[str, Shown]:
    """All digital signals by the pendant's names."""
    found: dict[str, Shown] = {}
    for way, variable in _BITS.items():
        bits = values[variable]
        for group, (first, count) in GROUPS.items():
            for number in range(count):
                found[f"{group}_{way}[{number}]"] = isinstance(bits, int) and bool(bits >> first + number & 1)
    return found


def degrees(value: Value) -> tuple[float, ...]:
    return tuple(math.degrees(one) for one in value) if isinstance(value, tuple) else ()

"""The variables that the virtual controller shows: those of the system, and those of the program that is selected.

Values are spelled as KRL spells them. What a name means is in the manual "System Variables" (KSS 8.1 to 8.4). The arm
is shown at its flange in its base, because of a tool and a base only the program knows.
"""

from __future__ import annotations

import math
import re
from collections.abc import Callable, Mapping
from pathlib import PurePosixPath

from rpl.controllers.kuka.krl import read_value, spelled, structure
from rpl.controllers.virtual.cabinet import Cabinet
from rpl.controllers.virtual.store import NotDoneError
from rpl.errors import UsageError
from rpl.runtime.values import Array, JointsValue, Member, PoseValue, Record, SignalRef, StopWatch, TargetValue, Value

VERSION = "KRC:\\RPL V8.3.0 (virtual)"
_MODES = {"manual": "#T1", "automatic": "#AUT", "remote": "#EX"}
_PHASES = {"running": "#P_ACTIVE", "paused": "#P_STOP"}
_SIGNAL = re.compile(r"\$(IN|OUT)\[\s*(\d+)\s*\]")
_ACCESS = re.compile(r"\[\s*(\d+)\s*\]|\.\s*(\w+)|(\[\s*\])")


class VariableError(Exception):
    """There is no such variable, or it takes no such value."""


class SystemVariables:
    """`speed_percent`: the override that clients set; it is shown, and the run is not slower for it."""

    def __init__(self, cabinet: Cabinet) -> None:
        self.cabinet = cabinet
        self.speed_percent = 100
        self.known: Mapping[str, Callable[[], str]] = {
            "PING": lambda: "PONG",
            "@PROXY_TYPE": lambda: "C3 BRIDGE INTERFACE",
            "@PROXY_VERSION": lambda: "1.4.0.0",
            "$MODE_OP": lambda: _MODES[cabinet.mode],
            "$PRO_STATE": self._state,
            "$PRO_STATE1": self._state,
            "$PRO_ACT": lambda: spelled(cabinet.phase == "running"),
            "$PRO_NAME[]": self._program,
            "$PRO_NAME1[]": self._program,
            "$PRO_IP1": self._pointer,
            "$PRO_IP1.SNR": lambda: spelled(cabinet.place[1]),
            "$PRO_IP1.NAME[]": self._program,
            "$ALARM_STOP": lambda: spelled(not cabinet.emergency_stop),
            "$PERI_RDY": lambda: spelled(cabinet.motors_on),
            "$STOPMESS": lambda: spelled(cabinet.emergency_stop),
            "$USER_SAF": lambda: "TRUE",
            "$OV_PRO": lambda: spelled(self.speed_percent),
            "$KR_SERIALNO": lambda: cabinet.serial,
            "$ROBNAME[]": lambda: '"RPL"',
            "$TRAFONAME[]": self._model,
            "$MODEL_NAME[]": self._model,
            "$RCV_INFO[]": lambda: spelled(VERSION),
            "$AXIS_ACT": self._axes,
            "$AXIS_ACT_MES": self._axes,
            "$POS_ACT": self._position,
            "$POS_ACT_MES": self._position,
        }

    def read(self, name: str) -> str:
        """Raises VariableError."""
        self.cabinet.advance()
        wanted = name.strip().upper()
        if wanted in self.known:
            return self.known[wanted]()
        signal = _SIGNAL.fullmatch(wanted)
        if signal is not None:
            return spelled(bool(self.cabinet.signal(f"${signal[1]}[{int(signal[2])}]")))
        return shown(self._variable(wanted))

    def write(self, name: str, value: str) -> None:
        """The override, an output, or a variable of the program; inputs come from the bus. Raises VariableError."""
        wanted, text = name.strip().upper(), value.strip()
        signal = _SIGNAL.fullmatch(wanted)
        if wanted == "$OV_PRO" and text.isdigit() and int(text) <= 100:
            self.speed_percent = int(text)
        elif signal is not None and signal[1] == "OUT" and text.upper() in ("TRUE", "FALSE"):
            self.cabinet.set_signal(f"$OUT[{int(signal[2])}]", text.upper() == "TRUE")
        elif signal is not None or wanted in self.known:
            raise VariableError(name)
        else:
            self._assign(wanted, text)

    def _assign(self, name: str, text: str) -> None:
        """Numbers, truth values, texts and members, and numbers of a structure (`NAME.X`)."""
        found = re.fullmatch(r"([\w$]+)(?:\[\s*\])?(?:\.(\w+))?", name)
        if found is None:
            raise VariableError(name)
        part = found[2].lower() if found[2] else None

        def changed(old: Value) -> Value:
            if part is None:
                return _like(old, text)
            inner = f"j{part[1:]}" if isinstance(old, JointsValue) and part[0] == "a" else part
            if not isinstance(old, JointsValue | TargetValue | PoseValue):
                raise VariableError(name)
            return old.replaced(inner, _like(0.0, text))

        try:
            self.cabinet.set_variable(found[1], changed)
        except (NotDoneError, UsageError, ValueError):
            raise VariableError(name) from None

    def _variable(self, name: str) -> Value:
        """A variable of the program, or a part of one: `NAME[2].X`."""
        base = re.match(r"[\w$]+", name)
        if base is None:
            raise VariableError(name)
        try:
            value = self.cabinet.variable(base[0])
        except (NotDoneError, UsageError):
            raise VariableError(name) from None
        for found in _ACCESS.finditer(name, base.end()):
            value = _part(value, found[1], found[2])
        return value

    def _state(self) -> str:
        if self.cabinet.phase in _PHASES:
            return _PHASES[self.cabinet.phase]
        if not self.cabinet.program:
            return "#P_FREE"
        return "#P_END" if self.cabinet.is_over else "#P_RESET"

    def _program(self) -> str:
        return spelled(PurePosixPath(self.cabinet.program).stem.upper())

    def _pointer(self) -> str:
        return f"{{PRO_IP: NAME[] {self._program()}, SNR {self.cabinet.place[1]}}}"

    def _model(self) -> str:
        model = self.cabinet.model
        return spelled(f"#{model.name.upper()}" if model is not None else "#NONE")

    def _axes(self) -> str:
        joints = self.cabinet.joints
        if joints is None:
            raise VariableError("$AXIS_ACT")
        parts = {f"A{number}": float(value) for number, value in enumerate(joints, 1)}
        return structure("E6AXIS", parts | {f"E{number}": 0.0 for number in range(1, 7)})

    def _position(self) -> str:
        """Without the status and turns that tell postures apart."""
        flange = self.cabinet.flange
        if flange is None:
            raise VariableError("$POS_ACT")
        parts = dict(zip("XYZ", (float(value) for value in flange[:3, 3]), strict=True))
        across = math.hypot(flange[0, 0], flange[1, 0])
        b = math.atan2(-flange[2, 0], across)
        if across < 1e-9:  # A and C turn about the same axis
            a, c = math.atan2(-flange[0, 1], flange[1, 1]), 0.0
        else:
            a, c = math.atan2(flange[1, 0], flange[0, 0]), math.atan2(flange[2, 1], flange[2, 2])
        parts |= dict(zip("ABC", map(math.degrees, (a, b, c)), strict=True))
        return structure("E6POS", parts | {f"E{number}": 0.0 for number in range(1, 7)})


def _like(old: Value, text: str) -> Value:
    """What a text says, as a value of the kind of the present one. Raises VariableError."""
    said = read_value(text)
    if isinstance(old, Member) and text.startswith("#"):
        return Member(text[1:].lower())
    if isinstance(old, bool) or isinstance(said, bool):
        if isinstance(old, bool) and isinstance(said, bool):
            return said
    elif isinstance(old, int) and isinstance(said, int):
        return said
    elif isinstance(old, float) and isinstance(said, int | float):
        return float(said)
    elif isinstance(old, str) and not isinstance(old, Member) and text.startswith('"'):
        return said
    raise VariableError(text)


def _part(value: Value, index: str | None, name: str | None) -> Value:
    """An element or a component. Raises VariableError."""
    try:
        if index is not None:
            return value.items[value.at(int(index))]
        if name is not None:
            lower = name.lower()
            return value.get(f"j{lower[1:]}" if isinstance(value, JointsValue) and lower[0] == "a" else lower)
    except (AttributeError, KeyError, ValueError):
        raise VariableError(name or index or "") from None
    return value


def shown(value: Value) -> str:
    """A value of a program in KRL. Raises VariableError for what KRL shows only in parts, or what has no value."""
    if value is None or isinstance(value, Array | SignalRef | StopWatch):
        raise VariableError("no value")
    if isinstance(value, Member):
        return f"#{value.upper()}"
    if isinstance(value, bool | int | float | str):
        return spelled(value)
    if isinstance(value, JointsValue):
        axes = {f"A{number}": part for number, part in enumerate(value.axes.values, 1) if part is not None}
        outside = {f"E{number}": part for number, part in enumerate(value.ext.values, 1) if part is not None}
        return structure("E6AXIS", axes | outside)
    if isinstance(value, TargetValue):
        parts = {name.upper(): value.get(name) for name in ("x", "y", "z", "a", "b", "c")}
        parts |= {name.upper(): flag for name, flag in value.conf.flags}
        parts |= {f"E{number}": part for number, part in enumerate(value.ext.values, 1)}
        return structure("E6POS", {name: part for name, part in parts.items() if part is not None})
    if isinstance(value, Record):
        inner = ", ".join(f"{name.upper()} {shown(part)}" for name, part in value.parts.items() if part is not None)
        return f"{{{value.type_name.upper()}: {inner}}}"
    if isinstance(value, PoseValue):
        parts = {name.upper(): value.get(name) for name in ("x", "y", "z", "a", "b", "c")}
        return structure("FRAME", {name: part for name, part in parts.items() if part is not None})
    raise VariableError("no value")

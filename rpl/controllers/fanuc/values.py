"""What a virtual FANUC controller keeps besides its programs: registers (also of positions, texts), system variables.

They are the selected program's data while there is one, and stay when it ends or another takes its place. What dumps
(`NUMREG.VA`, `POSREG.VA`, `STRREG.VA`) say of them holds from the beginning.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass, field
from pathlib import PurePosixPath
from typing import TYPE_CHECKING

from rpl import registry
from rpl.controllers.fanuc import snpx
from rpl.controllers.fanuc.listing import listing_of
from rpl.controllers.virtual import within
from rpl.controllers.virtual.cabinet import Cabinet
from rpl.controllers.virtual.store import NotDoneError
from rpl.diagnostics import Diagnostics
from rpl.project import read_sources
from rpl.runtime.values import (
    Array,
    AxesValue,
    ConfigValue,
    JointsValue,
    PoseValue,
    RotationValue,
    TargetValue,
    Value,
    VectorValue,
)
from rpl.source import source_from_bytes

if TYPE_CHECKING:
    from rpl.simulation import Simulation

_STATES = {"stopped": 0, "paused": 1, "running": 2}
# How the reader of TP calls them: one by one, or a bank as a whole where the program works out a number.
_REGISTER = re.compile(r"registers\.(r|sr|pr)(\d*)")
_UNTAUGHT = bytes(2 * snpx.POSITION_WORDS)
_CONVENTION = "zyx"
_READER = "READ_DUMPS.LS"  # a program that names what dumps list: what nobody names is not read
_SECTION = re.compile(r"^\[\*(\w+)\*\]", re.MULTILINE)
_ENTRY = re.compile(r"^\s*\[(?:\d+,\s*)?(\d+)\]\s*=", re.MULTILINE)
_SECTIONS = {"NUMREG": "R", "POSREG": "PR", "STRREG": "SR"}


@dataclass
class Values:
    """numbers, texts, places: as they are without a program, by their numbers; places as the panel has them."""

    cabinet: Cabinet
    numbers: dict[int, float] = field(default_factory=dict)
    texts: dict[int, str] = field(default_factory=dict)
    places: dict[int, bytes] = field(default_factory=dict)
    system: dict[str, float] = field(default_factory=lambda: {"$MCR.$GENOVERRIDE": 100.0})

    _known: tuple[Simulation | None, dict[tuple[str, int], int]] = field(default=(None, {}), repr=False)

    def __post_init__(self) -> None:
        self.cabinet.keeper = self

    def number(self, index: int) -> float:
        """R[index]."""
        found = self._seen("r", index)
        return float(found) if isinstance(found, int | float) else self.numbers.get(index, 0.0)

    def set_number(self, index: int, value: float) -> None:
        self.numbers[index] = value
        self._set("r", index, int(value) if value.is_integer() else value)

    def text(self, index: int) -> str:
        """SR[index]."""
        found = self._seen("sr", index)
        return found if isinstance(found, str) else self.texts.get(index, "")

    def set_text(self, index: int, value: str) -> None:
        self.texts[index] = value
        self._set("sr", index, value)

    def position(self, index: int) -> bytes:
        """PR[index] as the panel has it."""
        found = self._seen("pr", index)
        return position_bytes_of(found) or self.places.get(index, _UNTAUGHT)

    def set_position(self, index: int, data: bytes) -> None:
        """Raises NotDoneError where the program has joints there and the panel gives a pose, or the other way round."""
        old = self._seen("pr", index)
        value = position_value(data, old) if isinstance(old, TargetValue | JointsValue) else None
        self.places[index] = data
        if value is not None:
            self._set("pr", index, value)

    def read_dumps(self) -> None:
        """What the dumps among the files say; nothing where they cannot be read."""
        store, diagnostics = self.cabinet.store, Diagnostics()
        names = [name for name in store.names() if name.lower().endswith(".va") and ".." not in name]
        if not names:
            return
        dumps = [source_from_bytes(name, store.kept(name)) for name in names]
        said = sorted({place for dump in dumps for place in _listed(dump.text)})
        body = " ;\n   1:  ".join(f"{bank}[{number}]={bank}[{number}]" for bank, number in said) or "!"
        sources = [source_from_bytes(_READER, listing_of(body, "", PurePosixPath(_READER).stem).encode()), *dumps]
        read = read_sources(sources, self.cabinet.dialect, diagnostics)
        if not diagnostics.has_errors:
            self.taken(self.cabinet.made(read, PurePosixPath(_READER).stem))

    # ---- the program's own

    def given(self, simulation: Simulation) -> None:
        """A program that is selected begins with what is kept."""
        for bank, first, slot in _banks(simulation):
            value = simulation.globals[slot]
            numbers = range(1, len(value.items) + 1) if first == 0 and isinstance(value, Array) else (first,)
            for number in numbers:
                kept = self._kept(bank, number, _one(value, first, number))
                if kept is not None:
                    _put(simulation, slot, first, number, kept)

    def taken(self, simulation: Simulation) -> None:
        """What a program leaves is kept."""
        for bank, first, slot in _banks(simulation):
            value = simulation.globals[slot]
            numbers = range(1, len(value.items) + 1) if first == 0 and isinstance(value, Array) else (first,)
            for number in numbers:
                self._keep(bank, number, _one(value, first, number))

    def _kept(self, bank: str, number: int, old: Value) -> Value:
        """What is kept as the program has it; None: nothing."""
        if bank == "r":
            value = self.numbers.get(number)
            return int(value) if value is not None and value.is_integer() else value
        if bank == "sr":
            return self.texts.get(number)
        data = self.places.get(number)
        try:
            return position_value(data, old) if data is not None else None
        except NotDoneError:
            return None  # M: the program has joints there and a pose is kept, or the other way round

    def _keep(self, bank: str, number: int, value: Value) -> None:
        if bank == "r" and isinstance(value, int | float):
            self.numbers[number] = float(value)
        elif bank == "sr" and isinstance(value, str):
            self.texts[number] = value
        elif bank == "pr" and (data := position_bytes_of(value)):
            self.places[number] = data

    def _found(self, bank: str, number: int) -> tuple[Simulation, int, int] | None:
        """The selected program and where it has a register: the slot, and 0 or the number that it stands for alone."""
        simulation = self.cabinet.outer
        if simulation is None:
            return None
        if self._known[0] is not simulation:
            self._known = simulation, {(one, first): slot for one, first, slot in _banks(simulation)}
        for first in (number, 0):
            if (slot := self._known[1].get((bank, first))) is not None:
                return simulation, slot, first
        return None

    def _seen(self, bank: str, number: int) -> Value:
        with self.cabinet.lock:
            self.cabinet.advance()
            found = self._found(bank, number)
            return _one(found[0].globals[found[1]], found[2], number) if found is not None else None

    def _set(self, bank: str, number: int, value: Value) -> None:
        with self.cabinet.lock:
            found = self._found(bank, number)
            if found is not None:
                _put(*found, number, value)
                found[0].changed()

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


def _banks(simulation: Simulation) -> Iterator[tuple[str, int, int]]:
    """The registers that a program has: the bank, the number (0: the bank as an array), the slot."""
    within.data_of(simulation)  # has given all data its first value
    for place, slot in enumerate(simulation.program.slots):
        found = _REGISTER.fullmatch(slot.qualified)
        if found is not None:
            yield found[1], int(found[2] or 0), place


def _listed(dump: str) -> Iterator[tuple[str, int]]:
    """The registers of which a dump says something: bank and number."""
    parts = _SECTION.split(dump)
    for section, text in zip(parts[1::2], parts[2::2], strict=True):
        for found in _ENTRY.finditer(text) if section in _SECTIONS else ():
            yield _SECTIONS[section], int(found[1])


def _one(value: Value, first: int, number: int) -> Value:
    if first:
        return value
    return value.items[number - 1] if isinstance(value, Array) and 0 < number <= len(value.items) else None


def _put(simulation: Simulation, slot: int, first: int, number: int, value: Value) -> None:
    bank = simulation.globals[slot]
    if first:
        simulation.globals[slot] = value
    elif isinstance(bank, Array) and 0 < number <= len(bank.items):
        bank.items[number - 1] = value


# ---- positions


def position_bytes_of(value: Value) -> bytes:
    """A position register of a program as the panel has it; nothing where it is not taught."""
    match value:
        case TargetValue(pose=PoseValue(trans=trans, rot=rot), conf=conf):
            numbers = (*trans, *reversed(rot.parts))
            if rot.convention != _CONVENTION or any(one is None for one in numbers):
                return b""
            flags = {name: int(flag or 0) for name, flag in conf.flags}
            posture = (flags["flip"], 0, 1 - flags["down"], 1 - flags["back"], flags["t4"], 0, flags["t6"])
            place = snpx.Place(tuple(float(one) for one in numbers if one is not None), (), posture)
            return snpx.position_bytes(place, joints=False)
        case JointsValue(axes=axes):
            joints = tuple(float(one) for one in axes.values if one is not None)
            return snpx.position_bytes(snpx.Place((0.0,) * 6, joints), pose=False) if joints else b""
    return b""


def position_value(data: bytes, old: Value) -> Value:
    """The position register of a program with what the panel gives; nothing (as it was) where that is not valid.
    Raises NotDoneError where one is a pose and the other joints."""
    place, pose, joints = snpx.position_of(data), snpx.has_pose(data), snpx.has_joints(data)
    match old:
        case TargetValue(conf=conf, ext=ext) if pose:
            x, y, z, w, p, r = place.xyzwpr
            flip, _, up, front, turn4, _, turn6 = place.posture
            said = {"flip": flip, "down": 1 - up, "back": 1 - front, "t4": turn4, "t6": turn6, "t1": 0}
            flags = tuple((name, said.get(name, flag)) for name, flag in conf.flags)
            turned = PoseValue(VectorValue(x, y, z), RotationValue(_CONVENTION, (r, p, w)))
            return TargetValue(turned, ConfigValue(conf.notation, flags), ext)
        case JointsValue(ext=ext) if joints:
            return JointsValue(AxesValue(tuple(place.joints[:6])), ext)
    if pose or joints:
        raise NotDoneError("protected", "this position register has the other representation in the program")
    return None

"""First values of global data, in the order in which they need each other, with what the cell file overrides."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING

from rpl.errors import RunError, UsageError
from rpl.runtime.code import Values
from rpl.runtime.faults import ProgramError
from rpl.runtime.values import (
    Array,
    JointsValue,
    Member,
    PoseValue,
    Record,
    RotationValue,
    SignalRef,
    TargetValue,
    Value,
    VectorValue,
    pose_from,
)
from rpl.source import NOWHERE, Origin

if TYPE_CHECKING:
    from rpl.linking.symbols import Symbols
    from rpl.runtime.machine import Machine

# Records that stand for a pose in some languages -> the component that has the pose.
_HOLDS_A_POSE = {"tool": "frame", "workobject": "user_frame"}
_STEP = re.compile(r"\[(\d+)\]|\.(\w+)")


class _Loader:
    """Stands in for the task while initial values are made."""

    def __init__(self, machine: Machine) -> None:
        self.machine = machine
        self.g = machine.globals
        self.signals = machine.signals
        self.looked = self.looked_at_time = False
        self.inputs: dict[SignalRef, float] = {}
        self.name = "start"
        self.robot = None

    def where(self) -> Origin:
        return NOWHERE


def initialise(linked: Symbols, values: Values, machine: Machine) -> None:
    """Append first values for all global data that has none yet."""
    first = len(values)
    values.extend([None] * (len(linked.slots) - first))
    done: set[int] = set(range(first))
    frame: Values = [_Loader(machine)]
    number = first
    while number < len(linked.slots):
        values.extend([None] * (len(linked.slots) - len(values)))
        _make(linked, number, values, frame, done)
        number += 1
    _override(linked, values, machine, first)


def _make(linked: Symbols, number: int, values: Values, frame: Values, done: set[int]) -> None:
    if number in done:
        return
    done.add(number)
    slot = linked.slots[number]
    for needed in sorted(slot.needs):
        _make(linked, needed, values, frame, done)
    if slot.initial is None:
        return
    try:
        values[number] = slot.initial(frame)
        for assign in slot.assigns:
            assign(frame)
    except ProgramError as error:
        raise RunError(f"{slot.origin.place}the initial value of {slot.name}: {error.message}") from None


def _override(linked: Symbols, values: Values, machine: Machine, first: int) -> None:
    """Put in the values that the cell file gives."""
    for path, given in machine.cell.variables.items():
        for number in range(first, len(values)):
            slot = linked.slots[number]
            match = _split(path, slot.name, slot.qualified)
            if match is None:
                continue
            where = f"{machine.cell.path}: variables.{path}"
            value = _placed(values[number], match, given, where)
            try:
                values[number] = value if slot.fitted is None else slot.fitted(value)
            except ValueError as error:
                raise UsageError(f"{where}: {error}") from None


def _split(path: str, name: str, qualified: str) -> list[str | int] | None:
    """The steps behind the variable's name; None when the path names another variable."""
    lower = path.lower()
    for root in (qualified, name):
        wanted = root.lower()
        if lower == wanted or (lower.startswith(wanted) and lower[len(root)] in ".["):
            rest = path[len(root) :]
            return [int(m[1]) if m[1] else m[2].lower() for m in _STEP.finditer(rest)]
    return None


def _placed(old: Value, steps: list[str | int], given: Value, where: str) -> Value:
    """The value with the given one put in its place."""
    if not steps:
        return shaped(old, given, where)
    step, rest = steps[0], steps[1:]
    try:
        if isinstance(step, int):
            if not isinstance(old, Array):
                raise UsageError(f"{where}: [{step}] is no element of it")
            place = old.at(step)
            old.items[place] = _placed(old.items[place], rest, given, where)
            return old
        if isinstance(old, Record):
            held = _HOLDS_A_POSE.get(old.type_name)
            if step not in old.parts and held is not None:  # the pose of a tool or frame given where its data stands
                step, rest = held, [step, *rest]
            if step not in old.parts:
                raise UsageError(f"{where}: there is no component {step}")
            old.parts[step] = _placed(old.parts[step], rest, given, where)
            return old
        return old.replaced(step, _placed(old.get(step), rest, given, where))
    except (ProgramError, AttributeError, ValueError) as error:
        raise UsageError(f"{where}: {error}") from None


def shaped(old: Value, given: Value, where: str) -> Value:
    """A value of a TOML file in the shape of the variable that gets it."""
    if isinstance(given, dict):
        if old is None:
            return pose_from({key.lower(): value for key, value in given.items()}, "zyx")
        for key, value in given.items():
            old = _placed(old, [key.lower()], value, where)
        return old
    if isinstance(given, list):
        return _listed(old, given, where)
    if isinstance(old, bool) and not isinstance(given, bool):
        raise UsageError(f"{where}: must be true or false, not {given!r}")
    if isinstance(old, Member) and isinstance(given, str):
        return Member(given.lower().removeprefix("#"))
    if isinstance(old, int | float) and not isinstance(old, bool) and isinstance(given, str | bool):
        raise UsageError(f"{where}: must be a number, not {given!r}")
    return given


def _listed(old: Value, given: list[Value], where: str) -> Value:
    from rpl.runtime.functions.texts import parsed, value_text

    if isinstance(old, Array):
        if len(given) != len(old.items):
            raise UsageError(f"{where}: has {len(old.items)} elements, {len(given)} are given")
        return Array([shaped(o, g, where) for o, g in zip(old.items, given, strict=True)], old.base)
    if isinstance(old, VectorValue | PoseValue | RotationValue | TargetValue | JointsValue | Record):
        try:
            return parsed(value_text(Array(_arrays(given))), old)
        except (ValueError, ProgramError):
            raise UsageError(f"{where}: {given!r} has not the shape of the variable") from None
    raise UsageError(f"{where}: a list does not fit this variable")


def _arrays(given: list[Value]) -> list[Value]:
    return [Array(_arrays(each)) if isinstance(each, list) else each for each in given]

"""Values of a running program. Numbers, BOOLs and texts are Python's own; geometric values are immutable and keep the
convention they were given in, so that components read back exactly; records and arrays are mutable and are copied when
assigned. A component without a value is None.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any, NamedTuple

from rpl.passes import rigid
from rpl.runtime.faults import ProgramError

# Values travel between closures untyped: what they may be is decided by the source language's types, not by Python's.
Value = Any
Number = float | int
Numbers = tuple[float | None, ...]
UNUSED_AXIS = 9e8  # an external axis at or above this (9E9) is not there

_XYZ, _ABC, _QUATERNION = ("x", "y", "z"), ("a", "b", "c"), ("q1", "q2", "q3", "q4")
_EXTERNAL = ("e1", "e2", "e3", "e4", "e5", "e6")
_AXES = ("j1", "j2", "j3", "j4", "j5", "j6")
_NONE6: Numbers = (None,) * 6


class Member(str):
    """A member of an enumeration, or a mode word of a system variable; in lower case."""

    __slots__ = ()


class VectorValue(NamedTuple):
    x: float | None
    y: float | None
    z: float | None

    def __deepcopy__(self, memo: object) -> VectorValue:
        return self

    def get(self, name: str) -> Value:
        return self[_XYZ.index(name)]

    def replaced(self, name: str, value: Value) -> VectorValue:
        return self._replace(**{name: value})

    def __add__(self, other: VectorValue) -> VectorValue:  # type: ignore[override]  # of vectors, not tuples
        return VectorValue(*(p + q for p, q in zip(needed(self), needed(other), strict=True)))

    def __sub__(self, other: VectorValue) -> VectorValue:
        return VectorValue(*(p - q for p, q in zip(needed(self), needed(other), strict=True)))

    def __neg__(self) -> VectorValue:
        return VectorValue(*(-p for p in needed(self)))

    def __mul__(self, factor: float) -> VectorValue:  # type: ignore[override]  # of vectors, not tuples
        return VectorValue(*(p * factor for p in needed(self)))

    def __rmul__(self, factor: float) -> VectorValue:  # type: ignore[override]  # of vectors, not tuples
        return self * factor

    def __truediv__(self, divisor: float) -> VectorValue:
        return VectorValue(*(p / divisor for p in needed(self)))


class RotationValue(NamedTuple):
    """`convention`: quaternion (w, x, y, z) or zyx (angles a, b, c in degrees)."""

    convention: str
    parts: Numbers

    def __deepcopy__(self, memo: object) -> RotationValue:
        return self

    def get(self, name: str) -> Value:
        if name in _ABC:
            if self.convention == "zyx":
                return self.parts[_ABC.index(name)]
            return None if None in self.parts else self.rigid().zyx[_ABC.index(name)]
        if self.convention == "quaternion":
            return self.parts[_QUATERNION.index(name)]
        return None if None in self.parts else self.rigid().quaternion[_QUATERNION.index(name)]

    def replaced(self, name: str, value: Value) -> RotationValue:
        names, convention = (_ABC, "zyx") if name in _ABC else (_QUATERNION, "quaternion")
        parts = [self.get(each) for each in names]
        parts[names.index(name)] = value
        return RotationValue(convention, tuple(parts))

    def rigid(self) -> rigid.Rotation:
        parts = needed(self.parts)
        if self.convention == "zyx":
            return rigid.rotation_of_zyx(*parts)
        length = sum(part * part for part in parts)
        found = rigid.rotation_of_quaternion(*parts) if abs(length - 1.0) < 0.1 else None
        if found is None:
            raise ProgramError("bad_rotation", f"the quaternion has length {length**0.5:.4g}, but must have length 1")
        return found

    def same(self, other: Value) -> bool:
        if not isinstance(other, RotationValue):
            return False
        if self.convention == other.convention or None in self.parts or None in other.parts:
            return tuple(self) == tuple(other)
        return all(abs(p - q) < 1e-9 for p, q in zip(self.rigid().quaternion, other.rigid().quaternion, strict=True))


class PoseValue(NamedTuple):
    trans: VectorValue
    rot: RotationValue

    def __deepcopy__(self, memo: object) -> PoseValue:
        return self

    def get(self, name: str) -> Value:
        if name in _XYZ:
            return self.trans[_XYZ.index(name)]
        if name == "trans":
            return self.trans
        return self.rot if name == "rot" else self.rot.get(name)

    def replaced(self, name: str, value: Value) -> PoseValue:
        if name in _XYZ:
            return PoseValue(self.trans.replaced(name, value), self.rot)
        if name == "trans":
            return PoseValue(value, self.rot)
        return PoseValue(self.trans, value if name == "rot" else self.rot.replaced(name, value))

    def rigid(self) -> rigid.Pose:
        return rigid.Pose(rigid.Vector(*needed(self.trans)), self.rot.rigid())


class ConfigValue(NamedTuple):
    """Flags of a notation by name, in its order; None where a flag is not given."""

    notation: str
    flags: tuple[tuple[str, Value], ...]

    def __deepcopy__(self, memo: object) -> ConfigValue:
        return self

    def get(self, name: str) -> Value:
        return dict(self.flags).get(name)

    def replaced(self, name: str, value: Value) -> ConfigValue:
        return ConfigValue(self.notation, tuple((n, value if n == name else v) for n, v in self.flags))


class ExternalValue(NamedTuple):
    values: Numbers

    def __deepcopy__(self, memo: object) -> ExternalValue:
        return self

    def get(self, name: str) -> Value:
        return self.values[_EXTERNAL.index(name)]

    def replaced(self, name: str, value: Value) -> ExternalValue:
        return ExternalValue(_with(self.values, _EXTERNAL.index(name), value))


class AxesValue(NamedTuple):
    values: Numbers

    def __deepcopy__(self, memo: object) -> AxesValue:
        return self

    def get(self, name: str) -> Value:
        return self.values[_AXES.index(name)]

    def replaced(self, name: str, value: Value) -> AxesValue:
        return AxesValue(_with(self.values, _AXES.index(name), value))


class TargetValue(NamedTuple):
    pose: PoseValue
    conf: ConfigValue
    ext: ExternalValue

    def __deepcopy__(self, memo: object) -> TargetValue:
        return self

    def get(self, name: str) -> Value:
        if name == "conf":
            return self.conf
        if name == "ext":
            return self.ext
        if name in _EXTERNAL:
            return self.ext.get(name)
        return self.pose.get(name) if name in _POSE_NAMES else self.conf.get(name)

    def replaced(self, name: str, value: Value) -> TargetValue:
        if name == "conf":
            return TargetValue(self.pose, value, self.ext)
        if name == "ext":
            return TargetValue(self.pose, self.conf, value)
        if name in _EXTERNAL:
            return TargetValue(self.pose, self.conf, self.ext.replaced(name, value))
        if name in _POSE_NAMES:
            return TargetValue(self.pose.replaced(name, value), self.conf, self.ext)
        return TargetValue(self.pose, self.conf.replaced(name, value), self.ext)


class JointsValue(NamedTuple):
    axes: AxesValue
    ext: ExternalValue

    def __deepcopy__(self, memo: object) -> JointsValue:
        return self

    def get(self, name: str) -> Value:
        if name == "robax":
            return self.axes
        if name == "ext":
            return self.ext
        return self.axes.get(name) if name in _AXES else self.ext.get(name)

    def replaced(self, name: str, value: Value) -> JointsValue:
        if name == "robax":
            return JointsValue(value, self.ext)
        if name == "ext":
            return JointsValue(self.axes, value)
        if name in _AXES:
            return JointsValue(self.axes.replaced(name, value), self.ext)
        return JointsValue(self.axes, self.ext.replaced(name, value))


_POSE_NAMES = frozenset((*_XYZ, *_ABC, *_QUATERNION, "trans", "rot"))


class SignalRef(NamedTuple):
    """A physical signal as a value: kind, number (and last number of a group) or name."""

    kind: str
    number: int | None = None
    last: int | None = None
    name: str | None = None

    def __deepcopy__(self, memo: object) -> SignalRef:
        return self


class Record:
    """A record, tool, work object, load, speed or zone: components by name (folded where the language ignores case)."""

    __slots__ = ("parts", "type_name")

    def __init__(self, type_name: str, parts: dict[str, Value]) -> None:
        self.type_name = type_name
        self.parts = parts

    def get(self, name: str) -> Value:
        return self.parts[name]

    def copy(self) -> Record:
        return Record(self.type_name, {name: copied(value) for name, value in self.parts.items()})

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Record) and self.parts == other.parts

    __hash__ = None  # type: ignore[assignment]  # it changes

    def __repr__(self) -> str:
        return f"Record({self.type_name!r}, {self.parts!r})"


class Array:
    """An array; of more than one dimension: of arrays."""

    __slots__ = ("base", "items")

    def __init__(self, items: list[Value], base: int = 1) -> None:
        self.items = items
        self.base = base

    def copy(self) -> Array:
        items = self.items
        if items and items[0].__class__ in MUTABLE:
            return Array([item.copy() for item in items], self.base)
        return Array(items[:], self.base)

    def at(self, index: Value) -> int:
        """The place of an element; raises the program's own error when there is none."""
        place: int = (index if index.__class__ is int else whole(index)) - self.base
        if 0 <= place < len(self.items):
            return place
        last = self.base + len(self.items) - 1
        raise ProgramError("out_of_range", f"index {index} is outside {self.base}..{last}")

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Array) and self.items == other.items

    __hash__ = None  # type: ignore[assignment]  # it changes

    def __repr__(self) -> str:
        return f"Array({self.items!r}, {self.base})"


class StopWatch:
    """A clock variable: seconds counted up to `since`, and running from there when `running`."""

    __slots__ = ("counted", "running", "since")

    def __init__(self, counted: float = 0.0, since: float = 0.0, running: bool = False) -> None:
        self.counted = counted
        self.since = since
        self.running = running

    def copy(self) -> StopWatch:
        return StopWatch(self.counted, self.since, self.running)

    def seconds(self, now: float) -> float:
        return self.counted + (now - self.since if self.running else 0.0)


MUTABLE: frozenset[Any] = frozenset((Record, Array, StopWatch))
STRUCTURED: frozenset[Any] = frozenset(
    (
        *(VectorValue, RotationValue, PoseValue, ConfigValue, ExternalValue, AxesValue, TargetValue, JointsValue),
        *(Record, Array),
    )
)


def copied(value: Value) -> Value:
    """The value to store: records and arrays are copied on assignment."""
    return value.copy() if value.__class__ in MUTABLE else value


def _with(values: Numbers, place: int, value: Value) -> Numbers:
    return (*values[:place], value, *values[place + 1 :])


def needed(parts: tuple[float | None, ...]) -> list[float]:
    """Numbers of which none may be missing."""
    found = [part for part in parts if part is not None]
    if len(found) != len(parts):
        raise ProgramError("no_value", "a component of the pose has no value")
    return found


def whole(value: Value) -> int:
    """A number that must be whole (an index, a count)."""
    if value.__class__ is int or value.__class__ is bool:
        return int(value)
    if isinstance(value, float) and value.is_integer():
        return int(value)
    if value is None:
        raise ProgramError("no_value", "a number is needed, but there is no value")
    raise ProgramError("not_whole", f"a whole number is needed, not {value!r}")


def equal(left: Value, right: Value) -> bool:
    """Equality as languages have it: structures by components, rotations by what they mean."""
    if left is None or right is None:
        raise ProgramError("no_value", "a compared value has no value yet")
    kind = left.__class__
    if kind is RotationValue:
        return bool(left.same(right))
    if kind is PoseValue and right.__class__ is PoseValue:
        return bool(left.trans == right.trans and left.rot.same(right.rot))
    if kind is TargetValue and right.__class__ is TargetValue:
        return equal(left.pose, right.pose) and left.conf == right.conf and left.ext == right.ext
    return bool(left == right)


def is_unset(value: Value) -> bool:
    """Has it no value: a scalar without one, or a structure of which no component has one."""
    if value is None:
        return True
    kind = value.__class__
    if kind is Record:
        return all(is_unset(part) for part in value.parts.values())
    if kind is Array:
        return all(is_unset(item) for item in value.items)
    if kind is ConfigValue:
        return all(flag is None for _, flag in value.flags)
    if kind is TargetValue:
        return is_unset(value.pose)
    if kind is RotationValue:
        return all(part is None for part in value.parts)
    if kind in STRUCTURED:
        return all(is_unset(part) for part in value)
    return False


def vector_of(vector: rigid.Vector) -> VectorValue:
    return VectorValue(vector.x, vector.y, vector.z)


def rotation_of(rotation: rigid.Rotation, convention: str) -> RotationValue:
    """A computed rotation in the convention that its neighbours are written in."""
    if convention == "zyx":
        return RotationValue("zyx", rotation.zyx)
    return RotationValue("quaternion", rotation.quaternion)


def pose_of(pose: rigid.Pose, convention: str) -> PoseValue:
    return PoseValue(vector_of(pose.position), rotation_of(pose.rotation, convention))


def numbers(names: tuple[str, ...], parts: Mapping[str, Value]) -> Numbers:
    return tuple(parts.get(name) for name in names)


def rotation_from(parts: Mapping[str, Value], convention: str) -> RotationValue:
    """The rotation among named components; without any of them an empty one in the given convention."""
    if any(name in parts for name in _QUATERNION):
        return RotationValue("quaternion", numbers(_QUATERNION, parts))
    if any(name in parts for name in _ABC) or convention == "zyx":
        return RotationValue("zyx", numbers(_ABC, parts))
    return RotationValue("quaternion", (None,) * 4)


def pose_from(parts: Mapping[str, Value], convention: str) -> PoseValue:
    trans, rot = parts.get("trans"), parts.get("rot")
    return PoseValue(
        trans if trans is not None else VectorValue(*numbers(_XYZ, parts)),
        rot if rot is not None else rotation_from(parts, convention),
    )


def external_from(parts: Mapping[str, Value]) -> ExternalValue:
    found = parts.get("ext")
    return found if found is not None else ExternalValue(numbers(_EXTERNAL, parts))


def target_from(parts: Mapping[str, Value], notation: str, flags: tuple[str, ...], convention: str) -> TargetValue:
    conf = parts.get("conf")
    if conf is None:
        conf = ConfigValue(notation, tuple((flag, parts.get(flag)) for flag in flags))
    return TargetValue(pose_from(parts, convention), conf, external_from(parts))


def joints_from(parts: Mapping[str, Value]) -> JointsValue:
    axes = parts.get("robax")
    return JointsValue(axes if axes is not None else AxesValue(numbers(_AXES, parts)), external_from(parts))


def axes_from(parts: Mapping[str, Value]) -> AxesValue:
    return AxesValue(numbers(_AXES, parts))


def vector_from(parts: Mapping[str, Value]) -> VectorValue:
    return VectorValue(*numbers(_XYZ, parts))


def used_axes(values: Numbers) -> Numbers:
    """External axes with those that are not there as None."""
    return tuple(None if value is None or abs(value) >= UNUSED_AXIS else float(value) for value in values)


Reader = Callable[[list[Value]], Value]

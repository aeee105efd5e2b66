"""How far two values of one datum are apart, in words and numbers: millimetres and degrees for places, the rest as old
and new."""

from __future__ import annotations

import math
import re
from collections.abc import Iterator

from rpl import ir
from rpl.comparing.changes import Moved
from rpl.passes import rigid
from rpl.passes.fold import constant, constant_number
from rpl.passes.scope import Scope
from rpl.passes.values import Record, Target, Value

# Values closer than this are one value: what is left when a number is written with another spelling or unit.
_CLOSE = 1e-9
# A coordinate from here on says "not used" (RAPID 9E9).
_UNSET = 1e9
_JOINT = re.compile(r"j\d+")

Told = tuple[tuple[str, ...], Moved | None]


def known(expression: ir.Expression | None, scope: Scope) -> Value | None:
    """The value of an expression that is known here; of places also by a rotation vector, which no pass evaluates."""
    if expression is None:
        return None
    match expression:
        case ir.Builtin(function="pose_from_rotation_vector", arguments=arguments):
            numbers = [constant_number(one, scope) for one in arguments]
            x, y, z, *turn = [one for one in numbers if one is not None] if None not in numbers else [0.0] * 3
            return rigid.Pose(rigid.Vector(x, y, z), _turned(turn)) if len(turn) == 3 else None
    return constant(expression, scope)


def _turned(vector_deg: list[float]) -> rigid.Rotation:
    """The rotation of a rotation vector: its direction is the axis, its length the angle."""
    angle = math.hypot(*vector_deg)
    half = math.radians(angle) / 2
    share = math.sin(half) / angle if angle > _CLOSE else 0.0
    x, y, z = (part * share for part in vector_deg)
    return rigid.rotation_of_quaternion(math.cos(half), x, y, z) or rigid.NO_TURN


def value_change(old: Value, new: Value) -> Told | None:
    """What has changed, in words, and how far a place has moved; None when both are the same."""
    match old, new:
        case (rigid.Pose() | Target(), rigid.Pose() | Target()):
            return _place(old, new)
        case Record(), Record() if isinstance(old.type, ir.JointsType | ir.AxesType):
            return _joints(old, new)
    words = tuple(_words("", old, new))
    return (words, None) if words else None


def _pose(value: rigid.Pose | Target) -> rigid.Pose:
    return value.pose if isinstance(value, Target) else value


def _place(old: rigid.Pose | Target, new: rigid.Pose | Target) -> Told | None:
    one, other = _pose(old), _pose(new)
    words = list(_moved_words(one, other))
    moved = None
    if words:
        step = other.position.plus(one.position, -1.0)
        turn = one.rotation.inverse.then(other.rotation).angle
        moved = Moved(step.length, (step.x, step.y, step.z), turn)
    if isinstance(old, Target) and isinstance(new, Target):
        flags = list(_numbers(old.flags, new.flags))
        if flags:
            words.append("configuration: " + ", ".join(f"{name} {_text(a)} → {_text(b)}" for name, a, b in flags))
        words += [_step(name, a, b) for name, a, b in _numbers(old.external, new.external)]
    elif isinstance(old, Target) is not isinstance(new, Target):
        words.append("a place with a configuration is now one without, or the other way round")
    return (tuple(words), moved) if words else None


def _moved_words(one: rigid.Pose, other: rigid.Pose) -> Iterator[str]:
    step = other.position.plus(one.position, -1.0)
    turn = one.rotation.inverse.then(other.rotation).angle
    if step.length > _CLOSE:
        axes = [f"{name} {_signed(way)}" for name, way in zip("xyz", (step.x, step.y, step.z), strict=True) if way]
        yield f"moved {_length(step.length)} mm ({', '.join(axes)})"
    if turn > 1e-6:  # degrees; less is what the conversion between conventions leaves
        yield f"turned {_length(turn)}°"


def _joints(old: Record, new: Record) -> Told | None:
    pairs = list(_numbers(tuple(_leaves(old)), tuple(_leaves(new))))
    if not pairs:
        return None
    axes = tuple((name, b - a) for name, a, b in pairs if a is not None and b is not None)
    turned = [f"{name} {_signed(way)}°" for name, way in axes if _JOINT.fullmatch(name)]
    words = [f"axes {', '.join(turned)}"] if turned else []
    words += [_step(name, a, b) for name, a, b in pairs if a is None or b is None or not _JOINT.fullmatch(name)]
    return tuple(words), Moved(axes=axes)


def _leaves(record: Record) -> Iterator[tuple[str, float]]:
    for name, value in record.parts:
        if isinstance(value, Record):
            yield from _leaves(value)
        elif isinstance(value, int | float):
            yield name, float(value)


def _numbers(
    old: tuple[tuple[str, float], ...], new: tuple[tuple[str, float], ...]
) -> Iterator[tuple[str, float | None, float | None]]:
    """Numbers by name that differ; None where one side has none."""
    here, there = dict(old), dict(new)
    for name in dict.fromkeys((*here, *there)):
        a, b = here.get(name), there.get(name)
        if a is None or b is None or abs(a - b) > _CLOSE * max(1.0, abs(a), abs(b)):
            yield name, a, b


def _words(path: str, old: Value, new: Value) -> Iterator[str]:
    """What differs in a structured value, part by part."""
    head = f"{path} " if path else ""
    match old, new:
        case Record(), Record():
            here, there = dict(old.parts), dict(new.parts)
            for name in dict.fromkeys((*here, *there)):
                inner = f"{path}.{name}" if path else name
                if name in here and name in there:
                    yield from _words(inner, here[name], there[name])
                else:
                    yield f"{inner} {'added' if name in there else 'removed'}"
        case (rigid.Pose() | Target(), rigid.Pose() | Target()):
            told = _place(old, new)
            yield from (f"{head}{word}" for word in (told[0] if told else ()))
        case rigid.Vector(), rigid.Vector():
            yield from (f"{head}{word}" for word in _moved_words(_at(old), _at(new)))
        case rigid.Rotation(), rigid.Rotation():
            zero = rigid.Vector(0.0, 0.0, 0.0)
            yield from (f"{head}{word}" for word in _moved_words(rigid.Pose(zero, old), rigid.Pose(zero, new)))
        case tuple(), tuple():
            for at, (one, other) in enumerate(zip(old, new, strict=False), 1):
                yield from _words(f"{path}[{at}]", one, other)
            if len(old) != len(new):
                yield f"{head}{len(old)} elements → {len(new)}"
        case (bool() | int() | float() | str(), bool() | int() | float() | str()):
            if not _equal(old, new):
                yield f"{head}{_text(old)} → {_text(new)}"
        case _:
            if old != new:
                yield f"{head}{_text(old)} → {_text(new)}"


def _at(vector: rigid.Vector) -> rigid.Pose:
    return rigid.Pose(vector, rigid.NO_TURN)


def _equal(one: bool | float | str, other: bool | float | str) -> bool:
    if isinstance(one, str | bool) or isinstance(other, str | bool):
        return type(one) is type(other) and one == other
    return abs(one - other) <= _CLOSE * max(1.0, abs(one), abs(other))


def _step(name: str, old: float | None, new: float | None) -> str:
    if old is not None and new is not None and min(abs(old), abs(new)) >= _UNSET:
        return f"{name} {old:.10g} → {new:.10g}"
    return f"{name} {_text(old)} → {_text(new)}"


def _text(value: object) -> str:
    match value:
        case None:
            return "nothing"
        case bool():
            return "true" if value else "false"
        case float() if abs(value) >= _UNSET:
            return "unset"
        case int() | float():
            return f"{value:.10g}"
        case str():
            return f'"{value}"'
    return getattr(value, "name", None) or type(value).__name__.lower()


def _length(value: float) -> str:
    """A size with as many digits as it needs."""
    return f"{value:.2f}" if value >= 0.01 else f"{value:.2g}"


def _signed(value: float) -> str:
    rounded = round(value, 4)
    return f"{rounded:+.10g}" if rounded else f"{value:+.2g}"

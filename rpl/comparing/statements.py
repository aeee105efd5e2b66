"""What has changed in one statement: of a move its place, speed, corner, tool; of others what they are about."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, fields

from rpl import ir
from rpl.comparing.changes import Moved
from rpl.comparing.values import known, value_change
from rpl.ir.walk import is_expression, walk
from rpl.passes.fold import is_taught_type
from rpl.passes.scope import Scope
from rpl.passes.values import Value

_SPEEDS = frozenset(
    (
        *("path_speed", "path_acceleration", "swivel_speed", "twist_speed", "swivel_acceleration", "path_jerk"),
        *("twist_acceleration", "joint_speed", "joint_acceleration", "external_speed", "external_acceleration"),
        *("blend_distance", "blend_rotation", "blend_speed", "blend_joint", "override", "speed_percent", "speed_limit"),
        *("acceleration_percent", "acceleration_ramp", "deceleration_percent", "stop_ramp", "move_duration"),
    )
)
_SELECTED = {"tool": "tool", "base": "frame", "displacement": "frame", "robot_root": "frame", "load": "load"}
_UNITS = {
    "path": "mm/s",
    "rotation": "deg/s",
    "joint": "%",
    "axis": "deg/s",
    "duration": "s",
    "path_acceleration": "mm/s2",
    "axis_acceleration": "deg/s2",
    "distance": "mm",
    "percent": "%",
    "acceleration": "%",
}
_BLENDS = {
    ir.BlendStop: "exact stop",
    ir.BlendDistance: "corner by distance",
    ir.BlendPercent: "corner by percentage",
    ir.BlendSpeed: "corner by speed",
    ir.BlendZone: "zone",
    ir.BlendLevel: "corner level",
}


@dataclass(frozen=True, slots=True)
class Told:
    """What a change of a statement is about, in words; how far a place in it has moved; the name of the place that it
    assigns."""

    kind: str
    words: tuple[str, ...] = ()
    moved: Moved | None = None
    name: str = ""


def kind_of(nodes: tuple[object, ...]) -> str:
    """What a statement is about: io when it has to do with signals, speed and frame for settings, else logic."""
    for node in nodes:
        match node:
            case ir.Assign(target=ir.System(name=name)) | ir.SetForNextMove(setting=ir.System(name=name)):
                if name in _SPEEDS:
                    return "speed"
                if name in _SELECTED:
                    return _SELECTED[name]
    return "io" if any(isinstance(one, ir.Signal) for one in walk(nodes)) else "logic"


def change_told(old: tuple[object, ...], new: tuple[object, ...], before: Scope, after: Scope) -> Told:
    """What has changed from a statement to the one that stands in its place."""
    if len(old) == len(new):
        pairs = [(one, other) for one, other in zip(old, new, strict=True) if one != other]
        if len(pairs) == 1:
            match pairs[0]:
                case ir.Move() as one, ir.Move() as other:
                    return _move(one, other, before, after)
                case ir.Assign() as one, ir.Assign() as other if one.target == other.target:
                    return _assignment(one, other, before, after)
    return Told(kind_of(new) if kind_of(new) != "logic" else kind_of(old))


def _assignment(old: ir.Assign, new: ir.Assign, before: Scope, after: Scope) -> Told:
    kind = kind_of((new,))
    one, other = known(old.value, before), known(new.value, after)
    if one is None or other is None:
        return Told(kind)
    name = ""
    symbol = after.value(new.target.id) if isinstance(new.target, ir.Name) else None
    if isinstance(new.target, ir.Name) and symbol is not None and is_taught_type(symbol.type, after):
        kind, name = taught_kind(symbol.type, after), new.target.id
    words, moved = value_change(one, other) or ((), None)
    return Told(kind, words, moved, name)


def goals(*programs: ir.Program) -> frozenset[str]:
    """Names that moves go to, in small letters."""
    found: set[str] = set()
    for program in programs:
        for node in walk(program.modules):
            move = node.sample if isinstance(node, ir.Run) else node
            if isinstance(move, ir.Move):
                at = move.target
                while isinstance(at, ir.Builtin) and at.arguments:
                    at = at.arguments[0]
                found |= {one.id.lower() for one in (at, move.via) if isinstance(one, ir.Name)}
    return frozenset(found)


def taught_kind(type: ir.Type, scope: Scope) -> str:
    """What data of this type is: a point, a frame, a tool, a load, a speed or zone, or any data."""
    resolved = scope.resolve(type)
    while isinstance(resolved, ir.ArrayType):
        resolved = scope.resolve(resolved.element)
    match resolved:
        case ir.TargetType() | ir.JointsType() | ir.AxesType():
            return "point"
        case ir.PoseType() | ir.WorkObjectType():
            return "frame"
        case ir.ToolType():
            return "tool"
        case ir.LoadType():
            return "load"
        case ir.SpeedType() | ir.ZoneType():
            return "speed"
        case ir.SignalType():
            return "io"
    return "data"


def _move(old: ir.Move, new: ir.Move, before: Scope, after: Scope) -> Told:
    kinds: dict[str, None] = {}
    words: list[str] = []
    moved: Moved | None = None
    for name in [one.name for one in fields(ir.Move) if one.name != "origin"]:
        one, other = getattr(old, name), getattr(new, name)
        if one == other:
            continue
        if name in ("target", "via"):
            told = _goal(name, one, other, before, after)
            moved = told.moved or moved
        elif name in ("speed", "blend", "acceleration"):
            told = Told("speed", tuple(_settings(name, one, other, before, after)))
        elif name in ("tool", "frame", "load"):
            told = Told(name, (f"{name} {_named(one)} → {_named(other)}",))
        else:
            told = Told("logic", (f"{name.replace('_', ' ')}: {_plain(one)} → {_plain(other)}",))
        kinds[told.kind] = None
        words += told.words
    first = next((kind for kind in ("logic", "point", "frame", "tool", "load", "speed") if kind in kinds), "logic")
    return Told(first, tuple(word for word in words if word), moved)


def _goal(name: str, old: object, new: object, before: Scope, after: Scope) -> Told:
    if isinstance(old, ir.Name) and isinstance(new, ir.Name):
        return Told("logic", (f"goes {'by' if name == 'via' else 'to'} {new.id}, not {old.id}",))
    one, other = _value(old, before), _value(new, after)
    told = value_change(one, other) if one is not None and other is not None else None
    return Told("point", *told) if told is not None else Told("logic")


def _settings(name: str, old: object, new: object, before: Scope, after: Scope) -> Iterator[str]:
    """What of a speed or a corner has changed."""
    if is_expression(old) and is_expression(new):
        yield _number(name, old, new, before, after)
        return
    if type(old) is not type(new) or not isinstance(old, ir.Speed | _SOME_BLENDS):
        yield f"{_corner(old, before)} → {_corner(new, after)}"
        return
    for part in fields(old):
        one, other = getattr(old, part.name), getattr(new, part.name)
        if one != other:
            yield _number(part.name, one, other, before, after)


_SOME_BLENDS = ir.BlendDistance | ir.BlendPercent | ir.BlendSpeed | ir.BlendZone | ir.BlendLevel


def _corner(blend: object, scope: Scope) -> str:
    if blend is None:
        return "as set before"
    if isinstance(blend, ir.Speed):
        return "a speed of its own"
    word = _BLENDS.get(type(blend), "corner")
    parts = [getattr(blend, one.name) for one in fields(blend)] if isinstance(blend, _SOME_BLENDS) else []
    return " ".join([word, *(_told_number(one, scope) for one in parts[:1] if one is not None)])


def _number(name: str, old: object, new: object, before: Scope, after: Scope) -> str:
    unit = _UNITS.get(name, "")
    word = {"path": "speed", "rotation": "turning speed", "joint": "speed", "axis": "axis speed", "profile": "speed"}
    one, other = _told_number(old, before), _told_number(new, after)
    return f"{word.get(name, name.replace('_', ' '))} {one} → {other}{' ' if unit else ''}{unit}"


def _told_number(expression: object, scope: Scope) -> str:
    if isinstance(expression, ir.Name):
        return expression.id
    value = _value(expression, scope)
    return f"{value:.10g}" if isinstance(value, int | float) else _named(expression)


def _value(expression: object, scope: Scope) -> Value | None:
    return known(expression, scope) if is_expression(expression) else None


def _named(expression: object) -> str:
    match expression:
        case None:
            return "none"
        case ir.Name(id=name):
            return name
        case ir.System(name=name):
            return name
        case ir.Index(base=ir.Name(id=name), indices=(ir.IntLiteral(value=number),)):
            return f"{name}[{number}]"
    return "another value"


def _plain(value: object) -> str:
    if value is None or isinstance(value, str | bool | int):
        return "none" if value is None else str(value)
    return _named(value)

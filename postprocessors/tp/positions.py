"""Taught positions of one program: their numbers, their values and their text in /POS.

A position says in which user frame and tool it was taught, and the controller refuses it with any other. So the numbers
are written where every move to it has the same ones, and F (whatever is active) where they differ.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, field, replace
from itertools import repeat
from typing import NamedTuple

from rpl import ir
from rpl.passes.fold import constant
from rpl.passes.scope import Scope
from rpl.passes.values import Record, Target, pose_of
from rpl.source import NOWHERE, Origin
from rpl.writing.statements import CannotSayError
from rpl.writing.text import number_text

from . import tables
from .configuration import FLAGS, config_text
from .expressions import constant as number_of
from .texts import comment

_EXTERNAL = ("e1", "e2", "e3", "e4", "e5", "e6")
_POINT = re.compile(r"P\[?(\d+)\]?", re.IGNORECASE)
_POINT_TEXT = re.compile(r"\s*P\s*\[", re.IGNORECASE)
_FRAMES = re.compile(r"\bUF\s*:\s*(\w+)\s*,\s*UT\s*:\s*(\w+)", re.IGNORECASE)
_EXTENDED = re.compile(r"\bE\d\s*=", re.IGNORECASE)
_UNSET = 8e9  # RAPID's mark of an external axis that is not there
_DECIMALS, _MOST_DECIMALS = 3, 6


@dataclass(frozen=True, slots=True)
class Position:
    """kind: pose (x y z a b c; mm, deg), joints (own units) or none (never taught)."""

    kind: str
    values: tuple[float, ...] = ()
    flags: tuple[tuple[str, int], ...] = ()
    external: tuple[float, ...] = ()

    def with_flags(self, flags: Mapping[str, int]) -> Position:
        return Position(self.kind, self.values, tuple(flags.items()), self.external)


@dataclass(frozen=True, slots=True)
class Recorded:
    """What a point of a listing said besides its values: frame and tool, how many extended axes its first group has,
    the text of its further groups."""

    frame: str
    tool: str
    externals: int
    groups: str


def _recorded(text: str) -> Recorded | None:
    found = _FRAMES.search(text) if _POINT_TEXT.match(text) else None
    if found is None:
        return None
    arm, mark, others = text.partition("GP2")
    groups = f"{mark}{others}".rpartition("}")[0].strip() if mark else ""
    return Recorded(found[1].upper(), found[2].upper(), len(_EXTENDED.findall(arm)), groups)


class Reached(NamedTuple):
    """A move to the point of that number, with frame and tool by number ('': not known). `joint`: by its axes, so that
    it takes the turns that the point tells; a path leaves each axis in the turn it is in. `origin`: where the source
    says so."""

    number: int
    frame: str
    tool: str
    joint: bool
    origin: Origin = NOWHERE


@dataclass(slots=True)
class Points:
    """The positions of one program by number. `axes`: how many external axes the program moves; the first `extended` of
    them are the arm's extended axes, the others are those of the second motion group."""

    found: dict[int, Position] = field(default_factory=dict)
    labels: dict[int, str] = field(default_factory=dict)
    frames: dict[int, set[tuple[str, str]]] = field(default_factory=dict)
    anonymous: dict[Position, int] = field(default_factory=dict)
    recorded: dict[int, Recorded] = field(default_factory=dict)
    order: list[Reached] = field(default_factory=list)
    axes: int = 0
    extended: int = 0

    def declare(self, variable: ir.Variable, scope: Scope, step: bool = False) -> int:
        """A variable that is a point: by the number in its name. `step`: it is the way of relative moves, where what is
        left out is zero."""
        number = point_number(variable.name)
        if number is None or number in self.found:
            raise CannotSayError(f"{variable.name} is no number of a point")
        recorded = _recorded(variable.origin.text)
        if variable.initial is None:
            self.found[number] = Position("none")
        elif step and recorded is None:
            self.found[number] = step_of(variable.initial)
        else:
            self.found[number] = position_of(variable.initial, scope)
        if recorded is not None:
            self.recorded[number] = recorded
        label = comment(variable.label) if recorded is None else variable.label
        if label:
            self.labels[number] = label
        return number

    def declare_rows(self, rows: ir.VariableRows, scope: Scope) -> None:
        """Variables that are points, as `declare` takes each."""
        numbers = rows.numbers.tolist()
        found = positions_of_rows(rows)
        ends = (0, len(numbers) - 1)
        if found is None or any(found[at] != position_of(_value(rows.variable(at)), scope) for at in ends):
            found = [position_of(_value(one), scope) for one in rows.variables()]
        if not self.found.keys().isdisjoint(numbers):
            raise CannotSayError(f"{rows.name} is a number that another point has")
        self.found.update(zip(numbers, found, strict=True))

    def add(self, position: Position) -> int:
        """The number of a value without a name; equal values share one."""
        known = self.anonymous.get(position)
        if known is not None:
            return known
        number = next(n for n in range(tables.POINTS.first, tables.POINTS.last + 2) if n not in self.found)
        if number > tables.POINTS.last:
            raise CannotSayError("there are no more numbers for points")
        self.found[number] = position
        self.anonymous[position] = number
        return number

    def used(self, number: int, frame: str, tool: str, joint: bool = True, origin: Origin = NOWHERE) -> None:
        """A move goes to the point with this frame and tool in force ('': not known); `joint`: by its axes."""
        self.frames.setdefault(number, set()).add((frame or "F", tool or "F"))
        self.order.append(Reached(number, frame, tool, joint, origin))

    def used_as(self, like: Reached, numbers: list[int], origins: Iterable[Origin]) -> None:
        """Moves go to these points as that one did."""
        for number in numbers:
            self.frames.setdefault(number, set()).add((like.frame or "F", like.tool or "F"))
        self.order += map(Reached, numbers, repeat(like.frame), repeat(like.tool), repeat(like.joint), origins)

    def place(self, number: int) -> str:
        label = self.labels.get(number, "")
        return f"P[{number}{':' + label if label else ''}]"

    def text(self) -> Iterator[str]:
        for number in sorted(self.found):
            uses = self.frames.get(number, set())
            frame, tool = next(iter(uses)) if len(uses) == 1 else ("F", "F")
            position, further = self.found[number], ""
            known = self.recorded.get(number)
            if known is not None:
                frame, tool = known.frame, known.tool
                position = replace(position, external=position.external[: known.externals])
                further = _further_groups(known.groups.splitlines())
            elif position.external:
                beyond = position.external[self.extended : self.axes]
                position = replace(position, external=position.external[: min(self.extended, self.axes)])
                further = _further_groups(_second_group(beyond, frame, tool)) if beyond else ""
            label = self.labels.get(number, "")
            name = f"{number}:{chr(34)}{label}{chr(34)}" if label else number
            yield f"P[{name}]{{\n   GP1:\n{_text(position, frame, tool)}\n{further}}};"


def _further_groups(lines: Iterable[str]) -> str:
    """Groups of axes behind the first."""
    return "".join(f"   {one.strip()}\n" if one.strip()[:2] == "GP" else f"\t{one.strip()}\n" for one in lines)


def point_number(name: str) -> int | None:
    match = _POINT.fullmatch(name)
    return int(match[1]) if match else None


def step_of(value: ir.Expression, turned: bool = False) -> Position:
    """The way of a relative move; components that are left out are zero. INC adds component by component, so a turn in
    degrees is something else than a composed one (`turned`: it may have one)."""
    if not isinstance(value, ir.Aggregate):
        raise CannotSayError("the way of a relative move that is computed")
    parts = flat(value)
    names = ir.AXES if set(ir.AXES) & set(parts) else ir.POSE
    values = numbers({**dict.fromkeys(names, ir.RealLiteral(0.0)), **parts}, names)
    if names == ir.POSE and any(values[3:]) and not turned:
        raise CannotSayError("INC adds angles one by one; a turned relative move is something else")
    return Position("joints" if names == ir.AXES else "pose", tuple(values))


def position_of(value: ir.Expression, scope: Scope) -> Position:
    """The position of a constant value. Raises CannotSayError when it is computed or lacks components."""
    parts = flat(value)
    if set(ir.AXES) & set(parts):
        found = ir.AXES[: 6 if "j6" in parts or len(parts) > 5 else 4]
        return Position("joints", tuple(numbers(parts, found)), (), external(parts))
    if set(parts) >= set(ir.POSE):
        angles = [_turned(one) for one in numbers(parts, ir.POSE[3:])]
        return Position("pose", (*numbers(parts, ir.POSE[:3]), *angles), _flags(parts), external(parts))
    folded = constant(value, scope)
    pose = pose_of(folded)
    if pose is not None:
        x, y, z = pose.position.x, pose.position.y, pose.position.z
        a, b, c = pose.rotation.zyx
        flags = folded.flags if isinstance(folded, Target) else ()
        more = _in_order(dict(folded.external)) if isinstance(folded, Target) else ()
        return Position("pose", (x, y, z, a, b, c), flags, more)
    if isinstance(folded, Record) and isinstance(folded.type, ir.JointsType):
        axes = folded.part("robax")
        source = axes if isinstance(axes, Record) else folded
        given = [source.part(name) for name in ir.AXES]
        values = tuple(float(one) for one in given if isinstance(one, int | float))
        return Position("joints", values, (), _further(folded))
    raise CannotSayError("a position with computed or missing components")


def positions_of_rows(rows: ir.VariableRows) -> list[Position] | None:
    """Positions whose components are written out, as `position_of` takes each; None for others."""
    parts = flat(rows.sample.initial) if rows.sample.initial is not None else {}
    joints = bool(set(ir.AXES) & set(parts))
    names = ir.AXES[: 6 if "j6" in parts or len(parts) > 5 else 4] if joints else ir.POSE
    given = (*names, *FLAGS)
    cells = {id(parts[name]) for name in given if name in parts} & rows.cells.by_identity.keys()
    if not set(names) <= set(parts) or len(cells) < len(rows.cells.by_identity):
        return None
    columns = {name: _column(parts[name], rows) for name in given if name in parts}
    for name in () if joints else ir.POSE[3:]:
        columns[name] = list(map(_turned, columns[name]))
    values: Iterable[tuple[float, ...]] = zip(*(columns[name] for name in names), strict=True)
    more = external(parts)
    if joints:
        return [Position("joints", one, (), more) for one in values]
    flagged = [name for name in FLAGS if name in parts]
    if not flagged:
        return [Position("pose", one, (), more) for one in values]
    flags = zip(*(map(int, columns[name]) for name in flagged), strict=True)
    known: dict[tuple[int, ...], tuple[tuple[str, int], ...]] = {}
    return [
        Position("pose", one, known.setdefault(row, tuple(zip(flagged, row, strict=True))), more)
        for one, row in zip(values, flags, strict=True)
    ]


def _column(part: ir.Expression, rows: ir.VariableRows) -> list[float]:
    cell = rows.cells.by_identity.get(id(part))
    if cell is not None:
        return list(map(float, cell.signed_numbers(rows.moves)))
    (value,) = numbers({"": part}, ("",))
    return [value] * len(rows.moves)


def _value(variable: ir.Variable) -> ir.Expression:
    if variable.initial is None:
        raise CannotSayError(f"{variable.name} has no value")
    return variable.initial


def flat(value: ir.Expression) -> dict[str, ir.Expression]:
    """Components by name; those of nested parts beside the others."""
    found: dict[str, ir.Expression] = {}
    if isinstance(value, ir.Aggregate):
        for name, entry in value.entries:
            if isinstance(entry, ir.Aggregate):
                found.update(flat(entry))
            elif name is not None:
                found[name.lower()] = entry
    return found


def numbers(parts: Mapping[str, ir.Expression], names: tuple[str, ...]) -> list[float]:
    found = []
    for name in names:
        value = number_of(parts[name]) if name in parts else None
        if value is None:
            raise CannotSayError(f"the component {name} of a position is computed or missing")
        found.append(float(value))
    return found


def external(parts: Mapping[str, ir.Expression]) -> tuple[float, ...]:
    """Positions of external axes; those that are not there are left out."""
    return _in_order({name: number_of(parts[name]) for name in _EXTERNAL if name in parts})


def _further(joints: Record) -> tuple[float, ...]:
    """External axes of joint data."""
    inner = joints.part("ext")
    source = inner if isinstance(inner, Record) else joints
    given = {name: source.part(name) for name in _EXTERNAL}
    return _in_order({name: one if isinstance(one, int | float) else None for name, one in given.items()})


def _in_order(given: Mapping[str, float | None]) -> tuple[float, ...]:
    """Values up to the last axis that is there; one before it that is not has no place in a position."""
    values = {name: float(one) for name, one in given.items() if one is not None and abs(one) < _UNSET}
    last = max((_EXTERNAL.index(name) + 1 for name in values), default=0)
    for name in _EXTERNAL[:last]:
        if name not in values:
            raise CannotSayError(f"external axis {last} without external axis {name[1:]}")
    return tuple(values[name] for name in _EXTERNAL[:last])


def _second_group(axes: tuple[float, ...], frame: str, tool: str) -> Iterator[str]:
    """M: axes of a positioner are written as turning ones."""
    yield "   GP2:"
    yield f"\tUF : {frame}, UT : {tool},"
    yield "\t" + ",\t".join(f"J{number}= {_number(value)} deg" for number, value in enumerate(axes, 1))


def _flags(parts: Mapping[str, ir.Expression]) -> tuple[tuple[str, int], ...]:
    found = {name: number_of(parts[name]) for name in FLAGS if name in parts}
    return tuple((name, int(value)) for name, value in found.items() if value is not None)


def _turned(degrees: float) -> float:
    """The angle within half a turn."""
    if -180 <= degrees <= 180:
        return degrees
    return (degrees + 180) % 360 - 180


def _text(position: Position, frame: str, tool: str) -> str:
    """The lines of the first group."""
    head = f"\tUF : {frame}, UT : {tool},"
    more = [f"E{number}= {_number(value)}  mm" for number, value in enumerate(position.external, 1)]
    if position.kind == "pose":
        x, y, z, a, b, c = map(_number, position.values)
        head = f"{head}\t\tCONFIG : '{config_text(position.flags)}',\n\tX = {x}  mm,\tY = {y}  mm,\tZ = {z}  mm,"
        rows = [f"\tW = {c} deg,\tP = {b} deg,\tR = {a} deg"]
    elif position.kind == "none":
        head = f"{head}\t\tCONFIG : '{config_text(())}',"
        named = [[f"{name} = ********  {unit}" for name in names] for names, unit in (("XYZ", "mm"), ("WPR", "deg"))]
        rows = ["\t" + ",\t".join(row) for row in named]
    else:
        axes = [f"J{number}= {_number(value)} deg" for number, value in enumerate(position.values, 1)]
        rows = ["\t" + ",\t".join(row) for row in (axes[:3], axes[3:]) if row]
    rows += ["\t" + ",\t".join(row) for row in (more[:3], more[3:]) if row]
    return f"{head}\n" + ",\n".join(rows)


def _number(value: float) -> str:
    """Three places as on the screen; more where the value has them."""
    text = number_text(float(value), _MOST_DECIMALS, tables.NUMBERS)
    whole, _, places = text.partition(".")
    return f"{whole}.{places.ljust(_DECIMALS, '0')}".rjust(9)

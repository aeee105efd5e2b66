"""Taught positions: the blocks `P[1:"name"]{ GP1: UF : 0, UT : 1, CONFIG : '...', X = .. mm, ... };` of a listing.

A position has data for each motion group. Group 1 is the arm; its extended axes E1.. and then the axes of the further
groups become external axes. A component of stars was never taught: the whole position is then left without a value, and
a move there is a fault.
"""

from __future__ import annotations

import re
from dataclasses import dataclass, field

from rpl import ir
from rpl.reading.shapes import StatementError
from rpl.source import Origin

from . import tables
from .configtext import FIELDS, parse_config

_HEAD = re.compile(r"P\s*\[\s*(\d+)\s*(?::\s*\"?(.*?)\"?\s*)?\]\s*\{", re.DOTALL)
_GROUP = re.compile(r"\bGP(\d+)\s*:", re.IGNORECASE)
_FRAME = re.compile(r"\bU([FT])\s*:\s*(\d+|F|R)\b", re.IGNORECASE)
_CONFIG = re.compile(r"(?:CONFIG|KONFIG)\s*:\s*'([^']*)'", re.IGNORECASE)
_VALUE = re.compile(
    r"\b(?:(?P<remote>R)(?=[XYZWPR]\b))?(?P<name>[XYZWPR]|[JE]\d)\s*=\s*(?P<value>\*+|[+-]?(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?)",
    re.IGNORECASE,
)
_NUMBER = r"\s*=\s*([+-]?(?:\d+\.?\d*|\.\d+))\s*"
# What nearly all positions of a listing look like: one group, taught in space, no further axes.
_USUAL = re.compile(
    r"P\[(\d+)(?::\s*\"([^\"\[\]{}:]*)\"\s*)?\]\{\s*GP1:\s*UF\s*:\s*(\d+),\s*UT\s*:\s*(\d+),\s*CONFIG\s*:\s*'([^':]*)',\s*"
    rf"X{_NUMBER}mm,\s*Y{_NUMBER}mm,\s*Z{_NUMBER}mm,\s*W{_NUMBER}deg,\s*P{_NUMBER}deg,\s*R{_NUMBER}deg\s*\}};?"
)
_ORDER = ("X", "Y", "Z", "W", "P", "R")
_NEUTRAL = {"X": "x", "Y": "y", "Z": "z", "W": "c", "P": "b", "R": "a"}
EXTERNALS = 6


@dataclass(frozen=True, slots=True)
class Group:
    """One motion group of a position. `values` None: not taught. `frame`, `tool`: numbers it was recorded with."""

    values: dict[str, float | None]
    frame: int | None = None
    tool: int | None = None
    flags: dict[str, int | None] = field(default_factory=dict)
    remote: bool = False

    @property
    def kind(self) -> str:
        return "p" if "X" in self.values else "j"

    @property
    def taught(self) -> bool:
        return bool(self.values) and all(value is not None for value in self.values.values())


@dataclass(frozen=True, slots=True)
class Position:
    """A whole position: its groups by number."""

    number: int
    label: str
    groups: dict[int, Group]

    @property
    def kind(self) -> str:
        return self.groups[1].kind if 1 in self.groups else "j"

    @property
    def second_arm(self) -> int | None:
        """The number of a further group that is a robot itself: its place is in space."""
        return next((n for n, group in sorted(self.groups.items()) if n != 1 and group.kind == "p"), None)

    @property
    def taught(self) -> bool:
        return 1 not in self.groups or self.groups[1].taught


def parse_position(text: str) -> Position:
    """A position block. Raises StatementError where it is none."""
    usual = _USUAL.fullmatch(text)
    flags = parse_config(usual[5]) if usual is not None else None
    if usual is not None and flags is not None:
        number, label, frame, tool, _, *numbers = usual.groups()
        values: dict[str, float | None] = dict(zip(_ORDER, map(float, numbers), strict=True))
        return Position(int(number), (label or "").strip(), {1: Group(values, int(frame), int(tool), flags)})
    head = _HEAD.match(text)
    if head is None:
        raise StatementError("expected P[number]{ ... }", 0)
    body = text[head.end() :]
    marks = list(_GROUP.finditer(body))
    groups: dict[int, Group] = {}
    for place, mark in enumerate(marks):
        end = marks[place + 1].start() if place + 1 < len(marks) else len(body)
        groups[int(mark[1])] = _group(body[mark.end() : end], head.end() + mark.end())
    if not marks:
        groups[1] = _group(body, head.end())
    return Position(int(head[1]), (head[2] or "").strip(), groups)


def _group(text: str, offset: int) -> Group:
    config = _CONFIG.search(text)
    flags: dict[str, int | None] = {}
    if config is not None:
        found = parse_config(config[1])
        if found is None:
            raise StatementError(f"'{config[1]}' is no CONFIG: expected 'N U T, 0, 0, 0'", offset + config.start())
        flags = found
        text = text[: config.start()] + text[config.end() :]
    numbers = {match[1].upper(): match[2] for match in _FRAME.finditer(text)}
    values: dict[str, float | None] = {}
    remote = False
    for match in _VALUE.finditer(text):
        remote = remote or match["remote"] is not None
        given = match["value"]
        values[match["name"].upper()] = None if given.startswith("*") else float(given)
    if not values:
        raise StatementError("this position has no components", offset)
    if "X" in values:
        missing = [name for name in _ORDER if name not in values]
        if missing:
            raise StatementError(f"this position lacks {', '.join(missing)}", offset)
    frame, tool = (int(numbers[key]) if numbers.get(key, "").isdigit() else None for key in ("F", "T"))
    return Group(values, frame, tool, flags, remote)


def value_of(position: Position, origin: Origin) -> ir.Expression | None:
    """The constant of a position; None when it was not taught, or has places of two arms."""
    if not position.taught or position.second_arm is not None:
        return None
    arm = position.groups.get(1)
    entries: list[tuple[str | None, ir.Expression]] = []
    if arm is None:
        entries = [(f"j{n}", _number(0.0, origin)) for n in range(1, 7)]
    elif arm.kind == "p":
        entries = [(_NEUTRAL[name], _number(arm.values[name], origin)) for name in _ORDER]
        entries += [
            (name, ir.IntLiteral(flag, origin=origin)) for name in FIELDS if (flag := arm.flags.get(name)) is not None
        ]
    else:
        joints = [(int(name[1:]), value) for name, value in arm.values.items() if name.startswith("J")]
        entries = [(f"j{n}", _number(value, origin)) for n, value in sorted(joints) if n <= 6]
    entries += [(f"e{n}", _number(value, origin)) for n, value in enumerate(externals(position), 1)]
    return ir.Aggregate(tuple(entries), origin=origin)


def externals(position: Position) -> list[float | None]:
    """Extended axes of the arm, then the axes of the further groups (as many as there can be)."""
    arm = position.groups.get(1)
    values: list[float | None] = []
    if arm is not None and len(position.groups) == 1 and len(arm.values) == len(_ORDER) and arm.kind == "p":
        return values
    if arm is not None:
        values += [value for name, value in sorted(arm.values.items()) if name.startswith("E")]
        values += [value for name, value in sorted(arm.values.items()) if name in ("J7", "J8", "J9")]
    for number, group in sorted(position.groups.items()):
        if number != 1:
            values += [value for name, value in sorted(group.values.items()) if name[0] in "JE"]
    return values[:EXTERNALS]


def type_of_kind(kind: str) -> ir.Type:
    return tables.JOINTS if kind == "j" else tables.TARGET


def variable(position: Position, origin: Origin, constant: bool = True) -> ir.Variable:
    """The declaration of a program's own position."""
    value = value_of(position, origin)
    storage = "constant" if constant and value is not None else "persistent"
    return ir.Variable(
        f"P{position.number}",
        type_of_kind(position.kind),
        value,
        storage,
        "routine",
        position.label,
        origin=origin,
    )


def _number(value: float | None, origin: Origin) -> ir.Expression:
    return ir.RealLiteral(0.0 if value is None else value, origin=origin)

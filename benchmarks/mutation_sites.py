"""Places of a program that a mutant can change: every node with its path, what a number there means, and its statement.

The places are those of the IR, so they are the same in every language and in what was read back of a translation.
"""

from __future__ import annotations

import dataclasses
from collections.abc import Iterator
from dataclasses import dataclass, field, replace

from rpl import ir
from rpl.ir.walk import PART_FIELDS, is_statement
from rpl.source import NOWHERE, Origin

# Names of fields and numbers in tuples, from the program down to a node.
Path = tuple[str | int, ...]

_SPEED = {
    "path": "path speed",
    "rotation": "turning speed",
    "joint": "joint speed",
    "axis": "joint speed",
    "duration": "move time",
    "path_acceleration": "acceleration",
    "axis_acceleration": "acceleration",
}
_SYSTEM = {
    "path_speed": "path speed",
    "path_acceleration": "acceleration",
    "swivel_speed": "turning speed",
    "twist_speed": "turning speed",
    "swivel_acceleration": "acceleration",
    "twist_acceleration": "acceleration",
    "joint_speed": "joint speed",
    "joint_acceleration": "acceleration",
    "acceleration_percent": "acceleration",
    "speed_percent": "path speed",
    "override": "joint speed",
    "blend_distance": "corner",
    "blend_joint": "corner",
    "blend_speed": "corner",
    "blend_rotation": "corner",
    "move_duration": "move time",
}
_ENTRIES = {
    **dict.fromkeys("xyz", "coordinate"),
    **dict.fromkeys("abc", "angle"),
    **{f"j{axis}": "joint" for axis in range(1, 8)},
    **{f"e{axis}": "external axis" for axis in range(1, 7)},
    **dict.fromkeys(("flip", "down", "back", "noflip", "lower", "rear", "r180", "t180", "s180"), "posture flag"),
    **dict.fromkeys(("s", "t", "t1", "t4", "t6"), "posture number"),
    "mass": "load mass",
    **dict.fromkeys(("ix", "iy", "iz"), "inertia"),
}
# Entries without names, by the beginning of their aggregate's type.
_POSITIONAL = {
    "vector": "coordinate",
    "rotation": "quaternion",
    "external": "external axis",
    "axes": "joint",
    "configuration": "posture number",
    "speed": "path speed",
    "zone": "corner",
}
_LOAD = ("load mass", "", "", "inertia", "inertia", "inertia")
_POSES = ("coordinate",) * 3 + ("angle",) * 3
_BUILTINS = {
    "offset": ("", *_POSES[:3]),
    "tool_offset": ("", *_POSES),
    "pose_from_rotation_vector": _POSES,
    "pose_zyz": _POSES,
    "rotation_zyx": ("angle",) * 3,
    "joints_from_pulses": ("motor pulse",) * 7,
    "external_from_pulses": ("motor pulse",),
}
# (class, field) -> what a number there means.
_FIELDS = {
    ("Move", "acceleration"): "acceleration",
    ("Move", "blend"): "corner",
    ("Move", "swept"): "angle",
    ("MoveExternal", "blend"): "corner",
    ("MoveExternal", "target"): "external axis",
    ("Spline", "blend"): "corner",
    ("BlendLevel", "level"): "corner level",
    ("Wait", "time"): "wait",
    ("WaitUntil", "timeout"): "time-out",
    ("Dialog", "timeout"): "time-out",
    ("Pulse", "duration"): "pulse",
    ("SetAfter", "delay"): "delay",
    ("OrderInterrupt", "time"): "delay",
    ("Trigger", "distance"): "trigger distance",
    ("Trigger", "delay"): "trigger delay",
    ("For", "start"): "loop bound",
    ("For", "stop"): "loop bound",
    ("For", "step"): "loop bound",
    ("Case", "values"): "case value",
    ("Index", "indices"): "index",
    ("System", "indices"): "index",
    ("Variable", "type"): "declared type",
    ("DeclareInterrupt", "priority"): "priority",
    ("Trigger", "priority"): "priority",
}
_COMPARISONS = frozenset(("=", "<>", "<", ">", "<=", ">="))
_CONDITIONS = {
    ("While", "condition"),
    ("Repeat", "until"),
    ("WaitUntil", "condition"),
    ("Search", "condition"),
    ("DeclareInterrupt", "condition"),
    ("OrderInterrupt", "condition"),
}


@dataclass(frozen=True, slots=True)
class Site:
    """One place. role: what a number there means (empty: a plain number); unit: the unit that it is written in; owner:
    `tool or frame` inside of one, else empty; condition: it decides where the program goes on. `statement` is the
    innermost one around it (None: a declaration, whose name is `declared`). `value`: the node, or the body."""

    path: Path = ()
    value: object = None
    role: str = ""
    unit: str = ""
    owner: str = ""
    condition: bool = False
    statement: ir.Statement | None = None
    declared: str = ""
    origin: Origin = field(default=NOWHERE, compare=False)

    @property
    def is_body(self) -> bool:
        """Is it a row of statements?"""
        return isinstance(self.value, tuple)

    @property
    def place(self) -> str:
        """File and line."""
        return f"{self.origin.file.rpartition('/')[2]}:{self.origin.line}" if self.origin.source else "?"


def sites(program: ir.Program) -> Iterator[Site]:
    """Every node and every body below the modules of a program, in its order."""
    stack = [Site(("modules", number), module) for number, module in reversed(list(enumerate(program.modules)))]
    while stack:
        site = stack.pop()
        yield site
        if not site.is_body:
            stack.extend(reversed(list(_below(site))))
        else:
            assert isinstance(site.value, tuple)
            stack.extend(reversed([_entered(site, (at,), part, "") for at, part in enumerate(site.value)]))


def _below(site: Site) -> Iterator[Site]:
    node = site.value
    for name in PART_FIELDS[node.__class__]:
        for steps, part in _parts((name,), getattr(node, name)):
            yield _entered(site, steps, part, name)


def _parts(steps: Path, part: object) -> Iterator[tuple[Path, object]]:
    """The nodes and bodies in a field, through nested tuples. A body is told by its first statement."""
    if isinstance(part, tuple):
        if part and all(is_statement(one) for one in part):
            yield steps, part
        else:
            for number, one in enumerate(part):
                yield from _parts((*steps, number), one)
    elif dataclasses.is_dataclass(part) and not isinstance(part, Origin):
        yield steps, part


def _entered(site: Site, steps: Path, part: object, name: str) -> Site:
    """The place of a part of a node, with what is known there."""
    node = site.value
    below = replace(site, path=(*site.path, *steps), value=part, condition=False)
    origin = getattr(part, "origin", NOWHERE)
    if origin is not NOWHERE and origin.source is not None:
        below = replace(below, origin=origin)
    if is_statement(part):
        return replace(below, statement=part, role="", unit="", owner="")
    if isinstance(part, ir.Variable | ir.SignalDeclaration):
        owner = "tool or frame" if isinstance(getattr(part, "type", None), ir.ToolType | ir.WorkObjectType) else ""
        return replace(below, declared=part.name, owner=owner)
    if site.is_body:
        return below
    below = replace(below, condition=_is_condition(node, name, steps))
    return _meant(below, node, name, steps)


def _is_condition(node: object, name: str, steps: Path) -> bool:
    branch = isinstance(node, ir.If) and name == "branches" and steps[-1] == 0
    return branch or (type(node).__name__, name) in _CONDITIONS


def _meant(below: Site, node: object, name: str, steps: Path) -> Site:
    """The role, unit and owner of a part."""
    known = _FIELDS.get((type(node).__name__, name))
    if known is not None:
        return replace(below, role=known)
    match node:
        case ir.Speed():
            return replace(below, role=_SPEED.get(name, ""))
        case ir.Quantity(unit=unit):
            return replace(below, unit=unit, role=below.role or _by_unit(unit))
        case ir.Aggregate():
            return _entry(below, node, int(steps[1]))
        case ir.Builtin(function=function):
            roles = _BUILTINS.get(function, ())
            number = int(steps[1])
            return replace(below, role=roles[number] if number < len(roles) else "", unit="")
        case ir.Signal(kind=kind):
            return replace(below, role="output number" if kind.endswith("_out") else "input number")
        case ir.Assign(target=ir.Signal(kind=kind)) if name == "value" and kind.endswith("_out"):
            return replace(below, role="output value")
        case ir.Pulse() | ir.SetAfter() if name == "value":
            return replace(below, role="output value")
        case ir.Assign(target=target) | ir.SetForNextMove(setting=target) if name == "value":
            return _assigned(below, target)
        case ir.Binary(op=op) if op in _COMPARISONS:
            return replace(below, role="compared number")
        case ir.Binary(op=":") | ir.Unary() | ir.Convert() | ir.Argument():
            return below
        case ir.Binary(op="+" | "-"):
            return below
        case ir.Binary():
            return replace(below, role="")
    return below


def _by_unit(unit: str) -> str:
    return {"mm": "coordinate", "m": "coordinate", "deg": "angle", "rad": "angle"}.get(unit, "")


def _entry(below: Site, node: ir.Aggregate, number: int) -> Site:
    key, kind = node.entries[number][0], (node.type_name or "").partition(" ")[0]
    if key is None:
        role = _LOAD[number] if kind == "load" and number < len(_LOAD) else _POSITIONAL.get(kind, "")
    else:
        role = "motor pulse" if below.role == "motor pulse" else _ENTRIES.get(key.lower(), "")
    if kind == "load" or below.owner == "load":
        role = {"coordinate": "load centre"}.get(role, role)
        return replace(below, role=role, owner="load")
    return replace(below, role=role or ("" if below.role in ("coordinate", "angle") else below.role))


def _assigned(below: Site, target: ir.Expression) -> Site:
    while isinstance(target, ir.Field | ir.Index):
        if isinstance(target, ir.Field) and target.name.lower() in _ENTRIES:
            return replace(below, role=_ENTRIES[target.name.lower()])
        target = target.base
    if not isinstance(target, ir.System):
        return replace(below, role="assigned number")
    owner = {"tool": "tool or frame", "base": "tool or frame", "load": "load"}.get(target.name, "")
    return replace(below, role=_SYSTEM.get(target.name, "assigned number"), owner=owner)


def replaced(program: ir.Program, path: Path, value: object) -> ir.Program:
    """The program with the value in place of what the path leads to; everything beside the path is the same object."""
    chain: list[object] = [program]
    for step in path[:-1]:
        chain.append(_taken(chain[-1], step))
    made = value
    for holder, step in zip(reversed(chain), reversed(path), strict=True):
        if isinstance(holder, tuple):
            made = (*holder[: int(step)], made, *holder[int(step) + 1 :])
        else:
            made = replace(holder, **{str(step): made})  # type: ignore[type-var]  # nodes are dataclasses
    assert isinstance(made, ir.Program)
    return made


def _taken(holder: object, step: str | int) -> object:
    return holder[int(step)] if isinstance(holder, tuple) else getattr(holder, str(step))

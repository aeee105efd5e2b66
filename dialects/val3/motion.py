"""VAL3 movements to IR: movej, movel and movec with their tool and movement descriptor.

A descriptor that nothing in the application changes stands for its numbers; of another one the components are read when
the movement is commanded, as the controller does.
"""

from __future__ import annotations

from dataclasses import dataclass

from rpl import ir
from rpl.diagnostics import Diagnostics, Severity, code
from rpl.reading.shapes import StatementError, SyntaxTree

from .calls import Calls
from .data import Datum
from .expressions import BLENDS, parts_of
from .facts import Facts
from .places import WORLD, Value, moved_to, number_of, real
from .rules import FULL_PATH_SPEED_MM_S, UNLIMITED

UNEQUAL = code(
    "val3-unequal-corner",
    Severity.WARNING,
    "the corner leaves the way {leave:g} mm before the point and comes back {reach:g} mm behind it: read as {leave:g}",
    "say the same for leave and reach",
)
BY_JOINTS = code(
    "val3-speed-by-joints",
    Severity.INFO,
    "a path movement without a speed of the tool goes as fast as {vel:g} percent of the joints' speed allow: read as"
    " {speed:g} mm/s",
    "say tmax in the movement descriptor",
)
KINDS = {"movej": "joint", "movel": "linear", "movec": "circular"}
# M: the descriptor as delivered, where the file leaves a component out.
_USUAL = {
    "accel": 100.0, "vel": 100.0, "decel": 100.0, "tvel": UNLIMITED, "rvel": UNLIMITED, "blend": 0.0, "leave": 50.0,
    "reach": 50.0,
}  # fmt: skip


@dataclass(frozen=True, slots=True)
class Descriptor:
    """A movement descriptor: each component as a number or an expression."""

    parts: dict[str, ir.Expression]

    def number(self, name: str) -> float | None:
        return number_of(self.parts[name])


def descriptor_of(datum: Datum, index: int) -> dict[str, float]:
    """The components of a descriptor of the data."""
    given = datum.values.get(index, {})
    found = dict(_USUAL)
    for name in _USUAL:
        text = given.get(name)
        if text is not None:
            found[name] = float(BLENDS[text]) if text in BLENDS else float(text)
    return found


class Motion(Calls):
    """Lowers movements."""

    def __init__(self, facts: Facts, diagnostics: Diagnostics) -> None:
        super().__init__(facts)
        self.diagnostics = diagnostics

    def move(self, name: str, items: list[SyntaxTree]) -> ir.Move:
        kind = KINDS[name]
        if len(items) != (4 if kind == "circular" else 3):
            raise StatementError(f"{name} has other arguments", 0)
        *places, tool, description = items
        goal = self.goal(places[-1])
        via = None
        if kind == "circular":
            via = moved_to(self.value(places[0], "point"), goal.place)
        elif goal.kind == "joint" and kind != "joint":
            raise StatementError(f"{name} goes to a point, not to joint values", 0)
        of = self.descriptor(description)
        self.check(kind, of)
        return ir.Move(
            kind,
            goal.node,
            via=via,
            tool=self.value(tool, "tool").place,
            frame=goal.place,
            speed=_speed(kind, of),
            blend=_blend(of),
            settings=_settings(of),
            origin=self.origin,
        )

    def goal(self, tree: SyntaxTree) -> Value:
        """The target: a point, or joints (then there is no frame)."""
        joints = tree.data == "aggregate" and len(parts_of(tree.children[0])) == 6
        value = self.value(tree, "joint" if joints else "point")
        if value.kind not in ("point", "joint"):
            raise StatementError("a movement goes to a point or to joint values", 0)
        return Value(value.node, value.kind, WORLD if value.kind == "joint" else value.place)

    def descriptor(self, tree: SyntaxTree) -> Descriptor:
        value = self.value(tree, "mdesc")
        if value.kind != "mdesc":
            raise StatementError("a movement needs a movement descriptor", 0)
        match value.node:
            case ir.Name(id=name):
                index = 0
            case ir.Index(base=ir.Name(id=name), indices=(ir.IntLiteral(value=index),)):
                pass
            case _:
                name, index = "", 0
        datum = self.facts.data.get(name)
        if datum is not None and name not in self.own and name not in self.facts.assigned:
            return Descriptor({part: real(number) for part, number in descriptor_of(datum, index).items()})
        return Descriptor({part: ir.Field(value.node, part) for part in _USUAL})

    def check(self, kind: str, of: Descriptor) -> None:
        leave, reach, vel = of.number("leave"), of.number("reach"), of.number("vel")
        if of.number("blend") != 0.0 and leave is not None and reach is not None and leave != reach:
            self.diagnostics.report(UNEQUAL, self.origin, leave=leave, reach=reach)
        if kind != "joint" and of.number("tvel") == UNLIMITED and vel is not None:
            self.diagnostics.report(BY_JOINTS, self.origin, vel=vel, speed=vel / 100.0 * FULL_PATH_SPEED_MM_S)


def _share(of: Descriptor, full: float) -> ir.Expression:
    vel = of.number("vel")
    return real(vel / 100.0 * full) if vel is not None else ir.Binary("*", of.parts["vel"], real(full / 100.0))


def _speed(kind: str, of: Descriptor) -> ir.Speed:
    """Joint movements: vel percent of each joint's speed. Paths: tmax and rmax, and not faster than the joints."""
    if kind == "joint":
        return ir.Speed(joint=of.parts["vel"])
    share, limit = _share(of, FULL_PATH_SPEED_MM_S), of.parts["tvel"]
    known, most = number_of(share), number_of(limit)
    if most is not None and most < UNLIMITED:
        path = limit
    elif known is not None and most is not None:
        path = share
    else:
        path = ir.Builtin("min", (share, limit))
    return ir.Speed(path=path, rotation=None if of.number("rvel") == UNLIMITED else of.parts["rvel"])


def _blend(of: Descriptor) -> ir.Blend:
    """The corner of a descriptor; M: joint and Cartesian corners are alike but for their curve."""
    match of.number("blend"):
        case 0.0:
            return ir.BlendStop()
        case None:
            on = ir.Builtin("min", (of.parts["blend"], ir.IntLiteral(1)))
            return ir.BlendDistance(ir.Binary("*", of.parts["leave"], on))
    return ir.BlendDistance(of.parts["leave"])


def _settings(of: Descriptor) -> tuple[tuple[ir.Expression, ir.Expression], ...]:
    names = (("accel", "acceleration_percent"), ("decel", "deceleration_percent"))
    if all(of.number(part) == 100.0 for part, _ in names):
        return ()
    return tuple((ir.System(name), of.parts[part]) for part, name in names)

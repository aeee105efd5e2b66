"""How far each taught datum is moved, and its copies in the other program likewise.

The same amount means the same motion of the tool: a place moves by a small pose in its own axes, so that it does not
matter in which frame either program holds it; joints turn by degrees; where one program holds a place and the other one
joints, the arm says what the amount is there. The posture of a place is taught with it, as a pendant does.
"""

from __future__ import annotations

import math
import random
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

import numpy as np

from rpl import ir, registry
from rpl.emulator.model import RobotModel
from rpl.emulator.rotations import FloatArray
from rpl.ir.walk import walk
from rpl.passes import rigid
from rpl.proof.record import Record, place_of
from rpl.proof.teaching.data import POINT, Datum, Joints, Taught
from rpl.proof.teaching.pairs import Copy
from rpl.runtime.functions.geometry import rotation_of_vector

_FARTHEST_DEG = 45.0  # an axis that goes farther than this for a small amount stands at a singularity
_HALVINGS = 4
_LEAST_SHARE = 0.4  # of an amount: nobody teaches a point where it was


@dataclass(frozen=True, slots=True)
class Amount:
    """The greatest amounts: of places, tools and frames, of joints, of numbers."""

    mm: float = 5.0
    deg: float = 2.0
    share: float = 0.03

    def times(self, factor: float) -> Amount:
        return Amount(self.mm * factor, self.deg * factor, self.share * factor)

    @property
    def is_none(self) -> bool:
        return self.mm == 0.0 and self.deg == 0.0


@dataclass(frozen=True, slots=True, eq=False)
class Use:
    """How the arm stands at a taught place: its joints there (n,), and the tool (4, 4) of that move."""

    joints: FloatArray
    tool: FloatArray


@dataclass(frozen=True, slots=True, eq=False)
class Stand:
    """A program's arm, and how it stands at the program's taught places."""

    robot: RobotModel | None
    uses: Mapping[Datum, Use] = field(default_factory=dict)


def stand_of(program: ir.Program, record: Record, data: Sequence[Datum], robot: RobotModel | None) -> Stand:
    """Where the run goes to taught places themselves; places that others are worked out of have no posture."""
    named = {(one.routine.lower(), (one.variable + one.part).lower()): one for one in data if one.kind == POINT}
    by_line: dict[tuple[str, int], Use] = {}
    for stretch in (one for some in record.motion.values() for one in some):
        if stretch.asked is not None and stretch.asked.joints is not None:
            tool = stretch.asked.tool or rigid.IDENTITY
            key = (stretch.place.file, stretch.place.line)
            by_line.setdefault(key, Use(np.array(stretch.asked.joints), np.array(tool.matrix)))
    found: dict[Datum, Use] = {}
    for module in program.modules:
        for routine in module.routines:
            for move in (node for node in walk(routine) if isinstance(node, ir.Move)):
                name = _place_named(move.target)
                datum = named.get((routine.name.lower(), name)) or named.get(("", name))
                place = place_of(move.origin)
                use = by_line.get((place.file, place.line))
                if datum is not None and use is not None:
                    found.setdefault(datum, use)
    return Stand(robot, found)


def _place_named(target: ir.Expression) -> str:
    match target:
        case ir.Name(id=name):
            return name.lower()
        case ir.Index(base=ir.Name(id=name), indices=(ir.IntLiteral(value=at),)):
            return f"{name}[{at}]".lower()
    return ""


@dataclass(frozen=True, slots=True)
class Moved:
    """A datum of A as it is taught anew, and its copies in B."""

    datum: Datum
    taught: Taught
    copies: tuple[tuple[Datum, Taught], ...]


def moved(
    datum: Datum, copies: Sequence[Copy], ours: Stand, theirs: Stand, amount: Amount, seed: str, level: bool
) -> Moved | None:
    """The datum by a random amount that the seed and its name decide, and all copies likewise; None where the arm
    cannot go there, or a copy cannot be moved likewise. `level`: turned about its own z axis only, which leaves a tool
    that points down so."""
    for halving in range(_HALVINGS):
        chance = random.Random(f"{seed} {datum.name} {halving}")
        found = _tried(datum, copies, ours, theirs, amount.times(0.5**halving), chance, level)
        if found is not None:
            return found
    return None


def _tried(
    datum: Datum,
    copies: Sequence[Copy],
    ours: Stand,
    theirs: Stand,
    amount: Amount,
    chance: random.Random,
    level: bool,
) -> Moved | None:
    match datum.value:
        case float() as number:
            factor = 1.0 + _drawn(chance, amount.share)
            likewise = [(one.datum, _number(one.datum, factor)) for one in copies]
            taught: Taught | None = Taught(number * factor)
        case tuple() as joints:
            turned = _within(ours.robot, tuple(q + _drawn(chance, amount.deg) for q in joints), joints)
            taught = Taught(turned)
            likewise = [(one.datum, _as_joints(datum, turned, one.datum, ours, theirs)) for one in copies]
        case rigid.Pose():
            step = _step(chance, amount, level)
            taught = _by_step(datum, step, ours, None)
            likewise = [(one.datum, _by_step(one.datum, step, theirs, ours.uses.get(datum))) for one in copies]
    told = [(one, new) for one, new in likewise if new is not None]
    return Moved(datum, taught, tuple(told)) if taught is not None and len(told) == len(likewise) else None


def _drawn(chance: random.Random, most: float) -> float:
    return chance.choice((-1.0, 1.0)) * chance.uniform(_LEAST_SHARE, 1.0) * most


def _step(chance: random.Random, amount: Amount, level: bool) -> rigid.Pose:
    """A small pose: some way in some direction, some angle about some axis."""
    way, axis = _direction(chance), (rigid.Vector(0.0, 0.0, 1.0) if level else _direction(chance))
    far, angle = abs(_drawn(chance, amount.mm)), _drawn(chance, amount.deg)
    turn = axis.times(angle)
    return rigid.Pose(way.times(far), rotation_of_vector(turn.x, turn.y, turn.z))


def _direction(chance: random.Random) -> rigid.Vector:
    height, around = chance.uniform(-1.0, 1.0), chance.uniform(0.0, 2.0 * math.pi)
    flat = math.sqrt(1.0 - height * height)
    return rigid.Vector(flat * math.cos(around), flat * math.sin(around), height)


def _number(datum: Datum, factor: float) -> Taught | None:
    return Taught(datum.value * factor) if isinstance(datum.value, float) else None


def _within(robot: RobotModel | None, turned: Joints, before: Joints) -> Joints:
    """The joints; an axis that would leave its limits turns the other way."""
    if robot is None or len(turned) != robot.axes:
        return turned
    outside = set(robot.within_limits(turned))
    return tuple(
        2.0 * old - new if at in outside else new for at, (old, new) in enumerate(zip(before, turned, strict=True))
    )


def _by_step(datum: Datum, step: rigid.Pose, stand: Stand, other: Use | None) -> Taught | None:
    """A datum by a small pose in its own axes. `other`: how the other program's arm stands at it."""
    use = stand.uses.get(datum)
    match datum.value:
        case rigid.Pose() as pose:
            new = pose.then(step)
            if use is None or stand.robot is None:
                return Taught(new)
            joints = _stepped(stand.robot, use, step)
            return None if joints is None else Taught(new, _flags(datum, stand.robot, use.joints, joints))
        case tuple() as old if stand.robot is not None and len(old) == stand.robot.axes and (use or other):
            known = use or other
            assert known is not None  # as the guard says
            joints = _stepped(stand.robot, Use(np.array(old), known.tool), step)
            return None if joints is None else Taught(tuple(float(q) for q in joints))
    return None


def _stepped(robot: RobotModel, use: Use, step: rigid.Pose) -> FloatArray | None:
    """The joints (n,) with the tool a small pose farther; None out of reach or beyond a singularity."""
    flange = robot.forward(use.joints) @ use.tool @ np.array(step.matrix) @ np.linalg.inv(use.tool)
    joints = robot.nearest(flange, use.joints)
    return joints if joints is not None and np.abs(joints - use.joints).max() <= _FARTHEST_DEG else None


def _flags(datum: Datum, robot: RobotModel, before: FloatArray, after: FloatArray) -> Mapping[str, int] | None:
    """The flags of the posture that is taught with a place; None where they stay as they are."""
    if not isinstance(datum.type, ir.TargetType):
        return None
    make = registry.dialect(datum.type.notation).notation
    if make is None:
        return None
    notation = make()
    old, new = notation.encode(robot, before), notation.encode(robot, after)
    changed = {name: value for name, value in new.items() if old.get(name) != value}
    return changed or None


def _as_joints(datum: Datum, turned: Joints, copy: Datum, ours: Stand, theirs: Stand) -> Taught | None:
    """A copy of joints: the same ones, or the place that the tool is at then."""
    same_arm = ours.robot is theirs.robot
    if isinstance(copy.value, tuple) and same_arm and isinstance(datum.value, tuple):
        return Taught(tuple(old + new - q for old, new, q in zip(copy.value, turned, datum.value, strict=True)))
    use = theirs.uses.get(copy) or ours.uses.get(datum)
    if use is None or ours.robot is None or not isinstance(datum.value, tuple):
        return None
    here, there = (ours.robot.forward(one) @ use.tool for one in (datum.value, turned))
    step = rigid.pose_of_matrix((np.linalg.inv(here) @ there).tolist())
    return _by_step(copy, step, theirs, use)


__all__ = ["Amount", "Moved", "Stand", "Use", "moved", "stand_of"]

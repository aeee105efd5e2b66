"""Constant positions: their values out of IR expressions, and what of the program's data never changes."""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass, field, replace
from itertools import takewhile
from typing import TYPE_CHECKING

import numpy as np

from rpl import ir
from rpl.emulator.rotations import matrix_to_zyx, pose_matrix, quaternion_to_matrix, slerp, zyx_to_matrix
from rpl.passes.legalise.facts.entries import INITIALISE
from rpl.passes.rewrite import visit_bodies

from . import tables
from .operands import constant, numbered, selected

if TYPE_CHECKING:
    from rpl.emulator.rotations import FloatArray

_UNSET = 8e9  # RAPID's mark of an external axis that is not there
Values = tuple[float, ...]
WORLD: Values = (0.0,) * 6


@dataclass(frozen=True, slots=True)
class Position:
    """kind: pose (x y z a b c; mm, deg) or joints (deg), or external (base axes or a station alone). `flags` of a
    pose with a posture; external axes e1 ... in their units or, `counted`, in pulses; NaN where one is left out."""

    kind: str
    values: Values
    flags: tuple[tuple[str, int], ...] = ()
    external: Values = ()
    counted: bool = False

    def with_flags(self, flags: Mapping[str, int]) -> Position:
        return replace(self, flags=tuple(flags.items()))


def position_of(value: ir.Expression) -> Position | None:
    """The position that is written out; None when it is computed or lacks components. Joints that are left out belong
    to the way of a relative move, where they are zero."""
    match value:
        case ir.Builtin(function="with_external", arguments=(inner, axes)):
            return _beside(position_of(inner), axes)
    parts = flat(value)
    given = [at for at, name in enumerate(tables.JOINT_ELEMENTS, 1) if name in parts]
    if given:
        names = tables.JOINT_ELEMENTS[: given[-1]]
        found = _numbers({**dict.fromkeys(names, ir.RealLiteral(0.0)), **parts}, names)
        return None if found is None else Position("joints", found, (), _external(parts))
    quaternion = _numbers(parts, ("q1", "q2", "q3", "q4"))
    if quaternion is not None:
        angles = matrix_to_zyx(quaternion_to_matrix(list(quaternion)))
        parts |= dict(zip(ir.ANGLES, (ir.RealLiteral(float(one)) for one in angles), strict=True))
    found = _numbers(parts, ir.POSE)
    if found is None:
        return None
    flags = tuple((name, constant(parts[name])) for name in tables.FLAGS if name in parts)
    if any(value is None for _, value in flags):
        return None
    kept = tuple((name, int(value)) for name, value in flags if value is not None)
    return Position("pose", (*found[:3], *map(_turned, found[3:])), kept, _external(parts))


def way_of(value: ir.Expression) -> Position | None:
    """The way of a relative move: components that are left out are zero."""
    parts = flat(value)
    if not parts:
        return None
    joints = any(name in parts for name in tables.JOINT_ELEMENTS)
    names = tables.JOINT_ELEMENTS if joints else ir.POSE
    found = _numbers({**dict.fromkeys(names, ir.RealLiteral(0.0)), **parts}, names)
    return None if found is None else Position("joints" if joints else "pose", found, (), _external(parts))


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


def _numbers(parts: Mapping[str, ir.Expression], names: Sequence[str]) -> Values | None:
    found = [constant(parts.get(name)) for name in names]
    return None if None in found else tuple(float(one) + 0.0 for one in found if one is not None)


def _external(parts: Mapping[str, ir.Expression]) -> Values:
    """Positions of external axes up to the last that is there; NaN for one before it that is not, or is computed."""
    values = [constant(parts.get(name)) for name in tables.EXTERNAL]
    found = [math.nan if one is None or abs(one) >= _UNSET else float(one) for one in values]
    while found and math.isnan(found[-1]):
        found.pop()
    return tuple(found)


def _beside(position: Position | None, axes: ir.Expression) -> Position | None:
    """The position with external axes that are given beside it, in their units or in pulses."""
    counted = isinstance(axes, ir.Builtin) and axes.function == "external_from_pulses"
    given = axes.arguments[0] if isinstance(axes, ir.Builtin) and counted else axes
    if position is None or not isinstance(given, ir.Aggregate) or any(not math.isnan(one) for one in position.external):
        return None
    return replace(position, external=_external(flat(given)), counted=counted)


def _turned(degrees: float) -> float:
    """The angle within half a turn."""
    return degrees if -180 <= degrees <= 180 else (degrees + 180) % 360 - 180


# ---- matrices


def matrix(values: Values) -> FloatArray:
    return pose_matrix(list(values[:3]), zyx_to_matrix(list(values[3:6])))


def values_of(pose: FloatArray) -> Values:
    a, b, c = matrix_to_zyx(pose)
    return tuple(float(round(float(one), 9)) + 0.0 for one in (*pose[:3, 3], a, b, c))


def inverse(values: Values) -> Values:
    return values_of(np.asarray(np.linalg.inv(matrix(values)), dtype=np.float64))


def product(one: Values, other: Values) -> Values:
    return values_of(np.asarray(matrix(one) @ matrix(other), dtype=np.float64))


def between(one: Values, other: Values, share: float) -> Values:
    """The pose at this share of the straight way; it turns about one axis."""
    place = np.asarray(one[:3]) + share * np.subtract(other[:3], one[:3])
    turned = slerp(matrix(one)[:3, :3], matrix(other)[:3, :3], np.array([share]))[0]
    return values_of(pose_matrix(place, turned))


# ---- data that never changes


@dataclass(slots=True)
class Constants:
    """Position variables that get one constant value at the start of the program and no other."""

    values: dict[tuple[str, int], Position] = field(default_factory=dict)
    points: dict[str, Position] = field(default_factory=dict)  # the taught points of the routine at hand
    joints: frozenset[int] = frozenset()  # numbers of position variables that hold joints
    names: dict[str, str] = field(default_factory=dict)  # taught points of the routine, variables: their source's names

    @classmethod
    def of(cls, program: ir.Program, entries: Collection[str] = ()) -> Constants:
        """`entries`: routines that may be started; what stands at their very beginning happens once, too."""
        assigned: Counter[tuple[str, int]] = Counter()
        first: dict[tuple[str, int], Position] = {}
        before: dict[tuple[str, int], Position] = {}  # from the start of the program on
        chosen = False

        def note(target: ir.Expression) -> None:
            nonlocal chosen
            base = target.base if isinstance(target, ir.Field) else target
            place = numbered(base)
            if place is not None:
                assigned[place] += 1
            elif isinstance(base, ir.Index) and isinstance(base.base, ir.Name) and base.base.id == "P":
                chosen = True

        def body(statements: ir.Body) -> ir.Body:
            for statement in statements:
                if isinstance(statement, ir.Assign):
                    note(statement.target)
                if isinstance(statement, ir.Move) and statement.search is not None and statement.search.found:
                    note(statement.search.found)
                visit_bodies(statement, body)
            return statements

        for module in program.modules:
            for declaration in module.declarations:
                if isinstance(declaration, ir.Initialise):
                    given = position_of(declaration.assign.value)
                    place = numbered(declaration.assign.target) or selected(declaration.assign.target)
                    if place is not None and given is not None:
                        before[place] = given
            for routine in module.routines:
                body(routine.body)
                if not (routine.name.lower() in entries or routine.name.lower().startswith(INITIALISE)):
                    continue
                points = _points(routine)
                for statement in takewhile(_is_setting, routine.body):
                    place = numbered(statement.target) if isinstance(statement, ir.Assign) else None
                    if place is not None and isinstance(statement, ir.Assign):
                        given = points.get(statement.value.id) if isinstance(statement.value, ir.Name) else None
                        known = given or position_of(statement.value)
                        if known is not None:
                            first[place] = known
        joints = _joint_variables(program)
        if chosen:
            return cls({at: one for at, one in before.items() if at[0] not in tables.BANKS}, joints=joints)
        once = {place: value for place, value in first.items() if assigned[place] == 1}
        values = once | {place: value for place, value in before.items() if not assigned[place]}
        return cls(values, joints=joints)

    def routine(self, routine: ir.Routine) -> Constants:
        labels = {one.name: one.label for one in routine.declarations if isinstance(one, ir.Variable) and one.label}
        return Constants(self.values, _points(routine), self.joints, {**self.names, **labels})

    def name(self, expression: ir.Expression) -> str:
        """The source's name of a taught point, or of a variable that is set once; empty for what is written out."""
        if isinstance(expression, ir.Name) and expression.id in self.points:
            return self.names.get(expression.id, "")
        place = numbered(expression) or selected(expression)
        return "" if place is None or place not in self.values else self.names.get(f"{place[0]}{place[1]}", "")

    def operands(self, expression: ir.Expression) -> list[ir.Expression]:
        """What a position is computed of, one after the other."""
        match expression:
            case ir.Builtin(function="pose_of" | "inverse" | "compose", arguments=parts):
                return [inner for one in parts for inner in self.operands(one)]
            case ir.Binary(op=":", left=left, right=right):
                return [*self.operands(left), *self.operands(right)]
        return [expression]

    def rests_on_point(self, expression: ir.Expression) -> bool:
        """Is it a taught point with a name, or computed of one? Such a value is computed where the program runs."""
        parts = self.operands(expression)
        return any(isinstance(one, ir.Name) and one.id in self.points and one.id in self.names for one in parts)

    def lasting(self, expression: ir.Expression) -> Position | None:
        """The position that an expression always is; None for what is computed of anything with a name."""
        while isinstance(expression, ir.Builtin) and expression.function == "pose_of":
            expression = expression.arguments[0]
        computed = isinstance(expression, ir.Binary | ir.Builtin) and any(map(self.name, self.operands(expression)))
        return None if computed else self.known(expression)

    def is_joints(self, expression: ir.Expression) -> bool:
        """Does the expression give joints: a constant, a variable that holds them, or where the robot is?"""
        known = self.known(expression)
        if known is not None:
            return known.kind == "joints"
        match expression:
            case ir.System(name="actual_joints") | ir.Builtin(function="current_joints" | "target_to_joints"):
                return True
        place = numbered(expression)
        if place is None and isinstance(expression, ir.Index) and isinstance(expression.base, ir.Name):
            return expression.base.id == "P" and _WHOLE_BANK in self.joints
        return place is not None and place[0] == "P" and place[1] in self.joints

    def known(self, expression: ir.Expression) -> Position | None:
        """The position that an expression always is; None for what is computed of a taught point, which may change."""
        match expression:
            case ir.System(name="null_frame" | "world"):
                return Position("pose", WORLD)
            case ir.Builtin(function="inverse" | "compose") | ir.Binary() if self.rests_on_point(expression):
                return None
            case ir.Aggregate() | ir.Builtin(function="with_external"):
                return position_of(expression)
            case ir.Name(id=name) if name in self.points:
                return self.points[name]
            case ir.Builtin(function="pose_of", arguments=(inner,)):
                return self.known(inner)
            case ir.Builtin(function="inverse", arguments=(inner,)):
                found = self.known(inner)
                return None if found is None or found.kind != "pose" else Position("pose", inverse(found.values))
            case ir.Binary(op=":", left=left, right=right) | ir.Builtin(function="compose", arguments=(left, right)):
                one, other = self.known(left), self.known(right)
                if one is None or other is None or "joints" in (one.kind, other.kind):
                    return None
                return Position("pose", product(one.values, other.values))
        place = numbered(expression) or selected(expression)
        return None if place is None else self.values.get(place)


_WHOLE_BANK = -1  # stands for the variables that are chosen by a computed number


def _joint_variables(program: ir.Program) -> frozenset[int]:
    """Numbers of the position variables that are declared as joints; where the bank itself is, all others as well."""
    found: dict[int, bool] = {}
    for module in program.modules:
        for declaration in module.declarations:
            if not isinstance(declaration, ir.Variable):
                continue
            if declaration.name == tables.P.name and isinstance(declaration.type, ir.ArrayType):
                if isinstance(declaration.type.element, ir.JointsType):
                    every = dict.fromkeys((_WHOLE_BANK, *range(tables.P.first, tables.P.last + 1)), True)
                    found = every | found
                continue
            place = numbered(ir.Name(declaration.name))
            if place is not None and place[0] == "P":
                found[place[1]] = isinstance(declaration.type, ir.JointsType)
    return frozenset(number for number, joints in found.items() if joints)


def _is_setting(statement: ir.Statement) -> bool:
    """Does a program without moves, jumps or decisions go on behind it?"""
    if isinstance(statement, ir.CallRoutine):
        return statement.name.lower().startswith(INITIALISE)
    return isinstance(statement, ir.Assign | ir.Nothing)


def _points(routine: ir.Routine) -> dict[str, Position]:
    found: dict[str, Position] = {}
    for declaration in routine.declarations:
        if isinstance(declaration, ir.Variable) and declaration.initial is not None:
            position = position_of(declaration.initial)
            if position is not None and declaration.storage == "constant":
                found[declaration.name] = position
    return found

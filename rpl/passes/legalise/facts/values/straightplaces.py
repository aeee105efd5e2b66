"""Places that the statements in front set in variables of the routine: a place is copied and some of its components are
set, for moves of targets that want whole places. Passes that need the numbers of such a place ask here, and what it was
copied from.
"""

from __future__ import annotations

from dataclasses import dataclass, field, replace

from rpl import ir
from rpl.ir.walk import walk
from rpl.passes.fold import Unchanged, constant
from rpl.passes.legalise.facts.usage import base_name
from rpl.passes.rigid import Pose
from rpl.passes.scope import Scope
from rpl.passes.values import Target, Value, component, composed, pose_of


@dataclass(slots=True)
class StraightPlaces:
    """`values`: of variables by folded name, as `constant` takes them. `given`: the expressions that made them."""

    values: dict[str, Value] = field(default_factory=dict)
    given: dict[str, tuple[ir.Expression, ...]] = field(default_factory=dict)

    def follow(self, statement: ir.Statement, scope: Scope, unchanged: Unchanged) -> None:
        """What is known behind a statement of a straight line; who leaves the line begins anew."""
        if not isinstance(statement, ir.Assign):
            return
        if any(isinstance(one, ir.Call) for one in walk(statement)):
            self.values, self.given = {}, {}  # it may set what it is given
            return
        name = base_name(statement.target)
        symbol = None if name is None else scope.value(name)
        if name is None or symbol is None or symbol.routine is None:
            return
        before = self.values.pop(name, None)
        sources = self.given.pop(name, ())
        value = constant(statement.value, scope, unchanged, self.values)
        match statement.target:
            case ir.Name() if isinstance(value, Pose | Target):
                self.values[name], self.given[name] = value, self.rest_on(statement.value)
            case ir.Field(base=ir.Name(), name=part) if isinstance(before, Pose | Target) and value is not None:
                after = _changed(before, part, value)
                if after is not None:
                    self.values[name], self.given[name] = after, (*sources, *self.rest_on(statement.value))

    def rest_on(self, *expressions: ir.Expression | None) -> tuple[ir.Expression, ...]:
        """The names in the expressions; instead of variables that were made here the names in what made them."""
        found: list[ir.Expression] = []
        for one in walk(*(one for one in expressions if one is not None)):
            if isinstance(one, ir.Name):
                found += self.given.get(one.id.lower(), (one,))
        return tuple(found)


def _changed(place: Pose | Target, part: str, value: Value) -> Value | None:
    """The place with one component of six set (mm, degrees)."""
    if part not in ir.POSE:
        return None
    parts = {name: number for name in ir.POSE if (number := component(place, name)) is not None}
    pose = pose_of(composed(ir.PoseType(), {**parts, part: value}))
    return pose if pose is None or isinstance(place, Pose) else replace(place, pose=pose)


__all__ = ["StraightPlaces"]

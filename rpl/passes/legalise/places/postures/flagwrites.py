"""Single flags of arm configurations that a program sets or asks for (`P.S = XPICK.S`, `P.T = 3`).

Most controllers keep the flags of a place as a whole and have no word for one of them. Where all places that a variable
may hold have the same flag, setting it so changes nothing and asking for it gives that number. A flag that says nothing
of the posture, only how far the axes turn, may be left out: the controller then takes the shortest way.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, field
from functools import partial
from typing import TYPE_CHECKING

from rpl import ir
from rpl.ir.walk import bodies
from rpl.passes.fold import Unchanged, constant
from rpl.passes.legalise.context import ProgramScope
from rpl.passes.legalise.facts.targetuses import Uses
from rpl.passes.legalise.facts.usage import each_statement
from rpl.passes.scope import Scope
from rpl.passes.values import Target

if TYPE_CHECKING:
    from rpl.emulator.configuration import Notation
    from rpl.emulator.model import RobotModel

_TRIED = 2000  # joint values, spread evenly by chance over the ranges of the axes
_PARTS = frozenset(name for type in (ir.PoseType, ir.VectorType, ir.ExternalType) for name in ir.COMPONENTS[type]) | {
    *("trans", "rot", "ext")
}


@dataclass(frozen=True, slots=True)
class FlagValues:
    """What a flag may be. `places`: in the places that the variable gets whole; `set`: by statements of its own;
    `complete`: nothing else is possible."""

    places: frozenset[int]
    set: frozenset[int]
    complete: bool

    @property
    def only(self) -> int | None:
        """The one number it always is."""
        found = self.places | self.set
        return next(iter(found)) if self.complete and len(found) == 1 else None


@dataclass(slots=True)
class FlagFlow(Uses):
    """Where the flags of each variable come from; only whole places count."""

    fields: frozenset[str] = frozenset()
    unknown: set[int] = field(default_factory=set)
    written: dict[tuple[int, str], list[tuple[ir.Expression, Scope]]] = field(default_factory=dict)
    aggregates: dict[int, tuple[ir.Aggregate, Scope]] = field(default_factory=dict)
    unchanged: Unchanged | None = None

    @classmethod
    def of_program(
        cls, program: ir.Program, scopes: ProgramScope, fields: Iterable[str], unchanged: Unchanged
    ) -> FlagFlow:
        flow = cls(fields=frozenset(fields), unchanged=unchanged)
        for module in program.modules:
            scope = scopes.module(module)
            flow.declared(module.declarations, scope)
            for routine in module.routines:
                inner = scopes.routine(module, routine)
                flow.declared(routine.declarations, inner)
                for body in bodies(routine):
                    each_statement(body, partial(flow.values_of, scope=inner, routine=routine))
        return flow

    def feed_place(self, target: ir.Expression, value: ir.Expression, scope: Scope) -> None:
        if isinstance(target, ir.Field) and target.name in self.fields:
            for place in self.roots(target.base, scope):
                self.written.setdefault((place, target.name), []).append((value, scope))
        elif not (isinstance(target, ir.Field) and target.name in _PARTS):
            for place in self.roots(target, scope):
                self.feed(place, value, scope)

    def feed(self, place: int, value: ir.Expression, scope: Scope) -> None:
        found = set(self.roots(value, scope))
        if isinstance(value, ir.Aggregate):
            self.aggregates[id(value)] = (value, scope)
            found = {id(value)}
        if found:
            self.sources.setdefault(place, set()).update(found)
        else:
            self.unknown.add(place)

    def values(self, place: ir.Expression, flag: str, scope: Scope, asked: frozenset[int] = frozenset()) -> FlagValues:
        """The numbers that the flag of a place may be."""
        places: set[int] = set()
        made: set[int] = set()
        work, seen = list(self.roots(place, scope)), set(asked)
        complete = bool(work)
        while work:
            key = work.pop()
            if key in seen:
                continue
            seen.add(key)
            complete = complete and key not in self.unknown
            for value, home in self.written.get((key, flag), ()):
                found = self.given(value, flag, home, frozenset(seen))
                made |= found.places | found.set
                complete = complete and found.complete
            if key in self.aggregates:
                number = _flag_of(*self.aggregates[key], flag, self.unchanged)
                complete = complete and number is not None
                places |= {number} if number is not None else set()
            else:
                work.extend(self.sources.get(key, ()))
        return FlagValues(frozenset(places), frozenset(made), complete)

    def given(self, value: ir.Expression, flag: str, scope: Scope, asked: frozenset[int] = frozenset()) -> FlagValues:
        """The numbers that a value given to a flag may be: a number, or the same flag of another place."""
        if isinstance(value, ir.Field) and value.name == flag:
            return self.values(value.base, flag, scope, asked)
        number = constant(value, scope, self.unchanged)
        if isinstance(number, int) and not isinstance(number, bool):
            return FlagValues(frozenset(), frozenset((number,)), True)
        return FlagValues(frozenset(), frozenset(), False)


def _flag_of(place: ir.Aggregate, scope: Scope, flag: str, unchanged: Unchanged | None) -> int | None:
    value = constant(place, scope, unchanged)
    found = dict(value.flags).get(flag) if isinstance(value, Target) else None
    if found is not None:
        return found
    written = next((entry for name, entry in place.entries if name == flag), None)
    number = constant(written, scope, unchanged) if written is not None else None
    return number if isinstance(number, int) else None


def only_turns(arm: RobotModel, notation: Notation, flag: str) -> bool:
    """Do the other flags of the notation name the posture of the arm by themselves? Joint values from all over the
    ranges are tried, the same ones each time."""
    import numpy as np  # most translations ask nothing of the arm

    low, high = arm.limits[:, 0], arm.limits[:, 1]
    spread = np.random.default_rng(1).uniform(0.0, 1.0, size=(_TRIED, len(low)))
    known: dict[tuple[tuple[str, int], ...], object] = {}
    for joints in low + spread * (high - low):
        shown = notation.encode(arm, joints)
        others = tuple((name, value) for name, value in sorted(shown.items()) if name != flag)
        posture = arm.posture(joints).branch
        if known.setdefault(others, posture) != posture:
            return False
    return True

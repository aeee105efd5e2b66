"""Single angles of places that are written with other angles than the target gives back, for targets that keep a
rotation in their place: {A 0, B 180, C 0} comes back as {A 180, B 0, C 180}.

The place itself is the same. What reads one of its angles, or sets one and keeps the others, is named. A change of A or
C by a difference turns the place alike in both forms. Values go from variable to variable as whole places, through
arguments and results; products, inverses and what the controller tells are in the usual range everywhere.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field

from rpl import ir
from rpl.diagnostics import Severity, code
from rpl.ir.columns import as_float
from rpl.ir.walk import walk
from rpl.passes.capabilities import PlaceRule
from rpl.passes.legalise.context import Context
from rpl.passes.legalise.facts.effects import root
from rpl.passes.legalise.kinds import walk_for
from rpl.passes.legalise.stages import legalising
from rpl.passes.scope import ProgramScope, Scope
from rpl.passes.typing import type_of
from rpl.source import NOWHERE, Origin

ANGLE_RANGE = code(
    "angles-normalised",
    Severity.LOSS,
    "{name} may hold a place whose angles are written as the controller would not say them (B beyond 90 degrees, A or"
    " C beyond 180); the target keeps rotations, so a single angle read back or changed here comes from another of the"
    " equal forms",
    "write the place with B between -90 and 90 degrees",
)
_LIMITS = {"a": 180.0, "b": 90.0, "c": 180.0}
_PLACES = (ir.PoseType, ir.TargetType)
Key = tuple[str, str]


@legalising(
    unless=lambda context: (
        PlaceRule.KEEP_ANGLES in context.capabilities.places.rules
        and PlaceRule.QUATERNIONS not in context.capabilities.places.rules
    )
)
def named_angles(program: ir.Program, context: Context) -> ir.Program:
    """Looks only; for targets that keep rotations."""
    if any(_unusual(node) for node in walk_for({"Aggregate", "Assign"}, *program.modules)):
        _Angles(program, context).report()
    return program


def _unusual(node: object) -> bool:
    match node:
        case ir.Aggregate():
            return _beyond(node)
        case ir.Assign(target=ir.Field(name=name), value=value):
            return _beyond(ir.Aggregate(((name, value),)))
    return False


def _number(value: ir.Expression) -> float | None:
    match value:
        case ir.Unary(op="-", operand=operand):
            number = _number(operand)
            return None if number is None else -number
        case ir.Quantity(value=inner):
            return _number(inner)
        case ir.IntLiteral(value=known) | ir.RealLiteral(value=known):
            return as_float(known)
    return None


def _beyond(place: ir.Aggregate) -> bool:
    """Is an angle written out beyond its usual range?"""
    for name, value in place.entries:
        limit = _LIMITS.get(name or "")
        number = _number(value) if limit is not None else None
        if limit is not None and number is not None and abs(number) > limit:
            return True
    return False


def _increment(statement: ir.Assign) -> bool:
    """`p.a := p.a + 10`: the same turn in both forms."""
    match statement:
        case ir.Assign(target=ir.Field(name="a" | "c") as target, value=ir.Binary(op="+" | "-", left=left)):
            return left == target
    return False


@dataclass(slots=True)
class _Angles:
    """Variables by routine (empty: of a module) and folded name. `ways`: where a whole place goes from each."""

    program: ir.Program
    context: Context
    ways: dict[Key, set[Key]] = field(default_factory=dict)
    held: set[Key] = field(default_factory=set)
    own: dict[str, set[str]] = field(default_factory=dict)
    routines: dict[str, ir.Routine] = field(default_factory=dict)
    here: str = ""

    def key(self, name: str) -> Key:
        folded = name.lower()
        return (self.here, folded) if folded in self.own.get(self.here, ()) else ("", folded)

    def report(self) -> None:
        parts = list(self.parts())
        for name, part in parts:
            self.here = name
            for node in walk(part):
                self.look(node)
        work = list(self.held)
        while work:
            new = self.ways.get(work.pop(), set()) - self.held
            self.held |= new
            work.extend(new)
        scopes = ProgramScope(self.program)
        for module, routine in scopes.routines():
            self.here = routine.name.lower()
            self.read(routine, scopes.routine(module, routine))

    def parts(self) -> Iterator[tuple[str, object]]:
        for module in self.program.modules:
            for routine in module.routines:
                name = routine.name.lower()
                self.routines[name] = routine
                self.own[name] = {one.name.lower() for one in routine.parameters}
                self.own[name] |= {one.name.lower() for one in routine.declarations if isinstance(one, ir.Variable)}
                yield name, routine
            yield from (("", one) for one in module.declarations)

    def look(self, node: object) -> None:
        match node:
            case ir.Variable(name=name, initial=initial) if initial is not None:
                self.goes(initial, self.key(name))
            case ir.Assign(target=target, value=value):
                place = root(target)
                if isinstance(place, ir.Name):
                    self.goes(value, self.key(place.id))
                    if _unusual(node):
                        self.held.add(self.key(place.id))
            case ir.Return(value=value) if value is not None:
                self.goes(value, ("", f"{self.here}()"))
            case ir.Call(name=name, arguments=arguments) | ir.CallRoutine(name=name, arguments=arguments):
                self.passed(name, arguments)

    def passed(self, name: str, arguments: tuple[ir.Argument, ...]) -> None:
        routine = self.routines.get(name.lower())
        for parameter, argument in zip(routine.parameters if routine else (), arguments, strict=False):
            inside = (name.lower(), parameter.name.lower())
            if argument.value is None:
                continue
            self.goes(argument.value, inside)
            outer = root(argument.value)
            if parameter.mode == "reference" and isinstance(outer, ir.Name):
                self.ways.setdefault(inside, set()).add(self.key(outer.id))

    def goes(self, value: ir.Expression, to: Key) -> None:
        """A whole place, or a record or list of such, comes to a variable."""
        match value:
            case ir.Aggregate(entries=entries):
                if _beyond(value):
                    self.held.add(to)
                for _, one in entries:
                    self.goes(one, to)
            case ir.Field(name="a" | "b" | "c" | "x" | "y" | "z"):
                return
            case ir.Name() | ir.Index() | ir.Field():
                place = root(value)
                if isinstance(place, ir.Name):
                    self.ways.setdefault(self.key(place.id), set()).add(to)
            case ir.Call(name=name):
                self.ways.setdefault(("", f"{name.lower()}()"), set()).add(to)

    def read(self, routine: ir.Routine, scope: Scope) -> None:
        """Names the statements of a routine that need a single angle."""
        told: set[Origin] = set()
        quiet = _quiet(routine)
        last = NOWHERE
        for node in walk(routine):
            if isinstance(node, ir.Statement):
                last = node.origin
            if isinstance(node, ir.Field) and node.name in _LIMITS and id(node) not in quiet and last not in told:
                place = root(node)
                if not isinstance(place, ir.Name) or self.key(place.id) not in self.held:
                    continue
                if isinstance(type_of(node.base, scope), _PLACES):
                    told.add(last)
                    self.context.diagnostics.report(ANGLE_RANGE, last, name=place.id)


def _quiet(routine: ir.Routine) -> set[int]:
    """Uses of single angles (identities of nodes) that come to the same: those of a place whose angles the routine sets
    all, of a place that has just been set as a whole, and changes by a difference."""
    sets: dict[ir.Expression, set[str]] = {}
    statements = [node for node in walk(routine) if isinstance(node, ir.Statement)]
    for node in statements:
        if isinstance(node, ir.Assign) and isinstance(node.target, ir.Field):
            sets.setdefault(node.target.base, set()).add(node.target.name)
    quiet: set[int] = set()
    fresh: list[ir.Expression] = []
    for node in statements:
        match node:
            case ir.Assign(target=ir.Field(base=base, name=name) as target, value=value) if name in _LIMITS:
                if base in fresh or set(_LIMITS) <= sets[base]:
                    quiet.add(id(target))
                if _increment(node) and isinstance(value, ir.Binary):
                    quiet |= {id(target), id(value.left)}
                if _unusual(node) or _number(value) is None:
                    fresh.clear()
            case ir.Assign(target=ir.Field(name="x" | "y" | "z")):
                continue
            case ir.Assign(target=target, value=ir.System() | ir.Aggregate() as value) if not _unusual(value):
                fresh = [target]
            case _:
                fresh.clear()
    return quiet


__all__ = ["named_angles"]

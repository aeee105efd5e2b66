"""Places moved by a way without a turn, for targets whose programs have no functions: the source adds poses, mostly in
a small function of its own; people of these targets write the point and the way that it is moved by.
"""

from __future__ import annotations

from collections import Counter
from dataclasses import dataclass, field, replace

from rpl import ir
from rpl.ir.walk import rewrite, walk
from rpl.passes.capabilities import RoutineRule
from rpl.passes.fold import constant_number
from rpl.passes.legalise.context import Context
from rpl.passes.legalise.facts.effects import repeatable
from rpl.passes.legalise.facts.usage import usage_of
from rpl.passes.legalise.stages import legalising
from rpl.passes.rewrite import changed
from rpl.passes.scope import ProgramScope, Scope

_LENGTHS = ("m", "cm", "mm")


@legalising(
    unless=lambda context: RoutineRule.FUNCTIONS in context.capabilities.routines.rules, sees=("function pose_sum",)
)
def shifted_places(program: ir.Program, context: Context) -> ir.Program:
    """Only for targets without functions. A function that only gives such a place is written where it is called."""
    scopes = ProgramScope(program)
    modules = []
    for module in program.modules:
        routines = []
        for routine in module.routines:
            worker = _Sums(scopes.routine(module, routine), bool(context.capabilities.storage.banks))
            routines.append(rewrite(routine, worker.changed))
        modules.append(changed(module, routines=tuple(routines)))
    done = changed(program, modules=tuple(modules))
    return program if done is program else _inlined(done)


@dataclass(frozen=True, slots=True)
class _Sums:
    scope: Scope
    numbered: bool  # constants have no names in the target

    def changed(self, node: object) -> object:
        match node:
            case ir.Builtin(function="pose_sum", arguments=(one, other)):
                for way, place in ((one, other), (other, one)):
                    parts = self.way(way)
                    if parts is not None:
                        return ir.Builtin("offset", (place, *parts), origin=node.origin)
        return node

    def way(self, pose: ir.Expression) -> tuple[ir.Expression, ...] | None:
        """x, y and z of a pose that is written without a turn."""
        match pose:
            case ir.Builtin(function="pose_from_rotation_vector", arguments=(x, y, z, *turn)):
                if all(self.number(one) == 0 for one in turn):
                    return tuple(map(self.length, (x, y, z)))
        return None

    def number(self, value: ir.Expression) -> float | None:
        return constant_number(value.value if isinstance(value, ir.Quantity) else value, self.scope)

    def length(self, value: ir.Expression) -> ir.Expression:
        """In mm, with the numbers put together where constants are numbers in the target anyway."""
        if not self.numbered or not isinstance(value, ir.Quantity) or value.unit not in _LENGTHS:
            return value
        factor = ir.UNITS[value.unit]
        known = constant_number(value.value, self.scope)
        if known is not None:
            return ir.RealLiteral(round(known * factor, 9), origin=value.origin)
        match value.value:
            case ir.Binary(op="*", left=left, right=right):
                for one, other in ((left, right), (right, left)):
                    known = constant_number(other, self.scope)
                    if known is not None:
                        return ir.Binary("*", one, ir.RealLiteral(round(known * factor, 9)), origin=value.origin)
        return value


@dataclass(slots=True)
class _Function:
    """A function of one expression: what it is of, and what it gives."""

    parameters: tuple[str, ...]
    value: ir.Expression
    names: frozenset[str]  # what else it reads; nothing assigns it
    uses: Counter[str] = field(default_factory=Counter)


def _inlined(program: ir.Program) -> ir.Program:
    functions = _functions(program)
    if not functions:
        return program
    left: set[str] = set()
    modules = []
    for module in program.modules:
        routines = []
        for routine in module.routines:
            own = {one.name.lower() for one in (*routine.parameters, *routine.declarations) if hasattr(one, "name")}

            def called(node: object, own: set[str] = own) -> object:
                found = functions.get(node.name.lower()) if isinstance(node, ir.Call) else None
                if found is None or not isinstance(node, ir.Call):
                    return node
                value = None if found.names & own else _value(found, node)
                if value is None:
                    left.add(node.name.lower())
                return node if value is None else value

            routines.append(rewrite(routine, called))
        modules.append(changed(module, routines=tuple(routines)))
    done = changed(program, modules=tuple(modules))
    gone = {name for name in functions if name not in left} - {program.entry.lower()}
    return replace(
        done,
        modules=tuple(
            replace(one, routines=tuple(each for each in one.routines if each.name.lower() not in gone))
            for one in done.modules
        ),
    )


def _functions(program: ir.Program) -> dict[str, _Function]:
    """The functions that only give a shifted place, by their folded names; each name stands for one."""
    named = Counter(routine.name.lower() for module in program.modules for routine in module.routines)
    assigned = usage_of(program).assigned
    found: dict[str, _Function] = {}
    for module in program.modules:
        for routine in module.routines:
            function = _function(routine, assigned)
            if function is not None and named[routine.name.lower()] == 1:
                found[routine.name.lower()] = function
    return found


def _function(routine: ir.Routine, assigned: set[str]) -> _Function | None:
    match routine:
        case ir.Routine(
            kind="function",
            declarations=(),
            body=(ir.Return(value=ir.Builtin(function="offset") as value),),
            handlers=(),
            undo=(),
            backward=(),
        ) if all(one.mode == "value" and not one.optional for one in routine.parameters):
            pass
        case _:
            return None
    given = {one.name.lower() for one in routine.parameters}
    uses = Counter(one.id.lower() for one in walk(value) if isinstance(one, ir.Name))
    others = frozenset(uses) - given
    plain = all(isinstance(one, ir.Expression) and not isinstance(one, ir.Call) for one in walk(value))
    if not plain or others & assigned:
        return None
    return _Function(tuple(one.name.lower() for one in routine.parameters), value, others, uses)


def _value(function: _Function, call: ir.Call) -> ir.Expression | None:
    """What the call gives, written out; None where an argument would be worked out several times."""
    given = [one.value for one in call.arguments if one.name is None and one.if_present is None]
    if len(given) != len(function.parameters) or len(given) != len(call.arguments):
        return None
    values: dict[str, ir.Expression] = {}
    for name, one in zip(function.parameters, given, strict=True):
        if one is None or (function.uses[name] != 1 and not repeatable(one)):
            return None
        values[name] = one

    def argument(node: object) -> object:
        return values.get(node.id.lower(), node) if isinstance(node, ir.Name) else node

    return rewrite(function.value, argument)


__all__ = ["shifted_places"]

"""How each written target is used: the moves that it serves, with the tool and frame in force there.

A target reaches moves through variables, arrays, parameters and results.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field
from functools import partial

from rpl import ir
from rpl.ir.walk import bodies
from rpl.passes.fold import constant
from rpl.passes.legalise.facts.framesinforce import Frames, FramesInForce
from rpl.passes.legalise.facts.usage import each_expression, each_statement
from rpl.passes.scope import ProgramScope, Scope


@dataclass(frozen=True, slots=True)
class Use:
    """One way a target is used. `joint`: its arm configuration chooses the posture. `moved`: name and numbers of the
    function that moves it first (offset, tool_offset), when these are constant."""

    frames: Frames
    joint: bool
    moved: tuple[str, tuple[float, ...]] | None = None


@dataclass(slots=True)
class Uses:
    """For each written target (an aggregate, by identity) how it is used."""

    found: dict[int, set[Use]] = field(default_factory=dict)
    sources: dict[int, set[int]] = field(default_factory=dict)
    moves: list[tuple[int, Use]] = field(default_factory=list)
    order: dict[Use, int] = field(default_factory=dict)  # of the uses, as their moves stand in the program
    keep: list[object] = field(default_factory=list)

    @classmethod
    def of(cls, program: ir.Program, scopes: ProgramScope) -> Uses:
        uses = cls()
        flow = FramesInForce(program)
        for module in program.modules:
            scope = scopes.module(module)
            uses.declared(module.declarations, scope)
            for routine in module.routines:
                inner = scopes.routine(module, routine)
                uses.declared(routine.declarations, inner)
                for body in bodies(routine):
                    each_statement(body, partial(uses.statement, scope=inner, routine=routine, flow=flow))
        uses.spread()
        return uses

    def declared(self, declarations: tuple[ir.Declaration, ...], scope: Scope) -> None:
        for one in declarations:
            match one:
                case ir.Variable(initial=initial) if initial is not None:
                    self.feed(id(one), initial, scope)
                case ir.Initialise(assign=assign):
                    self.feed_place(assign.target, assign.value, scope)

    def statement(self, statement: ir.Statement, scope: Scope, routine: ir.Routine, flow: FramesInForce) -> None:
        if isinstance(statement, ir.Move):
            frames = flow.frames.get(id(statement), Frames(None, None))
            for place in (statement.target, statement.via):
                if place is not None:
                    use = Use(frames, statement.kind == "joint", _moved(place, scope))
                    self.moves.extend((root, use) for root in self.roots(place, scope))
        self.values_of(statement, scope, routine)

    def values_of(self, statement: ir.Statement, scope: Scope, routine: ir.Routine) -> None:
        """What the statement puts where: by assignments, results, and arguments of calls."""
        match statement:
            case ir.Assign(target=target, value=value):
                self.feed_place(target, value, scope)
            case ir.Return(value=value) if value is not None:
                self.feed(id(routine), value, scope)
            case ir.CallRoutine(name=name, arguments=arguments, dynamic=None):
                self.passed(name, arguments, scope)

        def look(expression: ir.Expression) -> None:
            if isinstance(expression, ir.Call):
                self.passed(expression.name, expression.arguments, scope)

        each_expression(statement, look)

    def passed(self, name: str, arguments: tuple[ir.Argument, ...], scope: Scope) -> None:
        routine = scope.routine(name)
        if routine is None:
            return
        required = [one for one in routine.parameters if not one.optional]
        by_name = {one.name.lower(): one for one in routine.parameters}
        for at, argument in enumerate(arguments):
            if argument.value is None:
                continue
            positional = required[at] if at < len(required) else None
            parameter = by_name.get(argument.name.lower()) if argument.name else positional
            if parameter is not None:
                self.feed(id(parameter), argument.value, scope)
                if parameter.mode == "reference":
                    for root in self.roots(argument.value, scope):
                        self.sources.setdefault(root, set()).add(id(parameter))

    def feed_place(self, target: ir.Expression, value: ir.Expression, scope: Scope) -> None:
        for place in self.roots(target, scope):
            self.feed(place, value, scope)

    def feed(self, place: int, value: ir.Expression, scope: Scope) -> None:
        found = set(self.roots(value, scope))
        if found:
            self.sources.setdefault(place, set()).update(found)

    def roots(self, value: ir.Expression, scope: Scope) -> Iterator[int]:
        """What a value's arm configuration comes from: declarations, routines, written aggregates."""
        match value:
            case ir.Name(id=name):
                symbol = scope.value(name)
                if symbol is not None:
                    yield id(symbol.declaration)
            case ir.Index(base=base) | ir.Field(base=base):
                yield from self.roots(base, scope)
            case ir.Binary(op=":", right=right):
                yield from self.roots(right, scope)
            case ir.Builtin(arguments=(first, *_)):
                yield from self.roots(first, scope)
            case ir.Call(name=name):
                routine = scope.routine(name)
                if routine is not None:
                    yield id(routine)
            case ir.Aggregate(entries=entries):
                yield id(value)
                self.keep.append(value)
                for _, entry in entries:
                    self.sources.setdefault(id(value), set()).update(self.roots(entry, scope))

    def reach(self, value: ir.Expression, scope: Scope) -> set[int]:
        """Everything that the value's arm configuration may come from."""
        found: set[int] = set()
        work = list(self.roots(value, scope))
        while work:
            key = work.pop()
            if key not in found:
                found.add(key)
                work.extend(self.sources.get(key, ()))
        return found

    def spread(self) -> None:
        for _, use in self.moves:
            self.order.setdefault(use, len(self.order))
        work = list(self.moves)
        while work:
            key, use = work.pop()
            have = self.found.setdefault(key, set())
            if use in have:
                continue
            have.add(use)
            work.extend((source, use) for source in self.sources.get(key, ()))


def _moved(place: ir.Expression, scope: Scope) -> tuple[str, tuple[float, ...]] | None:
    """By which constant numbers a move's target is moved first."""
    match place:
        case ir.Builtin(function="offset" | "tool_offset" as function, arguments=(_, *rest)):
            values = [constant(one, scope) for one in rest]
            numbers = tuple(float(value) for value in values if isinstance(value, int | float))
            return (function, numbers) if len(numbers) == len(values) and any(numbers) else None
    return None


__all__ = ["Use", "Uses"]

"""What variables of a program hold where a statement runs, as far as every way to it has given them the same value.

A value is closed: made of literals and of names of taught data that nothing assigns, so it means the same anywhere in
the program. Taught data stays its name, for it is taught anew. Only variables that assignments alone change are
followed, and none that an interrupt, a trigger or another task assigns.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field

from rpl import ir
from rpl.passes.fold import is_taught_type
from rpl.passes.legalise.facts.inforce import InForce
from rpl.passes.legalise.facts.usage import base_name, usage_of
from rpl.passes.scope import ProgramScope, Scope

Held = Mapping[str, ir.Expression]  # folded name -> closed value
NOTHING_HELD: Held = {}
_LITERALS = (ir.IntLiteral, ir.RealLiteral, ir.BoolLiteral, ir.TextLiteral, ir.EnumLiteral)
_DEEPEST = 16  # data that begins with other data; a longer chain is a cycle


@dataclass(slots=True)
class KnownData:
    """The data of a program that nothing assigns, by what it begins with."""

    program: ir.Program
    scopes: ProgramScope
    assigned: set[str]
    otherwise: set[str]
    initialised: dict[str, list[tuple[ir.Expression, ir.Module]]] = field(default_factory=dict)
    """Data lists: folded name -> whole values; an empty list where they set parts of it."""
    declared: Counter[str] = field(default_factory=Counter)

    @classmethod
    def of(cls, program: ir.Program) -> KnownData:
        bare = tuple(ir.Module(one.name, one.dialect, routines=one.routines, task=one.task) for one in program.modules)
        usage = usage_of(ir.Program(bare, program.tasks, program.entry))
        known = cls(program, ProgramScope(program), usage.assigned, usage.otherwise)
        for module in program.modules:
            for one in module.declarations:
                if isinstance(one, ir.Variable):
                    known.declared[one.name.lower()] += 1
                elif isinstance(one, ir.Initialise):
                    known.listed(one.assign, module)
            for routine in module.routines:
                known.declared.update(one.name.lower() for one in routine.parameters)
                known.declared.update(one.name.lower() for one in routine.declarations if isinstance(one, ir.Variable))
        return known

    def listed(self, assign: ir.Assign, module: ir.Module) -> None:
        name = base_name(assign.target)
        if name is not None:
            whole = isinstance(assign.target, ir.Name)
            self.initialised[name] = [*self.initialised.get(name, []), (assign.value, module)] if whole else []

    def closed(
        self, value: ir.Expression, scope: Scope, held: Held = NOTHING_HELD, depth: int = 0
    ) -> ir.Expression | None:
        """The value in terms of literals and taught data; None where the run may decide it."""
        match value:
            case _ if isinstance(value, _LITERALS):
                return value
            case ir.System(name="null_frame" | "world"):
                return value
            case ir.Unary(op="-", operand=ir.IntLiteral() | ir.RealLiteral()):
                return value
            case ir.Aggregate(entries=entries):
                done = [(name, self.closed(entry, scope, held, depth)) for name, entry in entries]
                parts = tuple((name, entry) for name, entry in done if entry is not None)
                return ir.Aggregate(parts, value.type_name, origin=value.origin) if len(parts) == len(done) else None
            case ir.Field(base=base, name=name):
                whole = self.closed(base, scope, held, depth)
                return None if whole is None else component(whole, name)
            case ir.Index(base=ir.Name(id=name), indices=indices) if self.is_fixed_place(name, scope):
                places = [self.closed(one, scope, held, depth) for one in indices]
                numbers = tuple(one for one in places if isinstance(one, ir.IntLiteral))
                return ir.Index(value.base, numbers) if len(numbers) == len(places) else None
            case ir.Name(id=name):
                found = held.get(name.lower())
                return found if found is not None else self.begun(name, scope, depth)
        return None

    def begun(self, name: str, scope: Scope, depth: int) -> ir.Expression | None:
        """What a datum holds that nothing assigns; itself where it is taught."""
        symbol, key = scope.value(name), name.lower()
        if symbol is None or not isinstance(symbol.declaration, ir.Variable) or depth > _DEEPEST:
            return None
        declaration = symbol.declaration
        if symbol.routine is not None or symbol.module is None or key in self.assigned:
            return None
        if self.is_fixed_place(name, scope):
            return ir.Name(name)
        if is_taught_type(declaration.type, scope) or isinstance(declaration.type, ir.ArrayType):
            return None
        listed = self.initialised.get(key)
        if listed is None and declaration.initial is not None:
            return self.closed(declaration.initial, self.scopes.module(symbol.module), depth=depth + 1)
        if listed is not None and len(listed) == 1 and declaration.initial is None and self.declared[key] == 1:
            return self.closed(listed[0][0], self.scopes.module(listed[0][1]), depth=depth + 1)
        return None

    def is_fixed_place(self, name: str, scope: Scope) -> bool:
        """Is it taught data of this one name, which nothing assigns?"""
        symbol, key = scope.value(name), name.lower()
        return (
            symbol is not None
            and symbol.module is not None
            and isinstance(symbol.declaration, ir.Variable)
            and key not in self.assigned
            and self.declared[key] == 1
            and is_taught_type(symbol.declaration.type, scope)
        )


def component(whole: ir.Expression, name: str) -> ir.Expression | None:
    """A component of a value that is written out; None where that leaves it out, or names the value only."""
    if isinstance(whole, ir.Aggregate):
        for key, entry in whole.entries:
            if key is not None and key.lower() == name.lower():
                return entry
    return None


@dataclass(slots=True)
class HeldValues:
    """What the variables `names` (folded) hold in front of each statement. Of others nothing is known."""

    known: KnownData
    at: dict[int, Held] = field(default_factory=dict)
    kept: list[ir.Statement] = field(default_factory=list)  # keeps the identities alive

    @classmethod
    def of(cls, known: KnownData, names: Iterable[str]) -> HeldValues:
        values = cls(known)
        _Holding(values, names).follow_program()
        return values

    def before(self, statement: ir.Statement) -> Held:
        return self.at.get(id(statement), NOTHING_HELD)


class _Holding(InForce[ir.Expression]):
    """`followed`: those of the names that assignments alone change, and these at known times."""

    def __init__(self, values: HeldValues, names: Iterable[str]) -> None:
        known = values.known
        super().__init__(known.program, NOTHING_HELD)
        self.values = values
        plain = (name for name in names if known.declared[name] == 1 and name not in known.otherwise)
        self.followed = frozenset(plain) - self.unsure

    def follow_program(self) -> None:
        if self.followed:
            super().follow_program()

    def transfer(self, statement: ir.Statement, before: Held) -> Held:
        match statement:
            case ir.Opaque() | ir.Vendor(effect="unknown"):
                return NOTHING_HELD
        return super().transfer(statement, before)

    def assigned(self, name: str, target: ir.Expression, value: ir.Expression, before: Held) -> Held:
        if name not in self.followed:
            return before
        given = self.values.known.closed(value, self.scope, before) if isinstance(target, ir.Name) else None
        return self.without(before, {name}) if given is None else {**before, name: given}

    def passed(self, call: ir.CallRoutine | ir.Call, state: Held) -> Held:
        return state if self.meant(call) else NOTHING_HELD

    def inner(self, statement: ir.Statement, state: Held | None) -> Held | None:
        if self.noting and state is not None:
            self.met(statement, state)
        return super().inner(statement, state)

    def met(self, statement: ir.Statement, before: Held) -> None:
        """Nothing is said of loops, whose condition is looked at again, nor where functions change what is followed."""
        inner = [call for call in self.calls_in(statement) if isinstance(call, ir.Call)]
        changing = any(not self.followed.isdisjoint(self.changed.get(call.name.lower(), ())) for call in inner)
        if changing or isinstance(statement, ir.While | ir.For | ir.Repeat | ir.Loop):
            return
        known = self.values.at.get(id(statement))
        if known is None:
            self.values.kept.append(statement)
        self.values.at[id(statement)] = before if known is None else self.join(known, before)


__all__ = ["Held", "HeldValues", "KnownData", "component"]

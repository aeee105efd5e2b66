"""Symbol tables: which declaration a name means at a place, by the visibility and case rules of its language.

Inner hides outer: routine, module, the other modules of the task (what is not local to them), the dialect's prelude.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field
from functools import cache

from rpl import ir, registry
from rpl.ir.rules import Rules

ValueDeclaration = ir.Variable | ir.Parameter | ir.SignalDeclaration
TypeDeclaration = ir.RecordDeclaration | ir.EnumDeclaration | ir.AliasDeclaration


@dataclass(frozen=True, slots=True)
class Symbol:
    """A found value: its declaration and where it lives (module None: a routine's own, or the prelude's)."""

    declaration: ValueDeclaration
    module: ir.Module | None
    routine: ir.Routine | None = None

    @property
    def type(self) -> ir.Type:
        declaration = self.declaration
        if isinstance(declaration, ir.SignalDeclaration):
            return signal_type(declaration.signal)
        return declaration.type


def signal_type(signal: ir.Signal) -> ir.Type:
    """What reading the signal gives: BOOL for one bit, whole number for a group, real for analog."""
    if signal.last is not None or signal.kind.startswith("group"):
        return ir.IntType()
    return ir.RealType() if signal.kind.startswith("analog") else ir.BoolType()


@dataclass(slots=True)
class _Table:
    """What one container declares, by folded name."""

    values: dict[str, ValueDeclaration] = field(default_factory=dict)
    types: dict[str, TypeDeclaration] = field(default_factory=dict)
    routines: dict[str, ir.Routine] = field(default_factory=dict)
    members: dict[str, ir.EnumDeclaration] = field(default_factory=dict)

    def add(self, declarations: Iterable[ir.Declaration], fold: Fold, visible_outside: bool = False) -> None:
        for declaration in declarations:
            match declaration:
                case ir.Variable() | ir.SignalDeclaration():
                    if not (visible_outside and declaration.scope == "module"):
                        self.values.setdefault(fold(declaration.name), declaration)
                case ir.VariableRows(sample=sample):  # who asks for a name asks for that of a sample
                    self.values.setdefault(fold(sample.name), sample)
                case ir.RecordDeclaration() | ir.EnumDeclaration() | ir.AliasDeclaration():
                    if visible_outside and declaration.scope == "module":
                        continue
                    self.types.setdefault(fold(declaration.name), declaration)
                    if isinstance(declaration, ir.EnumDeclaration):
                        for member in declaration.members:
                            self.members.setdefault(fold(member), declaration)
                case _:
                    continue


class Fold:
    """Names as keys: folded to lower case where the language ignores case."""

    __slots__ = ("sensitive",)

    def __init__(self, sensitive: bool) -> None:
        self.sensitive = sensitive

    def __call__(self, name: str) -> str:
        return name if self.sensitive else name.lower()


@cache
def _prelude_table(dialect: str) -> _Table:
    table = _Table()
    module = registry.dialect(dialect).prelude()
    if module is not None:
        fold = Fold(rules_of(dialect).case_sensitive)
        table.add(module.declarations, fold)
        table.routines.update((fold(routine.name), routine) for routine in module.routines)
    return table


@cache
def rules_of(dialect: str) -> Rules:
    """The rules of a dialect by name."""
    return registry.dialect(dialect).rules()


class ProgramScope:
    """Symbol tables of a whole program. Build once, ask often."""

    def __init__(self, program: ir.Program) -> None:
        self.program = program
        self._own: dict[int, _Table] = {}
        self._shared: dict[tuple[str, bool], _Table] = {}
        self._homes: dict[int, ir.Module] = {}  # of routines and declarations, by identity
        self._tasks = {module.task for module in program.modules} | {""}
        for module in sorted(program.modules, key=lambda one: not one.task):
            self._enter(module)

    def _enter(self, module: ir.Module) -> None:
        fold = Fold(rules_of(module.dialect).case_sensitive)
        own = _Table()
        own.add(module.declarations, fold)
        self._own[id(module)] = own
        for declaration in module.declarations:
            self._homes[id(declaration)] = module
        for task in self._seen_in(module):
            shared = self._shared.setdefault((task, fold.sensitive), _Table())
            shared.add(module.declarations, fold, visible_outside=True)
        for routine in module.routines:
            key = fold(routine.name)
            own.routines.setdefault(key, routine)
            self._homes[id(routine)] = module
            if routine.scope != "module":
                for task in self._seen_in(module):
                    self._shared[task, fold.sensitive].routines.setdefault(key, routine)

    def _seen_in(self, module: ir.Module) -> set[str]:
        """The tasks that see a module; one of no task is seen in all of them, where they have nothing of the name."""
        return {module.task, ""} if module.task else self._tasks

    def module(self, module: ir.Module) -> Scope:
        """The scope of a module's own declarations."""
        return Scope(self, module, None, {})

    def routine(self, module: ir.Module, routine: ir.Routine) -> Scope:
        """The scope inside a routine."""
        fold = Fold(rules_of(module.dialect).case_sensitive)
        local: dict[str, ValueDeclaration] = {fold(parameter.name): parameter for parameter in routine.parameters}
        table = _Table(values=local)
        table.add(routine.declarations, fold)
        for declaration in routine.declarations:  # a declaration refines its parameter (KRL declares types after DEF)
            if isinstance(declaration, ir.Variable):
                table.values.setdefault(fold(declaration.name), declaration)
        return Scope(self, module, routine, table.values, table.types)

    def home(self, declared: ir.Routine | ir.Declaration | ir.Parameter) -> ir.Module | None:
        """The module of one of the program's routines or declarations; None for a prelude's."""
        return self._homes.get(id(declared))

    def routines(self) -> Iterator[tuple[ir.Module, ir.Routine]]:
        for module in self.program.modules:
            for routine in module.routines:
                yield module, routine

    def own_table(self, module: ir.Module) -> _Table:
        return self._own[id(module)] if id(module) in self._own else _Table()

    def shared_table(self, module: ir.Module, sensitive: bool) -> _Table:
        return self._shared.get((module.task, sensitive)) or _Table()


class Scope:
    """What names mean at one place. Immutable; `with_value` gives an inner scope (a loop's own counter). `chains`:
    operations on operations, by identity, with what is known of them: who asks for one asks for those in it."""

    __slots__ = ("_local", "_local_types", "chains", "fold", "module", "program", "routine_here", "rules")

    def __init__(
        self,
        program: ProgramScope,
        module: ir.Module,
        routine: ir.Routine | None,
        local: dict[str, ValueDeclaration],
        local_types: dict[str, TypeDeclaration] | None = None,
    ) -> None:
        self.program = program
        self.module = module
        self.routine_here = routine
        self.rules = rules_of(module.dialect)
        self.fold = Fold(self.rules.case_sensitive)
        self._local = local
        self._local_types = local_types or {}
        self.chains: dict[int, tuple[ir.Binary, tuple[ir.Expression, ir.Type | None]]] = {}

    def with_value(self, declaration: ir.Variable) -> Scope:
        """This scope with one more innermost variable."""
        local = {**self._local, self.fold(declaration.name): declaration}
        return Scope(self.program, self.module, self.routine_here, local, self._local_types)

    def value(self, name: str) -> Symbol | None:
        """The variable, constant, parameter or signal of that name."""
        key = self.fold(name)
        found = self._local.get(key)
        if found is not None:
            return Symbol(found, None, self.routine_here)
        found = self.program.own_table(self.module).values.get(key)
        if found is not None:
            return Symbol(found, self.module)
        found = self.program.shared_table(self.module, self.fold.sensitive).values.get(key)
        if found is not None:
            return Symbol(found, self.program.home(found))
        found = _prelude_table(self.module.dialect).values.get(key)
        return Symbol(found, None) if found is not None else None

    def routine(self, name: str) -> ir.Routine | None:
        """The routine of that name that a call here means."""
        key = self.fold(name)
        return (
            self.program.own_table(self.module).routines.get(key)
            or self.program.shared_table(self.module, self.fold.sensitive).routines.get(key)
            or _prelude_table(self.module.dialect).routines.get(key)
        )

    def type(self, name: str) -> TypeDeclaration | None:
        """The record, enum or alias of that name."""
        key = self.fold(name)
        return (
            self._local_types.get(key)
            or self.program.own_table(self.module).types.get(key)
            or self.program.shared_table(self.module, self.fold.sensitive).types.get(key)
            or _prelude_table(self.module.dialect).types.get(key)
        )

    def enum_of(self, member: str) -> ir.EnumDeclaration | None:
        """The enumeration that has this member."""
        key = self.fold(member)
        return (
            self.program.own_table(self.module).members.get(key)
            or self.program.shared_table(self.module, self.fold.sensitive).members.get(key)
            or _prelude_table(self.module.dialect).members.get(key)
        )

    def resolve(self, type: ir.Type) -> ir.Type:
        """The type with aliases followed; a NamedType that stays one is a record, an enum, or unknown."""
        for _ in range(32):  # an alias chain longer than this can only be a cycle
            if not isinstance(type, ir.NamedType):
                return type
            declaration = self.type(type.name)
            if not isinstance(declaration, ir.AliasDeclaration):
                return self.rules.type_names.get(self.fold(type.name), type) if declaration is None else type
            type = declaration.type
        return type

"""Temporaries of routines that are never active at the same time share their numbers, where a bank would run out.

A temporary is a variable that the passes made, that one routine alone uses, and that it sets before it reads it. Two
routines may share when neither leads to the other by calls and both run in the same thread of the program alone. So
may two temporaries of one routine that are not needed at the same time.
Nothing is shared while the numbers suffice, so that each keeps the name of what it holds.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field, replace

from rpl import ir
from rpl.ir.walk import bodies
from rpl.passes.capabilities import Bank, Local
from rpl.passes.legalise.context import Context
from rpl.passes.legalise.control.locals import renamed
from rpl.passes.legalise.control.parameters import ARGUMENTS
from rpl.passes.legalise.facts.activations import Activations
from rpl.passes.legalise.facts.effects import children, everything, statements_in
from rpl.passes.legalise.facts.liveness import wanted_at_start
from rpl.passes.legalise.rewriting.editing import edit_bodies
from rpl.passes.legalise.rewriting.support import with_support
from rpl.passes.legalise.stages import legalising
from rpl.passes.legalise.storage.banks import sizes_of
from rpl.passes.legalise.storage.lifetimes import companions
from rpl.passes.scope import ProgramScope, Scope
from rpl.source import NOWHERE

_ROOM = 12  # numbers that later passes may still need
_STEM = "rpl_work"
_KINDS = (ir.IntType, ir.RealType, ir.BoolType, ir.StringType, ir.PoseType, ir.TargetType, ir.JointsType)
_SAME = {"IntType": "RealType"}


@legalising(
    unless=lambda context: (
        not context.capabilities.storage.banks or Local.VARIABLES in context.capabilities.routines.locals
    )
)
def share_temporaries(program: ir.Program, context: Context) -> ir.Program:
    """Only for targets with banks whose routines have no variables, and only for banks that would run out."""
    can = context.capabilities
    short = _short_banks(program, can.storage.banks)
    if not short:
        return program
    facts = Activations.of(program)
    pool = _Pool(context, facts)
    given: dict[int, dict[str, str]] = {}
    for routine, variables in _temporaries(program, facts, short, can.storage.banks):
        places = companions(routine, variables)
        used = {one.name: pool.give(id(routine), one) for one in variables if places[one.name.lower()] is one}
        given[id(routine)] = {name: used[one.name] for name, one in places.items()}
    return _rewritten(program, context, given, pool)


def _short_banks(program: ir.Program, banks: Mapping[str, Bank]) -> set[str]:
    """Names of the banks with too few numbers for all variables."""
    needed: Counter[str] = Counter()
    found: dict[str, Bank] = {}
    scopes = ProgramScope(program)
    for module in program.modules:
        scope = scopes.module(module)
        for declarations in (module.declarations, *(one.declarations for one in module.routines)):
            for declaration in declarations:
                bank = _bank(declaration, scope, banks)
                if bank is not None and isinstance(declaration, ir.Variable):
                    needed[bank.name] += _count(declaration, scope)
                    found[bank.name] = bank
    return {name for name, bank in found.items() if needed[name] + _ROOM > bank.last - bank.first + 1}


def _bank(declaration: ir.Declaration, scope: Scope, banks: Mapping[str, Bank]) -> Bank | None:
    if not isinstance(declaration, ir.Variable) or declaration.storage == "constant" or declaration.name == ARGUMENTS:
        return None
    type = scope.resolve(declaration.type)
    kind = (scope.resolve(type.element) if isinstance(type, ir.ArrayType) else type).__class__.__name__
    return banks.get(kind) or banks.get(_SAME.get(kind, ""))


def _count(variable: ir.Variable, scope: Scope) -> int:
    type = scope.resolve(variable.type)
    sizes = sizes_of(type, scope) if isinstance(type, ir.ArrayType) else ()
    total = 1
    for size in sizes or ():
        total *= size
    return total


# ---- what may share


def _temporaries(
    program: ir.Program, facts: Activations, short: set[str], banks: Mapping[str, Bank]
) -> Iterator[tuple[ir.Routine, list[ir.Variable]]]:
    """Routines with their temporaries, in order."""
    uses: Counter[str] = Counter()
    names: dict[int, set[str]] = {}
    declared: Counter[str] = Counter()
    for module in program.modules:
        declared.update(one.name.lower() for one in module.declarations if isinstance(one, ir.Variable))
        for routine in module.routines:
            names[id(routine)] = set(_names(routine))
            uses.update(names[id(routine)])
            declared.update(one.name.lower() for one in routine.declarations if isinstance(one, ir.Variable))
    scopes = ProgramScope(program)
    for module in program.modules:
        scope = scopes.module(module)
        for routine in module.routines:
            if id(routine) in facts.recursive or sum(id(routine) in one for one in facts.threads) != 1:
                continue
            candidates = {}
            for one in (*module.declarations, *routine.declarations):
                bank = _bank(one, scope, banks)
                if bank is None or bank.name not in short or not isinstance(one, ir.Variable):
                    continue
                key = one.name.lower()
                alone = declared[key] == 1 and uses[key] == 1 and key in names[id(routine)]
                plain = one.origin is NOWHERE and one.initial is None and one.storage == "variable"
                if alone and plain and isinstance(scope.resolve(one.type), _KINDS):
                    candidates[key] = one
            kept = wanted_at_start(routine, frozenset(candidates))
            yield routine, [one for key, one in candidates.items() if key not in kept]


def _names(routine: ir.Routine) -> Iterator[str]:
    for body in bodies(routine):
        for statement in statements_in(body):
            if isinstance(statement, ir.For):
                yield statement.counter.lower()
            for child in children(statement):
                yield from (one.id.lower() for one in everything(child) if isinstance(one, ir.Name))


# ---- the pool


@dataclass(slots=True)
class _Pool:
    """Shared variables: name -> type and the routines that use it."""

    context: Context
    facts: Activations
    slots: list[tuple[str, ir.Type, set[int]]] = field(default_factory=list)
    reached: dict[int, set[int]] = field(default_factory=dict)

    def give(self, routine: int, variable: ir.Variable) -> str:
        """A variable for this one that no routine uses which may be active at the same time."""
        for name, type, users in self.slots:
            if type == variable.type and not any(self.together(routine, one) for one in users):
                users.add(routine)
                return name
        name = self.context.fresh(_STEM)
        self.slots.append((name, variable.type, {routine}))
        return name

    def together(self, one: int, other: int) -> bool:
        if one == other or not any(one in thread and other in thread for thread in self.facts.threads):
            return True
        return other in self.from_here(one) or one in self.from_here(other)

    def from_here(self, routine: int) -> set[int]:
        if routine not in self.reached:
            self.reached[routine] = self.facts.reached({routine})
        return self.reached[routine]


def _rewritten(program: ir.Program, context: Context, given: dict[int, dict[str, str]], pool: _Pool) -> ir.Program:
    gone = {key for names in given.values() for key in names}

    def kept(declarations: tuple[ir.Declaration, ...]) -> tuple[ir.Declaration, ...]:
        return tuple(one for one in declarations if not (isinstance(one, ir.Variable) and one.name.lower() in gone))

    def routine(one: ir.Routine) -> ir.Routine:
        names = given.get(id(one), {})
        if not names:
            return one
        done = edit_bodies(one, lambda body: renamed(body, names))
        return replace(done, declarations=kept(done.declarations))

    modules = tuple(
        replace(module, declarations=kept(module.declarations), routines=tuple(map(routine, module.routines)))
        for module in program.modules
    )
    shared = [ir.Variable(name, type, scope="global") for name, type, _ in pool.slots]
    return with_support(replace(program, modules=modules), context, shared)

"""Bring along what the source language predefines: a target knows its own system routines and data, not another's.

The parts of the source's prelude that the program uses, directly or through other parts, become modules of the program.
"""

from __future__ import annotations

from dataclasses import replace
from functools import cache

from rpl import ir, registry
from rpl.diagnostics import Diagnostics
from rpl.errors import InternalError
from rpl.passes.legalise.context import Context
from rpl.passes.legalise.rewriting.editing import edit_bodies, map_body
from rpl.passes.legalise.stages import legalising
from rpl.passes.rewrite import changed, rewrite_parts
from rpl.passes.typing import normalise


@legalising()
def link_prelude(program: ir.Program, context: Context) -> ir.Program:
    """The program with the used part of each source dialect's prelude as a module of its own."""
    modules = list(program.modules)
    for dialect in sorted({module.dialect for module in program.modules}):
        prelude = _prelude(dialect)
        if prelude is None:
            continue
        modules = _without_externals(_with_own_values(modules, prelude), prelude)
        linked = _used_part(prelude, [module for module in modules if module.dialect == dialect], context)
        if linked is not None:
            modules.append(linked)
    return replace(program, modules=tuple(modules))


@cache
def _prelude(dialect: str) -> ir.Module | None:
    """A dialect's prelude in normal form, of which there is nothing to report."""
    prelude = registry.dialect(dialect).prelude()
    if prelude is None:
        return None
    diagnostics = Diagnostics()
    done = normalise(ir.Program((replace(prelude, dialect=dialect),)), diagnostics).modules[0]
    if diagnostics.items:
        raise InternalError(f"prelude of {dialect}: {[item.as_text() for item in diagnostics]}")
    return done


def _without_externals(modules: list[ir.Module], prelude: ir.Module) -> list[ir.Module]:
    """What is said to be elsewhere and comes with the prelude needs no word any more."""
    there = {routine.name.lower() for routine in prelude.routines}

    def is_there(one: ir.Declaration) -> bool:
        return isinstance(one, ir.ExternalDeclaration) and one.name.lower() in there

    return [
        changed(module, declarations=tuple(one for one in module.declarations if not is_there(one)))
        if module.dialect == prelude.dialect
        else module
        for module in modules
    ]


def _with_own_values(modules: list[ir.Module], prelude: ir.Module) -> list[ir.Module]:
    """Functions that only the source's controller has are values of its own, no routines to be brought along."""
    lone = {
        routine.name.lower(): routine.returns
        for routine in prelude.routines
        if routine.returns is not None and routine.open_ended and isinstance(routine.body[0], ir.Vendor)
    }
    for module in modules:
        for routine in module.routines:
            lone.pop(routine.name.lower(), None)

    def expression(one: ir.Expression) -> ir.Expression:
        done = rewrite_parts(one, expression)
        returns = lone.get(done.name.lower()) if isinstance(done, ir.Call) else None
        if isinstance(done, ir.Call) and returns is not None:
            text = one.origin.text or f"{done.name}(...)"
            return ir.VendorValue(prelude.dialect, text, returns, origin=done.origin)
        return done

    def body(statements: ir.Body) -> ir.Body:
        return map_body(statements, lambda statement: (rewrite_parts(statement, expression, body),), {"Call"})

    if not lone:
        return modules
    return [
        replace(module, routines=tuple(edit_bodies(routine, body) for routine in module.routines))
        if module.dialect == prelude.dialect
        else module
        for module in modules
    ]


# ---- what is used


class _Uses:
    """Names that a piece of IR mentions, folded."""

    def __init__(self) -> None:
        self.names: set[str] = set()

    def expression(self, expression: ir.Expression) -> ir.Expression:
        match expression:
            case ir.Name(id=name):
                self.names.add(name.lower())
            case ir.Call(name=name):
                self.names.add(name.lower())
            case ir.EnumLiteral(member=member):
                self.names.add(f"#{member.lower()}")
            case ir.Aggregate(type_name=word) if word:
                self.names.add(word.lower())
        return rewrite_parts(expression, self.expression)

    def body(self, body: ir.Body) -> ir.Body:
        for statement in body:
            match statement:
                case ir.CallRoutine(name=name):
                    self.names.add(name.lower())
                case ir.ConnectInterrupt(routine=name):
                    self.names.add(name.lower())
                case ir.WaitUntil(error=str() as name):
                    self.names.add(name.lower())
            rewrite_parts(statement, self.expression, self.body)
        return body

    def type(self, type: ir.Type | None) -> None:
        match type:
            case ir.NamedType(name=name):
                self.names.add(name.lower())
            case ir.ArrayType(element=element):
                self.type(element)
                rewrite_parts(type, self.expression)

    def declaration(self, declaration: ir.Declaration) -> None:
        match declaration:
            case ir.Variable(type=type, initial=initial):
                self.type(type)
                if initial is not None:
                    self.expression(initial)
            case ir.RecordDeclaration(fields=fields):
                for _, type in fields:
                    self.type(type)
            case ir.AliasDeclaration(type=type):
                self.type(type)
            case ir.Initialise(assign=assign):
                self.body((assign,))

    def routine(self, routine: ir.Routine) -> None:
        for parameter in routine.parameters:
            self.type(parameter.type)
        self.type(routine.returns)
        for declaration in routine.declarations:
            self.declaration(declaration)
        self.body(routine.body)
        for handler in routine.handlers:
            for one in handler.codes:
                self.expression(one)
            self.body(handler.body)
        self.body(routine.undo)
        self.body(routine.backward)


def _keys(declaration: ir.Declaration) -> list[str]:
    match declaration:
        case ir.EnumDeclaration(name=name, members=members):
            return [name.lower(), *(f"#{member.lower()}" for member in members)]
        case ir.Initialise(assign=ir.Assign(target=target)):
            base = target
            while isinstance(base, ir.Index | ir.Field):
                base = base.base
            return [base.id.lower()] if isinstance(base, ir.Name) else []
        case ir.Unread() | ir.ExternalDeclaration():
            return []
    return [declaration.name.lower()]


def _spot(target: ir.Expression) -> tuple[object, ...]:
    """The part of a variable that an assignment of a data list sets, to be compared."""
    match target:
        case ir.Name(id=name):
            return (name.lower(),)
        case ir.Index(base=base, indices=indices):
            numbers = (one.value if isinstance(one, ir.IntLiteral) else one for one in indices)
            return (*_spot(base), *numbers)
        case ir.Field(base=base, name=name):
            return (*_spot(base), name.lower())
    return (target,)


def _used_part(prelude: ir.Module, modules: list[ir.Module], context: Context) -> ir.Module | None:
    uses = _Uses()
    own: set[str] = set()
    given: set[tuple[object, ...]] = set()  # parts of the prelude's data that the project's data lists set
    for module in modules:
        for declaration in module.declarations:
            uses.declaration(declaration)
            if isinstance(declaration, ir.Initialise):
                given.add(_spot(declaration.assign.target))
            else:
                own.update(_keys(declaration))
        for routine in module.routines:
            uses.routine(routine)
            own.add(routine.name.lower())
    kept: set[int] = set()
    size = -1
    while len(kept) != size:
        size = len(kept)
        for declaration in prelude.declarations:
            keys = _keys(declaration)
            if id(declaration) not in kept and any(key in uses.names and key not in own for key in keys):
                kept.add(id(declaration))
                uses.declaration(declaration)
        for routine in prelude.routines:
            name = routine.name.lower()
            if id(routine) not in kept and name in uses.names and name not in own:
                kept.add(id(routine))
                uses.routine(routine)
    if not kept:
        return None
    return replace(
        prelude,
        name=context.fresh(f"{prelude.dialect}_base"),
        declarations=tuple(
            _shared(d)
            for d in prelude.declarations
            if id(d) in kept and not (isinstance(d, ir.Initialise) and _spot(d.assign.target) in given)
        ),
        routines=tuple(replace(r, scope="global") for r in prelude.routines if id(r) in kept),
    )


def _shared(declaration: ir.Declaration) -> ir.Declaration:
    match declaration:
        case ir.Variable() | ir.RecordDeclaration() | ir.EnumDeclaration() | ir.AliasDeclaration():
            return replace(declaration, scope="global")
    return declaration

"""Second names of types replaced by what they stand for, for targets that have none."""

from __future__ import annotations

from dataclasses import replace

from rpl import ir
from rpl.passes.capabilities import DataRule
from rpl.passes.legalise.context import Context, ProgramScope
from rpl.passes.legalise.stages import legalising
from rpl.passes.scope import Scope


@legalising(unless=lambda context: DataRule.ALIASES in context.capabilities.data.rules)
def without_aliases(program: ir.Program, context: Context) -> ir.Program:
    """Only for targets without aliases."""
    if not any(isinstance(d, ir.AliasDeclaration) for module in program.modules for d in module.declarations):
        return program
    scopes = ProgramScope(program)
    modules = []
    for module in program.modules:
        scope = scopes.module(module)
        kept = tuple(d for d in module.declarations if not isinstance(d, ir.AliasDeclaration))
        modules.append(
            replace(
                module,
                declarations=tuple(_declaration(d, scope) for d in kept),
                routines=tuple(_routine(routine, scopes.routine(module, routine)) for routine in module.routines),
            )
        )
    return replace(program, modules=tuple(modules))


def _type(type: ir.Type, scope: Scope) -> ir.Type:
    if isinstance(type, ir.ArrayType):
        return replace(type, element=_type(type.element, scope))
    return scope.resolve(type)


def _declaration(declaration: ir.Declaration, scope: Scope) -> ir.Declaration:
    match declaration:
        case ir.Variable():
            return replace(declaration, type=_type(declaration.type, scope))
        case ir.RecordDeclaration(fields=fields):
            return replace(declaration, fields=tuple((name, _type(type, scope)) for name, type in fields))
    return declaration


def _routine(routine: ir.Routine, scope: Scope) -> ir.Routine:
    return replace(
        routine,
        parameters=tuple(replace(p, type=_type(p.type, scope)) for p in routine.parameters),
        returns=None if routine.returns is None else _type(routine.returns, scope),
        declarations=tuple(_declaration(d, scope) for d in routine.declarations),
    )

"""Types that a module uses and that only another module has, for itself: named with where they stand.

A record, enumeration or alias without the word that shows it to the other modules (GLOBAL) is not known outside. What
is declared with it would have no components, and the first access would stop the program.
"""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

from rpl import ir
from rpl.diagnostics import Diagnostics, Severity, code
from rpl.ir.walk import walk
from rpl.passes.scope import ProgramScope, Scope, rules_of
from rpl.source import Origin

HIDDEN_TYPE = code(
    "hidden-type",
    Severity.ERROR,
    "{kind} {name} is local to module {home} ({place}): {module} does not know it",
    "declare it GLOBAL where it stands (GLOBAL in front of it), so that other modules see it",
)
_KINDS = {ir.RecordDeclaration: "record", ir.EnumDeclaration: "enumeration", ir.AliasDeclaration: "type"}
Declared = ir.RecordDeclaration | ir.EnumDeclaration | ir.AliasDeclaration


def hidden_types(program: ir.Program, diagnostics: Diagnostics) -> None:
    """Reports each use once per declaration."""
    local = {
        (declaration.name.lower(), declaration.name): (module, declaration)
        for module in program.modules
        for declaration in module.declarations
        if isinstance(declaration, Declared) and declaration.scope == "module"
    }
    if len(program.modules) < 2 or not local:
        return
    scopes = ProgramScope(program)
    for module in program.modules:
        for scope, type, origin in _uses(module, scopes):
            for node in walk(type):
                if not isinstance(node, ir.NamedType) or scope.type(node.name) is not None:
                    continue
                if scope.fold(node.name) in scope.rules.type_names:
                    continue
                _report(node.name, module, local, origin, diagnostics)


def _report(
    name: str,
    module: ir.Module,
    local: dict[tuple[str, str], tuple[ir.Module, Declared]],
    origin: Origin,
    diagnostics: Diagnostics,
) -> None:
    sensitive = rules_of(module.dialect).case_sensitive
    for (folded, written), (home, declaration) in local.items():
        if (written == name if sensitive else folded == name.lower()) and home.dialect == module.dialect:
            at = declaration.origin
            place = f"{Path(at.source.path).name}:{at.line}" if at.source else home.name
            kind = _KINDS[declaration.__class__]
            diagnostics.report(
                HIDDEN_TYPE, origin, kind=kind, name=written, home=home.name, place=place, module=module.name
            )
            return


def _uses(module: ir.Module, scopes: ProgramScope) -> Iterator[tuple[Scope, ir.Type, Origin]]:
    """Types that are written in a module, with the place of their declaration."""
    outer = scopes.module(module)
    yield from ((outer, type, origin) for type, origin in _declared(module.declarations))
    for routine in module.routines:
        inner = scopes.routine(module, routine)
        yield from ((inner, type, origin) for type, origin in _declared(routine.declarations))
        types = [*(one.type for one in routine.parameters), *((routine.returns,) if routine.returns else ())]
        yield from ((inner, type, routine.origin) for type in types)


def _declared(declarations: tuple[ir.Declaration, ...]) -> Iterator[tuple[ir.Type, Origin]]:
    for declaration in declarations:
        match declaration:
            case ir.Variable(type=type) | ir.AliasDeclaration(type=type):
                yield type, declaration.origin
            case ir.RecordDeclaration(fields=fields):
                yield from ((type, declaration.origin) for _, type in fields)


__all__ = ["HIDDEN_TYPE", "hidden_types"]

"""The names of an application: what the writer brings along is called otherwise."""

from __future__ import annotations

from rpl import ir
from rpl.passes.legalise.kinds import walk_for


def names_of(program: ir.Program, locals: bool = True) -> set[str]:
    """Every name that the program declares or gives a signal. locals: those of routines' own data too."""
    found: set[str] = set()
    for module in program.modules:
        found.update(str(getattr(declaration, "name", "")) for declaration in module.declarations)
        for routine in module.routines:
            found.add(routine.name)
            found.update(parameter.name for parameter in routine.parameters)
            found.update(str(getattr(one, "name", "")) for one in routine.declarations if locals)
    found.update(node.name or "" for node in walk_for({"Signal"}, *program.modules) if isinstance(node, ir.Signal))
    return found

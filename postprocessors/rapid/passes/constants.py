"""Data that begins with a value and that nothing assigns is `CONST`, as people write it: numbers at the module's head,
taught points (the pendant modifies positions of constants as well) and joint positions. Tools and work objects stay
`PERS`, which RAPID asks of them, and so do numbers that were registers: operators set these between two runs.
"""

from __future__ import annotations

from dataclasses import replace

from rpl import ir, registry
from rpl.passes.legalise.context import Context
from rpl.passes.legalise.facts.usage import base_name
from rpl.passes.legalise.kinds import walk_for
from rpl.passes.legalise.rewriting.walk import unchanged_in
from rpl.passes.legalise.stages import legalising
from rpl.passes.rewrite import changed

__all__ = ["constant_data"]

_PLACES = (ir.TargetType, ir.JointsType)
_NUMBERS = (ir.IntType, ir.RealType, ir.BoolType)


@legalising()
def constant_data(program: ir.Program, context: Context) -> ir.Program:
    """Only data of modules that one task has, and that no data list sets besides."""
    unchanged = unchanged_in(program)
    changes = unchanged.assigned | set(unchanged.initialised)
    changes |= {node.counter.lower() for node in walk_for({"For"}, *program.modules) if isinstance(node, ir.For)}
    changes |= _referred(program)
    tasks = {module.task for module in program.modules}
    target = registry.target(context.source) if context.source in registry.target_names() else None
    types = _PLACES if target is not None and target.capabilities().storage.banks else (*_PLACES, *_NUMBERS)

    def declared(one: ir.Declaration) -> ir.Declaration:
        match one:
            case ir.Variable(storage="variable" | "persistent", initial=initial, type=type) if (
                initial is not None and isinstance(type, types) and one.name.lower() not in changes
            ):
                return replace(one, storage="constant")
        return one

    if len(tasks) > 1:  # what several tasks share has to be persistent
        return program
    modules = (changed(module, declarations=tuple(map(declared, module.declarations))) for module in program.modules)
    return changed(program, modules=tuple(modules))


def _referred(program: ir.Program) -> set[str]:
    """Names that calls pass by reference: `INOUT` takes no constant, whether the routine changes it or not."""
    by_reference: dict[str, set[int | str]] = {}
    for module in program.modules:
        for routine in module.routines:
            found = by_reference.setdefault(routine.name.lower(), set())
            for at, one in enumerate(routine.parameters):
                if one.mode == "reference":
                    found |= {at, one.name.lower()}
    names: set[str | None] = set()
    for node in walk_for({"Call", "CallRoutine"}, *program.modules):
        if isinstance(node, ir.Call | ir.CallRoutine):
            referred = by_reference.get(node.name.lower(), set())
            for at, argument in enumerate(node.arguments):
                key = at if argument.name is None else argument.name.lower()
                if argument.value is not None and key in referred:
                    names.add(base_name(argument.value))
    return {name for name in names if name is not None}

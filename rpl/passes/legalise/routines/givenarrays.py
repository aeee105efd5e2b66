"""Arrays that a routine is given by reference, for targets whose data has numbers: it works with the array itself.

Copies of an array cost as many registers as it has elements. Where every call of a routine gives it the same array of
the program, the routine names that array, and the parameter is gone; a routine that is called with a few different
arrays is written once for each of them.
"""

from __future__ import annotations

from dataclasses import replace

from rpl import ir
from rpl.ir.walk import rewrite, walk
from rpl.passes.legalise.context import Context
from rpl.passes.legalise.stages import legalising
from rpl.passes.scope import ProgramScope, Scope

_MOST = 4  # versions of one routine
_OWN = (ir.Variable, ir.Parameter)


@legalising(unless=lambda context: not context.capabilities.storage.banks)
def given_arrays(program: ir.Program, context: Context) -> ir.Program:
    """Only for targets with banks, and calls that say all their arguments in order."""
    for _ in range(8):  # an array that is handed on is known when the routine in between knows it
        done = _versions(program, context)
        if done is program:
            return program
        program = done
    return program


def _arrays(routine: ir.Routine, scope: Scope) -> list[int]:
    """Positions of the parameters that are arrays by reference."""
    return [
        at
        for at, one in enumerate(routine.parameters)
        if one.mode == "reference" and isinstance(scope.resolve(one.type), ir.ArrayType)
    ]


def _versions(program: ir.Program, context: Context) -> ir.Program:
    scopes = ProgramScope(program)
    places = {
        routine.name.lower(): found
        for module, routine in scopes.routines()
        if (found := _arrays(routine, scopes.routine(module, routine)))
    }
    spelled = [routine.name.lower() for _, routine in scopes.routines()]
    places = {name: found for name, found in places.items() if spelled.count(name) == 1}
    wanted = _wanted(program, scopes, places)
    names = {
        (routine, arrays): routine if at == 0 else context.fresh(f"{routine}_{arrays[0].lstrip('$#')}")
        for routine, versions in wanted.items()
        for at, arrays in enumerate(sorted(versions))
    }
    if not names:
        return program

    def called(node: object) -> object:
        if isinstance(node, ir.CallRoutine | ir.Call) and node.name.lower() in wanted:
            key = node.name.lower()
            arrays = tuple(_array(node.arguments[at]) or "" for at in places[key])
            kept = tuple(one for at, one in enumerate(node.arguments) if at not in places[key])
            version = names[key, arrays]
            return replace(node, name=node.name if version == key else version, arguments=kept)
        return node

    modules = []
    for module in program.modules:
        routines: list[ir.Routine] = []
        for routine in module.routines:
            key = routine.name.lower()
            if key not in wanted:
                routines.append(routine)
                continue
            for arrays in sorted(wanted[key]):
                version = names[key, arrays]
                made = _version(routine, dict(zip(places[key], arrays, strict=True)))
                routines.append(made if version == key else replace(made, name=version))
        modules.append(replace(module, routines=tuple(routines)))
    return rewrite(replace(program, modules=tuple(modules)), called)


def _version(routine: ir.Routine, arrays: dict[int, str]) -> ir.Routine:
    """The routine with the arrays themselves in place of these parameters."""
    by_name = {routine.parameters[at].name.lower(): array for at, array in arrays.items()}
    kept = tuple(one for at, one in enumerate(routine.parameters) if at not in arrays)

    def named(node: object) -> object:
        if isinstance(node, ir.Name) and node.id.lower() in by_name:
            return replace(node, id=by_name[node.id.lower()])
        return node

    return replace(rewrite(routine, named), parameters=kept)


def _array(argument: ir.Argument) -> str | None:
    value = argument.value
    return value.id if isinstance(value, ir.Name) and argument.name is None and not argument.if_present else None


def _wanted(program: ir.Program, scopes: ProgramScope, places: dict[str, list[int]]) -> dict[str, set[tuple[str, ...]]]:
    """For each routine the arrays it is given; only routines of which every call names arrays of the whole program."""
    found: dict[str, set[tuple[str, ...]]] = {}
    lost: set[str] = set()
    spelled: dict[str, str] = {}
    for module, routine in scopes.routines():
        scope = scopes.routine(module, routine)
        own = {one.name.lower() for one in (*routine.parameters, *routine.declarations) if isinstance(one, _OWN)}
        for node in walk(routine):
            match node:
                case ir.CallRoutine(dynamic=dynamic) if dynamic is not None:
                    return {}
                case ir.CallRoutine(name=name, arguments=given) | ir.Call(name=name, arguments=given):
                    if name.lower() not in places:
                        continue
                    arrays = _of_program(places[name.lower()], given, scope, own)
                    if arrays is None or scope.routine(name) is None:
                        lost.add(name.lower())
                    else:
                        arrays = tuple(spelled.setdefault(one.lower(), one) for one in arrays)
                        found.setdefault(name.lower(), set()).add(arrays)
                case ir.TaskControl(task=name):
                    lost.add(name.lower())
    hidden = {
        one.name.lower() for _, routine in scopes.routines() for one in routine.declarations if isinstance(one, _OWN)
    }
    for name, versions in found.items():
        if len(versions) > _MOST or any(array.lower() in hidden for arrays in versions for array in arrays):
            lost.add(name)
    return {name: versions for name, versions in found.items() if name not in lost}


def _of_program(
    positions: list[int], given: tuple[ir.Argument, ...], scope: Scope, own: set[str]
) -> tuple[str, ...] | None:
    """The arrays that a call gives for these parameters, when all are the program's own."""
    arrays = []
    for at in positions:
        name = _array(given[at]) if at < len(given) else None
        symbol = scope.value(name) if name is not None else None
        if name is None or name.lower() in own or symbol is None or not isinstance(symbol.declaration, ir.Variable):
            return None
        if symbol.declaration.scope != "global" or any(one.name for one in given):
            return None
        arrays.append(name)
    return tuple(arrays)

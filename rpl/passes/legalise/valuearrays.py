"""Arrays that are passed by value, for targets that hand over the array itself.

A routine that changes such an array works with a copy: the parameter gets another name, and a variable of the old name
is filled from it. An array whose size differs between the calls cannot be copied so and is reported.
"""

from __future__ import annotations

from dataclasses import replace

from rpl import ir
from rpl.diagnostics import Severity, code
from rpl.ir.walk import walk
from rpl.passes.legalise.context import Context
from rpl.passes.legalise.parameters import ArraySizes
from rpl.passes.legalise.usage import assigned_in, bodies
from rpl.passes.scope import ProgramScope
from rpl.source import Origin

SHARED = code(
    "array-shared",
    Severity.LOSS,
    "{name} changes {parameter}, which is a copy in the source and the caller's own array here; its size is not known",
)


def copy_value_arrays(program: ir.Program, context: Context) -> ir.Program:
    """Only for targets that know no copies of arrays as arguments."""
    if context.capabilities.arrays_by_value:
        return program
    sizes = ArraySizes(program, ProgramScope(program))
    modules = tuple(
        replace(module, routines=tuple(_with_copies(routine, sizes, context) for routine in module.routines))
        for module in program.modules
    )
    return replace(program, modules=modules)


def _with_copies(routine: ir.Routine, sizes: ArraySizes, context: Context) -> ir.Routine:
    changed = {name for body in bodies(routine) for name in assigned_in(body)}
    parameters, copies, steps = [], [], []
    for parameter in routine.parameters:
        mine = parameter.mode != "reference" and isinstance(parameter.type, ir.ArrayType)
        if not mine or parameter.name.lower() not in changed:
            parameters.append(parameter)
            continue
        type = sizes.known(routine, parameter)
        if not isinstance(type, ir.ArrayType) or None in type.dimensions:
            context.diagnostics.report(SHARED, routine.origin, name=routine.name, parameter=parameter.name)
            parameters.append(parameter)
            continue
        given = context.fresh(f"{parameter.name}_given")
        parameters.append(replace(parameter, name=given))
        copies.append(ir.Variable(parameter.name, type, scope="routine"))
        steps.append(ir.Assign(ir.Name(parameter.name), ir.Name(given), origin=_first_origin(routine)))
    if not copies:
        return routine
    return replace(
        routine,
        parameters=tuple(parameters),
        declarations=(*routine.declarations, *copies),
        body=(*steps, *routine.body),
    )


def _first_origin(routine: ir.Routine) -> Origin:
    found = next((node.origin for node in walk(routine.body) if isinstance(node, ir.Assign)), routine.origin)
    return replace(found, comments=())

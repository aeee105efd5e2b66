"""Arrays that are passed by value, for targets that hand over the array itself.

A routine that changes such an array works with a copy: the parameter gets another name, and a variable of the old name
is filled from it. Of an array whose size differs between the calls as many elements are copied as there are; one that
such a routine hands on as a whole, or whose size nobody knows, is reported.
"""

from __future__ import annotations

from dataclasses import replace

from rpl import ir
from rpl.diagnostics import Severity, code
from rpl.ir.walk import bodies, rewrite, walk
from rpl.passes.capabilities import Passing
from rpl.passes.legalise.context import Context
from rpl.passes.legalise.control.parameters import ArraySizes
from rpl.passes.legalise.facts.usage import assigned_in
from rpl.passes.legalise.stages import legalising
from rpl.passes.scope import ProgramScope
from rpl.source import Origin

SHARED = code(
    "array-shared",
    Severity.LOSS,
    "{name} changes {parameter}, which is a copy in the source and the caller's own array here; its size is not known",
)


@legalising(unless=lambda context: Passing.ARRAYS_BY_VALUE in context.capabilities.routines.passing)
def copy_value_arrays(program: ir.Program, context: Context) -> ir.Program:
    """Only for targets that know no copies of arrays as arguments."""
    sizes = ArraySizes(program, ProgramScope(program))
    modules = tuple(
        replace(module, routines=tuple(_with_copies(routine, sizes, context) for routine in module.routines))
        for module in program.modules
    )
    return replace(program, modules=modules)


def _with_copies(routine: ir.Routine, sizes: ArraySizes, context: Context) -> ir.Routine:
    changed = {name for body in bodies(routine) for name in assigned_in(body)}
    parameters: list[ir.Parameter] = []
    copies: list[ir.Variable] = []
    steps: list[ir.Statement] = []
    by_size: dict[str, str] = {}
    for parameter in routine.parameters:
        mine = parameter.mode != "reference" and isinstance(parameter.type, ir.ArrayType)
        if not mine or parameter.name.lower() not in changed:
            parameters.append(parameter)
            continue
        type = sizes.known(routine, parameter)
        differs = isinstance(type, ir.ArrayType) and None in type.dimensions and _only_by_element(routine, parameter)
        if differs:
            type = sizes.largest(routine, parameter)
        if not isinstance(type, ir.ArrayType) or None in type.dimensions:
            context.diagnostics.report(SHARED, routine.origin, name=routine.name, parameter=parameter.name)
            parameters.append(parameter)
            continue
        given = context.fresh(f"{parameter.name}_given")
        parameters.append(replace(parameter, name=given))
        copies.append(ir.Variable(parameter.name, type, scope="routine"))
        if differs:
            by_size[parameter.name.lower()] = given
            counter = ir.Variable(context.fresh("element"), ir.IntType(), scope="routine")
            copies.append(counter)
            steps.append(_elements(ir.Name(parameter.name), ir.Name(given), counter.name, _first_origin(routine)))
        else:
            steps.append(ir.Assign(ir.Name(parameter.name), ir.Name(given), origin=_first_origin(routine)))
    if not copies:
        return routine
    done = rewrite(routine, lambda node: _asked(node, by_size)) if by_size else routine
    return replace(
        done,
        parameters=tuple(parameters),
        declarations=(*done.declarations, *copies),
        body=(*steps, *done.body),
    )


def _elements(copy: ir.Name, given: ir.Name, counter: str, origin: Origin) -> ir.Statement:
    """As many elements as the caller's array has."""
    place = (ir.Name(counter),)
    size = ir.Builtin("dimension", (given, ir.IntLiteral(1)))
    one = ir.Assign(ir.Index(copy, place), ir.Index(given, place), origin=origin)
    return ir.For(counter, ir.IntLiteral(1), size, None, (one,), origin=origin)


def _asked(node: object, given: dict[str, str]) -> object:
    """The size of a copy is that of what was given."""
    match node:
        case ir.Builtin(function="dimension" | "length", arguments=(ir.Name(id=name), *rest)) if name.lower() in given:
            return replace(node, arguments=(ir.Name(given[name.lower()]), *rest))
    return node


def _only_by_element(routine: ir.Routine, parameter: ir.Parameter) -> bool:
    """Is the parameter used element by element only, besides asking for its size?"""
    name, used, known = parameter.name.lower(), 0, 0
    for body in bodies(routine):
        for node in walk(body):
            match node:
                case ir.Name(id=one) if one.lower() == name:
                    used += 1
                case ir.Index(base=ir.Name(id=one)) if one.lower() == name:
                    known += 1
                case ir.Builtin(function="dimension" | "length", arguments=(ir.Name(id=one), *_)):
                    known += one.lower() == name
    return used == known


def _first_origin(routine: ir.Routine) -> Origin:
    found = next((node.origin for node in walk(routine.body) if isinstance(node, ir.Assign)), routine.origin)
    return replace(found, comments=())

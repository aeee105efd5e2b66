"""Lists that get all their elements one by one at the start: they are written as lists of these values."""

from __future__ import annotations

from dataclasses import replace

from rpl import ir
from rpl.writing.target import WriteContext


def gathered_lists(program: ir.Program, context: WriteContext) -> ir.Program:
    """The program with arrays whose elements all get a constant first, one by one, as lists with these values."""
    modules = tuple(replace(one, declarations=_gathered(one.declarations)) for one in program.modules)
    return replace(program, modules=modules)


def _gathered(declarations: tuple[ir.Declaration, ...]) -> tuple[ir.Declaration, ...]:
    given: dict[str, dict[int, ir.Initialise]] = {}
    for one in declarations:
        match one:
            case ir.Initialise(
                assign=ir.Assign(target=ir.Index(base=ir.Name(id=name), indices=(ir.IntLiteral(value=at),)))
            ):
                given.setdefault(name, {})[at] = one
    lists: dict[str, ir.Aggregate] = {}
    for one in declarations:
        if not isinstance(one, ir.Variable) or one.initial is not None or not isinstance(one.type, ir.ArrayType):
            continue
        found, bounds = given.get(one.name, {}), one.type.dimensions
        if len(bounds) != 1 or not isinstance(bounds[0], ir.IntLiteral):
            continue
        places = range(one.type.base, bounds[0].value + 1)
        if found and set(found) == set(places):
            lists[one.name] = ir.Aggregate(tuple((None, found[at].assign.value) for at in places))
    gone = {id(one) for name in lists for one in given[name].values()}
    return tuple(
        replace(one, initial=lists[one.name]) if isinstance(one, ir.Variable) and one.name in lists else one
        for one in declarations
        if id(one) not in gone
    )

"""Arrays of the source's controller (KRL BASE_DATA) that a program only uses some elements of, by constant numbers: a
variable for each of these. Numbered data of a target is not spent on the others, nor lists of 32 frames written."""

from __future__ import annotations

from collections import Counter
from dataclasses import replace

from rpl import ir
from rpl.ir.walk import rewrite, walk
from rpl.passes.legalise.context import Context
from rpl.passes.legalise.facts.mentioned import is_linked
from rpl.passes.legalise.stages import legalising

Elements = dict[str, dict[tuple[int, ...], str]]  # array (folded) -> numbers of an element -> its variable


@legalising()
def used_elements(program: ir.Program, context: Context) -> ir.Program:
    """Arrays with a value of their own, or wanted as a whole, stay."""
    arrays = {
        one.name.lower(): one
        for module in program.modules
        if is_linked(module, context)
        for one in module.declarations
        if isinstance(one, ir.Variable) and isinstance(one.type, ir.ArrayType) and one.initial is None
    }
    elements = _elements(program, context, arrays) if arrays else {}
    if not elements:
        return program

    def change(node: object) -> object:
        match node:
            case ir.Index(base=ir.Name(id=name), origin=origin) if (made := elements.get(name.lower())) is not None:
                return ir.Name(made[_numbers(node)], origin=origin)
        return node

    def declared(one: ir.Declaration) -> tuple[ir.Declaration, ...]:
        match one:
            case ir.Variable(name=name, type=ir.ArrayType(element=element)) if arrays.get(name.lower()) is one:
                made = elements.get(name.lower())
                if made is not None:
                    return tuple(replace(one, name=made[at], type=element) for at in sorted(made))
            case ir.Initialise(assign=ir.Assign(target=target)):
                while isinstance(target, ir.Field):  # a first value of a component alone
                    target = target.base
                if isinstance(target, ir.Index) and isinstance(target.base, ir.Name):
                    made = elements.get(target.base.id.lower())
                    if made is not None and _numbers(target) not in made:
                        return ()
        return (one,)

    modules = tuple(
        replace(module, declarations=tuple(new for one in module.declarations for new in declared(one)))
        for module in program.modules
    )
    return rewrite(replace(program, modules=modules), change)


def _elements(program: ir.Program, context: Context, arrays: dict[str, ir.Variable]) -> Elements:
    """The variables for the arrays of which nothing but single elements with constant numbers is mentioned."""
    mentions, single = Counter[str](), Counter[str]()
    used: dict[str, set[tuple[int, ...]]] = {name: set() for name in arrays}
    for module in program.modules:
        for part in (*module.declarations, *module.routines):
            first_value = isinstance(part, ir.Initialise) and is_linked(module, context)
            for node in walk(part):
                match node:
                    case ir.Name(id=name):
                        mentions[name.lower()] += 1
                    case ir.Variable(name=name) | ir.Parameter(name=name) if arrays.get(name.lower(), node) is not node:
                        mentions[name.lower()] += 1  # another one of that name
                    case ir.Index(base=ir.Name(id=name)) if name.lower() in arrays:
                        numbers = _numbers(node)
                        single[name.lower()] += len(numbers) == _dimensions(arrays[name.lower()])
                        if not first_value:
                            used[name.lower()].add(numbers)
    return {
        name: {at: context.fresh(one.name + "_".join(map(str, at))) for at in sorted(used[name])}
        for name, one in arrays.items()
        if mentions[name] == single[name]
    }


def _numbers(element: ir.Index) -> tuple[int, ...]:
    """Constant numbers of an element, as far as they are constant."""
    return tuple(one.value for one in element.indices if isinstance(one, ir.IntLiteral))


def _dimensions(array: ir.Variable) -> int:
    return len(array.type.dimensions) if isinstance(array.type, ir.ArrayType) else 0


__all__ = ["used_elements"]

"""Data that a data list gives its only value (`BASE_DATA[2]={X 700,..}`): it is declared with that value, in place of
being set when the program begins.
"""

from __future__ import annotations

from dataclasses import replace

from rpl import ir
from rpl.ir.walk import walk
from rpl.passes.legalise.context import Context
from rpl.passes.legalise.facts.usage import base_name
from rpl.passes.legalise.facts.values.heldvalues import KnownData
from rpl.passes.legalise.stages import legalising

_WRITTEN = (ir.Aggregate, ir.IntLiteral, ir.RealLiteral, ir.BoolLiteral, ir.TextLiteral, ir.EnumLiteral, ir.Unary)


@legalising(sees=("Initialise",))
def declared_values(program: ir.Program, context: Context) -> ir.Program:
    """Only values that are written out, of data that nothing else sets."""
    known = KnownData.of(program)
    given: dict[str, ir.Expression] = {}
    for module in program.modules:
        for one in module.declarations:
            if isinstance(one, ir.Variable) and one.initial is None:
                name = one.name.lower()
                listed = known.initialised.get(name, [])
                if len(listed) == 1 and known.declared[name] == 1 and name not in known.assigned:
                    value = listed[0][0]
                    if all(isinstance(part, _WRITTEN) for part in walk(value)):
                        given[name] = value

    def declared(one: ir.Declaration) -> tuple[ir.Declaration, ...]:
        match one:
            case ir.Variable(name=name) if name.lower() in given:
                return (replace(one, initial=given[name.lower()]),)
            case ir.Initialise(assign=assign) if base_name(assign.target) in given:
                return ()
        return (one,)

    if not given:
        return program
    modules = tuple(
        replace(module, declarations=tuple(new for one in module.declarations for new in declared(one)))
        for module in program.modules
    )
    return replace(program, modules=modules)


__all__ = ["declared_values"]

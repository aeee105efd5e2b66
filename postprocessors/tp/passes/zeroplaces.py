"""A place less itself is no place at all: `PR[n]=LPOS-LPOS` is how people clear a register, because one that nothing
has been written to yet has no value to take away from itself (a fault of the controller).
"""

from __future__ import annotations

from dataclasses import replace

from rpl import ir
from rpl.passes.legalise.context import Context
from rpl.passes.legalise.rewriting.editing import edit_all, map_body
from rpl.passes.legalise.stages import legalising
from rpl.passes.rewrite import rewrite_bodies

__all__ = ["zero_places"]

_HERE = ir.Builtin("current_target", ())


@legalising(sees=("function element_difference",))
def zero_places(program: ir.Program, context: Context) -> ir.Program:
    """The robot's place less itself, which always has a value."""

    def change(statement: ir.Statement) -> ir.Body:
        match statement:
            case ir.Assign(
                target=ir.Name() as place,
                value=ir.Builtin(function="element_difference", arguments=(ir.Name() as one, other)) as value,
            ) if place == one == other:
                return (replace(statement, value=replace(value, arguments=(_HERE, _HERE))),)
        return (rewrite_bodies(statement, lambda body: map_body(body, change)),)

    return edit_all(program, lambda body: map_body(body, change))

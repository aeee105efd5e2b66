"""Flags with a number as byte variables: a controller has no flags of its own."""

from __future__ import annotations

from dataclasses import replace

from rpl import ir
from rpl.passes.rewrite import rewrite_parts
from rpl.writing.target import WriteContext

from ..operands import Registers


def flags_in_bytes(program: ir.Program, context: WriteContext) -> ir.Program:
    """Each flag with a constant number is a byte of its own from the top of the bank; others stay and are refused."""
    registers = Registers.of(program, context.register_names)
    bytes_of: dict[int, int] = {}

    def look(expression: ir.Expression) -> ir.Expression:
        match expression:
            case (
                ir.Signal(kind="flag", index=ir.IntLiteral(value=number), last=None, name=None)
                | ir.System(name="flag", indices=(ir.IntLiteral(value=number),))
            ):
                if number not in bytes_of:
                    bytes_of[number] = registers.take("B")
                return ir.Name(f"B{bytes_of[number]:03d}", origin=expression.origin)
        return rewrite_parts(expression, look)

    def body(statements: ir.Body) -> ir.Body:
        return tuple(rewrite_parts(statement, look, body) for statement in statements)

    modules = tuple(
        replace(module, routines=tuple(replace(one, body=body(one.body)) for one in module.routines))
        for module in program.modules
    )
    return replace(program, modules=modules) if bytes_of else program

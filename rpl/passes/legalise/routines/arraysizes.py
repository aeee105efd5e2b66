"""Sizes of arrays that a routine is given come with them, as parameters, for targets where it cannot ask. Sizes of
declared arrays are known while writing.
"""

from __future__ import annotations

from dataclasses import replace

from rpl import ir
from rpl.passes.capabilities import DataRule
from rpl.passes.legalise.context import Context
from rpl.passes.legalise.rewriting.walk import Rewriter
from rpl.passes.legalise.stages import legalising

# routine, place of its parameter, dimension from 1
_Asked = tuple[str, int, int]
_ASKING = frozenset(("function dimension", "function length"))


@legalising(
    unless=lambda context: (
        "dimension" in context.capabilities.functions and DataRule.ROW_SIZES in context.capabilities.data.rules
    ),
    sees=_ASKING,
)
def array_sizes(program: ir.Program, context: Context) -> ir.Program:
    """Sizes of arrays that a routine is given come with them."""
    asked: dict[_Asked, str] = {}
    size = -1
    while size != len(asked):  # a size that is handed on is asked for by the caller's caller too
        size = len(asked)
        done = _Sized(program, context, asked).program()
    return done if asked else program


class _Sized(Rewriter):
    """`asked`: names of the new parameters; grows while the program is looked through."""

    acts_on = _ASKING | {"Call", "CallRoutine"}

    def __init__(self, program: ir.Program, context: Context, asked: dict[_Asked, str]) -> None:
        super().__init__(program, context)
        self.asked = asked
        self.inside: ir.Routine | None = None

    def routine(self, module: ir.Module, routine: ir.Routine) -> ir.Routine:
        self.inside = routine
        done = super().routine(module, routine)
        self.inside = None
        more = tuple(ir.Parameter(self.asked[key], ir.IntType()) for key in self.of(routine.name))
        return replace(done, parameters=(*done.parameters, *more)) if more else done

    def of(self, routine: str) -> list[_Asked]:
        return sorted(key for key in self.asked if key[0] == routine.lower())

    def expression(self, expression: ir.Expression) -> ir.Expression:
        match expression:
            case ir.Builtin(function="dimension", arguments=(ir.Name(id=name), ir.IntLiteral(value=number))):
                return self.size(name, number) or super().expression(expression)
            case ir.Builtin(function="length", arguments=(ir.Name(id=name),)):
                return self.size(name, 1) or super().expression(expression)
            case ir.Call(name=name, arguments=arguments):
                done = super().expression(expression)
                assert isinstance(done, ir.Call)
                return replace(done, arguments=(*done.arguments, *self.sizes(name, arguments)))
        return super().expression(expression)

    def statement(self, statement: ir.Statement) -> list[ir.Statement]:
        done = super().statement(statement)
        match statement, done:
            case ir.CallRoutine(name=name, arguments=arguments, dynamic=None), [ir.CallRoutine() as call]:
                return [replace(call, arguments=(*call.arguments, *self.sizes(name, arguments)))]
        return done

    def size(self, name: str, number: int) -> ir.Expression | None:
        """The parameter that holds the size of an array which the routine was given."""
        if self.inside is None:
            return None
        for place, parameter in enumerate(self.inside.parameters):
            type = self.scope.resolve(parameter.type)
            if parameter.name.lower() != name.lower() or not isinstance(type, ir.ArrayType):
                continue
            if number > len(type.dimensions) or type.dimensions[number - 1] is not None:
                return None
            if len(type.dimensions) == 1 and "dimension" in self.context.capabilities.functions:
                return None
            key = (self.inside.name.lower(), place, number)
            if key not in self.asked:
                self.asked[key] = self.context.fresh(f"{parameter.name}_size")
            return ir.Name(self.asked[key])
        return None

    def sizes(self, routine: str, arguments: tuple[ir.Argument, ...]) -> list[ir.Argument]:
        made = []
        for _, place, number in self.of(routine):
            value = arguments[place].value if place < len(arguments) else None
            found = self.size(value.id, number) if isinstance(value, ir.Name) else None
            if isinstance(value, ir.Aggregate):
                found = _count(value, number)
            elif found is None and value is not None:
                found = ir.Builtin("dimension", (value, ir.IntLiteral(number)))
            made.append(ir.Argument(found if found is not None else ir.IntLiteral(0)))
        return made


def _count(value: ir.Expression, number: int) -> ir.Expression | None:
    """How many elements a list that is written out has in one of its dimensions."""
    for _ in range(number - 1):
        value = value.entries[0][1] if isinstance(value, ir.Aggregate) and value.entries else value
    return ir.IntLiteral(len(value.entries)) if isinstance(value, ir.Aggregate) else None


__all__ = ["array_sizes"]

"""Arrays for targets whose indices start at one: indices of an array that starts elsewhere are shifted."""

from __future__ import annotations

from dataclasses import replace

from rpl import ir
from rpl.passes.legalise.context import Context
from rpl.passes.legalise.kinds import walk_for
from rpl.passes.legalise.rewriting.walk import Rewriter
from rpl.passes.legalise.stages import legalising


@legalising()
def array_bases(program: ir.Program, context: Context) -> ir.Program:
    """Every array starts at one. One that starts at zero, but whose element zero nothing uses, loses that element and
    keeps its numbers."""
    return _Shifted(_without_unused_first(program), context).program()


def _without_unused_first(program: ir.Program) -> ir.Program:
    names = _from_zero(program)
    if not names:
        return program

    def declared(declaration: ir.Declaration) -> ir.Declaration:
        if not isinstance(declaration, ir.Variable) or declaration.name.lower() not in names:
            return declaration
        type, initial = declaration.type, declaration.initial
        assert isinstance(type, ir.ArrayType)
        shorter = replace(type, base=1)  # its bound is the last number
        if isinstance(initial, ir.Aggregate):
            initial = replace(initial, entries=initial.entries[1:])
        return replace(declaration, type=shorter, initial=initial)

    modules = tuple(
        replace(module, declarations=tuple(map(declared, module.declarations))) for module in program.modules
    )
    return replace(program, modules=modules)


def _from_zero(program: ir.Program) -> set[str]:
    """Names (lower case) of global lists that start at zero and are only used by elements with a number above zero."""
    found: dict[str, int] = {}
    for module in program.modules:
        for declaration in module.declarations:
            match declaration:
                case ir.Variable(type=ir.ArrayType(base=0, dimensions=(ir.IntLiteral(),)), initial=initial):
                    if initial is None or isinstance(initial, ir.Aggregate):
                        found[declaration.name.lower()] = 0
    if not found:
        return set()
    for node in walk_for({"Variable", "Parameter", "Name", "Index"}, *program.modules):
        match node:
            case ir.Variable(name=name) | ir.Parameter(name=name) if name.lower() in found:
                found[name.lower()] += 1  # one declaration only
            case ir.Name(id=name) if name.lower() in found:
                found[name.lower()] += 2
            case ir.Index(base=ir.Name(id=name), indices=(ir.IntLiteral(value=number),)) if name.lower() in found:
                found[name.lower()] -= 2 if number > 0 else 0
    return {name for name, count in found.items() if count == 1}


class _Shifted(Rewriter):
    acts_on = frozenset(("ArrayType", "Index"))

    def type(self, type: ir.Type) -> ir.Type:
        done = super().type(type)
        if not isinstance(done, ir.ArrayType) or done.base == 1:
            return done
        shift = 1 - done.base
        return replace(
            done, dimensions=tuple(None if one is None else _plus(one, shift) for one in done.dimensions), base=1
        )

    def expression(self, expression: ir.Expression) -> ir.Expression:
        done = super().expression(expression)
        if not isinstance(expression, ir.Index) or not isinstance(done, ir.Index):
            return done
        type = self.type_of(expression.base)
        if not isinstance(type, ir.ArrayType) or type.base == 1:
            return done
        return replace(done, indices=tuple(_plus(index, 1 - type.base) for index in done.indices))


def _plus(value: ir.Expression, shift: int) -> ir.Expression:
    match value:
        case ir.IntLiteral(value=number):
            return replace(value, value=number + shift, spelling="")
        case ir.Binary(op="-", left=left, right=ir.IntLiteral(value=number)) if number == shift:
            return left
    return ir.Binary("+" if shift > 0 else "-", value, ir.IntLiteral(abs(shift)), origin=value.origin)


__all__ = ["array_bases"]

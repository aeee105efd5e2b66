"""A rewriter that knows which type each value's place wants: what is assigned, returned, passed or declared.

The two passes between poses of six numbers and poses of a position and a rotation rest on it.
"""

from __future__ import annotations

from abc import abstractmethod
from dataclasses import replace

from rpl import ir
from rpl.passes.legalise.rewriting.walk import Rewriter
from rpl.passes.rewrite import rewrite_parts

Kind = type[object]


class WantedRewriter(Rewriter):
    @abstractmethod
    def assignment(self, statement: ir.Assign) -> list[ir.Statement]:
        """An assignment in the new form."""

    @abstractmethod
    def arguments(self, name: str, given: tuple[ir.Argument, ...]) -> tuple[ir.Argument, ...]:
        """What a call of the routine gives, in the new form."""

    def statement(self, statement: ir.Statement) -> list[ir.Statement]:
        match statement:
            case ir.Assign():
                return self.assignment(statement)
            case ir.CallRoutine(name=name, arguments=arguments):
                done = rewrite_parts(replace(statement, arguments=()), self.expression)
                return [replace(done, arguments=self.arguments(name, arguments))]
            case ir.Return(value=value) if value is not None and self.scope.routine_here is not None:
                wanted = self.scope.routine_here.returns
                return [replace(statement, value=self.valued(value, self.scope.resolve(wanted) if wanted else None))]
        return super().statement(statement)

    def initial(self, value: ir.Expression, declaration: ir.Variable) -> ir.Expression | None:
        return self.valued(value, self.scope.resolve(declaration.type))

    def is_a(self, expression: ir.Expression, *types: Kind) -> bool:
        return isinstance(self.type_of(expression), types)

    def kept(self, value: ir.Expression, type: ir.Type) -> ir.Name:
        """A new variable that holds the value."""
        name = self.temporary(type)
        self.before.append(ir.Assign(name, value))
        return name

    def valued(self, value: ir.Expression, wanted: ir.Type | None) -> ir.Expression:
        """The value in the form that its place has after this pass; an array's values one by one."""
        match wanted:
            case ir.ArrayType(element=element, dimensions=dimensions, base=base) if isinstance(value, ir.Aggregate):
                rest = dimensions[1:]
                inner = ir.ArrayType(element, rest, base) if rest else self.scope.resolve(element)
                return replace(value, entries=tuple((name, self.valued(one, inner)) for name, one in value.entries))
        return self.expression(value)

"""Errors by their names in the target: controllers number the same errors differently, so only names carry over.

Also a wait's own error takes the target's name. An error that the target does not have keeps the source's number under
the source's name; nothing raises it there.
"""

from __future__ import annotations

from dataclasses import replace

from rpl import ir
from rpl.ir.errornames import spelled_among
from rpl.passes.legalise.context import Context, rules_of
from rpl.passes.legalise.facts.mentioned import is_linked
from rpl.passes.legalise.rewriting.walk import Rewriter
from rpl.passes.legalise.stages import legalising


@legalising()
def name_errors(program: ir.Program, context: Context) -> ir.Program:
    """The names of errors are those that RAPID defines itself."""
    ours, theirs = rules_of(context.source).errors, rules_of(context.target).errors
    linked = [one for module in program.modules if is_linked(module, context) for one in module.declarations]
    errors = {one.name: one for one in linked if isinstance(one, ir.Variable) and one.name in ours}
    spelled: dict[int, str] = {}
    for module in program.modules:
        for one in module.declarations:
            if isinstance(one, ir.Variable) and errors.get(one.name) == one:  # a task of its own has a copy
                found = spelled_among(one.name, theirs)
                if found is not None:
                    spelled[id(one)] = found
    bare = {name: found for name in ours if (found := spelled_among(name, theirs)) is not None}
    return _Named(program, context, spelled, bare).program() if spelled or bare else program


class _Named(Rewriter):
    """`spelled`: the target's names, by the constants of the source's prelude that they replace. `bare`: by the names
    of the source's errors, for languages that have numbers but no such constants (V+)."""

    def __init__(self, program: ir.Program, context: Context, spelled: dict[int, str], bare: dict[str, str]) -> None:
        super().__init__(program, context)
        self.spelled, self.bare = spelled, bare

    def declaration(self, declaration: ir.Declaration) -> list[ir.Declaration]:
        return [] if id(declaration) in self.spelled else super().declaration(declaration)

    def expression(self, expression: ir.Expression) -> ir.Expression:
        if isinstance(expression, ir.Name):
            return replace(expression, id=self.named(expression.id))
        return super().expression(expression)

    def statement(self, statement: ir.Statement) -> list[ir.Statement]:
        if isinstance(statement, ir.WaitUntil) and isinstance(statement.error, str):
            statement = replace(statement, error=self.named(statement.error))
        return super().statement(statement)

    def named(self, name: str) -> str:
        symbol = self.scope.value(name)
        return self.bare.get(name, name) if symbol is None else self.spelled.get(id(symbol.declaration), name)


__all__ = ["name_errors"]

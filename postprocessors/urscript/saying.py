"""What the printers of places and of geometry need of the printer of expressions that uses them.

Stated here, below all three, so that none of their files leads back to itself.
"""

from __future__ import annotations

from typing import Protocol

from rpl import ir
from rpl.passes.scope import Scope


class Saying(Protocol):
    """Prints the expressions of one scope."""

    scope: Scope

    def text(self, expression: ir.Expression) -> str:
        """The expression."""
        ...

    def atom(self, expression: ir.Expression) -> str:
        """The expression, in brackets where something follows it."""
        ...

    def type(self, expression: ir.Expression) -> ir.Type | None:
        """Its static type."""
        ...

    def given(self, value: ir.Expression, wanted: ir.Type | None = None) -> str:
        """The value as it is handed over or kept."""
        ...

    def measured(self, value: ir.Expression, unit: str) -> str:
        """The value in that unit."""
        ...

    def listed(self, values: tuple[ir.Expression, ...]) -> str:
        """The values with commas between them."""
        ...

    def helper(self, name: str, *arguments: str) -> str:
        """A call of a function that the program brings along."""
        ...

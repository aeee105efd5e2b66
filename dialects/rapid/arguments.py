"""Actual arguments of installed functions and instructions, and what their makers may ask of the reader."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Protocol

from rpl import ir
from rpl.reading.shapes import StatementError


@dataclass(slots=True)
class Arguments:
    """Actual arguments of an installed function or instruction: positional ones, options by lower-case name (None for
    a switch), and whether one is passed on only when present."""

    name: str
    positional: list[ir.Expression] = field(default_factory=list)
    options: dict[str, ir.Expression | None] = field(default_factory=dict)
    conditional: bool = False

    def need(self, least: int, most: int | None = None) -> list[ir.Expression]:
        """The positional arguments, at least so many. Raises StatementError."""
        if not least <= len(self.positional) <= (least if most is None else most):
            raise StatementError(f"{self.name} takes {least} arguments, {len(self.positional)} are given", 0)
        return self.positional


class Signals(Protocol):
    """The reader, as far as installed functions need it."""

    def signal(self, value: ir.Expression, kind: str) -> ir.Expression: ...

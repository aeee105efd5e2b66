"""What a row of the table of refusals is made of."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any

from rpl import ir
from rpl.diagnostics import Code
from rpl.passes.capabilities import Capabilities
from rpl.passes.legalise.context import Context
from rpl.passes.scope import Scope

__all__ = ["PLAINLY", "Asked", "Found", "Refusal"]


@dataclass(slots=True)
class Asked:
    """What a row of the table may ask about: the translation, the program as a whole, and names where the statement
    stands."""

    context: Context
    program: ir.Program
    scope: Scope

    @property
    def can(self) -> Capabilities:
        return self.context.capabilities


Found = tuple[Mapping[str, object], ...]  # one for each report about a statement; none: it is not refused
PLAINLY: Found = ({},)


@dataclass(frozen=True, slots=True)
class Refusal:
    """A row. what: the construct in words, for the page of what is supported. code: its text says why, its help what to
    do. nodes: classes of statements; refused: what the reports about such a statement name. left: the statement stays,
    because no writer of such a target can say it; else it becomes one that none says. A row without `refused` is told
    by the pass that rewrites the simpler forms of the construct (`rewriting.stopping`)."""

    what: str
    code: Code
    nodes: tuple[type, ...] = ()
    refused: Callable[[Any, Asked], Found] | None = None
    left: bool = True

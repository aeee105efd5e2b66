"""Questions about all that stands in a body, at any depth. Writers ask them of every block on their way inwards."""

from __future__ import annotations

from collections.abc import Callable

from rpl import ir
from rpl.ir.walk import walk
from rpl.passes.legalise.facts.effects import blocks, children

__all__ = ["Anywhere"]


class Anywhere:
    """Is there a node of some kind in a body? The answer is kept for each body, because those in it are asked too."""

    def __init__(self, asked: Callable[[object], bool]) -> None:
        """`asked`: is this node one of them?"""
        self._asked = asked
        self._known: dict[int, tuple[ir.Body, bool]] = {}

    def __call__(self, body: ir.Body) -> bool:
        known = self._known.get(id(body))
        if known is None or known[0] is not body:
            known = self._known[id(body)] = body, any(map(self.within, body))
        return known[1]

    def within(self, statement: ir.Statement) -> bool:
        """The same of a statement, itself included."""
        inner = blocks(statement)
        if not inner:
            return any(map(self._asked, walk(statement)))
        head = self._asked(statement) or any(map(self._asked, walk(*children(statement))))
        return head or any(map(self, inner))

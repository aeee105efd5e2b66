"""Texts that a variable can hold, where a program only ever gives it literal ones.

Conservative and by name: variables of one name count as one; what is passed on, read in or computed may hold any text.
"""

from __future__ import annotations

from dataclasses import dataclass

from rpl import ir
from rpl.ir.walk import rewrite, walk
from rpl.passes.legalise.usage import assigned_in


@dataclass(frozen=True, slots=True)
class HeldTexts:
    """By folded name: the texts of its assignments, and its first value. `unknown`: names that may hold any text."""

    texts: dict[str, frozenset[str]]
    unknown: frozenset[str]

    @staticmethod
    def of(program: ir.Program) -> HeldTexts:
        found: dict[str, set[str]] = {}
        unknown: set[str] = set()
        for node in walk(*program.modules):
            match node:
                case ir.Assign(target=ir.Name(id=name), value=ir.TextLiteral(value=text)):
                    found.setdefault(name.lower(), set()).add(text)
                case ir.Variable(name=name, initial=ir.TextLiteral(value=text)):
                    found.setdefault(name.lower(), set()).add(text)
                case ir.Variable(name=name, initial=initial) if initial is not None:
                    unknown.add(name.lower())
                case ir.Parameter(name=name):
                    unknown.add(name.lower())
        for module in program.modules:
            for routine in module.routines:
                rest = rewrite(routine, _without_literals)
                for body in (rest.body, rest.undo, *(handler.body for handler in rest.handlers)):
                    unknown |= {name.lower() for name in assigned_in(body)}
        return HeldTexts({name: frozenset(texts) for name, texts in found.items()}, frozenset(unknown))

    def of_name(self, name: str) -> frozenset[str] | None:
        """Every text that it can hold; None when that is not known."""
        return None if name.lower() in self.unknown else self.texts.get(name.lower())


def _without_literals(node: object) -> object:
    match node:
        case ir.Assign(target=ir.Name(), value=ir.TextLiteral()):
            return ir.Nothing()
    return node


__all__ = ["HeldTexts"]

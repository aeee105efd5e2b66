"""The interrupts that a program declares, by what it calls them, and the software signals that it uses itself."""

from __future__ import annotations

from dataclasses import dataclass

from rpl import ir
from rpl.passes.legalise.kinds import walk_for


@dataclass(frozen=True, slots=True)
class Interrupts:
    """`declared`: all declarations of an interrupt, by its identity or priority; `flags`: of software signals."""

    declared: dict[str, list[ir.DeclareInterrupt]]
    flags: frozenset[int]

    @classmethod
    def of(cls, program: ir.Program) -> Interrupts:
        declared: dict[str, list[ir.DeclareInterrupt]] = {}
        flags: set[int] = set()
        for node in walk_for({"DeclareInterrupt", "Signal", "System"}, program):
            if isinstance(node, ir.DeclareInterrupt):
                declared.setdefault(_key(node), []).append(node)
            elif (number := _flag(node)) is not None:
                flags.add(number)
        return cls(declared, frozenset(flags))


def _flag(node: object) -> int | None:
    """The number of a software signal that the program itself uses."""
    match node:
        case ir.Signal(kind="flag", index=ir.IntLiteral(value=number)):
            return number
        case ir.System(name="flag", indices=(ir.IntLiteral(value=number),)):
            return number
    return None


def _key(declared: ir.DeclareInterrupt) -> str:
    return repr(declared.identity if declared.identity is not None else declared.priority)

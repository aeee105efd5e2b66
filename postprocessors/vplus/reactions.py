"""Interrupts as REACT, REACTI, IGNORE, LOCK. V+ arms a reaction where it names its program, so a declaration elsewhere
leaves no step: it is looked up where the interrupt is switched on."""

from __future__ import annotations

from rpl import ir
from rpl.ir.walk import walk

from . import tables
from .expressions import Expressions, UnsayableError


class Reactions:
    """All interrupts of a program, by identity."""

    def __init__(self, program: ir.Program) -> None:
        self.declared: dict[str, list[ir.DeclareInterrupt]] = {}
        for node in walk(program):
            if isinstance(node, ir.DeclareInterrupt):
                self.declared.setdefault(_key(node), []).append(node)

    def lines(self, statement: ir.DeclareInterrupt | ir.ControlInterrupt, expressions: Expressions) -> list[str]:
        if isinstance(statement, ir.DeclareInterrupt):
            self.step(statement, expressions)  # says here what cannot be watched
            return []
        handle = statement.handle
        match statement.op:
            case "mask":
                return [f"LOCK {expressions.text(_lifted(handle)) if handle is not None else '0'}"]
            case "disable" | "enable" if handle is None:
                return ["LOCK 0" if statement.op == "enable" else f"LOCK {tables.PRIORITY_TOP - 1}"]
            case "on":
                return [self.step(one, expressions) for one in self.meant(handle)]
            case "off" | "delete":
                return [f"IGNORE {self.signal(one.condition, expressions)}" for one in self.meant(handle)]
        raise UnsayableError(f"a single interrupt cannot be {statement.op}d")

    def meant(self, handle: ir.Expression | None) -> list[ir.DeclareInterrupt]:
        if handle is None:
            return [one for group in self.declared.values() for one in group[:1]]
        found = self.declared.get(repr(handle), [])
        if not found:
            raise UnsayableError("an interrupt that is not declared")
        if any(one != found[0] for one in found):
            raise UnsayableError("an interrupt that is declared in different ways")
        return found[:1]

    def step(self, declared: ir.DeclareInterrupt, expressions: Expressions) -> str:
        action = declared.action
        if not isinstance(action, ir.CallRoutine) or action.arguments or action.dynamic is not None:
            raise UnsayableError("a reaction calls a program without arguments")
        if declared.once:
            raise UnsayableError("a reaction that comes once only")
        word = "REACTI" if declared.stops else "REACT"
        urgency = expressions.text(_lifted(declared.priority))
        return f"{word} {self.signal(declared.condition, expressions)}, {action.name.lower()}, {urgency}"

    def signal(self, condition: ir.Expression, expressions: Expressions, on: bool = True) -> str:
        """The number of the signal that is watched, negative for its off state."""
        match condition:
            case ir.Unary(op="not", operand=operand):
                return self.signal(operand, expressions, not on)
            case ir.Binary(op="=" | "<>" as op, left=left, right=ir.BoolLiteral(value=value)):
                return self.signal(left, expressions, on == (value == (op == "=")))
            case ir.Name(id=name):
                declared = expressions.places.declared(name)
                if declared is not None:
                    return self.signal(declared, expressions, on)
            case ir.Signal() if not expressions.places.is_group(condition):
                return expressions.places.number(expressions.places.numbered(condition), not on)
        raise UnsayableError("a reaction watches one digital signal")


def _key(declared: ir.DeclareInterrupt) -> str:
    return repr(declared.identity if declared.identity is not None else declared.priority)


def _lifted(priority: ir.Expression) -> ir.Expression:
    """V+ priorities grow with their urgency."""
    match priority:
        case ir.IntLiteral(value=value) | ir.RealLiteral(value=value):
            return ir.IntLiteral(max(1, min(tables.PRIORITY_TOP - 1, tables.PRIORITY_TOP - int(value))))
        case ir.Binary(op="-", left=ir.IntLiteral(value=tables.PRIORITY_TOP), right=right):
            return right
    return ir.Binary("-", ir.IntLiteral(tables.PRIORITY_TOP), priority)


__all__ = ["Reactions"]

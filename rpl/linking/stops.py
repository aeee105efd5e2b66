"""Before which statements the program pointer waits until the robot has driven everything: the dialect's rules asked of
one statement.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from rpl import ir
from rpl.ir.walk import children

if TYPE_CHECKING:
    from rpl.linking.linker import Linker

_POSITION = frozenset(("current_target", "current_joints", "current_position"))


def stops_before(statement: ir.Statement, linker: Linker) -> bool:
    """Does the advance run stop before this statement?"""
    rules = linker.compiler.scope.rules.advance
    if statement.__class__.__name__ in rules.stop_statements:
        return True
    if isinstance(statement, ir.Halt | ir.WaitForMotion):
        return True
    if not rules.signals_stop or isinstance(statement, ir.Trigger | ir.DefineTrigger | ir.DeclareInterrupt):
        return False
    return any(looks_outside(part, linker) for part in _own_expressions(statement))


def _own_expressions(statement: ir.Statement) -> list[object]:
    """Expressions that the statement itself evaluates: not those of bodies inside it, nor of attached actions."""
    match statement:
        case ir.If(branches=branches):
            return [condition for condition, _ in branches]
        case ir.Switch(selector=selector, cases=cases):
            return [selector, *(value for case in cases for value in case.values)]
        case ir.For(start=start, stop=stop, step=step):
            return [start, stop, *([step] if step is not None else [])]
        case ir.While(condition=condition):
            return [condition]
        case ir.Repeat(until=until):
            return [until]
        case ir.Loop() | ir.Spline():
            return []
    return [statement]


def looks_outside(root: object, linker: Linker) -> bool:
    """Does the node read or write a signal, or read where the robot is?"""
    stack: list[object] = [root]
    while stack:
        node = stack.pop()
        match node:
            case ir.Signal(kind=kind):
                if kind != "flag":
                    return True
            case ir.System(name=name):
                row = ir.SYSTEM_VARIABLES.get(name)
                if row is not None and row.stops_advance:
                    return True
            case ir.Builtin(function=function) if function in _POSITION:
                return True
            case ir.Name(id=name):
                if isinstance(linker.compiler.place_of(name), ir.SignalDeclaration):
                    return True
        stack.extend(c for c in children(node) if not isinstance(c, ir.Trigger))
    return False

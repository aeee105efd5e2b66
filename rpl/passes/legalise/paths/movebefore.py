"""The move before a statement, where nothing in between can have moved the robot or changed the frame: what is said of
its place holds there still.
"""

from __future__ import annotations

from collections.abc import Sequence
from functools import cached_property

from rpl import ir
from rpl.ir.walk import walk
from rpl.passes.fold import Unchanged
from rpl.passes.legalise.facts.effects import blocks
from rpl.passes.legalise.facts.usage import base_name, doing
from rpl.passes.scope import Scope

_MODAL = frozenset(("tool", "base", "robot_root", "displacement"))
_WAITING = (ir.Nothing, ir.Wait, ir.WaitForMotion, ir.LookAhead, ir.Pulse, ir.Halt, ir.ExitLoop)


class MovesBefore:
    """What the statements of a program may do to the robot and to its data."""

    def __init__(self, program: ir.Program, unchanged: Unchanged) -> None:
        self.program, self.assigned = program, unchanged.assigned

    @cached_property
    def unquiet(self) -> frozenset[str]:
        """Routines (folded names) that move the robot or change the frame, or of which that is not known."""
        return doing(self.program, _is_unquiet)

    def found(self, done: Sequence[ir.Statement]) -> int | None:
        """Where in these statements the last move stands, when those behind it are quiet."""
        for at in range(len(done) - 1, -1, -1):
            if isinstance(done[at], ir.Move):
                return at
            if not self.is_quiet(done[at]):
                return None
        return None

    def is_quiet(self, statement: ir.Statement) -> bool:
        """Can neither the robot nor the frame be another one behind it, whatever it sets besides?"""
        match statement:
            case ir.Assign(target=ir.System(name=name)):
                quiet = name not in _MODAL
            case ir.Assign(target=target):
                quiet = not any(isinstance(node, ir.System) for node in walk((target,)))
            case ir.CallRoutine(name=name, dynamic=None):
                quiet = name.lower() not in self.unquiet and name.lower() in self.names
            case ir.If() | ir.Switch() | ir.For() | ir.While() | ir.Repeat() | ir.Loop():
                quiet = all(self.is_quiet(one) for body in blocks(statement) for one in body)
            case ir.WaitUntil() | ir.Message() | ir.Clock():
                quiet = True
            case _:
                return isinstance(statement, _WAITING)
        return quiet and not any(
            isinstance(node, ir.Call) and (node.name.lower() in self.unquiet or node.name.lower() not in self.names)
            for node in walk((statement,))
        )

    @cached_property
    def names(self) -> frozenset[str]:
        return frozenset(one.name.lower() for module in self.program.modules for one in module.routines)

    def may_change(self, place: ir.Expression, statements: Sequence[ir.Statement], scope: Scope) -> bool:
        """May these quiet statements change what the place is made of?"""
        read = {node.id.lower() for node in walk((place,)) if isinstance(node, ir.Name)}
        if not read.isdisjoint(_assigned(statements)):
            return True
        calls = [one for one in walk(*statements) if isinstance(one, ir.CallRoutine | ir.Call)]
        lent = {node.id.lower() for one in calls for node in walk(one.arguments) if isinstance(node, ir.Name)}
        return bool(calls) and any(name in lent or self.is_shared(name, scope) for name in read)

    def is_shared(self, name: str, scope: Scope) -> bool:
        """Data that other routines may set."""
        symbol = scope.value(name)
        return name in self.assigned and (symbol is None or symbol.routine is None)


def _is_unquiet(node: object) -> bool:
    match node:
        case ir.Assign(target=ir.System(name=name) | ir.Field(base=ir.System(name=name))):
            return name in _MODAL
        case ir.CallRoutine(dynamic=dynamic):
            return dynamic is not None
        case ir.Move() | ir.Spline() | ir.TaskControl() | ir.Vendor() | ir.Opaque() | ir.MoveExternal():
            return True
        case ir.StopMotion() | ir.StartMotion() | ir.ClearMotion() | ir.StoreMotion():
            return True
    return False


def _assigned(statements: Sequence[ir.Statement]) -> set[str]:
    """Variables (folded names) that these set by themselves."""
    found: set[str] = set()
    for node in walk(*statements):
        match node:
            case ir.Assign(target=target):
                found.add((base_name(target) or "").lower())
            case ir.For(counter=counter):
                found.add(counter.lower())
            case ir.WaitUntil() | ir.Clock():
                found.update(one.id.lower() for one in walk((node,)) if isinstance(one, ir.Name))
    return found


def passes(statement: ir.Statement) -> bool:
    """Can neither the robot nor the frame nor any variable be another one behind it?"""
    match statement:
        case ir.Assign(target=ir.Signal()) | ir.Nothing() | ir.Wait() | ir.WaitUntil() | ir.WaitForMotion():
            return True
        case ir.LookAhead():
            return True
        case ir.Assign(target=ir.System(name=name)):
            return name not in ("tool", "base")
    return False


def says_how(move: ir.Move) -> bool:
    """Does the move say besides its place how it goes there, and nothing of where or in which posture?"""
    names = [place.name if isinstance(place, ir.System) else "tool" for place, _ in move.settings]
    return not any(name in _MODAL or name.startswith("posture_") for name in names)


__all__ = ["MovesBefore", "passes", "says_how"]

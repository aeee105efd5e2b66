"""Where the robot stands by itself and where the program has to wait for it, along all ways of a script.

A move without a blend radius has ended when the next line runs, a move with one has not. A step that wants the robot
to stand therefore says nothing behind the former, takes the radius from a move directly in front of it (also where the
step is the first of a routine that is called there), and is written as a wait where the robot may be at a corner.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable

from rpl import ir
from rpl.ir.walk import expressions, walk
from rpl.passes.legalise.facts.effects import blocks, children
from rpl.passes.legalise.facts.runbeside import RunBeside, stands_still

_LOOPS = (ir.For, ir.While, ir.Repeat, ir.Loop)
_DEEPEST = 8  # calls in calls that are looked into
_ROUNDS = 12


class Standing:
    """The facts of one script."""

    def __init__(self, program: ir.Program) -> None:
        self.routines = {one.name.lower(): one for module in program.modules for one in module.routines}
        self.changed = RunBeside.of(program).changed
        # In how many routines a name stands.
        self.routines_with = Counter(
            name
            for one in self.routines.values()
            for name in {n.id.lower() for n in walk(one) if isinstance(n, ir.Name)}
        )
        self.entered: set[str] = set()  # routines that may be called while the robot is at a corner
        self.leave: dict[tuple[str, bool], bool] = {}  # routine, at a corner before -> at one behind?
        self.waits: set[int] = set()  # the steps (by identity) that have to wait
        for _ in range(_ROUNDS):
            known = len(self.entered), dict(self.leave)
            self.everywhere()
            if known == (len(self.entered), self.leave):
                break

    def everywhere(self) -> None:
        for name, routine in self.routines.items():
            for entered in (False, True) if name in self.entered else (False,):
                way = _Way(self)
                end = way.body(routine.body, entered)
                self.leave[name, entered] = end or way.returned

    def must_wait(self, step: ir.WaitForMotion) -> bool:
        return id(step) in self.waits

    def wanted(self, rest: ir.Body, depth: int = 0) -> bool:
        """Does the next step want the robot to stand, or the first one of what it calls?"""
        for statement in rest:
            match statement:
                case ir.Nothing():
                    continue
                case ir.Assign(target=ir.Name(id=name), value=value) if self.unseen(name, value):
                    continue
                case ir.WaitForMotion() | ir.Wait(in_position=True) | ir.WaitUntil(in_position=True):
                    return True
                case ir.CallRoutine(name=name, dynamic=None) if depth < _DEEPEST and not _calls(children(statement)):
                    called = self.routines.get(name.lower())
                    return called is not None and self.wanted(called.body, depth + 1)
            return False
        return False

    def unseen(self, name: str, value: ir.Expression) -> bool:
        """May a variable be set later, when the robot stands: is it of one routine alone, and its value the same?"""
        return self.routines_with[name.lower()] == 1 and all(
            stands_still(part, self.changed) for part in expressions(value)
        )


class _Way:
    """One routine. A state tells whether the robot may be at a corner."""

    def __init__(self, facts: Standing) -> None:
        self.facts = facts
        self.returned = False
        self.exits: list[bool] = []

    def body(self, body: ir.Body, state: bool) -> bool:
        for at, statement in enumerate(body):
            state = self.statement(statement, state, body[at + 1 :])
        return state

    def statement(self, statement: ir.Statement, state: bool, rest: ir.Body) -> bool:
        for name in _calls(children(statement)):
            state = self.called(name, state)
        match statement:
            case ir.Move(blend=blend):
                return _rounds(blend) and not self.facts.wanted(rest)
            case ir.WaitForMotion():
                if state:
                    self.facts.waits.add(id(statement))
                return False
            case ir.MoveExternal() | ir.Spline() | ir.StopMotion() | ir.Halt():
                return False
            case ir.CallRoutine(name=name):
                return self.called(name.lower(), state)
            case ir.Return():
                self.returned = self.returned or state
                return False
            case ir.ExitLoop() | ir.NextPass():
                self.exits[-1:] = [state or any(self.exits[-1:])]
                return False
        if isinstance(statement, _LOOPS):
            return self.loop(statement, state)
        inner = blocks(statement)
        ends = [self.body(one, state) for one in inner]
        return any(ends) or (not inner and state)

    def loop(self, statement: ir.For | ir.While | ir.Repeat | ir.Loop, state: bool) -> bool:
        self.exits.append(False)
        end = self.body(statement.body, state)
        if (end or self.exits[-1]) and not state:  # each further pass begins as the one before it ends
            end = self.body(statement.body, True) or end
        left = self.exits.pop()
        return state or end or left if isinstance(statement, ir.For | ir.While) else end or left

    def called(self, name: str, state: bool) -> bool:
        if name not in self.facts.routines:
            return state
        if state:
            self.facts.entered.add(name)
        return self.facts.leave.get((name, state), False)


def _rounds(blend: ir.Blend | None) -> bool:
    match blend:
        case ir.BlendDistance(distance=distance) | ir.BlendZone(distance=distance) if distance is not None:
            return distance not in (ir.IntLiteral(0), ir.RealLiteral(0.0))
    return blend not in (None, ir.BlendStop())


def _calls(nodes: Iterable[object]) -> list[str]:
    """The functions of the program that expressions call, in lower case."""
    return [node.name.lower() for node in walk(*nodes) if isinstance(node, ir.Call)]


__all__ = ["Standing"]

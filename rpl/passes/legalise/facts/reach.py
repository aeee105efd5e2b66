"""Which statements may run while an interrupt is armed that the program has to serve itself.

One bit is carried through branches, loops and calls of the whole program until nothing changes, for each routine apart
by what it was at the call; what is not known counts as armed.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Protocol

from rpl import ir
from rpl.ir.walk import bodies, walk
from rpl.passes.legalise.facts.effects import children, everything


class Keys(Protocol):
    """What is asked of the interrupts."""

    def arms(self, statement: ir.ControlInterrupt) -> bool | None: ...


@dataclass(frozen=True, slots=True)
class Armed:
    """One interrupt by its number."""

    key: int

    def arms(self, statement: ir.ControlInterrupt) -> bool | None:
        handle = statement.handle
        other = isinstance(handle, ir.IntLiteral) and handle.value != self.key
        return None if other or statement.op not in ("on", "off", "delete") else statement.op == "on"


def armed_statements(program: ir.Program, keys: Keys) -> frozenset[int]:
    """Identities of the statements that may run then."""
    routines = {routine.name.lower(): routine for module in program.modules for routine in module.routines}
    reach = _Reach(keys, {(name, armed): False for name in routines for armed in (False, True)})
    while True:
        before = (set(reach.entries), dict(reach.exits), set(reach.jumps), len(reach.marked))
        for name, routine in routines.items():
            reach.here = name
            for armed in (False, True) if name in reach.entries else (False,):
                reach.leaving = reach.switched = False
                end = reach.body(routine.body, armed)
                for other in filter(None, bodies(routine)[1:]):  # an error may come where it was armed, or before
                    end = reach.body(other, end or armed or reach.switched) or end
                reach.exits[name, armed] = reach.exits.get((name, armed), False) or end or reach.leaving
        if before == (reach.entries, reach.exits, reach.jumps, len(reach.marked)):
            return frozenset(reach.marked)


def with_calls(program: ir.Program, marked: frozenset[int], declaring: frozenset[str]) -> frozenset[int]:
    """Also the calls of routines that arm the interrupt themselves: what leaves its level comes back behind these, up
    to the routine that declares it (by folded name)."""
    routines = {routine.name.lower(): routine for module in program.modules for routine in module.routines}
    calls = {
        name: [node for node in walk(*bodies(routine)) if isinstance(node, ir.CallRoutine)]
        for name, routine in routines.items()
    }
    ways = {
        name
        for name, routine in routines.items()
        if name not in declaring and any(id(node) in marked for node in walk(*bodies(routine)))
    }
    while True:
        more = {
            name
            for name, found in calls.items()
            if name not in declaring and any(call.name.lower() in ways for call in found)
        }
        if more <= ways:
            break
        ways |= more
    return marked | {id(call) for found in calls.values() for call in found if call.name.lower() in ways}


@dataclass(slots=True)
class _Reach:
    """`exits`: routine (folded) and whether it was armed at its call -> may it be armed behind. `entries`: routines
    that are called while it is armed. `switched`: is it armed anywhere in the routine at hand? `jumps`: labels, with
    their routine, that a jump comes to while it is armed; `left`: of each loop around, is it left so?"""

    keys: Keys
    exits: dict[tuple[str, bool], bool]
    entries: set[str] = field(default_factory=set)
    marked: set[int] = field(default_factory=set)
    leaving: bool = False
    switched: bool = False
    here: str = ""
    jumps: set[tuple[str, str]] = field(default_factory=set)
    left: list[bool] = field(default_factory=list)

    def body(self, body: ir.Body, armed: bool) -> bool:
        for statement in body:
            armed = self.statement(statement, armed)
        return armed

    def called(self, name: str, armed: bool) -> bool:
        key = name.lower()
        if armed:
            self.entries.add(key)
        return self.exits.get((key, armed), armed)

    def statement(self, statement: ir.Statement, armed: bool) -> bool:
        for expression in children(statement):
            for one in everything(expression):
                if isinstance(one, ir.Call):
                    armed = self.called(one.name, armed)
        if armed:
            self.marked.add(id(statement))
        match statement:
            case ir.ControlInterrupt():
                told = self.keys.arms(statement)
                self.switched = self.switched or bool(told)
                return armed if told is None else told
            case ir.OrderInterrupt(handle=handle):
                told = self.keys.arms(ir.ControlInterrupt("on", handle))
                self.switched = self.switched or bool(told)
                return armed if told is None else told
            case ir.CallRoutine(name=name):
                return self.called(name, armed)
            case ir.If(branches=branches, otherwise=otherwise):
                ends = [self.body(inner, armed) for _, inner in branches]
                return any([*ends, self.body(otherwise, armed)])
            case ir.Switch(cases=cases, default=default):
                ends = [self.body(case.body, armed) for case in cases]
                return any([*ends, self.body(default or (), armed)])
            case ir.For(body=body) | ir.While(body=body) | ir.Repeat(body=body) | ir.Loop(body=body):
                self.left.append(False)
                end = self.body(body, armed)
                if (end or self.left[-1]) and not armed:
                    end = self.body(body, True) or end
                return self.left.pop() or end or armed
            case ir.ExitLoop() | ir.NextPass() if self.left:
                self.left[-1] = self.left[-1] or armed
            case ir.Goto(label=label) if armed:
                self.jumps.add((self.here, label.lower()))
                self.left = [True] * len(self.left)  # a jump may leave any of the loops, or come back into one
            case ir.Label(name=name):
                return armed or (self.here, name.lower()) in self.jumps
            case ir.Return():
                self.leaving = self.leaving or armed
        return armed


__all__ = ["armed_statements"]


def number_of(value: ir.Expression | None) -> int | None:
    """The number of an interrupt that is given as a constant."""
    match value:
        case ir.IntLiteral(value=number):
            return number
        case ir.RealLiteral(value=real) if real.is_integer():
            return int(real)
    return None


def key_of(one: ir.DeclareInterrupt) -> int | None:
    """The number that control statements name the interrupt by."""
    return number_of(one.identity if one.identity is not None else one.priority)

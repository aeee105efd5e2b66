"""Which data a program may read before it has set it, over all calls: there it would matter what the last run has left.

Each routine is a step from what is wanted behind a call of it to what is wanted before. What comes at any time
(interrupts, actions on the path) reads from where it is connected on, tasks beside the program from the start. A
routine that an interrupt may leave for the level of its declaration sets nothing for certain.
"""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass

from rpl import ir
from rpl.ir.walk import bodies, walk
from rpl.passes.legalise.facts.effects import blocks, children, everything, statements_in
from rpl.passes.legalise.facts.liveness import Liveness, Names
from rpl.passes.legalise.facts.usage import called_below, doing, usage_of
from rpl.passes.legalise.kinds import holds_none

__all__ = ["read_first"]

_NONE: Names = frozenset()
_UP, _DOWN = ir.BoolLiteral(True), ir.BoolLiteral(False)
_CALLING = frozenset(("CallRoutine", "Call", "ConnectInterrupt", "TaskControl", "OnError"))
_SIMPLE = (ir.Move, ir.Assign, ir.Message, ir.Wait, ir.WaitUntil, ir.Switch, ir.For, ir.While, ir.Repeat, ir.Loop)


@dataclass(frozen=True, slots=True)
class _Passage:
    """A call of a routine: what it reads before it sets it, and what it does not surely set."""

    reads: Names = _NONE
    keeps: Names = _NONE


def read_first(program: ir.Program, names: Names, entries: Iterable[str], beside: Iterable[str] = ()) -> Names:
    """Those of `names` (folded; data of modules) that a run from one of the `entries` may read before it sets them.
    `beside`: routines that other tasks run. A name that stands for several data is always among them."""
    declared = Counter(one.name.lower() for one in _data(program))
    alone = frozenset(name for name in names if declared[name] == 1)
    routines = [routine for module in program.modules for routine in module.routines]
    left, guarded = _left(program), _guarded(program, alone)
    calls = {routine.name.lower(): _Passage() for routine in routines}
    waiting, calling = routines, [one for one in routines if not holds_none(one, _CALLING)]
    while waiting:
        before = dict(calls)
        for routine in waiting:
            key, hidden = routine.name.lower(), _own(routine)
            reads = _Reads(routine, alone - hidden, _NONE, calls, guarded).start
            keeps = alone if key in left else _Reads(routine, alone - hidden, alone - hidden, calls, guarded).start
            calls[key] = _Passage(calls[key].reads | reads, calls[key].keeps | keeps | (alone & hidden))
        waiting = calling if calls != before else []  # the others know all that they ask
    found = (names - alone).union(*(calls[one.lower()].reads for one in entries if one.lower() in calls))
    running = called_below(program, {one.lower() for one in beside})
    for routine in routines:
        if routine.name.lower() in running:
            found |= names & frozenset(node.id.lower() for node in walk(routine) if isinstance(node, ir.Name))
    return found


class _Reads(Liveness):
    """Of one routine, with what it calls. `guarded`: see `_guarded`."""

    def __init__(
        self,
        routine: ir.Routine,
        names: Names,
        after: Names,
        calls: Mapping[str, _Passage],
        guarded: Mapping[str, Names],
    ) -> None:
        self.calls, self.guarded = calls, guarded
        super().__init__(routine, names, after)

    def read(self, *parts: ir.Expression | None) -> Names:
        found = _NONE
        for node in (one for part in parts if part is not None for one in everything(part)):
            match node:
                case ir.Name(id=name):
                    found |= self.names & {name.lower()}
                case ir.Call(name=name):
                    found |= self.reads_of(name)
        return found

    def reads_of(self, name: str) -> Names:
        passage = self.calls.get(name.lower())
        return self.names if passage is None else self.names & passage.reads

    def branch(self, condition: ir.Expression, body: ir.Body, wanted: Names) -> Names:
        inside = self.body(body, wanted)
        for flag in _conjuncts(condition):
            inside -= self.guarded.get(flag, _NONE)
        return inside | self.read(condition)

    def other(self, statement: ir.Statement, wanted: Names) -> Names:
        match statement:
            case ir.CallRoutine(name=name, dynamic=None) if name.lower() in self.calls:
                passage = self.calls[name.lower()]
                return (wanted & passage.keeps) | self.reads_of(name) | self.read(*children(statement))
            case ir.CallRoutine():
                return self.names
            case ir.Opaque():
                return wanted
            case ir.Vendor(text=text):
                return wanted | (self.names & frozenset(re.findall(r"\w+", text.lower())))
        if isinstance(statement, _SIMPLE):
            return super().other(statement, wanted)
        for node in walk(statement):  # what it says that may come later too
            match node:
                case ir.Name(id=name):
                    wanted |= self.names & {name.lower()}
                case ir.CallRoutine(name=name) | ir.Call(name=name) | ir.ConnectInterrupt(routine=name):
                    wanted |= self.reads_of(name)
                case ir.TaskControl(task=name) | ir.OnError(routine=str(name)):
                    wanted |= self.reads_of(name)
        return wanted


def _data(program: ir.Program) -> Iterator[ir.Variable]:
    return (one for module in program.modules for one in module.declarations if isinstance(one, ir.Variable))


def _own(routine: ir.Routine) -> Names:
    return frozenset(
        one.name.lower()
        for one in (*routine.parameters, *routine.declarations)
        if isinstance(one, ir.Parameter | ir.Variable)
    )


def _conjuncts(condition: ir.Expression) -> Iterator[str]:
    """Truth values (folded) that hold where the condition does."""
    match condition:
        case ir.Name(id=name):
            yield name.lower()
        case ir.Binary(op="and" | "cand", left=left, right=right):
            yield from _conjuncts(left)
            yield from _conjuncts(right)


def _left(program: ir.Program) -> Names:
    """Routines that an interrupt may leave in the middle: what is called where interrupts are declared, if any leaves
    its level."""
    if not doing(program, lambda node: isinstance(node, ir.ResumeLevel)):
        return _NONE
    called: set[str] = set()
    for routine in (routine for module in program.modules for routine in module.routines):
        nodes = list(walk(*bodies(routine)))
        if any(isinstance(node, ir.DeclareInterrupt | ir.ConnectInterrupt) for node in nodes):
            called |= {node.name.lower() for node in nodes if isinstance(node, ir.CallRoutine | ir.Call)}
    return called_below(program, called)


def _guarded(program: ir.Program, names: Names) -> dict[str, Names]:
    """Flag -> data that is set in front of each place which raises the flag: where the flag is up, the run has set it.
    Only of flags that begin down and that nothing else than a literal sets."""
    begin = {one.name.lower() for one in _data(program) if one.initial == _DOWN} & names
    begin -= usage_of(program).otherwise
    found: dict[str, Names] = {}
    raised, counted = Counter[str](), Counter[str]()
    for routine in (routine for module in program.modules for routine in module.routines):
        begin -= _own(routine)
        for node in walk(*bodies(routine)):
            match node:
                case ir.Assign(target=ir.Name(id=name), value=value) if value == _UP:
                    raised[name.lower()] += 1
                case ir.Assign(target=ir.Name(id=name), value=value) if value != _DOWN:
                    begin.discard(name.lower())
        for body in (inner for outer in bodies(routine) for inner in _all(outer)):
            ready: set[str] = set()
            for statement in body:
                match statement:
                    case ir.Label():
                        ready.clear()
                    case ir.Assign(target=ir.Name(id=name), value=value):
                        if value == _UP:
                            counted[name.lower()] += 1
                            found[name.lower()] = found.get(name.lower(), names) & ready
                        ready.add(name.lower())
    return {flag: data for flag, data in found.items() if flag in begin and raised[flag] == counted[flag]}


def _all(body: ir.Body) -> Iterator[ir.Body]:
    """The body and those inside it."""
    yield body
    for statement in statements_in(body):
        yield from blocks(statement)

"""Which routines call which, and which may be active twice at a time: by calling themselves, or from an interrupt or
another task while they run.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field

from rpl import ir
from rpl.ir.walk import bodies
from rpl.passes.legalise.facts.effects import blocks, children, everything
from rpl.passes.legalise.kinds import kinds_within
from rpl.passes.scope import ProgramScope, Scope


@dataclass(slots=True)
class Activations:
    """`calls`: routine -> routines it calls, by identity. `recursive`: those that come back to themselves. `beside`:
    those that run for an interrupt, a trigger or a second task as well as for the program. `threads`: what each thread
    of the program may run, the program itself first."""

    routines: dict[int, ir.Routine] = field(default_factory=dict)
    calls: dict[int, set[int]] = field(default_factory=dict)
    recursive: set[int] = field(default_factory=set)
    beside: set[int] = field(default_factory=set)
    threads: list[set[int]] = field(default_factory=list)

    @classmethod
    def of(cls, program: ir.Program) -> Activations:
        made = cls()
        scopes = ProgramScope(program)
        apart: list[set[int]] = []  # the first routines of each thread of the program
        handling: set[int] = set()
        starts = {task.entry.lower() for task in program.tasks}
        for module, routine in scopes.routines():
            made.routines[id(routine)] = routine
            scope = scopes.routine(module, routine)
            callees = made.calls.setdefault(id(routine), set())
            for statement in _statements(routine):
                callees.update(map(id, called(statement, scope)))
                handling.update(map(id, _handling(statement, scope)))
                started = _started(statement, scope)
                if started is not None:
                    apart.append({id(started)})
            if routine.name.lower() in starts:
                apart.append({id(routine)})
        if handling:
            apart.append(handling)
        made.recursive = {key for key in made._beyond_leaves() if key in made.reached(made.calls[key])}
        made._find_beside(apart)
        return made

    def _beyond_leaves(self) -> set[int]:
        """Routines from which some call may lead back: all but those whose calls end. Programs have few of them."""
        callers: dict[int, list[int]] = {}
        for caller, callees in self.calls.items():
            for callee in callees:
                callers.setdefault(callee, []).append(caller)
        left = {key: len(callees) for key, callees in self.calls.items()}
        ending = [key for key in {*self.calls, *callers} if not left.get(key)]
        while ending:
            ended = ending.pop()
            left.pop(ended, None)
            for caller in callers.get(ended, ()):
                left[caller] -= 1
                if not left[caller]:
                    ending.append(caller)
        return set(left)

    def reached(self, starts: set[int]) -> set[int]:
        """These routines and all they call."""
        found, work = set(starts), list(starts)
        while work:
            for callee in self.calls.get(work.pop(), ()):
                if callee not in found:
                    found.add(callee)
                    work.append(callee)
        return found

    def _find_beside(self, apart: list[set[int]]) -> None:
        """Routines that two threads reach; what nobody calls belongs to the program itself."""
        anywhere = {callee for callees in self.calls.values() for callee in callees} | {
            one for starts in apart for one in starts
        }
        main = self.reached({key for key in self.calls if key not in anywhere})
        seen: set[int] = set(main)
        self.threads.append(main)
        for starts in apart:
            reached = self.reached(starts)
            self.threads.append(reached)
            self.beside |= reached & seen
            seen |= reached


def called(statement: ir.Statement, scope: Scope) -> list[ir.Routine]:
    """The program's routines that the statement itself calls (the blocks in it not looked at)."""
    names = [statement.name] if isinstance(statement, ir.CallRoutine) and statement.dynamic is None else []
    for child in children(statement) if "Call" in kinds_within(statement) else ():
        names += [one.name for one in everything(child) if isinstance(one, ir.Call)]
    found = [scope.routine(name) for name in names]
    return [routine for routine in found if routine is not None]


def _statements(routine: ir.Routine) -> Iterator[ir.Statement]:
    work = [statement for body in bodies(routine) for statement in body]
    while work:
        statement = work.pop()
        yield statement
        work.extend(one for body in blocks(statement) for one in body)


def _handling(statement: ir.Statement, scope: Scope) -> list[ir.Routine]:
    """Routines that the statement gives to an interrupt or a trigger."""
    names: list[str] = []
    match statement:
        case ir.DeclareInterrupt(action=ir.CallRoutine(name=name)) | ir.Trigger(action=ir.CallRoutine(name=name)):
            names.append(name)
        case ir.ConnectInterrupt(routine=name):
            names.append(name)
        case ir.OnError(routine=name) if name is not None:
            names.append(name)
        case ir.DefineTrigger(trigger=ir.Trigger(action=ir.CallRoutine(name=name))):
            names.append(name)
        case ir.Move(triggers=parts) | ir.Spline(body=parts):
            actions = [one.action for one in parts if isinstance(one, ir.Trigger)]
            names += [action.name for action in actions if isinstance(action, ir.CallRoutine)]
    found = [scope.routine(name) for name in names]
    return [routine for routine in found if routine is not None]


def _started(statement: ir.Statement, scope: Scope) -> ir.Routine | None:
    return scope.routine(statement.task) if isinstance(statement, ir.TaskControl) and statement.op == "start" else None

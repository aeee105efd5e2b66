"""What names hold in front of each statement: a name is known where every way there has given it the same.

The ground of four questions: settings as the program says them (`settingsinforce`) and as poses (`framesinforce`),
values of variables (`heldvalues`), and shifts of moves (`source.places.knownshifts`). They differ in what they take for
a value. Names are folded; a setting has a `$` in front, and what is known of a part or a trait of a variable is kept by
its name with brackets behind it (`tab[2]`).
"""

from __future__ import annotations

from abc import abstractmethod
from collections.abc import Mapping, Set
from typing import TypeVar

from rpl import ir
from rpl.passes.legalise.facts.entries import routines_beside
from rpl.passes.legalise.facts.forward import Forward, beside, reactions, started
from rpl.passes.legalise.facts.usage import assigned_below, assigned_in, base_name, done_below
from rpl.passes.legalise.kinds import gathering, walk_for
from rpl.passes.scope import Scope

V = TypeVar("V")
Changed = Mapping[str, Set[str]]  # routine -> what it changes, itself or by what it calls
_NOTHING: Set[str] = frozenset()
_ACTIONS = frozenset(("DeclareInterrupt", "Trigger"))


class InForce(Forward[Mapping[str, V]]):
    """`start`: what a run begins with; at other times nothing is known. `changed`: routine -> what it changes, itself
    or by what it calls. `unsure`: what may change between any two statements, of which nothing is known anywhere."""

    beyond_stops = True

    def __init__(self, program: ir.Program, start: Mapping[str, V]) -> None:
        variables, settings = assigned_below(program), done_below(program, _settings_of)
        self.changed = {name: frozenset(found | settings.get(name, set())) for name, found in variables.items()}
        self.unsure = changed_at_any_time(program, variables, settings)
        sure = {key: value for key, value in start.items() if variable(key) not in self.unsure}
        super().__init__(program, sure, {})

    def follow_program(self) -> None:
        """From wherever a run may begin."""
        self.solve(started(self.program), beside(self.program))

    # ---- what a question says

    @abstractmethod
    def assigned(
        self, name: str, target: ir.Expression, value: ir.Expression, before: Mapping[str, V]
    ) -> Mapping[str, V]:
        """What holds behind an assignment to `name`, or to a part of it."""

    def rests_on(self, value: V) -> Set[str]:
        """Variables without which a value is no longer what it was."""
        return _NOTHING

    def brought(self, state: Mapping[str, V], home: Scope, there: Scope) -> Mapping[str, V]:
        """What holds in one routine, as another one says it."""
        return state

    # ---- what they have in common

    def join(self, one: Mapping[str, V], other: Mapping[str, V]) -> Mapping[str, V]:
        same = {key: value for key, value in one.items() if key in other and other[key] == value}
        return one if len(same) == len(one) else same

    def transfer(self, statement: ir.Statement, before: Mapping[str, V]) -> Mapping[str, V]:
        match statement:
            case ir.Assign(target=target, value=value):
                name = changed_name(target)
                return (
                    self.without(before, {name}) if name in self.unsure else self.assigned(name, target, value, before)
                )
            case ir.For(counter=counter):
                return self.without(before, {counter.lower()})
            case ir.Do() | ir.Dialog() | ir.WaitUntil() | ir.Clock() | ir.DefineTrigger() | ir.Move(search=ir.Search()):
                return self.without(before, assigned_in((statement,))) if before else before
        return before

    def entered(self, state: Mapping[str, V], here: Scope, there: Scope) -> Mapping[str, V]:
        return self.brought(state, here, there)

    def left(
        self, before: Mapping[str, V], end: Mapping[str, V], routine: ir.Routine, there: Scope, here: Scope
    ) -> Mapping[str, V]:
        changed = self.changed.get(routine.name.lower(), _NOTHING)
        back = {key: value for key, value in end.items() if variable(key) in changed}
        kept = self.without(before, changed)
        return {**kept, **self.brought(back, there, here)} if back else kept

    def passed(self, call: ir.CallRoutine | ir.Call, state: Mapping[str, V]) -> Mapping[str, V]:
        """What is given to a parameter by reference may be changed."""
        return self.without(state, {base_name(one.value) or "" for one in call.arguments if one.value is not None})

    def without(self, state: Mapping[str, V], names: Set[str]) -> Mapping[str, V]:
        """The state with nothing known of these, nor of what rests on them."""
        kept = {
            key: value
            for key, value in state.items()
            if variable(key) not in names and self.rests_on(value).isdisjoint(names)
        }
        return state if len(kept) == len(state) else kept


def variable(key: str) -> str:
    """The variable or setting that a name in a state belongs to."""
    return key.partition("[")[0]


def changed_name(target: ir.Expression) -> str:
    """The variable or setting that an assignment changes, or changes a part of."""
    match target:
        case ir.System(name=name) | ir.Field(base=ir.System(name=name)):
            return f"${name}"
    return base_name(target) or ""


def changed_at_any_time(program: ir.Program, variables: Changed, settings: Changed) -> frozenset[str]:
    """What interrupts, triggers and error routines change, and variables that other tasks do (their settings are their
    own)."""
    reacting = {name.lower() for name in reactions(program)}
    apart = {task.entry.lower() for task in program.tasks if task.kind != "motion"}
    apart |= {task.entry.lower() for task in program.tasks[1:]} | {*beside(program)} | routines_beside(program)
    found = set[str]().union(*(settings.get(name, _NOTHING) for name in reacting))
    found = found.union(*(variables.get(name, _NOTHING) for name in reacting | apart))
    for node in walk_for(_ACTIONS, *program.modules):
        match node:
            case ir.DeclareInterrupt(action=ir.Assign(target=target)) | ir.Trigger(action=ir.Assign(target=target)):
                found.add(changed_name(target))
    return frozenset(found)


@gathering("System")
def _settings_of(statement: ir.Statement) -> tuple[str, ...]:
    """Settings that a statement changes."""
    match statement:
        case ir.Assign(target=ir.System() | ir.Field(base=ir.System()) as target):
            return (changed_name(target),)
    return ()


__all__ = ["InForce", "changed_name", "variable"]

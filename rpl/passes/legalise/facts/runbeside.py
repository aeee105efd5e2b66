"""What runs beside the program that moves the robot, and which variables it sets: interrupts, actions on the path,
background tasks and what these call. Names in lower case.
"""

from __future__ import annotations

from dataclasses import dataclass

from rpl import ir
from rpl.ir.walk import bodies, walk
from rpl.passes.legalise.facts.motion.advance import is_flag
from rpl.passes.legalise.facts.usage import base_name

_BY_TIME = frozenset(("clock_seconds", "time_text", "date_text", "random", "text_value"))
FLAGS = "a flag"  # in the place of a variable's name: all flags of the controller count as one


@dataclass(frozen=True, slots=True)
class RunBeside:
    """calls: what each routine calls; beside: routines that interrupts and background tasks run; changed: variables
    that these assign."""

    calls: dict[str, set[str]]
    beside: frozenset[str]
    changed: frozenset[str]

    @classmethod
    def of(cls, program: ir.Program) -> RunBeside:
        routines = {r.name.lower(): r for module in program.modules for r in module.routines}
        calls = {name: _called(routine) & routines.keys() for name, routine in routines.items()}
        started = {task.entry.lower() for task in program.tasks if task.kind != "motion"}
        for routine in routines.values():
            for node in walk(*bodies(routine)):
                match node:
                    case ir.DeclareInterrupt(action=ir.CallRoutine(name=name)) | ir.ConnectInterrupt(routine=name):
                        started.add(name.lower())
                    case ir.Trigger(action=ir.CallRoutine(name=name)) | ir.TaskControl(task=name, op="start"):
                        started.add(name.lower())
        beside = _with_callees(started & routines.keys(), calls)
        changed = {name for one in beside for name in _assigned(routines[one])}
        changed |= {
            name.lower()
            for routine in routines.values()
            for node in walk(*bodies(routine))
            if isinstance(node, ir.DeclareInterrupt | ir.Trigger) and isinstance(node.action, ir.Assign)
            for name in (assigned_name(node.action.target),)
            if name is not None
        }
        return cls(calls, beside, frozenset(changed))


def assigned_name(target: ir.Expression) -> str | None:
    """The variable that is assigned; all flags of the controller count as one."""
    return FLAGS if is_flag(target) else base_name(target)


def _called(routine: ir.Routine) -> set[str]:
    return {n.name.lower() for n in walk(*bodies(routine)) if isinstance(n, ir.CallRoutine | ir.Call)}


def _assigned(routine: ir.Routine) -> set[str]:
    own = {d.name.lower() for d in routine.declarations if isinstance(d, ir.Variable)}
    names = set()
    for node in walk(*bodies(routine)):
        match node:
            case ir.Assign(target=target):
                names.add(assigned_name(target))
            case ir.Do(arguments=arguments):
                names |= {base_name(one) for one in arguments if one is not None}
    return {name.lower() for name in names if name is not None} - own


def _with_callees(names: set[str], calls: dict[str, set[str]]) -> frozenset[str]:
    done, open_ = set(names), set(names)
    while open_:
        open_ = {callee for name in open_ for callee in calls.get(name, ())} - done
        done |= open_
    return frozenset(done)


def stands_still(value: ir.Expression, changes: frozenset[str] | None) -> bool:
    """Does reading it (its parts are asked for themselves) give the same as long as the program waits here?"""
    match value:
        case ir.Signal() | ir.System() | ir.Call():
            return False
        case ir.Builtin(function=function):
            return function not in _BY_TIME and not function.startswith("current_")
        case ir.Name(id=name):
            return changes is not None and name.lower() not in changes
    return True

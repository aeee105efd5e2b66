"""Critical sections in which no other task could come between anything: they are left out.

A section with one access that another task could notice (one assignment of what others look at, or one look at what
they assign) is the same without its bounds, since no controller divides one statement. What a program does before it
starts the task does not count. What is more than that needs the statement of the target, or is named as lost.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator

from rpl import ir
from rpl.ir.walk import bodies, children, walk
from rpl.passes.legalise.context import Context
from rpl.passes.legalise.facts.usage import base_name
from rpl.passes.legalise.kinds import walk_for
from rpl.passes.legalise.rewriting.editing import edit_bodies, map_body
from rpl.passes.legalise.rewriting.jumps import inside
from rpl.passes.legalise.stages import legalising
from rpl.passes.rewrite import changed
from rpl.source import NOWHERE

_SAID_APART = (ir.Call, ir.Builtin, ir.Signal, ir.System, ir.VendorValue)


@legalising(unless=lambda context: "Critical" in context.capabilities.statements, sees=("Critical",))
def without_criticals(program: ir.Program, context: Context) -> ir.Program:
    """Only for targets without critical sections, and programs whose tasks are started by statements."""
    if program.tasks:
        return program
    facts = Facts(program)
    modules = tuple(
        changed(module, routines=tuple(facts.edited(routine) for routine in module.routines))
        for module in program.modules
    )
    return changed(program, modules=modules)


class Facts:
    """Which routine runs in which task (`""`: the program itself), and what the routines read and assign."""

    def __init__(self, program: ir.Program) -> None:
        self.routines = {r.name.lower(): r for module in program.modules for r in module.routines}
        starts = [
            node
            for node in walk_for({"TaskControl"}, *program.modules)
            if isinstance(node, ir.TaskControl) and node.op == "start"
        ]
        declared = {node.task.lower() for node in starts if node.origin is NOWHERE}  # starting these again says nothing
        self.started = Counter(node.task.lower() for node in starts if node.task.lower() not in declared)
        self.started.update(declared)
        looped = {node.task.lower() for node in _in_loops(program) if node.op == "start"} - declared
        self.several = looped | {name for name, times in self.started.items() if times > 1}
        self.tasks: dict[str, set[str]] = {name: self.closure({name}) for name in self.started}
        calls = set().union(*(self.called(r) for r in self.routines)) if self.routines else set()
        self.alone = self.routines.keys() - calls - self.started.keys()
        self.tasks[""] = self.closure(self.alone)

    def called(self, name: str) -> set[str]:
        found = (n.name.lower() for n in walk(self.routines[name]) if isinstance(n, ir.CallRoutine | ir.Call))
        return {one for one in found if one in self.routines}

    def closure(self, names: set[str]) -> set[str]:
        done, todo = set[str](), {name for name in names if name in self.routines}
        while todo:
            done |= todo
            todo = set().union(*(self.called(name) for name in todo)) - done
        return done

    def after_start(self, routine: ir.Routine, task: str) -> list[ir.Body]:
        """The bodies of a routine; of the first one of a program only what stands behind the start of the task."""
        if routine.name.lower() not in self.alone or any(isinstance(one, ir.Label) for one in walk(routine)):
            return bodies(routine)
        starts = (
            at
            for at, statement in enumerate(routine.body)
            for node in walk(statement)
            if isinstance(node, ir.TaskControl) and node.op == "start" and node.task.lower() == task
        )
        first = next(starts, 0)
        if any(self.reaches(one, task) for one in routine.body[:first]):
            return bodies(routine)
        return [routine.body[first:], *bodies(routine)[1:]]

    def reaches(self, statement: ir.Statement, task: str) -> bool:
        """May the statement start the task by a routine that it calls, or by a task?"""
        called = {n.name.lower() for n in walk(statement) if isinstance(n, ir.CallRoutine | ir.Call)}
        called |= {n.task.lower() for n in walk(statement) if isinstance(n, ir.TaskControl)}
        inner = (self.routines[name] for name in self.closure(called))
        return any(isinstance(n, ir.TaskControl) and n.task.lower() == task for one in inner for n in walk(one))

    def edited(self, routine: ir.Routine) -> ir.Routine:
        """The routine without the sections that say nothing."""
        name = routine.name.lower()
        homes = [task for task, names in self.tasks.items() if name in names]
        if len(homes) != 1 or homes[0] in self.several:
            return routine
        others = [self.routines[one] for task, names in self.tasks.items() if task != homes[0] for one in names]
        beside = [body for one in others for body in self.after_start(one, homes[0])]
        named = {node.id.lower() for node in walk(*beside) if isinstance(node, ir.Name)}
        assigned = set(_changed_names(beside))

        def body(statements: ir.Body) -> ir.Body:
            bare = _bare(statements, named, assigned)
            return map_body(bare, lambda statement: (inside(statement, body),))

        return edit_bodies(routine, body)


def _bare(body: ir.Body, named: set[str], assigned: set[str]) -> ir.Body:
    """One body without the bounds of sections with at most one access that others notice."""
    done: list[ir.Statement] = []
    at = 0
    while at < len(body):
        one = body[at]
        end = next((n for n in range(at + 1, len(body)) if isinstance(body[n], ir.Critical)), None)
        if isinstance(one, ir.Critical) and one.enter and end is not None and not _enters(body[end]):
            section = body[at + 1 : end]
            seen = [_seen(each, named, assigned) for each in section]
            counted = [each for each in seen if each is not None]
            if len(counted) == len(seen) and sum(counted) <= 1:
                for bound in (one, *section, body[end]):
                    if not isinstance(bound, ir.Critical):
                        done.append(bound)
                    elif bound.origin.comments:
                        done.append(ir.Nothing(origin=bound.origin))
                at = end + 1
                continue
        done.append(one)
        at += 1
    return body if len(done) == len(body) else tuple(done)


def _enters(statement: ir.Statement) -> bool:
    return isinstance(statement, ir.Critical) and statement.enter


def _seen(statement: ir.Statement, named: set[str], assigned: set[str]) -> int | None:
    """How many accesses of a simple statement other tasks could notice; None for what is not simple."""
    match statement:
        case ir.Nothing():
            return 0
        case ir.Assign(target=target, value=value) if (name := base_name(target)) is not None:
            if any(isinstance(node, _SAID_APART) for node in walk(target, value)):
                return None
            looks = [node.id.lower() for node in walk(value) if isinstance(node, ir.Name)]
            if isinstance(target, ir.Index):
                looks += [node.id.lower() for one in target.indices for node in walk(one) if isinstance(node, ir.Name)]
            return int(name.lower() in named) + sum(look in assigned for look in looks)
    return None


def _changed_names(beside: list[ir.Body]) -> Iterator[str]:
    """What these statements may assign; each variable that they hand to another routine counts."""
    for node in walk(*beside):
        match node:
            case ir.Assign(target=target):
                name = base_name(target)
                yield from () if name is None else (name.lower(),)
            case ir.Nothing():
                continue
            case ir.For(counter=counter):
                yield counter.lower()
            case ir.CallRoutine() | ir.Do() | ir.Call() | ir.TaskControl() | ir.Argument():
                handed = (one for one in children(node) if isinstance(one, ir.Name | ir.Index | ir.Field))
                yield from (name.lower() for name in map(base_name, handed) if name is not None)


def _in_loops(program: ir.Program) -> Iterator[ir.TaskControl]:
    for loop in walk_for({"While", "Repeat", "Loop", "For"}, *program.modules):
        if isinstance(loop, ir.While | ir.Repeat | ir.Loop | ir.For):
            yield from (node for node in walk(loop) if isinstance(node, ir.TaskControl))

"""Critical sections as flags, for targets whose tasks cannot be held: a task sets its flag to go into a section, and
does so only while no other task's flag is set (the earlier task goes first when two come at once).

That keeps two sections apart, not a section and what others do outside of theirs. So it is done where what a section
uses is assigned by other tasks in sections only, and the difference is named. A task is ended from a section too.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

from rpl import ir
from rpl.diagnostics import Severity, code
from rpl.ir.walk import bodies, walk
from rpl.passes.legalise.context import Context
from rpl.passes.legalise.control.jumps import inside, leaves
from rpl.passes.legalise.facts.effects import blocks
from rpl.passes.legalise.facts.usage import base_name
from rpl.passes.legalise.rewriting.editing import edit_all, edit_bodies, map_body
from rpl.passes.legalise.rewriting.support import with_support
from rpl.passes.legalise.stages import legalising
from rpl.passes.legalise.tasks.criticals import Facts
from rpl.source import Origin

LOCKED = code(
    "critical-section-flag",
    Severity.WARNING,
    "the critical section holds only tasks that want to go into one ({flag} is on in it); what others do goes on",
)
OPEN = code(
    "critical-section-open",
    Severity.WARNING,
    "the critical section is written without its bounds: no other task changes what it uses, but may see it half done",
    "let the others look at the last variable that the section changes",
)
_TRUE, _FALSE = ir.BoolLiteral(True), ir.BoolLiteral(False)


@legalising(unless=lambda context: "Critical" in context.capabilities.statements, sees=("Critical",))
def critical_flags(program: ir.Program, context: Context) -> ir.Program:
    """Only for targets without critical sections, and programs whose tasks are started by statements."""
    if program.tasks:
        return program
    facts = Facts(program)
    found = _sections(facts)
    if not found or not _kept_apart(facts, found):
        return program
    if len(found) == 1:
        return _opened(program, context)
    ended = {n.task.lower() for n in walk(*program.modules) if isinstance(n, ir.TaskControl) and n.op == "stop"}
    enders = {_home(facts, name) for name, one in facts.routines.items() if _ends(one, ended & found.keys())}
    if None in enders:
        return program
    tasks = sorted({*found, *(one for one in enders if one is not None)})
    flags = {task: context.fresh(f"{task or _first(facts)}_inside") for task in tasks}
    worker = _Flags(flags, found.keys() & ended, context)
    modules = tuple(
        replace(module, routines=tuple(worker.routine(one, _home(facts, one.name.lower())) for one in module.routines))
        for module in program.modules
    )
    data = [ir.Variable(name, ir.BoolType(), _FALSE, scope="global") for name in flags.values()]
    return with_support(replace(program, modules=modules), context, data, (), modules[0].task)


def _opened(program: ir.Program, context: Context) -> ir.Program:
    """The program with sections of one task only, without their bounds."""

    def change(statement: ir.Statement) -> ir.Body:
        if isinstance(statement, ir.Critical):
            if statement.enter:
                context.diagnostics.report(OPEN, statement.origin)
            return (ir.Nothing(origin=statement.origin),) if statement.origin.comments else ()
        return (inside(statement, lambda body: map_body(body, change)),)

    return edit_all(program, lambda body: map_body(body, change))


def _first(facts: Facts) -> str:
    return min(facts.alone, default="program")


def _home(facts: Facts, routine: str) -> str | None:
    """The task that a routine runs in; None when it runs in several or in none."""
    homes = [task for task, names in facts.tasks.items() if routine in names]
    return homes[0] if len(homes) == 1 else None


def _ends(routine: ir.Routine, tasks: set[str]) -> bool:
    return any(isinstance(n, ir.TaskControl) and n.op == "stop" and n.task.lower() in tasks for n in walk(routine))


def _sections(facts: Facts) -> dict[str, list[ir.Statement]] | None:
    """Task -> the statements of its sections; None when a section does not begin and end in one body, is left from
    inside, or its task is not known."""
    done: dict[str, list[ir.Statement]] = {}
    for name, routine in facts.routines.items():
        if not any(isinstance(node, ir.Critical) for node in walk(routine)):
            continue
        home = _home(facts, name)
        if home is None:
            return None
        for body in _bodies(routine):
            within = False
            for statement in body:
                if isinstance(statement, ir.Critical):
                    if statement.enter == within:
                        return None
                    within = statement.enter
                elif within:
                    if any(leaves(node) or isinstance(node, ir.Label | ir.Critical) for node in _statements(statement)):
                        return None
                    done.setdefault(home, []).append(statement)
            if within:
                return None
    return done


def _bodies(routine: ir.Routine) -> Iterator[ir.Body]:
    """All bodies of a routine at any depth."""
    todo = list(bodies(routine))
    while todo:
        body = todo.pop()
        yield body
        for statement in body:
            todo.extend(blocks(statement))


def _statements(statement: ir.Statement) -> Iterator[ir.Statement]:
    yield statement
    for body in blocks(statement):
        for one in body:
            yield from _statements(one)


def _kept_apart(facts: Facts, sections: dict[str, list[ir.Statement]]) -> bool:
    """Does every other task assign what a section uses in sections of its own only?"""
    protected = {id(node) for statements in sections.values() for one in statements for node in _statements(one)}
    for task, statements in sections.items():
        used = {node.id.lower() for node in walk(*statements) if isinstance(node, ir.Name)}
        if any(isinstance(node, ir.CallRoutine | ir.Call | ir.VendorValue) for node in walk(*statements)):
            return False
        for other, names in facts.tasks.items():
            if other == task:
                continue
            for name in names:
                for body in facts.after_start(facts.routines[name], task):
                    for node in (n for one in body for n in _statements(one) if id(n) not in protected):
                        if used & set(_assigned(node)):
                            return False
    return True


def _assigned(statement: ir.Statement) -> Iterator[str]:
    """What the statement itself may assign; variables that it hands to a routine count."""
    match statement:
        case ir.Assign(target=target):
            name = base_name(target)
            yield from () if name is None else (name,)
        case ir.For(counter=counter):
            yield counter.lower()
        case ir.CallRoutine(arguments=arguments):
            handed = (base_name(one.value) for one in arguments if one.value is not None)
            yield from (name for name in handed if name is not None)
        case ir.Do():
            yield from (n.id.lower() for n in walk(statement) if isinstance(n, ir.Name))


class _Flags:
    def __init__(self, flags: dict[str, str], ended: set[str], context: Context) -> None:
        self.flags, self.ended, self.context = flags, ended, context
        self.order = list(flags)

    def routine(self, routine: ir.Routine, task: str | None) -> ir.Routine:
        if task is None or task not in self.flags:
            return routine

        def change(statement: ir.Statement) -> ir.Body:
            match statement:
                case ir.Critical(enter=True, origin=origin):
                    self.context.diagnostics.report(LOCKED, origin, flag=self.flags[task])
                    return self.entered(task, origin)
                case ir.Critical(origin=origin):
                    return (self.set(task, False, origin),)
                case ir.TaskControl(op="stop", task=name) if name.lower() in self.ended and name.lower() != task:
                    free = (self.set(one, False) for one in (name.lower(), task))
                    return (*self.entered(task, statement.origin), statement, *free)
            return (inside(statement, lambda body: map_body(body, change)),)

        return edit_bodies(routine, lambda body: map_body(body, change))

    def set(self, task: str, value: bool, origin: Origin | None = None) -> ir.Assign:
        made = ir.Assign(ir.Name(self.flags[task]), _TRUE if value else _FALSE)
        return made if origin is None else replace(made, origin=origin)

    def entered(self, task: str, origin: Origin) -> ir.Body:
        """The statements that wait until the task may go into a section."""
        at = self.order.index(task)
        earlier, later = self.order[:at], self.order[at + 1 :]
        own = ir.Name(self.flags[task])
        body: list[ir.Statement] = [self.set(task, True)]
        if earlier:
            free = self.none_of(earlier)
            again = ir.If(((ir.Unary("not", free), (self.set(task, False),)),))
            body = [ir.While(ir.Unary("not", own), (ir.WaitUntil(free), self.set(task, True), again))]
        if later:
            body.append(ir.WaitUntil(self.none_of(later)))
        return (replace(body[0], origin=origin), *body[1:])

    def none_of(self, tasks: list[str]) -> ir.Expression:
        done: ir.Expression | None = None
        for task in tasks:
            off = ir.Unary("not", ir.Name(self.flags[task]))
            done = off if done is None else ir.Binary("and", done, off)
        assert done is not None  # asked for with at least one task
        return done


__all__ = ["critical_flags"]

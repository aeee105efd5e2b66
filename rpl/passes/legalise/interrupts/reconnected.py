"""An interrupt variable that is connected to one trap after the other becomes one variable for each trap.

Targets without such variables know one action for each number. Which trap is meant is read from the order of the
statements; where jumps or branches leave that open, the loss is said.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field, replace

from rpl import ir
from rpl.diagnostics import Severity, code
from rpl.ir.walk import walk
from rpl.passes.legalise.context import Context
from rpl.passes.legalise.rewriting.editing import edit_bodies
from rpl.passes.rewrite import rewrite_parts

SEVERAL = code(
    "interrupt-connected-anew",
    Severity.LOSS,
    "{name} is connected to several routines, and which of them is meant depends on the way taken; {routine} is called",
    "use one interrupt variable for each routine",
)


def one_trap_each(program: ir.Program, context: Context) -> ir.Program:
    """The program in which every interrupt variable is connected to one routine only."""
    routines: dict[str, list[ir.ConnectInterrupt]] = {}
    for node in walk(*program.modules):
        if isinstance(node, ir.ConnectInterrupt) and (name := _name(node.handle)):
            routines.setdefault(name, []).append(node)
    several = {name for name, found in routines.items() if len({one.routine.lower() for one in found}) > 1}
    if not several:
        return program
    open_ones = several & _elements(program)
    for routine in (one for module in program.modules for one in module.routines):
        tried = _Split(context, several)
        tried.routine(routine)
        open_ones |= tried.failed
    for name in sorted(open_ones):
        first = routines[name][0]
        context.diagnostics.report(SEVERAL, first.origin, name=name, routine=first.routine)
    split = _Split(context, several - open_ones)
    modules = (
        replace(module, routines=tuple(map(split.routine, module.routines))) if split.names else module
        for module in program.modules
    )
    return replace(program, modules=tuple(modules))


def _name(handle: ir.Expression | None) -> str:
    while isinstance(handle, ir.Index):
        handle = handle.base
    return handle.id.lower() if isinstance(handle, ir.Name) else ""


def _elements(program: ir.Program) -> set[str]:
    """Arrays of interrupts, and what is handed on as an argument."""
    found = set()
    for node in walk(*program.modules):
        match node:
            case ir.Index(base=ir.Name(id=name)):
                found.add(name.lower())
            case ir.CallRoutine(arguments=arguments):
                names = (one for argument in arguments for one in walk(argument) if isinstance(one, ir.Name))
                found |= {one.id.lower() for one in names}
    return found


@dataclass(slots=True)
class _Split:
    """`given`: names that are in use already; those in `failed` are used where no connection is known for sure."""

    context: Context
    names: set[str]
    failed: set[str] = field(default_factory=set)
    given: set[str] = field(default_factory=set)

    def routine(self, routine: ir.Routine) -> ir.Routine:
        nodes = list(walk(routine))
        used = {_name(one.handle) for one in nodes if isinstance(one, _HANDLED)} & self.names
        if used and any(isinstance(one, ir.Goto) for one in nodes):
            self.failed |= used
        return edit_bodies(routine, lambda body: self.body(body, {}, nested=body is not routine.body))

    def body(self, body: ir.Body, now: dict[str, ir.Name], nested: bool) -> ir.Body:
        done: list[ir.Statement] = []
        for statement in body:
            name = _name(statement.handle) if isinstance(statement, _HANDLED) else ""
            if name in self.names and isinstance(statement, _HANDLED):
                if isinstance(statement, ir.ConnectInterrupt):
                    if nested:
                        self.failed.add(name)
                    now[name] = self.another(name)
                if name in now:
                    statement = replace(statement, handle=now[name])
                else:
                    self.failed.add(name)
                done.append(statement)
            else:
                done.append(rewrite_parts(statement, lambda one: one, self.inner(now)))
        return tuple(done)

    def inner(self, now: dict[str, ir.Name]) -> Callable[[ir.Body], ir.Body]:
        return lambda body: self.body(body, dict(now), nested=True)

    def another(self, name: str) -> ir.Name:
        fresh = name if name not in self.given else self.context.fresh(name)
        self.given.add(name)
        return ir.Name(fresh)


_HANDLED = ir.ConnectInterrupt | ir.OrderInterrupt | ir.ControlInterrupt

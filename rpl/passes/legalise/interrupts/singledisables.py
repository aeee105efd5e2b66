"""Single interrupts that wait (KRL `INTERRUPT DISABLE 5`), for controllers that let all of them wait or none.

The routine of such an interrupt asks a flag: while it is disabled it notes that it has come, and what enables it makes
the noted call.
"""

from __future__ import annotations

from dataclasses import dataclass, field, replace

from rpl import ir
from rpl.diagnostics import Severity, code
from rpl.ir.walk import walk
from rpl.passes.capabilities import InterruptRule, Watched
from rpl.passes.legalise.context import Context
from rpl.passes.legalise.facts.usage import called_names, exposed
from rpl.passes.legalise.records.watching import key_of, number_of
from rpl.passes.legalise.rewriting.editing import edit_bodies, map_body
from rpl.passes.legalise.rewriting.jumps import inside
from rpl.passes.legalise.stages import legalising

NOTED = code(
    "disabled-interrupt-noted",
    Severity.WARNING,
    "the target disables all interrupts or none: {name} notes that it has come while it is disabled, and acts later",
)
_HOLDS = ("disable", "enable")


@legalising(
    unless=lambda context: (
        InterruptRule.SINGLE_DISABLES in context.capabilities.interrupts.rules
        or context.capabilities.interrupts.watched is Watched.ALL
        or context.capabilities.interrupts.watched is Watched.INTERRUPTS
        or not {"DeclareInterrupt", "ConnectInterrupt"} & context.capabilities.statements
    ),
    sees=("ControlInterrupt",),
)
def single_disables(program: ir.Program, context: Context) -> ir.Program:
    """Only for targets whose controller has interrupts, and none of them can be disabled alone."""
    controls = [node for node in walk(program) if isinstance(node, ir.ControlInterrupt)]
    held = {number_of(one.handle) for one in controls if one.op in _HOLDS} - {None}
    if not held:
        return program
    resuming = _resuming(program)
    modules = []
    for module in program.modules:
        declared = [node for node in walk(module) if isinstance(node, ir.DeclareInterrupt)]
        plain = {
            key: one
            for one in declared
            if (key := key_of(one)) in held and key is not None and _is_plain(one, declared, resuming)
        }
        if not plain:
            modules.append(module)
            continue
        worker = _Held(context, plain)
        routines = tuple(edit_bodies(routine, worker.body) for routine in module.routines)
        declarations = (*module.declarations, *worker.flags())
        modules.append(replace(module, routines=(*routines, *worker.made), declarations=declarations))
        called = called_names(worker.made)
        program = exposed(program, called)
    return replace(program, modules=tuple(modules))


def _is_plain(one: ir.DeclareInterrupt, declared: list[ir.DeclareInterrupt], resuming: set[str]) -> bool:
    """Is it declared once, and can its action be done by the program itself?"""
    alone = sum(key_of(other) == key_of(one) for other in declared) == 1
    name = one.action.name.lower() if isinstance(one.action, ir.CallRoutine) else ""
    return alone and not one.once and not one.stops and name not in resuming


def _resuming(program: ir.Program) -> set[str]:
    """Routines (folded) that leave what was interrupted, directly or by what they call."""
    calls: dict[str, set[str]] = {}
    found: set[str] = set()
    for module in program.modules:
        for routine in module.routines:
            name = routine.name.lower()
            for node in walk(routine):
                match node:
                    case ir.ResumeLevel():
                        found.add(name)
                    case ir.CallRoutine(name=called) | ir.Call(name=called):
                        calls.setdefault(name, set()).add(called.lower())
    size = -1
    while size != (size := len(found)):
        found |= {name for name, called in calls.items() if called & found}
    return found


@dataclass(slots=True)
class _Held:
    """The interrupts of one module that may be disabled alone."""

    context: Context
    declared: dict[int, ir.DeclareInterrupt]
    names: dict[int, tuple[str, str]] = field(default_factory=dict)  # flags: it is disabled, it has come meanwhile
    made: list[ir.Routine] = field(default_factory=list)

    def __post_init__(self) -> None:
        for key in sorted(self.declared):
            self.names[key] = (self.context.fresh(f"rpl_disabled_{key}"), self.context.fresh(f"rpl_noted_{key}"))

    def flags(self) -> list[ir.Variable]:
        false = ir.BoolLiteral(False)
        return [ir.Variable(name, ir.BoolType(), false) for pair in self.names.values() for name in pair]

    def body(self, body: ir.Body) -> ir.Body:
        return map_body(body, self.statement)

    def statement(self, statement: ir.Statement) -> ir.Body:
        match statement:
            case ir.DeclareInterrupt() if (key := key_of(statement)) in self.names and key is not None:
                later = replace(statement.origin, comments=())
                lowered = [replace(self.set(name, False), origin=later) for name in self.names[key]]
                return (replace(statement, action=self.asking(key, statement)), *lowered)
            case ir.ControlInterrupt(op=op, handle=handle) if (key := number_of(handle)) in self.names:
                assert key is not None  # it is one of the numbers
                return self.control(key, op, statement)
        return (inside(statement, self.body),)

    def control(self, key: int, op: str, statement: ir.ControlInterrupt) -> ir.Body:
        disabled, noted = self.names[key]
        first, later = statement.origin, replace(statement.origin, comments=())
        if op == "disable":
            return (replace(self.set(disabled, True), origin=first),)
        if op == "enable":
            action = replace(self.declared[key].action, origin=later)
            call = ir.If(((ir.Name(noted), (self.set(noted, False), action)),), origin=later)
            return (replace(self.set(disabled, False), origin=first), call)
        if op in ("off", "delete"):
            return (statement, replace(self.set(noted, False), origin=later))
        return (statement,)

    def asking(self, key: int, statement: ir.DeclareInterrupt) -> ir.CallRoutine:
        """The call of a routine that acts, or notes that it should have."""
        disabled, noted = self.names[key]
        action = statement.action
        called = action.name if isinstance(action, ir.CallRoutine) else f"interrupt {key}"
        self.context.diagnostics.report(NOTED, statement.origin, name=called)
        name = self.context.fresh(f"rpl_interrupt_{key}")
        later = replace(statement.origin, comments=())
        choice = ir.If(((ir.Name(disabled), (self.set(noted, True),)),), (replace(action, origin=later),), origin=later)
        self.made.append(ir.Routine(name, body=(choice,), scope="global"))
        return ir.CallRoutine(name, origin=later)

    def set(self, name: str, value: bool) -> ir.Assign:
        return ir.Assign(ir.Name(name), ir.BoolLiteral(value))


__all__ = ["single_disables"]

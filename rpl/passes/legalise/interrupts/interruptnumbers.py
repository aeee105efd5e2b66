"""Routines that ask which interrupt has called them (RAPID INTNO), for targets that do not tell: each interrupt gets a
copy of the routine that knows the answer. What compares the number otherwise than with interrupts stays as it is.
"""

from __future__ import annotations

from dataclasses import replace

from rpl import ir
from rpl.ir.walk import rewrite, walk
from rpl.passes.legalise.context import Context
from rpl.passes.legalise.facts.usage import base_name

_NUMBER = "interrupt_number"


def known_interrupts(program: ir.Program, context: Context) -> ir.Program:
    """The program whose traps know the interrupt that they are called by."""
    if _NUMBER in context.capabilities.system_variables:
        return program
    asking = {
        routine.name.lower()
        for module in program.modules
        for routine in module.routines
        if routine.kind == "trap" and any(_asks(node) for node in walk(routine))
    }
    handles: dict[str, set[str]] = {}
    for node in walk(*program.modules):
        if isinstance(node, ir.ConnectInterrupt) and node.routine.lower() in asking:
            handles.setdefault(node.routine.lower(), set()).add(base_name(node.handle) or "")
    copied = {name for name, found in handles.items() if all(found)}
    if not copied:
        return program
    names = {
        (trap, handle): context.fresh(f"{trap}_{handle}") for trap in sorted(copied) for handle in sorted(handles[trap])
    }

    def connected(node: object) -> object:
        match node:
            case ir.ConnectInterrupt(handle=handle, routine=routine):
                found = names.get((routine.lower(), base_name(handle) or ""))
                return node if found is None else replace(node, routine=found)
        return node

    modules = []
    for module in program.modules:
        routines: list[ir.Routine] = []
        for routine in module.routines:
            key = routine.name.lower()
            if key not in copied:
                routines.append(rewrite(routine, connected))
                continue
            routines += [
                replace(_told(rewrite(routine, connected), handle), name=names[key, handle])
                for handle in sorted(handles[key])
            ]
        modules.append(replace(module, routines=tuple(routines)))
    return replace(program, modules=tuple(modules))


def _asks(node: object) -> bool:
    return isinstance(node, ir.System) and node.name == _NUMBER


def _told(routine: ir.Routine, handle: str) -> ir.Routine:
    """The routine as the interrupt of this name runs it."""

    def answer(other: ir.Expression) -> bool | None:
        return base_name(other) == handle if isinstance(other, ir.Name) else None

    def told(node: object) -> object:
        match node:
            case (
                ir.Binary(op="=" | "<>" as op, left=left, right=other)
                | ir.Binary(op="=" | "<>" as op, left=other, right=left)
            ) if _asks(left):
                known = answer(other)
                return node if known is None else ir.BoolLiteral(known == (op == "="))
            case ir.If():
                return _decided(node)
            case ir.Switch(selector=selector, cases=cases, default=default) if _asks(selector):
                known_cases = [[answer(value) for value in case.values] for case in cases]
                if any(None in known for known in known_cases):
                    return node
                chosen = [case.body for case, known in zip(cases, known_cases, strict=True) if True in known]
                return _alone(node, chosen[0] if chosen else default or ())
        return node

    return rewrite(routine, told)


def _decided(statement: ir.If) -> ir.If | ir.Body:
    """Without the branches that are never taken, and nothing behind one that always is."""
    branches = [one for one in statement.branches if one[0] != ir.BoolLiteral(False)]
    for place, (condition, body) in enumerate(branches):
        if condition == ir.BoolLiteral(True):
            kept = tuple(branches[:place])
            return replace(statement, branches=kept, otherwise=body) if kept else _alone(statement, body)
    return replace(statement, branches=tuple(branches)) if branches else _alone(statement, statement.otherwise)


def _alone(statement: ir.If | ir.Switch, body: ir.Body) -> ir.Body:
    """The body in place of the statement that chose it; comments before that stay."""
    return (ir.Nothing(origin=statement.origin), *body) if statement.origin.comments else body

"""Programs that only wait and then switch one signal, nothing calculated: executed as a task of their own they are an
output that follows later."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace

from rpl import ir
from rpl.ir.walk import rewrite, walk

from .expressions import significant


def outputs_later(modules: tuple[ir.Module, ...]) -> tuple[ir.Module, ...]:
    """EXECUTE of such a program as one neutral step, where the program serves nothing else; it is left out then."""
    found = {}
    for module in modules:
        for routine in module.routines:
            steps = [one for one in routine.body if not isinstance(one, ir.Nothing)]
            match steps:
                case [
                    ir.Wait(in_position=False) as wait,
                    ir.Assign(target=ir.Signal(kind="digital_out"), value=ir.BoolLiteral()) as assign,
                ]:
                    if not routine.parameters and not _calculated(wait, assign):
                        found[significant(routine.name)] = (wait, assign)
    if not found:
        return modules
    for name in _used_otherwise(modules):
        found.pop(name, None)
    started = {significant(one.task) for one in walk(modules) if isinstance(one, ir.TaskControl)}
    found = {name: steps for name, steps in found.items() if name in started}
    if not found:
        return modules

    def change(node: object) -> object:
        if isinstance(node, ir.TaskControl) and significant(node.task) in found:
            wait, assign = found[significant(node.task)]
            return ir.SetAfter(assign.target, assign.value, wait.time, origin=node.origin)
        return node

    return tuple(
        replace(
            module,
            routines=tuple(
                rewrite(routine, change) for routine in module.routines if significant(routine.name) not in found
            ),
        )
        for module in modules
    )


def _calculated(*steps: ir.Statement) -> bool:
    return any(isinstance(node, ir.Name | ir.Builtin | ir.Signal) for node in walk(steps[:1])) or any(
        isinstance(node, ir.Name | ir.Builtin) for node in walk(steps[1:])
    )


def _used_otherwise(modules: tuple[ir.Module, ...]) -> Iterable[str]:
    """Programs that are called, controlled otherwise than started, asked for their state, or part of a reaction."""
    for node in walk(modules):
        match node:
            case ir.CallRoutine(name=name):
                yield significant(name)
            case ir.TaskControl(op=op, task=name, arguments=arguments) if op != "start" or arguments:
                yield significant(name)
            case ir.Builtin(function="task_runs", arguments=(ir.TextLiteral(value=name),)):
                yield significant(name)
            case ir.OnError(routine=str() as name):
                yield significant(name)


__all__ = ["outputs_later"]

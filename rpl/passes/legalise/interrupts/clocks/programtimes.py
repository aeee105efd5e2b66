"""The time since the program began, for targets that cannot ask for it: a timer of their own that the program starts
first. It is the lowest one that the program does not use.
"""

from __future__ import annotations

from dataclasses import replace

from rpl import ir
from rpl.ir.walk import rewrite
from rpl.passes.legalise.context import Context
from rpl.passes.legalise.kinds import walk_for
from rpl.passes.legalise.rewriting.startdata import assigned_at_start
from rpl.passes.legalise.stages import legalising

_TIME = ir.System("time")
_TIMERS = ("timer", "timer_stopped", "timer_positive")


@legalising(
    unless=lambda context: (
        ("time" in context.capabilities.system_variables or context.capabilities.carries_rules)
        or not (context.capabilities.io.timers or "Clock" in context.capabilities.statements)
    ),
    sees=("system time",),
)
def program_times(program: ir.Program, context: Context) -> ir.Program:
    """Only for programs that ask for the time; a timer of a computed number could be any, so such programs stay."""
    can = context.capabilities
    nodes = list(walk_for({"System"}, *program.modules))
    if _TIME not in nodes:
        return program
    used: set[int] = set()
    for node in nodes:
        match node:
            case ir.System(name=name, indices=(ir.IntLiteral(value=number),)) if name in _TIMERS:
                used.add(number)
            case ir.System(name=name) if name in _TIMERS:
                return program
    number = next(each for each in range(1, len(used) + 2) if each not in used)
    if can.io.timers and number > can.io.timers:
        return program
    index = (ir.IntLiteral(number),)
    timer = ir.System("timer", index)
    modules = tuple(rewrite(module, lambda node: timer if node == _TIME else node) for module in program.modules)
    first = (
        ir.Assign(timer, ir.RealLiteral(0.0)),
        ir.Assign(ir.System("timer_stopped", index), ir.BoolLiteral(False)),
    )
    return assigned_at_start(replace(program, modules=modules), context, first)


__all__ = ["program_times"]

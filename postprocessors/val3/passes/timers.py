"""Timers: VAL3 has one clock that nobody sets, so a timer is the time at which it showed zero.

`timer1=clock()-5` sets one to five seconds, `clock()-timer1` reads it. The passes of the core have seen to timers and
stop watches that stand still before; a timer of a computed number stays for the writer, who refuses it.
"""

from __future__ import annotations

from dataclasses import replace

from rpl import ir
from rpl.ir.walk import rewrite
from rpl.passes.legalise.context import Context
from rpl.passes.legalise.kinds import walk_for
from rpl.passes.legalise.stages import legalising

_CLOCK = ir.System("time")


@legalising(sees=("system timer", "system timer_stopped"))
def timers_by_the_clock(program: ir.Program, context: Context) -> ir.Program:
    """Numbered timers, by the clock of the controller."""
    numbers = {number for node in walk_for({"system timer"}, *program.modules) if (number := _number(node)) is not None}
    names = {number: context.fresh(f"timer{number}") for number in sorted(numbers)}

    def change(node: object) -> object:
        """From below: a timer that is set has become the difference that reads it."""
        match node:
            case ir.Assign(ir.System("timer_stopped", (ir.IntLiteral(),)), ir.BoolLiteral(value=False), origin=origin):
                return ir.Nothing(origin=origin)  # the clock runs anyway
            case ir.System() if (number := _number(node)) is not None:
                return ir.Binary("-", _CLOCK, ir.Name(names[number]), origin=node.origin)
            case ir.Assign(target=ir.Binary(right=ir.Name() as begun), value=value):
                plain = value.value if isinstance(value, ir.Quantity) else value
                zero = isinstance(plain, ir.IntLiteral | ir.RealLiteral) and plain.value == 0
                return replace(node, target=begun, value=_CLOCK if zero else ir.Binary("-", _CLOCK, value))
        return node

    done = rewrite(program, change)
    if not names:
        return done
    made = tuple(ir.Variable(name, ir.RealType(), ir.RealLiteral(0.0), scope="global") for name in names.values())
    first, *others = done.modules
    return replace(done, modules=(replace(first, declarations=(*first.declarations, *made)), *others))


def _number(node: object) -> int | None:
    """The number of a timer that is written as one."""
    match node:
        case ir.System(name="timer", indices=(ir.IntLiteral(value=number),)):
            return number
    return None

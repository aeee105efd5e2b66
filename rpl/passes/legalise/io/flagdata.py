"""Flags by a computed number as an array of truth values, for targets without flags; flags beyond the last number that
a target has as variables.

Flags that a program only names by constants are single variables there, which the writer chooses; one number that is
computed needs them side by side, so that then all flags of the program are elements of one array.
"""

from __future__ import annotations

from dataclasses import replace

from rpl import ir
from rpl.diagnostics import Severity, code
from rpl.ir.walk import rewrite
from rpl.passes.legalise.context import Context
from rpl.passes.legalise.kinds import walk_for
from rpl.passes.legalise.stages import legalising

COMPUTED = code(
    "computed-flag",
    Severity.WARNING,
    "the number of a flag is computed; flags 1 to {last} have a variable, another number reaches other data",
)
# Numbers that a computed one is expected to reach where the program names no larger one.
_REACH = 32


@legalising(sees=("signal flag", "system flag"))
def flags_as_data(program: ir.Program, context: Context) -> ir.Program:
    """Only for targets without flags, or with fewer than are named, and for programs that compute the number of one."""
    can = context.capabilities
    numbers = [
        number
        for node in walk_for({"signal flag", "system flag"}, *program.modules)
        if (number := _number(node)) is not None
    ]
    largest = max((number.value for number in numbers if isinstance(number, ir.IntLiteral)), default=0)
    if can.io.last_flag is None or (can.io.last_flag and can.io.last_flag >= largest):
        return program
    computed = next((number for number in numbers if not isinstance(number, ir.IntLiteral)), None)
    if computed is None:
        return _beyond(program, can.io.last_flag, context) if can.io.last_flag else program
    last = max(_REACH, *(number.value for number in numbers if isinstance(number, ir.IntLiteral)), 1)
    name = context.fresh("flag")
    context.diagnostics.report(COMPUTED, computed.origin, last=last)

    def placed(node: object) -> object:
        number = _number(node)
        if number is None or not isinstance(node, ir.Signal | ir.System):
            return node
        return ir.Index(ir.Name(name, origin=node.origin), (number,), origin=node.origin)

    type = ir.ArrayType(ir.BoolType(), (ir.IntLiteral(last),))
    data = ir.Variable(name, type, storage="persistent", scope="global")
    first = program.modules[0]
    home = ir.Module(context.fresh("flags"), first.dialect, (data,), task=first.task, public=True)
    modules = tuple(
        replace(module, routines=tuple(rewrite(routine, placed) for routine in module.routines))
        for module in program.modules
    )
    return replace(program, modules=(*modules, home))


def _beyond(program: ir.Program, last: int, context: Context) -> ir.Program:
    """The program with single variables for the flags whose numbers the target does not have."""
    names: dict[int, str] = {}

    def placed(node: object) -> object:
        number = _number(node)
        if not isinstance(number, ir.IntLiteral) or number.value <= last:
            return node
        assert isinstance(node, ir.Signal | ir.System)  # only these have a number
        if number.value not in names:
            names[number.value] = context.fresh(f"flag{number.value}")
        return ir.Name(names[number.value], origin=node.origin)

    modules = tuple(
        replace(module, routines=tuple(rewrite(routine, placed) for routine in module.routines))
        for module in program.modules
    )
    data = tuple(ir.Variable(name, ir.BoolType(), storage="persistent", scope="global") for name in names.values())
    first = program.modules[0]
    home = ir.Module(context.fresh("flags"), first.dialect, data, task=first.task, public=True)
    return replace(program, modules=(*modules, home))


def _number(node: object) -> ir.Expression | None:
    """The number of the flag that this names."""
    match node:
        case ir.Signal(kind="flag", index=index, last=None, name=None):
            return index
        case ir.System(name="flag", indices=(index,)):
            return index
    return None


__all__ = ["flags_as_data"]

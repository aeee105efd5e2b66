"""Arguments of functions of numbers: TP takes a register or an argument there, as `R[1]=SIN[R[2]]`. Of a constant the
value is written; a component of a place, a signal or a timer goes into a variable of its own first."""

from __future__ import annotations

from rpl import ir
from rpl.passes.fold import lasting_number
from rpl.passes.legalise.context import Context
from rpl.passes.legalise.rewriting.bodies import Hoister, Lowered
from rpl.passes.legalise.rewriting.editing import Editor, edit_bodies, edit_routines
from rpl.passes.legalise.stages import legalising
from rpl.passes.values import real

from .. import tables

_REGISTERS = (ir.Name, ir.Index)
# Operations, which become statements of their own with all that they need.
_STEPS = (ir.Binary, ir.Unary, ir.Call, ir.Convert)


_ACTS_ON = frozenset(("Builtin", "Convert"))


@legalising(sees=_ACTS_ON)
def arguments_in_registers(program: ir.Program, context: Context) -> ir.Program:
    """Functions of what is no register: the value of a constant, a variable for the rest."""

    def work(editor: Editor, routine: ir.Routine) -> ir.Routine:
        return edit_bodies(routine, Hoister(editor, lambda one: _fitted(one, editor), _ACTS_ON).body)

    return edit_routines(program, context, work, _ACTS_ON)


def _fitted(expression: ir.Expression, editor: Editor) -> Lowered | None:
    """The function in another form; None: it stays."""
    match expression:
        case ir.Builtin(function=function, arguments=arguments) if function in tables.FUNCTIONS:
            pass
        case ir.Convert(how="trunc" | "round_half_away", operand=operand):
            arguments = (operand,)
        case _:
            return None
    value = lasting_number(expression, editor.scope)
    if value is not None and all(lasting_number(one, editor.scope) is not None for one in arguments):
        return (), real(value)
    before: list[ir.Statement] = []
    done = [_register(one, editor, before) for one in arguments]
    if not before:
        return None
    if isinstance(expression, ir.Builtin):
        return tuple(before), ir.Builtin(expression.function, tuple(done), origin=expression.origin)
    return tuple(before), ir.Convert(expression.how, done[0], origin=expression.origin)


def _register(argument: ir.Expression, editor: Editor, before: list[ir.Statement]) -> ir.Expression:
    """The argument as a register; statements that fill it are added."""
    inner = argument
    while isinstance(inner, ir.Convert) and inner.how == "real":
        inner = inner.operand
    known = lasting_number(inner, editor.scope)
    if known is None and (
        isinstance(inner, _REGISTERS + _STEPS) or (isinstance(inner, ir.Builtin) and inner.function != "clock_seconds")
    ):
        return argument
    kept = editor.temporary("argument", ir.RealType())
    before.append(ir.Assign(kept, argument if known is None else real(known)))
    return kept


__all__ = ["arguments_in_registers"]

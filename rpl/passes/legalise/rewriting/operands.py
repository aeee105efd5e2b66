"""What counts as a simple operand, and what may change while a program stands at one place."""

from __future__ import annotations

from dataclasses import replace

from rpl import ir
from rpl.ir.walk import bodies
from rpl.passes.conditions import negation
from rpl.passes.legalise.facts.effects import is_constant
from rpl.passes.legalise.facts.usage import each_statement, usage_of

_LITERALS = (ir.IntLiteral, ir.RealLiteral, ir.BoolLiteral, ir.TextLiteral, ir.EnumLiteral)


def is_operand(value: ir.Expression) -> bool:
    """A constant, a variable, an element whose number is one, a component, a signal: what every controller can read."""
    match value:
        case ir.Name() | ir.Present():
            return True
        case ir.Unary(op="-" | "+") | ir.Quantity() if is_constant(value):
            return True
        case ir.Quantity(value=inner) | ir.Magnitude(value=inner):
            return is_operand(inner) and not isinstance(value, ir.Magnitude)
        case ir.Index(base=base, indices=indices):
            return is_operand(base) and all(map(is_number, indices))
        case ir.Field(base=base):
            return is_operand(base) and not isinstance(base, ir.Aggregate)
        case ir.System(indices=indices):
            return all(map(is_number, indices))
        case ir.Signal(index=index, last=last):
            return all(one is None or is_number(one) for one in (index, last))
        case ir.Aggregate(entries=entries):
            return all(is_constant(one) or (isinstance(one, ir.Aggregate) and is_operand(one)) for _, one in entries)
        case ir.Convert(how="real", operand=operand):
            return is_operand(operand)
    return isinstance(value, _LITERALS)


def is_number(value: ir.Expression) -> bool:
    """What may stand as a number of an element: a constant or a variable that has no computed number itself."""
    match value:
        case ir.IntLiteral() | ir.Name():
            return True
        case ir.Index(base=ir.Name(), indices=indices):
            return all(isinstance(one, ir.IntLiteral) for one in indices)
    return False


def opposite(condition: ir.Expression) -> ir.Expression:
    """The opposite of comparisons joined by and/or, as comparisons joined by or/and."""
    other = {"and": "or", "or": "and", "cand": "cor", "cor": "cand"}
    match condition:
        case ir.Binary(op=op, left=left, right=right) if op in other:
            return replace(condition, op=other[op], left=opposite(left), right=opposite(right))
        case ir.Binary(op="=", right=ir.BoolLiteral(value=value) as right):
            return replace(condition, right=replace(right, value=not value))
    return negation(condition)


def changing(program: ir.Program) -> frozenset[str] | None:
    """Names that something else than the statement at hand may change: an interrupt, a trigger, another task. None: any
    (there are several tasks)."""
    if len(program.tasks) > 1:
        return None
    found = False

    def look(statement: ir.Statement) -> None:
        nonlocal found
        if isinstance(
            statement, ir.DeclareInterrupt | ir.ConnectInterrupt | ir.Trigger | ir.DefineTrigger | ir.TaskControl
        ):
            found = True
        if isinstance(statement, ir.Move) and statement.triggers:
            found = True

    for module in program.modules:
        for routine in module.routines:
            for body in bodies(routine):
                each_statement(body, look)
    return frozenset(usage_of(program).assigned) if found else frozenset()

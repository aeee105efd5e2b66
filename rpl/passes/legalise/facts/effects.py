"""What evaluating an expression can do besides giving a value: change something, or fail.

The passes move evaluations about (in front of a statement, to both sides of an `and`). What may be moved rests on these
facts. They are conservative: what is not known to be harmless counts as harmful.
"""

from __future__ import annotations

from collections.abc import Iterator, Set
from functools import cached_property

from rpl import ir
from rpl.ir.walk import bodies
from rpl.passes.legalise.kinds import holds_none
from rpl.passes.rewrite import visit_parts

# Built-in functions that fail for some arguments (a root of a negative number, a text that is no number, ...).
_FAILING = frozenset(
    (
        *("sqrt", "log", "asin", "acos", "power", "text_part", "text_value", "text_find", "text_find_any"),
        *(
            "text_find_none",
            "based_number",
            "digits_in_base",
            "digits_less",
            "digits_equal",
            "digits_sum",
            "digits_difference",
        ),
        *("digits_difference", "digits_product", "digits_quotient", "digits_remainder"),
        *("text_match", "text_member", "from_code", "target_to_joints", "joints_to_target", "frame_from_points"),
        *("normalise", "message_text", "format"),
    )
)
# Statements a function may contain without any effect outside of it.
_HARMLESS = (ir.If, ir.Switch, ir.For, ir.While, ir.Repeat, ir.Loop, ir.ExitLoop, ir.NextPass, ir.Label, ir.Goto,
             ir.Return, ir.Nothing)  # fmt: skip
_LITERALS = (ir.IntLiteral, ir.RealLiteral, ir.BoolLiteral, ir.TextLiteral, ir.EnumLiteral)


def children(node: ir.Expression | ir.Statement) -> list[ir.Expression]:
    """The direct expressions of a node in the order of its fields; bodies are not entered."""
    found: list[ir.Expression] = []
    visit_parts(node, found.append)
    return found


def everything(expression: ir.Expression) -> Iterator[ir.Expression]:
    """The expression and all below it."""
    work = [expression]
    while work:
        one = work.pop()
        yield one
        work += reversed(children(one))


def expressions_in(statement: ir.Statement, kinds: Set[str]) -> Iterator[ir.Expression]:
    """The expressions of a statement and all below them, its bodies left aside; nothing of one that holds none of these
    kinds."""
    if not holds_none(statement, kinds):
        for child in children(statement):
            yield from everything(child)


def blocks(statement: ir.Statement) -> list[ir.Body]:
    """The bodies directly inside a statement (conditions of branches and cases not included)."""
    match statement:
        case ir.If(branches=branches, otherwise=otherwise):
            return [*(body for _, body in branches), otherwise]
        case ir.Switch(cases=cases, default=default):
            return [*(case.body for case in cases), default or ()]
        case ir.For(body=body) | ir.While(body=body) | ir.Repeat(body=body) | ir.Loop(body=body):
            return [body]
    return []


def statements_in(body: ir.Body) -> Iterator[ir.Statement]:
    """Every statement of a body, outer before inner."""
    ahead = [iter(body)]
    while ahead:
        for statement in ahead[-1]:
            yield statement
            inner = blocks(statement)
            if inner:
                ahead += [iter(part) for part in reversed(inner) if part]
                break
        else:
            ahead.pop()


def is_constant(expression: ir.Expression) -> bool:
    """A literal, possibly signed or with a unit."""
    match expression:
        case ir.Unary(op="-" | "+", operand=operand) | ir.Quantity(value=operand):
            return is_constant(operand)
    return isinstance(expression, _LITERALS)


def may_be_zero(divisor: ir.Expression) -> bool:
    """Anything but a number other than zero."""
    match divisor:
        case ir.Unary(op="-" | "+", operand=operand) | ir.Quantity(value=operand):
            return may_be_zero(operand)
        case ir.IntLiteral(value=value) | ir.RealLiteral(value=value):
            return value == 0
    return True


def root(lvalue: ir.Expression) -> ir.Expression:
    """The variable (or system variable, signal) that an lvalue is a part of."""
    while isinstance(lvalue, ir.Index | ir.Field):
        lvalue = lvalue.base
    return lvalue


class Effects:
    """Facts about the routines of a program, by folded name."""

    def __init__(self, program: ir.Program) -> None:
        self._program = program

    @cached_property
    def _quiet(self) -> set[str]:
        routines: dict[str, list[ir.Routine]] = {}
        for module in self._program.modules:
            for routine in module.routines:
                routines.setdefault(routine.name.lower(), []).append(routine)
        quiet = {name for name, found in routines.items() if all(map(_could_be_quiet, found))}
        size = -1
        while size != len(quiet):  # greatest fixed point: recursion does not make a function harmful
            size = len(quiet)
            quiet = {name for name in quiet if all(_calls_quiet(one, quiet) for one in routines[name])}
        return quiet

    def quiet(self, expression: ir.Expression) -> bool:
        """Does evaluating it change nothing?"""
        return all(
            not (isinstance(one, ir.Call) and one.name.lower() not in self._quiet)
            and not (isinstance(one, ir.Builtin) and one.function in ir.PROCEDURES)
            for one in everything(expression)
        )

    def safe(self, expression: ir.Expression) -> bool:
        """Does evaluating it change nothing, call nothing and never fail?"""
        for one in everything(expression):
            match one:
                case ir.Call():
                    return False
                case ir.Builtin(function=function):
                    if function in _FAILING or function in ir.PROCEDURES:
                        return False
                case ir.Index(indices=indices):
                    if not all(map(is_constant, indices)):
                        return False
                case ir.Binary(op="/" | "div" | "mod" | "quo" | "**", right=right):
                    if not is_constant(right) or _zero(right):
                        return False
        return True

    def quiet_body(self, body: ir.Body, own: set[str]) -> bool:
        """Do the statements change nothing but the variables `own` (folded)?"""
        for statement in body:
            match statement:
                case ir.Assign(target=ir.Name(id=name)) if name.lower() in own:
                    pass
                case ir.Do(arguments=(ir.Name(id=name), *_)) if name.lower() in own:
                    pass
                case ir.CallRoutine(name=name, dynamic=None) if name.lower() in self._quiet:
                    pass
                case ir.If() | ir.Nothing():
                    pass
                case _:
                    return False
            if not all(map(self.quiet, children(statement))):
                return False
            if not all(self.quiet_body(inner, own) for inner in blocks(statement)):
                return False
        return True


def _calls_quiet(routine: ir.Routine, quiet: set[str]) -> bool:
    return all(
        not isinstance(one, ir.Call) or one.name.lower() in quiet
        for body in bodies(routine)
        for statement in statements_in(body)
        for child in children(statement)
        for one in everything(child)
    )


def _zero(expression: ir.Expression) -> bool:
    return any(isinstance(one, ir.IntLiteral | ir.RealLiteral) and one.value == 0 for one in everything(expression))


def _could_be_quiet(routine: ir.Routine) -> bool:
    """Assigns nothing but its own variables and value parameters, and does nothing else that shows."""
    if routine.kind != "function" or routine.handlers:
        return False
    local = {parameter.name.lower() for parameter in routine.parameters if parameter.mode == "value"}
    for declaration in routine.declarations:
        if isinstance(declaration, ir.Variable):
            if declaration.storage == "persistent":
                return False
            local.add(declaration.name.lower())
    aliases = {parameter.name.lower() for parameter in routine.parameters if parameter.mode != "value"}
    local -= aliases
    for statement in statements_in(routine.body):
        match statement:
            case ir.Assign(target=target) | ir.Do(arguments=(target, *_)):
                base = root(target) if target is not None else None
                if not (isinstance(base, ir.Name) and base.id.lower() in local):
                    return False
            case ir.For(counter=counter, scoped=scoped):
                if not scoped and counter.lower() not in local:
                    return False
            case _:
                if not isinstance(statement, _HARMLESS):
                    return False
    return True


def repeatable(value: ir.Expression) -> bool:
    """May it be written twice: is it a number, a variable, or a part of one, reached without a call?"""
    match value:
        case ir.RealLiteral() | ir.IntLiteral() | ir.Name():
            return True
        case ir.Field(base=base) | ir.Unary(operand=base):
            return repeatable(base)
        case ir.Index(base=base, indices=indices):
            return repeatable(base) and all(map(repeatable, indices))
    return False

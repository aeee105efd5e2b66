"""Calls of user functions inside expressions become instructions in front of the statement, their results places in the
frame: so a function's body may wait, be interrupted or raise like any other routine.

What stands to the left of a call is evaluated before it; the right side of a short-circuit operator only when needed.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from rpl import ir
from rpl.ir.walk import children
from rpl.linking.assembler import Label
from rpl.linking.expressions import HIDDEN, hidden
from rpl.passes.rewrite import rewrite_parts
from rpl.runtime.code import Instruction, Values

if TYPE_CHECKING:
    from rpl.linking.assembler import Make
    from rpl.linking.routine import RoutineLinker

_LITERALS = (ir.IntLiteral, ir.RealLiteral, ir.BoolLiteral, ir.TextLiteral, ir.EnumLiteral)


def has_call(node: object) -> bool:
    """Does a user function's call stand anywhere in it (statements inside, such as a trigger's, not counted)?"""
    stack = [node]
    while stack:
        each = stack.pop()
        if isinstance(each, ir.Call):
            return True
        stack.extend(child for child in children(each) if not isinstance(child, ir.Assign | ir.CallRoutine))
    return False


class Flattener:
    """Moves calls out of the expressions of one statement at a time."""

    def __init__(self, linker: RoutineLinker) -> None:
        self.linker = linker

    def statement(self, statement: ir.Statement) -> ir.Statement:
        """A statement whose own expressions hold no calls any more; bodies inside stay as they are."""
        if not has_call(statement):
            return statement
        if isinstance(statement, ir.Assign):
            target = statement.target
            if not isinstance(target, ir.Name):
                target = self.parts(target, has_call(statement.value))
            return ir.Assign(target, self.expression(statement.value), origin=statement.origin)
        waiting = sum(has_call(child) for child in _direct(statement))

        def change(expression: ir.Expression) -> ir.Expression:
            nonlocal waiting
            if has_call(expression):
                waiting -= 1
                return self.expression(expression)
            return self.kept(expression) if waiting and not _is_stable(expression) else expression

        return rewrite_parts(statement, change)

    def expression(self, expression: ir.Expression) -> ir.Expression:
        """The expression without calls; instructions that give its missing parts have been emitted."""
        if not has_call(expression):
            return expression
        match expression:
            case ir.Call():
                return self.call(expression)
            case ir.Binary(op="cand" | "cor") if has_call(expression.right):
                return self.short_circuit(expression)
        return self.parts(expression, False)

    def parts(self, expression: ir.Expression, more: bool) -> ir.Expression:
        """The parts in their order; `more`: another call follows behind this expression."""
        waiting = sum(has_call(child) for child in _direct(expression))

        def change(part: ir.Expression) -> ir.Expression:
            nonlocal waiting
            if has_call(part):
                waiting -= 1
                return self.expression(part)
            fixed = _is_stable(part) or isinstance(expression, ir.Field) or _is_base(expression, part)
            return self.kept(part) if (waiting or more) and not fixed else part

        return rewrite_parts(expression, change)

    def kept(self, expression: ir.Expression) -> ir.Name:
        """Evaluate now, keep for later."""
        place = self.linker.compiler.new_place()
        read = self.linker.compiler.copy_of(expression)
        self.linker.assembler.emit(_store(place, read))
        return hidden(place)

    def call(self, call: ir.Call) -> ir.Name:
        """The call as an instruction; its result's place."""
        place = self.linker.compiler.new_place()
        self.linker.calls.emit(call.name, call.arguments, call.origin, place)
        return hidden(place)

    def short_circuit(self, expression: ir.Binary) -> ir.Name:
        linker = self.linker
        place = linker.compiler.new_place()
        left = linker.compiler.value(self.expression(expression.left))
        done, decided = Label(), expression.op == "cor"
        linker.assembler.emit(_store_and_skip(place, left, decided, done))
        right = linker.compiler.value(self.expression(expression.right))
        linker.assembler.emit(_store(place, right))
        linker.assembler.place(done)
        return hidden(place)


def _direct(node: object) -> list[ir.Expression]:
    """The expressions directly in a node, through parts such as arguments and speeds."""
    found: list[ir.Expression] = []

    def look(expression: ir.Expression) -> ir.Expression:
        found.append(expression)
        return expression

    rewrite_parts(node, look)
    return found


def _is_stable(expression: ir.Expression) -> bool:
    return isinstance(expression, _LITERALS) or (isinstance(expression, ir.Name) and expression.id.startswith(HIDDEN))


def _is_base(expression: ir.Expression, part: ir.Expression) -> bool:
    """The array of an element that is written or read: it is not copied aside."""
    return isinstance(expression, ir.Index) and part is expression.base


def _store(place: int, read: object) -> Make:
    assert callable(read)

    def make(here: int, next: int) -> Instruction:
        def store(f: Values) -> int:
            f[place] = read(f)
            return next

        return store

    return make


def _store_and_skip(place: int, read: object, decided: bool, done: Label) -> Make:
    assert callable(read)

    def make(here: int, next: int) -> Instruction:
        end = done.pc

        def store(f: Values) -> int:
            value = f[place] = bool(read(f))
            return end if value == decided else next

        return store

    return make

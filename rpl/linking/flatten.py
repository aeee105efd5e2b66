"""Calls of user functions inside expressions become instructions in front of the statement, their results places in the
frame: so a function's body may wait, be interrupted or raise like any other routine.

What stands to the left of a call is evaluated before it; the right side of a short-circuit operator only when needed.
A place that the statement writes stays a place; only what chooses it (the index of an element) is evaluated before.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from rpl import ir
from rpl.ir.walk import children
from rpl.linking.assembler import Label
from rpl.linking.expressions import HIDDEN, hidden
from rpl.linking.places import letters_of
from rpl.passes.rewrite import rewrite_parts
from rpl.runtime.code import Instruction, Values

if TYPE_CHECKING:
    from rpl.linking.assembler import Make
    from rpl.linking.linker import Linker

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

    def __init__(self, linker: Linker) -> None:
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
        places = _places(statement)

        def change(expression: ir.Expression) -> ir.Expression:
            nonlocal waiting
            waiting -= has_call(expression)
            if id(expression) in places:
                return self.parts(expression, waiting > 0)
            if has_call(expression):
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
        places = _places(expression)

        def change(part: ir.Expression) -> ir.Expression:
            nonlocal waiting
            waiting -= has_call(part)
            if id(part) in places:
                return self.parts(part, waiting > 0 or more)
            if has_call(part):
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


def _places(node: object) -> set[int]:
    """Identities of the expressions of a node that name a place, signal or handle instead of standing for a value."""
    found: list[ir.Expression | None] = []
    match node:
        case ir.Do(procedure=name, arguments=arguments) | ir.Builtin(function=name, arguments=arguments):
            row = ir.PROCEDURES.get(name)
            letters = letters_of(row.parameters, len(arguments)) if row is not None else []
            found += [one for one, letter in zip(arguments, letters, strict=False) if letter == "l"]
        case ir.Dialog(answer=answer, timed_out=flag):
            found += [answer, flag]
        case ir.WaitUntil(timed_out=flag):
            found.append(flag)
        case ir.Pulse(signal=place) | ir.SetAfter(signal=place) | ir.SetForNextMove(setting=place):
            found.append(place)
        case ir.OrderInterrupt(handle=place) | ir.DefineTrigger(target=place):
            found.append(place)
        case ir.Move(search=search, settings=settings):
            found += [place for place, _ in settings]
            if search is not None:
                found += [search.found, search.hit]
        case ir.Spline(settings=settings):
            found += [place for place, _ in settings]
    return {id(one) for one in found if one is not None}


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

"""Which routines let an error out, and which errors a program looks for: the facts behind passes.legalise.errors."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field

from rpl import ir
from rpl.ir.errornames import neutral_name
from rpl.passes.legalise.context import rules_of
from rpl.passes.legalise.facts.effects import blocks, children, everything, is_constant, may_be_zero, statements_in
from rpl.passes.scope import ProgramScope, Scope
from rpl.passes.typing import type_of

_WAIT, _DIALOG, _DIVISION, _BOUND = "timeout", "dialog_timeout", "division_by_zero", "out_of_range"
_ARGUMENT = "negative_argument"
_SEEN = frozenset((_WAIT, _DIALOG, _DIVISION, _BOUND, _ARGUMENT))
_UNKNOWN_ERROR = 1


@dataclass(slots=True)
class Raising:
    """Facts about a program. `caught`: errors it mentions, by neutral names, and how it writes them."""

    caught: dict[str, ir.Expression] = field(default_factory=dict)
    used: bool = False
    whole_codes: bool = True
    _out: set[str] = field(default_factory=set)
    _called: set[str] = field(default_factory=set)
    _actions: set[str] = field(default_factory=set)
    _numbers: dict[str, int] = field(default_factory=dict)
    _spelled: set[str] = field(default_factory=set)

    def key(self, name: str) -> str:
        """The neutral name of an error of the language; a name of the program's own stays apart from those."""
        folded = name.lower()
        return neutral_name(folded) if folded in self._spelled else f"own {folded}"

    def raises(self, name: str) -> bool:
        """May an error come out of a routine of that name?"""
        return name.lower() in self._out

    def statement(self, statement: ir.Statement, hoisted: bool = False) -> bool:
        """May the statement itself (not the blocks in it) raise? An If is asked for what its blocks do.

        hoisted: operations that may fail have a check in front of them already."""
        match statement:
            case ir.Raise():
                return True
            case ir.WaitUntil(timeout=timeout, timed_out=None) | ir.Dialog(timeout=timeout, timed_out=None):
                if timeout is not None:
                    return True
            case ir.CallRoutine(name=name, dynamic=dynamic):
                if self.raises(name) if dynamic is None else bool(self._out):
                    return True
            case ir.If():
                if any(self.statement(inner, hoisted) for body in blocks(statement) for inner in body):
                    return True
            case ir.DeclareInterrupt() | ir.Trigger() | ir.DefineTrigger():
                return False
        for child in children(statement):
            for one in everything(child):
                if isinstance(one, ir.Call) and self.raises(one.name):
                    return True
                if not hoisted and self._risky(one):
                    return True
        return False

    def _risky(self, expression: ir.Expression) -> bool:
        """An operation whose failure the program looks for."""
        match expression:
            case ir.Binary(op="/" | "div" | "mod", right=right):
                return _DIVISION in self.caught and may_be_zero(right)
            case ir.Index(indices=indices):
                return _BOUND in self.caught and not all(map(is_constant, indices))
            case ir.Builtin(function="sqrt"):
                return _ARGUMENT in self.caught
        return False

    def body_raises(self, routine: ir.Routine) -> bool:
        return any(map(self.statement, statements_in(routine.body)))

    def needs_handler(self, routine: ir.Routine) -> bool:
        """Can an error that we see come to the routine's handlers?"""
        return self.body_raises(routine)

    def lets_out(self, routine: ir.Routine) -> bool:
        if not self.body_raises(routine):
            return False
        if all(handler.codes for handler in routine.handlers):
            return True
        return any(self.statement(one) for handler in routine.handlers for one in statements_in(handler.body))

    def is_top(self, routine: ir.Routine) -> bool:
        """Nobody is there to hand an error to."""
        return self.interrupts(routine) or routine.name.lower() not in self._called

    def interrupts(self, routine: ir.Routine) -> bool:
        """Does it run between the statements of others?"""
        return routine.kind == "trap" or routine.name.lower() in self._actions

    def partly(self, routine: ir.Routine) -> bool:
        """Is some handler of the routine for errors that only the source's controller sees?"""
        seen = _SEEN | {name for name in self.caught if name not in self._numbers}
        for handler in routine.handlers:
            asked = set(_mentioned(handler, self))
            if not asked or asked & set(self._numbers) - seen:
                return not (asked and asked <= seen)
        return False

    def timeout_code(self, statement: ir.WaitUntil | ir.Dialog) -> ir.Expression:
        """What the timeout of a wait or a question raises."""
        name = _DIALOG if isinstance(statement, ir.Dialog) else neutral_name(statement.error or _WAIT)
        if name in self.caught:
            return self.caught[name]
        return ir.IntLiteral(self._numbers.get(name, _UNKNOWN_ERROR))


def _mentioned(handler: ir.Handler, facts: Raising) -> Iterator[str]:
    parts = list(handler.codes)
    for statement in statements_in(handler.body):
        parts.extend(children(statement))
    for part in parts:
        for one in everything(part):
            if not isinstance(one, ir.Name):
                continue
            name = one.id.lower()
            if name.startswith("err") or name in facts._spelled or part in handler.codes:
                yield facts.key(one.id)


def raising_of(program: ir.Program) -> Raising:
    """The facts about a program; `used` is False when it has no errors to speak of."""
    facts = Raising()
    for module in program.modules:
        errors = rules_of(module.dialect).errors
        facts._spelled.update(name.lower() for name in errors)
        facts._numbers.update((neutral_name(name), number) for name, number in errors.items())
    scopes = ProgramScope(program)
    routines = list(scopes.routines())
    for module, routine in routines:
        scope = scopes.routine(module, routine)
        facts.used = facts.used or bool(routine.handlers)
        for body in (routine.body, *(handler.body for handler in routine.handlers)):
            for statement in statements_in(body):
                _note(facts, statement, scope)
        for handler in routine.handlers:
            for number in handler.codes:
                _caught(facts, number)
    size = -1
    while size != len(facts._out):
        size = len(facts._out)
        for _, routine in routines:
            if not facts.is_top(routine) and facts.lets_out(routine):
                facts._out.add(routine.name.lower())
    return facts


def _note(facts: Raising, statement: ir.Statement, scope: Scope) -> None:
    match statement:
        case ir.Raise(code=number):
            facts.used = True
            if number is not None:
                _caught(facts, number, raised=True)
                facts.whole_codes = facts.whole_codes and isinstance(type_of(number, scope), ir.IntType)
        case ir.WaitUntil(timeout=timeout, timed_out=None) | ir.Dialog(timeout=timeout, timed_out=None):
            facts.used = facts.used or timeout is not None
        case ir.CallRoutine(name=name):
            facts._called.add(name.lower())
        case ir.DeclareInterrupt(action=ir.CallRoutine(name=name)) | ir.Trigger(action=ir.CallRoutine(name=name)):
            facts._actions.add(name.lower())
    for child in children(statement):
        for one in everything(child):
            if isinstance(one, ir.Call):
                facts._called.add(one.name.lower())
            elif isinstance(one, ir.Name):
                _caught(facts, one)


def _caught(facts: Raising, number: ir.Expression, raised: bool = False) -> None:
    if isinstance(number, ir.Name) and (number.id.lower() in facts._spelled or raised):
        facts.caught.setdefault(facts.key(number.id), ir.Name(number.id))

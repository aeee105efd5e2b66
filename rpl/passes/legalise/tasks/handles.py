"""Threads that a program names by a number in a variable (URScript `h = run t()`), when one variable serves for
several of them: where the last number is known, the statement names its thread alone.
"""

from __future__ import annotations

from dataclasses import dataclass

from rpl import ir
from rpl.ir.walk import bodies, walk
from rpl.passes.legalise.context import Context
from rpl.passes.legalise.facts.effects import statements_in
from rpl.passes.legalise.facts.usage import assigned_in
from rpl.passes.legalise.rewriting.beside import local_names
from rpl.passes.legalise.rewriting.editing import edit_all, expansion
from rpl.passes.legalise.rewriting.jumps import LOOPS
from rpl.passes.legalise.stages import legalising
from rpl.passes.rewrite import rewrite_parts


@legalising()
def known_handles(program: ir.Program, context: Context) -> ir.Program:
    """For every target: a choice between threads by a number that is known becomes the one thread."""
    chosen = {name for one in walk(*program.modules) if (name := _choice(one)) is not None}
    if not chosen:
        return program
    setters: dict[str, int] = {}
    for module in program.modules:
        for routine in module.routines:
            shared = chosen - local_names(routine) if not _chooses(routine) else chosen
            for name in {one for body in bodies(routine) for one in assigned_in(body)} & shared:
                setters[name] = setters.get(name, 0) + 1
    worker = _Handles(frozenset(name for name in chosen if setters.get(name) == 1))
    return edit_all(program, worker.outer)


def _chooses(routine: ir.Routine) -> bool:
    return any(_choice(one) is not None for one in walk(*bodies(routine)))


def _choice(one: object) -> str | None:
    """The variable (folded) of a switch that only chooses between threads."""
    match one:
        case ir.Switch(selector=ir.Name(id=name), cases=cases, default=None):
            if all(isinstance(inner, ir.TaskControl) for case in cases for inner in case.body):
                return name.lower()
    return None


@dataclass(frozen=True, slots=True)
class _Handles:
    """`names`: variables that one routine sets alone."""

    names: frozenset[str]

    def outer(self, body: ir.Body) -> ir.Body:
        jumping = any(isinstance(one, ir.Label) for one in statements_in(body))
        return body if jumping else self.body(body, {})

    def body(self, body: ir.Body, known: dict[str, int]) -> ir.Body:
        """The body, begun with these numbers known; `known` is what it leaves."""
        done: list[ir.Statement] = []
        for statement in body:
            match statement:
                case ir.Assign(target=ir.Name(id=name), value=ir.IntLiteral(value=number)) if (
                    name.lower() in self.names
                ):
                    known[name.lower()] = number
                    done.append(statement)
                    continue
                case ir.Switch(selector=ir.Name(id=name), cases=cases) if _choice(statement) in known:
                    wanted = known[name.lower()]
                    alone = [case.body for case in cases if any(_is(value, wanted) for value in case.values)]
                    done.extend(expansion(statement.origin, alone[0] if alone else ()))
                    continue
            changed = assigned_in((statement,)) & self.names
            if isinstance(statement, LOOPS):
                _forget(known, changed)
            done.append(self.inside(statement, dict(known)))
            _forget(known, changed)
        return body if all(a is b for a, b in zip(done, body, strict=False)) and len(done) == len(body) else tuple(done)

    def inside(self, statement: ir.Statement, known: dict[str, int]) -> ir.Statement:
        return rewrite_parts(statement, lambda one: one, lambda inner: self.body(inner, dict(known)))


def _is(value: ir.Expression, number: int) -> bool:
    return isinstance(value, ir.IntLiteral) and value.value == number


def _forget(known: dict[str, int], names: set[str]) -> None:
    for name in names:
        known.pop(name, None)


__all__ = ["known_handles"]

"""Loops that count by hand: languages without a counting loop (URScript) set a number in front of a `while`, compare it
and add to it in the end. Where nothing else looks at the number, that is a counting loop with a counter of its own, and
what else sets the number in the same routine (`global i = 0` at its head) goes.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from itertools import pairwise

from rpl import ir
from rpl.ir.walk import bodies, walk
from rpl.passes.fold import constant
from rpl.passes.legalise.context import Context
from rpl.passes.legalise.facts.usage import usage_of
from rpl.passes.legalise.rewriting.editing import edit_bodies
from rpl.passes.legalise.stages import legalising
from rpl.passes.rewrite import changed, rewrite_bodies, visit_bodies
from rpl.passes.scope import ProgramScope, Scope

__all__ = ["counted_loops"]


def _no_use(context: Context) -> bool:
    return not context.foreign or "For" not in context.capabilities.statements


@legalising(unless=_no_use, sees=("While",))
def counted_loops(program: ir.Program, context: Context) -> ir.Program:
    """Only for targets with counting loops. The number is whole, at each pass by 1 more, and named nowhere but in such
    loops, or where one routine sets it to a constant; the end of the counting is the same in all passes, and the first
    pass surely runs."""
    worker = _Loops(program, bool(context.capabilities.storage.banks))
    return worker.program() if worker.counters else program


@dataclass(frozen=True, slots=True)
class _Loop:
    """`counter := start; WHILE counter < stop; ... counter := counter + 1`; last: the number of the last pass."""

    name: str
    start: ir.Expression
    last: ir.Expression
    loop: ir.While


class _Loops:
    """numbered: constants have no names in the target, so that the last number is written out."""

    def __init__(self, program: ir.Program, numbered: bool) -> None:
        self.source, self.numbered = program, numbered
        self.scopes = ProgramScope(program)
        usage = usage_of(program)
        self.assigned, self.otherwise = usage.assigned, usage.otherwise
        mentions: Counter[int] = Counter()
        counted: Counter[int] = Counter()
        looped, homes = set[int](), dict[int, set[int]]()  # homes: the routines that set it
        for module in program.modules:
            mentions.update(self.mentioned(module.declarations, self.scopes.module(module)))
        for module, routine in self.scopes.routines():
            scope = self.scopes.routine(module, routine)
            mentions.update(self.mentioned((routine,), scope))
            for body in _blocks(routine):
                for one in body:
                    if key := self.set_to(one, scope):
                        counted[key] += 1
                        homes.setdefault(key, set()).add(id(routine))
                for first, loop in pairwise(body):
                    found = self.loop(first, loop, scope)
                    if found is not None:
                        key = self.variable(found.name, scope)
                        counted[key] += sum(one == key for one in self.mentioned((loop,), scope))
                        looped.add(key)
        self.counters = {key for key in looped if key and counted[key] == mentions[key] and len(homes[key]) == 1}
        """Identities of the declarations of the numbers."""

    def variable(self, name: str, scope: Scope) -> int:
        """The variable of a name that holds nothing from one run to the next and is never passed by reference; 0 for
        anything else."""
        symbol = scope.value(name)
        declared = None if symbol is None else symbol.declaration
        plain = isinstance(declared, ir.Variable) and declared.storage == "variable"
        return id(declared) if plain and name.lower() not in self.otherwise else 0

    def set_to(self, statement: ir.Statement, scope: Scope) -> int:
        """The variable that a statement sets to a constant whole number; 0: it does something else."""
        match statement:
            case ir.Assign(target=ir.Name(id=name), value=value) if _whole(value, scope) is not None:
                return self.variable(name, scope)
        return 0

    def mentioned(self, nodes: Sequence[object], scope: Scope) -> list[int]:
        return [self.variable(name, scope) for node in walk(*nodes) for name in _mentioned(node)]

    def loop(self, first: ir.Statement, loop: ir.Statement, scope: Scope) -> _Loop | None:
        match first, loop:
            case (
                ir.Assign(target=ir.Name(id=name), value=start),
                ir.While(condition=ir.Binary(op="<" | "<=" as op, left=ir.Name(id=left), right=stop), body=body),
            ) if name.lower() == left.lower() and body:
                pass
            case _:
                return None
        begin, end = _whole(start, scope), _whole(stop, scope)
        if begin is None or end is None or not self.is_fixed(stop):
            return None
        steps = [one for one in walk(*body) if isinstance(one, ir.Assign) and _is_named(one.target, name)]
        ways = any(_is_in_the_way(one, name) for one in walk(*body))
        last = body[-1]
        if ways or steps != [last] or not isinstance(last, ir.Assign) or not _adds_one(last.value, name):
            return None
        if begin > (end if op == "<=" else end - 1):
            return None
        if op == "<" and self.numbered:
            stop = ir.IntLiteral(end - 1, origin=stop.origin)
        elif op == "<":
            stop = _one_less(stop)
        return _Loop(name, start, stop, loop)

    def is_fixed(self, stop: ir.Expression) -> bool:
        return not any(isinstance(one, ir.Name) and one.id.lower() in self.assigned for one in walk(stop))

    # ---- what it makes of the program

    def program(self) -> ir.Program:
        modules = []
        for module in self.source.modules:
            routines = tuple(self.routine(module, one) for one in module.routines)
            modules.append(changed(module, declarations=self.kept(module.declarations), routines=routines))
        return changed(self.source, modules=tuple(modules))

    def kept(self, declarations: tuple[ir.Declaration, ...]) -> tuple[ir.Declaration, ...]:
        return tuple(one for one in declarations if id(one) not in self.counters)

    def routine(self, module: ir.Module, routine: ir.Routine) -> ir.Routine:
        scope = self.scopes.routine(module, routine)

        def body(statements: ir.Body) -> ir.Body:
            done: list[ir.Statement] = []
            at = 0
            while at < len(statements):
                found = self.loop(statements[at], statements[at + 1], scope) if at + 1 < len(statements) else None
                if found is not None and self.variable(found.name, scope) in self.counters:
                    done.append(self.counting(statements[at], found, body))
                    at += 2
                    continue
                one = statements[at]
                if self.set_to(one, scope) not in self.counters:
                    done.append(rewrite_bodies(one, body))
                elif one.origin.comments:
                    done.append(ir.Nothing(origin=one.origin))
                at += 1
            return tuple(done)

        return replace(edit_bodies(routine, body), declarations=self.kept(routine.declarations))

    def counting(self, first: ir.Statement, found: _Loop, body: Callable[[ir.Body], ir.Body]) -> ir.For:
        loop = found.loop
        comments = (*first.origin.comments, *loop.origin.comments)
        inner = loop.body[:-1]
        left = loop.body[-1].origin
        if left.comments:
            inner = (*inner, ir.Nothing(origin=left))
        origin = replace(loop.origin, comments=comments)
        return ir.For(found.name, found.start, found.last, None, body(inner), scoped=True, origin=origin)


def _blocks(routine: ir.Routine) -> Iterator[ir.Body]:
    """Every body of the routine, at any depth."""
    for whole in bodies(routine):
        found = [whole]

        def look(body: ir.Body, found: list[ir.Body] = found) -> ir.Body:
            found.append(body)
            for one in body:
                visit_bodies(one, look)
            return body

        for one in whole:
            visit_bodies(one, look)
        yield from found


def _mentioned(node: object) -> Iterator[str]:
    match node:
        case ir.Name(id=name):
            yield name.lower()
        case ir.For(counter=name):
            yield name.lower()


def _is_named(target: ir.Expression, name: str) -> bool:
    return any(isinstance(one, ir.Name) and one.id.lower() == name.lower() for one in walk(target))


def _is_in_the_way(node: object, name: str) -> bool:
    """Does it leave the way to the end of the pass, look at the number at another time, or count with it too?"""
    match node:
        case ir.For(counter=counter):
            return counter.lower() == name.lower()
    return isinstance(node, ir.NextPass | ir.Label | ir.Goto | ir.DeclareInterrupt | ir.Trigger | ir.DefineTrigger)


def _adds_one(value: ir.Expression, name: str) -> bool:
    match value:
        case ir.Binary(op="+", left=ir.Name(id=left), right=ir.IntLiteral(value=1)):
            return left.lower() == name.lower()
    return False


def _whole(value: ir.Expression, scope: Scope) -> int | None:
    known = constant(value, scope)
    if isinstance(known, bool) or not isinstance(known, int | float) or known != int(known):
        return None
    return int(known)


def _one_less(stop: ir.Expression) -> ir.Expression:
    if isinstance(stop, ir.IntLiteral):
        return ir.IntLiteral(stop.value - 1, origin=stop.origin)
    return ir.Binary("-", stop, ir.IntLiteral(1), origin=stop.origin)

"""Where the counters of loops are used besides their loops: behind them, in jumps about them, in declarations."""

from __future__ import annotations

from collections.abc import Callable

from rpl import ir
from rpl.ir.walk import bodies
from rpl.passes.legalise.facts.effects import children, everything, root, statements_in
from rpl.passes.legalise.facts.usage import base_name
from rpl.passes.rewrite import rewrite_parts


def used_outside_loops(routine: ir.Routine) -> set[str]:
    """Names that stand anywhere but in the body of a loop that counts with them."""
    found: set[str] = set()

    def names(node: ir.Expression, counting: frozenset[str]) -> ir.Expression:
        if isinstance(node, ir.Name) and node.id.lower() not in counting:
            found.add(node.id.lower())
        return rewrite_parts(node, lambda part: names(part, counting))

    def look(body: ir.Body, counting: frozenset[str]) -> ir.Body:
        for statement in body:
            inner = counting
            if isinstance(statement, ir.For):
                inner = counting | {statement.counter.lower()}
            rewrite_parts(statement, lambda part: names(part, counting), _looking(look, inner))
        return body

    for body in bodies(routine):
        look(body, frozenset())
    for declaration in routine.declarations:
        if isinstance(declaration, ir.Variable) and declaration.initial is not None:
            names(declaration.initial, frozenset())
    return found


def jumps_about(routine: ir.Routine) -> bool:
    return any(isinstance(one, ir.Goto) for body in bodies(routine) for one in statements_in(body))


def overwritten(routine: ir.Routine) -> set[int]:
    """Loops on the routine's own level whose counter gets another value behind them before anything reads it."""
    found = set()
    for at, loop in enumerate(routine.body):
        if not isinstance(loop, ir.For):
            continue
        key = loop.counter.lower()
        for following in routine.body[at + 1 :]:
            read = {one.id.lower() for one in _all_expressions(following) if isinstance(one, ir.Name)}
            match following:
                case ir.For(counter=counter) if counter.lower() == key:
                    bounds = [following.start, following.stop] + ([following.step] if following.step else [])
                    if not any(
                        isinstance(one, ir.Name) and one.id.lower() == key for b in bounds for one in everything(b)
                    ):
                        found.add(id(loop))
                    break
                case ir.Assign(target=ir.Name(id=name), value=value) if name.lower() == key:
                    if not any(isinstance(one, ir.Name) and one.id.lower() == key for one in everything(value)):
                        found.add(id(loop))
                    break
            if key in read or _counts(following, key):
                break
        else:
            found.add(id(loop))
    return found


def _counts(statement: ir.Statement, key: str) -> bool:
    return any(isinstance(one, ir.For) and one.counter.lower() == key for one in statements_in((statement,)))


def _all_expressions(statement: ir.Statement) -> list[ir.Expression]:
    return [one for inner in statements_in((statement,)) for child in children(inner) for one in everything(child)]


def _looking(
    look: Callable[[ir.Body, frozenset[str]], ir.Body], counting: frozenset[str]
) -> Callable[[ir.Body], ir.Body]:
    return lambda body: look(body, counting)


def declared_loops(routine: ir.Routine, key: str) -> bool:
    """Does a loop still count with the declared variable?"""
    return any(
        isinstance(statement, ir.For) and not statement.scoped and statement.counter.lower() == key
        for statement in statements_in(routine.body)
    ) or any(
        isinstance(statement, ir.Assign) and base_name(root(statement.target)) == key
        for statement in statements_in(routine.body)
    )

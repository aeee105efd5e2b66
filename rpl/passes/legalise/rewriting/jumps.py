"""What the passes about jumps share: opposite conditions, ways out of a body, the labels of a routine and their use."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterable
from dataclasses import replace

from rpl import ir
from rpl.ir.walk import bodies
from rpl.passes.legalise.context import Context
from rpl.passes.legalise.facts.effects import blocks, statements_in
from rpl.passes.legalise.rewriting.editing import exits, expansion, map_body, passes_on
from rpl.passes.rewrite import rewrite_bodies

LOOPS = (ir.For, ir.While, ir.Repeat, ir.Loop)


def goes_on(body: ir.Body) -> bool:
    """May control come to the end of the body? Labels inside count as ways to come there."""
    for statement in reversed(body):
        match statement:
            case ir.Nothing():
                continue
            case ir.If(branches=branches, otherwise=otherwise):
                return goes_on(otherwise) or any(goes_on(inner) for _, inner in branches)
            case ir.Switch(cases=cases, default=default):
                return default is None or goes_on(default) or any(goes_on(case.body) for case in cases)
        return not leaves(statement)
    return True


def leaves(statement: ir.Statement) -> bool:
    """Does control never come to the statement behind it?"""
    match statement:
        case ir.Goto() | ir.Return() | ir.Halt(kind="exit" | "cycle") | ir.ExitLoop() | ir.NextPass():
            return True
        case ir.Retry() | ir.TryNext():  # a handler may go on behind a Raise
            return True
    return False


def targets(body: ir.Body) -> Counter[str]:
    """How many jumps go to each label, by folded name."""
    return Counter(one.label.lower() for one in statements_in(body) if isinstance(one, ir.Goto))


def labels(body: ir.Body) -> set[str]:
    """The labels of a body at any depth, folded."""
    return {one.name.lower() for one in statements_in(body) if isinstance(one, ir.Label)}


def entered(routine_body: ir.Body) -> set[int]:
    """Statements with a body that a jump from outside of them goes into, by identity."""
    found: set[int] = set()
    every = targets(routine_body)
    if not every:
        return found

    def look(body: ir.Body) -> None:
        for statement in body:
            if not blocks(statement):
                continue
            inside = labels((statement,))
            if inside:
                own = targets((statement,))
                # a jump from one branch into another one enters the statement as well
                across = any(every[name] > own[name] or _between(statement, name) for name in inside if name in every)
                if across:
                    found.add(id(statement))
            for inner in blocks(statement):
                look(inner)

    look(routine_body)
    return found


def _between(statement: ir.Statement, name: str) -> bool:
    """Does one of its bodies jump to a label in another one?"""
    inner = blocks(statement)
    home = next((at for at, body in enumerate(inner) if name in labels(body)), None)
    return home is not None and any(at != home and targets(body)[name] for at, body in enumerate(inner))


def own_jumps(statement: ir.Statement) -> bool:
    """Does it leave, or go on with, a loop around it?"""
    if isinstance(statement, LOOPS):
        return False
    return exits((statement,)) or passes_on((statement,))


class LabelNames:
    """New labels of one routine: `loop`, `loop2`, ..."""

    def __init__(self, context: Context, routine: ir.Routine) -> None:
        self.context = context
        self.taken = {name for body in bodies(routine) for name in labels(body)}
        self.taken |= {one.name.lower() for one in routine.declarations if isinstance(one, ir.Variable)}

    def fresh(self, stem: str) -> str:
        """A label that neither the routine nor a name of the program has."""
        name, number = stem, 1
        while name.lower() in self.taken or name.lower() in self.context.taken:
            number += 1
            name = f"{stem}{number}"
        self.taken.add(name.lower())
        return name


def inside(statement: ir.Statement, on_body: Callable[[ir.Body], ir.Body]) -> ir.Statement:
    """The statement with its bodies rewritten."""
    return rewrite_bodies(statement, on_body) if blocks(statement) else statement


def left_with(routine: ir.Routine, steps: ir.Body) -> ir.Routine:
    """The routine with these steps wherever it ends: at each return, and behind its body and its handlers."""

    def change(statement: ir.Statement) -> ir.Body:
        if isinstance(statement, ir.Return):
            return expansion(statement.origin, (*steps, statement))
        return (inside(statement, lambda body: map_body(body, change)),)

    def whole(body: ir.Body) -> ir.Body:
        done = map_body(body, change)
        return done if body and (leaves(body[-1]) or isinstance(body[-1], ir.Raise)) else (*done, *steps)

    handlers = tuple(replace(one, body=whole(one.body)) for one in routine.handlers)
    return replace(routine, body=whole(routine.body), handlers=handlers)


def without_labels(body: ir.Body, unused: Iterable[str]) -> ir.Body:
    """The body without these labels; their comments stay."""
    names = set(unused)

    def change(statement: ir.Statement) -> ir.Body:
        if isinstance(statement, ir.Label) and statement.name.lower() in names:
            return (ir.Nothing(origin=statement.origin),) if statement.origin.comments else ()
        return (inside(statement, lambda inner: map_body(inner, change)),)

    return map_body(body, change) if names else body

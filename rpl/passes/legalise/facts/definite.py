"""Which variables have certainly been assigned where a statement runs, going through a body in its order.

Conservative: what a loop may skip, one branch of several does or a jump may pass by is not certain. Once assigned, a
variable keeps a value.
"""

from __future__ import annotations

from dataclasses import replace

from rpl import ir
from rpl.ir.walk import walk
from rpl.passes.legalise.facts.usage import base_name
from rpl.passes.legalise.rewriting.editing import edit_bodies
from rpl.passes.rewrite import rewrite_parts


class Definite:
    """Rewrites a routine; `known`: names (folded) that have a value where the walk stands."""

    def __init__(self) -> None:
        self.known: set[str] = set()

    # ---- what a pass says

    def question(self, expression: ir.Expression) -> ir.Expression:
        """An expression whose operands are done."""
        return expression

    def calling(self, statement: ir.CallRoutine) -> ir.CallRoutine:
        return statement

    # ---- the walk

    def routine(self, routine: ir.Routine) -> ir.Routine:
        return edit_bodies(routine, self.fresh_body)

    def fresh_body(self, body: ir.Body) -> ir.Body:
        self.known = set()
        return self.body(body)

    def expression(self, expression: ir.Expression) -> ir.Expression:
        return self.question(rewrite_parts(expression, self.expression))

    def body(self, body: ir.Body) -> ir.Body:
        done: list[ir.Statement] = []
        for statement in body:
            done.append(self.statement(statement))
            if any(isinstance(node, ir.Label) for node in walk(statement)):
                self.known = set()
        return tuple(done)

    def inner(self, body: ir.Body) -> ir.Body:
        """A body that may be skipped."""
        outside = set(self.known)
        done = self.body(body)
        self.known = outside
        return done

    def statement(self, statement: ir.Statement) -> ir.Statement:
        match statement:
            case ir.If(branches=branches, otherwise=otherwise):
                conditions = [self.expression(condition) for condition, _ in branches]
                chosen, other = self.choice([*(body for _, body in branches), otherwise])
                pairs = tuple(zip(conditions, chosen, strict=True))
                return replace(statement, branches=pairs, otherwise=other)
            case ir.Switch(selector=selector, cases=cases, default=default):
                selector = self.expression(selector)
                chosen, other = self.choice([*(case.body for case in cases), default or ()])
                listed = tuple(replace(case, body=body) for case, body in zip(cases, chosen, strict=True))
                return replace(statement, selector=selector, cases=listed, default=None if default is None else other)
            case ir.For(counter=counter):
                counting = rewrite_parts(statement, self.expression)
                self.known |= set() if statement.scoped else {counter.lower()}
                return replace(counting, body=self.inner(statement.body))
            case ir.While() | ir.Repeat() | ir.Loop():
                parts = rewrite_parts(statement, self.expression)
                return replace(parts, body=self.inner(statement.body))
        done = rewrite_parts(statement, self.expression, self.inner)
        if isinstance(done, ir.CallRoutine):
            done = self.calling(done)
        self.known |= set(_places(statement))
        return done

    def choice(self, bodies: list[ir.Body]) -> tuple[list[ir.Body], ir.Body]:
        """Bodies of which one runs, the last being the one for all other cases."""
        outside, ends, done = set(self.known), [], []
        for body in bodies:
            self.known = set(outside)
            done.append(self.body(body))
            ends.append(self.known)
        self.known = set.intersection(*ends)
        return done[:-1], done[-1]


def _places(statement: ir.Statement) -> list[str]:
    """The variables (folded) that a statement gives a value whenever it runs."""
    place: ir.Expression | None = None
    match statement:
        case ir.Assign(target=target):
            place = target
        case ir.Do(procedure="increment" | "decrement" | "clear" | "text_clear" | "text_copy" | "text_append"):
            place = statement.arguments[0]
        case ir.WaitUntil(timed_out=flag):
            place = flag
    name = None if place is None else base_name(place)
    return [] if name is None else [name]

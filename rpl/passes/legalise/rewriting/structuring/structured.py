"""Labels and jumps as structure.

Ways back become loops, ways forward branches; what is structured already and has no jumps in it stays as it is. Where
several ways go into a loop at different places, a state variable in front of the loop's first branch tells which.
"""

from __future__ import annotations

import sys
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import replace
from functools import reduce

from rpl import ir
from rpl.diagnostics import Severity, code
from rpl.passes.capabilities import Limit
from rpl.passes.conditions import opposite
from rpl.passes.legalise.facts.effects import statements_in
from rpl.passes.legalise.rewriting.editing import Editor, expansion, passes_on
from rpl.passes.legalise.rewriting.jumps import entered, goes_on, inside, labels, without_labels
from rpl.passes.legalise.rewriting.structuring.flowgraph import Builder
from rpl.passes.legalise.rewriting.structuring.regions import Regions

INTO_FOR = code(
    "jump-into-counting-loop",
    Severity.LOSS,
    "a jump goes into this counting loop from outside; what its counter and its end are then is not defined",
)
_DEEP = 50_000
_Choice = tuple[list[tuple[ir.Expression, ir.Body]], ir.Body]


def _needs(editor: Editor, body: ir.Body) -> bool:
    lacking = "NextPass" not in editor.capabilities.statements
    return any(isinstance(one, ir.Goto) or (lacking and isinstance(one, ir.NextPass)) for one in statements_in(body))


def restructured(editor: Editor, body: ir.Body, raises: bool, returns: bool) -> ir.Body:
    """The body without jumps. raises: a handler stands behind it; returns: its end may be reached by Return."""
    if not _needs(editor, body):
        return without_labels(body, labels(body))
    for statement in statements_in(body):
        if isinstance(statement, ir.For) and id(statement) in entered(body):
            editor.context.diagnostics.report(INTO_FOR, statement.origin)
            return body
    regions = Regions(editor, returns)
    with _deeply():
        builder = Builder(body, regions.close, raises, "NextPass" in editor.capabilities.statements)
        builder.declare(body)
        first = builder.sequence(body, regions.exit, None)
        return _Tidy(editor, regions).body(regions.body(first))


@contextmanager
def _deeply() -> Iterator[None]:
    """Long programs of jumps are long chains of nodes, and these are followed by calls."""
    before = sys.getrecursionlimit()
    sys.setrecursionlimit(max(before, _DEEP))
    try:
        yield
    finally:
        sys.setrecursionlimit(before)


class _Tidy:
    """What was put together, as a person would write it: conditions turned, no empty branch, loops with their check."""

    def __init__(self, editor: Editor, regions: Regions) -> None:
        self.editor = editor
        self.has = editor.capabilities.statements
        self.regions = regions

    def body(self, body: ir.Body) -> ir.Body:
        done: list[ir.Statement] = []
        for statement in body:
            done.extend(self.statement(statement))
        return tuple(done)

    def statement(self, statement: ir.Statement) -> ir.Body:
        if isinstance(statement, ir.Goto) and statement.label.startswith("\0"):
            return self.regions.markers.get(statement.label, ())
        if id(statement) not in self.regions.made:
            return without_labels((statement,), labels((statement,))) or (ir.Nothing(origin=statement.origin),)
        done = inside(statement, self.body)
        match done:
            case ir.If():
                return expansion(statement.origin, self.choice(done))
            case ir.Loop():
                return (self.loop(done),)
        return (done,)

    # ---- branches

    def choice(self, statement: ir.If) -> ir.Body:
        branches, otherwise = list(statement.branches), statement.otherwise
        several = Limit.ONE_BRANCH not in self.editor.capabilities.control.limits
        match otherwise:
            case (ir.If() as inner,) if not inner.origin.comments and several:
                branches, otherwise = [*branches, *inner.branches], inner.otherwise
        while branches and not branches[-1][1] and not otherwise and self.silent(branches[-1][0]):
            branches.pop()
        if not branches:
            return otherwise
        branches, otherwise = self.without_empty(branches, otherwise)
        if len(branches) > 1 or (not branches[0][1] and not otherwise):
            filled = tuple((condition, body or (ir.Nothing(),)) for condition, body in branches)
            return (replace(statement, branches=filled, otherwise=otherwise),)
        (condition, body), *_ = branches
        if not body:
            return (replace(statement, branches=((opposite(condition), otherwise),), otherwise=()),)
        if otherwise and not goes_on(body):
            return (replace(statement, branches=((condition, body),), otherwise=()), *otherwise)
        if otherwise and not goes_on(otherwise):
            return (replace(statement, branches=((opposite(condition), otherwise),), otherwise=()), *body)
        return (replace(statement, branches=((condition, body),), otherwise=otherwise),)

    def without_empty(self, branches: list[tuple[ir.Expression, ir.Body]], otherwise: ir.Body) -> _Choice:
        """Branches that do nothing, and one behind them that does: one condition of several terms."""
        last = ([], otherwise) if otherwise else ([branches[-1][0]], branches[-1][1])
        empty = [condition for condition, _ in (branches if otherwise else branches[:-1])]
        if len(branches) < 2 or not last[1] or any(body for _, body in branches[: len(empty)]):
            return branches, otherwise
        if not all(self.silent(condition) for condition, _ in branches[1:]):
            return branches, otherwise
        terms = [term for condition in (*map(opposite, empty), *last[0]) for term in _terms(condition)]
        return [(reduce(lambda left, right: ir.Binary("and", left, right), terms), last[1])], ()

    def silent(self, condition: ir.Expression) -> bool:
        return self.editor.effects.quiet(condition) and self.editor.effects.safe(condition)

    # ---- loops

    def loop(self, statement: ir.Loop) -> ir.Loop | ir.While | ir.Repeat:
        """A check at the beginning is a While's, one at the end a Repeat's. What stands on the line of the label that
        the loop begins with is said of the loop."""
        match statement.body:
            case (ir.Nothing(origin=said), *rest) if (
                rest and said.comments and all(one.behind for one in said.comments)
            ):
                done = self.loop(replace(statement, body=tuple(rest)))
                comments = (*done.origin.comments, *said.comments)
                return replace(done, origin=replace(said, comments=comments))
            case (ir.If(branches=((condition, (ir.ExitLoop(),)),), otherwise=(), origin=origin), *rest):
                if "While" in self.has and not origin.comments:
                    return ir.While(opposite(condition), tuple(rest), origin=origin)
            case (*rest, ir.If(branches=((condition, (ir.ExitLoop(),)),), otherwise=(), origin=origin)):
                if "Repeat" in self.has and not passes_on(tuple(rest)) and not origin.comments:
                    return ir.Repeat(condition, tuple(rest), origin=origin)
        return statement


def _terms(condition: ir.Expression) -> list[ir.Expression]:
    if isinstance(condition, ir.Binary) and condition.op == "and":
        return [*_terms(condition.left), *_terms(condition.right)]
    return [condition]

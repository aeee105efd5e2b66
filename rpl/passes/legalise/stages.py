"""A pass as data: when a target needs it, what a program must hold for it to do anything, and its function.

A pass whose target does not need it, or whose program holds nothing that it sees, is not called. What a program holds
is kept by statement, so that a pass which changes three statements of 200,000 costs three walks and no more.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterable
from dataclasses import dataclass, replace
from functools import cache

from rpl import ir
from rpl.errors import InternalError
from rpl.ir.columns import LooksInsideError
from rpl.passes.legalise.context import Context
from rpl.passes.legalise.kept import keeping
from rpl.passes.legalise.kinds import kinds_in
from rpl.passes.legalise.moments import Moment, moved_back, note
from rpl.passes.stretches import settled

Run = Callable[[ir.Program, Context], ir.Program]
Unless = Callable[[Context], object]  # its truth counts


@dataclass(frozen=True, slots=True)
class Pass:
    """One rewriting of a whole program. unless: a translation that does not need it (the target has what the pass
    rewrites, or the source does not know it). sees: kinds of nodes (`kinds_of`), one of which a program must hold for
    the pass to change or report anything; empty: any program. again: why it runs here besides the place that it has in
    the stage of its folder."""

    run: Run
    unless: Unless | None = None
    sees: frozenset[str] = frozenset()
    again: str = ""

    @property
    def name(self) -> str:
        return f"{self.run.__name__} again" if self.again else self.run.__name__

    @property
    def purpose(self) -> str:
        """The first sentence of what is said of it; of a further run, why it is one."""
        if self.again:
            return f"Runs here too: {self.again}"
        text = " ".join((self.run.__doc__ or "").split())
        return text.split(". ")[0].rstrip(".")

    def needed(self, context: Context) -> bool:
        return self.unless is None or not self.unless(context)

    def __call__(self, program: ir.Program, context: Context) -> ir.Program:
        if not self.needed(context) or (self.sees and self.sees.isdisjoint(kinds_in(program))):
            return program
        return self.run(program, context)


def legalising(unless: Unless | None = None, sees: Iterable[str] = ()) -> Callable[[Run], Pass]:
    """Make a pass of a function. unless and sees as in Pass."""
    return lambda run: Pass(run, unless, frozenset(sees))


def again(one: Pass, reason: str) -> Pass:
    """A further run of a pass that stands once in the stage of its folder."""
    return replace(one, again=reason)


@dataclass(frozen=True, slots=True)
class Clause:
    """What a stage leaves nothing of in a program where the target's tables do not have it, unless a loss is reported
    at its place: names of statement and type classes and neutral names, with spaces between them; further: whole kinds
    (`handler of errors`)."""

    statements: str = ""
    functions: str = ""
    procedures: str = ""
    operators: str = ""
    system: str = ""
    types: str = ""
    further: frozenset[str] = frozenset()

    def kinds(self) -> frozenset[str]:
        """As legality.Illegal.kind says them."""
        words = (
            ("statement", self.statements),
            ("function", self.functions),
            ("procedure", self.procedures),
            ("operator", self.operators),
            ("system variable", self.system),
            ("type", self.types),
        )
        return self.further.union(f"{kind} {name}" for kind, names in words for name in names.split())


@dataclass(frozen=True, slots=True)
class Stage:
    """Passes about one matter, in the order in which they run. name: of its folder; clause: what is checked behind."""

    name: str
    passes: tuple[Pass, ...]
    clause: Clause = Clause()


@dataclass(frozen=True, slots=True)
class Placed:
    """A pass that a target brings along, and its place: directly behind or before a pass of a stage, by its name."""

    one: Pass
    stage: str
    behind: str = ""
    before: str = ""


@cache
def with_placed(stages: tuple[Stage, ...], own: tuple[Placed, ...]) -> tuple[Stage, ...]:
    """The stages with a target's own passes among theirs; of several at one place the first comes first. Raises
    InternalError where a place is beside no pass of its stage, or beside one that the stage has twice."""
    known = {stage.name: Counter(one.name for one in stage.passes) for stage in stages}
    for each in own:
        if known.get(each.stage, Counter())[each.behind or each.before] != 1:
            beside = f"{each.behind or each.before} of {each.stage}"
            raise InternalError(f"{each.one.name} stands beside {beside}, which is not one pass")
    return tuple(replace(stage, passes=_among(stage, own)) for stage in stages)


def _among(stage: Stage, own: tuple[Placed, ...]) -> tuple[Pass, ...]:
    here = [each for each in own if each.stage == stage.name]
    whole: list[Pass] = []
    for one in stage.passes:
        before = (each.one for each in here if each.before == one.name)
        behind = (each.one for each in here if each.behind == one.name)
        whole += [*before, one, *behind]
    return tuple(whole)


# How often moves of a run become ordinary ones before all do.
_MOST_PARTED = 40


def run_passes(passes: Iterable[Pass], program: ir.Program, context: Context) -> ir.Program:
    """The program behind the passes, in their order; those that have nothing to do are not called. Where one looks
    inside of a stretch of moves, it goes on behind the last pass that has left the stretches whole: with those moves as
    ordinary ones that are told apart, or with all where these are many."""
    with keeping():
        return _run(tuple(passes), program, context)


def _run(todo: tuple[Pass, ...], program: ir.Program, context: Context) -> ir.Program:
    moments, parted, at = list[Moment](), 0, 0
    while True:
        try:
            for at, one in enumerate(todo[at:], at):  # noqa: B020  # goes on where it was
                if not one.needed(context):
                    continue
                if one.sees and one.sees.isdisjoint(kinds_in(program)):
                    continue
                if context.stretches:
                    note(moments, at, program, context)
                program = one.run(program, context)
            settled(program, context.stretches, context.diagnostics.items[context.before :])
            return program
        except LooksInsideError as asked:
            parted += 1
            at, program = moved_back(moments, context, asked, part=parted <= _MOST_PARTED)

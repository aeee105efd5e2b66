"""Which move may come directly behind which, along all ways of a program and into the routines that it calls.

Each routine is laid out as a row of steps once; what comes before and behind a step is found by following the row.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, field

from rpl import ir
from rpl.ir.walk import bodies, walk
from rpl.passes.legalise.facts.effects import blocks, children

# Beside the moves by identity (negative: the robot stands behind the move): the robot stands who knows where; what was
# before the routine; what no one knows.
STANDS, BEFORE, UNKNOWN = 0, -1, -2
States = frozenset[int]
_NOTHING: States = frozenset()


@dataclass(frozen=True, slots=True)
class Pair:
    """Two moves of which the second may be the next one; None: one that is not known. `stands`: the program waits in
    between until the robot stands."""

    first: ir.Move | None
    second: ir.Move | None
    stands: bool = False


@dataclass(slots=True)
class _Step:
    """One place in the row of a routine. `ways`: labels where it goes on, where that is not the next step alone."""

    move: ir.Move | None = None
    stands: bool = False
    calls: tuple[str, ...] = ()
    unknown: bool = False
    ways: tuple[object, ...] | None = None


@dataclass(slots=True)
class _Row:
    """The steps of one body and where each goes on; the last number is its end."""

    steps: list[_Step]
    ways: list[tuple[int, ...]]


@dataclass(slots=True)
class _Summary:
    """What a routine leaves behind: the moves that may be its last; whether one may come through without a move."""

    lasts: States = _NOTHING
    passes: bool = False


@dataclass(slots=True)
class _Rows:
    """All routines by folded name, with those that call them."""

    rows: dict[str, list[_Row]] = field(default_factory=dict)
    callers: dict[str, set[str]] = field(default_factory=dict)
    moves: dict[int, ir.Move] = field(default_factory=dict)  # in the order of the program
    order: dict[int, int] = field(default_factory=dict)

    def in_order(self, states: Iterable[int]) -> list[int]:
        """Moves in the order of the program: identities are other numbers in each run."""
        if len(self.order) != len(self.moves):
            self.order = {one: number for number, one in enumerate(self.moves, 1)}
        return sorted(states, key=lambda one: (self.order.get(abs(one), 0), one < 0, min(abs(one), -UNKNOWN)))


def pairs_of(program: ir.Program) -> list[Pair]:
    """Every two moves of which the second may be the next one behind the first, in the order of the program. A routine
    that nobody calls begins with the robot at rest, as do handlers."""
    rows = _rows(program)
    summaries = _summaries(rows)
    found: list[tuple[str, int, int]] = []  # routine, move or state before, move
    entered: dict[str, set[int]] = {name: set() for name in rows.rows}
    inner: dict[str, set[str]] = {name: set() for name in rows.rows}  # routines called with what came before
    for name, own in rows.rows.items():
        for number, row in enumerate(own):
            start = frozenset((BEFORE if number == 0 else STANDS,))
            for step, state in _states(row, start, summaries):
                if step.move is not None:
                    found += [(name, before, id(step.move)) for before in rows.in_order(state)]
                if step.unknown:
                    found += [(name, before, UNKNOWN) for before in rows.in_order(state)]
                for called in step.calls:
                    if called in entered:
                        entered[called] |= state - {BEFORE}
                        if BEFORE in state:
                            inner[name].add(called)
                        state = _behind(state, summaries[called])
    _spread(entered, inner)
    pairs: dict[tuple[int, int], Pair] = {}
    for name, before, move in found:
        for one in rows.in_order(entered[name]) if before == BEFORE else (before,):
            if one != STANDS and (one, move) not in pairs:
                pairs[one, move] = Pair(rows.moves.get(abs(one)), rows.moves.get(move), one < UNKNOWN)
    return list(pairs.values())


def _spread(entered: dict[str, set[int]], inner: Mapping[str, set[str]]) -> None:
    """What comes before a routine comes before those too that it calls before it moves."""
    work = list(inner)
    while work:
        name = work.pop()
        for called in inner[name]:
            if not entered[name] <= entered[called]:
                entered[called] |= entered[name]
                work.append(called)


def _summaries(rows: _Rows) -> dict[str, _Summary]:
    found = {name: _Summary() for name in rows.rows}
    work = dict.fromkeys(rows.rows)
    while work:
        name = next(iter(work))
        del work[name]
        new = _summary(rows.rows[name], found)
        if new != found[name]:
            found[name] = new
            work |= dict.fromkeys(rows.callers.get(name, ()))
    return found


def _summary(own: list[_Row], summaries: Mapping[str, _Summary]) -> _Summary:
    lasts: States = _NOTHING
    for number, row in enumerate(own):
        start = frozenset((BEFORE if number == 0 else STANDS,))
        for step, state in _states(row, start, summaries):
            if step is row.steps[-1]:
                lasts |= state
    return _Summary(lasts - {BEFORE}, BEFORE in lasts)


def _behind(state: States, routine: _Summary) -> States:
    return routine.lasts | (state if routine.passes else _NOTHING)


def _states(row: _Row, start: States, summaries: Mapping[str, _Summary]) -> Iterator[tuple[_Step, States]]:
    """Each step that is reached, with the moves that may be the last before it."""
    before: list[States] = [_NOTHING] * len(row.steps)
    before[0] = start
    work = [0]
    while work:
        at = work.pop()
        state = _after(row.steps[at], before[at], summaries)
        for way in row.ways[at] if state else ():
            if not state <= before[way]:
                before[way] |= state
                work.append(way)
    return ((step, state) for step, state in zip(row.steps, before, strict=True) if state)


def _after(step: _Step, state: States, summaries: Mapping[str, _Summary]) -> States:
    for name in step.calls:
        if name in summaries:
            state = _behind(state, summaries[name])
    if step.unknown:
        return frozenset((UNKNOWN,))
    if step.stands:
        return frozenset(-one if one > 0 else one if one < UNKNOWN else STANDS for one in state)
    return frozenset((id(step.move),)) if step.move is not None and state else state


# ---- rows of steps


def _rows(program: ir.Program) -> _Rows:
    found = _Rows()
    for module in program.modules:
        for routine in module.routines:
            name = routine.name.lower()
            own = found.rows.setdefault(name, [])
            own += [_Layout().of(body) for body in bodies(routine)]
            for step in (step for row in own for step in row.steps):
                if step.move is not None:
                    found.moves[id(step.move)] = step.move
                for called in step.calls:
                    found.callers.setdefault(called, set()).add(name)
    return found


class _Layout:
    """Lays one body out. Work to do stands on a stack, so that no depth of the text matters."""

    def __init__(self) -> None:
        self.steps: list[_Step] = []
        self.labels: dict[object, int] = {}

    def of(self, body: ir.Body) -> _Row:
        work: list[object] = [_Mark(), *_inside(body, None, None)]
        end = work[0]
        while work:
            item = work.pop()
            if isinstance(item, _Mark):
                self.labels[item] = len(self.steps)
            elif isinstance(item, _Step):
                self.steps.append(item)
            elif isinstance(item, _Inside):
                work += self.laid_out(item, end)
        self.steps.append(_Step())
        last = len(self.steps) - 1
        ways = [
            (at + 1,) if step.ways is None else tuple(self.labels.get(way, last) for way in step.ways)
            for at, step in enumerate(self.steps[:-1])
        ]
        return _Row(self.steps, [*ways, ()])

    def laid_out(self, item: _Inside, end: object) -> list[object]:
        """What a statement becomes, the last first."""
        statement = item.statement
        asked = tuple(node.name.lower() for node in walk(*children(statement)) if isinstance(node, ir.Call))
        if asked:
            self.steps.append(_Step(calls=asked))
        match statement:
            case ir.If() | ir.Switch():
                return self.choice(blocks(statement), item)
            case ir.For() | ir.While() | ir.Repeat() | ir.Loop():
                return self.loop(statement, asked)
            case ir.ExitLoop():
                return [_Step(ways=(item.leave or end,))]
            case ir.NextPass():
                return [_Step(ways=(item.again or end,))]
            case ir.Label(name=name):
                self.labels[name.lower()] = len(self.steps)
            case ir.Goto(label=name):
                return [_Step(ways=(name.lower(),))]
            case ir.Return() | ir.Raise() | ir.Retry() | ir.TryNext() | ir.Halt(kind="exit" | "cycle"):
                return [_Step(ways=(end,))]
            case ir.Move():
                return [_Step(move=statement)]
            case ir.CallRoutine(name=name, dynamic=dynamic):
                return [_Step(calls=(name.lower(),)) if dynamic is None else _Step(unknown=True)]
        return [_Step(stands=True)] if _stands_at(statement) else []

    def choice(self, bodies: list[ir.Body], item: _Inside) -> list[object]:
        marks, behind = [_Mark() for _ in bodies], _Mark()
        self.steps.append(_Step(ways=tuple(marks)))
        made: list[object] = [behind]
        for mark, body in zip(reversed(marks), reversed(bodies), strict=True):
            made += [_Step(ways=(behind,)), *_inside(body, item.leave, item.again), mark]
        return made

    def loop(self, statement: ir.For | ir.While | ir.Repeat | ir.Loop, asked: tuple[str, ...]) -> list[object]:
        head, again, leave = _Mark(), _Mark(), _Mark()
        checked_first = isinstance(statement, ir.For | ir.While)
        ways: tuple[object, ...] = (head,) if isinstance(statement, ir.Loop) else (head, leave)
        if checked_first:
            self.steps.append(_Step(ways=ways))
        check = [_Step(ways=ways), *([_Step(calls=asked)] if asked else [])]
        return [leave, *check, again, *_inside(statement.body, leave, again), head]


class _Mark:
    """A place in the row, told apart by identity."""


@dataclass(frozen=True, slots=True)
class _Inside:
    """A statement to lay out, and where the loop around it ends and begins again."""

    statement: ir.Statement
    leave: object
    again: object


def _inside(body: ir.Body, leave: object, again: object) -> list[object]:
    return [_Inside(statement, leave, again) for statement in reversed(body)]


def _stands_at(statement: ir.Statement) -> bool:
    """Does the robot stand when it is done?"""
    match statement:
        case ir.WaitForMotion() | ir.MoveExternal() | ir.Spline() | ir.Halt():
            return True
        case ir.Wait(in_position=in_position) | ir.WaitUntil(in_position=in_position):
            return in_position
    return False


__all__ = ["Pair", "pairs_of"]

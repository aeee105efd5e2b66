"""Long runs of moves through the passes as a few moves: of each stretch of a run one move whose numbers are columns.

A run goes in as ordinary moves with stretches between them. Its first two and last two moves are ordinary ones, and so
are the first move in which a number has a sign or a way of being written that none before it had, and the first two
that share just these numbers. Why nothing wrong can come out in silence:

- Whatever asks for a value that the moves of a stretch and the ordinary ones of its run do not have alike raises
  LooksInsideError; then the run is translated move by move.
- Behind the passes each stretch has to be one move, which stands directly between the ordinary moves that it stood
  between; no column number may have gone anywhere else, and nothing may be reported about a stretch.
- Each ordinary move but the first and the last of the run has to be, to the spelling and the place, what the stretches
  give for its numbers. That refutes a pass which takes another way with columns than with numbers, which looks at a
  neighbour of a stretch as if it were that of each move, and which does something else with every second move.

What is left are passes that count the moves of a program; they are in the property test.

Where only a few moves of a run answer a question otherwise than the others, these and the moves beside them become
ordinary ones (`parted`), and the others stay stretches; only what most moves answer is checked by then.
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterable, Iterator, Sequence
from dataclasses import replace
from itertools import pairwise
from typing import TYPE_CHECKING, cast

from rpl import ir
from rpl.diagnostics import Diagnostic
from rpl.ir.columns import KEPT, Choice, ColumnNumber, LooksInsideError, Stretch, column_of
from rpl.ir.rows import Cells, Rows
from rpl.ir.runs import Make, always, identical, maker_of
from rpl.ir.walk import walk
from rpl.passes.legalise.kinds import walk_for
from rpl.passes.rewrite import changed, each, rewrite_parts, same
from rpl.source import Origin

if TYPE_CHECKING:  # who translates no long program does not wait for it
    import numpy as np
    from numpy.typing import NDArray

# A stretch of fewer moves costs more than it saves; and of a run there are not more of them.
SHORTEST = 6
_MOST = 100
# One of so many moves may become an ordinary one because it answers otherwise than most.
_ODD_IN = 12
# Moves on either side of it that do so too: one that is beside it may be changed because of it, with statements around.
_BESIDE = 2
_BLOCKS = (ir.If, ir.Switch, ir.For, ir.While, ir.Repeat, ir.Loop)
_Place = tuple[int, int, int]


def with_stretches(program: ir.Program, one_by_one: Collection[ir.Run] = ()) -> tuple[ir.Program, tuple[Stretch, ...]]:
    """The program with ordinary moves and stretches in place of its runs, and those; of the runs `one_by_one` all moves
    are ordinary ones."""
    found: list[Stretch] = []

    def body(statements: ir.Body) -> ir.Body:
        done: list[ir.Statement] = []
        for one in statements:
            if isinstance(one, ir.Run):
                done += one.moves() if one in one_by_one else _entered(one, found)
            else:
                done.append(rewrite_parts(one, _kept, body) if isinstance(one, _BLOCKS) else one)
        return statements if same(statements, done) else tuple(done)

    return _in_bodies(program, body), tuple(found)


def settled(program: ir.Program, stretches: Collection[Stretch], reports: Iterable[Diagnostic]) -> ir.Program:
    """The program behind the passes with its stretches as Rows. Raises LooksInsideError where one is not as it has to
    be."""
    if not stretches:
        return program
    places = {_place(one.origin): one for one in stretches}
    for report in reports:
        if (told := places.get(_place(report.origin))) is not None:
            raise LooksInsideError(told)
    left = dict(places)

    def body(statements: ir.Body) -> ir.Body:
        moves = {_place(one.origin): one for one in statements if isinstance(one, ir.Move)}
        here = not places.keys().isdisjoint(moves)
        done = list(statements)
        for at, one in enumerate(statements):
            if here and isinstance(one, ir.Move) and (stretch := left.pop(_place(one.origin), None)) is not None:
                done[at] = _rows(stretch, statements, at, moves)
            elif isinstance(one, _BLOCKS):
                done[at] = rewrite_parts(one, _kept, body)
        return statements if same(statements, done) else tuple(done)

    whole = _in_bodies(program, body)
    for stretch in left.values():
        raise LooksInsideError(stretch)
    _nothing_beside(whole, places)
    return whole


def check_rows(program: ir.Program, reports: Iterable[Diagnostic]) -> None:
    """Raises LooksInsideError where a pass behind `settled` has made numbers of rows anew, or has reported of them."""
    rows = [
        one
        for one in walk_for({"Rows", "VariableRows"}, *program.modules)
        if isinstance(one, ir.Rows | ir.VariableRows)
    ]
    for one in rows:
        if not one.cells.standing_in(one.sample):
            raise LooksInsideError(one.cells.stretch)
    places = {_place(one.origin): one.cells.stretch for one in rows if isinstance(one, ir.Rows)}
    for report in reports if places else ():
        if (told := places.get(_place(report.origin))) is not None:
            raise LooksInsideError(told)


def _kept(expression: ir.Expression) -> ir.Expression:
    return expression


def _in_bodies(program: ir.Program, body: Callable[[ir.Body], ir.Body]) -> ir.Program:
    def routine(one: ir.Routine) -> ir.Routine:
        handlers = each(one.handlers, lambda handler: changed(handler, body=body(handler.body)))
        return changed(one, body=body(one.body), handlers=handlers, undo=body(one.undo), backward=body(one.backward))

    modules = each(program.modules, lambda module: changed(module, routines=each(module.routines, routine)))
    return changed(program, modules=modules)


# ---- in front of the passes


def _entered(run: ir.Run, found: list[Stretch]) -> list[ir.Statement]:
    columns = run.columns
    spellings = [columns.spellings(at) for at in range(len(run))]
    last = len(run) - 1
    ordinary = {0, 1, last - 1, last, *_standing(run, spellings, range(1, last))}
    if len(run) < 2 * SHORTEST or len(ordinary) > _MOST:
        return list(run.moves())
    make = run.maker()

    def alone(first: int, end: int) -> list[ir.Statement]:
        return [make(spellings[at], columns.origin(at)) for at in range(first, end)]

    gaps, known = _gaps(ordinary, len(run))
    types = [_type({row[at] for row in spellings}) for at in range(len(columns.cells))]
    done, last = list[ir.Statement](), 0
    for first, end in gaps:
        found.append(Stretch(run, first, end, known, spellings))
        done += [*alone(last, first), _column_move(found[-1], types)]
        last = end
    return [*done, *alone(last, len(run))]


def _standing(run: ir.Run, spellings: list[tuple[str, ...]], moves: Sequence[int]) -> set[int]:
    """For each sign and each way of being written of a number the first of these moves that has it, and the first two
    that share just these numbers."""
    import numpy as np

    values, standing = run.columns.values, set[int]()
    for column in _kinds([spellings[at] for at in moves], values[moves]).T:
        standing.update(moves[one] for one in np.unique(column, return_index=True)[1].tolist())
    for one in np.unique(_repeated(values, moves), return_index=True)[1].tolist():
        standing.update((moves[one] - 1, moves[one]))
    return standing


def _gaps(standing: Collection[int], count: int) -> tuple[list[tuple[int, int]], tuple[int, ...]]:
    """Where enough moves for a stretch are between ordinary ones, and which of `count` moves are ordinary then."""
    gaps = [(one + 1, other) for one, other in pairwise(sorted(standing)) if other - one > SHORTEST]
    return gaps, tuple(sorted({*range(count)} - {at for gap in gaps for at in range(*gap)}))


def _kinds(spellings: list[tuple[str, ...]], values: NDArray[np.float64]) -> NDArray[np.int64]:
    """Of each number of a run: 4 whole, 2 with a sign, 1 zero. Passes may take another way for any of them."""
    import numpy as np

    whole = np.array([["." not in one for one in row] for row in spellings])
    kinds: NDArray[np.int64] = whole * 4 + np.signbit(values) * 2 + (values == 0.0)
    return kinds


def _repeated(values: NDArray[np.float64], moves: Sequence[int]) -> NDArray[np.int64]:
    """Which numbers of each move are those of the one before, as bits: passes may compare a move with its neighbour."""
    import numpy as np

    at = np.array(moves, dtype=np.int64)
    repeated = (values[at] == values[at - 1]).astype("int64")
    bits: NDArray[np.int64] = repeated @ (1 << np.arange(values.shape[1], dtype=np.int64))
    return bits


def _type(spellings: Collection[str]) -> type | None:
    """Of a column with these: int, float, or None where all moves of the run are written alike."""
    if len(spellings) == 1:
        return None
    return float if any("." in one for one in spellings) else int


def _column_move(stretch: Stretch, types: Sequence[type | None]) -> ir.Move:
    """The move that stands for a stretch. What is written alike in all moves of the run stays as it is."""
    run = stretch.run
    cells: list[ir.Expression] = []
    for at, (old, kind) in enumerate(zip(run.columns.cells, types, strict=True)):
        if kind is None:
            cells.append(old)
            continue
        number, spelling = ColumnNumber(stretch, run.columns.values[stretch.rows, at], kind), f"{KEPT}{at}"
        whole = kind is int
        cells.append(
            ir.IntLiteral(cast(int, number), spelling) if whole else ir.RealLiteral(cast(float, number), spelling)
        )
    return run.with_cells(tuple(cells), stretch.origin)


# ---- between the passes


def parted(
    program: ir.Program, whole: ir.Program, stretches: Sequence[Stretch], asked: LooksInsideError
) -> tuple[ir.Program, tuple[Stretch, ...]] | None:
    """The program with ordinary moves in place of those that answer a question otherwise than most, and the stretches
    that it has then. whole: the same program with its stretches as Rows (`settled`). None: there are too many."""
    run, odd = asked.stretch.run, asked.stretch.odd | frozenset(asked.odd)
    if not asked.odd or len(odd) * _ODD_IN > len(run):
        return None
    unlike = {at for one in odd for at in range(one - _BESIDE, one + _BESIDE + 1)}
    there = {_place(one.origin): one for one in walk(*whole.modules) if isinstance(one, ir.Rows)}
    parts: dict[_Place, list[ir.Statement]] = {}
    kept: list[Stretch] = []
    for stretch in stretches:
        if stretch.run is run and not unlike.isdisjoint((*stretch.checked, *range(stretch.first, stretch.end))):
            parts[_place(stretch.origin)] = _pieces(there[_place(stretch.origin)], unlike, odd, kept)
        else:
            kept.append(stretch)

    def body(statements: ir.Body) -> ir.Body:
        return tuple(_spread(statements))

    def _spread(statements: ir.Body) -> Iterator[ir.Statement]:
        for one in statements:
            if isinstance(one, ir.Move):
                yield from parts.get(_place(one.origin), (one,))
            else:
                yield rewrite_parts(one, _kept, body) if isinstance(one, _BLOCKS) else one

    return _in_bodies(program, body), tuple(kept)


def _pieces(rows: Rows, unlike: set[int], odd: frozenset[int], kept: list[Stretch]) -> list[ir.Statement]:
    """Ordinary moves and stretches, which are put with the `kept`, in place of rows."""
    old = rows.cells.stretch
    run, calculated = old.run, {*old.rows.tolist()} - odd
    left = [at for at in (*old.checked, *range(old.first, old.end)) if at not in unlike]
    standing = {at for at in _standing(run, old.spellings, left) if old.first <= at < old.end} if left else set[int]()
    standing = {*old.checked, *standing} - unlike
    checked = tuple(sorted(at for at in standing if {at - 1, at, at + 1} <= calculated))
    gaps, ordinary = _gaps({*old.ordinary, *standing, *unlike} & {*range(len(run))}, len(run))
    done, last = list[ir.Statement](), old.first
    for first, end in gaps:
        if old.first <= first and end <= old.end:
            kept.append(Stretch(run, first, end, ordinary, old.spellings, checked, odd))
            done += [*rows.these(range(last, first)), _part(rows, kept[-1])]
            last = end
    return [*done, *rows.these(range(last, old.end))]


def _part(rows: Rows, part: Stretch) -> ir.Move:
    """The move that stands for some moves of a stretch."""
    sample, old = rows.sample, rows.cells.stretch
    some = old.rows_of(part.rows)

    def number(literal: ir.Expression) -> ir.Expression:
        if not isinstance(literal, ir.IntLiteral | ir.RealLiteral):
            return literal
        column = column_of(literal.value)
        if column is None:
            return literal
        value = ColumnNumber(part, column.values[some], column.kind, column.shifted)
        if isinstance(literal, ir.IntLiteral):
            return replace(literal, value=cast(int, value))
        return replace(literal, value=cast(float, value))

    part.choices = [Choice(one.answers[some], tuple(map(number, one.options))) for one in old.choices]
    makes: dict[int, Make[None]] = {key: always(number(cell.literal)) for key, cell in rows.cells.by_identity.items()}
    make = maker_of(sample, makes, sample.origin)
    return cast(ir.Move, make(None, part.origin)) if make is not None else sample


# ---- behind the passes


def _place(origin: Origin) -> _Place:
    return id(origin.source), origin.start, origin.end


def _rows(stretch: Stretch, statements: ir.Body, at: int, moves: dict[_Place, ir.Move]) -> Rows:
    """The move at `at` of a body as rows, when it is what has to come of the stretch. moves: those of the body."""
    columns, sample = stretch.run.columns, statements[at]
    beside = [columns.origin(stretch.first - 1), columns.origin(stretch.end)]
    around = [statements[at - 1] if at else None, statements[at + 1] if at + 1 < len(statements) else None]
    if not isinstance(sample, ir.Move) or any(
        not isinstance(one, ir.Move) or _place(one.origin) != _place(origin)
        for one, origin in zip(around, beside, strict=True)
    ):
        raise LooksInsideError(stretch)
    numbers = stretch.checked
    alone = [moves.get(_place(columns.origin(one))) for one in numbers]
    for signed in (False, True):
        rows = Rows(sample, Cells(stretch, sample, signed), origin=sample.origin)
        if all(map(identical, rows.these(numbers), alone)):
            return rows
    raise LooksInsideError(stretch)


def _nothing_beside(program: ir.Program, places: dict[_Place, Stretch]) -> None:
    """No column number and no place of a stretch outside of its rows."""

    def body(statements: ir.Body) -> ir.Body:
        left = (rewrite_parts(one, _kept, body) for one in statements if not isinstance(one, Rows))
        return tuple(left)

    for node in walk(*_in_bodies(program, body).modules):
        column = column_of(node.value) if isinstance(node, ir.IntLiteral | ir.RealLiteral) else None
        if column is not None:
            raise LooksInsideError(column.stretch)
        origin = getattr(node, "origin", None)
        if isinstance(origin, Origin) and (stretch := places.get(_place(origin))) is not None:
            raise LooksInsideError(stretch)

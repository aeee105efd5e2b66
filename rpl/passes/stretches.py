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
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterable, Sequence
from itertools import pairwise
from typing import TYPE_CHECKING, cast

from rpl import ir
from rpl.diagnostics import Diagnostic
from rpl.ir.columns import KEPT, ColumnNumber, LooksInsideError, Stretch, column_of
from rpl.ir.rows import Cells, Rows
from rpl.ir.runs import identical
from rpl.ir.walk import walk
from rpl.passes.rewrite import changed, each, rewrite_parts, same
from rpl.source import Origin

if TYPE_CHECKING:  # who translates no long program does not wait for it
    import numpy as np
    from numpy.typing import NDArray

# A stretch of fewer moves costs more than it saves; and of a run there are not more of them.
SHORTEST = 6
_MOST = 100
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
    rows = [one for one in walk(*program.modules) if isinstance(one, ir.Rows | ir.VariableRows)]
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
    import numpy as np

    columns = run.columns
    spellings = [columns.spellings(at) for at in range(len(run))]
    kinds = _kinds(spellings, columns.values)
    ordinary = {0, 1, len(run) - 2, len(run) - 1}
    for column in kinds[1:-1].T:
        ordinary.update((np.unique(column, return_index=True)[1] + 1).tolist())
    for at in (np.unique(_repeated(columns.values)[1:-1], return_index=True)[1] + 1).tolist():
        ordinary.update((at - 1, at))
    if len(run) < 2 * SHORTEST or len(ordinary) > _MOST:
        return list(run.moves())
    make = run.maker()

    def alone(first: int, end: int) -> list[ir.Statement]:
        return [make(spellings[at], columns.origin(at)) for at in range(first, end)]

    standing = sorted(ordinary)
    gaps = [(one + 1, other) for one, other in pairwise(standing) if other - one > SHORTEST]
    known = tuple(sorted({*range(len(run))} - {at for gap in gaps for at in range(*gap)}))
    types = [_type({row[at] for row in spellings}) for at in range(len(columns.cells))]
    done, last = list[ir.Statement](), 0
    for first, end in gaps:
        found.append(Stretch(run, first, end, known, spellings))
        done += [*alone(last, first), _column_move(found[-1], types)]
        last = end
    return [*done, *alone(last, len(run))]


def _kinds(spellings: list[tuple[str, ...]], values: NDArray[np.float64]) -> NDArray[np.int64]:
    """Of each number of a run: 4 whole, 2 with a sign, 1 zero. Passes may take another way for any of them."""
    import numpy as np

    whole = np.array([["." not in one for one in row] for row in spellings])
    kinds: NDArray[np.int64] = whole * 4 + np.signbit(values) * 2 + (values == 0.0)
    return kinds


def _repeated(values: NDArray[np.float64]) -> NDArray[np.int64]:
    """Which numbers of a move are those of the move before, as bits: passes may compare a move with its neighbour."""
    import numpy as np

    repeated = np.zeros(values.shape, dtype=np.int64)
    repeated[1:] = values[1:] == values[:-1]
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
    numbers = stretch.ordinary[1:-1]
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

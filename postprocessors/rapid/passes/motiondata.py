"""Speeds and zones of moves by names: the predefined ones where they are within 2 % of what is wanted, else data at the
head of the module, one for each value.

People write no numbers there (0 of 2,454 public moves have a literal speed or zone): v100, z50 and fine are words that
the pendant offers, and a value of its own has a name that can be changed in one place. What is no number of the source
but an estimate (the tool speed that stands for percent of the axes, a corner in a measure that RAPID has not) becomes
the predefined value next to it.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field, replace

from rpl import ir
from rpl.diagnostics import Severity, code
from rpl.ir.columns import ColumnNumber, Stretch, column_of, in_each_row, selected
from rpl.ir.rows import Cell
from rpl.passes.legalise.context import Context
from rpl.passes.legalise.rewriting.editing import edit_all, map_body
from rpl.passes.legalise.rewriting.headdata import with_data
from rpl.passes.legalise.stages import legalising
from rpl.passes.percents import ZONE_PROPORTIONS
from rpl.passes.rewrite import rewrite_bodies

from ..expressions import number_of
from ..tables import SPEED_NAMES, ZONE_NAMES

NEAREST = code(
    "nearest-predefined",
    Severity.WARNING,
    "{wanted:g} {unit} is written as {name}, the predefined value next to it",
)
_WITHIN = 0.02
_ESTIMATED = 0.1  # how far the speed of a joint move may be from the predefined one next to it
_TURN, _ANY_TURN_DEG = 4, 180.0  # where a zone says how far from its corner the tool may turn, and all there is
_FULL = ir.Name("vmax")
_FULL_MM_S = 5000.0  # what 100 % of the axes' speed is written as, where a tool speed has to stand for it
_USUAL_TURN = dict(ZONE_PROPORTIONS)["rotation"] * (1.0 + 1e-9)  # deg a mm of the zone
_MOST_NAMES = 16  # of one speed or zone in a run, more of them are no few words that return
_Values = tuple[float, ...]
_Key = tuple[str, bool, _Values]  # v or z, is it an estimate, its numbers


@legalising(sees=("Move",))
def named_motion_data(program: ir.Program, context: Context) -> ir.Program:
    """The program with no speed or zone of numbers at a move."""
    worker = _Named(context)
    if context.stretches:  # once more when all names are known, those of the rows beside a stretch too
        edit_all(program, worker.body)
        worker.complete = True
    done = edit_all(program, worker.body)
    return with_data(done, worker.added) if worker.added else done


@dataclass(slots=True)
class _Named:
    context: Context
    names: dict[_Key, ir.Expression] = field(default_factory=dict)
    added: list[ir.Variable] = field(default_factory=list)
    complete: bool = False

    def body(self, body: ir.Body) -> ir.Body:
        return map_body(body, self.statement)

    def statement(self, statement: ir.Statement) -> ir.Body:
        if not isinstance(statement, ir.Move | ir.MoveExternal):
            return (rewrite_bodies(statement, self.body),)
        speed, blend = statement.speed, statement.blend
        if speed is not None and isinstance(speed.profile, ir.Aggregate):
            profile = self.named(speed.profile, statement)
            statement = replace(statement, speed=replace(speed, profile=profile))
        if isinstance(blend, ir.BlendZone) and isinstance(blend.zone, ir.Aggregate):
            statement = replace(statement, blend=replace(blend, zone=self.named(blend.zone, statement)))
        return (statement,)

    def named(self, data: ir.Aggregate, move: ir.Move | ir.MoveExternal) -> ir.Expression:
        """The name of the data, or the value of a predefined one."""
        numbers = [one for _, one in data.entries if isinstance(one, ir.IntLiteral | ir.RealLiteral)]
        columns = [column for column in (column_of(one.value) for one in numbers) if column is not None]
        if columns:
            return self.by_rows(data, move, columns)
        data = _with_any_turn(data)
        key = _key(data, move)
        if key is None:
            return data
        letter, _, values = key
        if letter == "v" and isinstance(move, ir.Move) and move.kind == "joint" and values[0] >= _FULL_MM_S:
            return _FULL
        if key not in self.names:
            self.names[key] = self.near(key, data, move) or self.own(key, data)
        return self.names[key]

    def by_rows(
        self, data: ir.Aggregate, move: ir.Move | ir.MoveExternal, columns: list[ColumnNumber]
    ) -> ir.Expression:
        """The names in a stretch of a run, in the order in which its moves ask for them."""
        import numpy as np

        stretch, numbers = columns[0].stretch, [column.values for column in columns]
        if data.type_name == "zone":
            size, turn = _size(data.entries[1][1], math.inf), _size(data.entries[_TURN][1], 0.0)
            turned = np.broadcast_to(in_each_row(turn) > in_each_row(size) * _USUAL_TURN, len(stretch.rows))
            numbers = [
                np.where(turned, _ANY_TURN_DEG, values) if column is column_of(turn) else values
                for column, values in zip(columns, numbers, strict=True)
            ]
            numbers.append(turned.astype("float64"))
        _, first, which = np.unique(np.array(numbers), axis=1, return_index=True, return_inverse=True)
        if len(first) > _MOST_NAMES:
            return data
        begin = stretch.row(stretch.first)
        inside = which[begin : begin + stretch.end - stretch.first]
        found, where = np.unique(inside, return_index=True)
        names = {
            kind: self.named(_alone(data, stretch, stretch.first + at), move)
            for at, kind in sorted(zip(where.tolist(), found.tolist(), strict=True))
        }
        for kind, row in enumerate(first.tolist()):
            if kind not in names:
                alone = _alone(data, stretch, int(stretch.rows[row]))
                known = self.complete and _key(_with_any_turn(alone), move) in self.names
                names[kind] = self.named(alone, move) if known else data
        return selected(stretch, which, tuple(names[kind] for kind in range(len(first))))

    def near(self, key: _Key, data: ir.Aggregate, move: ir.Statement) -> ir.Expression | None:
        """The values of the predefined speed or zone that is near enough in all of them."""
        letter, estimated, values = key
        table, at, unit = (SPEED_NAMES, 0, "mm/s") if letter == "v" else (ZONE_NAMES, 1, "mm")
        within = _ESTIMATED if estimated else _WITHIN
        found = [known for known in table if _is_near(known, values, letter, within)]
        if not found and estimated and letter == "z":  # rather less of the corner than more
            found = [max((known for known in table if known[1] <= values[1]), default=())]
        if not any(found):
            return None
        best = min(found, key=lambda known: abs(known[at] - values[at]))
        if best[at] != values[at]:
            self.context.diagnostics.report(NEAREST, move.origin, wanted=values[at], unit=unit, name=table[best])
        entries = zip(data.entries, best, strict=True)
        return replace(
            data,
            entries=tuple(
                (name, ir.BoolLiteral(bool(number)) if name == "stop" else ir.RealLiteral(number))
                for (name, _), number in entries
            ),
        )

    def own(self, key: _Key, data: ir.Aggregate) -> ir.Expression:
        """Data at the head of the module, named by its size: v350, z25."""
        letter, _, values = key
        size = values[0] if letter == "v" else values[1]
        word = f"{letter}{size:.6g}".replace(".", "_")
        if letter == "v" and values[1] != 500.0:
            word += f"_{values[1]:.6g}".replace(".", "_")
        if letter == "z" and not _is_usual(values):
            word += "Turning"
        name = self.context.fresh(word)
        type: ir.Type = ir.SpeedType() if letter == "v" else ir.ZoneType()
        self.added.append(ir.Variable(name, type, data, storage="constant", scope="global"))
        return ir.Name(name)


def _is_estimate(move: ir.Statement, letter: str, size: float) -> bool:
    """Is it a number that a conversion of measures has given: the speed of a joint move, a corner of odd size?"""
    if letter == "v":
        return isinstance(move, ir.Move) and move.kind == "joint"
    return abs(size * 2.0 - round(size * 2.0)) > 1e-6


def _is_near(known: _Values, wanted: _Values, letter: str, within: float) -> bool:
    """Is each number within that share? Of a zone in the usual proportions its size says all."""
    if letter == "z" and _is_usual(wanted):
        return known[0] == wanted[0] and abs(known[1] - wanted[1]) <= within * known[1]
    return all(abs(one - other) <= within * one for one, other in zip(known, wanted, strict=True))


def _key(data: ir.Aggregate, move: ir.Statement) -> _Key | None:
    """None where not all of its values are numbers."""
    values = tuple(number for number in (number_of(value) for _, value in data.entries) if number is not None)
    if len(values) < len(data.entries):
        return None
    letter, at = ("v", 0) if data.type_name == "speed" else ("z", 1)
    return letter, _is_estimate(move, letter, values[at]), values


def _alone(data: ir.Aggregate, stretch: Stretch, at: int) -> ir.Aggregate:
    """The data in one move of the run."""

    def number(part: ir.Expression) -> ir.Expression:
        if not isinstance(part, ir.IntLiteral | ir.RealLiteral) or column_of(part.value) is None:
            return part
        return Cell(stretch, part, False).number(at, stretch.run.columns.origin(at))

    return replace(data, entries=tuple((name, number(part)) for name, part in data.entries))


def _with_any_turn(data: ir.Aggregate) -> ir.Aggregate:
    """A zone that lets the tool turn more than its size does, so that the turn does not make it smaller: one for all
    moves, whose turns are limited by the size on the path then."""
    if data.type_name != "zone":
        return data
    if _size(data.entries[_TURN][1], 0.0) <= _size(data.entries[1][1], math.inf) * _USUAL_TURN:
        return data
    entries = list(data.entries)
    entries[_TURN] = (entries[_TURN][0], ir.RealLiteral(_ANY_TURN_DEG))
    return replace(data, entries=tuple(entries))


def _size(part: ir.Expression, otherwise: float) -> float:
    """A number of a zone, where it is one."""
    return part.value if isinstance(part, ir.IntLiteral | ir.RealLiteral) else otherwise


def _is_usual(zone: _Values) -> bool:
    """Does what the zone says of turning follow from its size?"""
    size = zone[1]
    return all(
        abs(one - size * factor) < 1e-6 * size for one, (_, factor) in zip(zone[1:], ZONE_PROPORTIONS, strict=True)
    )

"""Proves again with taught data moved: first all of it together, then, where that does not mean the same, by halves,
so that the data that does not is named after a few runs. Places come first, then tools and frames.

What is compared is what the proof compares. Re-teaching holds where it makes no difference that was not there before,
and no way, tool or frame deviates farther than it did.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, field, replace

import numpy as np

from rpl import ir
from rpl.cell import Cell
from rpl.emulator.model import RobotModel
from rpl.ir.walk import walk
from rpl.passes import rigid
from rpl.passes.given import with_given
from rpl.passes.legalise.source.places.pulses import pulses_as_joints
from rpl.proof.difference import Difference
from rpl.proof.reach import Reach
from rpl.proof.record import Record, place_of
from rpl.proof.teaching.data import FRAME, NUMBER, POINT, TOOL, Datum, Joints, Taught, taught_data, with_taught
from rpl.proof.teaching.moving import Amount, Moved, Stand, moved, stand_of
from rpl.proof.teaching.outcome import Retaught, outcomes_of
from rpl.proof.teaching.pairs import Given, paired, same_place
from rpl.proof.verdict import DIFFERENT, ProofResult

_MOST_RUNS = 80
# Tries to move all of it so that A still runs as it did: smaller, and then so that tools that point down stay so.
_TRIES = ((1.0, False), (0.5, False), (1.0, True), (0.5, True), (0.2, True), (0.05, True))
_SAME_WAY_DEG = 60.0  # an axis that ends a move farther from where it did goes another way
# Deviations that re-teaching must not make greater, and by how much they may differ (mm).
_HARD = ("path", "tool", "frame")
_ROOM_MM = 0.05
_SEEN_MM = 1e-6


@dataclass(frozen=True, slots=True)
class Teaching:
    """What --teach asks. `given`: which data of B the translation made of which of A (pairs.given_by)."""

    seed: int = 1
    amount: Amount = field(default_factory=Amount)
    given: tuple[Given, ...] = ()


@dataclass(frozen=True, slots=True, eq=False)
class Runs:
    """Both programs and how they are run and compared. `run_a`, `run_b`: a program in its cell; `compare`: both records
    with their programs."""

    program_a: ir.Program
    program_b: ir.Program
    robot_a: RobotModel | None
    robot_b: RobotModel | None
    cell_a: Cell | None
    cell_b: Cell | None
    run_a: Callable[[ir.Program, Cell | None], Record]
    run_b: Callable[[ir.Program, Cell | None], Record]
    compare: Callable[[Record, Record, ir.Program, ir.Program], ProofResult]


def retaught(base: ProofResult, runs: Runs, asked: Teaching) -> ProofResult:
    """The verdict with what re-teaching shows besides."""
    if base.verdict == DIFFERENT:
        note = "not looked at: the programs differ as they are"
        return replace(base, taught=Retaught((), asked.seed, asked.amount, note=note))
    first, cell_a = _settled(pulses_as_joints(runs.program_a, runs.robot_a), runs.cell_a)
    second, cell_b = _settled(pulses_as_joints(runs.program_b, runs.robot_b), runs.cell_b)
    runs = replace(runs, program_a=first, program_b=second, cell_a=cell_a, cell_b=cell_b)
    found = _Teacher(base, runs, asked).result()
    return replace(base, difference=found.difference, taught=found)


def _settled(program: ir.Program, cell: Cell | None) -> tuple[ir.Program, Cell | None]:
    """The program that begins with the values of the cell, as far as its data can hold them, and the rest of the
    cell. Data that says the cell's value already is not overridden any more when it is taught anew."""
    if cell is None or not cell.variables:
        return program, cell
    left = {}
    for name, value in cell.variables.items():
        begun = with_given(program, {name: value})
        if begun is program:
            left[name] = value
        program = begun
    held = {one.variable.lower(): one.value for one in taught_data(program, set_numbers=True) if one.first}
    left = {name: value for name, value in left.items() if not _says(held.get(name.lower()), value)}
    return program, replace(cell, variables=left)


def _says(held: rigid.Pose | Joints | float | None, given: object) -> bool:
    """Is what a datum holds the place that a cell file gives by components?"""
    if not isinstance(held, rigid.Pose) or not isinstance(given, dict):
        return False
    known = {str(name).lower(): value for name, value in given.items()}
    if not known.keys() <= set(ir.POSE) or not all(isinstance(value, int | float) for value in known.values()):
        return False
    x, y, z, a, b, c = (float(known.get(name, 0.0)) for name in ir.POSE)
    return same_place(held, rigid.Pose(rigid.Vector(x, y, z), rigid.rotation_of_zyx(a, b, c)))


class _Teacher:
    def __init__(self, base: ProofResult, runs: Runs, asked: Teaching) -> None:
        self.base, self.runs, self.asked = base, runs, asked
        self.ours, self.theirs = taught_data(runs.program_a), taught_data(runs.program_b, set_numbers=True)
        self.pairs = paired(self.ours, self.theirs, asked.given)
        self.count = 0
        self.difference: Difference | None = None
        self.moves: dict[Datum, Moved] = {}
        self.together: list[str] = []
        self.before = Record("", 0.0, {}, {})
        self.stands = (Stand(runs.robot_a), Stand(runs.robot_b))

    def result(self) -> Retaught:
        unreached = _unreached(self.runs.program_a, self.ours, self.base.reach_a)
        matched = [one for one, copies in self.pairs.items() if copies and one not in unreached]
        failing: dict[Datum, str] = {}
        if matched:
            record = self.runs.run_a(self.runs.program_a, self.runs.cell_a)
            other = self.runs.run_b(self.runs.program_b, self.runs.cell_b)
            self.before = record
            self.stands = (
                stand_of(self.runs.program_a, record, self.ours, self.runs.robot_a),
                stand_of(self.runs.program_b, other, self.theirs, self.runs.robot_b),
            )
            # Places are taught with the posture that the arm has there, so frames are taught at another time.
            for kinds in ((POINT, NUMBER), (TOOL, FRAME)):
                some = [one for one in matched if one.kind in kinds]
                self._choose(some)
                some = [one for one in some if one in self.moves]
                without = self._without_effect(record, some)
                unreached |= without
                failing |= self._failing([one for one in some if one not in without])
        unmoved = [one for one in matched if one not in self.moves]
        outcomes = outcomes_of(self.pairs, failing, tuple(unreached), unmoved)
        together = tuple(self.together)
        return Retaught(outcomes, self.asked.seed, self.asked.amount, self.count, "", together, self.difference)

    # ---- how far

    def _choose(self, data: Sequence[Datum]) -> None:
        """Amounts with which A runs as it did: of all, else of each by itself. What cannot be moved has none."""
        if data and not self._chosen(data) and len(data) > 1:
            for one in data:
                self._chosen([one])

    def _chosen(self, data: Sequence[Datum]) -> bool:
        for number, (factor, level) in enumerate(_TRIES):
            seed, amount = f"{self.asked.seed} {number}", self.asked.amount.times(factor)
            found = {one: moved(one, self.pairs[one], *self.stands, amount, seed, level) for one in data}
            moves = {one: move for one, move in found.items() if move is not None}
            if amount.is_none or _same_way(self.before, self._run_a(moves.values())):
                self.moves |= moves
                return True
        return False

    def _run_a(self, moves: Iterable[Moved]) -> Record:
        new = {one.datum: one.taught for one in moves}
        return self.runs.run_a(with_taught(self.runs.program_a, new), self.runs.cell_a)

    def _without_effect(self, record: Record, data: Sequence[Datum]) -> set[Datum]:
        """Elements of lists that the run never looks at: nothing in the program names them one by one."""
        some = [one for one in data if "[" in one.variable + one.part]
        return {one for one in some if _same_ends(record, self._run_a([self.moves[one]]))}

    # ---- proving again

    def _proved(self, data: Sequence[Datum]) -> ProofResult | None:
        """The proof with these data moved; None where A does not run as it did, which tells nothing about B."""
        self.count += 1
        new_a = {one: self.moves[one].taught for one in data}
        new_b: dict[Datum, Taught] = {copy: taught for one in data for copy, taught in self.moves[one].copies}
        first, second = with_taught(self.runs.program_a, new_a), with_taught(self.runs.program_b, new_b)
        record_a = self.runs.run_a(first, self.runs.cell_a)
        if not self.asked.amount.is_none and not _same_way(self.before, record_a):
            return None
        record_b = self.runs.run_b(second, self.runs.cell_b)
        return self.runs.compare(record_a, record_b, first, second)

    def _failing(self, data: Sequence[Datum]) -> dict[Datum, str]:
        """The data that do not mean the same when they are taught anew, and why."""
        if not data or self.count >= _MOST_RUNS:
            return {}
        half, result = len(data) // 2, self._proved(data)
        if result is None and not half:  # it went with the others only: an amount of its own
            result = self._proved(data) if self._chosen(data) else None
            if result is None:
                del self.moves[data[0]]
                return {}
        reason = _worse(self.base, result) if result is not None else ""
        if result is not None and not reason:
            return {}
        found = self._failing(data[:half]) | self._failing(data[half:]) if half else {data[0]: reason}
        if not found and reason:
            self.together.append(f"{', '.join(one.name for one in data)}: {reason}")
        if self.difference is None and result is not None and result.difference is not None:
            names = ", ".join(one.name for one in data)
            text = f"re-taught {names}: {result.difference.explanation}"
            self.difference = replace(result.difference, explanation=text)
        return found


def _worse(base: ProofResult, result: ProofResult) -> str:
    """What re-teaching has changed of the verdict; empty where it holds."""
    if result.difference is not None:
        lines = [f"line {one.place.line}" for one in (result.difference.a, result.difference.b)]
        return f"{result.difference.explanation} ({' / '.join(lines)})"
    before = {one.kind: one.worst.amount for one in (*base.open, *base.accepted)}
    for one in (*result.open, *result.accepted):
        if one.kind in _HARD and one.worst.amount > before.get(one.kind, 0.0) + _ROOM_MM:
            return one.as_text()
    return result.reason if result.reason and not base.reason else ""


def _same_way(before: Record, after: Record) -> bool:
    """Does the run end as it did, with each move ending about where it did?"""
    if before.status != after.status:
        return False
    for task, stretches in before.motion.items():
        others = after.motion.get(task, ())
        if len(others) != len(stretches):
            continue
        for one, other in zip(stretches, others, strict=True):
            if np.abs(one.joints - other.joints).max(initial=0.0) > _SAME_WAY_DEG:
                return False
    return True


def _same_ends(before: Record, after: Record) -> bool:
    """Has nothing moved elsewhere?"""
    pairs = [(some, after.motion.get(task, ())) for task, some in before.motion.items()]
    return all(
        len(some) == len(others)
        and all(
            np.abs(one.poses[-1] - other.poses[-1]).max() <= _SEEN_MM for one, other in zip(some, others, strict=True)
        )
        for some, others in pairs
    )


def _unreached(program: ir.Program, data: Sequence[Datum], reach: Reach | None) -> set[Datum]:
    """Data that only statements name to which no run came."""
    left = {(one.place.file, one.place.line) for one in reach.unreached} if reach is not None else set()
    lines: dict[str, set[tuple[str, int]]] = {}
    for module in program.modules:
        for routine in module.routines:
            for node in (one for one in walk(*routine.body) if isinstance(one, ir.Name)):
                at = place_of(node.origin)
                for name in (node.id.lower(), f"{routine.name}.{node.id}".lower()):
                    lines.setdefault(name, set()).add((at.file, at.line))
    found = set()
    for one in data:
        key = f"{one.routine}.{one.variable}".lower() if one.routine else one.variable.lower()
        seen = lines.get(key, set())
        if seen and seen <= left:
            found.add(one)
    return found


__all__ = ["Runs", "Teaching", "retaught"]

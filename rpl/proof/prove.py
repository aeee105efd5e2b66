"""Decides whether two programs mean the same: runs both in the same surroundings and compares what they showed.

Both are driven alike, with constant accelerations unless a controller is named: what differs then is what the programs
say, not how smoothly two makers' arms speed up.

The limit of this proof: it covers the way the programs took with these inputs, on models of the arms; and where our
reader and our writer of one language share a misunderstanding, both runs share it too.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

from rpl import ir
from rpl.motionmodel import PLAIN_NAME
from rpl.proof.bits import with_wired_groups
from rpl.proof.compare import Comparison, compare
from rpl.proof.explore import Budget, Exploration, explore
from rpl.proof.exploring import worst_of
from rpl.proof.paths import TURN_LEVER_MM
from rpl.proof.reach import reach_of
from rpl.proof.record import Record
from rpl.proof.recording import record_of
from rpl.proof.stops import with_written_stop
from rpl.proof.teaching.retaught import Runs, Teaching, retaught
from rpl.proof.tolerance import Accepted, Tolerance
from rpl.proof.verdict import Explored, ProofResult
from rpl.proof.watched import Side, side_of
from rpl.proof.wiring import in_words_of, turned, wired_bits, with_ranges_said
from rpl.runtime.limits import DEFAULTS, Limits

if TYPE_CHECKING:
    from rpl.cell import Cell
    from rpl.emulator.model import RobotModel
    from rpl.motionmodel import MotionModel


NOTHING_ACCEPTED = Accepted()


def prove_programs(
    program_a: ir.Program,
    program_b: ir.Program,
    robot_a: str | RobotModel | None = None,
    robot_b: str | RobotModel | None = None,
    cell: Cell | None = None,
    *,
    entry: str | None = None,
    to_entry: str | None = None,
    accepted: Accepted = NOTHING_ACCEPTED,
    limits: Limits = DEFAULTS,
    controller: str | MotionModel = PLAIN_NAME,
    budget: Budget | None = None,
    kept: Mapping[str, str] | None = None,
    teaching: Teaching | None = None,
) -> ProofResult:
    """Run two normalised programs and compare them. `robot_b` None: the same arm as A's. `controller` drives
    both.

    `accepted`: what may deviate and is equal still. `budget`: explore, which finds further cells in which the programs
    go other ways, and compare the programs in these too. `kept`: B's names of data that the controller keeps, by A's
    (wiring.kept_names). `teaching`: prove again with taught data moved. Raises UsageError for an unknown robot or an
    entry that cannot be found.
    """
    first, second = _model(robot_a), _model(robot_b)
    if second is None:
        second = first
    to_entry = to_entry if to_entry is not None else entry

    how = _Driven((first, second), (entry, to_entry), limits, controller, accepted)
    programs = (program_a, program_b)

    def proved(cell: Cell | None, limits: Limits, other: Cell | None = None) -> ProofResult:
        record_a = recorded_run(program_a, first, cell, entry, limits, controller)
        return prove_against(
            record_a,
            program_a,
            program_b,
            second,
            cell if other is None else other,
            to_entry=to_entry,
            accepted=accepted,
            limits=limits,
            controller=controller,
            kept=kept,
        )

    result = proved(cell, limits)
    if teaching is not None:
        result = retaught(result, how.runs(programs, (cell, _theirs(cell, *programs, kept))), teaching)
    if budget is None or result.difference is not None:
        return result
    sides = how.sides(programs, kept or {})
    found = explore(sides, cell, budget)
    shorter = replace(limits, time_s=min(limits.time_s, found.time_s))
    cells = tuple(zip(found.cells, found.others, strict=True))
    return _explored(worst_of(result, cells, lambda cell, other: proved(cell, shorter, other)), found, sides)


def _explored(joined: ProofResult, found: Exploration, sides: Sequence[Side]) -> ProofResult:
    """The joined result with what the exploration reached."""
    reaches = [
        reach_of(side.program, found.reached[number], side.entry, found.remarks[number], found.one_way[number])
        for number, side in enumerate(sides)
    ]
    explored = Explored(len(found.cells), found.tried, found.ended, found.unmatched)
    return replace(joined, reach_a=reaches[0], reach_b=reaches[1], explored=explored)


def prove_against(
    record_a: Record,
    program_a: ir.Program,
    program_b: ir.Program,
    robot_b: RobotModel | None,
    cell: Cell | None = None,
    *,
    to_entry: str | None = None,
    accepted: Accepted = NOTHING_ACCEPTED,
    limits: Limits = DEFAULTS,
    controller: str | MotionModel = PLAIN_NAME,
    kept: Mapping[str, str] | None = None,
) -> ProofResult:
    """Run B and compare it with a run of A that was recorded before, for who compares A with several programs."""
    theirs = _theirs(cell, program_a, program_b, kept)
    record_b = recorded_run(program_b, robot_b, theirs, to_entry, limits, controller)
    return prove_recorded(record_a, record_b, program_a, program_b, to_entry=to_entry, accepted=accepted)


def _theirs(
    cell: Cell | None, program_a: ir.Program, program_b: ir.Program, kept: Mapping[str, str] | None
) -> Cell | None:
    """The cell as B has it."""
    theirs = in_words_of(cell, program_a, program_b, kept) if cell is not None else None
    return with_ranges_said(theirs, program_a, program_b)


@dataclass(frozen=True, slots=True, eq=False)
class _Driven:
    """How both programs are run and compared, for who runs them several times; of pairs the first is A's."""

    robots: tuple[RobotModel | None, RobotModel | None]
    entries: tuple[str | None, str | None]
    limits: Limits
    controller: str | MotionModel
    accepted: Accepted

    def runs(self, programs: tuple[ir.Program, ir.Program], cells: tuple[Cell | None, Cell | None]) -> Runs:
        """The runs of these programs, or of others with the same statements."""

        def run(side: int) -> Callable[[ir.Program, Cell | None], Record]:
            robot, entry = self.robots[side], self.entries[side]
            return lambda program, cell: recorded_run(program, robot, cell, entry, self.limits, self.controller)

        def compared(a: Record, b: Record, first: ir.Program, second: ir.Program) -> ProofResult:
            return prove_recorded(a, b, first, second, to_entry=self.entries[1], accepted=self.accepted)

        return Runs(*programs, *self.robots, *cells, run(0), run(1), compared)

    def sides(self, programs: tuple[ir.Program, ir.Program], kept: Mapping[str, str]) -> tuple[Side, Side]:
        """The sides of an exploration; the second one has the cell in its own words."""

        def words(cell: Cell) -> Cell:
            return in_words_of(cell, *programs, kept)

        how = (self.limits, self.controller)
        return (
            side_of(programs[0], self.robots[0], self.entries[0], *how),
            side_of(programs[1], self.robots[1], self.entries[1], *how, words, turned(kept)),
        )


def prove_recorded(
    record_a: Record,
    record_b: Record,
    program_a: ir.Program,
    program_b: ir.Program,
    *,
    to_entry: str | None = None,
    accepted: Accepted = NOTHING_ACCEPTED,
) -> ProofResult:
    """Compare runs of A and of B that were recorded before, in the same surroundings and by the same controller."""
    record_a, record_b = (
        with_wired_groups(record_a, wired_bits(program_b)),
        with_wired_groups(record_b, wired_bits(program_a)),
    )
    stopped_a, stopped_b = with_written_stop(record_a, record_b), with_written_stop(record_b, record_a)
    written = "A" if stopped_a is not record_a else "B" if stopped_b is not record_b else ""
    record_a, record_b = stopped_a, stopped_b
    tolerance, limit = _tolerance(accepted)
    found = compare(record_a, record_b, tolerance, limit)
    reason = "" if found.difference is not None else _undecided(record_a, record_b, program_a, program_b, found)
    stop = (
        ()
        if found.difference is not None or not written
        else (_WRITTEN.format(where=_where(record_b if written == "A" else record_a), who=written),)
    )
    return ProofResult(
        found.level,
        found.difference,
        found.max_path_mm,
        found.max_joint_deg,
        found.max_time_s,
        found.deviations,
        stop[0] if stop else reason,
        (*_notes(record_a, record_b), *stop),
        tolerance,
        accepted,
        reach_of(program_a, (record_a.reached,)),
        reach_of(program_b, (record_b.reached,), to_entry),
    )


def _tolerance(accepted: Accepted) -> tuple[Tolerance, float]:
    """The tolerances, tightened where less is accepted than they leave, and how far apart ways may be at most."""
    usual = Tolerance()
    if accepted.path_mm is None:
        return usual, 0.0
    turned = math.degrees(accepted.path_mm / TURN_LEVER_MM)  # joints of a tool that may be so far off
    path_mm, joint_deg = min(usual.path_mm, accepted.path_mm), max(usual.joint_deg, turned)
    return replace(usual, path_mm=path_mm, joint_deg=joint_deg), accepted.path_mm


def load_cell(path: str | None) -> Cell | None:
    """The surroundings described by a cell file; None without a path."""
    if path is None:
        return None
    from rpl.cell import read_cell

    return read_cell(path)


def _model(robot: str | RobotModel | None) -> RobotModel | None:
    if isinstance(robot, str):
        from rpl.emulator.model import load_robot

        return load_robot(robot)
    return robot


def recorded_run(
    program: ir.Program,
    robot: RobotModel | None,
    cell: Cell | None = None,
    entry: str | None = None,
    limits: Limits = DEFAULTS,
    controller: str | MotionModel = PLAIN_NAME,
) -> Record:
    """What a run of the program shows, as proofs compare it."""
    from rpl.simulation import run_program

    result = run_program(program, robot, cell, entry, limits=limits, controller=controller)
    return record_of(result, program, robot)


_ENDED = {
    "fault": "both runs end in a fault{where}: what lies behind was not compared",
    "deadlock": "both runs end waiting for something that never comes{where}: a cell file can give the inputs",
    "limit": "both runs were ended by a limit before their end: what lies behind was not compared",
}


_WRITTEN = (
    "both runs stop with an unhandled fault{where}, {who} by the stop that is written for it:"
    " what lies behind was not compared"
)


def _undecided(a: Record, b: Record, program_a: ir.Program, program_b: ir.Program, found: Comparison) -> str:
    """Why runs without a difference decide nothing; empty where they do."""
    if a.status in _ENDED:
        return _ENDED[a.status].format(where=_where(a))
    moves = any(_has_moves(program) for program in (program_a, program_b))
    if moves and not (a.robot and b.robot):
        return "there is no robot, so that no motion was compared: name an arm with --robot"
    if moves and not any(a.motion.values()):
        return "nothing moved in these runs, although the programs have moves"
    return "" if found.compared else "nothing was compared: the programs do nothing that can be seen"


def _where(record: Record) -> str:
    """The place of the fault or of the wait in A."""
    ends = [happenings[-1] for happenings in record.tasks.values() if happenings]
    place = next((one.place for one in ends if one.place.line), None)
    every = (one for happenings in record.tasks.values() for one in happenings)
    fault = next((one.value for one in every if one.kind == "fault"), None)
    words = f" ({fault})" if fault else ""
    return f"{words} at {place}" if place is not None else words


def _has_moves(program: ir.Program) -> bool:
    from rpl.ir.walk import walk

    return any(isinstance(node, ir.Move | ir.Spline | ir.MoveExternal) for node in walk(program))


def _notes(a: Record, b: Record) -> tuple[str, ...]:
    notes = []
    if a.robot != b.robot:
        notes.append("another arm: tool paths are compared instead of joints, of joint moves only their ends")
    if a.language != b.language:
        notes.append("another controller: moments in time are not compared, only their order")
    return tuple(notes)


__all__ = ["ProofResult", "load_cell", "prove_against", "prove_programs", "prove_recorded", "recorded_run"]

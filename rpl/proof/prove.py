"""Decides whether two programs mean the same: runs both in the same surroundings and compares what they showed.

Both are driven alike, with constant accelerations unless a controller is named: what differs then is what the programs
say, not how smoothly two makers' arms speed up.

The limit of this proof: it covers the way the programs took with these inputs, on models of the arms; and where our
reader and our writer of one language share a misunderstanding, both runs share it too.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

from rpl import ir
from rpl.controllers import PLAIN_NAME
from rpl.proof.bits import with_wired_groups
from rpl.proof.compare import Tolerance, Verdict, compare
from rpl.proof.difference import Difference
from rpl.proof.record import Record
from rpl.proof.recording import record_of
from rpl.proof.wiring import in_words_of, wired_bits
from rpl.runtime.limits import DEFAULTS, Limits

if TYPE_CHECKING:
    from rpl.cell import Cell
    from rpl.controllers import MotionModel
    from rpl.emulator.model import RobotModel


@dataclass(frozen=True, slots=True)
class ProofResult:
    """The verdict. `level`: the highest of none, events, geometry, time at which the runs agree. `notes`: what the
    reader of the verdict should know, such as how far the runs came."""

    equal: bool
    level: str
    difference: Difference | None
    max_path_mm: float
    max_joint_deg: float
    max_time_s: float
    notes: tuple[str, ...] = ()

    def as_json(self) -> dict[str, object]:
        return {
            "equal": self.equal,
            "level": self.level,
            "first_difference": self.difference.as_json() if self.difference else None,
            "max_path_mm": round(self.max_path_mm, 6),
            "max_joint_deg": round(self.max_joint_deg, 6),
            "max_time_s": round(self.max_time_s, 6),
            "notes": list(self.notes),
        }

    def as_text(self) -> str:
        lines = [f"{'equal' if self.equal else 'not equal'} (agree on: {self.level})"]
        if self.difference is not None:
            lines.append(self.difference.as_text())
        lines.append(f"greatest distance {self.max_path_mm:.4f} mm, {self.max_joint_deg:.4f} deg")
        return "\n".join((*lines, *(f"note: {note}" for note in self.notes)))


def prove_programs(
    program_a: ir.Program,
    program_b: ir.Program,
    robot_a: str | RobotModel | None = None,
    robot_b: str | RobotModel | None = None,
    cell: Cell | None = None,
    *,
    entry: str | None = None,
    to_entry: str | None = None,
    path_mm: float | None = None,
    limits: Limits = DEFAULTS,
    controller: str | MotionModel = PLAIN_NAME,
) -> ProofResult:
    """Run two normalised programs and compare them. `robot_b` None: the same arm as A's. `controller` drives
    both.

    `path_mm` overrides how far apart the tool paths may be (see compare.Tolerance). Raises UsageError for an unknown
    robot or an entry that cannot be found.
    """
    first, second = _model(robot_a), _model(robot_b)
    if second is None:
        second = first
    record_a = recorded_run(program_a, first, cell, entry, limits, controller)
    to_entry = to_entry if to_entry is not None else entry
    return prove_against(
        record_a,
        program_a,
        program_b,
        second,
        cell,
        to_entry=to_entry,
        path_mm=path_mm,
        limits=limits,
        controller=controller,
    )


def prove_against(
    record_a: Record,
    program_a: ir.Program,
    program_b: ir.Program,
    robot_b: RobotModel | None,
    cell: Cell | None = None,
    *,
    to_entry: str | None = None,
    path_mm: float | None = None,
    limits: Limits = DEFAULTS,
    controller: str | MotionModel = PLAIN_NAME,
) -> ProofResult:
    """Run B and compare it with a run of A that was recorded before, for who compares A with several programs."""
    theirs = in_words_of(cell, program_a, program_b) if cell is not None else None
    record_b = recorded_run(program_b, robot_b, theirs, to_entry, limits, controller)
    record_a, record_b = (
        with_wired_groups(record_a, wired_bits(program_b)),
        with_wired_groups(record_b, wired_bits(program_a)),
    )
    tolerance = Tolerance() if path_mm is None else replace(Tolerance(), path_mm=path_mm)
    verdict = compare(record_a, record_b, tolerance)
    refuted = verdict.difference is not None
    return ProofResult(
        not refuted,
        verdict.level,
        verdict.difference,
        verdict.max_path_mm,
        verdict.max_joint_deg,
        verdict.max_time_s,
        (*_notes(record_a, record_b, refuted), *_corner_note(verdict)),
    )


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


_REACH = {
    "fault": "both runs end in the same fault",
    "deadlock": "both runs end waiting for something that never comes; a cell file can give the inputs",
    "limit": "both runs were ended by a limit",
}


def _corner_note(verdict: Verdict) -> list[str]:
    if not verdict.corners:
        return []
    return [
        "another controller measures the blends of joint moves differently: at these corners the programmed points were"
        f" compared, the tool went up to {verdict.max_corner_mm:.1f} mm apart there"
    ]


def _notes(a: Record, b: Record, refuted: bool) -> list[str]:
    notes = []
    if not refuted and a.status in _REACH:
        notes.append(f"{_REACH[a.status]}: what lies behind was not compared")
    if a.robot != b.robot:
        notes.append("another arm: tool paths are compared instead of joints, of joint moves only their ends")
    if a.language != b.language:
        notes.append("another controller: moments in time are not compared, only their order")
    return notes

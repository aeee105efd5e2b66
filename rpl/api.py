"""The Python API, with the command line's words: read, translate, run, prove. `import rpl` offers all four."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from rpl.diagnostics import Diagnostics
from rpl.project import ReadProgram, read_program

if TYPE_CHECKING:
    from rpl.cell import Cell
    from rpl.emulator.model import RobotModel
    from rpl.proof.prove import ProofResult
    from rpl.simulation import RunResult
    from rpl.translation import Translation


def read(
    paths: str | Path | Sequence[str | Path], dialect: str | None = None, diagnostics: Diagnostics | None = None
) -> ReadProgram:
    """Read files, folders or archives as one program. Pass a collector to see what was reported."""
    several = [paths] if isinstance(paths, str | Path) else paths
    return read_program(several, dialect, diagnostics)


def translate(
    program: ReadProgram,
    target: str,
    robot: str | None = None,
    to_robot: str | None = None,
    diagnostics: Diagnostics | None = None,
) -> Translation:
    """Write a program in the target's language; `losses` of the result lists what became a guarded stop."""
    from rpl.translation import translate_program

    return translate_program(program, target, robot, to_robot, diagnostics)


def run(
    program: ReadProgram,
    robot: str | RobotModel | None = None,
    cell: Cell | None = None,
    entry: str | None = None,
    max_time_s: float = 3600.0,
    controller: str | None = None,
) -> RunResult:
    """Run a program on an emulated robot in simulated time. `controller` (a language's name, `plain`, or a file) moves
    the robot in place of each language's own."""
    from rpl.simulation import run_program

    return run_program(program.program, robot, cell, entry, max_time_s, controller=controller)


def prove(a: ReadProgram, b: ReadProgram, robot: str | None = None, cell: Cell | None = None) -> ProofResult:
    """Run both programs and compare what they show; the result names the first difference."""
    from rpl.proof.prove import prove_programs

    return prove_programs(a.program, b.program, robot, robot, cell)

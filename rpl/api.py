"""The Python API, with the command line's words: read, translate, run, prove. `import rpl` offers all four.

A program is what `read` gave, or the paths of one: `rpl.run("cell/", robot="ur5e")`. A program that is named by its
paths must be free of errors, as on the command line.
"""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, TypeAlias

from rpl.diagnostics import Diagnostics, Severity
from rpl.errors import SourceError, UsageError
from rpl.grouping import told
from rpl.project import ReadProgram, read_program

if TYPE_CHECKING:
    from rpl.cell import Cell
    from rpl.emulator.model import RobotModel
    from rpl.proof.prove import ProofResult
    from rpl.simulation import RunResult
    from rpl.translation import Translation

Paths: TypeAlias = str | Path | Sequence[str | Path]
_MOST_ERRORS = 5


def read(paths: Paths, dialect: str | None = None, diagnostics: Diagnostics | None = None) -> ReadProgram:
    """Read files, folders or archives as one program. Pass a collector to see what was reported."""
    return read_program(_several(paths), dialect, diagnostics)


def translate(
    program: ReadProgram | Paths,
    target: str,
    robot: str | None = None,
    to_robot: str | None = None,
    diagnostics: Diagnostics | None = None,
) -> Translation:
    """Write a program in the target's language; `losses` of the result lists what became a guarded stop.

    Raises UsageError for unknown names, SourceError when a program named by its paths has errors.
    """
    from rpl import registry
    from rpl.translation import translate_program

    name = registry.target_called(target).name
    _model(robot), _model(to_robot)  # unknown arms are refused before anything is read
    return translate_program(_program(program, diagnostics), name, robot, to_robot, diagnostics)


def run(
    program: ReadProgram | Paths,
    robot: str | RobotModel | None = None,
    cell: Cell | str | Path | None = None,
    entry: str | None = None,
    max_time_s: float = 3600.0,
    controller: str | None = None,
) -> RunResult:
    """Run a program on an emulated robot in simulated time. `controller` (a language's name, `plain`, or a file) moves
    the robot in place of each language's own. `cell`: the surroundings, or the path of a cell file.

    Raises UsageError for unknown names, SourceError when a program named by its paths has errors. A fault inside the
    program is part of the result.
    """
    from rpl.simulation import run_program

    model, around = _model(robot), _cell(cell)
    return run_program(_program(program).program, model, around, entry, max_time_s, controller=controller)


def prove(
    a: ReadProgram | Paths,
    b: ReadProgram | Paths,
    robot: str | None = None,
    cell: Cell | str | Path | None = None,
    to_robot: str | None = None,
) -> ProofResult:
    """Run both programs and compare what they show; the result names the first difference. `to_robot`: the arm that b
    was written for, else the same. Raises as `run`."""
    from rpl.proof.prove import prove_programs

    first, second, around = _model(robot), _model(to_robot or robot), _cell(cell)
    return prove_programs(_program(a).program, _program(b).program, first, second, around)


def _several(paths: Paths) -> Sequence[str | Path]:
    return [paths] if isinstance(paths, str | Path) else paths


def _program(given: ReadProgram | Paths, diagnostics: Diagnostics | None = None) -> ReadProgram:
    """The program itself, read where its paths are given. Raises SourceError when it has errors then."""
    if isinstance(given, ReadProgram):
        return given
    collector = diagnostics if diagnostics is not None else Diagnostics()
    found = read_program(_several(given), None, collector)
    errors = collector.of(Severity.ERROR)
    if errors:
        texts = list(told(errors))
        more = [f"and {len(texts) - _MOST_ERRORS} more"] if len(texts) > _MOST_ERRORS else []
        raise SourceError("\n".join([*texts[:_MOST_ERRORS], *more]))
    if not found.files:
        raise UsageError(f"no robot program was found in {', '.join(str(path) for path in _several(given))}")
    return found


def _model(robot: str | RobotModel | None) -> RobotModel | None:
    """The arm of that name. Raises UsageError when there is none."""
    if not isinstance(robot, str):
        return robot
    from rpl.emulator.model import load_robot

    return load_robot(robot)


def _cell(cell: Cell | str | Path | None) -> Cell | None:
    if not isinstance(cell, str | Path):
        return cell
    from rpl.cell import read_cell

    return read_cell(cell)

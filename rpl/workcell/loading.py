"""The programs and arms of the robots that a cell file names, read and ready to run."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from rpl.emulator.model import load_robot
from rpl.errors import UsageError
from rpl.passes.given import with_given
from rpl.passes.unsetsettings import settings_as_they_were
from rpl.project import ReadProgram, read_program
from rpl.workcell.running import Driven

if TYPE_CHECKING:
    from rpl import ir
    from rpl.cell import Cell
    from rpl.cell.layout import RobotPlace
    from rpl.diagnostics import Diagnostics


@dataclass(frozen=True, slots=True)
class Loaded:
    """A robot of a cell, and what was read for it."""

    driven: Driven
    read: ReadProgram


def robots_of(cell: Cell, diagnostics: Diagnostics) -> tuple[Loaded, ...]:
    """Read the program of every robot that a cell file names.

    Raises UsageError where a robot has no program or no arm; what is wrong inside programs is reported.
    """
    return tuple(_loaded(cell, place, diagnostics) for place in cell.layout.robots)


def _loaded(cell: Cell, place: RobotPlace, diagnostics: Diagnostics) -> Loaded:
    for key, given in (("programs", place.programs), ("arm", place.arm)):
        if not given:
            raise UsageError(f"{cell.path}: {place.key}.{key}: is missing: {place.name} has nothing to run")
    read = read_program(place.programs, None, diagnostics)
    if not read.files:
        raise UsageError(f"{cell.path}: {place.key}.programs: no robot program was found")
    return Loaded(
        Driven(place, settled(read, cell, diagnostics), load_robot(place.arm).among(cell.mechanisms, cell.path)), read
    )


def settled(read: ReadProgram, cell: Cell, diagnostics: Diagnostics) -> ir.Program:
    """The program without settings that it takes from what only its controller knows, each of which is reported."""
    return settings_as_they_were(read.program, with_given(read.program, cell.variables), diagnostics)

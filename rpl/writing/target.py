"""What a target declares about itself, what it is given, and what it gives back."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

from rpl.diagnostics import Diagnostics
from rpl.ir.standing import NOTHING, Standing
from rpl.ir.statements import Statement
from rpl.passes.capabilities import Capabilities, NameRules

if TYPE_CHECKING:
    from rpl.emulator.model import RobotModel


@dataclass(frozen=True, slots=True)
class OutputFile:
    """One written file: its path relative to the output folder and its bytes."""

    path: str
    data: bytes


@dataclass(slots=True)
class LeftAlone:
    """Why passes right in front of a writer left a statement as it is, for the report of its guarded stop."""

    reasons: dict[int, tuple[Statement, str]] = field(default_factory=dict)  # the statement keeps its identity alive

    def note(self, statement: Statement, reason: str) -> None:
        self.reasons[id(statement)] = (statement, reason)

    def why(self, statement: Statement) -> str:
        """Empty where no pass said anything."""
        return self.reasons[id(statement)][1] if id(statement) in self.reasons else ""


@dataclass(frozen=True, slots=True)
class WriteContext:
    """What a writer is given: the collector, the arm that will run the program (None when none is named), the target's
    own options (such as `version`), the source names of data in numbered banks by (bank, number), whether the program
    comes from another language, a plant's own template files for this target, path -> text, what stands on the robot
    that will run it, and what the passes in front of it could not rewrite."""

    diagnostics: Diagnostics
    robot: RobotModel | None = None
    options: Mapping[str, str] = field(default_factory=dict)
    register_names: Mapping[tuple[str, int], str] = field(default_factory=dict)
    foreign: bool = True
    templates: Mapping[str, str] = field(default_factory=dict)
    there: Standing = NOTHING
    left_alone: LeftAlone = field(default_factory=LeftAlone)


__all__ = ["Capabilities", "LeftAlone", "NameRules", "OutputFile", "WriteContext"]

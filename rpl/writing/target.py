"""What a target declares about itself, what it is given, and what it gives back."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

from rpl.diagnostics import Diagnostics
from rpl.ir.standing import NOTHING, Standing
from rpl.passes.capabilities import Capabilities, NameRules

if TYPE_CHECKING:
    from rpl.emulator.model import RobotModel


@dataclass(frozen=True, slots=True)
class OutputFile:
    """One written file: its path relative to the output folder and its bytes."""

    path: str
    data: bytes


@dataclass(frozen=True, slots=True)
class WriteContext:
    """What a writer is given: the collector, the arm that will run the program (None when none is named), the target's
    own options (such as `version`), the source names of data in numbered banks by (bank, number), whether the program
    comes from another language, a plant's own template files for this target, path -> text, and what stands on the
    robot that will run it."""

    diagnostics: Diagnostics
    robot: RobotModel | None = None
    options: Mapping[str, str] = field(default_factory=dict)
    register_names: Mapping[tuple[str, int], str] = field(default_factory=dict)
    foreign: bool = True
    templates: Mapping[str, str] = field(default_factory=dict)
    there: Standing = NOTHING


__all__ = ["Capabilities", "NameRules", "OutputFile", "WriteContext"]

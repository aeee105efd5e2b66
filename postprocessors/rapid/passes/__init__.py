"""What only RAPID needs of a program, each pass with its place among those of the core."""

from __future__ import annotations

from rpl.passes.legalise.stages import Placed

from .constants import constant_data
from .errornames import name_errors
from .errornumbers import error_numbers
from .explicit import modal_to_explicit
from .finestops import fine_stops
from .fullzones import full_zones
from .joinedmodules import joined_modules
from .motiondata import named_motion_data
from .offsets import points_offset
from .tooldata import tool_data
from .traps import priorities_to_traps

PASSES: tuple[Placed, ...] = (
    Placed(points_offset, "source", behind="places_as_targets"),
    Placed(constant_data, "source", behind="places_as_targets"),
    Placed(error_numbers, "errors", behind="interrupt_places"),
    Placed(priorities_to_traps, "interrupts", behind="interrupts"),
    Placed(modal_to_explicit, "settings", behind="corner_leads"),
    Placed(full_zones, "settings", behind="corner_leads"),
    Placed(tool_data, "settings", behind="corner_leads"),
    Placed(named_motion_data, "settings", behind="stand_first"),
    Placed(fine_stops, "settings", behind="stand_first"),
    Placed(name_errors, "storage", before="ahead_readings"),
    Placed(joined_modules, "storage", behind="points_of_modules"),
)

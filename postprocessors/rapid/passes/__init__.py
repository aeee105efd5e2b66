"""What only RAPID needs of a program, each pass with its place among those of the core."""

from __future__ import annotations

from rpl.passes.legalise.stages import Placed

from .constants import constant_data
from .finestops import fine_stops
from .motiondata import named_motion_data
from .placedata import places_as_targets
from .traps import priorities_to_traps

PASSES: tuple[Placed, ...] = (
    Placed(places_as_targets, "source", behind="rotation_vectors"),
    Placed(constant_data, "source", behind="rotation_vectors"),
    Placed(priorities_to_traps, "interrupts", behind="interrupts"),
    Placed(named_motion_data, "settings", behind="stand_first"),
    Placed(fine_stops, "settings", behind="stand_first"),
)

"""What only RAPID needs of a program, each pass with its place among those of the core."""

from __future__ import annotations

from rpl.passes.legalise.stages import Placed

from .constants import constant_data
from .motiondata import named_motion_data

PASSES: tuple[Placed, ...] = (
    Placed(constant_data, "source", behind="kept_values_known"),
    Placed(named_motion_data, "settings", behind="stand_first"),
)

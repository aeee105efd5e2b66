"""What only RAPID needs of a program, each pass with its place among those of the core."""

from __future__ import annotations

from rpl.passes.legalise.stages import Placed

from .motiondata import named_motion_data

PASSES: tuple[Placed, ...] = (Placed(named_motion_data, "settings", behind="stand_first"),)

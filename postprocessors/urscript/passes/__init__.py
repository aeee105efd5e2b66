"""What only URScript needs of a program, each pass with its place among those of the core."""

from __future__ import annotations

from rpl.passes.legalise.stages import Placed

from .partedcorners import parted_corners
from .readings import clean_readings
from .taskstarts import stand_before_tasks

PASSES: tuple[Placed, ...] = (
    Placed(parted_corners, "settings", behind="settings_at_moves"),
    Placed(stand_before_tasks, "records", behind="watching"),
    Placed(clean_readings, "storage", behind="number_data"),
)
